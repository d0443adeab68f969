use std::sync::Arc;

use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use sbbk_core::traverse::Counters;

use crate::mesh::TreeCache;

/// A question about a mesh and another shape: which contacts do they have?
pub(crate) trait Question {
    /// Brings the manifolds of the pair up to date.
    fn contact_manifolds<M, C>(
        self,
        cache: &Arc<TreeCache>,
        counters: impl Counters,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Answer
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static;
}

/// How a question was answered; with more effort further down.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Answer {
    /// By the boxes of the whole shapes alone.
    Apart,
    /// By what the last query left: nothing has moved.
    Unchanged,
    /// From the candidates of an earlier descent.
    Reused,
    /// By a descent.
    Descended,
    /// Not at all: a mesh cannot have a tree, and somebody else must answer.
    Unsupported,
}
