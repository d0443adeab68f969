//! Tables of everyday scenes.

use super::{BODIES, DEFORMABLE, EverydayPlan, PILE, QUERIES, SENSORS, SINGLE};
use crate::prelude::*;
use crate::study::pair::Sides;

pub(super) fn tables(plan: &EverydayPlan, rows: &[Row]) -> Vec<Table> {
    let scene = &["scene", "triangles"][..];
    let worlds = [
        (BODIES, "Bodies on mesh terrains", &["triangles", "side", "edges", "shape"][..], Some(3)),
        (SINGLE, "Single bodies on a terrain, and many small meshes", scene, None),
        (DEFORMABLE, "Meshes with TriMeshFlags::all(), and robots on a terrain", scene, None),
        (SENSORS, "Mesh sensors, and Rapier's character controller", scene, None),
        (PILE, "Heads in a pile", &["scene"], None),
    ];
    let worlds = worlds.map(|(study, title, keys, total)| {
        let columns = [
            number("stock, µs", "detection.median").of("stock"),
            number("sbbk", "detection.median").of("sbbk"),
            faster("ratio", "detection.median", "stock").of("sbbk"),
            faster("whole step", "step.median", "stock").of("sbbk"),
            number("worst, stock", "detection.max").of("stock"),
            number("sbbk", "detection.max").of("sbbk"),
            number("verdict", "verdict").of("sbbk"),
            number("MiB, meshes", "mesh_mebibytes").of("sbbk"),
            number("plugin", "plugin_mebibytes").of("sbbk"),
            errors("wrong, stock", "judged").of("stock"),
            errors("sbbk", "judged").of("sbbk"),
        ];
        let title = format!("{title}: collision detection (narrow phase) of whole worlds");
        TableSpec::new(title, study, keys, columns)
            .total(total)
            .note(format!(
                "Rapier's defaults; microseconds a step: of each step the least over {} runs, both \
                 step by step in turn; ratio, whole step: stock : sbbk, of medians",
                plan.repeats
            ))
            .note(
                "wrong: missed + phantom + wrong depth, of the true contacts of up to 20 pairs, by \
                 brute force in f64; not with fixed edges",
            )
            .note(
                "ok: the median is no slower by 5 % or 1 µs, and the worst step by no more than 2 ms",
            )
    });
    let queries = TableSpec::new(
        "Single queries without a workspace on terrains; nanoseconds a query",
        QUERIES,
        &["body", "query", "place", "triangles"],
        [
            number("stock", "time.median").of("stock"),
            number("sbbk", "time.median").of("sbbk"),
            faster("ratio", "time.median", "stock").of("sbbk"),
            errors("lost + added + other", "answers").of("sbbk"),
            number("verdict", "verdict").of("sbbk"),
        ],
    )
    .total(2)
    .note(format!("median of {} repeats over up to 20 places, in turn", 2 * plan.repeats + 1))
    .note(
        "lost, added, other: answers that only stock has, only SBBK, and distances or times that \
         differ by more than 0.001; ok: no slower by 5 % or 50 ns",
    );
    let tables = worlds.into_iter().chain([queries]).map(|spec| spec.of(rows));
    tables.filter(|table| !table.lines.is_empty()).collect()
}

/// Main finding: ratios of the medians of worlds, and losses.
pub(super) fn verdict(rows: &[Row]) -> String {
    let worlds = Sides::of(rows, |row| row.study != QUERIES);
    let slower = worlds.sbbk().iter().filter(|row| !row.is("verdict", "ok")).count();
    let [stock, sbbk] = worlds.wrong("judged");
    format!(
        "in {} worlds collision detection is {:.2} times as fast as stock's and whole steps {:.2} \
         times (geometric means of medians; least {:.2}); {slower} worlds are slower than stock; \
         wrong contacts of those judged: SBBK {sbbk}, stock {stock}",
        worlds.sbbk().len(),
        worlds.ratio("detection.median"),
        worlds.ratio("step.median"),
        worlds.ratios("detection.median").fold(f64::INFINITY, f64::min),
    )
}
