use super::*;

/// Half extents of the boxes.
const HALVES: Vec3 = Vec3::new(0.3, 0.2, 0.4);

/// Slides a box with a contact skin. Returns its way, and how far its middle and its upright axis are off.
fn slide(ground: SharedShape, shape: SharedShape, skin: Real, turn: Real) -> [Real; 3] {
    let collider = |shape| ColliderBuilder::new(shape).friction(0.3);
    let world = world(collider(ground));
    let height = HALVES.y + skin;
    let start = Vec3::new(-10.0, height + 0.002, 0.0);
    let body = RigidBodyBuilder::dynamic().translation(start).rotation(turn * Vec3::Y);
    let collider = collider(shape).contact_skin(skin).density(1.0);
    let body = after(200, world, body.linvel(6.0 * Vec3::X), collider);
    let up = *body.rotation() * Vec3::Y;
    [body.translation().x + 10.0, (body.translation().y - height).abs(), 1.0 - up.y]
}

/// Would catch ghost contacts of bodies on a contact skin. Skins of more than a tenth of the body's radius leave no
/// contact near.
#[test]
fn boxes_with_a_contact_skin_slide_as_cuboids_do() {
    let cuboid = SharedShape::cuboid(HALVES.x, HALVES.y, HALVES.z);
    let slab = mesh::slab(Vec3::new(20.0, 1.0, 20.0), [37, 1, 37]).mapped(|v| v - Vec3::Y);
    let grounds = [mesh::floor(40.0, 37), slab].map(|mesh| mesh.shape());
    let flat = SharedShape::halfspace(Vec3::Y);
    for skin in [0.02, 0.06, 0.1] {
        for turn in [0.0, 0.4, 1.9] {
            let [way, ..] = slide(flat.clone(), cuboid.clone(), skin, turn);
            for ground in &grounds {
                for cells in [1, 4] {
                    let shape = mesh::cuboid(HALVES, cells).shape();
                    let [slid, height, tilt] = slide(ground.clone(), shape, skin, turn);
                    println!("skin {skin}, turned by {turn}: {slid:.3} of {way:.3}");
                    assert!((slid / way - 1.0).abs() < 0.02, "{slid} of {way}");
                    assert!(height < 0.005 && tilt < 1e-3, "{height} off, tilt {tilt}");
                }
            }
        }
    }
}
