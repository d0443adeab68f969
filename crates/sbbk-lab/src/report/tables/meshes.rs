//! What trees and first queries cost.

use super::super::Grid;
use super::super::format::{errors, min_median, times};
use super::{ERROR_NOTE, TIME_NOTE, cells};
use crate::metrics::ratio;
use crate::study::MeshRow;

/// Build time, memory, first queries and break-even, mesh by mesh.
pub fn costs(rows: &[MeshRow]) -> Grid {
    let kibibytes = |bytes: usize| format!("{:.0}", bytes as f64 / 1024.0);
    let table = rows.iter().map(|row| {
        let break_even = row.break_even().filter(|queries| *queries > 0.0);
        cells![
            row.mesh,
            row.triangle_count,
            min_median(&row.parry_build),
            min_median(&row.sbbk_build),
            kibibytes(row.parry_bytes),
            kibibytes(row.sbbk_bytes),
            row.stock_error.mesh_pairs,
            min_median(&row.stock_queries),
            min_median(&row.sbbk_queries),
            times(ratio(row.stock_queries.median, row.sbbk_queries.median)),
            break_even.map_or("-".to_owned(), |queries| format!("{:.0}", queries.ceil())),
            errors(&row.stock_error),
            errors(&row.sbbk_error),
        ]
    });
    Grid {
        title: "Trees and first queries: each mesh against itself, in touch".to_owned(),
        header: vec![
            "mesh",
            "triangles",
            "parry build, ms",
            "sbbk build, ms",
            "parry KiB",
            "sbbk KiB",
            "poses",
            "stock, ms for all",
            "sbbk, ms for all",
            "ratio",
            "break-even queries",
            "errors, stock",
            "errors, sbbk",
        ],
        text_columns: 1,
        rows: table.collect(),
        notes: vec![
            "the SBBK tree comes on top of Parry's; its leaves hold the triangles".to_owned(),
            "break-even: first queries whose saved time pays for the tree".to_owned(),
            TIME_NOTE.to_owned(),
            ERROR_NOTE.to_owned(),
        ],
    }
}
