//! Meshes that deform.

use super::super::Grid;
use super::super::format::{errors, min_median, three_digits, times};
use super::{ERROR_NOTE, TIME_NOTE, cells};
use crate::metrics::{Summary, ratio};
use crate::study::soft::{RefitStudy, Soft};

/// Soft heads on a helicopter, by backend.
pub fn soft_heads(study: &Soft) -> Grid {
    let stock = study.heads.first();
    let rows = study.heads.iter().map(|row| {
        let against_stock = |time: f64, of: fn(&crate::study::soft::SoftHeadsRow) -> f64| {
            times(stock.and_then(|stock| ratio(of(stock), time)))
        };
        cells![
            row.backend,
            min_median(&row.step),
            against_stock(row.step.min, |row| row.step.min),
            min_median(&row.queries),
            against_stock(row.queries.min, |row| row.queries.min),
            row.calls,
            errors(&row.errors),
        ]
    });
    Grid {
        title: format!("{}; milliseconds a step", study.scene),
        header: vec!["backend", "step", "ratio", "queries", "ratio", "calls", "errors"],
        text_columns: 1,
        rows: rows.collect(),
        notes: vec![
            "heads are Rapier's soft bodies, which deform their meshes in each step; queries: of \
             heads and helicopter, refits included; heads against heads are not a dispatcher's"
                .to_owned(),
            format!("{TIME_NOTE}; ratio: stock's minimum over this one"),
            ERROR_NOTE.to_owned(),
        ],
    }
}

/// Refits of a large mesh.
pub fn refit(study: &Soft) -> Grid {
    let RefitStudy { triangle_count, frames, contacts, lost, added, .. } = study.refit;
    let RefitStudy { all_layers, aabb_only, parry, build, .. } = &study.refit;
    let line = |name: &str, time: &Summary| {
        let share = |of: &Summary| times(ratio(time.min, of.min));
        cells![name, min_median(time), three_digits(time.max), share(aabb_only), share(parry)]
    };
    Grid {
        title: format!("Refit of {triangle_count} triangles over {frames} frames; milliseconds"),
        header: vec!["what", "time", "longest", "to boxes only", "to parry"],
        text_columns: 1,
        rows: vec![
            line("sphere, AABBs, k-DOPs", all_layers),
            line("AABBs only", aabb_only),
            line("parry, set_vertices", parry),
            line("build of all layers", build),
        ],
        notes: vec![
            format!(
                "contacts with a torus, refitted tree against one built in each frame: {lost} \
                 lost, {added} added, of {contacts}"
            ),
            format!("{TIME_NOTE}, in turn; ratios: of minima"),
        ],
    }
}
