//! Top-down build by the binned surface area heuristic.
//!
//! Wald, *On Fast Construction of SAH-based Bounding Volume Hierarchies*, 2007: the triangles'
//! centroids fall into a fixed number of bins along their longest axis; the split between two bins
//! with the least `area(1)·leaves(1) + area(2)·leaves(2)` wins, where `leaves` is the least number
//! that the triangles take: by the number of triangles trees had a tenth more leaves and were no
//! faster. Where no split separates anything (equal centroids) the triangles are halved by number.
//! Trying all three axes was dropped: 3 % fewer node tests for twice the build time. Two leaves'
//! worth of triangles are halved at the median: as good, and half of all splits are such.
//!
//! A split by cost may part one triangle from all others, and where sizes shrink by a sixteenth
//! from triangle to triangle, each one does: thousands of levels. So from [`DEEPEST_BY_COST`] on
//! triangles are halved at the median, and no tree of `n` triangles is deeper than that and `log2
//! n` together.

use glamx::Vec3;

use super::LayerPlan;
use super::bins::{BinMapping, Bins, Bounds};
use super::node::BATCH;
use crate::volumes::Aabb;

/// Depth of the last nodes that are split by cost. Lower: worse trees of meshes with a few very
/// deep parts; ordinary ones have 20 to 30 levels. Higher: deeper recursion of a refit.
const DEEPEST_BY_COST: u32 = 64;

/// How a tree is built.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct BuildOptions {
    /// The volume of each layer. `None`: boxes, and k-DOPs below if they pay for this mesh, by the model
    /// that [`LayerPlan`] tells of.
    pub layers: Option<LayerPlan>,
    /// Triangles in a leaf at most, 1 to [`BATCH`]; other values are clamped. Larger leaves make
    /// smaller trees and more triangle tests.
    pub leaf_size: usize,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self { layers: None, leaf_size: BATCH }
    }
}

/// The tree in the form of its construction.
pub(super) struct BuildTree {
    /// Parents before children; the root is first.
    pub(super) nodes: Vec<BuildNode>,
    /// The mesh's triangles, reordered so that each node has a contiguous range.
    pub(super) order: Vec<u32>,
}

pub(super) struct BuildNode {
    pub(super) aabb: Aabb,
    pub(super) depth: u32,
    pub(super) content: Content,
}

pub(super) enum Content {
    /// The two children's places in `nodes`.
    Inner([u32; 2]),
    /// A range of `order`.
    Leaf(std::ops::Range<u32>),
}

#[derive(Copy, Clone)]
struct Primitive {
    bounds: Bounds,
    triangle: u32,
}

/// A node whose content is still to be decided.
struct Task {
    node: u32,
    range: std::ops::Range<usize>,
}

pub(super) fn build(
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    options: &BuildOptions,
) -> BuildTree {
    let leaf_size = options.leaf_size.clamp(1, BATCH);
    let mut primitives = primitives(vertices, triangles);
    let mut nodes = Vec::with_capacity(triangles.len());
    nodes.push(BuildNode {
        aabb: bounds(&primitives).aabb(),
        depth: 0,
        content: Content::Leaf(0..triangles.len() as u32),
    });
    let mut tasks = vec![Task { node: 0, range: 0..primitives.len() }];
    while let Some(Task { node, range }) = tasks.pop() {
        if range.len() <= leaf_size {
            nodes[node as usize].content = Content::Leaf(range.start as u32..range.end as u32);
            continue;
        }
        let depth = nodes[node as usize].depth + 1;
        let (middle, bounds) = split(&mut primitives[range.clone()], leaf_size, depth);
        let middle = range.start + middle;
        let first = nodes.len() as u32;
        let children = [range.start..middle, middle..range.end];
        for (child, bounds) in children.into_iter().zip(bounds) {
            tasks.push(Task { node: nodes.len() as u32, range: child });
            nodes.push(BuildNode { aabb: bounds.aabb(), depth, content: Content::Leaf(0..0) });
        }
        nodes[node as usize].content = Content::Inner([first, first + 1]);
    }
    BuildTree { nodes, order: primitives.iter().map(|p| p.triangle).collect() }
}

fn primitives(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Primitive> {
    let primitive = |(triangle, [a, b, c]): (usize, &[u32; 3])| {
        let corner = |vertex: &u32| vertices[*vertex as usize];
        let bounds = Bounds::of_corners([corner(a), corner(b), corner(c)]);
        Primitive { bounds, triangle: triangle as u32 }
    };
    triangles.iter().enumerate().map(primitive).collect()
}

fn bounds(primitives: &[Primitive]) -> Bounds {
    primitives.iter().fold(Bounds::EMPTY, |all, p| all.merge(&p.bounds))
}

/// Reorders the primitives so that the two halves of the best split, which will be at `depth`,
/// follow each other. Returns where the second starts, never at an end, and the boxes of both.
fn split(primitives: &mut [Primitive], leaf_size: usize, depth: u32) -> (usize, [Bounds; 2]) {
    let centroids =
        primitives.iter().fold(Bounds::EMPTY, |all, p| all.with_point(p.bounds.centre()));
    if primitives.len() <= 2 * leaf_size || depth > DEEPEST_BY_COST {
        let axis = centroids.longest_axis();
        primitives
            .sort_unstable_by(|a, b| a.bounds.centre()[axis].total_cmp(&b.bounds.centre()[axis]));
        return halves(primitives);
    }
    if let Some(mapping) = BinMapping::new(&centroids, primitives.len()) {
        let mut bins = Bins::new(&mapping);
        for primitive in &*primitives {
            bins.add(mapping.bin(primitive.bounds.centre()), &primitive.bounds);
        }
        if let Some(split) = bins.best_split(leaf_size) {
            let middle = partition(primitives, |p| mapping.bin(p.bounds.centre()) < split.bin);
            return (middle, split.bounds);
        }
    }
    halves(primitives)
}

fn halves(primitives: &[Primitive]) -> (usize, [Bounds; 2]) {
    let middle = primitives.len() / 2;
    (middle, [bounds(&primitives[..middle]), bounds(&primitives[middle..])])
}

/// Moves the primitives for which `first` holds to the front; returns how many there are.
fn partition(primitives: &mut [Primitive], first: impl Fn(&Primitive) -> bool) -> usize {
    let mut front = 0;
    let mut back = primitives.len();
    while front < back {
        if first(&primitives[front]) {
            front += 1;
        } else {
            back -= 1;
            primitives.swap(front, back);
        }
    }
    front
}
