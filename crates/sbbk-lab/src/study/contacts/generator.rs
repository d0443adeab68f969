//! Two codes for one task: the manifold of two triangles.

use glamx::Pose3;
use rapier_integration::TriangleContacts;
use rapier3d::geometry::{ContactData, ContactManifold};
use rapier3d::math::Real;
use rapier3d::parry::query::{DefaultQueryDispatcher, PersistentQueryDispatcher};
use rapier3d::parry::shape::Triangle;

/// Brings one manifold up to date, with what it keeps to do so.
pub(super) trait Generator: Default {
    fn update(&mut self, pos12: &Pose3, triangles: &[Triangle; 2], prediction: Real);

    fn manifold(&self) -> &ContactManifold;
}

/// The call that stock Parry makes for each pair of triangles.
#[derive(Default)]
pub(super) struct Parrys(ContactManifold);

impl Generator for Parrys {
    fn update(&mut self, pos12: &Pose3, [one, two]: &[Triangle; 2], prediction: Real) {
        DefaultQueryDispatcher
            .contact_manifold_convex_convex(pos12, one, two, None, None, prediction, &mut self.0)
            .expect("Parry answers for two triangles");
    }

    fn manifold(&self) -> &ContactManifold {
        &self.0
    }
}

/// SBBK's, with its features kept as the dispatcher keeps them.
#[derive(Default)]
pub(super) struct Sbbks {
    contacts: TriangleContacts<ContactData>,
    manifold: ContactManifold,
}

impl Generator for Sbbks {
    fn update(&mut self, pos12: &Pose3, [one, two]: &[Triangle; 2], prediction: Real) {
        self.contacts.update(pos12, [one, two], [None; 2], prediction, &mut self.manifold);
    }

    fn manifold(&self) -> &ContactManifold {
        &self.manifold
    }
}
