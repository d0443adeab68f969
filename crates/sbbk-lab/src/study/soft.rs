//! Meshes that deform: soft monkey heads on a rigid helicopter, stock beside SBBK; what it costs to
//! refit a bare tree to one large mesh; and whether a pair of that mesh loses contacts.

use std::collections::BTreeSet;

use glamx::{Pose3, Quat, Vec3};
use rapier3d::geometry::SharedShape;
use rapier3d::parry::shape::TriMeshFlags;
use sbbk_core::tree::{LayerPlan, Tree};

use super::pair::{Contest, Memory};
use super::turns::{in_turn, timed};
use super::{Progress, StudyError, shape, tree};
use crate::backend::{Backend, SharedDispatcher};
use crate::mesh::{self, Mesh};
use crate::metrics::{Environment, ErrorCount, Judge, StepTimes, Summary, timed_step};
use crate::report::{
    ERROR_NOTE, Look, Panel, Results, Row, Scale, TIME_NOTE, Table, TableSpec, errors, faster,
    number, time,
};
use crate::scene::{Scene, SceneError, SoftHeads};

const HEADS: &str = "soft heads, ms";
const REFIT: &str = "refit, ms";
const CONTACTS: &str = "refit: contacts";

/// How much to measure.
#[derive(Clone, Copy, Debug)]
pub struct SoftPlan {
    /// Soft heads.
    pub heads: usize,
    /// Steps of each run.
    pub steps: usize,
    /// Timed runs of each backend.
    pub repeats: usize,
    /// Every so many steps of a run of its own are judged.
    pub judged_every: usize,
    /// Subdivision of the large ball: 8 times its square triangles.
    pub detail: u32,
    /// Frames through which the ball deforms; at least one.
    pub frames: usize,
}

impl SoftPlan {
    /// Within two minutes on two cores.
    pub fn standard() -> Self {
        Self { heads: 6, steps: 90, repeats: 3, judged_every: 10, detail: 112, frames: 500 }
    }

    /// Some seconds.
    pub fn quick() -> Self {
        Self { heads: 3, repeats: 1, judged_every: 15, detail: 35, frames: 50, ..Self::standard() }
    }
}

/// Measures both.
///
/// Errors: a mesh does not serve.
pub fn soft(plan: &SoftPlan, progress: &Progress) -> Result<Results, StudyError> {
    let scene = SoftHeads::with_heads(plan.heads);
    let mut rows = heads(&scene, plan, progress)?;
    rows.extend(refit(plan, progress)?);
    progress.finish();
    let panels = panels(&rows);
    let tables = tables(&rows, &scene, plan);
    Ok(Results { environment: Environment::detect(), rows, tables, panels })
}

/// Runs the scene under both backends. Times are means over the steps of a run.
fn heads(scene: &SoftHeads, plan: &SoftPlan, progress: &Progress) -> Result<Vec<Row>, SceneError> {
    let backends = Contest::BACKENDS;
    progress.phase(scene.name(), (plan.repeats + 1) * backends.len());
    let runs = in_turn(&backends, plan.repeats, |&backend| {
        progress.step();
        let mut built = scene.build()?;
        let installed = backend.install(&mut built.world);
        let step = |_| timed_step(&mut built.world, &installed.probe);
        Ok::<Vec<StepTimes>, SceneError>((0..plan.steps).map(step).collect())
    })?;
    let rows = backends.into_iter().zip(&runs).map(|(backend, runs)| {
        let errors = judged(scene, backend, plan)?;
        progress.step();
        let mean = |time: fn(&StepTimes) -> f64| {
            let total = |run: &Vec<StepTimes>| run.iter().map(time).sum::<f64>();
            Summary::of(runs.iter().map(|run| total(run) / run.len() as f64))
        };
        let in_step = |step: usize| Summary::of(runs.iter().map(|run| run[step].mesh_mesh));
        let by_step: Vec<f64> = (0..plan.steps).filter_map(in_step).map(|t| t.median).collect();
        Ok(Row::new(HEADS, backend)
            .key("scene", scene.name())
            .with("step", mean(|times| times.step))
            .with("queries", mean(|times| times.mesh_mesh))
            .with("queries_by_step", by_step)
            .with("calls", runs[0].iter().map(|times| times.mesh_mesh_calls).sum::<u64>())
            .with("errors", errors))
    });
    rows.collect()
}

