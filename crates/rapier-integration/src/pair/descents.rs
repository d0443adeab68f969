//! Descents to the candidates of two shapes made of triangles.
//!
//! Two rigid meshes with trees descend both trees. Two others descend Parry's BVHs. A mesh and a height field
//! visit Parry's BVH of the mesh and read the cells under it ([`sbbk_core::field`]).

use std::ops::ControlFlow;

use parry3d::math::Real;
use sbbk_core::field::{FieldFrame, FieldLeaves};
use sbbk_core::leaf::LeafTest;
use sbbk_core::surface::Surface;
use sbbk_core::traverse::{
    DescentCounts, DescentScratch, NodePair, PairFrame, begin_descent, descend_from,
};
use sbbk_core::tree::{BATCH, LeafBatch, Tree};

use super::bvh_descent::{BvhDescent, Culling};
use super::chunks::{ChunkResult, has_threads, in_chunks};
use super::field::Field;
use super::query::Moving;
use super::state::Candidate;
use super::triangle_shape::TriangleShape;
use super::triangle_shapes::{Hint, TriangleShapes};
use crate::mesh::MeshView;

/// Pairs of nodes or a few more at which the chunks of a descent start. Higher: fewer descents are split; lower: one
/// chunk may have all that is near.
const STARTS: usize = 1024;

/// Least number of node pairs in a chunk. Higher: one chunk may have all that is near; lower: chunks of microseconds.
const LEAST_STARTS: usize = 32;

/// Least number of triangles of the larger mesh in a chunk of a BVH descent. Higher, lower: see [`LEAST_STARTS`].
const LEAST_NEAR: usize = 64;

/// Memory for descents.
#[derive(Default)]
pub(super) struct DescentMemory {
    /// Triangles at which a descent starts.
    near: Vec<u32>,
    /// Nodes at which a descent starts.
    start: Vec<NodePair>,
    descent: DescentChunk,
}

/// Result of a chunk of a descent, and memory for it.
#[derive(Default)]
struct DescentChunk {
    found: Vec<Candidate<Hint>>,
    counts: DescentCounts,
    stack: DescentScratch,
}

impl ChunkResult for DescentChunk {
    fn append(&mut self, next: Self) {
        self.found.extend(next.found);
        self.counts += next.counts;
    }
}

impl TriangleShapes<'_> {
    /// Adds all pairs of triangles within `margin`, and few others.
    pub(super) fn descend(
        &self,
        margin: Real,
        counts: &mut DescentCounts,
        DescentMemory { near, start, descent }: &mut DescentMemory,
        found: &mut Vec<Candidate<Hint>>,
    ) {
        std::mem::swap(found, &mut descent.found);
        match (&self.shapes, self.trees) {
            (_, Some(trees)) => self.descend_trees(trees.into(), margin, start, descent),
            ([TriangleShape::Mesh(one), TriangleShape::Mesh(two)], None) => {
                self.descend_bvhs([one.view, two.view], margin, near, descent);
            }
            ([TriangleShape::Field(field), TriangleShape::Mesh(mesh)], None)
            | ([TriangleShape::Mesh(mesh), TriangleShape::Field(field)], None) => {
                self.descend_field(field.field, mesh.view, margin, near, descent);
            }
            ([TriangleShape::Field(_), TriangleShape::Field(_)], None) => {}
        }
        *counts += std::mem::take(&mut descent.counts);
        std::mem::swap(found, &mut descent.found);
    }

    fn descend_trees(
        &self,
        trees: (&Tree, &Tree),
        margin: Real,
        start: &mut Vec<NodePair>,
        descent: &mut DescentChunk,
    ) {
        let mut frame = PairFrame::new(trees, self.pose.placement12, margin);
        let culling = self.lateral_culling(margin);
        let test = LeafTest::new(&frame);
        let doubles = self.doubles();
        let count = if has_threads() { STARTS } else { 1 };
        begin_descent(trees, &mut frame, count, start, &mut descent.counts);
        let least = if start.len() < STARTS { STARTS } else { LEAST_STARTS };
        in_chunks(start, least, descent, &|start: &mut [_], chunk: &mut DescentChunk| {
            let DescentChunk { found, counts, stack } = chunk;
            let frame = &mut frame.clone();
            descend_from(start, trees, frame, stack, counts, |batch1, batch2| {
                let triangles = [batch1.triangles(), batch2.triangles()];
                let bends_little = |i: usize, lane: usize| self.bends_little(i, triangles[i][lane]);
                let found = |lane1: usize, lane2: usize| {
                    let pair = [triangles[0][lane1], triangles[1][lane2]];
                    if !has_double(&doubles, pair) {
                        found.push(Candidate::new(pair));
                    }
                };
                let lateral = culling.as_ref();
                test.survivors_in_front(lateral, batch1, batch2, bends_little, found);
            });
        });
    }

    fn descend_bvhs(
        &self,
        meshes: [&MeshView<'_>; 2],
        margin: Real,
        near: &mut Vec<u32>,
        descent: &mut DescentChunk,
    ) {
        let bends_little = |i: usize, triangle: u32| self.bends_little(i, triangle);
        let culling = self.lateral_culling(margin);
        let culling = culling.map(|lateral| Culling { lateral, may_reject: &bends_little });
        let search = BvhDescent::new(meshes, self.pose.placement12, margin, culling);
        search.list_near(near, &mut descent.counts);
        let doubles = self.doubles();
        let larger = doubles[self.larger];
        near.retain(|&triangle| !larger.is_some_and(|surface| surface.is_double(triangle)));
        in_chunks(near, LEAST_NEAR, descent, &|near: &mut [u32], chunk: &mut DescentChunk| {
            let DescentChunk { found, counts, .. } = chunk;
            let _ = search.pairs(near, counts, |pair| {
                if !has_double(&doubles, pair) {
                    found.push(Candidate::new(pair));
                }
                ControlFlow::Continue(())
            });
        });
        meshes[0].store.count_walk();
    }

    fn descend_field(
        &self,
        field: Field<'_>,
        mesh: &MeshView<'_>,
        margin: Real,
        near: &mut Vec<u32>,
        DescentChunk { found, counts, .. }: &mut DescentChunk,
    ) {
        let Moving { ball, placement } = self.moving();
        let frame = FieldFrame::new(&field, placement, margin);
        let leaves = FieldLeaves::new(&frame, ball.centre, mesh.magnitude());
        near.clear();
        near.extend(mesh.near(|node| frame.meets(node, ())));
        for triangles in near.chunks(BATCH) {
            let batch = LeafBatch::gather(triangles, |triangle| mesh.corners(triangle));
            leaves.visit(&batch, &mut *counts, |triangle, of_mesh| {
                let of_field = field.id(triangle);
                let pair = if self.larger == 0 { [of_field, of_mesh] } else { [of_mesh, of_field] };
                found.push(Candidate::new(pair));
            });
        }
    }

    /// Returns the surfaces that are known by now and have doubles. A descent may leave these out, as they have no contacts.
    fn doubles(&self) -> [Option<&Surface>; 2] {
        self.shapes.each_ref().map(|shape| match shape {
            TriangleShape::Mesh(mesh) => mesh.surface.as_ref()?.with_doubles(),
            TriangleShape::Field(_) => None,
        })
    }
}

/// Returns true if one of two triangles is a double.
#[inline]
fn has_double(of: &[Option<&Surface>; 2], pair: [u32; 2]) -> bool {
    (0..2).any(|i| of[i].is_some_and(|surface| surface.is_double(pair[i])))
}
