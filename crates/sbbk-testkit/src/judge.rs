//! Wrong contacts of a dispatcher, by comparison with brute force in f64.

use std::collections::{HashMap, HashSet};
use std::ops::AddAssign;

use glamx::{DPose3, DVec3, Vec3};
use rapier3d::math::{Pose, Real};
use rapier3d::parry::bounding_volume::BoundingVolume;
use rapier3d::parry::query::ContactManifold;
use rapier3d::parry::shape::{SharedShape, TriMesh};
use sbbk_truth::{ConvexTruth, TruthPair, pairs_within};
use serde::Serialize;

use crate::truth::{affine, convex_body};

/// Share of the prediction distance within which a pair may be reported or not. Higher: real
/// misses pass; lower: rounding to f32 counts as an error.
const SET_BAND: f64 = 0.01;
/// Tolerated errors of the distance of two triangles, as shares of the prediction distance and of
/// the depth.
const MESH_BANDS: [f64; 2] = [0.05, 0.0];
/// [`MESH_BANDS`] of a triangle and a convex shape.
const CONVEX_BANDS: [f64; 2] = [0.01, 1.0e-5];
/// Tolerated angle of a normal, in degrees.
const NORMAL_BAND: f64 = 0.1;

/// Right and wrong contacts, summed over the pairs of shapes that were judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Errors {
    /// Pairs of shapes.
    pub pairs: usize,
    /// True contacts within the prediction distance.
    pub true_pairs: usize,
    pub missed: usize,
    /// Reported contacts that are farther than the prediction distance, or were reported before.
    pub phantom: usize,
    /// Reported true contacts with a wrong distance or depth.
    pub wrong_depth: usize,
    /// Contacts of right depth with a wrong normal, where right ones are known.
    pub wrong_normal: usize,
}

impl Errors {
    pub fn without_normals(self) -> Self {
        Self { wrong_normal: 0, ..self }
    }
}

impl AddAssign for Errors {
    fn add_assign(&mut self, other: Self) {
        self.pairs += other.pairs;
        self.true_pairs += other.true_pairs;
        self.missed += other.missed;
        self.phantom += other.phantom;
        self.wrong_depth += other.wrong_depth;
        self.wrong_normal += other.wrong_normal;
    }
}

/// All true contacts of two shapes at a pose, by their subshapes.
pub struct Truth {
    /// Normals point out of the shape number `side`, in its frame.
    contacts: HashMap<[u32; 2], ConvexTruth>,
    side: usize,
    prediction: Real,
    bands: [f64; 2],
}

impl Truth {
    /// Computes the truth for a mesh and a mesh, convex shape or compound. Takes about 10 µs for
    /// each pair of triangles with near boxes.
    ///
    /// # Panics
    ///
    /// If neither shape is a mesh.
    pub fn of([shape1, shape2]: [&SharedShape; 2], pos12: &Pose, prediction: Real) -> Self {
        match (shape1.as_trimesh(), shape2.as_trimesh()) {
            (Some(mesh1), Some(mesh2)) => {
                let one = near(mesh1, shape2, pos12, prediction);
                let two = near(mesh2, shape1, &pos12.inverse(), prediction);
                Self::of_meshes([&one, &two], pos12, prediction)
            }
            (Some(mesh), None) => Self::of_parts(mesh, shape2, pos12, true, prediction),
            (None, Some(mesh)) => Self::of_parts(mesh, shape1, pos12, false, prediction),
            (None, None) => panic!("one of the shapes must be a mesh"),
        }
    }

    fn of_meshes(near: [&[Corners]; 2], pos12: &Pose, prediction: Real) -> Self {
        let margin = f64::from(prediction) * (1.0 + SET_BAND);
        let corners = near.map(|near| near.iter().map(|&(_, corners)| corners));
        let pairs = pairs_within(corners, DPose3::from(*pos12), margin).into_iter().map(|pair| {
            let triangles = [0, 1].map(|i| near[i][pair.triangles[i] as usize].0);
            TruthPair { triangles, ..pair }
        });
        Self::of_pairs(pairs, prediction)
    }

