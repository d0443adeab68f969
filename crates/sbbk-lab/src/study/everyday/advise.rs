//! Measures a mesh or a robot as a terrain, as bodies and as sensors.

use crate::prelude::*;
use std::fmt;

use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::query::Ray;
use rapier3d::pipeline::ActiveEvents;
use sbbk_core::surface::SurfaceKind;

use super::measure::{Driven, Everyday};
use super::robots::Subject;
use super::scenes::{kinds, put};

/// Runs of each scene.
const REPEATS: usize = 2;
/// Convex bodies on a terrain, along each side.
const TERRAIN_SIDE: usize = 7;
/// Length of these, as a share of the longest side.
const TERRAIN_BODY: f32 = 0.07;
/// Least and largest number of bodies that fall onto each other, and their triangles together.
/// Higher: more certain speeds; lower: sooner done.
const BODIES: [usize; 2] = [6, 24];
const BODY_TRIANGLES: usize = 100_000;
/// Sensors around a fixed subject.
const SENSORS: usize = 10;
/// Triangles above which a mesh has a tree only if it is prepared.
const UNPREPARED: usize = 8192;
/// Speeds count as equal below this factor.
const NOISE: f64 = 1.1;
/// Sizes in units for which Rapier's default `length_unit` is right.
const USUAL_SIZES: [f32; 2] = [0.3, 30.0];

/// Uses of a subject. Dynamic bodies are number `BODY`.
const USES: [&str; 3] = ["terrain", "bodies", "sensors"];
const BODY: usize = 1;

/// Measurements of one mesh or robot, displayed as its name and three lines.
#[derive(Clone, Debug)]
pub struct Advice {
    /// Name of the mesh, or of the robot's file.
    pub name: String,
    pub triangles: usize,
    /// Longest side, in units.
    pub size: f32,
    /// Kind that SBBK detects.
    pub kind: SurfaceKind,
    /// Rows of stock Rapier and SBBK: as a terrain, as bodies, as sensors.
    pub rows: [[Row; 2]; 3],
    is_robot: bool,
    wants_trees: bool,
}

/// Measures whole worlds with a subject for so many steps. `length_unit` and gravity have the size
/// of the bodies.
pub fn advise(subject: &Subject, steps: usize, progress: &Progress) -> Advice {
    let bounds = subject.bounds(&Pose3::IDENTITY);
    let size = bounds.extents().max_element();
    let large = subject.larger_than(UNPREPARED);
    let scenes = Scenes { subject, bounds, size, large, steps };
    let rows = [scenes.terrain(), scenes.bodies(), scenes.sensors()]
        .map(|scene| scene.measure(REPEATS, progress));
    Advice {
        name: subject.name.clone(),
        triangles: subject.triangle_count(),
        size,
        kind: subject.kind(),
        rows,
        is_robot: subject.is_robot,
        wants_trees: !scenes.large.is_empty(),
    }
}

struct Scenes<'a> {
    subject: &'a Subject,
    bounds: Aabb,
    size: f32,
    /// Shapes with a tree only if prepared.
    large: Vec<SharedShape>,
    steps: usize,
}

impl Scenes<'_> {
    /// Convex bodies of all kinds, each a little above the subject.
    fn terrain(&self) -> Everyday<'_> {
        let length = TERRAIN_BODY * self.size;
        let (_, shapes) = kinds(length).pop().expect("the last is the mixture");
        let build = move || {
            let mut world = world(length);
            self.fix(&mut world);
            let mut random = Rand32::new(5);
            let mut shapes = shapes.iter().cycle();
            for index in 0..TERRAIN_SIDE * TERRAIN_SIDE {
                let [x, z] = [index % TERRAIN_SIDE, index / TERRAIN_SIDE]
                    .map(|place| (place as f32 + 0.5) / TERRAIN_SIDE as f32);
                let share = Vec3::new(x, 1.0, z);
                let top = self.bounds.mins + share * self.bounds.extents() + 2.0 * length * Vec3::Y;
                let hit = self.subject.cast(&Ray::new(top, Vec3::NEG_Y), 2.0 * self.size);
                let turn = random::rotation(&mut random);
                if let (Some(fall), Some(shape)) = (hit, shapes.next()) {
                    let place = top - (fall - length) * Vec3::Y;
                    let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(place, turn));
                    world.insert(body, ColliderBuilder::new(shape.clone()));
                }
            }
            Driven::alone(world)
        };
        Everyday { prepared: Vec::new(), ..self.scene("terrain", build) }
    }

    /// Copies that fall onto each other and onto a floor.
    fn bodies(&self) -> Everyday<'_> {
        let [least, most] = BODIES;
        let count = (BODY_TRIANGLES / self.subject.triangle_count().max(1)).clamp(least, most);
        let build = move || {
            let mut world = world(self.size);
            let floor = ColliderBuilder::cuboid(20.0 * self.size, self.size, 20.0 * self.size);
            world.insert(RigidBodyBuilder::fixed(), floor.translation(-self.size * Vec3::Y));
            let (mut random, mut height) = (Rand32::new(5), 0.0);
            for index in 0..count {
                let turn = random::rotation(&mut random);
                let bounds = self.subject.bounds(&Pose3::from_rotation(turn));
                let spread = 0.5 * bounds.extents() * random::direction(&mut random);
                let column = self.size * Vec3::X * (0.8 * (index % 3) as f32 - 0.8);
                let place = column + spread.with_y(height - bounds.mins.y);
                (self.subject.insert)(&mut world, Pose3::from_parts(place, turn));
                // Three start side by side.
                height += if index % 3 == 2 { self.size } else { 0.0 };
            }
            Driven::alone(world)
        };
        self.scene("bodies", build)
    }

    /// Sensors that drift through a fixed subject, and past it.
    fn sensors(&self) -> Everyday<'_> {
        let build = move || {
            let mut world = world(self.size);
            self.fix(&mut world);
            let mut random = Rand32::new(5);
            let starts = (0..SENSORS).map(|index| {
                let away = self.size * (0.2 + 0.8 * index as f32 / SENSORS as f32);
                let place = away * random::direction(&mut random);
                let pose = Pose3::from_parts(place, random::rotation(&mut random));
                let body = RigidBodyBuilder::dynamic().pose(pose).gravity_scale(0.0);
                let body = world.insert_body(body.additional_mass(1.0));
                for sensor in self.subject.colliders() {
                    let sensor = sensor.sensor(true).active_events(ActiveEvents::COLLISION_EVENTS);
                    world.insert_collider(sensor, Some(body));
                }
                (body, place)
            });
            let starts: Vec<_> = starts.collect();
            let speed = 0.002 * self.size;
            Driven::by(world, move |world, step| {
                for &(body, start) in &starts {
                    put(world, body, start + speed * step as f32 * Vec3::X);
                }
            })
        };
        self.scene("sensors", build)
    }

    /// Inserts a fixed subject.
    fn fix(&self, world: &mut PhysicsWorld) {
        let body = world.insert_body(RigidBodyBuilder::fixed());
        for collider in self.subject.colliders() {
            world.insert_collider(collider, Some(body));
        }
    }

    fn scene<'b>(&self, part: &str, build: impl Fn() -> Driven + 'b) -> Everyday<'b> {
        let row = Row::new("advice", "").key("mesh", &self.subject.name).key("as", part);
        Everyday { prepared: self.large.clone(), ..Everyday::new(row, self.steps, build) }
    }
}

