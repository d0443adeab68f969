//! The error of a backend's contacts, by comparison with brute force in f64.

use std::collections::HashMap;
use std::iter::Sum;
use std::ops::AddAssign;

use glamx::{DPose3, DVec3};
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use sbbk_core::truth::{TruthPair, pairs_within};
use serde::Serialize;

use super::near::near_parts;
use super::ratio;
use crate::backend::{Answer, Question, shape_address};

/// Pairs whose distance differs from the prediction distance by at most this share of it may be
/// reported or not. Raised, real misses pass; lowered, f32 rounding of large meshes is blamed.
const SET_BAND: f64 = 0.01;
/// A distance or depth off by more than this share of the prediction distance is wrong.
const DEPTH_BAND: f64 = 0.05;

/// Triangle pairs, right and wrong, summed over the mesh pairs that were judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ErrorCount {
    /// Mesh pairs judged.
    pub mesh_pairs: usize,
    /// Mesh pairs from which they were sampled.
    pub sampled_from: usize,
    /// Triangle pairs within the prediction distance, by the truth.
    pub true_pairs: usize,
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

impl ErrorCount {
    /// Missed, phantom and wrong pairs.
    pub fn wrong(&self) -> usize {
        self.missed + self.phantom + self.wrong_depth
    }

    /// Wrong pairs for each true pair; may exceed 1. `None` when there were no true pairs.
    pub fn share(&self) -> Option<f64> {
        ratio(self.wrong() as f64, self.true_pairs as f64)
    }
}

impl AddAssign for ErrorCount {
    fn add_assign(&mut self, other: Self) {
        self.mesh_pairs += other.mesh_pairs;
        self.sampled_from += other.sampled_from;
        self.true_pairs += other.true_pairs;
        self.reported += other.reported;
        self.missed += other.missed;
        self.phantom += other.phantom;
        self.wrong_depth += other.wrong_depth;
    }
}

impl Sum for ErrorCount {
    fn sum<I: Iterator<Item = Self>>(counts: I) -> Self {
        counts.fold(Self::default(), |mut total, count| {
            total += count;
            total
        })
    }
}

/// Knows the meshes of a world in f64, and judges answers about them.
#[derive(Default)]
pub struct Judge {
    meshes: HashMap<usize, TruthMesh>,
}

struct TruthMesh {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// Keeps the address, which is the key, from being used for another shape.
    _shape: Option<SharedShape>,
}

/// Every triangle pair of one question within the prediction distance and its band.
pub struct Truth {
    contacts: HashMap<(u32, u32), TruthPair>,
}

impl Judge {
    /// A judge of the meshes among `shapes`; each is converted once, however often it is shared.
    pub fn new<'a>(shapes: impl IntoIterator<Item = &'a SharedShape>) -> Self {
        Self::holding(shapes, true)
    }

    /// A judge of meshes that deform, as they are now. It does not hold them, as they would be copied then before their
    /// vertices move: it must not outlive them.
    pub fn of_present<'a>(shapes: impl IntoIterator<Item = &'a SharedShape>) -> Self {
        Self::holding(shapes, false)
    }

    fn holding<'a>(shapes: impl IntoIterator<Item = &'a SharedShape>, is_held: bool) -> Self {
        let mut judge = Self::default();
        for shape in shapes {
            if let Some(mesh) = shape.as_trimesh() {
                let address = shape_address(&**shape);
                judge.meshes.entry(address).or_insert_with(|| TruthMesh {
                    vertices: mesh.vertices().iter().map(|v| v.as_dvec3()).collect(),
                    triangles: mesh.indices().to_vec(),
                    _shape: is_held.then(|| shape.clone()),
                });
            }
        }
        judge
    }

    /// Answers `question` by brute force: about 10 µs for each pair of triangles whose boxes are
    /// near.
    ///
    /// Panics when the question is about a mesh that this judge was not given.
    pub fn truth(&self, question: &Question) -> Truth {
        let meshes = question.shapes.map(|address| &self.meshes[&address]);
        let pose = DPose3::from(question.pos12);
        let margin = f64::from(question.prediction) * (1.0 + SET_BAND);
        let surfaces = meshes.map(|mesh| (&*mesh.vertices, &*mesh.triangles));
        let [part1, part2] = near_parts(surfaces, pose, margin);
        let [(vertices1, _), (vertices2, _)] = surfaces;
        let pairs =
            pairs_within(vertices1, &part1.triangles, vertices2, &part2.triangles, pose, margin);
        let contacts = pairs.into_iter().map(|pair| {
            let triangle1 = part1.indices[pair.triangle1 as usize];
            let triangle2 = part2.indices[pair.triangle2 as usize];
            ((triangle1, triangle2), TruthPair { triangle1, triangle2, ..pair })
        });
        Truth { contacts: contacts.collect() }
    }
}

impl Truth {
    /// The triangle pairs, in no particular order.
    pub fn pairs(&self) -> impl Iterator<Item = (u32, u32)> {
        self.contacts.keys().copied()
    }

    /// Distance and normal of all triangle pairs, in no particular order.
    pub fn contacts(&self) -> impl Iterator<Item = &TruthPair> {
        self.contacts.values()
    }

    /// Distance and normal of a triangle of the first mesh and one of the second; `None` if they
    /// are farther apart than the prediction distance and its band.
    pub fn contact(&self, triangle1: u32, triangle2: u32) -> Option<&TruthPair> {
        self.contacts.get(&(triangle1, triangle2))
    }

    /// Counts what is wrong in an answer to the question that this is the truth of.
    pub fn judge(&self, answer: &Answer) -> ErrorCount {
        let prediction = f64::from(answer.question.prediction);
        let mut reported: HashMap<(u32, u32), Real> = HashMap::new();
        let mut errors = ErrorCount {
            mesh_pairs: 1,
            sampled_from: 1,
            reported: answer.reported.len(),
            ..ErrorCount::default()
        };
        for pair in &answer.reported {
            let key = (pair.triangle1, pair.triangle2);
            let is_repeated = reported.insert(key, pair.distance).is_some();
            match self.contacts.get(&key) {
                Some(contact) if !is_repeated => {
                    let is_wrong =
                        !is_right_depth(pair.distance, contact, answer.question.prediction);
                    errors.wrong_depth += usize::from(is_wrong);
                }
                _ => errors.phantom += 1,
            }
        }
        for (key, contact) in &self.contacts {
            errors.true_pairs += usize::from(contact.distance <= prediction);
            let is_certain = contact.distance <= (1.0 - SET_BAND) * prediction;
            errors.missed += usize::from(is_certain && !reported.contains_key(key));
        }
        errors
    }
}

/// Whether a distance or depth is that of the truth, but for 5 % of the prediction distance.
pub fn is_right_depth(distance: Real, truth: &TruthPair, prediction: Real) -> bool {
    (f64::from(distance) - truth.distance).abs() <= DEPTH_BAND * f64::from(prediction)
}

/// At most `limit` indices below `count`, evenly spread.
pub fn sample_indices(count: usize, limit: usize) -> Vec<usize> {
    let sample_count = count.min(limit);
    (0..sample_count).map(|i| i * count / sample_count).collect()
}
