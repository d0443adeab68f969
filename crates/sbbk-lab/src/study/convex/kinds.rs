//! Convex shapes and compounds.

use glamx::{Pose3, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::SharedShape;

use crate::scene::random;

/// A convex shape or a compound.
#[derive(Clone)]
pub(in crate::study) struct Kind {
    /// Name in tables.
    pub name: &'static str,
    /// The shape, about a unit across, or a floor.
    pub shape: SharedShape,
    /// For floors: orientation of the mesh, which comes from above.
    pub floor: Option<Upright>,
}

/// Orientation of a mesh on a floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::study) enum Upright {
    /// Along the axes of the floor.
    Yes,
    /// Any orientation: the box of the floor in the frame of the mesh then contains the mesh.
    No,
}

/// Every convex kind of Rapier, about `unit` across, floors of 100 units, and compounds.
pub(in crate::study) fn kinds(unit: f32) -> Vec<Kind> {
    let mut random = Rand32::new(3);
    let cloud: Vec<Vec3> = (0..40).map(|_| 0.5 * unit * random::direction(&mut random)).collect();
    let hull = SharedShape::convex_hull(&cloud);
    let border = 0.1 * unit;
    let round_hull = SharedShape::round_convex_hull(&cloud, border);
    let [a, b, c] =
        [Vec3::new(-0.5, 0.0, 0.1), Vec3::new(0.5, 0.2, 0.0), Vec3::new(0.0, -0.3, 0.5)]
            .map(|corner| corner * unit);
    let cuboid = |x, y, z| SharedShape::cuboid(x * unit, y * unit, z * unit);
    let bodies = [
        ("ball", Some(SharedShape::ball(0.5 * unit))),
        ("cuboid", Some(cuboid(0.5, 0.35, 0.25))),
        ("capsule", Some(SharedShape::capsule_y(0.4 * unit, 0.2 * unit))),
        ("cylinder", Some(SharedShape::cylinder(0.5 * unit, 0.3 * unit))),
        ("cone", Some(SharedShape::cone(0.5 * unit, 0.4 * unit))),
        ("convex polyhedron", hull),
        ("triangle", Some(SharedShape::triangle(a, b, c))),
        ("segment", Some(SharedShape::segment(a, b))),
        (
            "round cuboid",
            Some(SharedShape::round_cuboid(0.4 * unit, 0.3 * unit, 0.2 * unit, border)),
        ),
        ("round triangle", Some(SharedShape::round_triangle(a, b, c, border))),
        ("round cylinder", Some(SharedShape::round_cylinder(0.4 * unit, 0.2 * unit, border))),
        ("round cone", Some(SharedShape::round_cone(0.4 * unit, 0.3 * unit, border))),
        ("round polyhedron", round_hull),
    ];
    let bodies = bodies
        .into_iter()
        .filter_map(|(name, shape)| Some(Kind { name, shape: shape?, floor: None }));
    let floor = |name, shape, upright| Kind { name, shape, floor: Some(upright) };
    let floors = [
        floor("half-space", SharedShape::halfspace(Vec3::Y), Upright::No),
        floor("large floor", cuboid(50.0, 0.25, 50.0), Upright::Yes),
        floor("large floor, turned", cuboid(50.0, 0.25, 50.0), Upright::No),
    ];
    bodies.chain(floors).chain(compounds(unit)).collect()
}

/// A dumbbell, and clusters of balls, cuboids, capsules and hulls.
fn compounds(unit: f32) -> [Kind; 3] {
    let cuboid = |x, y, z| SharedShape::cuboid(x * unit, y * unit, z * unit);
    let end = |x: f32| (Pose3::translation(x * unit, 0.0, 0.0), cuboid(0.2, 0.25, 0.25));
    let bar = (Pose3::IDENTITY, cuboid(0.5, 0.08, 0.08));
    let compound = |name, parts| Kind { name, shape: SharedShape::compound(parts), floor: None };
    [
        compound("dumbbell of 3 cuboids", vec![bar, end(-0.5), end(0.5)]),
        compound("cluster of 8 parts", cluster(8, 0.5, unit)),
        compound("cluster of 24 parts", cluster(24, 1.0, unit)),
    ]
}

fn cluster(count: usize, radius: f32, unit: f32) -> Vec<(Pose3, SharedShape)> {
    let mut random = Rand32::new(count as u64);
    let cloud: Vec<Vec3> = (0..20).map(|_| 0.25 * unit * random::direction(&mut random)).collect();
    let shapes = [
        Some(SharedShape::ball(0.2 * unit)),
        Some(SharedShape::cuboid(0.25 * unit, 0.18 * unit, 0.12 * unit)),
        Some(SharedShape::capsule_y(0.15 * unit, 0.1 * unit)),
        SharedShape::convex_hull(&cloud),
    ];
    let part = |shape: &SharedShape| {
        let place = radius * unit * random::direction(&mut random);
        (Pose3::from_parts(place, random::rotation(&mut random)), shape.clone())
    };
    shapes.iter().flatten().cycle().take(count).map(part).collect()
}
