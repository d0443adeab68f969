use parry3d::shape::TriMesh;
use sbbk_core::collections::Numbers;
use sbbk_core::tree::{BuildError, BuildOptions, Tree};

/// All that is computed once a mesh.
pub(crate) struct PreparedMesh {
    pub(crate) tree: Tree,
    /// For each triangle its place in the order in which Parry's own hierarchy lists them, which is
    /// the order of stock manifolds.
    ranks: Numbers,
}

impl PreparedMesh {
    pub(crate) fn new(mesh: &TriMesh, options: &BuildOptions) -> Result<Self, BuildError> {
        let tree = Tree::build(mesh.vertices(), mesh.indices(), options)?;
        Ok(Self { tree, ranks: ranks(mesh) })
    }

    /// The place of a triangle in stock order. A number that is not a triangle's sorts last.
    #[inline(always)]
    pub(crate) fn rank(&self, triangle: u32) -> u32 {
        self.ranks.get(triangle).unwrap_or(u32::MAX)
    }

    /// Memory, with this value but without the mesh itself.
    pub(crate) fn bytes(&self) -> usize {
        size_of::<Self>() + self.tree.stats().bytes() + self.ranks.bytes()
    }
}

fn ranks(mesh: &TriMesh) -> Numbers {
    let mut ranks = vec![None; mesh.indices().len()];
    for (rank, triangle) in (0..).zip(mesh.bvh().leaves(|_| true)) {
        ranks[triangle as usize] = Some(rank);
    }
    Numbers::new(ranks.into_iter())
}
