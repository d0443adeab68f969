//! One mesh at a time: what its tree costs, and what first queries cost with and without it.

use std::time::Duration;

use super::contacts::places;
use super::motion::Mode;
use super::pair::{Contest, query_count};
use super::turns::{race, timed};
use super::{Progress, shape, tree};
use crate::mesh::Mesh;
use crate::metrics::{Sequence, Summary, ratio};
use crate::report::{
    ERROR_NOTE, Panel, Row, Scale, TIME_NOTE, Table, TableSpec, errors, faster, number, time,
};

const MESHES: &str = "trees and first queries";
/// The prediction distance of the queries: Rapier's default.
const PREDICTION: f32 = 0.02;
/// Least and greatest number of approaches of five poses each. Large meshes, whose queries take
/// long, get the least.
const APPROACHES: [usize; 2] = [1, 3];
/// Least and greatest number of repeats.
const REPEATS: [usize; 2] = [3, 25];
/// Triangles in all approaches, or all repeats, together.
const TRIANGLES: usize = 100_000;

/// Measures each mesh, scaled to two units, against itself. Builds are in milliseconds, queries in
/// µs.
pub(super) fn meshes(meshes: &[Mesh], progress: &Progress) -> Vec<Row> {
    progress.phase("trees and first queries", meshes.len());
    let mut rows = Vec::new();
    for mesh in meshes {
        rows.extend(measure(&mesh.clone().centred().scaled_to(2.0)));
        progress.step();
    }
    rows
}

fn measure(mesh: &Mesh) -> [Row; 2] {
    let count =
        |[least, most]: [usize; 2]| (TRIANGLES / mesh.triangle_count().max(1)).clamp(least, most);
    let shape = shape(mesh);
    let bytes = [
        shape.as_trimesh().map_or(0, |mesh| mesh.bvh().total_memory_size()),
        tree(mesh, None).stats().bytes(),
    ];
    let builds: [&dyn Fn() -> Duration; 2] =
        [&|| timed(|| mesh.shared_shape()).0, &|| timed(|| tree(mesh, None)).0];
    let builds = race(&builds, count(REPEATS), 1e3, |build| build());
    let contest = Contest::new([&shape]);
    let places = (0..count(APPROACHES) as u64)
        .flat_map(|seed| places(&contest, &shape, 2.0, PREDICTION, seed));
    let sequence = |place| Mode::Fresh.sequence([&shape; 2], &place, PREDICTION);
    let sequences: Vec<Sequence> = places.map(sequence).collect();
    let queries = contest.race(count(REPEATS), &sequences);
    let errors = contest.mesh_errors(&sequences, |_| true).map(|errors| errors.pairs);
    // First queries after which the time they save has paid for the tree.
    let saved = queries[0].median - queries[1].median;
    let paid = |build: &Summary| ratio(1e3 * build.median, saved).filter(|count| *count > 0.0);
    let break_even = [None, paid(&builds[1])];
    [0, 1].map(|side| {
        Row::new(MESHES, Contest::BACKENDS[side])
            .key("mesh", &*mesh.name)
            .key("triangle_count", mesh.triangle_count())
            .with("build", builds[side])
            .with("bytes", bytes[side])
            .with("kibibytes", bytes[side] as f64 / 1024.0)
            .with("pose_count", query_count(&sequences) as usize)
            .with("time", queries[side])
            .with("break_even", break_even[side].map(|count| count.ceil() as u64))
            .with("errors", errors[side])
    })
}

/// Build time, memory, first queries and break-even.
pub(super) fn table(rows: &[Row]) -> Table {
    TableSpec::new(
        "Trees and first queries: each mesh against itself, 2 units across",
        MESHES,
        &["mesh", "triangle_count"],
        [
            time("parry build, ms", "build").of("stock"),
            time("sbbk build, ms", "build").of("sbbk"),
            number("parry KiB", "kibibytes").of("stock"),
            number("sbbk KiB", "kibibytes").of("sbbk"),
            number("poses", "pose_count").of("sbbk"),
            time("stock, µs", "time").of("stock"),
            time("sbbk, µs", "time").of("sbbk"),
            faster("ratio", "time.median", "stock").of("sbbk"),
            number("break-even queries", "break_even").of("sbbk"),
            errors("errors, stock", "errors").of("stock"),
            errors("errors, sbbk", "errors").of("sbbk"),
        ],
    )
    .note("the SBBK tree comes on top of Parry's; its leaves hold the triangles")
    .note("break-even: first queries whose saved time pays for the tree")
    .note(TIME_NOTE)
    .note(ERROR_NOTE)
    .of(rows)
}

/// Time against error of first queries, for each true pair of triangles.
pub(super) fn panel(rows: &[Row]) -> Panel {
    let labels = ["µs for each true triangle pair", "wrong triangle pairs for 100 true ones"];
    let point = |row: &Row| {
        let time = row.number("time.median") * row.number("pose_count");
        Some([time / row.number("errors.true_pairs"), 100.0 * row.error_share("errors")?])
    };
    let rows = rows.iter().filter(|row| row.study == MESHES);
    let panel = Panel::new("Time against error, first queries", labels, Scale::Linear);
    panel.backends(&Contest::BACKENDS, rows, false, point)
}