/// The answers of some steps, judged by the vertices at the start of the step, where Rapier asks.
fn judged(scene: &SoftHeads, backend: Backend, plan: &SoftPlan) -> Result<ErrorCount, SceneError> {
    let mut built = scene.build()?;
    let installed = backend.install(&mut built.world);
    let mut errors = ErrorCount::default();
    for step in 1..=plan.steps {
        if !step.is_multiple_of(plan.judged_every) {
            built.world.step();
            continue;
        }
        let shapes = built.world.colliders.iter().map(|(_, collider)| collider.shared_shape());
        let judge = Judge::new(shapes);
        installed.probe.start_recording();
        built.world.step();
        for answer in installed.probe.take_answers() {
            errors += judge.truth(&answer.question).judge(&answer);
        }
    }
    Ok(errors)
}

/// What is timed in each frame.
const TIMED: [&str; 4] =
    ["parry, set_vertices", "refit of all layers", "refit of AABBs only", "build of all layers"];

/// A ball that deforms, and all that follows it.
struct Followed {
    ball: Mesh,
    all_layers: Tree,
    aabb_only: Tree,
    parry: SharedShape,
    torus: SharedShape,
    dispatcher: SharedDispatcher,
    memory: Memory,
}

/// Times of one frame, in milliseconds, and pairs of triangles that touch the torus.
struct Frame {
    times: [f64; 4],
    built: BTreeSet<(u32, u32)>,
    refitted: BTreeSet<(u32, u32)>,
}

fn refit(plan: &SoftPlan, progress: &Progress) -> Result<Vec<Row>, StudyError> {
    progress.phase("refits", plan.frames);
    let mut followed = Followed::new(mesh::ball(1.0, plan.detail))?;
    let frames = (0..plan.frames).map(|frame| {
        progress.step();
        followed.frame(frame)
    });
    let frames = frames.collect::<Result<Vec<Frame>, _>>()?;
    let triangle_count = followed.ball.triangle_count();
    let row = |study, name| Row::new(study, name).key("triangle_count", triangle_count);
    let mut rows: Vec<Row> = Vec::new();
    for (index, name) in TIMED.into_iter().enumerate() {
        let times: Vec<f64> = frames.iter().map(|frame| frame.times[index]).collect();
        rows.push(
            row(REFIT, name).with("time", Summary::of(times.clone())).with("by_frame", times),
        );
    }
    type Count = fn(&Frame) -> usize;
    let kinds: [(&str, Count); 4] = [
        ("tree built in each frame", |frame| frame.built.len()),
        ("refitted tree", |frame| frame.refitted.len()),
        ("lost", |frame| frame.built.difference(&frame.refitted).count()),
        ("added", |frame| frame.refitted.difference(&frame.built).count()),
    ];
    for (name, count) in kinds {
        let counts: Vec<usize> = frames.iter().map(count).collect();
        let row = row(CONTACTS, name).with("contacts", counts.iter().sum::<usize>());
        rows.push(row.with("by_frame", counts));
    }
    Ok(rows)
}

impl Followed {
    fn new(ball: Mesh) -> Result<Self, StudyError> {
        let deformable = ball.trimesh(TriMeshFlags::DEFORMABLE);
        let named = |cause| SceneError { mesh: ball.name.clone(), cause };
        Ok(Self {
            all_layers: tree(&ball, LayerPlan::SBBK)?,
            aabb_only: tree(&ball, LayerPlan::AABB_ONLY)?,
            parry: SharedShape::new(deformable.map_err(named)?),
            torus: shape(&mesh::torus(1.0, 0.4, 24, 12))?,
            dispatcher: Backend::Sbbk.dispatcher().shared,
            memory: Memory::default(),
            ball,
        })
    }

    fn frame(&mut self, frame: usize) -> Result<Frame, StudyError> {
        let ball = Mesh { vertices: deformed(&self.ball.vertices, frame), ..self.ball.clone() };
        let refit = |tree: &mut Tree| {
            let (time, refitted) = timed(|| tree.refit(&ball.vertices, &ball.triangles));
            refitted.map_err(|cause| StudyError::Tree { mesh: ball.name.clone(), cause })?;
            Ok::<_, StudyError>(time)
        };
        let all_layers = refit(&mut self.all_layers)?;
        let aabb_only = refit(&mut self.aabb_only)?;
        let soft = self.parry.make_mut().as_trimesh_mut().expect("made of a mesh");
        let (parry, ()) = timed(|| soft.set_vertices(&ball.vertices));
        let (build, built) = timed(|| tree(&ball, LayerPlan::SBBK));
        drop(built?);
        let copy = soft.clone();
        let times = [parry, all_layers, aabb_only, build].map(|time| 1e3 * time.as_secs_f64());

        let pos12 = Pose3::from_parts(Vec3::new(1.5, 0.4, 0.2), Quat::from_rotation_x(1.0));
        let mut fresh = Memory::default();
        self.memory.ask(&self.dispatcher, [&*self.parry, &*self.torus], &pos12, 0.02);
        fresh.ask(&Backend::Sbbk.dispatcher().shared, [&copy, &*self.torus], &pos12, 0.02);
        let [refitted, built] = [&self.memory, &fresh].map(|memory| {
            let pairs = memory.manifolds.iter();
            pairs.map(|manifold| (manifold.subshape1, manifold.subshape2)).collect()
        });
        Ok(Frame { times, built, refitted })
    }
}

