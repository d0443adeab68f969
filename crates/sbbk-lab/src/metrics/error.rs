//! The error of a backend's contacts, by comparison with brute force in f64.

use std::collections::HashMap;
use std::iter::Sum;
use std::ops::AddAssign;

use glamx::{DPose3, DVec3, Vec3};
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;
use sbbk_core::truth::{TruthPair, pairs_within};
use serde::Serialize;

use crate::backend::{Question, Reported, shape_address};

/// Pairs whose distance differs from the prediction distance by at most this share of it may be
/// reported or not. Raised, real misses pass; lowered, f32 rounding of large meshes is blamed.
const SET_BAND: f64 = 0.01;
/// A distance or depth off by more than this share of the prediction distance is wrong.
const DEPTH_BAND: f64 = 0.05;
/// Degrees between a normal and the true one beyond which it is wrong.
const NORMAL_BAND: f64 = 0.1;

/// Triangle pairs, right and wrong, summed over the mesh pairs that were judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ErrorCount {
    /// Mesh pairs judged.
    pub mesh_pairs: usize,
    /// Mesh pairs from which they were sampled.
    pub sampled_from: usize,
    /// Triangle pairs within the prediction distance, by the truth.
    pub true_pairs: usize,
    /// Those of them that cross or touch.
    pub crossing: usize,
    /// Triangle pairs reported with a point within the prediction distance.
    pub reported: usize,
    /// True pairs, by more than 1 % of the prediction distance, that were not reported.
    pub missed: usize,
    /// Reported pairs that are farther than the prediction distance, by more than 1 % of it, or
    /// that had been reported before.
    pub phantom: usize,
    /// Reported true pairs whose distance or depth is off by more than 5 % of the prediction
    /// distance.
    pub wrong_depth: usize,
}

/// Right and wrong contacts, their normals included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ContactErrors {
    /// Missed, phantom and wrong depth.
    #[serde(flatten)]
    pub pairs: ErrorCount,
    /// Reported true pairs of right depth whose normals the truth tells.
    pub judged_normals: usize,
    /// Those whose normal is off by more than 0.1 degrees.
    pub wrong_normal: usize,
}

impl ErrorCount {
    /// Missed, phantom and wrong pairs.
    pub fn wrong(&self) -> usize {
        self.missed + self.phantom + self.wrong_depth
    }
}

/// Counts that are summed field by field.
macro_rules! summed {
    ($name:ident { $($field:ident),* }) => {
        impl AddAssign for $name {
            fn add_assign(&mut self, other: Self) {
                $(self.$field += other.$field;)*
            }
        }

        impl Sum for $name {
            fn sum<I: Iterator<Item = Self>>(counts: I) -> Self {
                counts.fold(Self::default(), |mut total, count| {
                    total += count;
                    total
                })
            }
        }
    };
}

summed!(ErrorCount {
    mesh_pairs,
    sampled_from,
    true_pairs,
    crossing,
    reported,
    missed,
    phantom,
    wrong_depth
});
summed!(ContactErrors { pairs, judged_normals, wrong_normal });

/// Knows the meshes of a world in f64, as they were when it was made, and judges answers about
/// them.
///
/// It knows a mesh by its address, and must not outlive it.
pub struct Judge {
    meshes: HashMap<usize, TruthMesh>,
}

struct TruthMesh {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// Every contact of one question within the prediction distance and its band, by the subshapes: the
/// triangles of two meshes, or one and a part of a convex shape.
pub struct Truth {
    contacts: HashMap<(u32, u32), TrueContact>,
    prediction: f64,
    /// What a distance or depth may be off by: the first share of the prediction distance, or the
    /// second of the depth, whichever is more.
    bands: [f64; 2],
    /// The shape whose outward normal is judged, in its own frame.
    side: usize,
}

/// What is true of two subshapes.
pub struct TrueContact {
    /// The distance, or minus the depth.
    pub distance: f64,
    /// The normals of which each is right; none where that cannot be said.
    pub normals: Vec<DVec3>,
}

impl Judge {
    /// A judge of the meshes among `shapes`; each is converted once, however often it is shared.
    pub fn new<'a>(shapes: impl IntoIterator<Item = &'a SharedShape>) -> Self {
        let mut meshes = HashMap::new();
        for shape in shapes {
            if let Some(mesh) = shape.as_trimesh() {
                meshes.entry(shape_address(&**shape)).or_insert_with(|| TruthMesh {
                    vertices: mesh.vertices().iter().map(|v| v.as_dvec3()).collect(),
                    triangles: mesh.indices().to_vec(),
                });
            }
        }
        Self { meshes }
    }

