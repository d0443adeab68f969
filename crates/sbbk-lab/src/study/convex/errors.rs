//! Contacts lost and added, against Parry's routine on every triangle and every part of the shape.

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

/// A triangle of the mesh and a part of the shape, 0 if it has no parts.
pub(super) type Subshapes = (u32, u32);

/// The least distance of each triangle and part that Parry's routine gives points, at one pose.
pub(super) struct Expected {
    distances: BTreeMap<Subshapes, Real>,
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
        let mut distances = BTreeMap::new();
        for (part_index, (pose, part)) in (0..).zip(parts(shape)) {
            let pos12 = if is_mesh_first { pos12 * pose } else { pose.inverse() * pos12 };
            let triangles = mesh.as_trimesh().into_iter().flat_map(|mesh| mesh.triangles());
            for (triangle_index, triangle) in (0..).zip(triangles) {
                let pair: [&dyn Shape; 2] =
                    if is_mesh_first { [&triangle, part] } else { [part, &triangle] };
                if let Some(distance) = distance(&pos12, pair, prediction) {
                    distances.insert((triangle_index, part_index), distance);
                }
            }
        }
        Self { distances, prediction }
    }

    /// Judges the manifolds of an answer; `subshapes` tells the triangle and the part of each.
    pub fn judge(
        &self,
        manifolds: &[ContactManifold],
        subshapes: impl Fn(&ContactManifold) -> Subshapes,
    ) -> ErrorCount {
        let band = SET_BAND * self.prediction;
        let mut errors = ErrorCount { mesh_pairs: 1, sampled_from: 1, ..ErrorCount::default() };
        let mut reported = BTreeMap::new();
        for manifold in manifolds {
            let Some(distance) = least(manifold).filter(|&d| d <= self.prediction) else {
                continue;
            };
            errors.reported += 1;
            let expected = self.distances.get(&subshapes(manifold)).copied();
            let is_true = expected.is_some_and(|expected| expected <= self.prediction + band);
            let is_repeated = reported.insert(subshapes(manifold), distance).is_some();
            // Just within here, just beyond there.
            let is_doubtful = distance > self.prediction - band;
            errors.phantom += usize::from(is_repeated || !is_true && !is_doubtful);
            let is_off = expected
                .is_some_and(|expected| (expected - distance).abs() > DEPTH_BAND * self.prediction);
            errors.wrong_depth += usize::from(is_true && is_off);
        }
        for (subshapes, &distance) in &self.distances {
            errors.true_pairs += usize::from(distance <= self.prediction);
            let must = distance < self.prediction - band;
            errors.missed += usize::from(must && !reported.contains_key(subshapes));
        }
        errors
    }
}

/// The convex parts of a shape and their poses in its frame.
fn parts(shape: &SharedShape) -> Vec<(Pose3, &dyn Shape)> {
    match shape.as_compound() {
        Some(compound) => compound.shapes().iter().map(|(pose, part)| (*pose, &*part.0)).collect(),
        None => vec![(Pose3::IDENTITY, &*shape.0)],
    }
}

/// The least distance of the points that Parry's routine gives two convex shapes.
fn distance(pos12: &Pose3, pair: [&dyn Shape; 2], prediction: Real) -> Option<Real> {
    let mut manifold: ContactManifold = ContactManifold::new();
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
    least(&manifold)
}

fn least(manifold: &ContactManifold) -> Option<Real> {
    manifold.points.iter().map(|point| point.dist).reduce(Real::min)
}
