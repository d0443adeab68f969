//! Recordings as text: base64 of gzipped JSON.
//!
//! Lists of places, rotations and contacts are whole numbers, each but the first as the difference
//! from the one before. So most are small, and those of bodies at rest are zeros.

use crate::prelude::*;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;

use super::recorder::STRIDE;
use super::shapes::{levels, surface};

/// Steps of a quaternion's parts.
const TURN: f32 = 32767.0;

#[derive(Serialize)]
struct Replay<'a> {
    /// Step of positions in units, and number of steps of rotations.
    quantum: f32,
    turn: f32,
    stride: usize,
    /// Each shape, fine and coarse.
    shapes: Vec<[Surface; 2]>,
    runs: Vec<Run<'a>>,
}

#[derive(Serialize)]
struct Surface {
    vertices: Vec<f32>,
    triangles: Vec<u32>,
}

#[derive(Serialize)]
struct Run<'a> {
    name: &'a str,
    times: &'a [f32],
    /// Shapes of the objects.
    shapes: Vec<usize>,
    fixed: Vec<bool>,
    /// Places and rotations: seven lists, each with all frames of all objects.
    poses: [Vec<i32>; 7],
    /// Number of contacts in each frame, and their coordinates.
    counts: Vec<usize>,
    contacts: [Vec<i32>; 3],
}

/// Encodes recordings.
pub fn encode(runs: &[Recorder]) -> String {
    let mut surfaces: Vec<Mesh> = Vec::new();
    let mut place = |shape: &SharedShape| {
        let surface = surface(&**shape);
        surfaces.iter().position(|other| *other == surface).unwrap_or_else(|| {
            surfaces.push(surface);
            surfaces.len() - 1
        })
    };
    let quantum = quantum(runs);
    let encoded = runs.iter().map(|run| {
        let places: Vec<usize> = run.shapes.iter().map(&mut place).collect();
        Run::new(run, &places, quantum)
    });
    let replay = Replay {
        quantum,
        turn: TURN,
        stride: STRIDE,
        runs: encoded.collect(),
        shapes: surfaces.iter().map(|surface| levels(surface).map(Surface::new)).collect(),
    };
    let mut out = GzEncoder::new(Vec::new(), Compression::best());
    let written = serde_json::to_writer(&mut out, &replay).map_err(Into::into);
    let packed = written.and_then(|()| out.finish());
    BASE64_STANDARD.encode(packed.expect("a stream in memory is always written"))
}

impl Surface {
    fn new(mesh: Mesh) -> Self {
        let vertices = mesh.vertices.iter().flat_map(|vertex| vertex.to_array()).collect();
        Self { vertices, triangles: mesh.triangles.concat() }
    }
}

impl<'a> Run<'a> {
    /// `places` are the surfaces of the shapes of a run.
    fn new(run: &'a Recorder, places: &[usize], quantum: f32) -> Self {
        let points = || run.frames.iter().flat_map(|frame| &frame.contacts);
        let contacts = [0, 1, 2].map(|axis| points().map(|p| steps(p[axis], quantum)).collect());
        Self {
            name: &run.name,
            times: &run.times,
            shapes: run.objects.iter().map(|object| places[object.shape]).collect(),
            fixed: run.objects.iter().map(|object| object.is_fixed).collect(),
            poses: poses(run, quantum).map(differences),
            counts: run.frames.iter().map(|frame| frame.contacts.len()).collect(),
            contacts: contacts.map(differences),
        }
    }
}

/// Step of positions: a thousandth of the smallest moving body.
fn quantum(runs: &[Recorder]) -> f32 {
    let radii = runs.iter().flat_map(|run| {
        let moving = run.objects.iter().filter(|object| !object.is_fixed);
        moving.map(|object| run.shapes[object.shape].compute_local_aabb().half_extents().length())
    });
    let least = radii.filter(|radius| *radius > 0.0).fold(f32::INFINITY, f32::min);
    1e-3 * if least.is_finite() { least } else { 1.0 }
}

fn steps(length: f32, quantum: f32) -> i32 {
    // A body that flies away stops after four thousand times its size.
    (length / quantum).round().clamp(-4e6, 4e6) as i32
}

/// Absent objects have a rotation of zeros.
fn poses(run: &Recorder, quantum: f32) -> [Vec<i32>; 7] {
    let mut numbers: [Vec<i32>; 7] = Default::default();
    for object in 0..run.objects.len() {
        let mut last = [0.0; 4];
        let mut shown = Vec3::ZERO;
        for frame in &run.frames {
            let pose: Option<Pose> = frame.poses.get(object).copied().flatten();
            let rotation = pose.map_or([0.0; 4], |pose| pose.rotation.to_array());
            // A rotation has two quaternions; take the one nearer to the last.
            let dot: f32 = rotation.iter().zip(last).map(|(a, b)| a * b).sum();
            let rotation = rotation.map(|part| if dot < 0.0 { -part } else { part });
            (last, shown) = (rotation, pose.map_or(shown, |pose| pose.translation));
            let place = shown.to_array().map(|part| steps(part, quantum));
            let rotation = rotation.map(|part| (TURN * part).round() as i32);
            numbers.iter_mut().zip(place.into_iter().chain(rotation)).for_each(|(n, k)| n.push(k));
        }
    }
    numbers
}

fn differences(list: Vec<i32>) -> Vec<i32> {
    let mut last = 0;
    list.into_iter().map(|number| number - std::mem::replace(&mut last, number)).collect()
}
