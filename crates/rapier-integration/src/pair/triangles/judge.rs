//! Which contacts of triangles are contacts of the surfaces.
//!
//! Two triangles know nothing of the meshes that they are of. A contact of theirs belongs to the set
//! if
//!
//! * apart, nothing around its points is nearer: a local minimum of the distance, which leads out
//!   of solids. Others are of internal edges, or of walls that pass by. Of sharp edges and corners
//!   only those that are about to touch: what is farther may pass by;
//! * crossing, it leads out of solids, and the surfaces end where the overlap does, a local minimum
//!   of the overlap. So do triangles of solids that have passed each other.
//!
//! Crossing surfaces never stay without a contact: where a whole region of pairs that cross has none
//! of these ([`Regions`]), it gets the best that there is.

use glamx::DVec3;
use parry3d::bounding_volume::Aabb;
use parry3d::math::{Real, Vector};
use sbbk_core::contact::{Feature, ManifoldPoints, TriangleContact, penetration_out_of_solid};
use sbbk_core::leaf::LateralCulling;
use sbbk_core::query::TrianglePair;
use sbbk_core::surface::{Facets, OneRing};

use super::regions::{Regions, Sheet};
use crate::mesh::BEHIND;
use crate::pair::pose::PairPose;

/// What is known of the surfaces of two shapes.
pub(crate) trait Surfaces {
    /// The triangles of either shape.
    type Facets<'f>: Facets
    where
        Self: 'f;

    /// The surface of shape 1 (0) or 2 (1), if it is known.
    fn around(&self, i: usize) -> Option<OneRing<Self::Facets<'_>>>;

    /// The distance up to which contacts must be local minima; infinite without surfaces. Farther ones,
    /// which only soft CCD asks for, are all kept, as bodies may turn before they meet. Depths are cut at
    /// this, or at four prediction distances if that is more.
    fn near(&self) -> f64;

    /// Whether contacts are those of surfaces.
    fn has_surface(&self) -> bool {
        self.near() < f64::INFINITY
    }

    /// The box around a shape, in its frame.
    fn bounds(&self, i: usize) -> Aabb;

    /// Whether a point, in the frame of the shape, may be inside of it.
    fn is_covered(&self, i: usize, point: Vector) -> bool;

    /// The point of a surface that is nearest to another, in its frame, and how far that is seen from
    /// behind: the cosine of the angle to the back of the surface.
    fn nearest(&self, i: usize, point: Vector) -> Option<(Vector, Real)>;
}

/// [`Surfaces::near`] as a share of the radius of the smaller shape. Higher: plates that soft CCD
/// sees turn through what they meet; less: small bodies in a large prediction distance have contacts
/// that are no local minima.
const NEAR: f64 = 0.1;

/// [`Surfaces::near`] of shapes of which the smaller one has this radius.
pub(super) fn near(has_surface: bool, radius: Real) -> f64 {
    if has_surface { NEAR * f64::from(radius) } else { f64::INFINITY }
}

/// How much deeper than the least translation, or than the prediction distance if that is more, a
/// contact may be that is taken without a second look. Parry's number for constrained normals. (Of a
/// prediction distance not more than [`Surfaces::near`] counts: small bodies would be pushed out of each
/// other on their far sides, and gain four times the energy on a tray.)
const SHALLOW: f64 = 5.0;

/// How far behind a sheet the middle of a thin solid may be, as a share of half its height over the sheet,
/// that is still pushed to the front: most sheets are grounds. Of 1000 slabs of 3 cm that fall 1.75 units
/// on triangles of 0.5, 12 pass from the front and 335 from the back. Higher: what comes from behind is
/// pulled through. Lower: what one step has brought to the midst of a ground falls out below (with 0.15,
/// 36 and 173; with 0, as many from the front as from the back).
const LEAN: f64 = 0.33;

