use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use sbbk_core::traverse::DescentCounts;

/// Counts of a dispatcher and its clones.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SbbkStats {
    /// New pairs of colliders that SBBK handles, without those that boxes keep apart. If this and
    /// [`searches`](Self::searches) stay 0, the dispatcher is not in use.
    pub pairs: u64,
    /// Queries without manifolds that SBBK has handled, such as casts and distances.
    pub searches: u64,
    /// Queries that Parry has handled because a mesh is without triangles or its box is not finite.
    pub unsupported_queries: u64,
    /// Analysed meshes that count as solids.
    pub solids: usize,
    /// Analysed meshes that count as sheets.
    pub sheets: usize,
    /// Analysed meshes that are closed with inward normals: rooms, or meshes that are wound the
    /// wrong way.
    pub inside_out: usize,
    /// Contact queries of two meshes in which no contact was left, and a solid has pushed out a
    /// mesh inside or across its surface.
    pub push_outs: u64,
    /// Meshes that have a tree.
    pub trees: usize,
    /// Memory of trees and surfaces, in bytes.
    pub tree_bytes: usize,
    /// Contact queries that SBBK has handled, 0 without
    /// [`SbbkConfig::count_queries`](crate::SbbkConfig::count_queries).
    pub queries: u64,
    /// Contact queries that searched for candidates, 0 without
    /// [`SbbkConfig::count_queries`](crate::SbbkConfig::count_queries).
    pub descended_queries: u64,
    /// Counts for the authors of this crate.
    pub internals: SbbkInternals,
}

/// Counts of what the dispatcher saves, and of the work of its descents.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SbbkInternals {
    /// Trees that no pair of colliders uses.
    pub idle_trees: usize,
    /// Trees built.
    pub tree_builds: u64,
    /// Trees found by their content.
    pub tree_hits: u64,
    /// Descents of two meshes without trees, through the BVHs.
    pub walks: u64,
    /// Part of [`SbbkStats::queries`]: the pair has not moved.
    pub unchanged_queries: u64,
    /// Part of [`SbbkStats::queries`]: the candidates of an earlier descent served.
    pub reused_queries: u64,
    /// Work of the descents. Descents through BVHs count as tests of boxes.
    pub descent: DescentCounts,
}

/// A count that any thread may raise.
#[derive(Default)]
pub(crate) struct Counter(AtomicU64);

impl Counter {
    pub(crate) fn raise(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// Way in which a query was answered.
pub(crate) enum QueryOutcome {
    /// By the distance of the shapes: Parry's hierarchy and a box or a ball, or the motion since.
    Apart,
    /// By the manifolds of the last query.
    Unchanged,
    /// From the candidates of an earlier descent.
    Reused,
    /// By a descent.
    Descended,
}

/// Counts of a dispatcher, see [`SbbkStats`].
#[derive(Default)]
pub(crate) struct Counters {
    pub(crate) pairs: Counter,
    pub(crate) searches: Counter,
    pub(crate) unsupported: Counter,
    pub(crate) push_outs: Counter,
    pub(crate) tree_builds: Counter,
    pub(crate) tree_hits: Counter,
    pub(crate) walks: Counter,
    /// Counts of contact queries alone.
    contacts: Mutex<SbbkStats>,
}

impl Counters {
    pub(crate) fn add(&self, answer: QueryOutcome, counts: DescentCounts) {
        let stats = &mut *self.contacts();
        stats.queries += 1;
        match answer {
            QueryOutcome::Unchanged => stats.internals.unchanged_queries += 1,
            QueryOutcome::Reused => stats.internals.reused_queries += 1,
            QueryOutcome::Descended => stats.descended_queries += 1,
            QueryOutcome::Apart => return,
        }
        stats.internals.descent += counts;
    }

    /// The counts, 0 for those of meshes.
    pub(crate) fn stats(&self) -> SbbkStats {
        let contacts = *self.contacts();
        SbbkStats {
            pairs: self.pairs.get(),
            searches: self.searches.get(),
            unsupported_queries: self.unsupported.get(),
            push_outs: self.push_outs.get(),
            internals: SbbkInternals {
                tree_builds: self.tree_builds.get(),
                tree_hits: self.tree_hits.get(),
                walks: self.walks.get(),
                ..contacts.internals
            },
            ..contacts
        }
    }

    fn contacts(&self) -> MutexGuard<'_, SbbkStats> {
        self.contacts.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
