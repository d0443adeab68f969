//! The surface filter: keeps the contacts of two triangles that are contacts of the surfaces.
//!
//! * Apart: both points are local minima of the distance ([`Around::is_local_minimum`]), and the
//!   normal leads out of solids. Others are contacts of internal edges, or of walls that pass by.
//!   Distant edges and vertices may pass each other, and count only if they face each other or if
//!   nothing is nearer.
//! * Crossing: the contact leads out of solids, and both surfaces end where the overlap does.
//!   Triangles of solids that have passed each other count as crossing.
//!
//! A sheet is a solid for a [thin](THIN) body in front of it.
//!
//! Crossing surfaces never stay without a contact: an island without one gets the best there is
//! ([`OverlapIslands`](super::islands::OverlapIslands)).

use glamx::{DVec3, Vec3};
use sbbk_core::contact::{Feature, Outward, TriangleContact};
use sbbk_core::query::TrianglePair;
use sbbk_core::surface::{Around, Facets, Side, area_vector};

use super::islands::{Crossing, SheetSide, Support};
use super::shapes::{
    ContactSource, OverSheet, ShapeFacets, TriangleShapes, TriangleSurfaceContact,
};
use super::tuning::{DISTANT, LIP, NEAR_NORMAL, SAME_SIDE, THIN};
use super::ways::resting_depth;

/// Least cosine between the normals of an upright contact and of its face. Higher: contacts are
/// turned in vain; lower: slanted contacts keep their normals.
pub(super) const ALONG_NORMAL: f64 = 0.999_999;

/// Length by which a ray between two triangles that have passed each other starts and ends within
/// them, in their distance. Also the share of the way to the middle of a triangle at which a second
/// point is tested. Higher: thin walls in each other are pushed together. Lower: rounding decides
/// where rays start.
const WITHIN: f64 = 0.01;

/// Distance, in sizes of the triangles, below which rounding decides on which side of each other
/// these are. Higher: contacts are lost; lower: triangles that touch count as crossing.
const SIDE_ROUNDING: f64 = 1.0e-9;

/// Result of the first pass for two triangles.
pub(super) enum Verdict {
    None,
    /// Edges or vertices that may pass each other. They have a contact only if nothing is nearer.
    Passing,
    /// A contact and, at a [border](super::borders), the normal of the face.
    Contact(TriangleSurfaceContact, Option<DVec3>),
    /// The surfaces cross.
    Crossing(Crossing),
}

impl TriangleShapes<'_> {
    /// Calls `then` with the filter of two triangles, if these exist and have surfaces.
    pub(super) fn with_filter<T>(
        &self,
        pair: [u32; 2],
        then: impl FnOnce(&SurfaceFilter<'_>) -> T,
    ) -> Option<T> {
        let local = self.local(pair)?;
        Some(then(&SurfaceFilter::new(self, pair, &local)?))
    }
}

/// Two triangles and the surfaces around them. Turns contacts of the triangles into contacts of the
/// surfaces.
pub(super) struct SurfaceFilter<'a> {
    pub(super) shapes: &'a TriangleShapes<'a>,
    pub(super) pair: [u32; 2],
    /// The triangles.
    local: &'a TrianglePair,
    surfaces: [Around<ShapeFacets<'a>>; 2],
}

impl<'a> SurfaceFilter<'a> {
    /// The filter for contacts of surfaces. `local` are the triangles of `pair`.
    #[inline(always)]
    pub(super) fn new(
        shapes: &'a TriangleShapes<'a>,
        pair: [u32; 2],
        local: &'a TrianglePair,
    ) -> Option<Self> {
        let surfaces = [shapes[0].around(pair[0])?, shapes[1].around(pair[1])?];
        let mut filter = Self { shapes, pair, local, surfaces };
        for i in 0..2 {
            let other = 1 - i;
            if filter.surfaces[i].side == Side::Sheet
                && filter.is_thin(other)
                && filter.smaller() == Some(other)
                && filter.is_in_front(i)
            {
                filter.surfaces[i].side = Side::Outer;
            }
        }
        Some(filter)
    }

    /// Returns true if a triangle has the body on both sides, or is a double. It has no contacts.
    pub(super) fn has_wall_within(&self) -> bool {
        self.surfaces.iter().any(|surface| surface.side == Side::Inner)
    }

