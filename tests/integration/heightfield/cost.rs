use allocation_counter::measure;
use glamx::{Quat, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::math::{Pose, Real};
use rapier3d::parry::shape::{HeightField, HeightFieldFlags};
use rapier3d::parry::utils::Array2;
use sbbk_testkit::mesh;

use super::terrain::{Terrain, rolling};
use crate::support::{Pair, Question, counting, nudge, shape, touching};

/// Would catch a descent that looks at more of a terrain than what lies under the mesh: the same
/// mesh on a field of the same cells, of a thousand times as many. And loss of digits far from the
/// middle of it.
#[test]
fn a_million_cells_cost_what_is_under_the_mesh() {
    let head = shape(&mesh::monkey_head());
    let visited = |cells: u32, x: Real| {
        let size = 0.1 * cells as Real;
        // The same hills, wherever the field ends.
        let lines = cells as usize + 1;
        let wave = |k: usize| (k as f32 - 0.5 * cells as f32) * 0.1;
        let heights = Array2::from_fn(lines, lines, |i, j| {
            0.3 * (1.7 * wave(i)).sin() * (1.3 * wave(j)).cos()
        });
        let field = HeightField::new(heights, Vec3::new(size, 1.0, size));
        let terrain = Terrain { field, mesh: head.clone(), ids: Vec::new() };
        let dispatcher = counting();
        let pose = Pose::from_parts(Vec3::new(x, 0.6, x), Quat::from_rotation_y(0.4));
        let count = Question::new(&terrain.field, &head, pose).fresh(&dispatcher).len();
        (count, dispatcher.stats().descent.cells)
    };
    let (small_count, small) = visited(32, 0.1);
    let (large_count, large) = visited(1000, 0.1);
    assert!(small_count > 10, "{small_count} contacts");
    assert!(large_count.abs_diff(small_count) <= 2, "{large_count} for {small_count}");
    // Two units across are four hundred cells; a few layers of nodes are above them.
    assert!(large < 10 * 400, "{large} cells");
    assert!(large <= small + small / 4, "{large} for {small}");
    // In a corner of it.
    let (_, far) = visited(1000, 48.7);
    assert!(far < 10 * 400, "{far} cells");
    let (count, none) = visited(1000, 60.0);
    assert_eq!((count, none), (0, 0));
}

/// Would catch manifolds, lists of candidates and descents that are made anew in each step.
#[test]
fn steady_contact_allocates_nothing() {
    let mut terrain = Terrain::new(rolling(6.0, 20, 0.5));
    terrain.field.set_flags(HeightFieldFlags::FIX_INTERNAL_EDGES);
    let head = shape(&mesh::monkey_head());
    for (stride, flipped) in [(1e-4, false), (1e-3, true), (2.5e-2, false)] {
        let dispatcher = counting();
        let mut random = Rand32::new(8);
        let start = touching(&mut random, [&terrain.mesh, &head], 0.02);
        let poses: Vec<Pose> = (0..20).map(|_| nudge(&mut random, 0.5 * stride) * start).collect();
        let mut pair = Pair::<ContactManifoldData, ContactData>::default();
        let question = |pose| Question::new(&terrain.field, &head, pose).flipped(flipped);
        for &pose in poses.iter().cycle().take(20 * 20) {
            pair.ask(&dispatcher, &question(pose));
        }
        for &pose in poses.iter().cycle().take(20 * 5) {
            let allocated = measure(|| _ = pair.ask(&dispatcher, &question(pose)));
            assert!(!pair.manifolds.is_empty());
            assert_eq!(allocated.count_total, 0, "{stride}: {allocated:?}");
        }
        assert!(dispatcher.stats().reused_queries + dispatcher.stats().descended_queries > 400);
    }
}
