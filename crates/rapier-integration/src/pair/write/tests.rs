use oorandom::Rand32;
use parry3d::math::Vector;

use super::*;

type Manifold = ContactManifold<u32, ()>;

fn manifold(name: u32) -> Manifold {
    let mut manifold = Manifold::with_data(name, 0, name + 1);
    let (at, id) = (Vector::ZERO, PackedFeatureId::UNKNOWN);
    manifold.points.push(TrackedContact::new(at, at, id, id, 0.0));
    manifold
}

/// Would catch manifolds that are lost, doubled or out of order, and data of another pair in a
/// recycled manifold.
#[test]
fn kept_manifolds_are_in_the_order_in_which_they_were_kept() {
    let mut random = Rand32::new(3);
    let mut manifolds: Vec<Manifold> = Vec::new();
    let (mut next_name, mut stayed, mut moved) = (0, 0, 0);
    for _ in 0..3000 {
        let is_lively = random.rand_float() < 0.6;
        let mut chance = |share: f32| is_lively && random.rand_float() < share;
        let before: Vec<u32> = manifolds.iter().map(|manifold| manifold.subshape1).collect();
        let mut expected = Vec::new();
        let mut writer = Writer::begin(&mut manifolds, None);
        for (index, name) in before.iter().enumerate() {
            if chance(0.1) || before.len() < 8 && index == 0 {
                next_name += 1;
                let spare = writer.take_spare();
                assert!(spare.points.is_empty() && spare.data == 0);
                writer.keep_new(manifold(next_name));
                expected.push(next_name);
            }
            if chance(0.1) {
                writer.retire(index);
            } else {
                writer.keep_old(index);
                expected.push(*name);
            }
        }
        if before.is_empty() {
            next_name += 1;
            writer.keep_new(manifold(next_name));
            expected.push(next_name);
        }
        writer.end();
        let names: Vec<u32> = manifolds.iter().map(|manifold| manifold.subshape1).collect();
        assert_eq!(names, expected);
        assert!(manifolds.iter().all(|manifold| manifold.data == manifold.subshape1 + 1));
        *(if names == before { &mut stayed } else { &mut moved }) += 1;
    }
    assert!(stayed > 300 && moved > 300, "{stayed} stayed, {moved} moved");
}

/// Would catch spare manifolds without end.
#[test]
fn spare_manifolds_are_limited() {
    let count = 2 * MOST_SPARE as u32;
    let mut manifolds: Vec<Manifold> = (0..count).map(manifold).collect();
    let mut writer = Writer::begin(&mut manifolds, None);
    (0..count).for_each(|index| writer.retire(index as usize));
    assert_eq!(writer.pool.spare.len(), MOST_SPARE);
}