    /// First pass. `may_pass`: edges and vertices may pass each other.
    #[inline(always)]
    pub(super) fn apply(&self, contact: TriangleContact, may_pass: bool) -> Verdict {
        let of_triangles = TriangleSurfaceContact::of_triangles(contact);
        if self.has_wall_within() {
            return Verdict::None;
        }
        if contact.distance > self.shapes.filter_distance {
            // The smaller shape may turn before the two meet. A contact from within the larger one
            // would hold it in.
            let leads_inside = self.larger().any(|i| self.points_inside(i, &contact));
            return if leads_inside { Verdict::None } else { Verdict::Contact(of_triangles, None) };
        }
        if !contact.features.is_crossing() {
            if may_pass && self.passes_by(&contact) {
                return Verdict::Passing;
            }
            let is_first_minimum = self.is_minimum(0, &contact);
            if is_first_minimum && self.is_minimum(1, &contact) {
                let upright = (0..2).find_map(|i| self.normal_at_border(i, &contact));
                return Verdict::Contact(of_triangles, upright);
            }
            if !self.have_passed(is_first_minimum, &contact) {
                let passed = self.passed_sheets(&contact);
                return passed.map_or(Verdict::None, Verdict::Crossing);
            }
        }
        Verdict::Crossing(self.crossing(&contact))
    }

    /// Returns true if triangles that are apart have passed each other in solids.
    /// `is_first_minimum`: the contact is a local minimum on shape 1.
    #[inline(always)]
    fn have_passed(&self, is_first_minimum: bool, contact: &TriangleContact) -> bool {
        let is_solid = self.are_solid();
        // A local minimum does not point inside: spares the test.
        let points_inside = |i: usize| self.points_inside(i, contact);
        (is_solid[0] || is_solid[1])
            && !(is_solid[0] && is_first_minimum)
            && self.local.corners.iter().any(|corners| !leans(corners, contact.normal))
            && (0..2).all(|i| !is_solid[i] || points_inside(i))
            && self.is_way_inside(is_solid, contact)
    }

    /// Returns the crossing of two sheets that have passed each other a little. The smaller one goes
    /// back to the side of its middle.
    fn passed_sheets(&self, contact: &TriangleContact) -> Option<Crossing> {
        if contact.distance > resting_depth(self.shapes.filter_distance)
            || self.are_solid() != [false; 2]
            || self.local.corners.iter().any(|corners| leans(corners, contact.normal))
        {
            return None;
        }
        let crossing = self.crossing(contact);
        let sheet = crossing.sheet.filter(|sheet| sheet.is_pushed_through(contact.normal))?;
        sheet.shape?;
        let normals = self.local.corners.each_ref().map(area_vector);
        let outward = [0, 1].map(|i| {
            let out = [-contact.normal, contact.normal][i];
            Some(normals[i].dot(out).signum())
        });
        Some(Crossing { outward, ..crossing })
    }

    /// Returns true if the other point of a contact is in a solid that does not end before. If both
    /// solids end between the points, they are thin walls, and their outer sides have the contact.
    fn is_way_inside(&self, is_solid: [bool; 2], contact: &TriangleContact) -> bool {
        if is_solid != [true; 2] {
            return true;
        }
        let length = (1.0 - 2.0 * WITHIN) * contact.distance;
        let ends = |i: usize| self.shapes[i].ends_within(self.way(i, contact), length);
        let is_sure = |i: usize| {
            let direction = self.direction(i, contact);
            self.surfaces[i].leads_behind_all(self.pair[i], feature(contact, i), direction)
        };
        (0..2).any(|i| !ends(i) && (is_sure(i) || self.may_hold(i, contact, length)))
    }

    /// Returns true if the other triangle of a contact has a point in a solid, or if that is in
    /// doubt. `length`: of the way to the other triangle.
    fn may_hold(&self, i: usize, contact: &TriangleContact, length: f64) -> bool {
        let [start, direction] = self.way(i, contact);
        // The point may be at a border of the solid though the triangle is in it.
        let beside = || {
            let [a, b, c] = self.local.corners[1 - i];
            let point = [contact.point2, contact.point1][i];
            self.in_shape(i, point.lerp((a + b + c) / 3.0, WITHIN))
        };
        let may_hold = |point: DVec3| self.shapes[i].may_hold(point.as_vec3());
        may_hold(start + length * direction) || may_hold(beside())
    }