    /// Answers `question` by brute force: about 10 µs for each pair of triangles whose boxes are
    /// near.
    ///
    /// # Panics
    ///
    /// If the question is about a mesh that this judge was not given.
    pub fn truth(&self, question: &Question) -> Truth {
        let [mesh1, mesh2] = question.shapes.map(|address| &self.meshes[&address]);
        let pose = DPose3::from(question.pos12);
        let margin = f64::from(question.prediction) * (1.0 + SET_BAND);
        let near = near_triangles([mesh1, mesh2], pose, margin);
        let triangles = |mesh: &TruthMesh, near: &[u32]| -> Vec<[u32; 3]> {
            near.iter().map(|&index| mesh.triangles[index as usize]).collect()
        };
        let [triangles1, triangles2] = [triangles(mesh1, &near[0]), triangles(mesh2, &near[1])];
        let [vertices1, vertices2] = [&*mesh1.vertices, &*mesh2.vertices];
        let pairs = pairs_within(vertices1, &triangles1, vertices2, &triangles2, pose, margin);
        let numbered = pairs.into_iter().map(|pair| TruthPair {
            triangle1: near[0][pair.triangle1 as usize],
            triangle2: near[1][pair.triangle2 as usize],
            ..pair
        });
        Truth::of_triangles(numbered, question.prediction)
    }
}

/// The triangles of two meshes, the second one at `pose`, that reach within `margin` of the box
/// around those of the other mesh, and of the box around what that leaves of it. Bodies in touch
/// share a small part of their boxes: this saves brute force most of its work.
fn near_triangles(meshes: [&TruthMesh; 2], pose: DPose3, margin: f64) -> [Vec<u32>; 2] {
    let poses = [DPose3::IDENTITY, pose];
    let boxes: [Vec<[DVec3; 2]>; 2] = [0, 1].map(|side| {
        let vertices: Vec<DVec3> = meshes[side].vertices.iter().map(|&v| poses[side] * v).collect();
        let corners = meshes[side].triangles.iter().map(|t| t.map(|i| vertices[i as usize]));
        corners.map(|corners| union(corners.map(|corner| [corner; 2]))).collect()
    });
    let mut near = boxes.each_ref().map(|boxes| (0..boxes.len() as u32).collect::<Vec<_>>());
    for (side, other) in [(0, 1), (1, 0), (0, 1), (1, 0)] {
        let [min, max] = union(near[other].iter().map(|&i| boxes[other][i as usize]));
        near[side].retain(|&i| {
            let [low, high] = boxes[side][i as usize];
            (low - margin).cmple(max).all() && (high + margin).cmpge(min).all()
        });
    }
    near
}

/// The box around boxes, each given by its least and its greatest corner.
fn union(boxes: impl IntoIterator<Item = [DVec3; 2]>) -> [DVec3; 2] {
    boxes.into_iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[min, max], [low, high]| {
        [min.min(low), max.max(high)]
    })
}

impl Truth {
    /// About triangles of two meshes: a depth may be off by 5 % of the prediction distance.
    pub fn of_triangles(pairs: impl IntoIterator<Item = TruthPair>, prediction: Real) -> Self {
        let contact = |pair: TruthPair| {
            let normals = pair.normal_is_unique.then_some(pair.normal).into_iter().collect();
            let contact = TrueContact { distance: pair.distance, normals };
            ((pair.triangle1, pair.triangle2), contact)
        };
        Self::new(pairs.into_iter().map(contact), prediction, [DEPTH_BAND, 0.0], 0)
    }

    /// About any subshapes. A distance or depth may be off by the first of the `bands` as a share of
    /// the prediction distance, or the second as a share of the depth, whichever is more; normals are
    /// those of the shape number `side`, out of it and in its frame.
    pub fn new(
        contacts: impl IntoIterator<Item = ((u32, u32), TrueContact)>,
        prediction: Real,
        bands: [f64; 2],
        side: usize,
    ) -> Self {
        let contacts = contacts.into_iter().collect();
        Self { contacts, prediction: prediction.into(), bands, side }
    }

