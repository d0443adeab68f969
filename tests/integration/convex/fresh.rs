use std::collections::BTreeMap;

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::parry::shape::{SharedShape, TriMeshFlags};
use sbbk_lab::mesh;

use super::question::{Question, bits, touches};
use super::shapes::{PREDICTIONS, lattice_pose, pose, shapes};
use crate::support::{Manifold, rotation, shape_with};

/// Panics unless a fresh answer is that of Parry's routine on all triangles, bit for bit: each manifold of ours is
/// one of brute force, and each of brute force that has a point within the prediction distance is one of ours. The
/// number of contacts.
fn check_fresh(name: &str, dispatcher: &SbbkDispatcher, question: &Question) -> usize {
    let found = question.fresh(dispatcher);
    let all = question.brute_force();
    let by_triangle: BTreeMap<u32, &Manifold> =
        found.iter().map(|manifold| (question.triangle_of(manifold), manifold)).collect();
    assert_eq!(by_triangle.len(), found.len(), "{name}: two manifolds of one triangle");
    for (triangle, manifold) in &by_triangle {
        let expected =
            all.get(triangle).unwrap_or_else(|| panic!("{name}: {triangle} is invented"));
        assert_eq!(bits(manifold), bits(expected), "{name}: {triangle}");
    }
    let mut count = 0;
    for (triangle, expected) in &all {
        if touches(expected, question.prediction) {
            count += 1;
            assert!(
                by_triangle.contains_key(triangle),
                "{name}: {triangle} is lost, {:?} {}",
                expected.points,
                question.prediction
            );
        }
    }
    count
}

/// The same for stock's dispatcher: its manifolds with a point within the prediction distance are ours.
fn check_against_stock(name: &str, dispatcher: &SbbkDispatcher, question: &Question) {
    let touching = |manifolds: Vec<Manifold>| -> BTreeMap<u32, Vec<u32>> {
        let near = manifolds.into_iter().filter(|m| touches(m, question.prediction));
        near.map(|m| (question.triangle_of(&m), bits(&m))).collect()
    };
    let stock = touching(question.fresh(&DefaultQueryDispatcher));
    assert_eq!(touching(question.fresh(dispatcher)), stock, "{name}");
}

/// Would catch a triangle that the descent or the leaf test drops, one that is kept though Parry sees no contact, and any
/// other pose, order, constraint or argument than stock passes.
#[test]
fn fresh_contacts_are_those_of_parrys_routine_on_all_triangles() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(1);
    let [head, constrained] = [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES]
        .map(|flags| shape_with(&mesh::monkey_head(), flags));
    for size in [0.1, 0.6, 3.0] {
        for (name, shape) in shapes(size) {
            let mut count = 0;
            for (i, prediction) in PREDICTIONS.into_iter().cycle().take(16).enumerate() {
                let mesh = if i % 8 < 4 { &head } else { &constrained };
                let is_lattice = i >= 12;
                let pose = if is_lattice {
                    lattice_pose(&mut random)
                } else {
                    pose(&mut random, mesh, size)
                };
                for flipped in [false, true] {
                    let question = Question { mesh, shape: &shape, pose, prediction, flipped };
                    count += check_fresh(name, &dispatcher, &question);
                    check_against_stock(name, &dispatcher, &question);
                }
            }
            assert!(count > 10, "{name} of {size}: {count} contacts");
        }
    }
}

/// Would catch rounding that grows with the floor and is not allowed for, and a floor that is cut off too early.
#[test]
fn a_huge_floor_loses_no_contact() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(2);
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let mut count = 0;
    for half in [50.0, 2000.0] {
        let shape = SharedShape::cuboid(half, 0.25, half);
        for i in 0..60 {
            let turn = if i % 4 == 0 { Quat::IDENTITY } else { rotation(&mut random) };
            let [x, z] = [(); 2].map(|()| 1.8 * half * (random.rand_float() - 0.5));
            let at = Vec3::new(x, 0.25 + 0.9 * random.rand_float(), z);
            // The head in the frame of the floor, and back.
            let pose = Pose3::from_parts(at, turn).inverse();
            let prediction = PREDICTIONS[i % 4];
            for flipped in [false, true] {
                let question = Question { mesh: &head, shape: &shape, pose, prediction, flipped };
                count += check_fresh("floor", &dispatcher, &question);
            }
        }
    }
    assert!(count > 1000, "{count} contacts");
}