    /// Returns true if both points of a contact are local minima of the distance.
    pub(super) fn is_local_minimum(&self, contact: &TriangleContact) -> bool {
        (0..2).all(|i| self.is_minimum(i, contact))
    }

    /// Returns true if the point on the larger shape, or on one of two equally large ones, is a
    /// local minimum of the distance.
    pub(super) fn is_minimum_of_larger(&self, contact: &TriangleContact) -> bool {
        self.larger().any(|i| self.is_minimum(i, contact))
    }

    /// Returns true if a contact leads into a solid.
    pub(super) fn leads_inside(&self, contact: &TriangleContact) -> bool {
        (0..2).any(|i| self.points_inside(i, contact))
    }

    /// Returns the larger shape, or both if they are equally large.
    fn larger(&self) -> impl Iterator<Item = usize> {
        let smaller = self.smaller();
        (0..2).filter(move |i| Some(*i) != smaller)
    }

    /// Returns the smaller shape.
    pub(super) fn smaller(&self) -> Option<usize> {
        let [size1, size2] = [0, 1].map(|i| self.shapes[i].bounds().half_extents().length());
        (size1 != size2).then_some(usize::from(size2 < size1))
    }

    /// Returns true if a shape is as thin as what a resting body may sink in.
    fn is_thin(&self, i: usize) -> bool {
        let half_thickness = f64::from(self.shapes[i].bounds().half_extents().min_element());
        half_thickness <= THIN * self.shapes.filter_unit()
    }

    /// Returns true if the middle of the other shape is in front of a triangle, or not far behind.
    fn is_in_front(&self, i: usize) -> bool {
        let (normal, height) = self.middle_over(i);
        normal != DVec3::ZERO && height >= -self.shapes.filter_unit()
    }

    /// Returns the normal of a triangle, and the height of the middle of the other shape over it.
    pub(super) fn middle_over(&self, i: usize) -> (DVec3, f64) {
        let corners = &self.local.corners[i];
        let normal = area_vector(corners).normalize_or_zero();
        let middle = self.in_local(1 - i, self.shapes[1 - i].bounds().center());
        (normal, normal.dot(middle - corners[0]))
    }

    /// Returns the crossing of triangles that cross or have passed each other, without a contact.
    fn crossing(&self, contact: &TriangleContact) -> Crossing {
        let is_crossing = contact.features.is_crossing();
        Crossing {
            pair: self.pair,
            is_crossing,
            is_touching: !is_crossing && self.is_touching(contact, SIDE_ROUNDING),
            is_reliable: false,
            normal: DVec3::ZERO,
            depth: 0.0,
            outward: self.outward_signs(),
            sheet: self.sheet_side(self.are_solid()),
            is_rejected: false,
            counts: false,
            island: 0,
        }
    }

    /// Returns the extremal contact of a crossing. Triangles that only touch do not count, nor does
    /// the far side of a thin wall, behind which the sheet is.
    pub(super) fn find_extremal(&self, crossing: &mut Crossing) -> Option<TriangleSurfaceContact> {
        let ends = |i: usize, feature: Feature, axis: DVec3| self.ends(i, feature, axis);
        let good = self.outward_axes(crossing).extremal(ends);
        crossing.is_reliable = good.is_some();
        (crossing.normal, crossing.depth) =
            good.map_or_else(Default::default, |good| (good.normal, -good.distance));
        let is_lost = !crossing.is_crossing
            && (good.is_none() && crossing.is_touching
                || crossing.sheet.is_some_and(|sheet| sheet.is_pushed_through(crossing.normal)));
        crossing.counts = !is_lost;
        let source = ContactSource::OutwardAxis;
        good.filter(|_| !is_lost).map(|contact| TriangleSurfaceContact { contact, source })
    }

    /// Returns the side of a sheet's triangle on which the middle of a solid, or of a smaller
    /// sheet, is. `None` for two solids, and if the solid is larger than the sheet.
    pub(super) fn sheet_side(&self, is_solid: [bool; 2]) -> Option<SheetSide> {
        let smaller = self.smaller();
        let body = match is_solid {
            [true, true] => return None,
            [true, false] => 0,
            [false, true] => 1,
            [false, false] => match smaller {
                Some(smaller) => smaller,
                // The side must not depend on the order of two sheets of one size.
                None => return self.side_between(),
            },
        };
        let sheet = 1 - body;
        if smaller == Some(sheet) {
            return None;
        }
        let (normal, height) = self.height_over(sheet);
        Some(SheetSide { shape: Some(sheet), away: [normal, -normal][sheet], height })
    }

