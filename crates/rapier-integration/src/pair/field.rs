use std::hash::BuildHasher;
use std::ops::ControlFlow;

use glamx::{DVec3, Vec3};
use parry3d::bounding_volume::Aabb;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::PointQuery;
use parry3d::shape::{HeightField, HeightFieldCellStatus, Triangle};
use rustc_hash::FxBuildHasher;
use sbbk_core::contact::Feature;
use sbbk_core::field::{FieldFrame, FieldTriangle, HeightGrid};
use sbbk_core::surface::Facets;
use sbbk_core::traverse::{Placement, TestedBox};

use crate::mesh::{MeshView, box_between};

/// Parry's height field as a grid of triangles. Parry's rows lie along z, its columns along x.
#[derive(Copy, Clone)]
pub(crate) struct Field<'a>(pub(crate) &'a HeightField);

impl Field<'_> {
    /// Returns false if the heights under the box of a mesh, which is placed in the field, are all
    /// beyond the prediction distance.
    pub(crate) fn is_near(self, mesh: &MeshView<'_>, mesh_pose: &Pose, prediction: Real) -> bool {
        let (placement, root) = (Placement::new(mesh_pose), mesh.root());
        let frame = FieldFrame::new(&self, &placement, prediction.max(0.0));
        frame.meets(TestedBox::new(root.mins, root.maxs))
    }

    /// Returns Parry's number of a triangle: left ones first, along z, then x.
    pub(super) fn id(self, FieldTriangle { cell: [column, row], side }: FieldTriangle) -> u32 {
        let cell = column * self.0.nrows() + row;
        (cell + side * self.cell_count()) as u32
    }

    /// Returns the triangle of a number.
    fn of_id(self, id: u32) -> FieldTriangle {
        let (cell, side) = (id as usize % self.cell_count(), id as usize / self.cell_count());
        FieldTriangle { cell: [cell / self.0.nrows(), cell % self.0.nrows()], side }
    }

    /// Returns the columns and rows of the corners of a triangle, in Parry's order, by which
    /// normals point up.
    fn places(self, FieldTriangle { cell: [column, row], side }: FieldTriangle) -> [[usize; 2]; 3] {
        let status = self.0.cell_status(row, column);
        let corners = match (status.contains(HeightFieldCellStatus::ZIGZAG_SUBDIVISION), side) {
            (false, 0) => [[0, 0], [0, 1], [1, 0]],
            (false, _) => [[0, 1], [1, 1], [1, 0]],
            (true, 0) => [[0, 0], [0, 1], [1, 1]],
            (true, _) => [[0, 0], [1, 1], [1, 0]],
        };
        corners.map(|[right, up]| [column + right, row + up])
    }

    /// Returns true if normals point up. A negative scale turns them.
    pub(super) fn points_up(self) -> bool {
        self.0.scale().x * self.0.scale().z > 0.0
    }

    /// Returns the nearest point of the surface, and the cosine between the direction to the point
    /// and the downward normal.
    pub(super) fn nearest(self, point: Vector) -> Option<(Vector, Real)> {
        let (triangle, nearest) = self.walk(point)?;
        let normal = self.triangle(self.id(triangle))?.normal()?;
        Some((nearest, -(point - nearest).normalize_or_zero().dot(normal)))
    }

    /// Returns a triangle within a distance of a point.
    pub(super) fn nearest_triangle(self, point: Vector, within: Real) -> Option<u32> {
        let (triangle, nearest) = self.walk(point)?;
        (nearest.distance(point) <= within).then(|| self.id(triangle))
    }

    /// Returns the nearest triangle to a point, and its nearest point. Walks from the cell under
    /// the point to nearer triangles of the cells around, so the triangle is the nearest one there.
    /// Another hill may be nearer.
    fn walk(self, point: Vector) -> Option<(FieldTriangle, Vector)> {
        let (mut least, mut nearest, mut at) = (Real::INFINITY, None, point);
        for _ in 0..STEPS {
            let around = self.nearest_around(at, point);
            let nearer = around.filter(|(_, foot)| foot.distance(point) < least);
            let Some((_, foot)) = nearer else { break };
            (least, nearest, at) = (foot.distance(point), nearer, foot);
        }
        nearest
    }

    /// Returns the triangle that is nearest to a point, and its nearest point. Only the cell under
    /// `at` and the cells around it count. The triangle that faces the point most wins a tie, as it
    /// tells the side of the point.
    fn nearest_around(self, at: Vector, point: Vector) -> Option<(FieldTriangle, Vector)> {
        let (row, column) = self.0.closest_cell_at_point(at);
        let [columns, rows] = self.cell_counts();
        let around = |line: usize, count: usize| line.saturating_sub(1)..(line + 2).min(count);
        let cells = around(column, columns)
            .flat_map(|column| around(row, rows).map(move |row| [column, row]));
        let triangles = cells.flat_map(|cell| {
            let of_side = move |(side, corners)| Some((FieldTriangle { cell, side }, corners?));
            (0..2).zip(self.triangles(cell)).filter_map(of_side)
        });
        let feet = triangles.map(|(triangle, corners)| {
            let corners = Triangle::from(corners);
            let foot = corners.project_local_point(point, false).point;
            let way = point - foot;
            let faces = corners.normal().map_or(0.0, |normal| normal.dot(way).abs());
            (way.length() - NEARLY * faces, (triangle, foot))
        });
        let feet = feet.filter(|(_, (_, foot))| foot.is_finite());
        Some(feet.min_by(|(one, _), (two, _)| one.total_cmp(two))?.1)
    }

    /// Returns about the number of triangles under a box.
    pub(super) fn count_under(self, around: &Aabb) -> f64 {
        let Some(near) = around.intersection(self.0.root_aabb()) else { return 0.0 };
        let cells = |extent: Real, width: Real| 1.0 + f64::from(extent / width.abs());
        let Vector { x, z, .. } = near.extents();
        2.0 * cells(x, self.0.cell_width()) * cells(z, self.0.cell_height())
    }

    /// Returns the triangle of a number, if it exists and is finite.
    pub(super) fn triangle(self, id: u32) -> Option<Triangle> {
        let triangle = self.0.triangle_at_id(id)?;
        triangle.vertices().iter().all(|corner| corner.is_finite()).then_some(triangle)
    }

    pub(super) fn triangle_count(self) -> usize {
        2 * self.cell_count()
    }

    fn cell_count(self) -> usize {
        self.0.nrows() * self.0.ncols()
    }
}

