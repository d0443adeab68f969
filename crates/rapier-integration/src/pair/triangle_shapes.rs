//! Two shapes made of triangles, as the contact query sees them.

use std::ops::Index;
use std::sync::OnceLock;

use glamx::DVec3;
use parry3d::math::{Pose, Real};
use parry3d::partitioning::BvhNode;
use parry3d::query::details::NormalConstraints;
use parry3d::shape::TrianglePseudoNormals;
use sbbk_core::contact::{Feature, FeaturePair, TriangleContact};
use sbbk_core::leaf::LateralCulling;
use sbbk_core::query::TrianglePair;
use sbbk_core::surface::Facets;
use sbbk_core::tree::Tree;
use sbbk_core::volumes::Sphere;
use sbbk_core::volumes::rounding::gamma;

use super::pose::{Moving, PairPose};
use super::reduce::FILTERED;
use super::triangle_shape::{FieldShape, MeshShape, TriangleShape};
use crate::mesh::MeshView;

/// Greatest [reach](TriangleShapes::reach) of fine meshes in filter distances: 0.04 radii. A body of one length unit has a
/// radius of half a unit, and Rapier predicts 0.02 units by default. Higher: fine meshes cost more;
/// lower: bodies come deeper into others before they meet.
const REACH: f64 = 0.4;

/// Least reach of fine meshes in filter distances: 0.01 radii. Higher: fine meshes cost more; lower: bodies turn and sink where
/// they are pressed together.
const LEAST_REACH: f64 = 0.1;

/// Reach of fine meshes in sizes of their triangles. Higher: each triangle is near more others. Lower: meshes of a few thousand triangles
/// have contacts late.
const REACH_PER_TRIANGLE: f64 = 0.25;

/// Share of the reach above which triangles do not reduce it. Higher: far contacts take more time than the smaller reach saves.
/// Lower: fine meshes cost more.
const MUCH_LESS: f64 = 0.75;

/// Greatest product of the numbers of triangles near the other shape with which all pairs are candidates.
/// Higher: small bodies cost more time and memory. Lower: thin plates with soft CCD turn through sheets.
const MOST_PAIRS: usize = 1 << 14;

/// Distance in prediction distances beyond which a contact of edges or vertices needs a normal near
/// both triangle normals. Higher: gears are braked by edges that pass each other; lower: edges meet
/// with less warning.
pub(super) const DISTANT: f64 = 0.25;

/// Least cosine between the normal of a [`DISTANT`] contact and both triangle normals. Higher:
/// smooth bodies lose contacts; lower: gears are braked.
pub(super) const NEAR_NORMAL: f64 = 0.87;

/// Returns the distance up to which contacts must be local minima, from the radius of the smaller shape.
pub(super) fn filter_distance(has_surface: bool, radius: Real) -> f64 {
    if has_surface { f64::from(FILTERED * radius) } else { f64::INFINITY }
}

/// Returns the unit of the filter: the prediction distance, or less for small shapes.
pub(super) fn filter_unit(pose: &PairPose, filter_distance: f64) -> f64 {
    f64::from(pose.prediction).min(filter_distance)
}

/// Normal cones of both triangles.
pub(super) type Cones<'a> = [Option<&'a dyn NormalConstraints>; 2];

/// Features that were closest at the last query, to be tried first.
pub(super) type Hint = Option<FeaturePair>;

/// Two shapes made of triangles at a pose. One of them is a mesh.
pub(crate) struct TriangleShapes<'q> {
    pub(super) pose: &'q PairPose,
    pub(super) shapes: [TriangleShape<'q>; 2],
    /// Trees of two meshes, if both have one.
    pub(super) trees: Option<[&'q Tree; 2]>,
    /// 0 if shape 1 is the larger one or a height field, else 1.
    pub(super) larger: usize,
    /// Distance up to which contacts must be local minima; infinite for contacts of each two triangles. Farther contacts,
    /// of soft CCD, are all kept: bodies may turn before they meet.
    pub(super) filter_distance: f64,
    /// See [`reach`](Self::reach).
    pub(super) reach: OnceLock<Real>,
    /// Position of the other shape over each shape that is a [sheet](super::sheets).
    pub(super) over_sheets: [OnceLock<Option<OverSheet>>; 2],
}

/// Position of the middle of a shape over the nearest point of a sheet.
#[derive(Copy, Clone)]
pub(super) struct OverSheet {
    /// Direction from the back of the sheet to the front, in frame 1.
    pub(super) front: DVec3,
    /// Height over the front.
    pub(super) height: f64,
    /// Height of the shape over its middle.
    pub(super) half_height: f64,
}

impl<'q> Index<usize> for TriangleShapes<'q> {
    type Output = TriangleShape<'q>;

    /// Returns shape 1 (0) or 2 (1).
    #[inline(always)]
    fn index(&self, i: usize) -> &TriangleShape<'q> {
        &self.shapes[i]
    }
}

