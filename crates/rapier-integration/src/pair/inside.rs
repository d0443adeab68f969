//! Push-outs and separation directions: how a mesh leaves a solid. Wholly inside, no triangles need
//! be near each other; if it sticks out on both sides, as many contacts push each way.

use glamx::DVec3;
use parry3d::math::{Real, Vector};
use parry3d::query::PointQuery;
use sbbk_core::contact::{Feature, FeaturePair, TriangleContact};
use sbbk_core::traverse::Placement;
use sbbk_core::volumes::Sphere;

use super::mesh_mesh::{MeshPair, Meshes};
use super::pose::PairPose;
use super::triangles::{ContactSource, TriangleHit, TriangleShapes, TriangleSurfaceContact};
use crate::mesh::{BEHIND, is_covered, nearest};

/// Share of an f32 distance that is a lower bound of the exact one.
const SURE: f64 = 0.99;

/// Last result of the test whether the smaller mesh is inside the larger one.
#[derive(Clone, Debug, Default)]
pub(crate) enum InsideTest {
    #[default]
    Unknown,
    /// The larger mesh is no solid.
    NoSolid,
    /// A vertex was at least this far outside at this placement of the smaller mesh.
    Outside(Placement, f64),
}

impl InsideTest {
    /// Returns true if a mesh with points in `ball` cannot have come inside.
    fn is_outside(&self, ball: Sphere, placement: &Placement) -> bool {
        match self {
            Self::Unknown => false,
            Self::NoSolid => true,
            Self::Outside(before, distance) => {
                placement.motion_bound(before, ball.centre, ball.radius) < *distance
            }
        }
    }
}

/// Part of a body that may stick out of a room that holds it, in half heights of the body. Higher:
/// bodies deep in a solid stay there. Lower: fast bodies fall through the floors of rooms.
const STICKS_OUT: Real = 0.5;

impl MeshPair<'_> {
    /// Returns true if the larger mesh is a room for the smaller one: the smaller one is in it, or
    /// hardly sticks out.
    pub(super) fn is_room(&self, test: &mut InsideTest) -> bool {
        let outer = self.larger();
        let [held, holder] = [1 - outer, outer].map(|i| &self.meshes[i]);
        if !held.sorted_extents().cmplt(holder.sorted_extents()).all() {
            return false;
        }
        let middle = to_other(self.pose, 1 - outer, held.ball().centre);
        let Some(exit) = self.exit(middle, test) else { return false };
        let depth = exit.distance(middle);
        let way = to_other(self.pose, outer, exit) - held.ball().centre;
        let height = held.height(way.normalize_or_zero(), depth / (1.0 - STICKS_OUT));
        depth >= (1.0 - STICKS_OUT) * height
    }

    /// Returns the nearest point of the larger mesh, if a point of the smaller one is inside. `point` is
    /// in the frame of the larger mesh.
    fn exit(&self, point: Vector, test: &mut InsideTest) -> Option<Vector> {
        let outer = self.larger();
        let [held, holder] = [1 - outer, outer].map(|i| &self.meshes[i]);
        let PairPose { placement12, placement21, .. } = self.pose;
        let placement = [placement12, placement21][outer];
        if test.is_outside(held.ball(), placement) {
            return None;
        }
        let outside = |distance: f32| InsideTest::Outside(*placement, SURE * f64::from(distance));
        let from_box = holder.root().distance_to_local_point(point, true);
        if from_box > 0.0 {
            *test = outside(from_box);
            return None;
        }
        let is_covered = is_covered(holder.mesh, point);
        let (_, near, behind) = nearest(holder.mesh, point)?;
        if !is_covered || behind < -BEHIND {
            *test = outside(near.point.distance(point));
        }
        (is_covered && behind >= BEHIND).then_some(near.point)
    }
}