impl Facets for Field<'_> {
    fn twin(&self, half_edge: u32) -> Option<u32> {
        let triangle = self.of_id(half_edge / 3);
        let own = self.places(triangle);
        let [from, to] = [0, 1].map(|i| own[(half_edge as usize + i) % 3]);
        let [column, row] = triangle.cell;
        // An edge on a grid line has its twin in the other cell; else it is the diagonal of its
        // cell.
        let beyond =
            |line: usize, cell: usize| if line == cell { line.wrapping_sub(1) } else { line };
        let cell = match [0, 1].map(|axis| from[axis] == to[axis]) {
            [true, _] => [beyond(from[0], column), row],
            [_, true] => [column, beyond(from[1], row)],
            _ => triangle.cell,
        };
        let [columns, rows] = self.cell_counts();
        if cell[0] >= columns || cell[1] >= rows {
            return None;
        }
        [0, 1].into_iter().find_map(|side| {
            let other = FieldTriangle { cell, side };
            let theirs = self.places(other);
            let edge = (0..3).find(|&i| [theirs[i], theirs[(i + 1) % 3]] == [to, from])?;
            let id = self.id(other);
            self.triangle(id).map(|_| 3 * id + edge as u32)
        })
    }

    /// Two parts of the surface may meet in a vertex if triangles between them were removed.
    fn is_whole(&self, triangle: u32, feature: Feature) -> bool {
        let i = match feature {
            Feature::Vertex(i) => i,
            Feature::Edge(i) => return self.twin(3 * triangle + u32::from(i)).is_some(),
            Feature::Face => return true,
        };
        let [column, row] = self.places(self.of_id(triangle))[usize::from(i)];
        let [columns, rows] = self.cell_counts();
        let cells = |line: usize, count: usize| line.saturating_sub(1)..(line + 1).min(count);
        let has_all = |cell| self.triangles(cell).iter().all(Option::is_some);
        cells(column, columns).all(|column| cells(row, rows).all(|row| has_all([column, row])))
    }

    fn near(&self, corners: [DVec3; 2], visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        let near = box_between(corners);
        self.0.map_elements_in_local_aabb(&near, &mut |id, _| _ = visit(id));
    }

    fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        let triangle = self.triangle(half_edge / 3);
        triangle.map_or(DVec3::NAN, |triangle| {
            triangle.vertices()[(half_edge as usize + i) % 3].as_dvec3()
        })
    }
}

impl HeightGrid for Field<'_> {
    fn cell_counts(&self) -> [usize; 2] {
        [self.0.ncols(), self.0.nrows()]
    }

    fn scale(&self) -> Vec3 {
        self.0.scale()
    }

    #[inline]
    fn heights(&self, column: usize) -> &[f32] {
        let heights = self.0.heights();
        let start = heights.flat_index(0, column);
        &heights.data()[start..start + heights.nrows()]
    }

    #[inline]
    fn triangles(&self, [column, row]: [usize; 2]) -> [Option<[Vec3; 3]>; 2] {
        let (left, right) = self.0.triangles_at(row, column);
        [left, right].map(|triangle| triangle.map(|Triangle { a, b, c }| [a, b, c]))
    }
}

/// Greatest number of cells on the way to the nearest triangle. Higher: more time where cells are
/// small; lower: triangles that are farther.
const STEPS: usize = 32;

/// Share of a distance below which two are equal.
const NEARLY: Real = 1.0e-6;

/// Hash that tells fields apart in constant time: addresses, sizes, scale, flags, and some heights.
/// Heights cannot be edited in place.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) struct FieldToken(u64);

impl FieldToken {
    /// Number of heights in the hash, evenly spread. Higher: slower; lower: edits are missed.
    const SAMPLES: usize = 8;

    pub(super) fn of(field: &HeightField) -> Self {
        let (heights, statuses) = (field.heights().data(), field.cells_statuses().data());
        let addresses = [heights.as_ptr().addr(), statuses.as_ptr().addr()];
        let sizes = [field.nrows(), field.ncols()];
        let (scale, ends) = (field.scale(), field.root_aabb());
        let numbers = [scale.x, scale.y, scale.z, ends.mins.y, ends.maxs.y];
        let samples: [f32; Self::SAMPLES] =
            std::array::from_fn(|i| heights[i * heights.len() / Self::SAMPLES]);
        let bits = (numbers.map(f32::to_bits), samples.map(f32::to_bits));
        Self(FxBuildHasher.hash_one((addresses, sizes, field.flags().bits(), bits)))
    }
}
