use super::*;

const FRICTION: f32 = 0.1;
/// Steps in which a body lands.
const LANDING: usize = 20;
const STARTS: u64 = 3;
/// Half the height of a body, and its distance from the floor at the start.
const HALF: f32 = 0.5;
const GAP: f32 = 0.001;

/// Speed at the start, and steps of a ride.
#[derive(Clone, Copy)]
pub(super) struct Course {
    pub speed: f32,
    pub steps: usize,
}

/// A body, and how it starts.
pub(super) struct Rider {
    pub name: &'static str,
    shape: SharedShape,
    start: Start,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Start {
    /// Upright, turned by chance.
    Upright,
    /// With its axis across the way.
    Lying,
    /// Turned by chance.
    Any,
}

/// Measurement on a floor.
#[derive(Clone, Copy)]
pub(super) struct Ride {
    path: f32,
    /// Highest speed upwards after landing.
    rise: f32,
    /// Height at the end.
    height: f32,
}

/// Ground without edges, its top at height 0.
fn cuboid() -> ColliderBuilder {
    ColliderBuilder::cuboid(20.0, 1.0, 20.0).translation(-Vec3::Y)
}

pub(super) fn riders(flags: TriMeshFlags) -> [Rider; 7] {
    let rider = |name, shape, start| Rider { name, shape, start };
    let tapered = [-HALF, HALF].into_iter().flat_map(|y| {
        let wide = if y < 0.0 { 0.7 * HALF } else { HALF };
        [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)]
            .map(|(x, z)| Vec3::new(x * wide, y, z * wide))
    });
    let hull = SharedShape::convex_hull(&tapered.collect::<Vec<Vec3>>()).expect("a hull");
    [
        rider("mesh cube", mesh::cuboid(Vec3::splat(HALF), 2).shape_with(flags), Start::Upright),
        rider("mesh ball", mesh::ball(HALF, 16).shape_with(flags), Start::Any),
        rider("cuboid", SharedShape::cuboid(HALF, HALF, HALF), Start::Upright),
        rider("ball", SharedShape::ball(HALF), Start::Any),
        rider("capsule", SharedShape::capsule_y(HALF, HALF), Start::Lying),
        rider("cylinder", SharedShape::cylinder(HALF, HALF), Start::Lying),
        rider("hull", hull, Start::Upright),
    ]
}

impl Rider {
    /// Pose some time after leaving a ground that ends at x = 2.
    pub(super) fn fall(&self, ground: ColliderBuilder, speed: f32) -> Pose3 {
        let turn = match self.start {
            Start::Lying => Quat::from_rotation_x(FRAC_PI_2),
            Start::Upright | Start::Any => Quat::IDENTITY,
        };
        let place = Vec3::new(1.4, HALF + GAP, 0.3);
        let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(place, turn));
        let body = body
            .linvel(speed * Vec3::X)
            .angvel(-speed / HALF * Vec3::Z * f32::from(self.start != Start::Upright));
        let collider = ColliderBuilder::new(self.shape.clone()).friction(FRICTION);
        let steps = (60.0 * (1.0 / speed + 0.8)) as usize;
        let world = world(ground.friction(FRICTION));
        *after(steps, world, body.can_sleep(false), collider).position()
    }
}

impl Course {
    /// Judges rides over roads, each of one mesh or more, by those on a cuboid.
    pub(super) fn judge(&self, title: &str, roads: &[(&str, Vec<Mesh>)], known: &[(&str, &str)]) {
        let mut cases = Vec::new();
        for flags in FLAGS {
            let riders = riders(flags);
            let controls = riders.each_ref().map(|rider| self.rides(&[cuboid()], rider));
            for (name, road) in roads {
                let colliders =
                    road.iter().map(|mesh| ColliderBuilder::new(mesh.shape_with(flags)));
                let road: Vec<ColliderBuilder> = colliders.collect();
                for (rider, controls) in riders.iter().zip(&controls) {
                    let rides = self.rides(&road, rider);
                    cases.push(case(name, flags, rider, &rides, controls));
                }
            }
        }
        judge(title, &cases, known);
    }

    /// Rides of a body from several starts.
    fn rides(&self, ground: &[ColliderBuilder], rider: &Rider) -> Vec<Ride> {
        (0..STARTS).map(|seed| self.ride(ground, rider, seed)).collect()
    }

    fn ride(&self, ground: &[ColliderBuilder], rider: &Rider, seed: u64) -> Ride {
        let mut random = Rand32::new(seed);
        let heading = Quat::from_rotation_y(TAU * random.rand_float());
        let mut place = heading * Vec3::X * -6.0;
        place += Vec3::new(random.rand_float(), 0.0, random.rand_float());
        place.y = HALF + GAP;
        let turn = match rider.start {
            Start::Upright => Quat::from_rotation_y(TAU * random.rand_float()),
            Start::Lying => heading * Quat::from_rotation_x(FRAC_PI_2),
            Start::Any => rotation(&mut random),
        };
        let ground = ground.iter().map(|collider| collider.clone().friction(FRICTION));
        let world = world_of(ground, SbbkDispatcher::default());
        let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(place, turn));
        let body = body.linvel(heading * Vec3::X * self.speed).can_sleep(false);
        let collider = ColliderBuilder::new(rider.shape.clone()).friction(FRICTION);
        let (mut step, mut rise): (usize, f32) = (0, 0.0);
        let look = |body: &RigidBody| {
            step += 1;
            rise = if step > LANDING { rise.max(body.linvel().y) } else { rise };
        };
        let end = watched(self.steps, world, body, collider, look).translation();
        Ride { path: (end - place).dot(heading * Vec3::X), rise, height: end.y }
    }
}

/// Compares with the same body on a cuboid: the worst of all starts.
fn case(name: &str, flags: TriMeshFlags, rider: &Rider, rides: &[Ride], controls: &[Ride]) -> Case {
    // A mesh ball rocks, and loses speed at its facets by chance.
    let [most, most_rise] = match rider.name {
        "mesh ball" => [0.04, 0.15],
        "mesh cube" => [0.01, 0.05],
        _ => [0.015, 0.05],
    };
    let pairs = || rides.iter().zip(controls);
    let worst = pairs()
        .map(|(ride, control)| ride.path / control.path)
        .max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs()));
    let worst = worst.expect("there is a start");
    let rise = pairs().map(|(ride, control)| ride.rise - control.rise).fold(0.0, f32::max);
    let has_sunk = pairs().any(|(ride, control)| (ride.height - control.height).abs() > 0.02);
    let is_right = (worst - 1.0).abs() <= most && rise <= most_rise && !has_sunk;
    Case::new(name, flags, rider.name, format!("{worst:.2} {rise:.2}"), is_right)
}