impl TriangleShapes<'_> {
    /// Returns two triangles in frame 1, relative to a corner: with all digits. `None` if one does not exist.
    #[inline(always)]
    pub(super) fn local(&self, [triangle1, triangle2]: [u32; 2]) -> Option<TrianglePair> {
        let corners1 = self[0].corners(triangle1)?;
        Some(TrianglePair::new(&self.pose.placement12, corners1, self[1].corners(triangle2)?))
    }

    /// Returns true for contacts of surfaces.
    pub(super) fn has_surface(&self) -> bool {
        self.filter_distance < f64::INFINITY
    }

    /// Returns the normal cones that contacts of two triangles obey: none for contacts of surfaces.
    #[inline(always)]
    pub(super) fn cones(&mut self, triangles: [u32; 2]) -> [Option<TrianglePseudoNormals>; 2] {
        if self.has_surface() {
            return [None, None];
        }
        let [shape1, shape2] = &mut self.shapes;
        [shape1.cone(triangles[0]), shape2.cone(triangles[1])]
    }

    /// Returns the body whose motion limits how long candidates serve: the smaller one.
    pub(super) fn moving(&self) -> Moving {
        let smaller = 1 - self.larger;
        Moving { ball: self[smaller].ball(), is_second: smaller == 1 }
    }

    /// Returns a lower bound of the distance between two meshes, from the ball around the smaller one, if that is more than
    /// `margin`.
    pub(super) fn clearance(&self, margin: Real) -> Option<Real> {
        let (TriangleShape::Mesh(larger), TriangleShape::Mesh(_)) =
            (&self[self.larger], &self[1 - self.larger])
        else {
            return None;
        };
        let Sphere { centre, radius } = self.moving().ball;
        let placed = self.pose.in_other(1 - self.larger, centre);
        let offset = self.pose.pos12.translation.abs().max_element();
        let size = larger.view.magnitude() + centre.abs().max_element() + radius + offset;
        let reach = radius + gamma(64) * size;
        let clearance = larger.view.distance_beyond(placed, reach + margin)? - reach;
        (clearance > margin && clearance.is_finite()).then_some(clearance)
    }

    /// Returns the unit of the filter: the prediction distance, or less for small shapes.
    pub(super) fn filter_unit(&self) -> f64 {
        filter_unit(self.pose, self.filter_distance)
    }

    /// Returns the distance up to which all pairs of triangles are candidates. Farther contacts are
    /// [far](super::far).
    pub(super) fn reach(&self) -> Real {
        *self.reach.get_or_init(|| {
            let most = self.reach_of_fine() as Real;
            // A prediction distance that is NaN finds nothing.
            let is_less = most < self.pose.prediction && !self.are_few();
            if is_less { most } else { self.pose.prediction }
        })
    }

    /// Returns the greatest reach of fine meshes.
    fn reach_of_fine(&self) -> f64 {
        let [least, most] = [LEAST_REACH, REACH].map(|share| share * self.filter_distance);
        let [size1, size2] = self.shapes.each_ref().map(TriangleShape::triangle_size);
        let of_triangles = (REACH_PER_TRIANGLE * f64::from(size1.max(size2))).max(least);
        let otherwise = most.min(f64::from(self.pose.prediction));
        if of_triangles <= MUCH_LESS * otherwise { of_triangles } else { most }
    }

    /// Returns true if few pairs of triangles may be within the prediction distance.
    fn are_few(&self) -> bool {
        let PairPose { pos12, prediction, .. } = *self.pose;
        let poses = [pos12, pos12.inverse()];
        let are_few_of_field = |field: &FieldShape<'_>, mesh: &MeshShape<'_>, pose: &Pose| {
            let under = field.field.count_under(&mesh.view.placed_root(pose, prediction));
            mesh.view.mesh.indices().len() as f64 * under <= MOST_PAIRS as f64
        };
        match &self.shapes {
            [TriangleShape::Mesh(one), TriangleShape::Mesh(two)] => {
                are_few_of_meshes([one.view, two.view], poses, prediction)
            }
            [TriangleShape::Field(field), TriangleShape::Mesh(mesh)] => {
                are_few_of_field(field, mesh, &poses[0])
            }
            [TriangleShape::Mesh(mesh), TriangleShape::Field(field)] => {
                are_few_of_field(field, mesh, &poses[1])
            }
            [TriangleShape::Field(_), TriangleShape::Field(_)] => true,
        }
    }

    /// Returns a test for triangles beside each other. Their contacts are no local minima while candidates within `margin`
    /// serve, where the surface [bends little](Self::bends_little).
    pub(super) fn lateral_culling(&self, margin: Real) -> Option<LateralCulling> {
        let reach = self.reach();
        let is_filtered = f64::from(reach) <= self.filter_distance;
        (self.has_surface() && is_filtered).then(|| {
            let (distance, travel) = ((DISTANT * self.filter_unit()) as Real, margin - reach);
            LateralCulling::new(distance, NEAR_NORMAL as Real, reach, travel)
        })
    }

    /// Returns true if contacts beside a triangle of shape `i`, by [lateral culling](Self::lateral_culling), are no local
    /// minima. False for height fields.
    pub(super) fn bends_little(&self, i: usize, triangle: u32) -> bool {
        let TriangleShape::Mesh(MeshShape { surface: Some(surface), .. }) = &self[i] else {
            return false;
        };
        surface.facets().cones(triangle).least_square(false) >= NEAR_NORMAL * NEAR_NORMAL
    }

    /// Returns the direction in which shape 2 separates from shape 1, if one is deep in the other. The way starts at the
    /// middle of the smaller one, which must be in both. Two equal meshes are both tried.
    pub(super) fn separation(&self) -> Option<DVec3> {
        if !(0..2).all(|i| self[i].is_solid()) {
            return None;
        }
        let sizes = self.shapes.each_ref().map(TriangleShape::size_squared);
        let is_inner = |i: &usize| sizes[*i] <= sizes[1 - i];
        let ways = (0..2).filter(is_inner).filter_map(|i| self.way_out(i));
        ways.min_by(|a, b| a.length().total_cmp(&b.length()))?.try_normalize()
    }

    /// Returns the translation that separates shape 2 from shape 1 by the shortest way from the middle of shape
    /// `inner`. The middle must be in both shapes, and both must be solids.
    fn way_out(&self, inner: usize) -> Option<DVec3> {
        let middle = self[inner].bounds().center();
        let placed = self.pose.in_other(inner, middle);
        let out = self[1 - inner].nearest_exit(placed)? - placed;
        self[inner].nearest_exit(middle)?;
        let out = if inner == 0 { -(self.pose.pos12.rotation * out) } else { out };
        Some(out.as_dvec3())
    }
}