    /// Returns the side of two sheets of one size, by the direction from one middle to the other.
    fn side_between(&self) -> Option<SheetSide> {
        let [middle1, middle2] = [0, 1].map(|i| self.shapes[i].bounds().center());
        let between = self.shapes.pose.placement12.to_frame1(middle2, middle1);
        Some(SheetSide { shape: None, away: between.try_normalize()?, height: between.length() })
    }

    /// Returns the normal of a sheet's triangle, and the height of the other shape's middle over
    /// the front.
    fn height_over(&self, sheet: usize) -> (DVec3, f64) {
        let (normal, height) = self.middle_over(sheet);
        let own = self.in_frame(1 - sheet, normal).as_vec3();
        let along = |over: &OverSheet| over.front.dot(normal);
        let over = self.shapes.over_sheet(sheet).filter(|over| along(over).abs() > SAME_SIDE);
        let over = match over {
            Some(over) => OverSheet { height: along(&over).signum() * over.height, ..over },
            None => {
                let half_height = f64::from(self.shapes[1 - sheet].height(own));
                OverSheet { front: normal, height, half_height }
            }
        };
        (normal, self.shapes.leaning(over, sheet, self.pair[sheet]))
    }

    /// Second pass: returns a contact for an island whose `support` is not enough.
    pub(super) fn supporting_contact(
        &self,
        crossing: &Crossing,
        support: Support,
    ) -> Option<TriangleSurfaceContact> {
        let ends = |i: usize, feature: Feature, axis: DVec3| self.ends(i, feature, axis);
        let agrees = |normal: DVec3| support.agrees(normal);
        let contact = self.outward_axes(crossing).least(ends, agrees)?;
        let is_overlap = crossing.is_crossing || contact.distance <= 0.0;
        let source = ContactSource::OutwardAxis;
        is_overlap.then_some(TriangleSurfaceContact { contact, source })
    }

