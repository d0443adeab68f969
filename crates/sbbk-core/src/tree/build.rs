//! Top-down build by the binned surface area heuristic.
//!
//! Wald, *On Fast Construction of SAH-based Bounding Volume Hierarchies*, 2007. The triangles'
//! centroids fall into a fixed number of bins along their longest axis. The split between two bins
//! with the least `area(1)·leaves(1) + area(2)·leaves(2)` wins, where `leaves` is the least number
//! of leaves for the triangles. If no split separates anything (equal centroids), the triangles are
//! halved by number. Two leaves' worth of triangles are halved at the median.
//!
//! A split by cost may part one triangle from all others, thousands of times if sizes shrink from
//! triangle to triangle. So below [`DEEPEST_BY_COST`] triangles are halved at the median. No tree
//! of `n` triangles is deeper than that plus `log2 n`.

use glamx::Vec3;

use super::bins::{BinMapping, Bins, Bounds};
use super::node::BATCH;
use crate::volumes::Aabb;

/// Depth of the last nodes that are split by cost. Higher: deeper trees; lower: worse trees of
/// meshes with a few very deep parts. Ordinary trees have 20 to 30 levels.
const DEEPEST_BY_COST: u32 = 64;

/// The tree under construction.
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
    /// Indices of the two children in `nodes`.
    Inner([u32; 2]),
    /// A range of `order`.
    Leaf(std::ops::Range<u32>),
}

#[derive(Copy, Clone)]
struct Primitive {
    bounds: Bounds,
    triangle: u32,
}

pub(super) fn build(vertices: &[Vec3], triangles: &[[u32; 3]]) -> BuildTree {
    let mut primitives = primitives(vertices, triangles);
    let mut nodes = Vec::with_capacity(triangles.len());
    nodes.push(BuildNode {
        aabb: bounds(&primitives).aabb(),
        depth: 0,
        content: Content::Leaf(0..triangles.len() as u32),
    });
    // Nodes without content.
    let mut tasks = vec![(0, 0..primitives.len())];
    while let Some((node, range)) = tasks.pop() {
        if range.len() <= BATCH {
            nodes[node].content = Content::Leaf(range.start as u32..range.end as u32);
            continue;
        }
        let depth = nodes[node].depth + 1;
        let (middle, bounds) = split(&mut primitives[range.clone()], depth);
        let middle = range.start + middle;
        let first = nodes.len() as u32;
        let children = [range.start..middle, middle..range.end];
        for (child, bounds) in children.into_iter().zip(bounds) {
            tasks.push((nodes.len(), child));
            nodes.push(BuildNode { aabb: bounds.aabb(), depth, content: Content::Leaf(0..0) });
        }
        nodes[node].content = Content::Inner([first, first + 1]);
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

/// Reorders the primitives by the best split into nodes at `depth`. Returns the start of the second
/// half, never at an end, and the boxes of both.
fn split(primitives: &mut [Primitive], depth: u32) -> (usize, [Bounds; 2]) {
    let centroids =
        primitives.iter().fold(Bounds::EMPTY, |all, p| all.with_point(p.bounds.centre()));
    if primitives.len() <= 2 * BATCH || depth > DEEPEST_BY_COST {
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
        if let Some((bin, bounds)) = bins.best_split() {
            let middle = partition(primitives, |p| mapping.bin(p.bounds.centre()) < bin);
            return (middle, bounds);
        }
    }
    halves(primitives)
}

fn halves(primitives: &[Primitive]) -> (usize, [Bounds; 2]) {
    let middle = primitives.len() / 2;
    (middle, [bounds(&primitives[..middle]), bounds(&primitives[middle..])])
}

/// Moves the primitives for which `first` holds to the front; returns their number.
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
