//! Lines of trees and queries for a debug renderer, handed to a closure.
//!
//! ```
//! # use sbbk_core::tree::Tree;
//! # use glamx::Vec3;
//! use glamx::Pose3;
//! use sbbk_core::draw::layer;
//!
//! # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! # let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree = Tree::build(&vertices, &triangles, None)?;
//! let mut lines = Vec::new();
//! layer(&tree, 4, &Pose3::IDENTITY, |a, b, colour| lines.push((a, b, colour)));
//! assert!(!lines.is_empty());
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```

use std::collections::BTreeMap;
use std::f32::consts::TAU;

use glamx::{DVec3, Pose3, Vec3};

use crate::leaf::LeafTest;
use crate::traverse::{DescentScratch, PairFrame, Placement, descend};
use crate::tree::Tree;
use crate::volumes::{Aabb, Kdop, Sphere, directions};

/// Hue in degrees, then saturation, lightness and opacity from 0 to 1, like Rapier's debug
/// renderer.
pub type Colour = [f32; 4];

/// Colour of spheres in [`layer`].
pub const SPHERE: Colour = [50.0, 1.0, 0.5, 1.0];
/// Colour of boxes in [`layer`].
pub const BOX: Colour = [210.0, 1.0, 0.5, 1.0];
/// Colour of k-DOPs in [`layer`].
pub const KDOP: Colour = [140.0, 1.0, 0.4, 1.0];

/// Colours of the triangles of each mesh in [`candidates`].
pub const CANDIDATES: [Colour; 2] = [[260.0, 0.5, 0.7, 1.0], [180.0, 0.5, 0.6, 1.0]];

/// Lines of each great circle of a sphere. Higher: rounder; lower: faster.
const CIRCLE_LINES: u32 = 32;

/// Lengths below this share of the coordinates are rounding errors of f64.
const TOLERANCE: f64 = 1e-12;

/// Draws the volumes of the nodes at `depth`, and of leaves above it, with the mesh at `pose`. The
/// root, at depth 0, is drawn as its sphere if it has one.
pub fn layer(tree: &Tree, depth: u32, pose: &Pose3, mut line: impl FnMut(Vec3, Vec3, Colour)) {
    let mut draw = |a, b, colour| line(pose * a, pose * b, colour);
    let mut nodes = vec![tree.root()];
    while let Some(node) = nodes.pop() {
        match node.children() {
            Some(children) if node.depth() < depth => nodes.extend(children),
            _ => match (tree.sphere().filter(|_| node.depth() == 0), node.kdop()) {
                (Some(ball), _) => sphere(ball, |a, b| draw(a, b, SPHERE)),
                (None, Some(volume)) => kdop(&volume, |a, b| draw(a, b, KDOP)),
                (None, None) => aabb(&node.aabb(), |a, b| draw(a, b, BOX)),
            },
        }
    }
}

/// Draws the candidates of a query as three lines each: the triangles of two meshes, at these
/// poses, that volumes and leaf tests cannot show to be farther apart than `margin`.
pub fn candidates(
    trees: (&Tree, &Tree),
    poses: [&Pose3; 2],
    margin: f32,
    mut line: impl FnMut(Vec3, Vec3, Colour),
) {
    let placement = Placement::new(&poses[0].inv_mul(poses[1]));
    let mut frame = PairFrame::new(trees, placement, margin);
    let test = LeafTest::new(&frame);
    let (mut one, mut two) = (BTreeMap::new(), BTreeMap::new());
    descend(trees, &mut frame, &mut DescentScratch::default(), |batch1, batch2| {
        test.survivors(batch1, batch2, |lane1, lane2| {
            one.insert(batch1.triangles()[lane1], batch1.corners(lane1));
            two.insert(batch2.triangles()[lane2], batch2.corners(lane2));
        });
    });
    for (side, triangles) in [one, two].into_iter().enumerate() {
        for corners in triangles.into_values() {
            let [a, b, c] = corners.map(|corner| poses[side] * corner);
            [(a, b), (b, c), (c, a)].into_iter().for_each(|(a, b)| line(a, b, CANDIDATES[side]));
        }
    }
}

/// Draws three great circles of a sphere, or nothing if it is empty.
pub fn sphere(sphere: &Sphere, mut line: impl FnMut(Vec3, Vec3)) {
    if sphere.radius < 0.0 {
        return;
    }
    for [x, y] in [[Vec3::X, Vec3::Y], [Vec3::Y, Vec3::Z], [Vec3::Z, Vec3::X]] {
        let point = |step: u32| {
            let (sin, cos) = (TAU * step as f32 / CIRCLE_LINES as f32).sin_cos();
            sphere.centre + sphere.radius * (cos * x + sin * y)
        };
        (0..CIRCLE_LINES).for_each(|step| line(point(step), point(step + 1)));
    }
}

/// Draws the edges of a box, or nothing if it is empty.
pub fn aabb(aabb: &Aabb, line: impl FnMut(Vec3, Vec3)) {
    edges(&[Vec3::X, Vec3::Y, Vec3::Z], &aabb.min.to_array(), &aabb.max.to_array(), line);
}

/// Draws the edges of a k-DOP, or nothing if it is empty.
pub fn kdop(kdop: &Kdop, line: impl FnMut(Vec3, Vec3)) {
    edges(&directions::DIRECTIONS, &kdop.min, &kdop.max, line);
}

/// A half-space: points whose product with the normal is at most `end`.
struct Half {
    normal: DVec3,
    end: f64,
}

/// The edges of the polytope between slabs, each once, in cubic time.
///
/// An edge is the part of the line of two planes that lies in all other half-spaces.
fn edges(directions: &[Vec3], min: &[f32], max: &[f32], mut line: impl FnMut(Vec3, Vec3)) {
    let slabs = directions.iter().zip(min.iter().zip(max));
    let halves: Vec<Half> = slabs
        .flat_map(|(direction, (&min, &max))| {
            let (normal, min, max) = (direction.as_dvec3(), f64::from(min), f64::from(max));
            [Half { normal, end: max }, Half { normal: -normal, end: -min }]
        })
        .collect();
    let tolerance = TOLERANCE * halves.iter().map(|half| half.end.abs()).fold(0.0, f64::max);
    for second in 1..halves.len() {
        for first in 0..second {
            if let Some([a, b]) = edge(&halves, [first, second], tolerance) {
                line(a.as_vec3(), b.as_vec3());
            }
        }
    }
}

/// The edge between two planes; `None` if they have none, or if other planes stand for it.
fn edge(halves: &[Half], [first, second]: [usize; 2], tolerance: f64) -> Option<[DVec3; 2]> {
    let [one, two] = [&halves[first], &halves[second]];
    let along = one.normal.cross(two.normal);
    let scale = along.length_squared();
    if scale == 0.0 {
        return None;
    }
    let start = (one.end * two.normal.cross(along) + two.end * along.cross(one.normal)) / scale;
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for (index, half) in halves.iter().enumerate() {
        if index == first || index == second {
            continue;
        }
        // Distance to the plane at the start, and its decrease along the line.
        let (left, slope) = (half.end - half.normal.dot(start), half.normal.dot(along));
        if slope > 0.0 {
            to = to.min(left / slope);
        } else if slope < 0.0 {
            from = from.max(left / slope);
        } else {
            // If more than two planes hold the line, the first two that are not opposite draw it.
            let is_opposite = index == first ^ 1 && index > first;
            let is_earlier = index < second && !is_opposite;
            if left < -tolerance || (left <= tolerance && is_earlier) {
                return None;
            }
        }
    }
    let is_long = (to - from) * scale.sqrt() > tolerance;
    is_long.then(|| [start + from * along, start + to * along])
}
