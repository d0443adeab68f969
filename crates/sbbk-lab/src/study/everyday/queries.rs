//! Single queries of a body and a terrain without a workspace, as character controllers make them.

use crate::prelude::*;
use std::hint::black_box;

use rapier3d::parry::query::NonlinearRigidMotion;
use rapier3d::parry::query::details::ShapeCastOptions;

use super::scenes::{Ground, above, head};
use super::{PREDICTION, QUERIES};
use crate::study::pair::{SIDES, in_turn};

/// A query of two shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Query {
    Intersection,
    Distance,
    Contact,
    #[value(name = "manifolds, no workspace")]
    Manifolds,
    Cast,
    #[value(name = "nonlinear cast")]
    NonlinearCast,
}

/// Velocity of a body in casts, and angular velocity in nonlinear ones, a second.
const WAY: Vec3 = Vec3::new(0.2, -1.0, 0.1);
const TURN: Vec3 = Vec3::new(0.3, 0.7, 1.1);
/// How long.
const SECONDS: Real = 10.0;

impl Query {
    /// Returns the answer as a number: 0 or 1, a distance or a time.
    fn ask(self, dispatcher: &SharedDispatcher, asked: &Asked, pos12: &Pose3) -> Option<Real> {
        let (ground, body) = (&*asked.ground.shape, &**asked.body);
        match self {
            Self::Intersection => {
                let meets = dispatcher.intersection_test(pos12, ground, body).ok()?;
                Some(Real::from(u8::from(meets.intersecting)))
            }
            Self::Distance => Some(dispatcher.distance(pos12, ground, body).ok()?.distance),
            Self::Contact => Some(dispatcher.contact(pos12, ground, body, PREDICTION).ok()??.dist),
            Self::Manifolds => {
                let mut memory = Memory::default();
                memory.ask(dispatcher, [ground, body], pos12, PREDICTION);
                let points = memory.manifolds.iter().flat_map(|manifold| &manifold.points);
                let distances = points.map(|point| point.dist);
                distances.reduce(Real::min).filter(|&distance| distance <= PREDICTION)
            }
            Self::Cast => {
                let options = ShapeCastOptions::with_max_time_of_impact(SECONDS);
                let hit = dispatcher.cast_shapes(pos12, WAY, ground, body, options);
                Some(hit.ok()??.time_of_impact)
            }
            Self::NonlinearCast => {
                let still = NonlinearRigidMotion::identity();
                let motion = NonlinearRigidMotion::new(*pos12, Vec3::ZERO, WAY, TURN);
                let hit = dispatcher
                    .cast_shapes_nonlinear(&still, ground, &motion, body, 0.0, SECONDS, true);
                Some(hit.ok()??.time_of_impact)
            }
        }
    }
}

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
            let asked = Asked { ground, body, poses: &poses };
            let is_slow = |query| query == Query::NonlinearCast && body.as_trimesh().is_some();
            for query in Query::value_variants().iter().filter(|&&query| !is_slow(query)) {
                let key = |row: Row| {
                    let row = row.key("query", query.to_string()).key("body", *name);
                    row.key("place", place).key("triangles", ground.triangle_count)
                };
                rows.extend(asked.measure(*query, repeats).map(key));
            }
        }
    }
    rows
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

struct Asked<'a> {
    ground: &'a Ground,
    body: &'a SharedShape,
    poses: &'a [Pose3],
}

impl Asked<'_> {
    fn measure(&self, query: Query, repeats: usize) -> [Row; 2] {
        let dispatchers = SIDES.map(|backend| backend.per_triangle([]));
        // Fills the caches of the processor.
        self.sweep(query, &Backend::Stock.dispatcher());
        let sweep = |dispatcher: &Dispatcher| self.sweep(query, dispatcher);
        let times = in_turn(&dispatchers, 2 * repeats + 1, sweep);
        let row = |side: usize| {
            let time = Summary::of(times[side].iter().copied());
            Row::new(QUERIES, SIDES[side]).with("time", time)
        };
        [row(0), row(1)]
    }

    /// Nanoseconds a query.
    fn sweep(&self, query: Query, dispatcher: &SharedDispatcher) -> f64 {
        let start = Instant::now();
        let mut count = 0;
        for pose in self.poses {
            black_box(query.ask(dispatcher, self, pose));
            count += 1;
            if start.elapsed() > BUDGET {
                break;
            }
        }
        1e9 * start.elapsed().as_secs_f64() / f64::from(count)
    }
}
