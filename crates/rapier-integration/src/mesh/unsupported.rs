use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use parry3d::shape::TriMesh;

use super::identity::MeshToken;

/// Meshes that cannot have a tree: not asked about again. By token, so a mesh that is taken for one of them by
/// mistake is answered by Parry, correctly if slowly.
#[derive(Default)]
pub(super) struct Unsupported {
    tokens: Mutex<HashSet<MeshToken>>,
    /// Whether there are any, so that nobody takes the lock where there are none.
    has_any: AtomicBool,
}

/// Unsupported meshes remembered at most; then all are forgotten, and asked about once more.
const GREATEST_COUNT: usize = 256;

impl Unsupported {
    pub(super) fn note(&self, mesh: &TriMesh) {
        let mut tokens = self.lock();
        if tokens.len() >= GREATEST_COUNT {
            tokens.clear();
        }
        tokens.insert(MeshToken::of(mesh));
        self.has_any.store(true, Ordering::Release);
    }

    pub(super) fn contains(&self, mesh: &TriMesh) -> bool {
        self.has_any.load(Ordering::Acquire) && self.lock().contains(&MeshToken::of(mesh))
    }

    fn lock(&self) -> MutexGuard<'_, HashSet<MeshToken>> {
        self.tokens.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
