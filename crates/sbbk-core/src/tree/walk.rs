//! Read access to the nodes of a tree.

use super::Tree;
use super::node::{LeafBatch, Link, Slot};
use crate::volumes::{Aabb, Kdop};

/// A node of a tree: see [`Tree::root`].
#[derive(Copy, Clone, Debug)]
pub struct Node<'a> {
    tree: &'a Tree,
    slot: Slot,
    depth: u32,
}

impl Tree {
    /// The root, from which all nodes can be reached.
    pub fn root(&self) -> Node<'_> {
        Node { tree: self, slot: Slot::ROOT, depth: 0 }
    }
}

impl<'a> Node<'a> {
    /// Steps from the root.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// The box of the node, in the frame of the mesh.
    pub fn aabb(&self) -> Aabb {
        self.tree.children(self.slot.node()).aabb(self.slot.lane())
    }

    /// The k-DOP of the node, in the layers that have one.
    pub fn kdop(&self) -> Option<Kdop> {
        self.tree.children(self.slot.node()).kdop(self.slot.lane())
    }

    /// The two nodes below; `None` for a leaf.
    pub fn children(&self) -> Option<[Self; 2]> {
        let link = self.link();
        let child = |lane| Self {
            tree: self.tree,
            slot: Slot::new(link.index(), lane),
            depth: self.depth + 1,
        };
        (!link.is_leaf()).then(|| [child(0), child(1)])
    }

    /// The triangles of a leaf; `None` for an inner node.
    pub fn leaf(&self) -> Option<&'a LeafBatch> {
        let link = self.link();
        link.is_leaf().then(|| self.tree.leaf(link.index()))
    }

    fn link(&self) -> Link {
        self.tree.link(self.slot)
    }
}
