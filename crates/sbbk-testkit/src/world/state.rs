//! State of a world between two steps.

use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::pipeline::PhysicsWorld;

/// Contacts, heights and penetration after a step.
///
/// The contacts belong to the start of the last step. Contacts of recycled pairs are older.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorldState {
    /// Manifolds with at least one point.
    pub contact_manifold_count: usize,
    pub point_count: usize,
    /// Mean over the touching pairs of the depth of their deepest point, in units; a pair whose
    /// points are all apart counts as 0.
    pub mean_penetration: f64,
    /// Depth of the deepest point of all, in units.
    pub max_penetration: f64,
    /// Mean height of the watched bodies' centres of mass, in units.
    pub mean_height: f64,
}

impl WorldState {
    /// State of `world`, with heights of the bodies `watched`.
    pub fn of(world: &PhysicsWorld, watched: &[RigidBodyHandle]) -> Self {
        let mut state = Self::default();
        state.add_contacts(world);
        let height = |&body: &RigidBodyHandle| f64::from(world.bodies[body].center_of_mass().y);
        state.mean_height = watched.iter().map(height).sum::<f64>() / watched.len().max(1) as f64;
        state
    }

    fn add_contacts(&mut self, world: &PhysicsWorld) {
        let mut touching_pair_count = 0_usize;
        for pair in world.narrow_phase.contact_pairs() {
            let manifolds = pair.manifolds().iter().filter(|manifold| !manifold.points.is_empty());
            self.contact_manifold_count += manifolds.clone().count();
            let depths = manifolds.flat_map(|manifold| &manifold.points).map(|point| -point.dist);
            self.point_count += depths.clone().count();
            if let Some(depth) = depths.reduce(f32::max) {
                let depth = f64::from(depth.max(0.0));
                touching_pair_count += 1;
                self.mean_penetration += depth;
                self.max_penetration = self.max_penetration.max(depth);
            }
        }
        self.mean_penetration /= touching_pair_count.max(1) as f64;
    }
}

/// The contacts that the solver has: clusters where Rapier makes them of several manifolds.
pub fn solver_points(world: &PhysicsWorld) -> usize {
    let manifolds = world.contact_pairs().flat_map(|pair| pair.solver_manifolds());
    manifolds.map(|manifold| manifold.data.solver_contacts.len()).sum()
}
