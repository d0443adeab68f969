//! Packs the tree of the build into the arrays of the descent.
//!
//! Upper nodes are numbered breadth first, so that those visited by every descent share cache
//! lines. The k-DOP layers follow in the order of the build (depth first, siblings adjacent).

use glamx::Vec3;

use super::build::{BuildNode, BuildTree, Content};
use super::node::{LeafBatch, Link, Pair};
use super::{BuildStats, LayerPlan, Tree};
use crate::volumes::{Kdop, SLABS, Sphere};

pub(super) fn pack(
    built: BuildTree,
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    plan: Option<LayerPlan>,
) -> Tree {
    let (leaves, leaf_links) = leaves(&built, vertices, triangles);
    let candidate = plan.unwrap_or(LayerPlan::CANDIDATE);
    let kdops = kdops(&built.nodes, (&leaves, &leaf_links), candidate);
    let (layers, kdop_cut) = match plan {
        Some(layers) => (layers, None),
        None => {
            let nodes = built.nodes.iter().zip(&kdops);
            let nodes = nodes.map(|(node, kdop)| (node.depth, node.aabb, kdop));
            let (layers, cut) = LayerPlan::choose(nodes);
            (layers, Some(cut))
        }
    };
    let (aabb_pairs, kdop_pairs) = pairs(&built.nodes, &leaf_links, &kdops, layers);
    let depth = built.nodes.iter().map(|node| node.depth).max().unwrap_or(0);
    let bytes = size_of_val(&*aabb_pairs) + size_of_val(&*kdop_pairs) + size_of_val(&*leaves);
    Tree {
        sphere: layers.sphere_root.then(|| sphere(vertices, triangles)),
        aabb_pairs,
        kdop_pairs,
        leaves,
        triangle_count: triangles.len() as u32,
        bounds: built.nodes[0].aabb,
        stats: BuildStats { depth, layers, kdop_cut, bytes },
    }
}

/// The children of all inner nodes: boxes of the upper layers, then k-DOPs of the lower ones.
fn pairs(
    nodes: &[BuildNode],
    leaf_links: &[Link],
    kdops: &[Kdop],
    layers: LayerPlan,
) -> (Vec<Pair<3>>, Vec<Pair<SLABS>>) {
    let (numbers, [aabb_count, kdop_count]) = number_nodes(nodes, layers);
    let mut aabb_pairs = vec![Pair::EMPTY; aabb_count];
    let mut kdop_pairs = vec![Pair::EMPTY; kdop_count];
    let link_of = |place: usize| match nodes[place].content {
        Content::Inner(_) => Link::inner(numbers[place]),
        Content::Leaf(_) => leaf_links[place],
    };
    let root = &nodes[0].aabb;
    aabb_pairs[0].set(0, link_of(0), root.min.as_ref(), root.max.as_ref());
    for (place, node) in nodes.iter().enumerate() {
        let Content::Inner(children) = node.content else {
            continue;
        };
        let number = numbers[place] as usize;
        for (lane, child) in children.into_iter().enumerate() {
            let child = child as usize;
            if layers.is_kdop(node.depth + 1) {
                let (pair, kdop) = (&mut kdop_pairs[number - aabb_pairs.len()], &kdops[child]);
                pair.set(lane, link_of(child), &kdop.min, &kdop.max);
            } else {
                let aabb = &nodes[child].aabb;
                let pair = &mut aabb_pairs[number];
                pair.set(lane, link_of(child), aabb.min.as_ref(), aabb.max.as_ref());
            }
        }
    }
    (aabb_pairs, kdop_pairs)
}

/// The batches of triangles, and for each place of the built tree the link to its batch.
fn leaves(
    built: &BuildTree,
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
) -> (Vec<LeafBatch>, Vec<Link>) {
    let corners_of = |triangle: u32| triangles[triangle as usize].map(|v| vertices[v as usize]);
    let mut leaves = Vec::with_capacity(built.nodes.len() / 2 + 1);
    let mut links = vec![Link::NONE; built.nodes.len()];
    for (place, node) in built.nodes.iter().enumerate() {
        if let Content::Leaf(range) = &node.content {
            links[place] = Link::leaf(leaves.len() as u32);
            let members = &built.order[range.start as usize..range.end as usize];
            leaves.push(LeafBatch::gather(members, corners_of));
        }
    }
    (leaves, links)
}

/// The k-DOPs of the nodes in the k-DOP layers, bottom up; empty ones above.
fn kdops(
    nodes: &[BuildNode],
    (leaves, leaf_links): (&[LeafBatch], &[Link]),
    layers: LayerPlan,
) -> Vec<Kdop> {
    if layers.kdop_from_depth.is_none() {
        return Vec::new();
    }
    let mut kdops = vec![Kdop::EMPTY; nodes.len()];
    for (place, node) in nodes.iter().enumerate().rev() {
        if !layers.is_kdop(node.depth) {
            continue;
        }
        kdops[place] = match &node.content {
            Content::Inner([first, second]) => {
                kdops[*first as usize].merge(&kdops[*second as usize])
            }
            Content::Leaf(_) => leaves[leaf_links[place].index() as usize].kdop(),
        };
    }
    kdops
}

/// Returns the runtime number of each inner node by its place in the built tree, and the numbers of
/// pairs of boxes and of k-DOPs.
fn number_nodes(nodes: &[BuildNode], layers: LayerPlan) -> (Vec<u32>, [usize; 2]) {
    let children_are_kdops = |node: &BuildNode| layers.is_kdop(node.depth + 1);
    let is_inner = |node: &BuildNode| matches!(node.content, Content::Inner(_));

    let mut upper: Vec<u32> = (0..nodes.len() as u32)
        .filter(|&i| is_inner(&nodes[i as usize]) && !children_are_kdops(&nodes[i as usize]))
        .collect();
    upper.sort_by_key(|&i| nodes[i as usize].depth);

    let mut of_place = vec![u32::MAX; nodes.len()];
    for (number, &place) in upper.iter().enumerate() {
        of_place[place as usize] = 1 + number as u32;
    }
    // Number 0 holds the root itself, in lane 0.
    let aabb_count = 1 + upper.len();
    let mut next = aabb_count as u32;
    for (place, node) in nodes.iter().enumerate() {
        if is_inner(node) && children_are_kdops(node) {
            of_place[place] = next;
            next += 1;
        }
    }
    (of_place, [aabb_count, next as usize - aabb_count])
}

/// The sphere of the vertices that triangles use.
fn sphere(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Sphere {
    let mut used = vec![false; vertices.len()];
    for &vertex in triangles.iter().flatten() {
        used[vertex as usize] = true;
    }
    if used.iter().all(|&used| used) {
        return Sphere::fit(vertices);
    }
    let used: Vec<Vec3> =
        vertices.iter().zip(used).filter_map(|(&v, used)| used.then_some(v)).collect();
    Sphere::fit(&used)
}
