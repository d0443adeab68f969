//! Triangle pairs as two touching meshes give them.

use glamx::{DPose3, DVec3};
use sbbk_core::contact::{Feature, TriangleContact, contact};
use sbbk_truth::pairs_within;
use std::f64::consts::PI;

/// Two triangles and their contact.
#[derive(Clone, Copy)]
pub struct Pair {
    pub t1: [DVec3; 3],
    pub t2: [DVec3; 3],
    pub margin: f64,
    pub contact: TriangleContact,
}

impl Pair {
    /// Names of the ways in which triangles meet.
    pub fn kind(&self) -> &'static str {
        use Feature::{Edge, Face, Vertex};
        let TriangleContact { features, distance, .. } = self.contact;
        match (features.feature1(), features.feature2()) {
            _ if distance <= 0.0 => "Crossing",
            (Vertex(_), Face) | (Face, Vertex(_)) => "VertexFace",
            (Edge(_), Edge(_)) => "EdgeEdge",
            (Vertex(_), Edge(_)) | (Edge(_), Vertex(_)) => "VertexEdge",
            (Vertex(_), Vertex(_)) => "VertexVertex",
            _ => "Other",
        }
    }
}

/// The pairs within the margin of two unit spheres with bumps, which overlap a little, in an
/// order that does not help branch prediction.
pub fn bumpy_spheres(subdivisions: usize, margin: f64) -> Vec<Pair> {
    let sphere = bumpy_sphere(subdivisions);
    let pose = DPose3::new(DVec3::new(1.1, 1.3, 0.4), DVec3::new(0.3, 1.7, -0.5));
    let mut pairs: Vec<_> = pairs_within([sphere.clone(), sphere.clone()], pose, margin)
        .into_iter()
        .map(|pair| {
            let [t1, t2] = pair.triangles.map(|triangle| sphere[triangle as usize]);
            let t2 = t2.map(|v| pose * v);
            let contact = contact(&t1, &t2, margin * 1.001).expect("within the margin");
            Pair { t1: t1.map(|v| v - t1[0]), t2: t2.map(|v| v - t1[0]), margin, contact }
        })
        .collect();
    pairs.sort_by_key(|p| {
        (p.t1[1].x.to_bits() ^ p.t2[1].y.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    });
    pairs
}

/// Corners of the triangles.
fn bumpy_sphere(n: usize) -> Vec<[DVec3; 3]> {
    let (rings, sectors) = (n, 2 * n);
    let vertex = |ring: usize, sector: usize| {
        let (sin, cos) = (PI * (ring as f64 + 0.5) / rings as f64).sin_cos();
        let around = PI * (sector % sectors) as f64 / n as f64;
        let direction = DVec3::new(sin * around.cos(), sin * around.sin(), cos);
        let bumps =
            (7.0 * direction.x).sin() * (6.0 * direction.y).cos() * (5.0 * direction.z).sin();
        direction * (1.0 + 0.08 * bumps)
    };
    let quads = (0..rings - 1).flat_map(|r| (0..sectors).map(move |s| (r, s)));
    let halves = quads.flat_map(|(r, s)| {
        let [a, c] = [vertex(r, s), vertex(r + 1, s + 1)];
        [[a, vertex(r + 1, s), c], [a, c, vertex(r, s + 1)]]
    });
    halves.collect()
}
