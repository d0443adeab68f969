//! Wrong contacts of a backend, by comparison with brute force in f64.

use crate::prelude::*;
use std::iter::Sum;
use std::ops::AddAssign;

use glamx::DPose3;
use sbbk_core::truth::{TruthPair, pairs_within};

/// Share of the prediction distance within which a pair may be reported or not. Higher: real
/// misses pass; lower: rounding to f32 counts as an error.
const SET_BAND: f64 = 0.01;
/// Tolerated error of a distance or depth, as a share of the prediction distance.
const DEPTH_BAND: f64 = 0.05;
/// Tolerated angle of a normal, in degrees.
const NORMAL_BAND: f64 = 0.1;

/// Right and wrong triangle pairs, summed over the mesh pairs that were judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ErrorCount {
    pub mesh_pairs: usize,
    /// Mesh pairs from which the judged ones were sampled.
    pub sampled_from: usize,
    /// True triangle pairs within the prediction distance.
    pub true_pairs: usize,
    /// True triangle pairs that cross or touch.
    pub crossing: usize,
    /// Triangle pairs reported within the prediction distance.
    pub reported: usize,
    pub missed: usize,
    /// Reported pairs that are farther than the prediction distance, or were reported before.
    pub phantom: usize,
    /// Reported true pairs with a wrong distance or depth.
    pub wrong_depth: usize,
}

/// Right and wrong contacts, normals included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ContactErrors {
    /// Missed pairs, phantoms and wrong depths.
    #[serde(flatten)]
    pub pairs: ErrorCount,
    /// Pairs of right depth whose true normal is unique.
    pub judged_normals: usize,
    /// Pairs among these with a wrong normal.
    pub wrong_normal: usize,
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

/// Meshes in f64, by the addresses of their shapes. Must not outlive the shapes.
pub struct Judge {
    meshes: HashMap<usize, TruthMesh>,
}

struct TruthMesh {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// All true contacts of one question, by their subshapes.
pub struct Truth {
    contacts: HashMap<(u32, u32), TrueContact>,
    prediction: f64,
    /// Tolerated error of a distance: a share of the prediction distance, or a share of the depth,
    /// whichever is more.
    bands: [f64; 2],
    /// Index of the shape whose outward normal is judged, in the frame of this shape.
    side: usize,
}

/// A true contact of two subshapes.
pub struct TrueContact {
    /// The distance, or minus the depth.
    pub distance: f64,
    /// All right normals; none if the normal is not unique.
    pub normals: Vec<DVec3>,
}

impl Judge {
    /// Converts the meshes among `shapes`, shared ones once.
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

    /// Computes the truth by brute force: about 10 µs for each pair of triangles with near boxes.
    ///
    /// # Panics
    ///
    /// If the judge was not given a mesh of the question.
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

/// Triangles of each mesh within `margin` of the box of the other mesh, and then of the box of the
/// triangles that this leaves. Saves brute force most of its work.
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

/// Box around boxes, each given by its least and its greatest corner.
fn union(boxes: impl IntoIterator<Item = [DVec3; 2]>) -> [DVec3; 2] {
    boxes.into_iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[min, max], [low, high]| {
        [min.min(low), max.max(high)]
    })
}

impl Truth {
    /// Contacts of triangles of two meshes.
    pub fn of_triangles(pairs: impl IntoIterator<Item = TruthPair>, prediction: Real) -> Self {
        let contact = |pair: TruthPair| {
            let normals = pair.normal_is_unique.then_some(pair.normal).into_iter().collect();
            let contact = TrueContact { distance: pair.distance, normals };
            ((pair.triangle1, pair.triangle2), contact)
        };
        Self::new(pairs.into_iter().map(contact), prediction, [DEPTH_BAND, 0.0], 0)
    }

    /// Contacts of any subshapes. `bands` are the tolerated errors of a distance, as shares of the
    /// prediction distance and of the depth. Normals point out of shape number `side`.
    pub fn new(
        contacts: impl IntoIterator<Item = ((u32, u32), TrueContact)>,
        prediction: Real,
        bands: [f64; 2],
        side: usize,
    ) -> Self {
        let contacts = contacts.into_iter().collect();
        Self { contacts, prediction: prediction.into(), bands, side }
    }

