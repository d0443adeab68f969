use parry3d::shape::{TriMesh, TriMeshFlags, TrianglePseudoNormals};
use sbbk_core::collections::Numbers;
use sbbk_core::tree::{BuildError, BuildOptions, Tree};

/// All that is computed once a mesh.
pub(crate) struct PreparedMesh {
    pub(crate) tree: Tree,
    /// For each triangle its place in the order in which Parry's own hierarchy lists them, which is
    /// the order of stock manifolds.
    ranks: Numbers,
    /// The pseudo-normals that constrain contact normals, if the mesh asks for them
    /// (`TriMeshFlags::FIX_INTERNAL_EDGES`); for degenerate triangles none. Parry computes them
    /// anew for each pair of triangles.
    normal_constraints: Vec<Option<TrianglePseudoNormals>>,
}

impl PreparedMesh {
    pub(crate) fn new(mesh: &TriMesh, options: &BuildOptions) -> Result<Self, BuildError> {
        let tree = Tree::build(mesh.vertices(), mesh.indices(), options)?;
        let triangles = 0..mesh.indices().len() as u32;
        let has_constraints = mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES);
        let normal_constraints = if has_constraints {
            triangles.map(|i| mesh.triangle_normal_constraints(i)).collect()
        } else {
            Vec::new()
        };
        Ok(Self { tree, ranks: ranks(mesh), normal_constraints })
    }

    /// The place of a triangle in stock order. A number that is not a triangle's sorts last.
    #[inline(always)]
    pub(crate) fn rank(&self, triangle: u32) -> u32 {
        self.ranks.get(triangle).unwrap_or(u32::MAX)
    }

    /// The cone of a triangle.
    #[inline]
    pub(crate) fn normal_constraints(&self, triangle: u32) -> Option<&TrianglePseudoNormals> {
        self.normal_constraints.get(triangle as usize)?.as_ref()
    }

    /// Memory, with this value but without the mesh itself.
    pub(crate) fn bytes(&self) -> usize {
        size_of::<Self>()
            + self.tree.stats().bytes()
            + self.ranks.bytes()
            + self.normal_constraints.len() * size_of::<Option<TrianglePseudoNormals>>()
    }
}

fn ranks(mesh: &TriMesh) -> Numbers {
    let mut ranks = vec![None; mesh.indices().len()];
    for (rank, triangle) in (0..).zip(mesh.bvh().leaves(|_| true)) {
        ranks[triangle as usize] = Some(rank);
    }
    Numbers::new(ranks.into_iter())
}
