//! Contacts lost and added, against Parry's routine on every triangle and every part of the shape.
//!
//! Where the cores of two shapes just touch, that routine may see no contact at all. A contact that it does not see is not
//! counted as added if by Parry's own distance it is there.

use std::collections::BTreeMap;

use glamx::Pose3;
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;
use rapier3d::parry::query::{DefaultQueryDispatcher, PersistentQueryDispatcher, QueryDispatcher};
use rapier3d::parry::shape::{Shape, Triangle};

use crate::metrics::ErrorCount;

/// Distances this close to the prediction distance, as a share of it, may go either way: kept points are only moved
/// along, by Parry's rules, while a pair moves by up to a thousandth of a unit.
const SET_BAND: Real = 0.01;
/// A depth off by more than this share of the prediction distance is wrong.
const DEPTH_BAND: Real = 0.05;

/// A triangle of the mesh and a part of the shape, 0 if it has no parts.
pub(super) type Subshapes = (u32, u32);

/// The truth about one pose.
pub(super) struct Expected<'a> {
    /// Of each triangle and part that Parry's routine gives points, the least.
    distances: BTreeMap<Subshapes, Real>,
    pose: Posed<'a>,
    prediction: Real,
}

/// A mesh and a shape at a pose.
pub(super) struct Posed<'a> {
    pub mesh: &'a SharedShape,
    pub shape: &'a SharedShape,
    /// The pose of the second in the frame of the first. In the other order Parry's routine may answer otherwise, so
    /// it is asked in the same, and with the inverse of an inverse where stock does so.
    pub pos12: Pose3,
    pub is_mesh_first: bool,
}

impl Posed<'_> {
    /// Asks about a triangle, whose flags are left out of account, and a part.
    fn ask<T>(
        &self,
        triangle: &Triangle,
        (pose, part): (Pose3, &dyn Shape),
        question: impl FnOnce(&Pose3, [&dyn Shape; 2]) -> T,
    ) -> T {
        if self.is_mesh_first {
            question(&(self.pos12 * pose), [triangle, part])
        } else {
            question(&(pose.inverse() * self.pos12.inverse().inverse()), [part, triangle])
        }
    }

    /// By Parry's measure of distance, not by its contact routine.
    fn distance(&self, (triangle, part): Subshapes) -> Real {
        let triangle = self.mesh.as_trimesh().map(|mesh| mesh.triangle(triangle));
        let part = parts(self.shape).into_iter().nth(part as usize);
        let asked = triangle.zip(part).and_then(|(triangle, part)| {
            self.ask(&triangle, part, |pos12, [shape1, shape2]| {
                DefaultQueryDispatcher.distance(pos12, shape1, shape2).ok()
            })
        });
        asked.map_or(Real::INFINITY, |answer| answer.distance)
    }
}

impl<'a> Expected<'a> {
    /// Asks Parry's routine about all triangles and parts.
    pub fn new(pose: Posed<'a>, prediction: Real) -> Self {
        let mut distances = BTreeMap::new();
        for (part_index, part) in (0..).zip(parts(pose.shape)) {
            let triangles = pose.mesh.as_trimesh().into_iter().flat_map(|mesh| mesh.triangles());
            for (triangle_index, triangle) in (0..).zip(triangles) {
                let least =
                    pose.ask(&triangle, part, |pos12, pair| distance(pos12, pair, prediction));
                if let Some(distance) = least {
                    distances.insert((triangle_index, part_index), distance);
                }
            }
        }
        Self { distances, pose, prediction }
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
            let is_true = match expected {
                Some(expected) => expected <= self.prediction + band,
                None => self.pose.distance(subshapes(manifold)) <= self.prediction + band,
            };
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
