//! Convex shapes and compounds.

use crate::prelude::*;

/// A convex shape or a compound.
#[derive(Clone)]
pub(super) struct Kind {
    /// Name in tables.
    pub name: &'static str,
    /// The shape, about a unit across, or a floor.
    pub shape: SharedShape,
    /// For floors: draws the orientation of the mesh, which comes from above.
    pub floor: Option<fn(&mut Rand32) -> Quat>,
}

/// Every convex kind of Rapier, about `unit` across, floors of 100 units, and compounds: a
/// dumbbell, and clusters of balls, cuboids, capsules and hulls.
pub(super) fn kinds(unit: f32) -> Vec<Kind> {
    let mut random = Rand32::new(3);
    let cloud: Vec<Vec3> = (0..40).map(|_| 0.5 * unit * random::direction(&mut random)).collect();
    let border = 0.1 * unit;
    let hull = SharedShape::convex_hull(&cloud).expect("a cloud has a hull");
    let round_hull = SharedShape::round_convex_hull(&cloud, border).expect("a cloud has a hull");
    let [a, b, c] = [[-0.5, 0.0, 0.1], [0.5, 0.2, 0.0], [0.0, -0.3, 0.5]]
        .map(|corner| Vec3::from_array(corner) * unit);
    let [r, s, t] = [0.4, 0.3, 0.2].map(|length: f32| length * unit);
    let cuboid = |x, y, z| SharedShape::cuboid(x * unit, y * unit, z * unit);
    let end = |x: f32| (Pose3::translation(x * unit, 0.0, 0.0), cuboid(0.2, 0.25, 0.25));
    let bar = (Pose3::IDENTITY, cuboid(0.5, 0.08, 0.08));
    // The box of a floor in the frame of a turned mesh contains the mesh.
    type Turn = fn(&mut Rand32) -> Quat;
    let (floor, tilted): (Option<Turn>, Option<Turn>) =
        (Some(|_| Quat::IDENTITY), Some(random::rotation));
    let kinds = [
        ("ball", SharedShape::ball(0.5 * unit), None),
        ("cuboid", cuboid(0.5, 0.35, 0.25), None),
        ("capsule", SharedShape::capsule_y(r, t), None),
        ("cylinder", SharedShape::cylinder(0.5 * unit, s), None),
        ("cone", SharedShape::cone(0.5 * unit, r), None),
        ("convex polyhedron", hull, None),
        ("triangle", SharedShape::triangle(a, b, c), None),
        ("segment", SharedShape::segment(a, b), None),
        ("round cuboid", SharedShape::round_cuboid(r, s, t, border), None),
        ("round triangle", SharedShape::round_triangle(a, b, c, border), None),
        ("round cylinder", SharedShape::round_cylinder(r, t, border), None),
        ("round cone", SharedShape::round_cone(r, s, border), None),
        ("round polyhedron", round_hull, None),
        ("half-space", SharedShape::halfspace(Vec3::Y), tilted),
        ("large floor", cuboid(50.0, 0.25, 50.0), floor),
        ("large floor, turned", cuboid(50.0, 0.25, 50.0), tilted),
        ("dumbbell of 3 cuboids", SharedShape::compound(vec![bar, end(-0.5), end(0.5)]), None),
        ("cluster of 8 parts", cluster(8, 0.5, unit), None),
        ("cluster of 24 parts", cluster(24, 1.0, unit), None),
    ];
    kinds.map(|(name, shape, floor)| Kind { name, shape, floor }).into()
}

fn cluster(count: usize, radius: f32, unit: f32) -> SharedShape {
    let mut random = Rand32::new(count as u64);
    let cloud: Vec<Vec3> = (0..20).map(|_| 0.25 * unit * random::direction(&mut random)).collect();
    let shapes = [
        SharedShape::ball(0.2 * unit),
        SharedShape::cuboid(0.25 * unit, 0.18 * unit, 0.12 * unit),
        SharedShape::capsule_y(0.15 * unit, 0.1 * unit),
        SharedShape::convex_hull(&cloud).expect("a cloud has a hull"),
    ];
    let part = |shape: &SharedShape| {
        let place = radius * unit * random::direction(&mut random);
        (Pose3::from_parts(place, random::rotation(&mut random)), shape.clone())
    };
    SharedShape::compound(shapes.iter().cycle().take(count).map(part).collect())
}
