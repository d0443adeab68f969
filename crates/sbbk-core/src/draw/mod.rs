//! Lines for a picture of what a tree holds, and of what a query of two finds, handed to a closure:
//! any renderer of lines will do.
//!
//! ```
//! # use sbbk_core::tree::{BuildOptions, Tree};
//! # use glamx::Vec3;
//! use glamx::Pose3;
//! use sbbk_core::draw::layer;
//!
//! # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! # let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree: Tree = Tree::build(&vertices, &triangles, &BuildOptions::default())?;
//! let mut lines = Vec::new();
//! layer(&tree, 4, &Pose3::IDENTITY, |a, b, colour| lines.push((a, b, colour)));
//! assert!(!lines.is_empty());
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```

mod candidates;
mod polytope;

use std::f32::consts::TAU;

use glamx::{Pose3, Vec3};

use crate::tree::Tree;
use crate::volumes::{Aabb, Kdop, Sphere, directions};
use polytope::edges;

pub use candidates::candidates;

/// Hue in degrees, then saturation, lightness and opacity from 0 to 1: as Rapier's debug renderer
/// has it.
pub type Colour = [f32; 4];

/// What [`layer`] draws spheres in.
pub const SPHERE: Colour = [50.0, 1.0, 0.5, 1.0];
/// What [`layer`] draws boxes in.
pub const BOX: Colour = [210.0, 1.0, 0.5, 1.0];
/// What [`layer`] draws k-DOPs in.
pub const KDOP: Colour = [140.0, 1.0, 0.4, 1.0];

/// What [`candidates`] draws in, for each of the two meshes.
pub const CANDIDATES: [Colour; 2] = [[260.0, 0.5, 0.7, 1.0], [180.0, 0.5, 0.6, 1.0]];

/// Lines of each great circle of a sphere. Fewer: corners show.
const CIRCLE_LINES: u32 = 32;

/// Draws the volumes of the nodes at `depth`, and of leaves above it: together they hold the whole
/// mesh, which is at `pose`. The root, at depth 0, is drawn as its sphere if it has one.
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

/// Draws three great circles of a sphere. Nothing, if it is empty.
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

/// Draws the edges of a box. Nothing, if it is empty.
pub fn aabb(aabb: &Aabb, line: impl FnMut(Vec3, Vec3)) {
    edges(&[Vec3::X, Vec3::Y, Vec3::Z], &aabb.min.to_array(), &aabb.max.to_array(), line);
}

/// Draws the edges of a k-DOP. Nothing, if it is empty.
pub fn kdop(kdop: &Kdop, line: impl FnMut(Vec3, Vec3)) {
    edges(&directions::DIRECTIONS, &kdop.min, &kdop.max, line);
}
