//! The error of a backend's contacts, by comparison with brute force in f64.

use std::collections::HashMap;
use std::iter::Sum;
use std::ops::AddAssign;

use glamx::{DPose3, DVec3};
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use sbbk_core::truth::{TruthPair, pairs_within};
use serde::Serialize;

use super::ratio;
use crate::backend::{Answer, Question, Reported, shape_address};

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

/// Every triangle pair of one question within the prediction distance and its band.
pub struct Truth {
    contacts: HashMap<(u32, u32), TruthPair>,
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
        let contacts = pairs.into_iter().map(|pair| {
            let triangle1 = near[0][pair.triangle1 as usize];
            let triangle2 = near[1][pair.triangle2 as usize];
            ((triangle1, triangle2), TruthPair { triangle1, triangle2, ..pair })
        });
        Truth { contacts: contacts.collect() }
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

    /// The same for the contacts of surfaces, which are some of those of triangles: where these cross
    /// or have passed each other they are measured along another way, and none need be there but one
    /// if the meshes cross. No way is shorter than the distance of triangles that are apart.
    pub fn judge_surfaces(&self, answer: &Answer) -> ErrorCount {
        let band = DEPTH_BAND * f64::from(answer.question.prediction);
        let is_wrong = |pair: &&Reported| {
            let truth = self.contact(pair.triangle1, pair.triangle2);
            let distance = f64::from(pair.distance);
            distance > 0.0 && truth.is_some_and(|truth| distance < truth.distance - band)
        };
        let is_crossing = self.contacts().any(|contact| contact.distance < -band);
        ErrorCount {
            missed: usize::from(is_crossing && answer.reported.is_empty()),
            wrong_depth: answer.reported.iter().filter(is_wrong).count(),
            ..self.judge(answer)
        }
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