    /// Returns the axes that lead out of the shapes.
    fn outward_axes(&self, crossing: &Crossing) -> Outward<'_> {
        let cones = [0, 1].map(|i| self.least_square(i));
        Outward::new(self.local.corners.each_ref(), crossing.outward, cones)
    }

    /// Returns the signs with which the normals of the triangles lead out of solids; `None` for
    /// sheets.
    fn outward_signs(&self) -> [Option<f64>; 2] {
        self.surfaces.each_ref().map(|surface| surface.side.outward())
    }

    fn are_solid(&self) -> [bool; 2] {
        self.surfaces.each_ref().map(Around::is_solid)
    }

    /// Returns true if the triangles are within a distance, in their sizes.
    pub(super) fn is_touching(&self, contact: &TriangleContact, distance: f64) -> bool {
        let [t1, t2] = &self.local.corners;
        contact.distance.abs() < distance * (size(t1) + size(t2))
    }

    /// Returns true if edges or vertices are far from each other, and may pass each other.
    fn passes_by(&self, contact: &TriangleContact) -> bool {
        let TriangleContact { normal, distance, features, .. } = *contact;
        distance > DISTANT * self.shapes.filter_unit()
            && ![features.feature1(), features.feature2()].contains(&Feature::Face)
            && self.local.corners.iter().any(|corners| leans(corners, normal))
    }

    /// Returns the normal of the face for a contact at its border. The other shape must be all on
    /// one side of the face.
    fn normal_at_border(&self, i: usize, contact: &TriangleContact) -> Option<DVec3> {
        let feature = feature(contact, i);
        if feature == Feature::Face {
            return None;
        }
        let (up, height) = self.middle_over(i);
        let up = if height < 0.0 { -up } else { up };
        let is_upright = up.dot([contact.normal, -contact.normal][i]) > ALONG_NORMAL;
        let place = self.place(i, contact);
        if up == DVec3::ZERO
            || is_upright
            || !self.surfaces[i].is_border(self.pair[i], feature, place)
        {
            return None;
        }
        let lowest = self.shapes[1 - i].mesh()?.lowest(self.in_frame(1 - i, up).as_vec3());
        let lowest =
            f64::from(lowest) + up.dot(self.in_local(1 - i, Vec3::ZERO) - self.local.corners[i][0]);
        (lowest >= -LIP * self.shapes.filter_unit()).then_some([up, -up][i])
    }

    /// Returns start and direction of the ray between both points of a contact, in the frame of a
    /// shape. The ray begins a little way off the surface.
    fn way(&self, i: usize, contact: &TriangleContact) -> [DVec3; 2] {
        let way = self.direction(i, contact);
        [self.place(i, contact) + WITHIN * contact.distance * way, way]
    }

    /// Returns the direction in which the normal of a contact leads away from its point on a shape,
    /// in the frame of the shape.
    fn direction(&self, i: usize, TriangleContact { normal, .. }: &TriangleContact) -> DVec3 {
        self.in_frame(i, [*normal, -*normal][i])
    }

    /// Returns the point of a contact on a shape, in the frame of the shape.
    fn place(&self, i: usize, contact: &TriangleContact) -> DVec3 {
        self.in_shape(i, [contact.point1, contact.point2][i])
    }

    /// Returns a point relative to the origin of two triangles in the frame of a shape.
    fn in_shape(&self, i: usize, point: DVec3) -> DVec3 {
        match i {
            0 => self.local.origin.as_dvec3() + point,
            _ => self.shapes.pose.placement12.to_frame2(point, self.local.origin),
        }
    }

    /// Returns a point of a shape in frame 1, from the origin of two triangles.
    fn in_local(&self, i: usize, point: Vec3) -> DVec3 {
        self.shapes.pose.in_local(i, point, self.local.origin)
    }

    /// Returns a direction of frame 1 in the frame of a shape.
    pub(super) fn in_frame(&self, i: usize, direction: DVec3) -> DVec3 {
        if i == 0 { direction } else { self.shapes.pose.placement12.inverse * direction }
    }

    /// Returns true if the point of a contact on a shape is a local minimum of the distance.
    #[inline(always)]
    fn is_minimum(&self, i: usize, contact: &TriangleContact) -> bool {
        let direction = self.direction(i, contact);
        let to = Some((self.place(i, contact), feature(contact, 1 - i)));
        self.surfaces[i].is_local_minimum(self.pair[i], feature(contact, i), direction, to)
    }

    /// Returns true if the normal of a contact points into a shape.
    fn points_inside(&self, i: usize, contact: &TriangleContact) -> bool {
        let direction = self.direction(i, contact);
        self.surfaces[i].points_inside(self.pair[i], feature(contact, i), direction)
    }

    /// Returns true if a surface ends at a feature, seen along an axis.
    #[inline(always)]
    fn ends(&self, i: usize, feature: Feature, axis: DVec3) -> bool {
        self.surfaces[i].is_local_minimum(self.pair[i], feature, self.in_frame(i, axis), None)
    }

    /// Returns true if both surfaces end where an overlap along a direction does, at the outermost
    /// corners.
    pub(super) fn ends_along(&self, way: DVec3) -> bool {
        (0..2).all(|i| {
            let axis = [way, -way][i];
            let heights = self.local.corners[i].map(|corner| corner.dot(axis));
            self.surfaces[i].ends_along(self.pair[i], heights, self.in_frame(i, axis))
        })
    }

    /// Returns the square of the least cosine between the normal of a triangle and an axis along
    /// which its surface may end.
    fn least_square(&self, i: usize) -> f64 {
        self.surfaces[i].facets.cones(self.pair[i]).least_square(false)
    }
}

/// Returns the feature of a contact on shape 1 (0) or 2 (1).
fn feature(TriangleContact { features, .. }: &TriangleContact, i: usize) -> Feature {
    [features.feature1(), features.feature2()][i]
}

/// Returns true if a unit direction is far from the normals of a triangle.
pub(super) fn leans(corners: &[DVec3; 3], direction: DVec3) -> bool {
    let normal = area_vector(corners);
    normal.dot(direction).abs() < NEAR_NORMAL * normal.length()
}

/// Returns the longer of two sides.
fn size([a, b, c]: &[DVec3; 3]) -> f64 {
    (*b - *a).length().max((*c - *a).length())
}

#[cfg(test)]
mod tests;
