//! Whether runs repeat, and how times fall as threads grow.

use super::super::Grid;
use super::super::format::{min_median, times};
use super::cells;
use crate::backend::Backend;
use crate::metrics::ratio;
use crate::study::determinism::{Determinism, DeterminismRow, DeterminismRun, Way};

/// Hashes of whole worlds: how many runs ended in the same one.
pub fn fingerprints(determinism: &Determinism) -> Grid {
    let rows = determinism.rows.iter().map(|row| {
        let ways: Vec<String> = row.runs.iter().map(|run| run.way.to_string()).collect();
        let different = row.runs.iter().filter(|run| run.fingerprint != row.runs[0].fingerprint);
        let different: Vec<String> = different.map(|run| run.way.to_string()).collect();
        cells![
            row.scene,
            row.backend,
            ways.join(", "),
            row.manifold_count,
            row.runs[0].fingerprint,
            if different.is_empty() { "all".to_owned() } else { different.join(", ") + " differ" },
        ]
    });
    Grid {
        title: format!("Worlds after {} steps, bit for bit", determinism.steps),
        header: vec!["scene", "backend", "runs", "manifolds", "hash of the first", "same"],
        text_columns: 3,
        rows: rows.collect(),
        notes: vec![
            "hash: poses, velocities, contacts in their order, features and impulses".to_owned(),
            "forgetful: a new dispatcher before each step, so that no tree, candidate or feature is known"
                .to_owned(),
        ],
    }
}

/// Narrow phase and step of stock and SBBK by number of threads.
pub fn threads(determinism: &Determinism) -> Grid {
    let find = |scene: &str, backend: Backend, way: Way| -> Option<&DeterminismRun> {
        let is_it = |row: &&DeterminismRow| row.scene == scene && row.backend == backend;
        let row = determinism.rows.iter().find(is_it)?;
        row.runs.iter().find(|run| run.way == way)
    };
    let stock = determinism.rows.iter().filter(|row| row.backend == Backend::Stock);
    let rows = stock.flat_map(|row| row.runs.iter().map(move |run| (row, run))).filter_map(
        |(row, stock)| {
            let Way::Threads(count) = stock.way else { return None };
            let sbbk = find(&row.scene, Backend::Sbbk, stock.way)?;
            Some(cells![
                row.scene,
                count,
                min_median(&stock.narrow_phase),
                min_median(&sbbk.narrow_phase),
                times(ratio(stock.narrow_phase.mean, sbbk.narrow_phase.mean)),
                min_median(&stock.step),
                min_median(&sbbk.step),
                times(ratio(stock.step.mean, sbbk.step.mean)),
            ])
        },
    );
    Grid {
        title: "Milliseconds a step, by number of threads".to_owned(),
        header: vec![
            "scene",
            "threads",
            "stock, narrow phase",
            "sbbk, narrow phase",
            "ratio",
            "stock, step",
            "sbbk, step",
            "ratio",
        ],
        text_columns: 1,
        rows: rows.collect(),
        notes: vec![
            "times: min / median over the steps; ratio: of means".to_owned(),
            "more threads than one are used only under Rapier's feature `parallel`".to_owned(),
        ],
    }
}
