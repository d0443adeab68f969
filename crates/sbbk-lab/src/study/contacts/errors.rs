//! What is wrong with contacts, normals included.

use std::iter::Sum;
use std::ops::AddAssign;

use rapier3d::geometry::ContactManifold;
use rapier3d::math::Real;
use sbbk_core::truth::TruthPair;
use serde::Serialize;

use crate::backend::{Answer, Question};
use crate::metrics::{ErrorCount, Truth, is_right_depth};

/// Degrees between a normal and the true one beyond which it is wrong.
pub(in crate::study) const NORMAL_BAND: f64 = 0.1;

/// Right and wrong contacts, summed over the mesh pairs that were judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ContactErrors {
    /// Missed, phantom and wrong depth.
    #[serde(flatten)]
    pub pairs: ErrorCount,
    /// Reported true pairs of right depth whose normal the truth says is the only right one.
    pub judged_normals: usize,
    /// Those whose normal is off by more than 0.1 degrees.
    pub wrong_normal: usize,
}

impl ContactErrors {
    /// Judges the manifolds that answer a question against its truth.
    pub fn of(truth: &Truth, question: Question, manifolds: &[ContactManifold]) -> Self {
        let pairs = truth.judge(&Answer::new(question, manifolds));
        let normals = manifolds.iter().filter_map(|manifold| {
            let truth = truth.contact(manifold.subshape1, manifold.subshape2)?;
            is_wrong_normal(truth, manifold, question.prediction)
        });
        Self { pairs, ..Self::default() }.with_normals(normals)
    }

    /// Judges the manifold of a pair of triangles that is truly within the prediction distance.
    pub fn of_pair(truth: &TruthPair, manifold: &ContactManifold, prediction: Real) -> Self {
        let distance = distance(manifold).filter(|distance| *distance <= prediction);
        let is_wrong_depth = distance.is_some_and(|d| !is_right_depth(d, truth, prediction));
        let pairs = ErrorCount {
            true_pairs: 1,
            reported: usize::from(distance.is_some()),
            missed: usize::from(distance.is_none()),
            wrong_depth: usize::from(is_wrong_depth),
            ..ErrorCount::default()
        };
        Self { pairs, ..Self::default() }.with_normals(is_wrong_normal(truth, manifold, prediction))
    }

    pub(in crate::study) fn with_normals(
        mut self,
        are_wrong: impl IntoIterator<Item = bool>,
    ) -> Self {
        for is_wrong in are_wrong {
            self.judged_normals += 1;
            self.wrong_normal += usize::from(is_wrong);
        }
        self
    }
}

impl AddAssign for ContactErrors {
    fn add_assign(&mut self, other: Self) {
        self.pairs += other.pairs;
        self.judged_normals += other.judged_normals;
        self.wrong_normal += other.wrong_normal;
    }
}

impl Sum for ContactErrors {
    fn sum<I: Iterator<Item = Self>>(errors: I) -> Self {
        errors.fold(Self::default(), |mut total, errors| {
            total += errors;
            total
        })
    }
}

/// Whether the normal of a manifold is wrong. `None` when that cannot be said: nothing is reported,
/// the depth is wrong already, or the true normal is not the only one.
fn is_wrong_normal(
    truth: &TruthPair,
    manifold: &ContactManifold,
    prediction: Real,
) -> Option<bool> {
    let distance = distance(manifold).filter(|distance| *distance <= prediction)?;
    let is_judged = truth.normal_is_unique && is_right_depth(distance, truth, prediction);
    is_judged.then(|| {
        let degrees = manifold.local_n1.as_dvec3().angle_between(truth.normal).to_degrees();
        // A zero normal is at no angle to anything.
        degrees.is_nan() || degrees > NORMAL_BAND
    })
}

/// Signed distance of the deepest point.
pub(in crate::study) fn distance(manifold: &ContactManifold) -> Option<Real> {
    manifold.points.iter().map(|point| point.dist).reduce(Real::min)
}

#[cfg(test)]
mod tests {
    use glamx::{DVec3, Quat, Vec3};
    use rapier3d::parry::query::TrackedContact;
    use rapier3d::parry::shape::PackedFeatureId;

    use super::*;

    const PREDICTION: Real = 0.02;

    fn manifold(normal: Vec3, distance: Real) -> ContactManifold {
        let fid = PackedFeatureId::UNKNOWN;
        let mut manifold = ContactManifold::new();
        manifold.points.push(TrackedContact::new(Vec3::ZERO, Vec3::ZERO, fid, fid, distance));
        manifold.local_n1 = normal;
        manifold
    }

    /// Would catch a judge that lets wrong normals pass, blames right ones, or judges where there
    /// is nothing to judge.
    #[test]
    fn normals_are_judged_where_the_truth_is_sure() {
        let normal = DVec3::new(0.6, 0.0, 0.8);
        let distance = -0.01;
        let truth =
            TruthPair { triangle1: 0, triangle2: 0, distance, normal, normal_is_unique: true };
        let turned = |degrees: Real| Quat::from_rotation_y(degrees.to_radians()) * normal.as_vec3();
        let judged = |truth: &TruthPair, normal: Vec3, distance: Real| {
            let errors = ContactErrors::of_pair(truth, &manifold(normal, distance), PREDICTION);
            (errors.judged_normals, errors.wrong_normal, errors.pairs.wrong() + errors.wrong_normal)
        };
        let right = [turned(0.0), turned(0.09), 5.0 * turned(-0.09)];
        for normal in right {
            assert_eq!(judged(&truth, normal, -0.01), (1, 0, 0), "{normal}");
        }
        let wrong = [turned(0.11), turned(-0.11), -turned(0.0), Vec3::ZERO, Vec3::NAN];
        for normal in wrong {
            assert_eq!(judged(&truth, normal, -0.01), (1, 1, 1), "{normal}");
        }
        // A wrong depth is one error, not two.
        assert_eq!(judged(&truth, turned(90.0), -0.02), (0, 0, 1));
        // Beyond the prediction distance nothing is reported: the pair is missed.
        assert_eq!(judged(&truth, turned(90.0), 0.03), (0, 0, 1));
        let unsure = TruthPair { normal_is_unique: false, ..truth };
        assert_eq!(judged(&unsure, turned(90.0), -0.01), (0, 0, 0));
    }
}
