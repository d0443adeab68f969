use super::terrain::{Terrain, place};
use crate::prelude::*;
use rapier3d::parry::shape::{HeightFieldCellStatus, HeightFieldFlags};

/// Would catch answers for a field that is no longer there, where a host keeps the workspace over
/// an edit.
#[test]
fn an_edited_field_is_noticed() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(7);
    let mut terrain = Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 1.0, 4.0));
    let head = shape(&mesh::monkey_head());
    let pose = place(&mut random, &terrain, &head, 0.1);
    let mut pair: Pair = Pair::default();
    let check = |terrain: &Terrain, pair: &mut Pair| {
        let question = Question::new(&terrain.field, &head, pose);
        let expected = question.fresh(&dispatcher);
        assert_same(&pair.ask(&dispatcher, &question).manifolds, &expected, 0.0);
        expected.len()
    };
    assert!(check(&terrain, &mut pair) > 0);
    terrain.field.set_scale(Vec3::new(5.0, 1.1, 4.5));
    assert!(check(&terrain, &mut pair) > 0);
    terrain.field.set_scale(Vec3::new(5.5, 1.1, 4.5));
    assert!(check(&terrain, &mut pair) > 0);
    terrain.field.set_flags(HeightFieldFlags::FIX_INTERNAL_EDGES);
    check(&terrain, &mut pair);
    terrain = Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 1.0, 4.0));
    check(&terrain, &mut pair);
    // A hole where the contacts are, seen at the next motion.
    for manifold in Question::new(&terrain.field, &head, pose).fresh(&dispatcher) {
        let cell = manifold.subshape1 as usize % (14 * 17);
        terrain.field.set_cell_status(cell % 14, cell / 14, HeightFieldCellStatus::CELL_REMOVED);
    }
    let moved = Question::new(&terrain.field, &head, nudge(&mut random, 1e-5) * pose);
    let expected = moved.fresh(&dispatcher);
    assert_same(&pair.ask(&dispatcher, &moved).manifolds, &expected, 0.0);
}

/// Would catch memory and counts for a mesh that is far from the ground.
#[test]
fn a_far_mesh_gets_no_workspace() {
    let (dispatcher, mut random) = (SbbkDispatcher::default(), Rand32::new(7));
    let terrain = Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 1.0, 4.0));
    let head = shape(&mesh::monkey_head());
    let near = place(&mut random, &terrain, &head, 0.1);
    for is_flipped in [false, true] {
        for (height, is_near) in [(0.0, true), (3.0, false), (-3.0, false)] {
            let pose = Pose::from_translation(height * Vec3::Y) * near;
            let question = Question::new(&terrain.field, &head, pose).flipped(is_flipped);
            let mut pair: Pair = Pair::default();
            pair.ask(&dispatcher, &question);
            assert_eq!(pair.workspace.is_some(), is_near, "{height}");
            assert_eq!(pair.manifolds.is_empty(), !is_near, "{height}");
        }
    }
    assert_eq!(dispatcher.stats().pairs, 2);
}
