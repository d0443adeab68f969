use super::terrain::rolling;
use crate::prelude::*;

/// The reason for all this: under stock Rapier heads fall through a height field. Here they come to
/// rest, about where they do on the same terrain as a mesh.
#[test]
fn heads_rest_on_a_height_field() {
    let field = rolling(12.0, 24, 0.4);
    let as_mesh = mesh::terrain(12.0, 24, 0.4).shape();
    let field = SharedShape::new(field);
    let run = |terrain: &SharedShape, dispatcher: Option<SbbkDispatcher>| {
        let mut world = heads_above(terrain.clone(), dispatcher);
        world.step(30);
        let early = world.poses();
        world.step(570);
        let before = world.poses();
        world.step(60);
        let late = world.poses();
        let moved = before.iter().zip(&late).map(|(a, b)| (a.translation - b.translation).length());
        (early, late.clone(), moved.fold(0.0, Real::max))
    };
    let (_, fallen, _) = run(&field, None);
    assert!(fallen.iter().all(|pose| pose.translation.y < -100.0), "stock has learnt it");
    let dispatcher = SbbkDispatcher::default();
    let (early, on_field, moved) = run(&field, Some(dispatcher.clone()));
    let (expected, on_mesh, moved_on_mesh) = run(&as_mesh, Some(dispatcher));
    for (pose, expected) in early.iter().zip(&expected) {
        let apart = (pose.translation - expected.translation).length();
        assert!(apart < 1e-3, "{apart} apart at the first touch");
    }
    assert!(moved < 0.05 && moved_on_mesh < 0.05, "move by {moved} and {moved_on_mesh}");
    for pose in on_field.iter().chain(&on_mesh) {
        assert!((0.0..1.6).contains(&pose.translation.y), "{pose:?}");
    }
}
