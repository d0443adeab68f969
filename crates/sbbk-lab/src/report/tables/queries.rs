//! Queries without manifolds: times and errors.

use super::super::Grid;
use super::super::format::{min_median, three_digits, times};
use super::{TIME_NOTE, cells};
use crate::study::queries::{Queries, Query, QueryErrors};

/// Times, ratios and errors, by query, place and mesh; and the geometric means.
pub fn one_answer(queries: &Queries) -> [Grid; 2] {
    [all(queries), means(queries)]
}

fn all(queries: &Queries) -> Grid {
    let rows = Query::ALL.into_iter().flat_map(|query| {
        let mut rows: Vec<_> = queries.rows.iter().filter(|row| row.query == query).collect();
        rows.sort_by_key(|row| row.place as u8);
        rows
    });
    let rows = rows.map(|row| {
        let [stock, sbbk] = &row.sides;
        cells![
            row.query,
            row.place,
            row.mesh,
            row.triangle_count,
            row.pose_count,
            min_median(&stock.time),
            min_median(&sbbk.time),
            times(row.ratio()),
            errors(&stock.errors),
            errors(&sbbk.errors),
        ]
    });
    Grid {
        title: "Queries about each mesh and itself, 2 units across".to_owned(),
        header: vec![
            "query",
            "place",
            "mesh",
            "triangles",
            "poses",
            "stock, µs",
            "sbbk, µs",
            "ratio",
            "errors, stock",
            "errors, sbbk",
        ],
        text_columns: 3,
        rows: rows.collect(),
        notes: vec![
            TIME_NOTE.to_owned(),
            "errors against brute force in f64: wrong answers of those judged, and the largest error of \
             the others in sizes of the mesh (for casts: the distance left at the time of impact)"
                .to_owned(),
        ],
    }
}

fn errors(errors: &QueryErrors) -> String {
    let QueryErrors { judged, wrong, largest } = errors;
    format!("{wrong} of {judged}, {largest:.0e}")
}

fn means(queries: &Queries) -> Grid {
    let rows = Query::ALL.into_iter().filter_map(|query| {
        let ratio = queries.mean_ratio(query)?;
        Some(cells![query, three_digits(ratio)])
    });
    Grid {
        title: "How many times faster than stock: geometric means over meshes and places"
            .to_owned(),
        header: vec!["query", "ratio"],
        text_columns: 1,
        rows: rows.collect(),
        notes: Vec::new(),
    }
}