/// A contact of edges or corners that are farther from each other than this share of the prediction
/// distance is one only if its normal is near those of both triangles. Rapier's solver lets bodies come no
/// nearer along it in a step than they are, and sharp edges pass each other. Higher: of two gears at 5 rad/s
/// the driver is braked to 0.991 of its speed and the other runs ahead by 0.032 rad (with 1; with 0.25 0.997
/// and 0.015). Lower: gears run no better, and edges meet with less warning.
const DISTANT: f64 = 0.25;

/// The cosine of the greatest such angle. Higher: smooth bodies lose contacts, too; with 1 a chain under 50
/// times its weight gains 0.062 of its energy in place of 0.009. Lower: gears are braked.
const NEAR_NORMAL: f64 = 0.87;

/// Distances below this share of their sizes do not tell on which side of each other triangles are.
const TOUCHING: f64 = 1.0e-9;

/// Two triangles of two surfaces.
pub(super) struct Judge<'a, S> {
    pub(super) shapes: &'a S,
    pub(super) pose: &'a PairPose,
    pub(super) pair: [u32; 2],
}

impl<S: Surfaces> Judge<'_, S> {
    /// Which pairs of triangles, of those that a descent within `margin` finds, only
    /// [pass by](Self::passes_by) while it serves.
    pub(super) fn beside(shapes: &S, prediction: Real, margin: Real) -> Option<LateralCulling> {
        // Not by the surfaces themselves: they are looked for where triangles touch.
        let is_near = f64::from(prediction) <= shapes.near();
        (shapes.has_surface() && is_near).then(|| {
            let travel = margin - prediction;
            LateralCulling::new(
                DISTANT as Real * prediction,
                NEAR_NORMAL as Real,
                prediction,
                travel,
            )
        })
    }

    /// The contact of the surfaces that the contact of their triangles stands for, if there is one:
    /// perhaps only in a second round. `points` stays empty if it is the same. Else it can be deeper
    /// than its points, as a flat side goes on beyond a triangle.
    #[inline(always)]
    pub(super) fn verdict(
        &self,
        local: &TrianglePair,
        contact: TriangleContact,
        regions: &mut Regions,
        points: &mut ManifoldPoints,
    ) -> Option<TriangleContact> {
        points.clear();
        match [self.shapes.around(0), self.shapes.around(1)] {
            [None, None] => Some(contact),
            around => self.by_surfaces(around, local, contact, regions, points),
        }
    }

    /// Whether edges or corners are far from each other, and may pass each other.
    fn passes_by(&self, local: &TrianglePair, contact: &TriangleContact) -> bool {
        let TriangleContact { normal, distance, features, .. } = *contact;
        distance > DISTANT * f64::from(self.pose.prediction)
            && ![features.feature1(), features.feature2()].contains(&Feature::Face)
            && local.corners.iter().any(|corners| leans(corners, normal))
    }

    fn by_surfaces(
        &self,
        around: [Option<OneRing<S::Facets<'_>>>; 2],
        local: &TrianglePair,
        contact: TriangleContact,
        regions: &mut Regions,
        points: &mut ManifoldPoints,
    ) -> Option<TriangleContact> {
        let inverse = self.pose.placement12.inverse;
        let own = |i: usize, direction: DVec3| if i == 0 { direction } else { inverse * direction };
        let is_front = |i: usize, feature: Feature, direction: DVec3, to: Option<Feature>| {
            let is_front = |around: &OneRing<_>| {
                around.is_local_minimum(self.pair[i], feature, own(i, direction), to)
            };
            around[i].as_ref().is_none_or(is_front)
        };
        let is_solid =
            around.each_ref().map(|around| around.as_ref().is_some_and(|around| around.is_solid));
        let has_solid = is_solid[0] || is_solid[1];
        let TriangleContact { normal, distance, features, .. } = contact;
        let is_crossing = features.is_crossing();
        if is_crossing && !has_solid {
            return Some(contact);
        }
        if !is_crossing {
            if distance > self.shapes.near() {
                return Some(contact);
            }
            if self.passes_by(local, &contact) {
                return None;
            }
            let features = [features.feature1(), features.feature2()];
            let directions = [normal, -normal];
            let is_in_front =
                |i: usize| is_front(i, features[i], directions[i], Some(features[1 - i]));
            let is_behind = |i: usize| {
                around[i].as_ref().is_some_and(|around| {
                    around.points_inside(self.pair[i], features[i], own(i, directions[i]))
                })
            };
            let is_first_in_front = is_in_front(0);
            if is_first_in_front && is_in_front(1) {
                return Some(contact);
            }
            // What is in front is not behind: this spares a look.
            let may_have_passed = has_solid && !(is_solid[0] && is_first_in_front);
            let have_passed = may_have_passed && (0..2).all(|i| !is_solid[i] || is_behind(i));
            if !have_passed {
                return None;
            }
        }
        let is_end = |i: usize, feature: Feature, axis: DVec3| is_front(i, feature, axis, None);
        let [t1, t2] = &local.corners;
        let shallow = f64::from(self.pose.prediction).min(self.shapes.near());
        let greatest = SHALLOW * distance.abs().max(shallow);
        if regions.is_first_round() {
            let contact =
                penetration_out_of_solid(t1, t2, is_solid, is_end, Some(greatest), points);
            if contact.is_none()
                && !is_crossing
                && distance.abs() < TOUCHING * (size(t1) + size(t2))
            {
                return None;
            }
            regions.add(self.pair, contact.as_ref(), self.sheet(is_solid, local));
            return contact;
        }
        if !regions.is_lost(self.pair) {
            return None;
        }
        let contact = penetration_out_of_solid(t1, t2, is_solid, is_end, None, points)?;
        let is_overlap = is_crossing || contact.distance <= 0.0;
        let is_shallow = contact.distance >= -greatest;
        let is_meant = is_overlap
            && regions.agrees(self.pair, contact.normal)
            && (is_shallow || self.is_deep(local, &contact));
        if !is_meant {
            return None;
        }
        // Between two rows of triangles of a flat side there is no overlap with either: a box that sank
        // into a slab along its sides would rest there.
        let most = (contact.distance + greatest).max(0.0);
        let side_beyond = |i: usize, direction: DVec3| {
            around[i]
                .as_ref()
                .map_or(0.0, |around| around.side_beyond(self.pair[i], own(i, direction), most))
        };
        let beyond = if regions.is_unheld(self.pair) {
            side_beyond(0, contact.normal) + side_beyond(1, -contact.normal)
        } else {
            0.0
        };
        Some(TriangleContact { distance: contact.distance - beyond.min(most), ..contact })
    }

    /// How the middle of a solid lies to the triangle of a sheet. The middle of a larger one tells nothing: of
    /// 100 half balls in a bowl with a wall of 3 cm, 54 would fall out.
    fn sheet(&self, is_solid: [bool; 2], local: &TrianglePair) -> Option<Sheet> {
        let solid = match is_solid {
            [true, false] => 0,
            [false, true] => 1,
            _ => return None,
        };
        let [bounds, others] = [solid, 1 - solid].map(|i| self.shapes.bounds(i));
        if bounds.half_extents().length() > others.half_extents().length() {
            return None;
        }
        let middle = match solid {
            0 => bounds.center().as_dvec3() - local.origin.as_dvec3(),
            _ => self.pose.placement12.to_frame1(bounds.center(), local.origin),
        };
        let [a, b, c] = local.corners[1 - solid];
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let (away, own) = match solid {
            0 => (-normal, normal),
            _ => (normal, self.pose.placement12.inverse * normal),
        };
        let half_height = own.abs().dot(bounds.half_extents().as_dvec3());
        Some(Sheet { away, height: normal.dot(middle - a) + LEAN * half_height })
    }

    /// Whether a contact is deep because the surface of a body is far, not because this triangle is
    /// on its far side.
    fn is_deep(&self, local: &TrianglePair, contact: &TriangleContact) -> bool {
        let within = (-contact.distance / SHALLOW) as Real;
        let point1 = (local.origin.as_dvec3() + contact.point2).as_vec3();
        let point2 = self.pose.placement12.to_frame2(contact.point1, local.origin).as_vec3();
        (0..2).zip([point1, point2]).any(|(i, point)| {
            self.shapes.nearest(i, point).is_some_and(|(nearest, behind)| {
                behind >= BEHIND && nearest.distance(point) > within
            })
        })
    }
}

