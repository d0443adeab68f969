//! Single queries of a body and a terrain without a workspace, as character controllers make them.

use crate::prelude::*;
use std::hint::black_box;

use rapier3d::parry::query::NonlinearRigidMotion;
use rapier3d::parry::query::details::ShapeCastOptions;
use rapier3d::parry::shape::Shape;

use super::QUERIES;
use super::scenes::{Ground, above, head};
use crate::study::PREDICTION;
use crate::study::pair::{SIDES, in_turn};

/// Velocity of a body in casts, and angular velocity in nonlinear ones, a second.
const WAY: Vec3 = Vec3::new(0.2, -1.0, 0.1);
const TURN: Vec3 = Vec3::new(0.3, 0.7, 1.1);
/// How long.
const SECONDS: Real = 10.0;

/// Asks about a body at a pose in the frame of a terrain, and drops the answer.
type Ask = fn(&SharedDispatcher, [&dyn Shape; 2], &Pose3);

const ASKS: [(&str, Ask); 6] = [
    ("intersection", |dispatcher, [ground, body], pos12| {
        let _ = black_box(dispatcher.intersection_test(pos12, ground, body));
    }),
    ("distance", |dispatcher, [ground, body], pos12| {
        let _ = black_box(dispatcher.distance(pos12, ground, body));
    }),
    ("contact", |dispatcher, [ground, body], pos12| {
        let _ = black_box(dispatcher.contact(pos12, ground, body, PREDICTION));
    }),
    ("manifolds, no workspace", |dispatcher, [ground, body], pos12| {
        let Memory { mut manifolds, mut workspace } = Memory::default();
        let (answers, kept) = (&mut manifolds, &mut workspace);
        let _ = dispatcher.contact_manifolds(pos12, ground, body, PREDICTION, answers, kept);
        black_box(manifolds);
    }),
    ("cast", |dispatcher, [ground, body], pos12| {
        let options = ShapeCastOptions::with_max_time_of_impact(SECONDS);
        let _ = black_box(dispatcher.cast_shapes(pos12, WAY, ground, body, options));
    }),
    (NONLINEAR, |dispatcher, [ground, body], pos12| {
        let still = NonlinearRigidMotion::identity();
        let motion = NonlinearRigidMotion::new(*pos12, Vec3::ZERO, WAY, TURN);
        let hit =
            dispatcher.cast_shapes_nonlinear(&still, ground, &motion, body, 0.0, SECONDS, true);
        let _ = black_box(hit);
    }),
];
const NONLINEAR: &str = "nonlinear cast";

/// Heights of a body of about one unit above the terrain, in units.
const PLACES: [(&str, f32); 3] = [("in", 0.35), ("near", 0.75), ("above", 1.8)];
/// Poses at each height; a repeat ends with the pose at which it has taken this long.
const POSES: usize = 20;
const BUDGET: Duration = Duration::from_millis(20);

/// Measures all queries of bodies on a terrain, without nonlinear casts of the head, which take
/// stock seconds.
pub(super) fn queries(ground: &Ground, repeats: usize) -> Vec<Row> {
    let hull = SharedShape::convex_hull(&head().vertices).expect("a head has a hull");
    let bodies = [
        ("ball", SharedShape::ball(0.5)),
        ("capsule", SharedShape::capsule_y(0.3, 0.2)),
        ("hull", hull),
        ("head", head().shape()),
    ];
    let mut rows = Vec::new();
    for (name, body) in &bodies {
        for (place, height) in PLACES {
            let poses = places(ground, height);
            for (query, ask) in ASKS {
                if query == NONLINEAR && body.as_trimesh().is_some() {
                    continue;
                }
                let key = |row: Row| {
                    let row = row.key("query", query).key("body", *name);
                    row.key("place", place).key("triangles", ground.triangle_count)
                };
                rows.extend(measure(ask, [&ground.shape, body], &poses, repeats).map(key));
            }
        }
    }
    rows
}

fn measure(ask: Ask, shapes: [&SharedShape; 2], poses: &[Pose3], repeats: usize) -> [Row; 2] {
    let shapes = shapes.map(|shape| &**shape);
    let dispatchers = SIDES.map(|backend| backend.per_triangle([]));
    // Fills the caches of the processor.
    sweep(ask, &Backend::Stock.dispatcher(), shapes, poses);
    let sweep = |dispatcher: &Dispatcher| sweep(ask, dispatcher, shapes, poses);
    let times = in_turn(&dispatchers, 2 * repeats + 1, sweep);
    [0, 1].map(|side| {
        let time = Summary::of(times[side].iter().copied());
        Row::new(QUERIES, SIDES[side]).with("time", time)
    })
}

/// Nanoseconds a query.
fn sweep(ask: Ask, dispatcher: &SharedDispatcher, shapes: [&dyn Shape; 2], poses: &[Pose3]) -> f64 {
    let start = Instant::now();
    let mut count = 0;
    for pose in poses {
        ask(dispatcher, shapes, pose);
        count += 1;
        if start.elapsed() > BUDGET {
            break;
        }
    }
    1e9 * start.elapsed().as_secs_f64() / f64::from(count)
}

/// Random places above the middle of the terrain.
fn places(ground: &Ground, height: f32) -> Vec<Pose3> {
    let mut numbers = Rand32::new(8);
    let reach = 0.5 * ground.size - 3.0;
    let place = |_| {
        let at = [(); 2].map(|()| reach * (2.0 * numbers.rand_float() - 1.0));
        let turn = random::rotation(&mut numbers);
        Pose3::from_parts(above(ground.size, at, height), turn)
    };
    (0..POSES).map(place).collect()
}
