use super::*;
use rapier3d::dynamics::MassProperties;

/// Half the side of a vessel of single walls.
const HALF: f32 = 0.4;

fn vessels() -> [(&'static str, Mesh); 2] {
    let profile = [[0.0, -HALF], [HALF, -HALF], [HALF, HALF]];
    let cup = mesh::revolved(&profile.map(Vec2::from_array), 24);
    let cube = mesh::cuboid(Vec3::splat(HALF), 3);
    [("box", cube.keeping(|corners| corners.iter().any(|at| at.y < HALF))), ("cup", cup)]
}

/// Lids of half a side, with the heights of their lower sides.
fn lids(half: f32, flags: TriMeshFlags) -> [(&'static str, SharedShape, f32); 4] {
    let slab = Vec3::new(half, 0.1, half);
    [
        ("mesh box", mesh::cuboid(slab, 3).shape_with(flags), -0.1),
        ("sheet", mesh::floor(2.0 * half, 3).shape_with(flags), 0.0),
        ("cuboid", SharedShape::cuboid(half, 0.1, half), -0.1),
        ("cylinder", SharedShape::cylinder(0.1, half), -0.1),
    ]
}

/// Lays a lid on a vessel. Returns the height of the lid over the rim after two seconds.
fn height(vessel: &Mesh, flags: TriMeshFlags, lid: SharedShape, bottom: f32) -> f32 {
    let vessel = ColliderBuilder::new(vessel.shape_with(flags));
    let at = Vec3::new(0.0, HALF + 0.01 - bottom, 0.0);
    let mass = MassProperties::from_cuboid(100.0, Vec3::new(HALF, 0.1, HALF));
    let lid = ColliderBuilder::new(lid).mass_properties(mass);
    let lid = after(120, world(vessel), RigidBodyBuilder::dynamic().translation(at), lid);
    lid.translation().y + bottom - HALF
}

/// Would catch rims of single walls that do not carry what overhangs them by less than a
/// centimetre.
#[test]
fn rims_carry_lids() {
    let mut cases = Vec::new();
    for (flags, (vessel, mesh)) in with_flags(vessels()) {
        for overhang in [0.0, 0.001, 0.005, 0.01, 0.05] {
            for (column, lid, bottom) in lids(HALF + overhang, flags) {
                let height = height(&mesh, flags, lid, bottom);
                let name = format!("{vessel}, {} mm", 1000.0 * overhang);
                let (shown, is_right) = (format!("{height:.3}"), height.abs() < 0.005);
                cases.push(Case::new(name, flags, column, shown, is_right));
            }
        }
    }
    judge("height of a lid over a rim, by overhang, after 2 s", &cases, &[]);
}
