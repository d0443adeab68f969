//! Heads on terrains.

use super::super::Grid;
use super::super::format::{errors, min_median, three_digits};
use super::{ERROR_NOTE, TIME_NOTE, cells};
use crate::study::terrain::{Fall, HEAD_COUNT, Terrain};

/// Both tables of the study of terrains.
pub fn terrains(study: &Terrain) -> [Grid; 2] {
    [queries(study), falls(&study.falls)]
}

/// Times and errors by size of the terrain and who answered.
fn queries(study: &Terrain) -> Grid {
    let rows = study.rows.iter().map(|row| {
        cells![
            row.backend,
            row.ground,
            format!("{0} × {0}", row.cells),
            min_median(&row.fresh),
            min_median(&row.steady),
            row.cells_read.map_or("-".to_owned(), three_digits),
            errors(&row.errors),
        ]
    });
    Grid {
        title: "A head of 968 triangles on a terrain; microseconds a query".to_owned(),
        header: vec!["backend", "ground", "cells", "first", "steady", "cells read", "errors"],
        text_columns: 2,
        rows: rows.collect(),
        notes: vec![
            "stock Rapier has no contacts of a mesh and a height field".to_owned(),
            "first, on a mesh: with the hash of its vertices and triangles, by which its tree is found"
                .to_owned(),
            "cells read: by a first query, each as often as its heights are read".to_owned(),
            TIME_NOTE.to_owned(),
            ERROR_NOTE.to_owned(),
        ],
    }
}

/// How many heads are left.
fn falls(falls: &[Fall]) -> Grid {
    let rows = falls.iter().map(|fall| cells![fall.backend, fall.ground, fall.left()]);
    let steps = falls.first().map_or(0, |fall| fall.heads_above.len());
    Grid {
        title: format!("{HEAD_COUNT} heads that fell on a terrain, after {steps} steps"),
        header: vec!["backend", "ground", "not under it"],
        text_columns: 2,
        rows: rows.collect(),
        notes: Vec::new(),
    }
}
