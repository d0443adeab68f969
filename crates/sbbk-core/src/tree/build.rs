//! Top-down build by the binned surface area heuristic.
//!
//! Wald, *On Fast Construction of SAH-based Bounding Volume Hierarchies*, 2007: the triangles' centroids fall
//! into a fixed number of bins an axis; the split between two bins with the least
//! `area(1)·count(1) + area(2)·count(2)` wins. Where no split separates anything (equal centroids) the
//! triangles are halved by number, so the depth stays logarithmic for any input.

use glamx::Vec3;

use super::LayerPlan;
use super::bins::{BINS, Bin, BinMapping};
use super::node::BATCH;
use crate::volumes::{Aabb, Volume};

/// How a tree is built.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct BuildOptions {
    /// The volume of each layer.
    pub layers: LayerPlan,
    /// Triangles in a leaf at most, 1 to [`BATCH`]; other values are clamped. Larger leaves make smaller
    /// trees and more triangle tests.
    pub leaf_size: usize,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self { layers: LayerPlan::default(), leaf_size: BATCH }
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
    aabb: Aabb,
    centroid: Vec3,
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
        aabb: bounds(&primitives),
        depth: 0,
        content: Content::Leaf(0..triangles.len() as u32),
    });
    let mut tasks = vec![Task { node: 0, range: 0..primitives.len() }];
    while let Some(Task { node, range }) = tasks.pop() {
        if range.len() <= leaf_size {
            nodes[node as usize].content = Content::Leaf(range.start as u32..range.end as u32);
            continue;
        }
        let (middle, aabbs) = split(&mut primitives[range.clone()]);
        let middle = range.start + middle;
        let depth = nodes[node as usize].depth + 1;
        let first = nodes.len() as u32;
        let children = [range.start..middle, middle..range.end];
        for (child, aabb) in children.into_iter().zip(aabbs) {
            tasks.push(Task { node: nodes.len() as u32, range: child });
            nodes.push(BuildNode { aabb, depth, content: Content::Leaf(0..0) });
        }
        nodes[node as usize].content = Content::Inner([first, first + 1]);
    }
    BuildTree { nodes, order: primitives.iter().map(|p| p.triangle).collect() }
}

fn primitives(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Primitive> {
    triangles
        .iter()
        .enumerate()
        .map(|(triangle, indices)| {
            let aabb = Aabb::fit(&indices.map(|v| vertices[v as usize]));
            Primitive { aabb, centroid: aabb.centre(), triangle: triangle as u32 }
        })
        .collect()
}

fn bounds(primitives: &[Primitive]) -> Aabb {
    primitives.iter().fold(Aabb::EMPTY, |all, p| all.merge(&p.aabb))
}

/// Reorders the primitives so that the two halves of the best split follow each other. Returns where the second
/// starts, never at an end, and the boxes of both.
fn split(primitives: &mut [Primitive]) -> (usize, [Aabb; 2]) {
    let centroids = primitives.iter().fold(Aabb::EMPTY, |all, p| all.with_point(p.centroid));
    let mapping = BinMapping::new(&centroids);
    if let Some((axis, bin, aabbs)) = best_split(primitives, &mapping) {
        let middle = partition(primitives, |p| mapping.bins(p.centroid)[axis] < bin);
        return (middle, aabbs);
    }
    let middle = primitives.len() / 2;
    (middle, [bounds(&primitives[..middle]), bounds(&primitives[middle..])])
}

/// The axis and first bin of the right side of the cheapest split that has triangles on both sides.
fn best_split(primitives: &[Primitive], mapping: &BinMapping) -> Option<(usize, usize, [Aabb; 2])> {
    let mut bins = [[Bin::EMPTY; BINS]; 3];
    for primitive in primitives {
        for (axis, bin) in mapping.bins(primitive.centroid).into_iter().enumerate() {
            let bin = &mut bins[axis][bin];
            bin.aabb = bin.aabb.merge(&primitive.aabb);
            bin.count += 1;
        }
    }
    let mut best = None;
    let mut best_cost = f32::INFINITY;
    for axis in (0..3).filter(|&axis| !mapping.is_flat(axis)) {
        let mut above = [Bin::EMPTY; BINS];
        above[BINS - 1] = bins[axis][BINS - 1];
        for bin in (0..BINS - 1).rev() {
            above[bin] = bins[axis][bin].merge(&above[bin + 1]);
        }
        let mut below = Bin::EMPTY;
        for bin in 1..BINS {
            below = below.merge(&bins[axis][bin - 1]);
            let cost = below.cost() + above[bin].cost();
            if below.count > 0 && above[bin].count > 0 && cost < best_cost {
                best_cost = cost;
                best = Some((axis, bin, [below.aabb, above[bin].aabb]));
            }
        }
    }
    best
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
