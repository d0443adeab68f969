//! The recording dispatcher beside the one inside.

use std::sync::Arc;

use glamx::Vec3;
use rapier3d::math::Pose;
use rapier3d::parry::query::{ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher};
use rapier3d::parry::shape::{Ball, Cuboid, Shape};
use sbbk_testkit::mesh;
use sbbk_testkit::probe::{Answer, Probe, Question, Recording};

/// Would catch a wrapper that changes the contacts, or records too much or too little.
#[test]
fn mesh_pairs_are_recorded() {
    let probe = Probe::default();
    let recording = Recording::new(Arc::new(DefaultQueryDispatcher), probe.clone());
    let mesh = mesh::ball(1.0, 4).trimesh(Default::default()).unwrap();
    let (ball, cuboid) = (Ball::new(1.0), Cuboid::new(Vec3::splat(0.5)));
    let pos12 = Pose::translation(1.2, 0.3, 0.1);
    let ask = |dispatcher: &dyn PersistentQueryDispatcher<(), ()>, [g1, g2]: [&dyn Shape; 2]| {
        let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
        dispatcher.contact_manifolds(&pos12, g1, g2, 0.1, &mut manifolds, &mut None).unwrap();
        Answer::new(Question::new(&pos12, [g1, g2], 0.1), &manifolds)
    };
    let pairs: [[&dyn Shape; 2]; 4] =
        [[&mesh, &mesh], [&mesh, &cuboid], [&cuboid, &mesh], [&ball, &cuboid]];
    for (index, shapes) in pairs.into_iter().enumerate() {
        probe.start_recording();
        let answer = ask(&recording, shapes);
        assert_eq!(answer, ask(&DefaultQueryDispatcher, shapes));
        assert!(!answer.reported.is_empty());
        let recorded = if index == 0 { vec![answer] } else { Vec::new() };
        assert_eq!(probe.take_answers(), recorded);
        ask(&recording, shapes);
        assert_eq!(probe.take_answers(), []);
    }
}
