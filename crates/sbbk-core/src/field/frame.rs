//! Boxes of a mesh against ranges of cells.
//!
//! # Rounding
//!
//! With `n` cells along an axis, line `c` computed in f32 as `(c·fl(1/n) - 1/2)·scale`, in any
//! order, is off by less than `γ_4·|scale|`. Ranges are therefore wider by `γ_8` of the whole. A
//! height times its scale loses `γ_1` of the product, and [`MIN_POSITIVE`](f32::MIN_POSITIVE) to
//! underflow, so bounds of heights are wider by `γ_4`. Boxes are turned in f64, with a dozen
//! roundings of `2⁻⁵³`: they grow by `1e-14` of their coordinates.

use std::cell::Cell;
use std::ops::Range;

use glamx::{DMat3, DVec3, Vec3};

use super::HeightGrid;
use crate::traverse::{Placement, TestedBox};
use crate::volumes::rounding::gamma;

/// Cells under a node up to which their heights are read; a node above more is taken apart at once.
/// More: whole parts of a mesh above the ground are ruled out sooner. Fewer: less is read twice
/// where they are not.
const READ_LIMIT: usize = 1024;

/// A mesh and a height field at one pose: which cells a part of the mesh can touch.
pub struct FieldFrame<'a, F> {
    pub(super) field: &'a F,
    pub(super) placement: Placement,
    absolute: DMat3,
    /// The margin in the frame of the field.
    pub(super) reach: f64,
    /// Reads of cells so far.
    pub cells: Cell<u64>,
}

/// A range of cells and the heights at which it can touch.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CellRange {
    pub(super) columns: Range<usize>,
    pub(super) rows: Range<usize>,
    /// Not yet scaled.
    low: f32,
    high: f32,
}

impl<'a, F: HeightGrid> FieldFrame<'a, F> {
    /// For a mesh at `placement` in the frame of the field. Triangles within `margin`, in either
    /// frame, will be found. A pose that is not finite is nowhere.
    pub fn new(field: &'a F, placement: &Placement, margin: f32) -> Self {
        let reach = f64::from(margin) * placement.scale().max(1.0) * (1.0 + 1e-12);
        let absolute = placement.rotation.abs();
        Self { field, placement: *placement, absolute, reach, cells: Cell::new(0) }
    }

    /// Returns true if a triangle in a box of the mesh's frame may touch the field. Conservative.
    pub fn meets(&self, tested: TestedBox) -> bool {
        let (centre, extent) = tested.centre_extent();
        // Centre and half-lengths are rounded: what they lose is a part of their size.
        let lost = gamma(4) * (centre.abs() + extent).max_element();
        let middle = self.placed(centre);
        let half = self.absolute * (extent + Vec3::splat(lost)).as_dvec3();
        let cells = self.cells_between(middle - half, middle + half);
        cells.is_some_and(|cells| cells.count() > READ_LIMIT || self.are_met(&cells))
    }

    pub(super) fn count_reads(&self, count: usize) {
        self.cells.set(self.cells.get() + count as u64);
    }

    /// A point of the mesh in the frame of the field.
    pub(super) fn placed(&self, x: Vec3) -> DVec3 {
        self.placement.to_frame1(x, Vec3::ZERO)
    }

    /// The cells that may come within the margin of a box of the field's frame.
    pub(super) fn cells_between(&self, low: DVec3, high: DVec3) -> Option<CellRange> {
        let coordinates = low.abs().max(high.abs()).element_sum()
            + self.placement.translation.abs().element_sum();
        let reach = self.reach + 1e-14 * coordinates;
        let (low, high) = (low - reach, high + reach);
        let scale = self.field.scale().as_dvec3();
        let [columns, rows] = self.field.cell_counts();
        let [bottom, top] = heights(low.y, high.y, scale.y);
        Some(CellRange {
            columns: lines(low.x, high.x, scale.x, columns)?,
            rows: lines(low.z, high.z, scale.z, rows)?,
            low: bottom,
            high: top,
        })
    }

    /// True unless the corners of the cells are all above or all below. A NaN is neither.
    fn are_met(&self, cells: &CellRange) -> bool {
        let (mut is_one_below, mut is_one_above) = (false, false);
        for column in cells.columns.start..=cells.columns.end {
            self.count_reads(cells.rows.len());
            for &height in &self.field.heights(column)[cells.rows.start..=cells.rows.end] {
                is_one_below |= height <= cells.high;
                is_one_above |= height >= cells.low;
            }
            if is_one_below && is_one_above {
                return true;
            }
        }
        false
    }
}

impl CellRange {
    fn count(&self) -> usize {
        self.columns.len() * self.rows.len()
    }

    /// True if a cell with these corners can be touched, see [`FieldFrame::are_met`].
    pub(super) fn is_met(&self, corners: [f32; 4]) -> bool {
        corners.iter().any(|&height| height <= self.high)
            && corners.iter().any(|&height| height >= self.low)
    }
}

/// The cells along an axis that an interval meets.
fn lines(low: f64, high: f64, scale: f64, count: usize) -> Option<Range<usize>> {
    if count == 0 {
        return None;
    }
    if scale == 0.0 {
        return (low <= 0.0 && high >= 0.0).then_some(0..count);
    }
    let (a, b) = (low / scale + 0.5, high / scale + 0.5);
    let slack = f64::from(gamma(8));
    let cells = count as f64;
    let first = ((a.min(b) - slack) * cells).floor();
    let last = ((a.max(b) + slack) * cells).floor();
    let is_inside = first < cells && last >= 0.0;
    is_inside.then(|| first.max(0.0) as usize..last.min(cells - 1.0) as usize + 1)
}

/// The interval of y in heights before scaling. Rounding its ends to f32 passes no height, as
/// heights are f32 themselves.
fn heights(low: f64, high: f64, scale: f64) -> [f32; 2] {
    if scale == 0.0 {
        let is_inside = low <= 0.0 && high >= 0.0;
        return if is_inside { [f32::NEG_INFINITY, f32::INFINITY] } else { [f32::NAN; 2] };
    }
    let (a, b) = (low / scale, high / scale);
    let slack =
        f64::from(gamma(4)) * a.abs().max(b.abs()) + (f64::from(f32::MIN_POSITIVE) / scale).abs();
    [(a.min(b) - slack) as f32, (a.max(b) + slack) as f32]
}

#[cfg(test)]
mod tests {
    use super::heights;

    /// A scaled height is in its own interval, where the product rounds and where it underflows.
    #[test]
    fn a_scaled_height_is_a_height() {
        for i in 1..10_000_u16 {
            let (x, y) = (f32::from(i).sqrt(), f32::from(i).cbrt());
            for (height, scale) in [(x, y), (x, -y), (1e-30 * x, 1e-20 * y), (1e-38 * x, 0.1 * y)] {
                let scaled = f64::from(height * scale);
                let [low, high] = heights(scaled, scaled, f64::from(scale));
                assert!(low <= height && height <= high, "{height} times {scale}: {low} to {high}");
            }
        }
    }
}
