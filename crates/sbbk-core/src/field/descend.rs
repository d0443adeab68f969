use glamx::{DVec3, Vec3};

use super::frame::FieldFrame;
use super::grid::{FieldTriangle, HeightGrid};
use crate::leaf::PlacedTest;
use crate::simd::each_bit;
use crate::traverse::Counters;
use crate::tree::{LeafBatch, Link, Tree};
use crate::volumes::{DirectionSet, Directions};

/// Memory of the descent, kept by the caller. Holds at most one node a level of the tree and one
/// more.
#[derive(Clone, Debug, Default)]
pub struct FieldScratch {
    stack: Vec<Link>,
}

/// Calls `found` with a triangle of the field and the index of one of the mesh for all pairs within
/// the margin of `frame`, and few others.
///
/// The order depends on the tree and the pose. Cells counted are those whose heights were read, as
/// often as they were.
pub fn descend_field<F: HeightGrid, const AXES: usize>(
    tree: &Tree<AXES>,
    frame: &FieldFrame<'_, F>,
    scratch: &mut FieldScratch,
    mut counters: impl Counters,
    mut found: impl FnMut(FieldTriangle, u32),
) where
    Directions<AXES>: DirectionSet<AXES>,
{
    let leaves = FieldLeaves::new(frame, tree.bounding_ball().centre, tree.magnitude());
    let stack = &mut scratch.stack;
    stack.clear();
    // The root's own volume is in lane 0 of the first entry; the other lane is empty.
    let mut node = Some(0);
    while let Some(index) = node {
        let children = tree.children(index);
        counters.aabb_tests(2);
        for lane in 0..2 {
            let centre = Vec3::from_array(children.boxes.centre.map(|axis| axis[lane]));
            let extent = Vec3::from_array(children.boxes.extent.map(|axis| axis[lane].into()));
            if frame.node_meets(centre, extent, &mut counters) {
                stack.push(children.links[lane]);
            }
        }
        node = None;
        while let Some(link) = stack.pop() {
            if !link.is_leaf() {
                node = Some(link.index());
                break;
            }
            counters.leaf_pair();
            leaves.visit(tree.leaf(link.index()), &mut counters, &mut found);
        }
    }
}

/// Finds the triangles of a field near batches of triangles of a mesh. Made once a query.
pub struct FieldLeaves<'a, F> {
    frame: &'a FieldFrame<'a, F>,
    test: PlacedTest,
}

impl<'a, F: HeightGrid> FieldLeaves<'a, F> {
    /// For a mesh around `centre`, with coordinates up to `magnitude`.
    pub fn new(frame: &'a FieldFrame<'a, F>, centre: Vec3, magnitude: f32) -> Self {
        let test = PlacedTest::new(&frame.placement, centre, magnitude, frame.margin);
        Self { frame, test }
    }

    /// Calls `found` as [`descend_field`] does, for the triangles of `batch`.
    pub fn visit(
        &self,
        batch: &LeafBatch,
        mut counters: impl Counters,
        mut found: impl FnMut(FieldTriangle, u32),
    ) {
        let Self { frame, test } = self;
        let corners = (0..batch.count()).flat_map(|lane| batch.corners(lane));
        let (low, high) = corners
            .map(|corner| frame.placed(corner))
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), corner| {
                (low.min(corner), high.max(corner))
            });
        let Some(cells) = frame.cells_between(low, high) else {
            return;
        };
        let placed = test.place(batch);
        for column in cells.columns.clone() {
            counters.cells(cells.rows.len());
            let lines = [column, column + 1].map(|line| frame.field.heights(line));
            for row in cells.rows.clone() {
                let [a, b] = lines.map(|line| [line[row], line[row + 1]]);
                if !cells.is_met([a[0], a[1], b[0], b[1]]) {
                    continue;
                }
                let cell = [column, row];
                for (side, triangle) in frame.field.triangles(cell).iter().enumerate() {
                    let is_finite = |triangle: &&[Vec3; 3]| triangle.iter().all(|x| x.is_finite());
                    let Some(triangle) = triangle.as_ref().filter(is_finite) else {
                        continue;
                    };
                    each_bit(placed.near(triangle), |lane| {
                        found(FieldTriangle { cell, side }, batch.triangles()[lane]);
                    });
                }
            }
        }
    }
}