    /// The same under other numbers of the subshapes.
    pub fn renumbered(mut self, number: impl Fn(u32, u32) -> (u32, u32)) -> Self {
        let contacts = self.contacts.into_iter();
        self.contacts = contacts.map(|((one, two), truth)| (number(one, two), truth)).collect();
        self
    }

    /// The subshapes, in no particular order.
    pub fn pairs(&self) -> impl Iterator<Item = (u32, u32)> {
        self.contacts.keys().copied()
    }

    /// Whether any two cross or touch.
    pub fn meets(&self) -> bool {
        self.contacts.values().any(|truth| truth.distance <= 0.0)
    }

    /// Counts what is wrong in the manifolds that answer the question that this is the truth of.
    pub fn judge_manifolds(&self, manifolds: &[ContactManifold]) -> ContactErrors {
        self.judge(&Reported::all(manifolds, self.prediction as Real))
    }

    /// The same of what is reported within the prediction distance.
    pub fn judge(&self, reported: &[Reported]) -> ContactErrors {
        let mut seen = HashMap::new();
        let mut errors = ContactErrors::default();
        let pairs = &mut errors.pairs;
        (pairs.mesh_pairs, pairs.sampled_from, pairs.reported) = (1, 1, reported.len());
        for contact in reported {
            let key = (contact.triangle1, contact.triangle2);
            let is_repeated = seen.insert(key, contact.distance).is_some();
            match self.contacts.get(&key) {
                Some(truth) if !is_repeated => {
                    let [band, depth_band] = self.bands;
                    let band = (band * self.prediction).max(depth_band * -truth.distance);
                    if (f64::from(contact.distance) - truth.distance).abs() > band {
                        pairs.wrong_depth += 1;
                    } else if !truth.normals.is_empty() {
                        let normal = contact.normals[self.side];
                        errors.judged_normals += 1;
                        errors.wrong_normal += usize::from(!truth.has(normal));
                    }
                }
                _ => pairs.phantom += 1,
            }
        }
        for (key, truth) in &self.contacts {
            pairs.true_pairs += usize::from(truth.distance <= self.prediction);
            pairs.crossing += usize::from(truth.distance <= 0.0);
            let is_certain = truth.distance <= (1.0 - SET_BAND) * self.prediction;
            pairs.missed += usize::from(is_certain && !seen.contains_key(key));
        }
        errors
    }

    /// The same for the contacts of surfaces, which are some of those of triangles: where these cross
    /// or have passed each other they are measured along another way, and none need be there but one
    /// if the meshes cross. No way is shorter than the distance of triangles that are apart.
    pub fn judge_surfaces(&self, reported: &[Reported]) -> ErrorCount {
        let band = DEPTH_BAND * self.prediction;
        let is_wrong = |contact: &&Reported| {
            let truth = self.contacts.get(&(contact.triangle1, contact.triangle2));
            let distance = f64::from(contact.distance);
            distance > 0.0 && truth.is_some_and(|truth| distance < truth.distance - band)
        };
        let is_crossing = self.contacts.values().any(|truth| truth.distance < -band);
        ErrorCount {
            missed: usize::from(is_crossing && reported.is_empty()),
            wrong_depth: reported.iter().filter(is_wrong).count(),
            ..self.judge(reported).pairs
        }
    }
}

impl TrueContact {
    /// Whether a normal is right. One that is zero is at no angle to anything.
    fn has(&self, normal: Vec3) -> bool {
        let angle = |right: &DVec3| normal.as_dvec3().angle_between(*right).to_degrees();
        self.normals.iter().any(|right| angle(right) <= NORMAL_BAND)
    }
}

/// At most `limit` indices below `count`, evenly spread.
pub fn sample_indices(count: usize, limit: usize) -> Vec<usize> {
    let sample_count = count.min(limit);
    (0..sample_count).map(|i| i * count / sample_count).collect()
}

#[cfg(test)]
mod tests {
    use glamx::Quat;
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
            let truth = Truth::of_triangles([*truth], PREDICTION);
            let errors = truth.judge_manifolds(&[manifold(normal, distance)]);
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
