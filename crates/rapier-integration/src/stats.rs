use std::sync::atomic::{AtomicU64, Ordering};

use sbbk_core::traverse::DescentCounts;

use crate::mesh::StoreCounts;
use crate::pair::QueryOutcome;

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
    /// Analysed meshes that are closed with inward normals, and count as sheets. They may be wound the
    /// wrong way.
    pub inside_out: usize,
    /// Contact queries of two meshes in which a declared solid has pushed out a mesh that is wholly
    /// inside.
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

#[derive(Default)]
pub(crate) struct QueryCounters {
    searches: AtomicU64,
    unsupported: AtomicU64,
    queries: AtomicU64,
    unchanged: AtomicU64,
    reused: AtomicU64,
    descended: AtomicU64,
    sphere_tests: AtomicU64,
    aabb_tests: AtomicU64,
    kdop_tests: AtomicU64,
    leaf_pairs: AtomicU64,
    cells: AtomicU64,
}

impl QueryCounters {
    pub(crate) fn add_search(&self) {
        self.searches.fetch_add(1, Ordering::Relaxed);
    }

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

    pub(crate) fn stats(&self, store: StoreCounts) -> SbbkStats {
        let load = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        SbbkStats {
            pairs: store.pairs,
            searches: load(&self.searches),
            unsupported_queries: load(&self.unsupported),
            solids: store.solids,
            sheets: store.sheets,
            inside_out: store.inside_out,
            push_outs: store.push_outs,
            trees: store.trees,
            tree_bytes: store.bytes,
            queries: load(&self.queries),
            descended_queries: load(&self.descended),
            internals: SbbkInternals {
                idle_trees: store.idle_trees,
                tree_builds: store.builds,
                tree_hits: store.hits,
                walks: store.walks,
                unchanged_queries: load(&self.unchanged),
                reused_queries: load(&self.reused),
                descent: DescentCounts {
                    sphere_tests: load(&self.sphere_tests),
                    aabb_tests: load(&self.aabb_tests),
                    kdop_tests: load(&self.kdop_tests),
                    leaf_pairs: load(&self.leaf_pairs),
                    cells: load(&self.cells),
                },
            },
        }
    }
}
