//! Contacts lost and added, against Parry's routine on every triangle.

use std::collections::BTreeMap;

use glamx::Pose3;
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;
use rapier3d::parry::query::{DefaultQueryDispatcher, PersistentQueryDispatcher};
use rapier3d::parry::shape::Shape;

use crate::metrics::ErrorCount;

/// Distances this close to the prediction distance, as a share of it, may go either way: kept points are only moved
/// along, by Parry's rules, while a pair moves by up to a thousandth of a unit.
const SET_BAND: Real = 0.01;
/// A depth off by more than this share of the prediction distance is wrong.
const DEPTH_BAND: Real = 0.05;

/// The least distance of each triangle that Parry's routine gives points, at one pose.
pub(super) struct Expected {
    distances: BTreeMap<u32, Real>,
    prediction: Real,
}

impl Expected {
    /// `pos12` is the pose of the second in the frame of the first. In the other order Parry's routine may answer
    /// otherwise, so it is asked in the same. Flags of the mesh are left out of account.
    pub fn new(
        mesh: &SharedShape,
        shape: &SharedShape,
        pos12: &Pose3,
        prediction: Real,
        is_mesh_first: bool,
    ) -> Self {
        let triangles = mesh.as_trimesh().into_iter().flat_map(|mesh| mesh.triangles());
        let mut distances = BTreeMap::new();
        for (index, triangle) in triangles.enumerate() {
            let mut manifold = ContactManifold::new();
            let pair: [&dyn Shape; 2] =
                if is_mesh_first { [&triangle, &*shape.0] } else { [&*shape.0, &triangle] };
            DefaultQueryDispatcher
                .contact_manifold_convex_convex(
                    pos12,
                    pair[0],
                    pair[1],
                    None,
                    None,
                    prediction,
                    &mut manifold,
                )
                .expect("Parry has contacts of these shapes with triangles");
            if let Some(distance) = least(&manifold) {
                distances.insert(index as u32, distance);
            }
        }
        Self { distances, prediction }
    }

    /// Judges the manifolds of an answer; `triangle` tells the triangle of each.
    pub fn judge(
        &self,
        manifolds: &[ContactManifold],
        triangle: impl Fn(&ContactManifold) -> u32,
    ) -> ErrorCount {
        let band = SET_BAND * self.prediction;
        let mut errors = ErrorCount { mesh_pairs: 1, sampled_from: 1, ..ErrorCount::default() };
        let mut reported = BTreeMap::new();
        for manifold in manifolds {
            let Some(distance) = least(manifold).filter(|&d| d <= self.prediction) else {
                continue;
            };
            errors.reported += 1;
            let expected = self.distances.get(&triangle(manifold)).copied();
            let is_true = expected.is_some_and(|expected| expected <= self.prediction + band);
            let is_repeated = reported.insert(triangle(manifold), distance).is_some();
            // Just within here, just beyond there.
            let is_doubtful = distance > self.prediction - band;
            errors.phantom += usize::from(is_repeated || !is_true && !is_doubtful);
            let is_off = expected
                .is_some_and(|expected| (expected - distance).abs() > DEPTH_BAND * self.prediction);
            errors.wrong_depth += usize::from(is_true && is_off);
        }
        for (triangle, &distance) in &self.distances {
            errors.true_pairs += usize::from(distance <= self.prediction);
            let must = distance < self.prediction - band;
            errors.missed += usize::from(must && !reported.contains_key(triangle));
        }
        errors
    }
}

fn least(manifold: &ContactManifold) -> Option<Real> {
    manifold.points.iter().map(|point| point.dist).reduce(Real::min)
}
