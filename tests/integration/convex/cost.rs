use allocation_counter::measure;
use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::math::Pose;
use rapier3d::parry::shape::TriMeshFlags;
use sbbk_testkit::mesh;

use super::shapes::{floor, near_pose, shapes};
use crate::support::{Pair, Question, distance, every, nudge, shape_with};

/// Would catch a manifold, a list of points or of candidates that is made anew in each step, in
/// Parry's routines too. The shapes do not overlap: Parry's EPA allocates.
#[test]
fn steady_contact_allocates_nothing() {
    let fixed = TriMeshFlags::FIX_INTERNAL_EDGES;
    for (flags, dispatcher) in
        [(fixed, every()), (TriMeshFlags::empty(), SbbkDispatcher::default())]
    {
        let head = shape_with(&mesh::monkey_head(), flags);
        for (name, shape) in shapes(0.6).into_iter().chain([("floor", floor())]) {
            let mut random = Rand32::new(5);
            let question = |pose, flipped| Question::new(&head, &*shape, pose).flipped(flipped);
            for (flipped, stride) in [(false, 1e-4), (true, 1e-3), (false, 6e-3)] {
                let starts = (0..200).map(|_| near_pose(&mut random, &head, &shape, 0.012));
                let is_good = |&pose: &Pose| {
                    let found = question(pose, flipped).fresh(&every());
                    found.len() > 1 && found.iter().all(|manifold| distance(manifold) > 0.011)
                };
                let start = { starts }.find(is_good).expect("most ways end near the mesh");
                let poses: Vec<Pose> =
                    (0..20).map(|_| nudge(&mut random, stride) * start).collect();
                let mut pair = Pair::<ContactManifoldData, ContactData>::default();
                // What the search has needed is given back by then.
                for &pose in poses.iter().cycle().take(20 * 100) {
                    pair.ask(&dispatcher, &question(pose, flipped));
                }
                for &pose in poses.iter().cycle().take(20 * 4) {
                    let question = question(pose, flipped);
                    let allocated = measure(|| _ = pair.ask(&dispatcher, &question));
                    assert_eq!(allocated.count_total, 0, "{name}, {stride}: {allocated:?}");
                }
            }
        }
    }
}