/// Waves that wander over the ball.
fn deformed(rest: &[Vec3], frame: usize) -> Vec<Vec3> {
    let phase = 0.05 * frame as f32;
    let wave = |v: &Vec3| (4.0 * v.x + phase).sin() * (3.0 * v.y - 2.0 * phase).cos();
    rest.iter().map(|v| *v * (1.0 + 0.15 * wave(v)) + Vec3::Z * (0.2 * (2.0 * v.x).sin())).collect()
}

fn tables(rows: &[Row], scene: &SoftHeads, plan: &SoftPlan) -> Vec<Table> {
    let heads = TableSpec {
        title: format!("{}; milliseconds a step", scene.name()),
        study: HEADS,
        keys: &["backend"],
        total: None,
        columns: vec![
            time("step", "step"),
            faster("ratio", "step.min", Backend::Stock),
            time("queries", "queries"),
            faster("ratio", "queries.min", Backend::Stock),
            number("calls", "calls"),
            errors("errors", "errors"),
        ],
        notes: vec![
            "heads are Rapier's soft bodies, which deform their meshes in each step; queries: of \
             heads and helicopter, refits included; heads against heads are not a dispatcher's"
                .to_owned(),
            TIME_NOTE.to_owned(),
            ERROR_NOTE.to_owned(),
        ],
    };
    let slower = |header, base| faster(header, "time.min", base).inverse();
    let refit = TableSpec {
        title: format!("Refit of a mesh over {} frames; milliseconds", plan.frames),
        study: REFIT,
        keys: &["triangle_count", "backend"],
        total: None,
        columns: vec![
            time("time", "time"),
            number("longest", "time.max"),
            slower("to boxes only", TIMED[2]),
            slower("to parry", TIMED[0]),
        ],
        notes: vec!["times: min / median over the frames, in turn; ratios: of minima".to_owned()],
    };
    let contacts = TableSpec {
        title: "Contacts of this mesh with a torus, over all frames".to_owned(),
        study: CONTACTS,
        keys: &["backend"],
        total: None,
        columns: vec![number("pairs of triangles", "contacts")],
        notes: vec!["lost, added: by the refitted tree".to_owned()],
    };
    [heads, refit, contacts].map(|spec| spec.of(rows)).into()
}

/// Time of the queries of soft heads, time of refits, and contacts of the refitted mesh.
fn panels(rows: &[Row]) -> Vec<Panel> {
    let panel = |title: &str, labels, study, values: &'static str, sum_up: fn(&Summary) -> f64| {
        let rows = rows.iter().filter(|row| row.study == study);
        let rows = rows.filter(|row| row.backend != TIMED[3]).zip(LOOKS);
        // The first one is on top: black squares leave blue circles to be seen.
        let rows = rows.collect::<Vec<_>>().into_iter().rev();
        rows.fold(Panel::new(title, labels, Scale::Linear), |panel, (row, look)| {
            let values = row.get(values).and_then(|values| values.as_array());
            let values = values.into_iter().flatten().filter_map(|value| value.as_f64());
            panel.line(&row.backend, look, curve(&values.collect::<Vec<_>>(), sum_up))
        })
    };
    const LOOKS: [Look; 4] = [Look::ALL[0], Look::ALL[2], Look::ALL[1], Look::ALL[3]];
    vec![
        panel(
            "Soft heads fall on a helicopter",
            ["step", "ms a step in queries, refits included"],
            HEADS,
            "queries_by_step",
            |times| times.median,
        ),
        // Frames differ little; the longest are other programs'.
        panel("A mesh deforms", ["frame", "ms a frame"], REFIT, "by_frame", |times| times.min),
        panel(
            "Contacts of this mesh with a torus",
            ["frame", "pairs of triangles"],
            CONTACTS,
            "by_frame",
            |counts| counts.median,
        ),
    ]
}

/// Values by their index, a few at a time, so that the markers of several curves can be told apart.
fn curve(values: &[f64], sum_up: fn(&Summary) -> f64) -> impl Iterator<Item = [f64; 2]> {
    const MARKER_COUNT: usize = 18;
    let length = values.len().div_ceil(MARKER_COUNT).max(1);
    values.chunks(length).enumerate().filter_map(move |(chunk, values)| {
        let middle = (chunk * length) as f64 + 0.5 * (values.len() - 1) as f64;
        Some([middle, sum_up(&Summary::of(values.iter().copied())?)])
    })
}
