//! Far contacts of two meshes: what may be hit in the next step, but is not near.
//!
//! A host asks for them where a body is small beside the prediction distance, or fast and has soft CCD.
//! Meshes of few triangles keep all contacts within that distance. Fine meshes only have contacts from their tips to
//! the nearest points of the other mesh. Walks add the places where meshes are nearest to each other. A walk goes
//! from a point of one mesh to the nearest point of the other, and back. It may end at another place.

use glamx::Vec3;
use parry3d::math::Real;
use parry3d::partitioning::BvhNode;
use parry3d::shape::CompositeShapeRef;
use sbbk_core::contact::{Feature, FeaturePair, TriangleContact, contact};

use super::bvh_search::BvhSearch;
use super::pose::PairPose;
use super::triangle_contacts::{in_local, local_pair};
use super::triangles::{ContactSource, TriangleHit, TriangleSurfaceContact};
use crate::mesh::{MeshSurface, MeshView};

/// Greatest product of the numbers of triangles near the other mesh with which all pairs are candidates.
/// Higher: small bodies cost more time and memory. Lower: thin plates with soft CCD turn through sheets.
const FEW: usize = 1 << 16;

/// Greatest number of steps from a tip to the nearest point. Higher: more time for surfaces that are nearly
/// parallel; lower: the contact is farther than the nearest one.
const STEPS: usize = 8;

/// Share of the distance that a step must gain.
const GAIN: f64 = 0.01;

/// Two meshes whose far contacts are wanted.
pub(super) struct FarSearch<'a, 'm> {
    pub(super) search: BvhSearch<'a>,
    pub(super) surfaces: [&'a MeshSurface<'m>; 2],
    pub(super) pose: &'a PairPose,
}

/// Returns true if few triangles of two meshes are within the prediction distance of the box around the
/// other mesh.
pub(super) fn are_few(meshes: [&MeshView<'_>; 2], pose: &PairPose) -> bool {
    let PairPose { pos12, prediction, .. } = *pose;
    let poses = [pos12, pos12.inverse()];
    let count = |i: usize, most: usize| {
        let around = BvhNode::leaf(meshes[1 - i].placed_root(&poses[i], prediction), 0);
        meshes[i].mesh.bvh().leaves(|node| node.intersects(&around)).take(most + 1).count()
    };
    let least = FEW.isqrt();
    match [0, 1].map(|i| count(i, least)) {
        [one, _] if one <= least => one * count(1, FEW / one.max(1)) <= FEW,
        [_, two] if two <= least => two * count(0, FEW / two.max(1)) <= FEW,
        _ => false,
    }
}

impl FarSearch<'_, '_> {
    /// Calls `found` with the contacts of tips, and with those one step of a walk farther, which may be near.
    /// Meshes that are apart also get the contacts where walks from the nearest tips and from the middles end.
    pub(super) fn contacts(&self, is_apart: bool, mut found: impl FnMut(TriangleHit)) {
        if !self.search.placement.is_finite() {
            return;
        }
        let within = self.pose.prediction;
        for i in 0..2 {
            let mesh = self.search.meshes[i];
            let of_tip = |&tip: &u32| self.of_point(i, tip, mesh.corner(tip), within);
            let tips = self.surfaces[i].tips(mesh).iter().filter_map(of_tip);
            let nearest = tips
                .inspect(|hit| {
                    found(*hit);
                    self.step(1 - i, hit, distance(hit)).into_iter().for_each(&mut found);
                })
                .min_by(|one, two| distance(one).total_cmp(&distance(two)));
            if is_apart {
                let of_middle = self.of_point(i, 0, mesh.root().center(), Real::MAX);
                let from_middle = of_middle.and_then(|hit| self.step(1 - i, &hit, f64::INFINITY));
                let starts = [nearest.map(|hit| (1 - i, hit)), from_middle.map(|hit| (i, hit))];
                let ends = starts.into_iter().flatten().map(|(next, hit)| self.walked(next, hit));
                ends.filter(|end| distance(end) <= f64::from(within)).for_each(&mut found);
            }
        }
    }

    /// Walks on from a contact. The first step starts at the point of mesh `i`.
    fn walked(&self, mut i: usize, mut hit: TriangleHit) -> TriangleHit {
        for _ in 0..STEPS {
            let limit = (1.0 - GAIN) * distance(&hit);
            let Some(next) = self.step(i, &hit, limit) else { break };
            (i, hit) = (1 - i, next);
        }
        hit
    }

    /// Returns the contact after a step from the point of mesh `i`: the triangle of the other mesh becomes the
    /// nearest one. `None` beyond a limit.
    fn step(&self, i: usize, (pair, known): &TriangleHit, limit: f64) -> Option<TriangleHit> {
        let BvhSearch { meshes, placement } = &self.search;
        let [origin, ..] = meshes[0].corners(pair[0]);
        let point = match i {
            0 => placement.to_frame2(known.contact.point1, origin),
            _ => known.contact.point2 + origin.as_dvec3(),
        };
        let mut pair = *pair;
        pair[1 - i] = self.nearest(1 - i, point.as_vec3(), limit as Real)?;
        Some(hit(pair, self.search.pair(pair, limit)?.contact))
    }

    /// Returns the contact of a point and the nearest triangle of the other mesh. The point is in the frame of
    /// mesh `i`, and stands for the start of a half-edge.
    fn of_point(&self, i: usize, half_edge: u32, point: Vec3, within: Real) -> Option<TriangleHit> {
        let BvhSearch { meshes, placement } = &self.search;
        let in_other = match i {
            0 => placement.to_frame2(point.as_dvec3(), Vec3::ZERO),
            _ => placement.to_frame1(point, Vec3::ZERO),
        };
        let mut pair = [self.nearest(1 - i, in_other.as_vec3(), within)?; 2];
        pair[i] = half_edge / 3;
        let triangles = [0, 1].map(|i| meshes[i].mesh.triangle(pair[i]));
        let mut local = local_pair(placement, &triangles);
        local.corners[i] = [in_local(placement, i, point, &local); 3];
        let [t1, t2] = &local.corners;
        let contact = contact(t1, t2, f64::from(within))?;
        let mut features = [contact.features.feature1(), contact.features.feature2()];
        features[i] = Feature::Vertex((half_edge % 3) as u8);
        let features = FeaturePair::new(features[0], features[1]);
        Some(hit(pair, TriangleContact { features, ..contact }))
    }

    /// Returns the triangle of mesh `i` that is nearest to a point in its frame.
    fn nearest(&self, i: usize, point: Vec3, within: Real) -> Option<u32> {
        let mesh = CompositeShapeRef(self.search.meshes[i].mesh);
        let (nearest, _) = mesh.project_local_point(point, within, false)?;
        Some(nearest)
    }
}

fn distance((_, hit): &TriangleHit) -> f64 {
    hit.contact.distance
}

fn hit(pair: [u32; 2], contact: TriangleContact) -> TriangleHit {
    (pair, TriangleSurfaceContact { contact, source: ContactSource::Triangles })
}