/// Returns true if few pairs of triangles of two meshes may be within the prediction distance. `poses` has each mesh's partner
/// in the frame of the mesh.
fn are_few_of_meshes(meshes: [&MeshView<'_>; 2], poses: [Pose; 2], prediction: Real) -> bool {
    let count = |i: usize, most: usize| {
        let around = BvhNode::leaf(meshes[1 - i].placed_root(&poses[i], prediction), 0);
        meshes[i].mesh.bvh().leaves(|node| node.intersects(&around)).take(most + 1).count()
    };
    let least = MOST_PAIRS.isqrt();
    match [0, 1].map(|i| count(i, least)) {
        [one, _] if one <= least => one * count(1, MOST_PAIRS / one.max(1)) <= MOST_PAIRS,
        [_, two] if two <= least => two * count(0, MOST_PAIRS / two.max(1)) <= MOST_PAIRS,
        _ => false,
    }
}

/// A contact and its subshapes.
pub(super) type TriangleHit = ([u32; 2], TriangleSurfaceContact);

/// A contact of two triangles, or of the surfaces around them.
#[derive(Copy, Clone)]
pub(crate) struct TriangleSurfaceContact {
    pub(super) contact: TriangleContact,
    pub(super) source: ContactSource,
}

impl TriangleSurfaceContact {
    /// A contact of two triangles.
    pub(super) fn of_triangles(contact: TriangleContact) -> Self {
        Self { contact, source: ContactSource::Triangles }
    }

    /// Returns a contact that pushes shapes apart along a normal, at points that belong to no feature.
    pub(super) fn push_out(normal: DVec3, distance: f64, [point1, point2]: [DVec3; 2]) -> Self {
        let features = FeaturePair::new(Feature::Face, Feature::Face);
        let contact = TriangleContact { normal, distance, point1, point2, features };
        Self { contact, source: ContactSource::PushOut }
    }
}

/// Origin of a contact.
#[derive(Copy, Clone, PartialEq)]
pub(super) enum ContactSource {
    /// Two triangles; their closest points are points of the contact.
    Triangles,
    /// Two crossing triangles, along an axis that leads out of solids.
    OutwardAxis,
    /// Two shapes, one inside the other, or deep in each other.
    PushOut,
}

impl ContactSource {
    /// Returns the normal cones of both triangles that a contact obeys.
    pub(super) fn cones(self, of_triangles: &[Option<TrianglePseudoNormals>; 2]) -> Cones<'_> {
        of_triangles.each_ref().map(|cone| {
            let cone = cone.as_ref().filter(|_| self != Self::PushOut)?;
            Some(cone as &dyn NormalConstraints)
        })
    }
}
