//! The parts of a front, one after the other.

use super::super::Grid;
use super::super::format::{min_median, three_digits, times};
use super::race::Shown;
use super::{TIME_NOTE, cells, contacts};
use crate::metrics::{geometric_mean, ratio};
use crate::study::front::{FrontMotion, FrontRow, FrontStudy, JourneyRow, Variant, VariantRow};

/// What the columns of errors hold.
const DIFFERING_NOTE: &str = "differing: triangle pairs within the prediction distance, against \
                              fresh descents; all queries together";

/// Every variant on every mesh, and means over the meshes.
pub fn front(study: &FrontStudy) -> Vec<Grid> {
    vec![details(&study.rows), summary(&study.rows), journeys(&study.journeys)]
}

/// Whole queries of stock and SBBK in coherent motion with teleports.
fn journeys(rows: &[JourneyRow]) -> Grid {
    let times_faster = |row: &JourneyRow| ratio(row.sides[0].time.min, row.sides[1].time.min);
    let mut table: Vec<Vec<String>> = Vec::new();
    table.extend(rows.iter().map(|row| {
        let [stock, sbbk] = &row.sides;
        cells![
            row.mesh,
            row.triangle_count,
            row.query_count,
            row.teleport_count,
            min_median(&stock.time),
            min_median(&sbbk.time),
            times(times_faster(row)),
            stock.errors.shown(),
            sbbk.errors.shown(),
            row.differing,
        ]
    }));
    let mean = geometric_mean(rows.iter().filter_map(times_faster));
    let differing: usize = rows.iter().map(|row| row.differing).sum();
    table.push(cells!["geometric mean", "", "", "", "", "", times(mean), "", "", differing]);
    Grid {
        title: "The dispatcher in slow motion with teleports: microseconds a query".to_owned(),
        header: vec![
            "mesh",
            "triangles",
            "queries",
            "teleports",
            "stock",
            "sbbk",
            "ratio",
            "errors, stock",
            "errors, sbbk",
            "differing",
        ],
        text_columns: 1,
        rows: table,
        notes: vec![
            format!("{TIME_NOTE}; ratio: of the minima; 0.05 prediction distances a step"),
            contacts::ERROR_NOTE.to_owned(),
            "differing: manifolds of sbbk that differ from a fresh query's in any bit".to_owned(),
        ],
    }
}

/// Every variant on every mesh.
fn details(rows: &[FrontRow]) -> Grid {
    let cells = rows.iter().flat_map(|row| {
        let fresh = &row.variants[0];
        row.variants.iter().map(move |variant| {
            let VariantRow { node_tests, leaf_pairs, traversal, query, .. } = variant;
            cells![
                row.motion,
                row.triangle_count,
                variant.variant,
                three_digits(*node_tests),
                three_digits(*leaf_pairs),
                min_median(traversal),
                times(ratio(fresh.traversal.min, traversal.min)),
                min_median(query),
                times(ratio(fresh.query.min, query.min)),
                three_digits(variant.pairs),
                variant.differing,
            ]
        })
    });
    Grid {
        title: "Coherence: each variant, for one query on average".to_owned(),
        header: vec![
            "motion",
            "triangles",
            "variant",
            "node tests",
            "leaf pairs",
            "traversal, µs",
            "times faster",
            "query, µs",
            "times faster",
            "true pairs",
            "differing",
        ],
        text_columns: 3,
        rows: cells.collect(),
        notes: vec![format!("{TIME_NOTE}; times faster: of the minima"), DIFFERING_NOTE.to_owned()],
    }
}

/// Geometric means over the meshes, against the fresh descent.
fn summary(rows: &[FrontRow]) -> Grid {
    let mean = |motion: FrontMotion, index: usize, value: fn(&VariantRow) -> f64| {
        let rows = rows.iter().filter(|row| row.motion == motion);
        geometric_mean(
            rows.filter_map(|row| ratio(value(&row.variants[0]), value(&row.variants[index]))),
        )
    };
    let cells = FrontMotion::ALL.into_iter().flat_map(|motion| {
        Variant::ALL.into_iter().enumerate().map(move |(index, variant)| {
            let differing: usize = rows
                .iter()
                .filter(|row| row.motion == motion)
                .map(|row| row.variants[index].differing)
                .sum();
            cells![
                motion,
                variant,
                times(mean(motion, index, |row| row.node_tests)),
                times(mean(motion, index, |row| row.traversal.min)),
                times(mean(motion, index, |row| row.query.min)),
                differing,
            ]
        })
    });
    Grid {
        title:
            "Coherence: times fewer and faster than fresh descents, geometric means over the meshes"
                .to_owned(),
        header: vec!["motion", "variant", "node tests", "traversal", "query", "differing pairs"],
        text_columns: 2,
        rows: cells.collect(),
        notes: vec!["of the minima of times".to_owned(), DIFFERING_NOTE.to_owned()],
    }
}
