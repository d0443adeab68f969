use crate::heightfield::terrain::{Terrain, rolling};
use crate::prelude::*;
use rapier3d::parry::query::distance as shape_distance;

/// Would catch a direction left out because a neighbour is nearer, and near contacts that are kept.
/// Soft CCD needs each direction of the larger shape's local minima beyond a tenth of the radius.
#[test]
fn far_contacts_have_every_direction() {
    let [head, torus] = [mesh::monkey_head_with(3), mesh::torus(0.7, 0.3, 8, 5)].map(|m| shape(&m));
    let surfaces = having(ContactSet::Surfaces);
    let (mut random, mut far, mut left_out, mut near) = (Rand32::new(1), 0, 0, [0; 2]);
    for i in 0..120 {
        let away = 1.2 + 0.015 * i as Real;
        let at = Pose::from_parts(away * direction(&mut random), rotation(&mut random));
        let query = Question::new(&head, &torus, at).within(0.7);
        let [found, all] = [query.fresh(&surfaces), query.fresh(&per_triangle())];
        // The ball around the box of the torus has a radius of 1.446.
        if all.iter().all(|manifold| distance(manifold) > 0.145) {
            let pairs =
                |manifolds: &[Manifold]| manifolds.iter().map(triangles).collect::<BTreeSet<_>>();
            assert!(pairs(&found).is_subset(&pairs(&all)), "{at:?}");
            let nearest = |manifolds: &[Manifold]| {
                manifolds.iter().map(distance).fold(Real::INFINITY, Real::min)
            };
            assert_eq!(nearest(&found), nearest(&all), "{at:?}");
            for manifold in &all {
                let is_like = |found: &Manifold| found.local_n1.dot(manifold.local_n1) >= 0.98;
                let is_there = found.iter().any(is_like);
                assert!(
                    is_there || !is_minimum(&head, &at, manifold),
                    "{at:?} lost {}",
                    manifold.local_n1
                );
            }
            far += found.len();
            left_out += all.len() - found.len();
        } else {
            near = [near[0] + found.len(), near[1] + all.len()];
        }
    }
    assert!(far > 50 && left_out > 50, "{far} far, {left_out} left out");
    assert!(near[0] < near[1], "{near:?} near");
}

/// Returns true if no triangle of mesh 1 at a contact's point has a point nearer to the point of
/// mesh 2.
fn is_minimum(mesh1: &TriMesh, pos12: &Pose, manifold: &Manifold) -> bool {
    let point = manifold.find_deepest_contact().expect("a point");
    let point2 = pos12 * point.local_p2;
    let around =
        mesh1.triangles().filter(|one| one.distance_to_local_point(point.local_p1, false) < 1e-4);
    let nearest = around.map(|one| one.distance_to_local_point(point2, false));
    nearest.fold(Real::INFINITY, Real::min) > point.dist - 1e-4
}

/// Meshes of 3200 and 1536 triangles, as far from each other as they are large.
#[test]
fn fine_meshes_have_a_few_far_contacts() {
    let [ball, torus] = [mesh::ball(0.8, 20), mesh::torus(0.7, 0.3, 48, 16)].map(|m| shape(&m));
    let mut random = Rand32::new(1);
    let poses = (0..100).map(|i| {
        let away = 1.3 + 0.01 * i as Real;
        Pose::from_parts(away * direction(&mut random), rotation(&mut random))
    });
    has_few_far_contacts([&ball, &torus], &ball, poses);
}

/// Would also catch far contacts with triangles of another cell.
#[test]
fn fine_meshes_have_a_few_far_contacts_with_fields() {
    let torus = shape(&mesh::torus(0.7, 0.3, 48, 16));
    let Terrain { field, mesh, .. } = Terrain::new(rolling(6.0, 60, 0.5));
    let mut random = Rand32::new(2);
    let poses = (0..100).map(|i| {
        let [x, z] = [0; 2].map(|_| 3.0 * random.rand_float() - 1.5);
        Pose::from_parts(Vec3::new(x, 1.0 + 0.01 * i as Real, z), rotation(&mut random))
    });
    has_few_far_contacts([&field, &torus], &mesh, poses);
}

/// Would catch lost far contacts, contacts nearer than the shapes, and too many points. Parry
/// measures the distance of `mesh1`, which is shape 1 as a mesh.
fn has_few_far_contacts(
    [shape1, shape2]: [&dyn Shape; 2],
    mesh1: &dyn Shape,
    poses: impl Iterator<Item = Pose>,
) {
    let (mut ratios, dispatcher) = (Vec::new(), having(ContactSet::Surfaces));
    for at in poses {
        let query = Question::new(shape1, shape2, at).within(1.0);
        let least = shape_distance(&Pose::IDENTITY, mesh1, &at, shape2).expect("both are meshes");
        let least = least.distance;
        // Walks end within a tenth, and contacts beyond the prediction distance do not count.
        if !(0.05..0.9).contains(&least) {
            continue;
        }
        for is_flipped in [false, true] {
            let found = query.flipped(is_flipped).fresh(&dispatcher);
            let points: usize = found.iter().map(|manifold| manifold.points.len()).sum();
            let nearest = found.iter().map(distance).fold(Real::INFINITY, Real::min);
            assert!(
                points < 120 && nearest >= 0.9999 * least,
                "{points}, {nearest} for {least}, {at:?}"
            );
            ratios.push(nearest / least);
        }
    }
    ratios.sort_unstable_by(Real::total_cmp);
    let [median, most] = [ratios[ratios.len() / 2], ratios[ratios.len() - 1]];
    assert!(ratios.len() > 120 && median < 1.01 && most < 1.1, "{ratios:?}");
}

/// A body that lies on a face, not quite flat, is held up at its other corners as well: it rocks
/// onto them. Would catch corners that are left out as the lower ones are nearer.
#[test]
fn corners_above_a_face_count_though_others_are_nearer() {
    let [floor, cube] = [mesh::floor(4.0, 1), mesh::cuboid(Vec3::splat(0.5), 1)].map(|m| shape(&m));
    let tilt: Real = 0.07;
    let turn = Quat::from_rotation_y(0.3) * Quat::from_rotation_x(tilt);
    let height = 0.5 * (tilt.sin() + tilt.cos());
    let at = Pose::from_parts(Vec3::new(0.3, height + 0.001, 0.2), turn);
    let found = Question::new(&floor, &cube, at).within(0.1).fresh(&having(ContactSet::Surfaces));
    let at_corners = |near: Real, far: Real| {
        let distances = found.iter().map(distance);
        distances.filter(|distance| (near..far).contains(distance)).count()
    };
    assert!(at_corners(0.0, 0.002) > 0 && at_corners(0.069, 0.073) > 0, "{found:?}");
}
