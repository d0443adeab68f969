use std::sync::atomic::{AtomicU64, Ordering};

use sbbk_core::traverse::DescentCounts;

use crate::mesh::StoreCounts;
use crate::pair::QueryOutcome;

/// What a dispatcher and its clones did so far.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SbbkStats {
    /// Meshes that have a tree at present.
    pub trees: usize,
    /// Meshes that have met another mesh and bound a solid: what meets them is pushed out, see
    /// [`ContactSet`](crate::ContactSet).
    pub solids: usize,
    /// Meshes that have met another mesh and bound nothing: these are met from both sides.
    pub sheets: usize,
    /// The same for closed meshes whose normals point inwards: most likely wound the wrong way. They
    /// are met from both sides, too.
    pub inside_out: usize,
    /// Of the trees, how many no pair of colliders uses.
    pub idle_trees: usize,
    /// Memory of all of them, with all that is kept beside a tree.
    pub tree_bytes: usize,
    /// Trees built.
    pub tree_builds: u64,
    /// How often a tree that was needed, or prepared, was found by its content.
    pub tree_hits: u64,
    /// Pairs of colliders that SBBK has answered for: queries about pairs of which nothing was
    /// known, and that were not apart at once. If this stays zero, the dispatcher is not in use.
    pub pairs: u64,
    /// Descents of two meshes that did without trees, down Parry's own hierarchies: of deformable
    /// meshes, of large ones that nobody prepared, and of small ones that have no tree yet.
    pub walks: u64,
    /// Queries that Parry had to answer, as a rigid mesh has a vertex that is not finite: see
    /// [`SbbkDispatcher::prepare`](crate::SbbkDispatcher::prepare).
    pub unsupported_queries: u64,
    /// Contact queries that SBBK has answered. Counted, like the following, if
    /// [`SbbkConfig::count_queries`](crate::SbbkConfig::count_queries) is set.
    pub queries: u64,
    /// Of these, how many found nothing moved since the last query of the pair.
    pub unchanged_queries: u64,
    /// How many tested the candidates of an earlier descent.
    pub reused_queries: u64,
    /// How many descended. The rest was apart by Parry's hierarchy and the box of the other shape.
    pub descended_queries: u64,
    /// The work of the descents: those down Parry's hierarchies count as tests of boxes.
    pub descent: DescentCounts,
}

#[derive(Default)]
pub(crate) struct QueryCounters {
    queries: AtomicU64,
    unchanged: AtomicU64,
    reused: AtomicU64,
    descended: AtomicU64,
    unsupported: AtomicU64,
    sphere_tests: AtomicU64,
    aabb_tests: AtomicU64,
    kdop_tests: AtomicU64,
    leaf_pairs: AtomicU64,
    cells: AtomicU64,
}

impl QueryCounters {
    pub(crate) fn add_unsupported(&self) {
        self.unsupported.fetch_add(1, Ordering::Relaxed);
    }

    pub(crate) fn add(&self, answer: QueryOutcome, counts: &DescentCounts) {
        if answer != QueryOutcome::Unsupported {
            self.queries.fetch_add(1, Ordering::Relaxed);
        }
        match answer {
            QueryOutcome::Unchanged => self.unchanged.fetch_add(1, Ordering::Relaxed),
            QueryOutcome::Reused => self.reused.fetch_add(1, Ordering::Relaxed),
            QueryOutcome::Descended => self.descended.fetch_add(1, Ordering::Relaxed),
            QueryOutcome::Apart | QueryOutcome::Unsupported => return,
        };
        self.sphere_tests.fetch_add(counts.sphere_tests, Ordering::Relaxed);
        self.aabb_tests.fetch_add(counts.aabb_tests, Ordering::Relaxed);
        self.kdop_tests.fetch_add(counts.kdop_tests, Ordering::Relaxed);
        self.leaf_pairs.fetch_add(counts.leaf_pairs, Ordering::Relaxed);
        self.cells.fetch_add(counts.cells, Ordering::Relaxed);
    }

    pub(crate) fn stats(&self, cache: StoreCounts) -> SbbkStats {
        let load = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        SbbkStats {
            trees: cache.trees,
            solids: cache.solids,
            sheets: cache.sheets,
            inside_out: cache.inside_out,
            idle_trees: cache.idle_trees,
            tree_bytes: cache.bytes,
            tree_builds: cache.builds,
            tree_hits: cache.hits,
            pairs: cache.pairs,
            walks: cache.walks,
            unsupported_queries: load(&self.unsupported),
            queries: load(&self.queries),
            unchanged_queries: load(&self.unchanged),
            reused_queries: load(&self.reused),
            descended_queries: load(&self.descended),
            descent: DescentCounts {
                sphere_tests: load(&self.sphere_tests),
                aabb_tests: load(&self.aabb_tests),
                kdop_tests: load(&self.kdop_tests),
                leaf_pairs: load(&self.leaf_pairs),
                cells: load(&self.cells),
            },
        }
    }
}
