//! A long run, piece by piece.

use super::super::Grid;
use super::super::format::{errors, min_median, three_digits};
use super::{ERROR_NOTE, cells};
use crate::study::soak::Soak;

/// Time, memory, trees and errors over the steps.
pub fn soak(soak: &Soak) -> Grid {
    let mebibytes = |bytes: usize| three_digits(bytes as f64 / (1 << 20) as f64);
    let rows = soak.rows.iter().map(|row| {
        cells![
            row.step,
            min_median(&row.time),
            row.memory.map_or("-".to_owned(), mebibytes),
            row.tree_builds,
            row.trees,
            row.idle_trees,
            mebibytes(row.tree_bytes),
            row.errors.mesh_pairs,
            errors(&row.errors),
        ]
    });
    let Soak { body_count, body_limit, trees_left, .. } = soak;
    Grid {
        title: format!("{body_count} bodies, {body_limit} at once, on a mesh terrain"),
        header: vec![
            "until step",
            "ms a step",
            "process, MiB",
            "trees built",
            "trees",
            "idle",
            "trees, MiB",
            "mesh pairs judged",
            "errors",
        ],
        text_columns: 0,
        rows: rows.collect(),
        notes: vec![
            format!(
                "trees left after all bodies and the world went and idle trees were released: {trees_left}"
            ),
            "times: min / median".to_owned(),
            ERROR_NOTE.to_owned(),
        ],
    }
}
