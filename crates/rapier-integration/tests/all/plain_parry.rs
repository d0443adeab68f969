//! The dispatcher as a host without Rapier has it: of Parry's traits alone.

use std::collections::BTreeSet;

use glamx::{DPose3, Pose3, Vec3};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher, QueryDispatcher};
use parry3d::shape::{Ball, TriMesh, Triangle};
use rapier_integration::{ContactDetail, ContactSet, SbbkConfig, SbbkDispatcher};
use sbbk_truth::{TruthPair, pairs_within};

fn ball(radius: f32) -> TriMesh {
    let (vertices, triangles) = Ball::new(radius).to_trimesh(24, 12);
    TriMesh::new(vertices, triangles).unwrap()
}

fn truth(meshes: [&TriMesh; 2], pos12: &Pose3, margin: f64) -> Vec<TruthPair> {
    let corners = |triangle: Triangle| triangle.vertices().map(|corner| corner.as_dvec3());
    let meshes = meshes.map(|mesh| mesh.triangles().map(corners));
    pairs_within(meshes, DPose3::from(*pos12), margin)
}

/// Two balls that come close, overlap and turn, in one workspace: the contacts are those of all
/// pairs of triangles, with their depths. Would catch what works in Rapier's hands only.
#[test]
fn contacts_of_two_meshes_are_true() {
    const PREDICTION: f32 = 0.02;
    let mut config = SbbkConfig::default();
    config.contact_set = ContactSet::Triangles;
    config.detail = ContactDetail::Every;
    let dispatcher = SbbkDispatcher::new(config);
    let (one, two) = (ball(1.0), ball(0.7));
    let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
    let mut workspace = None;
    let mut contacts = 0;
    for step in 0..40 {
        let turn = 0.02 * step as f32;
        let mut pos12 = Pose3::rotation(Vec3::new(turn, 0.3, -turn));
        pos12.translation = Vec3::new(1.75 - 0.005 * step as f32, 0.1, 0.05);
        dispatcher
            .contact_manifolds(&pos12, &one, &two, PREDICTION, &mut manifolds, &mut workspace)
            .unwrap();
        let found: BTreeSet<[u32; 2]> =
            manifolds.iter().map(|manifold| [manifold.subshape1, manifold.subshape2]).collect();
        assert_eq!(found.len(), manifolds.len());
        let truth = truth([&one, &two], &pos12, f64::from(1.01 * PREDICTION));
        for pair in &truth {
            let is_clear = (pair.distance - f64::from(PREDICTION)).abs() > 1e-5;
            let is_found = found.contains(&pair.triangles);
            assert!(!is_clear || is_found == (pair.distance < f64::from(PREDICTION)), "{pair:?}");
        }
        for manifold in &manifolds {
            let triangles = [manifold.subshape1, manifold.subshape2];
            let pair = truth.iter().find(|pair| pair.triangles == triangles).expect("close");
            let least =
                manifold.points.iter().map(|point| point.dist).fold(f32::INFINITY, f32::min);
            assert!((f64::from(least) - pair.distance).abs() < 1e-5, "{least} and {pair:?}");
        }
        contacts += manifolds.len();
        let meets = dispatcher.intersection_test(&pos12, &one, &two).unwrap().intersecting;
        assert_eq!(meets, truth.iter().any(|pair| pair.distance <= 0.0));
    }
    assert!(contacts > 200, "{contacts} contacts");
}