    /// Takes the pairs of triangles of two meshes a little beyond the prediction distance.
    pub fn of_pairs(pairs: impl IntoIterator<Item = TruthPair>, prediction: Real) -> Self {
        let contacts = pairs.into_iter().map(|pair| {
            let normals = pair.normal_is_unique.then_some(pair.normal).into_iter().collect();
            let truth = ConvexTruth { distance: pair.distance, normals };
            (pair.triangles, truth)
        });
        Self { contacts: contacts.collect(), side: 0, prediction, bands: MESH_BANDS }
    }

    /// Computes the truth for a mesh and a shape of convex parts. A shape without parts is part 0.
    fn of_parts(
        mesh: &TriMesh,
        shape: &SharedShape,
        pos12: &Pose,
        is_mesh_first: bool,
        prediction: Real,
    ) -> Self {
        let single = [(Pose::IDENTITY, shape.clone())];
        let parts = shape.as_compound().map_or(&single[..], |compound| compound.shapes());
        let reach = f64::from(prediction) * (1.0 + SET_BAND);
        let (pose, to_shape) = match is_mesh_first {
            true => (*pos12, affine(pos12).inverse()),
            false => (pos12.inverse(), affine(pos12)),
        };
        let mut contacts = HashMap::new();
        for (part_index, (place, part)) in (0..).zip(parts) {
            let (body, to_part) = (convex_body(&**part), affine(place).inverse() * to_shape);
            for (index, corners) in near(mesh, part, &(pose * *place), prediction) {
                let found = body.contact(&corners.map(|corner| to_part.transform_point3(corner)));
                if found.distance <= reach {
                    let normals = found.normals.into_iter().map(|normal| -normal).collect();
                    let pair = [index, part_index];
                    let pair = if is_mesh_first { pair } else { [part_index, index] };
                    contacts.insert(pair, ConvexTruth { normals, ..found });
                }
            }
        }
        Self { contacts, side: usize::from(is_mesh_first), prediction, bands: CONVEX_BANDS }
    }

    /// True if any two subshapes cross or touch.
    pub fn meets(&self) -> bool {
        self.contacts.values().any(|truth| truth.distance <= 0.0)
    }

    /// Counts the wrong contacts among those reported within the prediction distance.
    pub fn judge<M, C>(&self, manifolds: &[ContactManifold<M, C>]) -> Errors {
        let mut seen = HashSet::new();
        let mut errors = Errors { pairs: 1, ..Errors::default() };
        for (manifold, distance) in self.reported(manifolds) {
            let key = [manifold.subshape1, manifold.subshape2];
            let is_new = seen.insert(key);
            match self.contacts.get(&key) {
                Some(truth) if is_new => {
                    let [band, depth_band] = self.bands;
                    let band =
                        (band * f64::from(self.prediction)).max(depth_band * -truth.distance);
                    let normal = [manifold.local_n1, manifold.local_n2][self.side];
                    if (distance - truth.distance).abs() > band {
                        errors.wrong_depth += 1;
                    } else if !is_one_of(&truth.normals, normal) {
                        errors.wrong_normal += 1;
                    }
                }
                _ => errors.phantom += 1,
            }
        }
        let prediction = f64::from(self.prediction);
        for (key, truth) in &self.contacts {
            errors.true_pairs += usize::from(truth.distance <= prediction);
            let is_certain = truth.distance <= (1.0 - SET_BAND) * prediction;
            errors.missed += usize::from(is_certain && !seen.contains(key));
        }
        errors
    }

    /// Counts the wrong contacts of surfaces. One contact is missed if the meshes cross and none is
    /// reported. A distance is wrong if the triangles are farther apart.
    pub fn judge_surfaces<M, C>(&self, manifolds: &[ContactManifold<M, C>]) -> Errors {
        let band = self.bands[0] * f64::from(self.prediction);
        let is_wrong = |(manifold, distance): &(&ContactManifold<M, C>, f64)| {
            let truth = self.contacts.get(&[manifold.subshape1, manifold.subshape2]);
            *distance > 0.0 && truth.is_some_and(|truth| *distance < truth.distance - band)
        };
        let is_crossing = self.contacts.values().any(|truth| truth.distance < -band);
        Errors {
            missed: usize::from(is_crossing && self.reported(manifolds).next().is_none()),
            wrong_depth: self.reported(manifolds).filter(is_wrong).count(),
            ..self.judge(manifolds)
        }
    }

