//! Slopes of a surface around a point: how far it rises towards a direction, and bends.

use glamx::DVec3;

/// Rise of a neighbour in bends of the surface, as it bends on both sides of a triangle. Higher:
/// blunt edges stop bodies. Lower: a polyhedron that rolls meets the next vertex late and is
/// braked.
pub(super) const BENDS: f64 = 2.0;

/// Sine of the angle by which a neighbour may rise towards a direction and still count as no
/// nearer, where the surface bends as much. Higher: bodies catch on edges between facets. Lower:
/// faces that lie on each other, not quite flat, lose contacts.
pub(super) const RISE: f64 = 0.05;

/// [`RISE`] if the other feature is a face. Higher: blunt edges stop bodies that slide over
/// them. Lower: a body that rocks from point to point gets the next point too late.
pub(super) const RISE_TO_FACE: f64 = 0.3;

/// Sine of the angle up to which triangles count as one plane, and directions as parallel to it.
/// Higher: a nut locks on its bolt. Lower: flat sides end at rounding.
pub(super) const FLAT: f64 = 1.0e-3;

/// Triangles at a place beyond which they are a crowd. Higher: fans take longer. Lower: ordinary
/// vertices do.
pub(super) const LONG: usize = 32;

/// The surface around a point, seen along a direction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slopes {
    /// Greatest slope towards the direction, as the square of a sine.
    pub(super) rise: f64,
    /// Height of the direction along the [pseudo-normal](Heights) out of the body.
    pub(super) height: f64,
    /// The bend where many triangles meet: twice that from their mean plane.
    pub(super) bend: Option<Bend>,
}

impl Slopes {
    /// Takes note of the way to a corner.
    #[inline(always)]
    pub(super) fn add(&mut self, edge: DVec3, direction: DVec3) {
        let height = edge.dot(direction);
        if height > 0.0 {
            self.rise = self.rise.max(height * height / edge.length_squared());
        }
    }
}

/// Greatest slope out of the plane of a triangle, as the square of a sine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bend {
    normal: DVec3,
    square: f64,
}

impl From<DVec3> for Bend {
    /// A triangle without an area has no plane to bend from.
    fn from(normal: DVec3) -> Self {
        Self { normal, square: if normal == DVec3::ZERO { f64::INFINITY } else { 0.0 } }
    }
}

impl Bend {
    /// Takes note of the way to a corner.
    #[inline(always)]
    pub(super) fn add(&mut self, edge: DVec3) {
        let off = edge.dot(self.normal);
        let square = off * off / (edge.length_squared() * self.normal.length_squared());
        self.square = self.square.max(square);
    }

    /// Returns twice the bend.
    pub(super) fn doubled(self) -> Self {
        Self { square: 4.0 * self.square, ..self }
    }

    /// True if a surface rises more than it bends, at most by `most`. A flat place is no feature.
    pub(super) fn is_exceeded(&self, rise: f64, most: f64) -> bool {
        rise > (BENDS * BENDS * self.square).clamp(FLAT * FLAT, most * most)
    }
}

/// Height of a direction along the pseudo-normal of a point: the sum of the normals there, weighted
/// by angles. The height is negative if the direction leads to a point in the solid to which the
/// place is nearest. Areas as weights would fail at acute corners.
///
/// Source: Bærentzen and Aanæs, *Signed Distance Computation Using the Angle Weighted
/// Pseudonormal*, 2005.
#[derive(Clone, Copy, Default)]
pub(super) struct Heights {
    normal: DVec3,
    size: f64,
}

impl Heights {
    /// Share of the terms below which a height is zero.
    const ROUNDING: f64 = 1.0e-8;

    /// Adds a triangle by its area vector, and the angle that the triangle has at the point.
    pub(super) fn add(&mut self, area: DVec3, angle: f64) {
        self.normal += angle * area.normalize_or_zero();
        self.size += angle;
    }

    /// Returns the height of a unit direction.
    pub(super) fn along(&self, direction: DVec3) -> f64 {
        let height = self.normal.dot(direction);
        if height.abs() <= Self::ROUNDING * self.size { 0.0 } else { height }
    }
}

/// Returns the angle between two vectors.
pub(super) fn angle(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length().atan2(u.dot(v))
}

/// The signs of heights of a direction along the normals of triangles.
#[derive(Default)]
pub(super) struct Signs {
    low: f64,
    high: f64,
}

impl Signs {
    #[inline(always)]
    pub(super) fn add(&mut self, height: f64) {
        self.low = self.low.min(height);
        self.high = self.high.max(height);
    }

    /// Returns true if the direction leads behind all triangles, false if behind none, else `None`.
    pub(super) fn lead_in(&self) -> Option<bool> {
        (self.low >= 0.0 || self.high <= 0.0).then_some(self.low < 0.0)
    }
}
