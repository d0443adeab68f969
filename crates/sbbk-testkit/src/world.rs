//! Worlds described by numbers: contacts of the solver, and a hash of all bits.

use std::hash::{DefaultHasher, Hasher};

use rapier3d::geometry::ContactPair;
use rapier3d::pipeline::PhysicsWorld;

/// The contacts that the solver has: clusters where Rapier makes them of several manifolds.
pub fn solver_points(world: &PhysicsWorld) -> usize {
    let manifolds = world.contact_pairs().flat_map(|pair| pair.solver_manifolds());
    manifolds.map(|manifold| manifold.data.solver_contacts.len()).sum()
}

/// Returns a hash of what a step changes in a world, bit for bit. It has poses and velocities of
/// bodies, and all contacts with order, places, features and impulses. Contact pairs are sorted by
/// their colliders, because the order of Rapier's graph is not defined.
pub fn fingerprint(world: &PhysicsWorld) -> u64 {
    let mut hash = DefaultHasher::new();
    let mut add = |bits: u32| hash.write_u32(bits);
    for (_, body) in world.bodies.iter() {
        let pose = body.position();
        let numbers = pose.translation.to_array().into_iter().chain(pose.rotation.to_array());
        let velocities = [body.linvel(), body.angvel()];
        let velocities = velocities.into_iter().flat_map(|velocity| velocity.to_array());
        numbers.chain(velocities).for_each(|number| add(number.to_bits()));
    }
    let mut pairs: Vec<&ContactPair> = world.narrow_phase.contact_pairs().collect();
    let key = |pair: &ContactPair| [pair.collider1, pair.collider2].map(|c| c.into_raw_parts());
    pairs.sort_unstable_by_key(|pair| key(pair));
    for pair in pairs {
        for (index, generation) in key(pair) {
            add(index);
            add(generation);
        }
        add_contacts(pair, &mut add);
    }
    hash.finish()
}

fn add_contacts(pair: &ContactPair, add: &mut impl FnMut(u32)) {
    for manifold in pair.manifolds() {
        [manifold.subshape1, manifold.subshape2].into_iter().for_each(&mut *add);
        manifold.local_n1.to_array().into_iter().for_each(|x| add(x.to_bits()));
        for point in &manifold.points {
            let places = [point.local_p1, point.local_p2].map(|place| place.to_array());
            places.into_iter().flatten().for_each(|x| add(x.to_bits()));
            [point.dist, point.data.impulse].into_iter().for_each(|x| add(x.to_bits()));
            [point.fid1.0, point.fid2.0].into_iter().for_each(&mut *add);
        }
    }
}

/// Would catch a hash without a body, or without the contacts. After a step with heads in the floor
/// all bodies are put back to the start.
#[test]
fn a_moved_body_or_a_new_contact_changes_the_hash() {
    use crate::scene::{MonkeyPile, Scene};

    let mut built = MonkeyPile::with_heads(2).build();
    let world = &mut built.world;
    world.gravity = Default::default();
    world.bodies[built.watched[0]].set_translation(0.5 * rapier3d::math::Vector::Y, true);
    let (before, bodies) = (fingerprint(world), world.bodies.clone());
    let body = &mut world.bodies[built.watched[1]];
    let place = body.translation();
    body.set_translation(place.with_z(place.z.next_up()), true);
    assert_ne!(before, fingerprint(world));
    world.step();
    assert!(world.contact_pairs().any(|pair| pair.has_any_active_contact()));
    world.bodies = bodies;
    assert_ne!(before, fingerprint(world));
}