    /// Renames the subshapes.
    pub fn renumbered(mut self, number: impl Fn(u32, u32) -> (u32, u32)) -> Self {
        let contacts = self.contacts.into_iter();
        self.contacts = contacts.map(|((one, two), truth)| (number(one, two), truth)).collect();
        self
    }

    /// True if any two subshapes cross or touch.
    pub fn meets(&self) -> bool {
        self.contacts.values().any(|truth| truth.distance <= 0.0)
    }

    /// Counts the wrong contacts of manifolds.
    pub fn judge_manifolds(&self, manifolds: &[ContactManifold]) -> ContactErrors {
        self.judge(&Reported::all(manifolds, self.prediction as Real))
    }

    /// Counts the wrong contacts among those reported within the prediction distance.
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

    /// Counts the wrong contacts of surfaces. One contact
    /// is missed if the meshes cross and none is reported. A distance is wrong if it is shorter than
    /// the distance of the triangles.
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
    /// True if a normal is right. A normal of length zero is at no angle to anything.
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

    use super::*;

    fn pair(triangle1: u32, distance: f64, normal_is_unique: bool) -> TruthPair {
        let normal = DVec3::new(0.6, 0.0, 0.8);
        TruthPair { triangle1, triangle2: 7, distance, normal, normal_is_unique }
    }

    fn reported(triangle1: u32, distance: Real, normal: Vec3) -> Reported {
        Reported { triangle1, triangle2: 7, distance, normals: [normal; 2] }
    }

    /// Would catch wrong normals that pass, right ones that fail, and ambiguous ones that count.
    #[test]
    fn unique_normals_are_judged() {
        let turned =
            |degrees: Real| Quat::from_rotation_y(degrees.to_radians()) * Vec3::new(0.6, 0.0, 0.8);
        let judged = |is_unique: bool, normal: Vec3, distance: Real| {
            let truth = Truth::of_triangles([pair(0, -0.01, is_unique)], 0.02);
            let errors = truth.judge(&[reported(0, distance, normal)]);
            (errors.judged_normals, errors.wrong_normal, errors.pairs.wrong_depth)
        };
        for normal in [turned(0.0), turned(0.09), 5.0 * turned(-0.09)] {
            assert_eq!(judged(true, normal, -0.01), (1, 0, 0), "{normal}");
        }
        for normal in [turned(0.11), turned(-0.11), -turned(0.0), Vec3::ZERO, Vec3::NAN] {
            assert_eq!(judged(true, normal, -0.01), (1, 1, 0), "{normal}");
        }
        // A wrong depth is one error, not two.
        assert_eq!(judged(true, turned(90.0), -0.02), (0, 0, 1));
        assert_eq!(judged(false, turned(90.0), -0.01), (0, 0, 0));
    }

    /// Would catch a fault that is not counted, or is counted twice.
    #[test]
    fn each_fault_is_counted_once() {
        let pairs =
            [(0, -0.01), (1, 0.0199), (2, 0.005)].map(|(one, depth)| pair(one, depth, true));
        let truth = Truth::of_triangles(pairs, 0.02);
        let errors = |contacts: &[(u32, Real)]| {
            let contacts = contacts.iter().map(|&(one, depth)| reported(one, depth, Vec3::Y));
            let errors = truth.judge(&contacts.collect::<Vec<_>>()).pairs;
            [errors.missed, errors.phantom, errors.wrong_depth]
        };
        let [one, two] = [(0, -0.01), (2, 0.005)];
        assert_eq!(errors(&[one, two]), [0, 0, 0], "the pair in the band may be missing");
        assert_eq!(errors(&[one]), [1, 0, 0]);
        assert_eq!(errors(&[one, two, (5, 0.01)]), [0, 1, 0]);
        assert_eq!(errors(&[one, two, two]), [0, 1, 0]);
        assert_eq!(errors(&[one, (2, 0.0062)]), [0, 0, 1]);
        assert_eq!(errors(&[one, (2, 0.0058)]), [0, 0, 0]);
    }
}