/// Whether a unit direction is far from the normals of a triangle.
fn leans([a, b, c]: &[DVec3; 3], direction: DVec3) -> bool {
    let normal = (*b - *a).cross(*c - *a);
    normal.dot(direction).abs() < NEAR_NORMAL * normal.length()
}

/// The longer of two sides.
fn size([a, b, c]: &[DVec3; 3]) -> f64 {
    (*b - *a).length().max((*c - *a).length())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use parry3d::math::Pose;
    use parry3d::shape::{Ball, SharedShape, TriMesh};
    use sbbk_core::contact::contact;
    use sbbk_core::tree::BuildOptions;

    use super::*;
    use crate::mesh::TreeCache;
    use crate::pair::driver::{Pair, Scratch};
    use crate::pair::triangles::MeshPair;
    use crate::pair::triangles::exact::local_pair;
    use crate::pair::triangles::query::TriangleShapes;

    /// Rough balls of triangles about as large as the prediction distance, with trees and without,
    /// apart and crossing. Would catch contacts lost among what [`Judge::beside`] leaves out.
    #[test]
    fn triangles_beside_each_other_pass_by() {
        let cache = Arc::new(TreeCache::new(BuildOptions::default(), 1 << 30));
        let shapes = [20, 30].map(|rows| {
            let (mut vertices, triangles) = Ball::new(1.0).to_trimesh(2 * rows, rows);
            for (i, vertex) in (0_u32..).zip(&mut vertices) {
                *vertex *= 1.0 + 0.002 * (i * i % 31) as Real;
            }
            SharedShape::new(TriMesh::new(vertices, triangles).unwrap())
        });
        let meshes = shapes.each_ref().map(|shape| shape.as_trimesh().unwrap());
        let seen = meshes.map(|mesh| cache.view(mesh).unwrap());
        let mut counts = [0; 2];
        for (i, gap) in [(1, 0.03), (2, 0.0), (3, -0.03), (4, -0.06)] {
            let turn = Vector::new(0.3, 0.1 * i as Real, 0.7);
            let place = turn.normalize() * (2.06 + gap);
            let pose = PairPose::new(&Pose::new(place, turn), 0.08);
            let mesh_pair =
                MeshPair { pose: &pose, meshes: seen, has_surfaces: true, has_patches: false };
            for has_trees in [false, true] {
                let registered = has_trees
                    .then(|| [0, 1].map(|i| cache.register(&shapes[i], meshes[i]).unwrap()));
                let mut known = Default::default();
                let shapes = mesh_pair.open(&cache, &mut known).1.shapes;
                let mut found = Vec::new();
                let scratch = &mut Scratch::default();
                shapes.descend(pose.prediction, &mut (), scratch, |pair| found.push(pair));
                found.sort_unstable();
                let count = meshes.map(|mesh| mesh.indices().len() as u32);
                for pair in (0..count[0]).flat_map(|i| (0..count[1]).map(move |j| [i, j])) {
                    let local = local_pair(&pose.placement12, &shapes.triangles(pair).unwrap());
                    let [t1, t2] = &local.corners;
                    if t1[0].distance(t2[0]) > 1.0 {
                        continue;
                    }
                    let contact = contact(t1, t2, f64::from(pose.prediction));
                    let Some(contact) = contact else { continue };
                    let judge = Judge { shapes: &shapes, pose: &pose, pair };
                    let passes_by = judge.passes_by(&local, &contact);
                    let is_found = found.binary_search(&pair).is_ok();
                    assert!(is_found || passes_by, "{pair:?}, {contact:?}");
                    counts[usize::from(is_found)] += 1;
                }
                drop(registered);
            }
        }
        assert!(counts.into_iter().all(|count| count > 500), "{counts:?}");
    }
}
