//! Thin and fast bodies.

use rapier3d::parry::query::intersection_test;

use super::kit::*;

/// Thickness of plates that are a unit wide.
const THICKNESS: f32 = 0.03;
const PLATE: Vec3 = Vec3::new(0.5, 0.5 * THICKNESS, 0.5);
const PHASES: usize = 8;
/// Time of one step, in seconds.
const STEP: f32 = 1.0 / 60.0;

pub(super) fn trials() -> Vec<Trial> {
    let plates = ["a floor", "a slab", "a spike", "an edge"].map(|target| {
        let name = format!("8 plates at 30 m/s onto {target}");
        Trial::new(name, move |kit| plates(kit, target)).without_control()
    });
    let slabs = [0.5, 5.0].map(|cell| {
        let name = format!("60 thin slabs dropped on a floor of triangles of {cell}");
        Trial::new(name, move |kit| slabs(kit, cell)).without_control()
    });
    let boxes = Trial::new("8 pairs of boxes that meet at 120 units/s", boxes);
    plates.into_iter().chain([boxes]).chain(slabs).collect()
}

/// A target of the plates. Its highest point is at the origin.
fn target(name: &str) -> Mesh {
    const DEPTH: f32 = 4.0;
    let half = DEPTH * (0.5 * FRAC_PI_3).tan();
    let down = |mesh: Mesh, way: f32| mesh.mapped(|vertex| vertex - way * Vec3::Y);
    match name {
        "a floor" => mesh::floor(10.0, 20),
        "a slab" => down(mesh::slab(Vec3::new(5.0, 0.5, 5.0), [4, 1, 4]), 0.5),
        "a spike" => {
            mesh::revolved(&[Vec2::new(0.0, -DEPTH), Vec2::new(half, -DEPTH), Vec2::ZERO], 16)
        }
        _ => {
            let up = 0.5 * DEPTH;
            let outline = [Vec2::new(0.0, up), Vec2::new(-half, -up), Vec2::new(half, -up)];
            down(mesh::prism(&outline, 5.0), up)
        }
    }
}

/// Plates that fly down at several turns and places.
fn plates(kit: &Kit, name: &str) -> Figures {
    const SPEED: f32 = 30.0;
    let mesh = target(name);
    let (fixed, plate) = (kit.mesh(&mesh), kit.collider(&Form::cuboid(PLATE, 4)));
    let (surface, inside) = (mesh.shape(), Depths::new(&mesh));
    let is_pointed = matches!(name, "a spike" | "an edge");
    let passes = |&index: &usize| {
        let phase = index as f32 / PHASES as f32;
        let mut world = kit.world();
        world.fix(Vec3::ZERO, fixed.clone());
        let turn = Quat::from_rotation_y(phase * TAU) * Quat::from_rotation_x(0.6 * phase);
        let place = Vec3::new(0.1 * phase, 2.0 + phase * SPEED * STEP, 0.05);
        let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(place, turn));
        let body = body.linvel(-SPEED * Vec3::Y).soft_ccd_prediction(0.6);
        let body = world.add(body, &plate);
        plate_passes(&mut world, body, is_pointed.then_some(&*surface), &inside)
    };
    Figures::default().none("passed", (0..PHASES).filter(passes).count())
}

/// True if a plate ends below the target, or if its middle stays in the target for longer than an
/// impact. A tip, if there is one, must not cross both its faces for as long.
fn plate_passes(
    world: &mut World,
    body: RigidBodyHandle,
    tip: Option<&dyn rapier3d::parry::shape::Shape>,
    inside: &Depths,
) -> bool {
    let face = SharedShape::cuboid(0.45, 0.01 * THICKNESS, 0.45);
    let mut stuck = 0;
    for _ in 0..60 {
        world.step();
        let pose = *world.bodies[body].position();
        let is_pierced = tip.is_some_and(|tip| {
            [-0.4, 0.4].into_iter().all(|side| {
                let pose = pose * Pose3::translation(0.0, side * THICKNESS, 0.0);
                intersection_test(&pose, &*face, &Pose3::IDENTITY, tip)
                    .is_ok_and(|meets| meets.intersecting)
            })
        });
        stuck += usize::from(is_pierced || inside.of(pose.translation) > THICKNESS);
    }
    let end = world.bodies[body].translation();
    // Beside a spike or an edge it may well be below the top.
    let is_below = tip.is_none() && end.y < -0.5 * THICKNESS;
    is_below || stuck > 4 || !end.is_finite()
}

/// Boxes that fly at each other without gravity, at several phases of a step.
fn boxes(kit: &Kit) -> Figures {
    const SPEED: f32 = 60.0;
    // Smaller cuboids of Rapier's own pass through each other.
    const HALF: f32 = 1.0;
    let collider = kit.collider(&Form::cuboid(Vec3::splat(HALF), 4));
    let passes = |&index: &usize| {
        let mut world = kit.world();
        world.gravity = Vec3::ZERO;
        let distance = 4.0 + SPEED * STEP * index as f32 / PHASES as f32;
        let bodies = [-1.0, 1.0].map(|side| {
            let place = Vec3::new(side * distance, 0.0, 0.0);
            let body = RigidBodyBuilder::dynamic().translation(place);
            let body = body.linvel(-side * SPEED * Vec3::X).soft_ccd_prediction(2.5);
            world.add(body, &collider)
        });
        world.run(60);
        let [left, right] = bodies.map(|body| world.bodies[body].translation().x);
        let are_apart = right - left > 1.8 * HALF;
        !are_apart
    };
    Figures::default().none("passed", (0..PHASES).filter(passes).count())
}

/// Slabs that fall from a unit above, turned at random.
fn slabs(kit: &Kit, cell: f32) -> Figures {
    const SIZE: f32 = 10.0;
    let floor = kit.mesh(&mesh::floor(SIZE, (SIZE / cell) as u32));
    let slab = kit.collider(&Form::cuboid(PLATE, 1));
    let mut random = seeded();
    let passes = |_: &usize| {
        let mut world = kit.world();
        world.fix(Vec3::ZERO, floor.clone());
        let place = Vec3::new(0.1, 1.75, 0.2);
        let body = world.put(Pose3::from_parts(place, random::rotation(&mut random)), &slab);
        world.run(150);
        let is_above = world.bodies[body].translation().y > 0.0;
        !is_above
    };
    Figures::default().none("passed", (0..60).filter(passes).count())
}
