use parry3d::shape::TriMesh;
use sbbk_core::tree::{BuildError, BuildOptions, Tree};

/// All that is computed once a mesh.
pub(crate) struct PreparedMesh {
    pub(crate) tree: Tree,
}

impl PreparedMesh {
    pub(crate) fn new(mesh: &TriMesh, options: &BuildOptions) -> Result<Self, BuildError> {
        let tree = Tree::build(mesh.vertices(), mesh.indices(), options)?;
        Ok(Self { tree })
    }

    /// Memory, with this value but without the mesh itself.
    pub(crate) fn bytes(&self) -> usize {
        size_of::<Self>() + self.tree.stats().bytes()
    }
}