/// Makes an empty world for bodies of this size.
fn world(size: Real) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.length_unit = size;
    world.gravity *= size;
    world
}

impl Advice {
    /// Speed of collision detection beside stock: as a terrain, as bodies, as sensors.
    pub fn speeds(&self) -> [f64; 3] {
        self.rows
            .each_ref()
            .map(|[stock, sbbk]| stock.number("detection.mean") / sbbk.number("detection.mean"))
    }

    /// Settings for one use.
    fn settings(&self, index: usize) -> String {
        let length_unit = format!("`length_unit = {}`", two_digits(self.size));
        let [small, large] = USUAL_SIZES;
        let inside_out = "turn its triangles unless it is a room, as its normals point inwards";
        let settings = [
            (self.is_robot, "load it with `trimesh_flags = TriMeshFlags::empty()`, as here"),
            (self.wants_trees, "call `prepare_shape` at load time"),
            (self.kind == SurfaceKind::InsideOut, inside_out),
            (index == BODY && !(small..large).contains(&self.size), &length_unit),
        ];
        let settings = settings.into_iter().filter(|(is_wanted, _)| *is_wanted);
        let settings: Vec<&str> = settings.map(|(_, setting)| setting).collect();
        if settings.is_empty() { "nothing".to_owned() } else { settings.join("; ") }
    }

    /// The line of one use.
    fn line(&self, index: usize) -> String {
        let (use_, settings) = (USES[index], self.settings(index));
        let [stock, sbbk] = &self.rows[index];
        let speed = self.speeds()[index];
        let verdict = match speed {
            _ if speed > NOISE => format!("{speed:.1} times as fast"),
            _ if speed < 1.0 / NOISE => format!("slower, {speed:.2} of the speed"),
            _ => "as fast".to_owned(),
        };
        let ms = |row: &Row, time: &str| 1e-3 * row.number(time);
        let [mean, stocks_mean] = [sbbk, stock].map(|row| ms(row, "detection.mean"));
        let [worst, stocks_worst] = [sbbk, stock].map(|row| ms(row, "detection.max"));
        let [wrong, stocks_wrong] = [sbbk, stock].map(|row| row.wrong("judged"));
        let right = match stock.count("judged.true_pairs") {
            0 => "no contacts to judge".to_owned(),
            all => format!("{wrong} wrong answers, stock {stocks_wrong}, beside {all} true ones"),
        };
        let [own, meshes] = ["plugin_mebibytes", "mesh_mebibytes"].map(|m| sbbk.number(m));
        format!(
            "  as {use_}: {verdict} ({mean:.3} ms a step, stock {stocks_mean:.3}; slowest step \
             {worst:.2}, stock {stocks_worst:.2}); {right}; {own:.1} MiB more than {meshes:.1}; set: \
             {settings}"
        )
    }
}

/// Two significant digits: `0.16`, `160`.
fn two_digits(value: f32) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(f64::NAN)
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.kind {
            SurfaceKind::Solid => {
                "a solid: pushes out mesh bodies that sink in, and is a room for bodies inside"
            }
            SurfaceKind::Sheet => "a sheet: bodies touch it from both sides",
            SurfaceKind::InsideOut => "inside out: its normals point inwards",
        };
        let Self { name, triangles, size, .. } = self;
        write!(f, "{name}: {triangles} triangles, {size:.3} units, {kind}")?;
        (0..USES.len()).try_for_each(|index| write!(f, "\n{}", self.line(index)))
    }
}
