//! The second experiment.

use super::super::format::{errors, min_median, three_digits, times};
use super::super::{Grid, PAPER};
use super::{ERROR_NOTE, TIME_NOTE, cells};
use crate::backend::Backend;
use crate::metrics::{Summary, ratio};
use crate::study::{PILE_QUERY_STRIDE, PileRow, PileStudy, SamePosesRow};

/// The paper's Table 2, for one pile.
pub fn runs(pile: &PileStudy) -> Grid {
    let is_papers = pile.heads == PAPER.heads;
    let against = |row: &PileRow, backend, time: fn(&PileRow) -> Summary| {
        times(ratio(run_median(pile, backend, time), time(row).median))
    };
    let paper = [("aabb", PAPER.aabb_ms, 1.0), ("sbbk", PAPER.sbbk_ms, PAPER.time_ratio())];
    let paper = paper.map(|(name, ms, against)| {
        let name = format!("the paper's {name}");
        cells![name, ms, "", times(Some(against)), "", "", "", "", "", "", "", ""]
    });
    let ours = pile.runs.iter().map(|row| {
        cells![
            row.backend,
            min_median(&row.collision_detection),
            against(row, Backend::Stock, |row| row.collision_detection),
            against(row, Backend::AabbOnly, |row| row.collision_detection),
            min_median(&row.mesh_mesh),
            min_median(&row.mesh_other),
            min_median(&row.solver),
            min_median(&row.step),
            against(row, Backend::Stock, |row| row.step),
            row.state.contact_manifold_count,
            row.state.point_count,
            format!("{:.3}", row.state.mean_height),
        ]
    });
    let first = pile.runs.first();
    let (repeats, steps) = first.map_or((0, 0), |row| (row.step.count, row.steps));
    Grid {
        title: format!("Table 2. {}: milliseconds a step", pile.scene),
        header: vec![
            "backend",
            "broad + narrow",
            "vs stock",
            "vs aabb-only",
            "head-head queries",
            "head-floor queries",
            "solver",
            "step",
            "vs stock",
            "manifolds",
            "points",
            "mean height",
        ],
        text_columns: 1,
        rows: paper.into_iter().filter(|_| is_papers).chain(ours).collect(),
        notes: vec![
            format!(
                "mean of the {steps} steps after the first heads land, in which one query in {PILE_QUERY_STRIDE} is timed; \
                 {TIME_NOTE} ({repeats})"
            ),
            format!(
                "contact recycling {}; backends side by side, each on its own trajectory; manifolds, points and \
                 height after the last sampled step",
                if pile.contact_recycling { "on (Rapier's default)" } else { "off" }
            ),
        ],
    }
}

/// The numbers behind the paper's Diagram 1.
pub fn sizes(piles: &[&PileStudy]) -> Grid {
    let rows = piles.iter().map(|pile| {
        let detection = |backend| run_median(pile, backend, |row| row.collision_detection);
        let step = |backend| run_median(pile, backend, |row| row.step);
        let queries = |backend| run_median(pile, backend, |row| row.mesh_mesh);
        let steady = |backend| query_median(pile, backend, |row| row.steady);
        let [stock, aabb, sbbk] = [Backend::Stock, Backend::AabbOnly, Backend::Sbbk];
        let paper = (pile.heads == PAPER.heads).then_some(PAPER.time_ratio());
        cells![
            pile.heads,
            three_digits(detection(stock)),
            three_digits(detection(aabb)),
            three_digits(detection(sbbk)),
            times(ratio(detection(stock), detection(sbbk))),
            times(ratio(detection(aabb), detection(sbbk))),
            times(paper),
            times(ratio(step(stock), step(sbbk))),
            times(ratio(queries(stock), queries(sbbk))),
            times(ratio(queries(aabb), queries(sbbk))),
            times(ratio(steady(stock), steady(sbbk))),
            times(ratio(steady(aabb), steady(sbbk))),
        ]
    });
    Grid {
        title: "Diagram 1. Collision detection by number of heads".to_owned(),
        header: vec![
            "heads",
            "stock, ms",
            "aabb-only, ms",
            "sbbk, ms",
            "stock : sbbk",
            "aabb : sbbk",
            "paper's",
            "whole step, stock : sbbk",
            "queries, stock : sbbk",
            "aabb : sbbk",
            "same poses, stock : sbbk",
            "aabb : sbbk",
        ],
        text_columns: 0,
        rows: rows.collect(),
        notes: vec![
            "broad and narrow phase if nothing else is said, medians of whole runs, contact recycling on; queries: head \
             against head only; same poses: steady queries of the next table"
                .to_owned(),
        ],
    }
}

