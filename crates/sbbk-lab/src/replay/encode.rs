//! Recordings as text: base64 of a gzip stream.
//!
//! The stream has the length of the header in bytes as `u32`, the header as JSON, zeros up to a
//! multiple of four, and arrays of little-endian numbers:
//!
//! * for each shape, fine and coarse: vertices as `f32`, triangles as `u32`;
//! * for each run: times as `f32`, [`planes`] of seven numbers for each object and frame, counts of
//!   contacts as `u32`, and [`planes`] of the contacts.

use crate::prelude::*;
use std::io::{self, Write};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;

use super::difference::Difference;
use super::recorder::STRIDE;
use super::shapes::levels;

/// Steps of a quaternion's parts.
const TURN: f32 = 32767.0;

#[derive(Serialize)]
struct Header<'a> {
    /// Step of positions in units, and number of steps of rotations.
    quantum: f32,
    turn: f32,
    stride: usize,
    /// Vertices and triangles of each shape, fine and coarse.
    shapes: Vec<[[usize; 2]; 2]>,
    runs: Vec<RunHeader<'a>>,
    difference: Option<Difference>,
}

#[derive(Serialize)]
struct RunHeader<'a> {
    name: &'a str,
    steps: usize,
    frames: usize,
    contacts: usize,
    /// Shapes of the objects.
    shapes: Vec<usize>,
    fixed: Vec<bool>,
}

/// Encodes recordings.
pub fn encode(runs: &[Recorder]) -> String {
    let packed = packed(runs).expect("a stream in memory is always written");
    BASE64_STANDARD.encode(packed)
}

fn packed(runs: &[Recorder]) -> io::Result<Vec<u8>> {
    let mut surfaces: Vec<&Mesh> = Vec::new();
    let mut place = |surface| {
        surfaces.iter().position(|other| *other == surface).unwrap_or_else(|| {
            surfaces.push(surface);
            surfaces.len() - 1
        })
    };
    let places: Vec<Vec<usize>> =
        runs.iter().map(|run| run.shapes.surfaces.iter().map(&mut place).collect()).collect();
    let levels: Vec<[Mesh; 2]> = surfaces.iter().map(|surface| levels(surface)).collect();
    let header = header(runs, &places, &levels);
    let quantum = header.quantum;

    let header = serde_json::to_vec(&header)?;
    let mut out = GzEncoder::new(Vec::new(), Compression::best());
    out.write_all(&(header.len() as u32).to_le_bytes())?;
    out.write_all(&header)?;
    out.write_all(&[0; 3][..header.len().next_multiple_of(4) - header.len()])?;
    for surface in levels.iter().flatten() {
        let numbers = surface.vertices.iter().flat_map(|vertex| vertex.to_array());
        out.write_all(&bytes(numbers.map(f32::to_bits)))?;
        out.write_all(&bytes(surface.triangles.iter().flatten().copied()))?;
    }
    for run in runs {
        out.write_all(&bytes(run.times.iter().map(|time| time.to_bits())))?;
        out.write_all(&planes(&poses(run, quantum)))?;
        out.write_all(&bytes(run.frames.iter().map(|frame| frame.contacts.len() as u32)))?;
        let points = || run.frames.iter().flat_map(|frame| &frame.contacts);
        let numbers = [0, 1, 2].map(|axis| points().map(|p| steps(p[axis], quantum)).collect());
        out.write_all(&planes(&numbers))?;
    }
    out.finish()
}

/// The header of runs with these surfaces. `places` are the surfaces of the shapes of each run.
fn header<'a>(runs: &'a [Recorder], places: &[Vec<usize>], levels: &[[Mesh; 2]]) -> Header<'a> {
    let headers = runs.iter().zip(places).map(|(run, places)| RunHeader {
        name: &run.name,
        steps: run.times.len(),
        frames: run.frames.len(),
        contacts: run.frames.iter().map(|frame| frame.contacts.len()).sum(),
        shapes: run.objects.iter().map(|object| places[object.shape]).collect(),
        fixed: run.objects.iter().map(|object| object.is_fixed).collect(),
    });
    let size = |surface: &Mesh| [surface.vertices.len(), surface.triangles.len()];
    Header {
        quantum: quantum(runs),
        turn: TURN,
        stride: STRIDE,
        shapes: levels.iter().map(|levels| levels.each_ref().map(size)).collect(),
        runs: headers.collect(),
        difference: runs.get(1).and_then(|other| Difference::first(&runs[0], other)),
    }
}

fn bytes(numbers: impl Iterator<Item = u32>) -> Vec<u8> {
    numbers.flat_map(u32::to_le_bytes).collect()
}

/// Step of positions: a thousandth of the smallest moving body.
fn quantum(runs: &[Recorder]) -> f32 {
    let radii = runs.iter().flat_map(|run| {
        let moving = run.objects.iter().filter(|object| !object.is_fixed);
        moving.map(|object| run.shapes.surfaces[object.shape].bounds().half_extents().length())
    });
    let least = radii.filter(|radius| *radius > 0.0).fold(f32::INFINITY, f32::min);
    1e-3 * if least.is_finite() { least } else { 1.0 }
}

fn steps(length: f32, quantum: f32) -> i32 {
    // Three bytes: a body stops after four thousand times its size.
    (length / quantum).round().clamp(-4e6, 4e6) as i32
}

/// Seven lists of numbers, each with all frames of all objects. Absent objects have a rotation of
/// zeros.
fn poses(run: &Recorder, quantum: f32) -> [Vec<i32>; 7] {
    let mut numbers = [(); 7].map(|()| Vec::with_capacity(run.objects.len() * run.frames.len()));
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

/// Differences of successive numbers, zigzag-coded, first all low bytes, then the middle and the
/// high ones. Numbers that do not change become long runs of zeros.
fn planes<const N: usize>(lists: &[Vec<i32>; N]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for list in lists {
        let mut last = 0;
        let folded = list.iter().map(|&number| {
            let difference = number - std::mem::replace(&mut last, number);
            ((difference << 1) ^ (difference >> 31)) as u32
        });
        let folded: Vec<u32> = folded.collect();
        bytes.extend([0, 8, 16].iter().flat_map(|s| folded.iter().map(move |k| (k >> s) as u8)));
    }
    bytes
}
