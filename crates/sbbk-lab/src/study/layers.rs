//! Which layers of a tree should be boxes and which k-DOPs: fixed plans beside the one that the build
//! chooses, on pairs of meshes of different kinds; what it chooses, why, and what the choice takes.
//!
//! Bare trees list all contacts of triangles at a pose, with every kind of k-DOP and size of leaf; the
//! dispatcher, which has 18-DOPs and leaves of four triangles, is asked as a user asks it.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;

use glamx::{Quat, Vec2, Vec3};
use oorandom::Rand32;
use rapier_integration::{SbbkConfig, SbbkDispatcher};
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use sbbk_core::query::{SearchScratch, contacts};
use sbbk_core::traverse::Placement;
use sbbk_core::tree::{BATCH, BuildOptions, LayerPlan, Tree};

use super::motion::{Approach, Mode, Place, mode_notes};
use super::pair::{Contest, query_count, sweep};
use super::turns::{race, timed};
use super::{Progress, shape};
use crate::backend::SharedDispatcher;
use crate::mesh::{self, Mesh, Thread};
use crate::metrics::Sequence;
use crate::report::{Results, Row, Table, TableSpec, faster, number};

const BARE: &str = "layers: bare trees";
const DISPATCHER: &str = "layers: dispatcher";
const CHOICE: &str = "layers: choice";
/// Rapier's default.
const PREDICTION: Real = 0.02;
/// How far the second mesh goes beyond the first touch, in units; negative: short of it.
const ADVANCES: [Real; 4] = [-0.95 * PREDICTION, -0.5 * PREDICTION, 0.0, PREDICTION];

/// The plan that is chosen for each mesh.
const CHOSEN: &str = "chosen";
/// The others are compared with the first.
const PLANS: [(&str, Option<LayerPlan>); 7] = [
    (CHOSEN, None),
    ("from 4", Some(LayerPlan::SBBK)),
    ("boxes", Some(LayerPlan::AABB_ONLY)),
    ("sphere, boxes", Some(LayerPlan { sphere_root: true, kdop_from_depth: None })),
    ("from 1", Some(LayerPlan { sphere_root: true, kdop_from_depth: Some(1) })),
    ("from 6", Some(LayerPlan { sphere_root: true, kdop_from_depth: Some(6) })),
    ("from 8", Some(LayerPlan { sphere_root: true, kdop_from_depth: Some(8) })),
];
/// What bare trees can besides. The last two are the paper's AABB trees: boxes of both along the axes of
/// one frame, for which those of the second mesh must be fitted anew when it moves.
const OTHERS: [&str; 1] = ["leaves of 2"];

const LEAST: &str = "times: means over the poses of the least time at each; plans take turns there";

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct LayersPlan {
    /// Pairs of meshes.
    pub pairs: Vec<[Mesh; 2]>,
    /// Approaches of each pair, with four poses each.
    pub approach_count: usize,
    /// How often everything is timed.
    pub repeats: usize,
}

impl LayersPlan {
    /// Seventeen pairs of meshes of 48 to 20,000 triangles, 32 poses each; about four minutes.
    pub fn standard() -> Self {
        let own = |mesh: Mesh| [(); 2].map(|()| mesh.clone().centred().scaled_to(2.0));
        let head = || mesh::monkey_head_with(11);
        let under = |mesh: Mesh, small: Mesh| {
            [mesh.centred().scaled_to(4.0), small.centred().scaled_to(0.5)]
        };
        let cuboid = || mesh::cuboid(Vec3::ONE, 5);
        let turn = Quat::from_rotation_y(0.4) * Quat::from_rotation_x(0.3);
        let turned = |mesh: Mesh| mesh.mapped(|vertex| turn * vertex);
        let floor = || mesh::floor(2.0, 70);
        let cylinder = mesh::revolved(&[Vec2::new(-1.0, 0.5), Vec2::new(1.0, 0.5)], 24);
        let thread = Thread { segments: 96, ..Thread::BOLT };
        let pairs = vec![
            own(mesh::torus(0.7, 0.3, 8, 6)),
            own(cuboid()),
            own(mesh::ball(1.0, 8)),
            own(head()),
            own(mesh::monkey_head_with(3)),
            own(turned(cuboid()).named("turned cuboid")),
            own(turned(cylinder).named("turned cylinder")),
            own(mesh::slab(Vec3::new(1.0, 0.03, 0.03), [40, 2, 2]).named("rod")),
            own(mesh::helicopter()),
            own(thread.bolt().named("bolt")),
            own(soup(5000)),
            own(mesh::monkey_head_with(23)),
            under(mesh::hills(40.0, 100), head()),
            under(floor(), head()),
            under(floor(), cuboid()),
            under(turned(floor()).named("turned floor"), head()),
            under(city(), head()),
        ];
        Self { pairs, approach_count: 8, repeats: 15 }
    }

