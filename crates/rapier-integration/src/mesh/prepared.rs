use parry3d::shape::{CompositeShape, TriMesh, TriMeshFlags, TrianglePseudoNormals};
use sbbk_core::tree::{BuildError, BuildOptions, RefitCost, Tree};

use super::broken;
use super::identity::HierarchyHash;

/// All that is computed once a mesh.
pub(crate) struct PreparedMesh {
    pub(crate) tree: Tree,
    /// For each triangle its place in the order in which Parry's own hierarchy lists them, which is
    /// the order of stock manifolds.
    ranks: Vec<u32>,
    /// The hierarchy that the ranks are of.
    hierarchy: HierarchyHash,
    /// The pseudo-normals that constrain contact normals, if the mesh asks for them
    /// (`TriMeshFlags::FIX_INTERNAL_EDGES`); for degenerate triangles none. Parry computes them
    /// anew for each pair of triangles. Empty for a deformable mesh, whose normals turn.
    normal_constraints: Vec<Option<TrianglePseudoNormals>>,
    normals_turn: bool,
    /// Triangles of a deformable mesh with a corner that is NaN or infinite, in ascending order:
    /// they touch nothing.
    broken: Vec<u32>,
}

impl PreparedMesh {
    pub(crate) fn new(mesh: &TriMesh, options: &BuildOptions) -> Result<Self, BuildError> {
        let (tree, broken) = match Tree::build(mesh.vertices(), mesh.indices(), options) {
            Err(BuildError::NotFinite { .. }) if mesh.is_deformable() => {
                broken::build(mesh, options)?
            }
            built => (built?, Vec::new()),
        };
        let triangles = 0..mesh.indices().len() as u32;
        let has_constraints = mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES);
        let normals_turn = has_constraints && mesh.is_deformable();
        let normal_constraints = if has_constraints && !normals_turn {
            triangles.map(|i| mesh.triangle_normal_constraints(i)).collect()
        } else {
            Vec::new()
        };
        let (ranks, hierarchy) = (ranks(mesh), HierarchyHash::of(mesh));
        Ok(Self { tree, ranks, hierarchy, normal_constraints, normals_turn, broken })
    }

    /// Fits the tree to a mesh whose vertices have moved, and the ranks if its hierarchy is
    /// another.
    ///
    /// # Errors
    /// Those of [`Tree::refit`]: a broken mesh needs a build.
    pub(super) fn refit(&mut self, mesh: &TriMesh) -> Result<RefitCost, BuildError> {
        let cost = self.tree.refit(mesh.vertices(), mesh.indices())?;
        self.broken.clear();
        let hierarchy = HierarchyHash::of(mesh);
        if self.hierarchy != hierarchy {
            (self.ranks, self.hierarchy) = (ranks(mesh), hierarchy);
        }
        Ok(cost)
    }

    /// Whether a triangle is broken and touches nothing, wherever the tree has it.
    #[inline]
    pub(crate) fn is_broken(&self, triangle: u32) -> bool {
        !self.broken.is_empty() && self.broken.binary_search(&triangle).is_ok()
    }

    /// The place of a triangle in stock order. A number that is not a triangle's sorts last.
    pub(crate) fn rank(&self, triangle: u32) -> u32 {
        self.ranks.get(triangle as usize).copied().unwrap_or(u32::MAX)
    }

    /// The cone of a triangle of `mesh`; made in `fresh` if the mesh deforms.
    #[inline]
    pub(crate) fn normal_constraints<'a>(
        &'a self,
        mesh: &TriMesh,
        triangle: u32,
        fresh: &'a mut Option<TrianglePseudoNormals>,
    ) -> Option<&'a TrianglePseudoNormals> {
        if self.normals_turn {
            *fresh = mesh.triangle_normal_constraints(triangle);
            return fresh.as_ref();
        }
        self.normal_constraints.get(triangle as usize)?.as_ref()
    }

    /// Memory, with this value but without the mesh itself.
    pub(crate) fn bytes(&self) -> usize {
        size_of::<Self>()
            + self.tree.stats().bytes()
            + (self.ranks.len() + self.broken.len()) * size_of::<u32>()
            + self.normal_constraints.len() * size_of::<Option<TrianglePseudoNormals>>()
    }
}

/// For each triangle its place among the leaves of Parry's hierarchy.
fn ranks(mesh: &TriMesh) -> Vec<u32> {
    let mut ranks = vec![0; mesh.indices().len()];
    for (rank, triangle) in mesh.bvh().leaves(|_| true).enumerate() {
        ranks[triangle as usize] = rank as u32;
    }
    ranks
}
