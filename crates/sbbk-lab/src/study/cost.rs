//! How cost grows: time of collision detection against the number of bodies, and against triangles
//! a mesh, with the exponents of power laws through them.

use super::Progress;
use super::pile::{PilePlan, pile};
use crate::backend::Backend;
use crate::mesh;
use crate::metrics::{RunPlan, power_law};
use crate::report::{Look, Panel, Results, Row, Scale, Table, TableSpec, faster, number, time};
use crate::scene::MonkeyPile;

const COST: &str = "cost";
const EXPONENTS: &str = "cost: exponents";
/// What grows.
const AXES: [&str; 2] = ["bodies", "triangles a mesh"];

/// What to run.
#[derive(Clone, Debug)]
pub struct CostPlan {
    /// Who answers.
    pub backends: Vec<Backend>,
    /// Sizes of piles of the usual head.
    pub heads: Vec<usize>,
    /// Heads of other resolutions: see [`mesh::monkey_head_with`].
    pub details: Vec<u32>,
    /// How many of them.
    pub few: usize,
    /// Steps after the free fall.
    pub steps: usize,
}

impl CostPlan {
    /// 100 to 5000 bodies, and 512 to 500,000 triangles.
    pub fn standard() -> Self {
        Self {
            backends: vec![Backend::Stock, Backend::Sbbk],
            heads: vec![100, 200, 500, 1000, 2000, 5000],
            details: vec![8, 16, 35, 79, 158, 250],
            few: 20,
            steps: 43,
        }
    }

    /// Fewer and smaller ones: for trying, not for quoting.
    pub fn quick() -> Self {
        Self { heads: vec![50, 100, 200], details: vec![8, 16, 35], ..Self::standard() }
    }
}

/// Runs all the piles.
pub fn cost(plan: &CostPlan, progress: &Progress) -> Results {
    let heads = plan.heads.iter().map(|&heads| (AXES[0], heads, MonkeyPile::with_heads(heads)));
    let fine = plan.details.iter().map(|&detail| {
        let scene = MonkeyPile::of(plan.few, mesh::monkey_head_with(detail));
        (AXES[1], scene.mesh.triangle_count(), scene)
    });
    let mut rows = Vec::new();
    for (axis, count, scene) in heads.chain(fine) {
        let run = RunPlan {
            warm_up: PilePlan::FREE_FALL,
            steps: plan.steps,
            query_stride: PilePlan::QUERY_STRIDE,
            ..RunPlan::default()
        };
        let backends = plan.backends.clone();
        let pile_plan = PilePlan { backends, repeats: 1, run, same_poses: None };
        let found = pile(&scene, &pile_plan, progress);
        rows.extend(found.into_iter().map(|found| {
            let row = Row::new(COST, found.backend.clone()).key("growing", axis);
            let row = row.key("count", count);
            ["collision_detection", "solver", "step"]
                .into_iter()
                .fold(row, |row, name| row.with(name, found.get(name)))
        }));
    }
    progress.finish();
    let exponents = AXES.iter().flat_map(|&axis| {
        let rows = &rows;
        plan.backends.iter().map(move |backend| {
            let law = |path| power_law(points(rows, axis, *backend, path));
            Row::new(EXPONENTS, backend)
                .key("growing", axis)
                .with("collision_detection", law("collision_detection.median"))
                .with("step", law("step.median"))
        })
    });
    let exponents: Vec<Row> = exponents.collect();
    let tables = vec![table(plan, &rows), exponent_table(&exponents)];
    let panels = AXES.map(|axis| panel(plan, &rows, axis)).into();
    rows.extend(exponents);
    Results::new(rows, tables, panels)
}

fn points(rows: &[Row], axis: &str, backend: Backend, path: &str) -> Vec<[f64; 2]> {
    let rows = rows.iter().filter(|row| row.is("growing", axis) && row.is("backend", backend));
    rows.map(|row| [row.number("count"), row.number(path)]).collect()
}

fn table(plan: &CostPlan, rows: &[Row]) -> Table {
    let spec = TableSpec::new(
        "Cost: milliseconds a step",
        COST,
        &["growing", "count", "backend"],
        [
            time("broad + narrow", "collision_detection"),
            faster("vs stock", "collision_detection.median", Backend::Stock),
            time("solver", "solver"),
            time("step", "step"),
        ],
    )
    .note(format!(
        "means of the {} steps after the first heads land; triangles a mesh: {} heads; all with \
             trees",
        plan.steps, plan.few
    ));
    spec.of(rows)
}

fn exponent_table(rows: &[Row]) -> Table {
    let spec = TableSpec::new(
        "Exponents of power laws through these times",
        EXPONENTS,
        &["growing", "backend"],
        [number("broad + narrow", "collision_detection"), number("step", "step")],
    )
    .note("least squares over logarithms");
    spec.of(rows)
}

fn panel(plan: &CostPlan, rows: &[Row], axis: &'static str) -> Panel {
    let labels = [axis, "broad + narrow phase, ms a step"];
    let panel = Panel::new(format!("Cost against {axis}"), labels, Scale::Logarithmic);
    plan.backends.iter().fold(panel, |panel, &backend| {
        let points = points(rows, axis, backend, "collision_detection.median");
        let law = power_law(points.iter().copied());
        let label = law.map_or_else(String::new, |k| format!(": count^{k:.2}"));
        panel.line(&format!("{backend}{label}"), Look::of(backend), points.into_iter())
    })
}
