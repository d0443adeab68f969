//! Contacts of a mesh and a half-space. They have the normal of the half-space, so none is a ghost.
//! Patches take each vertex once, and the triangles that share it do not repeat it.

use glamx::DVec3;
use parry3d::math::Real;
use parry3d::query::TrackedContact;
use parry3d::shape::{HalfSpace, PackedFeatureId};
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::{ConvexContact, half_space_contact};

use super::contact::{NormalSource, PartContact};
use super::pair::ConvexPair;
use super::parts::Part;
use super::query::{ConvexQuery, ConvexScratch};
use super::shape::ConvexShape;
use super::triangle_part::TrianglePartPair;
use crate::pair::query::{Candidate, ContactList, ContactPoints, Limits};

impl ConvexQuery<'_> {
    /// Adds a contact for each vertex within the prediction distance of a half-space.
    pub(super) fn add_vertices(
        &self,
        half_space: &HalfSpace,
        candidates: &mut [Candidate<()>],
        limits: Limits,
        scratch: &mut ConvexScratch,
        contacts: &mut ContactList<PartContact>,
    ) {
        let ConvexPair { mesh, mesh_place, pose, .. } = self.pair;
        let (normal, prediction) = (half_space.normal.as_dvec3(), f64::from(pose.prediction));
        let vertices = |of: [u32; 2]| mesh.mesh.indices()[mesh_place.swap(of)[0] as usize];
        let ConvexScratch { at_hand, is_vertex_known: is_known, .. } = scratch;
        is_known.resize(mesh.mesh.vertices().len().max(is_known.len()), false);
        let part = Part { pose: None, shape: ConvexShape::HalfSpace(half_space), cone: None };
        let placed = self.placed(0, &part, at_hand);
        for candidate in candidates.iter_mut().filter(|candidate| limits.may_touch(candidate)) {
            let of = candidate.subshapes;
            let corners = placed.in_part(mesh.corners(mesh_place.swap(of)[0]));
            let lowest = half_space_contact(&corners, normal, limits.margin);
            let distance = lowest.map_or(limits.margin, |contact| contact.distance);
            candidate.touches_at = distance + limits.travel;
            if lowest.is_none() || distance > prediction {
                continue;
            }
            let vertices = vertices(of);
            for (i, corner, distance) in near_corners(&corners, normal, prediction) {
                if std::mem::replace(&mut is_known[vertices[usize::from(i)] as usize], true) {
                    continue;
                }
                let on_shape = corner - normal * distance;
                let contact =
                    ConvexContact { distance, normal: -normal, on_triangle: corner, on_shape };
                let (feature, source) = (Feature::Vertex(i), NormalSource::Own);
                contacts.push((of, PartContact { contact, feature, source }));
            }
        }
        for vertex in contacts.iter().flat_map(|(of, _)| vertices(*of)) {
            is_known[vertex as usize] = false;
        }
    }
}

impl TrianglePartPair<'_> {
    /// Writes the vertex of a contact, or all corners of its triangle that are within the
    /// prediction distance.
    pub(super) fn write_half_space(
        &self,
        half_space: &HalfSpace,
        PartContact { contact, feature, .. }: &PartContact,
        out: &mut ContactPoints,
    ) {
        let ConvexPair { mesh_place, pose, .. } = self.pair;
        let normal = half_space.normal.as_dvec3();
        let corners = self.placed.in_part(self.corners);
        let is_all = self.pair.half_space_by_vertices().is_none();
        for (i, corner, distance) in near_corners(&corners, normal, pose.prediction.into()) {
            if is_all || *feature == Feature::Vertex(i) {
                out.points.push(TrackedContact::flipped(
                    (corner - normal * distance).as_vec3(),
                    self.corners[usize::from(i)],
                    PackedFeatureId::face(0),
                    PackedFeatureId::vertex(i.into()),
                    distance as Real,
                    !mesh_place.is_second(),
                ));
            }
        }
        out.normals = self.normals(contact);
    }
}

/// Returns the corners of a triangle within a distance of a half-space, with their numbers and
/// distances.
fn near_corners(
    corners: &[DVec3; 3],
    normal: DVec3,
    within: f64,
) -> impl Iterator<Item = (u8, DVec3, f64)> {
    let heights = (0..).zip(corners).map(move |(i, corner)| (i, *corner, corner.dot(normal)));
    heights.filter(move |(.., distance)| *distance <= within)
}