impl Meshes<'_> {
    /// Returns the contact that moves the smaller mesh out of the larger one, by the shortest way
    /// from its middle, and its triangles. Call this if no other contact was found.
    ///
    /// Tests one vertex unless the mesh is known to be deep: a mesh that pierces the surface has
    /// contacts.
    pub(super) fn find_push_out(
        &self,
        is_deep: bool,
        test: &mut InsideTest,
    ) -> Option<TriangleHit> {
        let outer = self.pair.larger();
        let [held, holder] = [1 - outer, outer].map(|i| &self.pair.meshes[i]);
        let vertex = to_other(self.pair.pose, 1 - outer, held.corners(0)[0]);
        if !is_deep {
            if self.surfaces[outer].is_none() || self.room.is_some() {
                return None;
            }
            self.pair.exit(vertex, test)?;
            if !self.is_solid(outer) {
                *test = InsideTest::NoSolid;
                return None;
            }
        }
        let middle = to_other(self.pair.pose, 1 - outer, held.ball().centre);
        let (triangle, exit, from) = [middle, vertex].into_iter().find_map(|from| {
            let (triangle, exit, behind) = nearest(holder.mesh, from)?;
            (behind >= BEHIND).then_some((triangle, exit.point, from))
        })?;
        let mut subshapes = [0; 2];
        subshapes[outer] = triangle;
        let origin = self.pair.meshes[0].corners(subshapes[0])[0];
        let mut points = [exit, from].map(|point| match outer {
            0 => point.as_dvec3() - origin.as_dvec3(),
            _ => self.pair.pose.placement12.to_frame1(point, origin),
        });
        if outer == 1 {
            points.reverse();
        }
        let [point1, point2] = points;
        let normal = (point1 - point2).try_normalize()?;
        let distance = (point2 - point1).dot(normal);
        let features = FeaturePair::new(Feature::Face, Feature::Face);
        let contact = TriangleContact { normal, distance, point1, point2, features };
        Some((subshapes, TriangleSurfaceContact { contact, source: ContactSource::PushOut }))
    }

    /// Returns the direction in which mesh 2 separates from mesh 1 by the shortest way from the
    /// middle of the smaller mesh, if the middle is in both. Two equal meshes are both tried.
    pub(super) fn separation_of_smaller(&self) -> Option<DVec3> {
        let [one, two] = &self.pair.meshes;
        let [size1, size2] = [one, two].map(|mesh| mesh.size_squared());
        let inner = [(0, one, size1 <= size2), (1, two, size2 <= size1)];
        let ways = inner.into_iter().filter(|(.., is_inner)| *is_inner);
        let ways =
            ways.filter_map(|(i, mesh, _)| way_out(self, self.pair.pose, i, mesh.ball().centre));
        ways.min_by(|a, b| a.length().total_cmp(&b.length()))?.try_normalize()
    }
}

/// Returns the translation that separates shape 2 from shape 1 by the shortest way from a point.
/// `middle` is in the frame of shape `inner` and must be in both shapes; both must be solids.
pub(super) fn way_out(
    shapes: &impl TriangleShapes,
    pose: &PairPose,
    inner: usize,
    middle: Vector,
) -> Option<DVec3> {
    if !(0..2).all(|i| shapes.is_solid(i)) {
        return None;
    }
    let placed = to_other(pose, inner, middle);
    let exit = |i: usize, point: Vector| {
        let (exit, behind) = shapes.is_covered(i, point).then(|| shapes.nearest(i, point))??;
        (behind >= BEHIND).then_some(exit)
    };
    let out = exit(1 - inner, placed)? - placed;
    exit(inner, middle)?;
    let out = if inner == 0 { -(pose.pos12.rotation * out) } else { out };
    Some(out.as_dvec3())
}

/// Returns a point of one shape in the frame of the other.
fn to_other(
    PairPose { placement12, placement21, .. }: &PairPose,
    i: usize,
    point: Vector,
) -> Vector {
    [placement21, placement12][i].to_frame1(point, Vector::ZERO).as_vec3()
}
