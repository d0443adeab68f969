use crate::prelude::*;

/// A convex shape of each kind, about `size` across.
pub fn shapes(size: Real) -> Vec<(&'static str, SharedShape)> {
    let half = 0.5 * size;
    let [a, b, c] = [
        Vec3::new(-half, 0.0, 0.1 * size),
        Vec3::new(half, 0.2 * size, 0.0),
        Vec3::new(0.0, -0.3 * size, half),
    ];
    let mut random = Rand32::new(77);
    let cloud: Vec<Vec3> = (0..30).map(|_| half * direction(&mut random)).collect();
    let hull = |points: &[Vec3]| SharedShape::convex_hull(points).expect("a cloud has a hull");
    let round_hull = SharedShape::round_convex_hull(&cloud, 0.1 * size).expect("as above");
    vec![
        ("ball", SharedShape::ball(half)),
        ("cuboid", SharedShape::cuboid(half, 0.7 * half, 0.5 * half)),
        ("capsule", SharedShape::capsule_y(half, 0.4 * half)),
        ("skew capsule", SharedShape::capsule(a, b, 0.3 * half)),
        ("segment", SharedShape::segment(a, b)),
        ("triangle", SharedShape::triangle(a, b, c)),
        ("cylinder", SharedShape::cylinder(half, 0.6 * half)),
        ("cone", SharedShape::cone(half, 0.6 * half)),
        ("hull", hull(&cloud)),
        ("round cuboid", SharedShape::round_cuboid(half, 0.7 * half, 0.5 * half, 0.1 * size)),
        ("round triangle", SharedShape::round_triangle(a, b, c, 0.1 * size)),
        ("round cylinder", SharedShape::round_cylinder(half, 0.6 * half, 0.1 * size)),
        ("round cone", SharedShape::round_cone(half, 0.6 * half, 0.1 * size)),
        ("round hull", round_hull),
        ("half-space", SharedShape::halfspace(Vec3::new(0.36, 0.8, -0.48))),
    ]
}

pub(super) const PREDICTIONS: [Real; 4] = [0.0, 0.002, 0.02, 0.2];

/// A pose at which a shape is about a triangle of the mesh: just apart, touching, inside.
pub(super) fn pose(random: &mut Rand32, mesh: &TriMesh, size: Real) -> Pose3 {
    let triangle = mesh.triangle(random.rand_range(0..mesh.indices().len() as u32));
    let turn = rotation(random);
    let away = direction(random) * (0.5 + 0.2 * random.rand_float()) * size;
    Pose3::from_parts(triangle.center() + away, turn)
}

/// A pose with a turn by multiples of 90 degrees and a shift by multiples of a sixteenth.
pub(super) fn lattice_pose(random: &mut Rand32) -> Pose3 {
    let mut quarter =
        |axis| Quat::from_axis_angle(axis, FRAC_PI_2 * random.rand_range(0..4) as Real);
    let turn = quarter(Vec3::X) * quarter(Vec3::Y) * quarter(Vec3::Z);
    let [x, y, z] = [(); 3].map(|()| random.rand_range(0..33) as Real / 16.0 - 1.0);
    Pose3::from_parts(Vec3::new(x, y, z), turn)
}