    /// Manifolds with their least distance, if it is within the prediction distance. Stock keeps
    /// farther points from earlier poses.
    fn reported<'a, M, C>(
        &self,
        manifolds: &'a [ContactManifold<M, C>],
    ) -> impl Iterator<Item = (&'a ContactManifold<M, C>, f64)> {
        let prediction = self.prediction;
        manifolds.iter().filter_map(move |manifold| {
            let distance = manifold.points.iter().map(|point| point.dist).reduce(Real::min)?;
            (distance <= prediction).then_some((manifold, distance.into()))
        })
    }
}

/// True if a normal is right, or if no right ones are known. A normal of length zero is wrong.
fn is_one_of(right: &[DVec3], normal: Vec3) -> bool {
    let angle = |right: &DVec3| normal.as_dvec3().angle_between(*right).to_degrees();
    right.is_empty() || right.iter().any(|right| angle(right) <= NORMAL_BAND)
}

/// Index and corners of a triangle.
type Corners = (u32, [DVec3; 3]);

/// Finds the triangles near the box of a shape at a pose in the frame of the mesh.
fn near(mesh: &TriMesh, other: &SharedShape, pose: &Pose, prediction: Real) -> Vec<Corners> {
    let bounds = other.compute_aabb(pose).loosened(2.0 * prediction);
    let corners = |index| mesh.triangle(index).vertices().map(|corner| corner.as_dvec3());
    mesh.bvh().intersect_aabb(&bounds).map(|index| (index, corners(index))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glamx::Quat;
    use rapier3d::parry::query::TrackedContact;
    use rapier3d::parry::shape::PackedFeatureId;

    /// Returns missed contacts, phantoms, wrong depths and wrong normals. True contacts have these
    /// distances and the normal `Y`; reported ones have a triangle, a distance and a normal.
    fn errors(truth: &[f64], reported: &[(u32, Real, Vec3)]) -> [usize; 4] {
        let contacts = (0..).zip(truth).map(|(triangle, &distance)| {
            ([triangle, 7], ConvexTruth { distance, normals: vec![DVec3::Y] })
        });
        let contacts = contacts.collect();
        let truth = Truth { contacts, side: 0, prediction: 0.02, bands: MESH_BANDS };
        let manifolds = reported.iter().map(|&(triangle, distance, normal)| {
            let mut manifold = ContactManifold::<(), ()>::new();
            (manifold.subshape1, manifold.subshape2) = (triangle, 7);
            manifold.local_n1 = normal;
            let (place, feature) = (Vec3::ZERO, PackedFeatureId::UNKNOWN);
            manifold.points.push(TrackedContact::new(place, place, feature, feature, distance));
            manifold
        });
        let errors = truth.judge(&manifolds.collect::<Vec<_>>());
        [errors.missed, errors.phantom, errors.wrong_depth, errors.wrong_normal]
    }

    /// Would catch a fault that is not counted, or is counted twice.
    #[test]
    fn each_fault_is_counted_once() {
        let true_ones = [-0.01, 0.0199, 0.005];
        let [one, two] = [(0, -0.01, Vec3::Y), (2, 0.005, Vec3::Y)];
        let errors = |reported: &[(u32, Real, Vec3)]| errors(&true_ones, reported);
        assert_eq!(errors(&[one, two]), [0; 4], "the pair in the band may be missing");
        assert_eq!(errors(&[one]), [1, 0, 0, 0]);
        assert_eq!(errors(&[one, two, (5, 0.01, Vec3::Y)]), [0, 1, 0, 0]);
        assert_eq!(errors(&[one, two, two]), [0, 1, 0, 0]);
        assert_eq!(errors(&[one, (2, 0.0058, Vec3::Y)]), [0; 4]);
        assert_eq!(errors(&[one, (2, 0.0062, Vec3::X)]), [0, 0, 1, 0], "not two errors");
        let leaning = |degrees: Real| Quat::from_rotation_x(degrees.to_radians()) * Vec3::Y;
        assert_eq!(errors(&[one, (2, 0.005, 5.0 * leaning(0.09))]), [0; 4]);
        for normal in [leaning(0.11), leaning(-0.11), -Vec3::Y, Vec3::ZERO, Vec3::NAN] {
            assert_eq!(errors(&[one, (2, 0.005, normal)]), [0, 0, 0, 1], "{normal}");
        }
    }
}
