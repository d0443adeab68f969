//! Tables and a picture of everyday scenes.

use rapier3d::dynamics::IntegrationParameters;

use super::{BODIES, DEFORMABLE, EverydayPlan, PILE, QUERIES, SENSORS, SINGLE};
use crate::backend::Backend;
use crate::report::{Column, Look, Panel, Row, Scale, Table, TableSpec, errors, faster, number};

pub(super) fn tables(plan: &EverydayPlan, rows: &[Row]) -> Vec<Table> {
    let worlds = [
        (BODIES, "Bodies on mesh terrains", &["triangles", "side", "edges", "shape"][..], Some(3)),
        (SINGLE, "Single bodies on a terrain, and many small meshes", &SCENE, None),
        (
            DEFORMABLE,
            "All meshes with TriMeshFlags::all(), and robots on a plain terrain",
            &SCENE,
            None,
        ),
        (SENSORS, "Mesh sensors, and Rapier's character controller", &SCENE, None),
        (PILE, "Heads in a pile", &["scene"], None),
    ];
    let worlds = worlds.map(|(study, title, keys, total)| {
        TableSpec::new(
            format!("{title}: collision detection (narrow phase) of whole worlds"),
            study,
            keys,
            world_columns(study == BODIES),
        )
        .total(total)
        .notes(world_notes(plan))
    });
    let queries = TableSpec::new(
        "Single queries without a workspace on terrains; nanoseconds a query",
        QUERIES,
        &["body", "query", "place", "triangles"],
        [
            number("stock", "time.median").of("stock"),
            number("sbbk", "time.median").of("sbbk"),
            faster("ratio", "time.median", Backend::Stock).of("sbbk"),
            number("first, stock", "first").of("stock"),
            number("first, sbbk", "first").of("sbbk"),
            errors("lost + added + other", "answers").of("sbbk"),
            number("verdict", "verdict").of("sbbk"),
        ],
    )
    .total(2)
    .note(format!("median of {} repeats over up to 20 places, both in turn", 2 * plan.repeats + 1))
    .note(
        "first: the first query of a dispatcher; ok: no slower by 5 % or 50 ns, and the first \
             by no more than 2 ms",
    )
    .note(
        "lost, added, other: answers that only stock has, only SBBK, and distances or times \
             that differ by more than 0.001, of all",
    );
    let tables = worlds.into_iter().chain([queries]).map(|spec| spec.of(rows));
    tables.filter(|table| !table.lines.is_empty()).collect()
}

const SCENE: [&str; 2] = ["scene", "triangles"];

fn world_columns(counts_bodies: bool) -> Vec<Column> {
    let bodies = counts_bodies.then(|| number("bodies", "bodies").of("sbbk"));
    let columns = [
        number("stock, µs", "detection.median").of("stock"),
        number("sbbk", "detection.median").of("sbbk"),
        faster("ratio", "detection.median", Backend::Stock).of("sbbk"),
        number("p99, stock", "detection.p99").of("stock"),
        number("sbbk", "detection.p99").of("sbbk"),
        number("worst, stock", "detection.max").of("stock"),
        number("sbbk", "detection.max").of("sbbk"),
        number("bad", "bad_steps").of("sbbk"),
        faster("whole step", "step.median", Backend::Stock).of("sbbk"),
        number("mesh, MiB", "mesh_mebibytes").of("sbbk"),
        number("plugin", "plugin_mebibytes").of("sbbk"),
        errors("pairs", "pairs").of("sbbk"),
        errors("triangles", "triangles_of_pairs").of("sbbk"),
        errors("wrong, stock", "judged").of("stock"),
        errors("sbbk", "judged").of("sbbk"),
        number("verdict", "verdict").of("sbbk"),
    ];
    bodies.into_iter().chain(columns).collect()
}

fn world_notes(plan: &EverydayPlan) -> Vec<String> {
    let parameters = IntegrationParameters::default();
    vec![
        format!(
            "time step 1/{:.0} s, length unit {}, prediction distance {} units; microseconds a \
             step: of each step the least over {} runs, both step by step in turn",
            1.0 / parameters.dt,
            parameters.length_unit,
            parameters.prediction_distance(),
            plan.repeats
        ),
        "bad: steps that took 2 ms more than stock's worst".to_owned(),
        "ratio, whole step: stock : sbbk, of medians; mesh: Parry's memory of all meshes; plugin: \
         what SBBK keeps beside it"
            .to_owned(),
        "pairs, triangles: contacts lost + added + at another distance, of stock's, at the same \
         poses, nothing known of the pair; bands: 5 % of the prediction distance"
            .to_owned(),
        "wrong: missed + phantom + wrong depth by brute force in f64, of the first 20 pairs about \
         which they differ; not with fixed edges"
            .to_owned(),
        "ok: the median is no slower by 5 % or 1 µs, and the worst step by no more than 2 ms"
            .to_owned(),
    ]
}

pub(super) fn panels(rows: &[Row]) -> Vec<Panel> {
    let groups = [BODIES, SINGLE, DEFORMABLE, SENSORS, PILE];
    let labels = ["µs a step, stock", "stock : sbbk"];
    let ratios = Panel::new("Collision detection, medians", labels, Scale::Logarithmic);
    let labels = ["worst step of stock, µs", "worst step of sbbk, µs"];
    let worst = Panel::new("Worst steps", labels, Scale::Logarithmic);
    let [mut ratios, mut worst] = [ratios, worst];
    for (study, look) in groups.into_iter().zip(Look::ALL) {
        let pairs = sides(rows, study);
        let label = study.trim_start_matches("everyday: ");
        let ratio = |[stock, sbbk]: [&Row; 2]| {
            let [stock, sbbk] = [stock, sbbk].map(|row| row.number("detection.median"));
            [stock, stock / sbbk]
        };
        ratios = ratios.points(label, look, pairs.iter().copied().map(ratio));
        let worsts = |sides: [&Row; 2]| sides.map(|row| row.number("detection.max"));
        worst = worst.points(label, look, pairs.into_iter().map(worsts));
    }
    let equal =
        worst.line("as long", Look::ALL[5], [1e2, 1e3, 1e4].map(|time| [time; 2]).into_iter());
    vec![ratios, equal, queries(rows, "ball"), queries(rows, "head")]
}

fn queries(rows: &[Row], body: &str) -> Panel {
    let title = format!("Queries of a {body}, no workspace");
    let panel = Panel::new(title, ["ns a query, stock", "stock : sbbk"], Scale::Logarithmic);
    let pairs = sides(rows, QUERIES);
    let mut names: Vec<&str> = Vec::new();
    for [stock, _] in &pairs {
        let name = stock.get("query").and_then(|name| name.as_str()).unwrap_or_default();
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.into_iter().zip(Look::ALL).fold(panel, |panel, (name, look)| {
        let pairs = pairs.iter().filter(|[row, _]| row.is("query", name) && row.is("body", body));
        let point = |pair: &[&Row; 2]| {
            let [stock, sbbk] = pair.map(|row| row.number("time.median"));
            [stock, stock / sbbk]
        };
        panel.points(name, look, pairs.map(point))
    })
}

/// Stock's and SBBK's rows of the same scenes.
fn sides<'a>(rows: &'a [Row], study: &str) -> Vec<[&'a Row; 2]> {
    let of = |backend: Backend| {
        rows.iter().filter(move |row| row.study == study && row.is("backend", backend))
    };
    of(Backend::Stock).zip(of(Backend::Sbbk)).map(|(stock, sbbk)| [stock, sbbk]).collect()
}