    /// The first four pairs, two approaches each: for trying, not for quoting.
    pub fn quick() -> Self {
        let mut standard = Self::standard();
        standard.pairs.truncate(4);
        Self { approach_count: 2, repeats: 5, ..standard }
    }
}

/// Blocks of five heights along the axes, in rows.
fn city() -> Mesh {
    let block = |i: u32| {
        let half_extents = Vec3::new(0.3, 0.3 + 0.1 * (7 * i % 5) as f32, 0.3);
        let place = Vec3::new((i % 8) as f32, half_extents.y, (i / 8) as f32);
        mesh::cuboid(half_extents, 3).mapped(|vertex| vertex + place)
    };
    Mesh::merged("city", &(0..64).map(block).collect::<Vec<_>>())
}

/// Triangles at random in a cube, each by itself.
fn soup(count: usize) -> Mesh {
    let mut random = Rand32::new(7);
    let mut point = || Vec3::from([(); 3].map(|()| 2.0 * random.rand_float() - 1.0));
    let corners = (0..count).flat_map(|_| {
        let centre = point();
        [(); 3].map(|()| centre + 0.08 * point())
    });
    let vertices: Vec<Vec3> = corners.collect();
    let triangles = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh::new("soup", vertices, triangles)
}

/// Measures all that `plan` asks for.
pub fn layers(plan: &LayersPlan, progress: &Progress) -> Results {
    progress.phase("layers", plan.pairs.len());
    let mut rows = Vec::new();
    for meshes in &plan.pairs {
        let case = Case::new(meshes, plan);
        rows.extend(case.bare(plan.repeats));
        rows.extend(case.dispatcher(plan.repeats));
        for row in meshes.each_ref().map(|mesh| choice(mesh, plan.repeats)) {
            let is_same = |known: &Row| known.study == row.study && known.keys == row.keys;
            if !rows.iter().any(is_same) {
                rows.push(row);
            }
        }
        progress.step();
    }
    progress.finish();
    let tables = tables(&rows);
    Results::new(rows, tables, Vec::new())
}

struct Case<'a> {
    meshes: &'a [Mesh; 2],
    shapes: [SharedShape; 2],
    /// A place of each approach and advance.
    places: Vec<Place>,
}

/// Asks at a place, and takes the time.
type Ask<'a> = Box<dyn Fn(usize) -> Duration + 'a>;

impl<'a> Case<'a> {
    fn new(meshes: &'a [Mesh; 2], plan: &LayersPlan) -> Self {
        let shapes = [shape(&meshes[0]), shape(&meshes[1])];
        let contest = Contest::new(&shapes);
        let approaches = (0..plan.approach_count as u64).map(|seed| {
            Approach::random(contest.sbbk(), shapes.each_ref(), &mut Rand32::new(seed))
        });
        let places = approaches.flat_map(|approach| ADVANCES.map(|way| approach.place(way)));
        Self { meshes, places: places.collect(), shapes }
    }

    fn row(&self, study: &'static str, mode: Mode, plan: &str) -> Row {
        let [one, two] = self.meshes;
        let beside = if one.name == two.name { "itself" } else { &two.name };
        Row::new(study, plan)
            .key("mode", mode.to_string())
            .key("mesh", &*one.name)
            .key("triangle_count", one.triangle_count())
            .key("beside", beside)
    }

    /// First queries of bare trees.
    fn bare(&self, repeats: usize) -> impl Iterator<Item = Row> {
        let options = |layers| BuildOptions { layers, leaf_size: BATCH };
        let default = options(None);
        let mut asks = Vec::new();
        for (_, layers) in PLANS {
            asks.push(self.ask(options(layers)));
        }
        asks.push(self.ask(BuildOptions { leaf_size: 2, ..default }));
        let times = self.fastest(&asks, repeats, 1.0, |ask, place| ask(place));
        let names = PLANS.map(|(name, _)| name).into_iter().chain(OTHERS);
        let rows = names
            .zip(times)
            .map(|(name, time)| self.row(BARE, Mode::Fresh, name).with("time", time));
        rows.collect::<Vec<_>>().into_iter()
    }

