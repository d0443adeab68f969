//! The first experiment.

use super::super::format::{errors, min_median, three_digits, times};
use super::super::{Grid, PAPER};
use super::{ERROR_NOTE, TIME_NOTE, cells};
use crate::backend::Backend;
use crate::metrics::ratio;
use crate::study::{CutStudy, HelicopterRow, Hierarchy};

/// The paper's Table 1.
pub fn frames(rows: &[HelicopterRow]) -> Grid {
    let median = |like: &HelicopterRow, backend| {
        let mut rows = rows.iter().filter(|row| row.ball == like.ball);
        let row = rows.find(|row| row.backend == backend);
        row.map_or(f64::NAN, |row| row.frames_per_second.median)
    };
    let paper = [("aabb", PAPER.aabb_fps, 1.0), ("sbbk", PAPER.sbbk_fps, PAPER.fps_ratio())];
    let paper = paper.map(|(name, fps, against)| {
        cells![
            "?",
            format!("the paper's {name}"),
            fps,
            "",
            "",
            times(Some(against)),
            "",
            "",
            "",
            ""
        ]
    });
    let ours = rows.iter().map(|row| {
        let fps = row.frames_per_second;
        cells![
            row.ball,
            row.backend,
            three_digits(fps.median),
            three_digits(fps.max),
            times(ratio(fps.median, median(row, Backend::Stock))),
            times(ratio(fps.median, median(row, Backend::AabbOnly))),
            min_median(&row.collision_detection),
            min_median(&row.queries),
            errors(&row.fresh),
            errors(&row.updated),
        ]
    });
    let first = rows.first();
    let (repeats, steps) = first.map_or((0, 0), |row| (row.frames_per_second.count, row.steps));
    Grid {
        title: "Table 1. A ball falls on the rotor: frames a second".to_owned(),
        header: vec![
            "ball",
            "backend",
            "fps, median",
            "best",
            "vs stock",
            "vs aabb-only",
            "broad + narrow, ms",
            "queries, ms",
            "errors, fresh",
            "errors, in the run",
        ],
        text_columns: 2,
        rows: paper.into_iter().chain(ours).collect(),
        notes: vec![
            format!("{repeats} runs of {steps} steps each, backends in turn; contact recycling on"),
            "a frame is a step: nothing is drawn, unlike in the paper".to_owned(),
            TIME_NOTE.to_owned(),
            ERROR_NOTE.to_owned(),
        ],
    }
}

/// The paper's figures 6 and 7.
pub fn overlapping_area(cut: &CutStudy) -> Grid {
    let [aabb, sbbk] = Hierarchy::ALL
        .map(|hierarchy| cut.rows.iter().filter(move |row| row.hierarchy == hierarchy));
    let mut rows: Vec<_> = aabb.zip(sbbk).collect();
    rows.dedup_by_key(|(aabb, sbbk)| [aabb.pair_count, sbbk.pair_count, aabb.triangle_count]);
    let rows = rows.into_iter().map(|(aabb, sbbk)| {
        let fewer = ratio(aabb.triangle_count as f64, sbbk.triangle_count as f64);
        cells![
            aabb.depth,
            aabb.pair_count,
            sbbk.pair_count,
            aabb.triangle_count,
            sbbk.triangle_count,
            times(fewer),
            format!("{:.5}", aabb.volume),
            format!("{:.5}", sbbk.volume),
            times(ratio(aabb.volume, sbbk.volume)),
        ]
    });
    Grid {
        title: "Figures 6 and 7. \"Overlapping area\" when the descent is cut at a depth"
            .to_owned(),
        header: vec![
            "depth",
            "node pairs, aabb",
            "sbbk",
            "triangles, aabb",
            "sbbk",
            "ratio",
            "volume, aabb",
            "sbbk",
            "ratio",
        ],
        text_columns: 0,
        rows: rows.collect(),
        notes: vec![
            format!(
                "ball of triangles on the rotor, step {}: the first at which it penetrates; \
                 {} triangles are truly within the prediction distance; deeper cuts change nothing",
                cut.step, cut.true_triangle_count
            ),
            "triangles: those of both meshes below a node reported as touching; volume: what lies \
             within both nodes of a reported pair, cubed units"
                .to_owned(),
        ],
    }
}
