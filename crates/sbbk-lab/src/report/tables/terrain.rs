//! A mesh on terrains.

use super::super::Grid;
use super::super::format::{errors, min_median, three_digits};
use super::{ERROR_NOTE, TIME_NOTE, cells};
use crate::study::terrain::Terrain;

/// Times and errors by size of the terrain and who answered.
pub fn terrain(study: &Terrain) -> Grid {
    let rows = study.rows.iter().map(|row| {
        cells![
            row.way,
            format!("{0} × {0}", row.cells),
            min_median(&row.fresh),
            min_median(&row.steady),
            row.visited.map_or("-".to_owned(), three_digits),
            errors(&row.errors),
        ]
    });
    Grid {
        title: "A head of 968 triangles on a terrain; microseconds a query".to_owned(),
        header: vec!["who, on what", "cells", "first", "steady", "cells read", "errors"],
        text_columns: 1,
        rows: rows.collect(),
        notes: vec![
            "stock Rapier has no contacts of a mesh and a height field".to_owned(),
            "cells read: by a first query, each as often as its heights are read".to_owned(),
            TIME_NOTE.to_owned(),
            ERROR_NOTE.to_owned(),
        ],
    }
}
