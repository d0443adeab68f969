//! Which way a mesh leaves a solid that it is deep in, where triangles do not tell: wholly inside, none
//! need be near each other; on both sides of it, as many push each way.

use glamx::DVec3;
use parry3d::math::Vector;
use parry3d::query::PointQuery;
use sbbk_core::contact::{Feature, FeaturePair, TriangleContact};

use super::judge::Surfaces;
use super::meshes::Meshes;
use crate::mesh::{BEHIND, is_covered, nearest};
use crate::pair::pose::PairPose;

/// Of a distance in f32, what surely is left of it.
const SURE: f64 = 0.99;

impl Meshes<'_> {
    /// If no contact was found: the one that takes the smaller mesh out of the larger one by the way
    /// that is shortest from its middle, and the triangles that it is written to.
    ///
    /// If it is not known to be deep in it, one vertex is asked for, as what pierces a surface has other
    /// contacts. `outside` is how far the vertex surely was from the solid when it was last looked at,
    /// plus the travel of the pair then.
    pub(super) fn inside(
        &self,
        is_deep: bool,
        outside: &mut f64,
        travel: f64,
    ) -> Option<([u32; 2], TriangleContact)> {
        let outer = self.pair.larger();
        let [held, holder] = [1 - outer, outer].map(|i| &self.pair.meshes[i]);
        let vertex = to_other(self.pair.pose, 1 - outer, held.corners(0)[0]);
        if !is_deep {
            if *outside > travel || self.surfaces[outer].is_none() {
                return None;
            }
            let from_box = f64::from(holder.root().distance_to_local_point(vertex, true));
            if from_box > 0.0 {
                *outside = SURE * from_box + travel;
                return None;
            }
            let is_covered = is_covered(holder.mesh, vertex);
            let (_, near, behind) = nearest(holder.mesh, vertex)?;
            if !is_covered || behind < -BEHIND {
                *outside = SURE * f64::from(near.point.distance(vertex)) + travel;
            }
            if !is_covered || behind < BEHIND {
                return None;
            }
            if !is_solid(self, outer) {
                *outside = f64::INFINITY;
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
        Some((subshapes, TriangleContact { normal, distance, point1, point2, features }))
    }

    /// If the smaller mesh is deep in the other one, where its middle is in both: the direction in which
    /// mesh 2 leaves mesh 1 by the way that is shortest from there. Of two alike, by the shorter way.
    pub(super) fn way_apart(&self) -> Option<DVec3> {
        let [one, two] = &self.pair.meshes;
        let [size1, size2] = [one, two].map(|mesh| mesh.size_squared());
        let inner = [(0, one, size1 <= size2), (1, two, size2 <= size1)];
        let ways = inner.into_iter().filter(|(.., is_inner)| *is_inner);
        let ways =
            ways.filter_map(|(i, mesh, _)| way_out(self, self.pair.pose, i, mesh.ball().centre));
        ways.min_by(|a, b| a.length().total_cmp(&b.length()))?.try_normalize()
    }
}

/// The way in which shape 2 leaves shape 1 that is shortest from a point of one of them, in its frame, if
/// that is in both and both are solids.
pub(super) fn way_out(
    shapes: &impl Surfaces,
    pose: &PairPose,
    inner: usize,
    middle: Vector,
) -> Option<DVec3> {
    if !(0..2).all(|i| is_solid(shapes, i)) {
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

/// A point of one shape in the frame of the other.
fn to_other(
    PairPose { placement12, placement21, .. }: &PairPose,
    i: usize,
    point: Vector,
) -> Vector {
    [placement21, placement12][i].to_frame1(point, Vector::ZERO).as_vec3()
}

fn is_solid(shapes: &impl Surfaces, i: usize) -> bool {
    shapes.around(i).is_some_and(|around| around.is_solid)
}