    fn ask(&self, options: BuildOptions) -> Ask<'_> {
        let trees = [self.tree(0, options), self.tree(1, options)];
        Box::new(move |place| {
            contacts_of([&trees[0], &trees[1]], Placement::new(&self.places[place].pos12))
        })
    }

    fn tree(&self, index: usize, options: BuildOptions) -> Tree {
        build(&self.meshes[index], &options)
    }

    /// All modes of the dispatcher.
    fn dispatcher(&self, repeats: usize) -> Vec<Row> {
        let dispatchers = PLANS.map(|(_, layers)| {
            let mut config = SbbkConfig::default();
            config.layers = layers;
            SbbkDispatcher::new(config)
        });
        let prepare = |dispatcher: &SbbkDispatcher| {
            self.shapes.each_ref().map(|shape| dispatcher.prepare_shape(shape))
        };
        let _primed = dispatchers.each_ref().map(prepare);
        let shared = dispatchers.map(|dispatcher| -> SharedDispatcher { Arc::new(dispatcher) });
        let rows = Mode::ALL.into_iter().flat_map(|mode| {
            let sequence = |place| mode.sequence(self.shapes.each_ref(), place, PREDICTION);
            let sequences: Vec<Sequence> = self.places.iter().map(sequence).collect();
            let queries = query_count(&sequences[..1]);
            let times = self.fastest(&shared, repeats, queries, |dispatcher, place| {
                sweep(dispatcher, &sequences[place..=place])
            });
            let rows = PLANS.iter().zip(times);
            let rows =
                rows.map(|((name, _), time)| self.row(DISPATCHER, mode, name).with("time", time));
            rows.collect::<Vec<_>>()
        });
        rows.collect()
    }

    /// Microseconds a query of each contestant, of `queries` at a place: the least time of all repeats at
    /// each place, and of these the mean. Contestants take turns at each place, and each is asked twice,
    /// so that none pays for what another has put into the caches.
    fn fastest<C>(
        &self,
        contestants: &[C],
        repeats: usize,
        queries: f64,
        ask: impl Fn(&C, usize) -> Duration,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; contestants.len()];
        for place in 0..self.places.len() {
            let times = race(contestants, repeats, 1e6 / queries, |contestant| {
                ask(contestant, place);
                ask(contestant, place)
            });
            for (sum, time) in sums.iter_mut().zip(times) {
                *sum += time.min / self.places.len() as f64;
            }
        }
        sums
    }
}

fn build(mesh: &Mesh, options: &BuildOptions) -> Tree {
    Tree::build(&mesh.vertices, &mesh.triangles, options).expect("meshes of the studies are sound")
}

/// What a build chooses, and how much longer than one that is told so it takes.
fn choice(mesh: &Mesh, repeats: usize) -> Row {
    let chosen = *build(mesh, &BuildOptions::default()).stats();
    let plans = [None, Some(chosen.layers)];
    let times = race(&plans, repeats.max(1), 1e6, |layers| {
        let options = BuildOptions { layers: *layers, ..BuildOptions::default() };
        timed(|| black_box(build(mesh, &options))).0
    });
    Row::new(CHOICE, CHOSEN)
        .key("mesh", &*mesh.name)
        .key("triangle_count", mesh.triangle_count())
        .with("kdop_from_depth", chosen.layers.kdop_from_depth)
        .with("kdop_cut", chosen.kdop_cut)
        .with("build", times[0].min)
        .with("share", 100.0 * (1.0 - times[1].min / times[0].min))
}

/// The time of all contacts of triangles.
fn contacts_of([tree1, tree2]: [&Tree; 2], placement: Placement) -> Duration {
    let (mut scratch, mut found) = (SearchScratch::default(), 0);
    let prediction = PREDICTION.into();
    let (time, ()) =
        timed(|| contacts((tree1, tree2), placement, prediction, &mut scratch, |_| found += 1));
    black_box(found);
    time
}

fn tables(rows: &[Row]) -> Vec<Table> {
    let table = |study, title: &str, keys, names: Vec<&str>, notes: Vec<String>| {
        let ratios = names.into_iter().filter(|name| *name != CHOSEN);
        let ratios = ratios.map(|name| faster(name, "time", CHOSEN).of(name));
        let note = "ratios: how many times faster than the plan that is chosen";
        let columns = [number("chosen, µs", "time").of(CHOSEN)].into_iter().chain(ratios);
        let spec = TableSpec::new(title, study, keys, columns);
        spec.note(note).note(LEAST).notes(notes).of(rows)
    };
    let plans: Vec<&str> = PLANS.iter().map(|(name, _)| *name).collect();
    vec![
        table(
            BARE,
            "Layers: bare trees, all contacts of triangles, first queries",
            &["mesh", "triangle_count", "beside"],
            [&plans[..], &OTHERS].concat(),
            Vec::new(),
        ),
        table(
            DISPATCHER,
            "Layers: the dispatcher",
            &["mode", "mesh", "triangle_count", "beside"],
            plans,
            mode_notes(),
        ),
        TableSpec::new(
            "Layers: what is chosen",
            CHOICE,
            &["mesh", "triangle_count"],
            [
                number("k-DOPs cut off", "kdop_cut").of(CHOSEN),
                number("k-DOPs from", "kdop_from_depth").of(CHOSEN),
                number("build, µs", "build").of(CHOSEN),
                number("the choice, % of it", "share").of(CHOSEN),
            ],
        )
        .note("nothing in \"k-DOPs from\": they do not pay, so all layers are boxes")
        .note("least times; the choice: what the build takes longer than one that is told the plan")
        .of(rows),
    ]
}