/// All backends at the same poses.
pub fn same_poses(piles: &[&PileStudy]) -> Grid {
    let rows = piles.iter().flat_map(|pile| {
        let against = |row: &SamePosesRow, time: fn(&SamePosesRow) -> Summary| {
            let stock = query_median(pile, Backend::Stock, time);
            times(ratio(stock, time(row).median))
        };
        pile.same_poses.iter().map(move |row| {
            cells![
                pile.heads,
                row.backend,
                row.pair_count,
                min_median(&row.fresh),
                against(row, |row| row.fresh),
                min_median(&row.steady),
                against(row, |row| row.steady),
                errors(&row.fresh_error),
                errors(&row.steady_error),
            ]
        })
    });
    let repeats = piles.iter().flat_map(|pile| &pile.same_poses).map(|row| row.fresh.count).max();
    Grid {
        title: "The same head-head pairs at the same poses, milliseconds for all".to_owned(),
        header: vec![
            "heads",
            "backend",
            "pairs",
            "fresh",
            "vs stock",
            "steady",
            "vs stock",
            "errors, fresh",
            "errors, steady",
        ],
        text_columns: 2,
        rows: rows.collect(),
        notes: vec![
            "poses of the stock run's last sampled step; fresh: nothing known about a pair; \
             steady: a step later, with what is kept from the first query"
                .to_owned(),
            "no pair is left out as recycled, so that steady is Rapier with recycling off"
                .to_owned(),
            format!("{TIME_NOTE} ({}), backends in turn", repeats.unwrap_or(0)),
            ERROR_NOTE.to_owned(),
        ],
    }
}

/// Errors on each backend's own trajectory.
pub fn accuracy(piles: &[PileStudy]) -> Grid {
    let rows = piles.iter().flat_map(|pile| {
        let recycling = if pile.contact_recycling { "on" } else { "off" };
        pile.runs.iter().map(move |row| {
            cells![
                pile.heads,
                recycling,
                row.backend,
                format!("{} of {}", row.fresh.mesh_pairs, row.fresh.sampled_from),
                errors(&row.fresh),
                format!("{} of {}", row.updated.mesh_pairs, row.updated.sampled_from),
                errors(&row.updated),
                format!("{:.4}", row.state.mean_penetration),
                format!("{:.4}", row.state.max_penetration),
            ]
        })
    });
    Grid {
        title: "Accuracy in whole runs".to_owned(),
        header: vec![
            "heads",
            "recycling",
            "backend",
            "mesh pairs, fresh",
            "errors",
            "mesh pairs, in the run",
            "errors",
            "mean depth",
            "max depth",
        ],
        text_columns: 3,
        rows: rows.collect(),
        notes: vec![
            "fresh: sampled from all pairs of the broad phase, asked anew; in the run: sampled \
             from those that Rapier updated in the sampled steps, as it got them"
                .to_owned(),
            "depth: units, of the deepest point of touching pairs as Rapier holds them, recycled \
             ones included"
                .to_owned(),
            ERROR_NOTE.to_owned(),
        ],
    }
}

/// The value that belongs to `backend`; NaN if there is none.
fn of(backend: Backend, values: impl Iterator<Item = (Backend, f64)>) -> f64 {
    let mut values = values.filter(|value| value.0 == backend);
    values.next().map_or(f64::NAN, |value| value.1)
}

/// A median of the whole runs of `backend`.
fn run_median(pile: &PileStudy, backend: Backend, time: fn(&PileRow) -> Summary) -> f64 {
    of(backend, pile.runs.iter().map(|row| (row.backend, time(row).median)))
}

/// A median of the queries of `backend` at the same poses.
fn query_median(pile: &PileStudy, backend: Backend, time: fn(&SamePosesRow) -> Summary) -> f64 {
    of(backend, pile.same_poses.iter().map(|row| (row.backend, time(row).median)))
}
