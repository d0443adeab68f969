//! A mesh during one query, and searches of its BVH.
//!
//! Parry's BVH is there before the first query and always fits the mesh, so a pair without trees
//! needs nothing else.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::sync::Arc;

use arrayvec::ArrayVec;
use glamx::Vec3;
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::partitioning::BvhNode;
use parry3d::query::{PointQuery, Ray, RayCast, RayIntersection};
use parry3d::shape::{CompositeShape, FeatureId, Shape, TriMesh};
use sbbk_core::surface::{Place, RayTriangles, place};
use sbbk_core::traverse::TestedBox;
use sbbk_core::volumes::Sphere;
use sbbk_core::volumes::rounding::gamma;

use super::data::{MeshData, Tips};
use super::rays::MeshRays;
use super::store::MeshStore;

/// Returns false if the BVH of a mesh has no triangle within `margin` of the box around a shape at
/// `pos12`.
pub(crate) fn is_near(mesh: &TriMesh, shape: &dyn Shape, pos12: &Pose, margin: Real) -> bool {
    let is_searched = is_valid(&mesh.bvh().root_aabb());
    !is_searched || has_near(mesh, &shape.compute_aabb(pos12), pos12, margin)
}

/// Two meshes at a pose, for tests that need no data of a pair.
pub(crate) struct TwoMeshes<'a> {
    larger: &'a TriMesh,
    /// The other mesh in the frame of the larger one.
    pose: Pose,
    /// Box around the other mesh, in its own frame.
    root: Aabb,
    is_valid: bool,
}

impl<'a> TwoMeshes<'a> {
    pub(crate) fn new([mesh1, mesh2]: [&'a TriMesh; 2], pos12: &Pose) -> Self {
        let [root1, root2] = [mesh1, mesh2].map(|mesh| mesh.bvh().root_aabb());
        let is_valid = is_valid(&root1) && is_valid(&root2);
        let size = |root: &Aabb| root.half_extents().length_squared();
        if size(&root1) < size(&root2) {
            Self { larger: mesh2, pose: pos12.inverse(), root: root1, is_valid }
        } else {
            Self { larger: mesh1, pose: *pos12, root: root2, is_valid }
        }
    }

    /// Returns true if nothing of the larger mesh is within `margin` of the box around the other
    /// one.
    pub(crate) fn are_apart(&self, margin: Real) -> bool {
        let Self { larger, pose, root, is_valid, .. } = self;
        *is_valid && !has_near(larger, &root.transform_by(pose), pose, margin)
    }

    /// True if the larger mesh [covers](is_covered) the box around the smaller one. A closed mesh
    /// covers all that is in it.
    pub(crate) fn may_be_inside(&self) -> bool {
        is_box_covered(self.larger, &self.root.transform_by(&self.pose))
    }
}

/// True if each of the six rays from a point along the axes crosses the box of a triangle. So it is
/// for each point inside a closed mesh, and for no point above a terrain.
pub(crate) fn is_covered(mesh: &TriMesh, point: Vec3) -> bool {
    is_box_covered(mesh, &Aabb::new(point, point))
}

/// True if a box, on each of the six ways along the axes, meets the box of a triangle.
fn is_box_covered(mesh: &TriMesh, aabb: &Aabb) -> bool {
    let root = mesh.bvh().root_aabb();
    if !root.intersects(aabb) {
        return false;
    }
    let lengths = [aabb.mins - root.mins, root.maxs - aabb.maxs].map(|way| way.max(Vec3::ZERO));
    let mut ways = [0, 1, 2, 3, 4, 5].map(|i| (i, lengths[i / 3][i % 3]));
    // The shortest way is the cheapest, and the most likely to meet nothing.
    if let Some(shortest) = (0..6).min_by(|&a, &b| ways[a].1.total_cmp(&ways[b].1)) {
        ways.swap(0, shortest);
    }
    ways.iter().all(|&(i, length)| {
        let mut way = *aabb;
        // Twice as long, as rounding may leave out a face at the end.
        match i / 3 {
            0 => way.mins[i % 3] -= 2.0 * length,
            _ => way.maxs[i % 3] += 2.0 * length,
        }
        mesh.bvh().intersect_aabb(&way).next().is_some()
    })
}

/// Cosine of [`nearest`] from which a point counts as inside. Points next to a reflex edge may have
/// less.
pub(crate) const BEHIND: Real = 0.9;

/// Returns the nearest triangle of a mesh, the nearest point, and the cosine between the direction
/// to `point` and the inward normal. The cosine is 0 for a point on the mesh.
pub(super) fn nearest(
    mesh: &TriMesh,
    point: Vec3,
    is_left_out: impl Fn(u32) -> bool,
) -> Option<(u32, Vec3, Real)> {
    let (triangle, (_, nearest)) = mesh.bvh().find_best(
        Real::MAX,
        |node: &BvhNode, _| node.aabb().distance_to_local_point(point, true),
        |triangle, least| {
            let nearest = mesh.triangle(triangle).project_local_point(point, false).point;
            let distance = nearest.distance(point);
            (distance < least && !is_left_out(triangle)).then_some((distance, nearest))
        },
    )?;
    let away = (point - nearest).normalize_or_zero();
    let behind = mesh.triangle(triangle).normal().map_or(0.0, |normal| -away.dot(normal));
    Some((triangle, nearest, behind))
}

/// Returns the first triangle that a ray meets within a length, and where. Faster than Parry's cast
/// with a normal, which divides for each box.
pub(crate) fn first_hit(mesh: &TriMesh, ray: &Ray, within: Real) -> Option<(u32, RayIntersection)> {
    let hit =
        |triangle| mesh.triangle(triangle).cast_local_ray_and_get_normal(ray, Real::MAX, false);
    let time = |triangle, _| Some(hit(triangle)?.time_of_impact);
    let (triangle, _) = mesh.bvh().cast_ray(ray, within, time)?;
    Some((triangle, hit(triangle)?))
}

/// Places where a ray meets a mesh, at most. At least half as many nearest ones are found. Higher:
/// more memory; lower: overlaps of many layers are less deep.
const MOST_HITS: usize = 64;

/// Returns true if a ray that starts in a shape leaves it where it meets a triangle. `outward` is
/// the sign with which normals lead out of a solid; `None` for a sheet, which may be left on both
/// sides.
pub(crate) fn leaves(hit: &RayIntersection, outward: Option<f64>) -> bool {
    // Parry calls the back face 1.
    let is_back = hit.feature == FeatureId::Face(1);
    outward.is_none_or(|outward| is_back == (outward > 0.0))
}

/// True if a box is finite and not empty.
fn is_valid(aabb: &Aabb) -> bool {
    aabb.mins.is_finite() && aabb.maxs.is_finite() && aabb.mins.cmple(aabb.maxs).all()
}

/// True if the BVH of a mesh has a triangle within `margin` of a box, or a little farther. `aabb`
/// was placed at `pos12`.
fn has_near(mesh: &TriMesh, aabb: &Aabb, pos12: &Pose, margin: Real) -> bool {
    // Some 30 operations on coordinates up to twice these.
    let size = aabb.mins.abs().max(aabb.maxs.abs()).max_element();
    let grown = margin.max(0.0) + gamma(64) * 2.0 * (size + pos12.translation.abs().max_element());
    let is_number = grown >= 0.0;
    if !is_number {
        return false;
    }
    mesh.bvh().intersect_aabb(&aabb.loosened(grown)).next().is_some()
}

/// A mesh during one query.
#[derive(Copy, Clone)]
pub(crate) struct MeshView<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(crate) store: &'a MeshStore,
    root: Aabb,
}

impl MeshStore {
    /// Returns a view of a mesh for one query. `None` if the box around the mesh is not finite, or
    /// if there are no triangles. Only Parry can answer then.
    #[inline]
    pub(crate) fn view<'a>(&'a self, mesh: &'a TriMesh) -> Option<MeshView<'a>> {
        let root = mesh.bvh().root_aabb();
        let view = || MeshView { mesh, store: self, root };
        is_valid(&root).then(view)
    }
}

impl<'a> MeshView<'a> {
    /// Returns the shared data of the mesh with its tree, if the mesh is registered or small. Finds
    /// small ones by a hash of their content, and builds their trees within the budget.
    pub(crate) fn with_tree(&self) -> Option<Arc<MeshData>> {
        self.registered().or_else(|| self.store.small_with_tree(self.mesh))
    }

    /// Returns the shared data of the mesh, if it is registered.
    pub(crate) fn registered(&self) -> Option<Arc<MeshData>> {
        Some(Arc::clone(&self.store.registered(self.mesh)?.data))
    }

    /// True if the mesh cannot change while its token stays.
    pub(crate) fn is_rigid(&self) -> bool {
        !self.mesh.is_deformable()
    }

    /// The box around the mesh.
    pub(crate) fn root(&self) -> &Aabb {
        &self.root
    }

    /// Square of half the diagonal of the box around the mesh.
    pub(crate) fn size_squared(&self) -> Real {
        self.root.half_extents().length_squared()
    }

    /// Returns the box around the mesh at `pose`, grown by `reach` and by rounding. A pose that is
    /// not finite gives a box that overlaps nothing.
    pub(crate) fn placed_root(&self, pose: &Pose, reach: Real) -> Aabb {
        let size = self.root.half_extents().length() + self.root.center().length();
        let grown = reach + gamma(64) * (size + pose.translation.length() + reach);
        let is_number = grown >= 0.0;
        if is_number { self.root.transform_by(pose).loosened(grown) } else { Aabb::new_invalid() }
    }

    /// Half the sides of the box around the mesh, the least first.
    pub(crate) fn sorted_extents(&self) -> Vec3 {
        let mut sides = self.root.half_extents().to_array();
        sides.sort_unstable_by(f32::total_cmp);
        sides.into()
    }

    /// Least coordinate of the mesh along a direction.
    pub(crate) fn lowest(&self, direction: Vec3) -> Real {
        self.lowest_corner(direction).0
    }

    /// Returns the tips of the mesh, each vertex once.
    pub(super) fn tips(&self) -> Tips {
        let mut tips = Tips::new();
        for direction in tip_directions() {
            let (_, tip) = self.lowest_corner(direction);
            if tips.iter().all(|&other| self.corner(other) != self.corner(tip)) {
                tips.push(tip);
            }
        }
        tips
    }

    /// Returns true if an edge at a tip of the mesh has one triangle: the mesh has a border. A look
    /// at a few tips may miss one.
    pub(super) fn has_bare_edge(&self) -> bool {
        /// Tips that are looked at. Higher: slower for closed meshes. Lower: slower for sheets
        /// whose borders are not at these.
        const LOOKED_AT: usize = 3;
        let tips = tip_directions().take(LOOKED_AT);
        tips.map(|direction| self.lowest_corner(direction).1).any(|tip| {
            let tip = self.corner(tip);
            let around = Aabb::new(tip, tip);
            let near = self.mesh.bvh().intersect_aabb(&around);
            let fan = near.map(|triangle| self.corners(triangle)).filter(|of| of.contains(&tip));
            let ends = fan.flatten().filter(|end| *end != tip).map(place);
            let mut ends: Vec<Place> = ends.collect();
            ends.sort_unstable();
            ends.chunk_by(Place::eq).any(|same| same.len() == 1)
        })
    }

    /// Returns the least coordinate of the mesh along a direction, and the half-edge that begins
    /// there.
    fn lowest_corner(&self, direction: Vec3) -> (Real, u32) {
        let least = Cell::new((Real::INFINITY, 0));
        let bound =
            |node: &BvhNode| (direction * node.mins()).min(direction * node.maxs()).element_sum();
        for triangle in self.mesh.bvh().leaves(|node| bound(node) < least.get().0) {
            for (half_edge, corner) in (3 * triangle..).zip(self.corners(triangle)) {
                let height = corner.dot(direction);
                if height < least.get().0 {
                    least.set((height, half_edge));
                }
            }
        }
        least.get()
    }

    /// Height of the mesh over the middle of its box along a unit direction, or of the box if that
    /// is less than `enough`.
    pub(crate) fn height(&self, direction: Vec3, enough: Real) -> Real {
        let of_box = direction.abs().dot(self.root.half_extents());
        if of_box <= enough {
            return of_box;
        }
        -self.lowest(-direction) - self.root.center().dot(direction)
    }

    /// Distance by which rounding may move where a ray meets a triangle.
    pub(crate) fn rounding(&self) -> Real {
        64.0 * Real::EPSILON * self.magnitude()
    }

    /// The largest absolute coordinate.
    pub(crate) fn magnitude(&self) -> Real {
        self.root.mins.abs().max(self.root.maxs.abs()).max_element()
    }

    /// A ball around the mesh.
    pub(crate) fn ball(&self) -> Sphere {
        let (centre, half) = (self.root.center(), self.root.half_extents().length());
        Sphere { centre, radius: half + gamma(8) * (centre.length() + half) }
    }

    /// Returns the distance of a point to the mesh, up to rounding; `None` if the box of a triangle
    /// is within `least` of the point.
    pub(crate) fn distance_beyond(&self, point: Vec3, least: Real) -> Option<Real> {
        let is_within = |node: &BvhNode| node.aabb().distance_to_local_point(point, true) <= least;
        if self.mesh.bvh().leaves(is_within).next().is_some() {
            return None;
        }
        let (_, nearest, _) = nearest(self.mesh, point, |_| false)?;
        Some(nearest.distance(point))
    }

    /// Returns the distance in which a ray from a point inside leaves the mesh, and the outward
    /// normal there. A solid goes on while the ray is in one of its parts, which may overlap.
    /// `None` if the ray does not leave. See [`leaves`].
    pub(crate) fn exit(&self, ray: &Ray, outward: Option<f64>) -> Option<(Real, Vec3)> {
        if outward.is_none() {
            let (_, hit) = first_hit(self.mesh, ray, Real::MAX)?;
            return Some((hit.time_of_impact, -hit.normal));
        }
        // Rounding parts the triangles at an edge.
        let rounding = self.rounding();
        let is_same = |a: &RayIntersection, b: &RayIntersection| {
            b.time_of_impact - a.time_of_impact <= rounding
        };
        let sign = |hit| if leaves(hit, outward) { 1 } else { -1 };
        let (mut parts, mut end) = (1, None);
        for same in self.hits(ray).chunk_by(is_same) {
            let left = same.iter().map(sign).sum::<i32>().signum();
            if end.is_some() && left < 0 {
                break;
            }
            parts -= left;
            if left > 0 && parts <= 0 {
                end = same.first().copied();
            }
        }
        // Parry turns normals against the ray.
        end.map(|hit| (hit.time_of_impact, -hit.normal))
    }

    /// Returns where a ray meets triangles, the nearest first.
    fn hits(&self, ray: &Ray) -> ArrayVec<RayIntersection, MOST_HITS> {
        let nearest_first = |a: &RayIntersection, b: &RayIntersection| {
            a.time_of_impact.total_cmp(&b.time_of_impact)
        };
        let (mut hits, mut within) = (ArrayVec::<_, MOST_HITS>::new(), Real::MAX);
        let mut meet = |triangle| {
            if hits.is_full() {
                hits.sort_unstable_by(nearest_first);
                hits.truncate(MOST_HITS / 2);
                within = hits[MOST_HITS / 2 - 1].time_of_impact;
            }
            let triangle = self.mesh.triangle(triangle);
            hits.extend(triangle.cast_local_ray_and_get_normal(ray, within, false));
            ControlFlow::Continue(())
        };
        MeshRays(self.mesh).along(ray.origin.as_dvec3(), ray.dir.as_dvec3(), &mut meet);
        hits.sort_unstable_by(nearest_first);
        hits
    }

    /// Returns the triangles for whose boxes, and the boxes above them, `overlaps` returns true.
    #[inline(always)]
    pub(crate) fn near(&self, overlaps: impl Fn(TestedBox) -> bool) -> impl Iterator<Item = u32> {
        self.mesh.bvh().leaves(move |node| overlaps(box_of(node)))
    }

    /// The box around some triangles.
    pub(crate) fn tested(&self, triangles: &[u32]) -> TestedBox {
        let corners = || triangles.iter().flat_map(|&triangle| self.corners(triangle));
        let low = corners().fold(Vec3::INFINITY, Vec3::min);
        TestedBox::new(low, corners().fold(Vec3::NEG_INFINITY, Vec3::max))
    }

    /// The vertex at which a half-edge begins.
    pub(crate) fn corner(&self, half_edge: u32) -> Vec3 {
        self.corners(half_edge / 3)[half_edge as usize % 3]
    }

    /// The corners of a triangle.
    #[inline(always)]
    pub(crate) fn corners(&self, triangle: u32) -> [Vec3; 3] {
        // `TriMesh::triangle` is slower here: it writes 12 bytes that are then read as 16.
        let (vertices, [a, b, c]) = (self.mesh.vertices(), self.mesh.indices()[triangle as usize]);
        [vertices[a as usize], vertices[b as usize], vertices[c as usize]]
    }
}

/// Directions of the corners and faces of a cube.
fn tip_directions() -> impl Iterator<Item = Vec3> {
    let signs = [-1.0, 1.0];
    let corners = signs
        .into_iter()
        .flat_map(move |x| signs.into_iter().flat_map(move |y| signs.map(|z| Vec3::new(x, y, z))));
    corners.chain(Vec3::AXES).chain(Vec3::AXES.map(|axis| -axis))
}

/// The box of a node of the BVH.
#[inline(always)]
pub(crate) fn box_of(node: &BvhNode) -> TestedBox {
    TestedBox::new(node.mins(), node.maxs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use parry3d::shape::Cuboid;

    /// A mesh of boxes along x, of two units of height and depth.
    fn row(boxes: &[[Real; 2]]) -> TriMesh {
        let parts = boxes.iter().map(|&[from, to]| {
            let middle = Pose::translation(0.5 * (from + to), 0.0, 0.0);
            let (mut vertices, indices) =
                Cuboid::new(Vec3::new(0.5 * (to - from), 1.0, 1.0)).to_trimesh();
            vertices.iter_mut().for_each(|vertex| *vertex = middle * *vertex);
            TriMesh::new(vertices, indices).unwrap()
        });
        parts
            .reduce(|mut row, part| {
                row.append(&part);
                row
            })
            .unwrap()
    }

    /// Closed forms. Would catch solids that end where one part begins in another, or at an edge of
    /// two triangles.
    #[test]
    fn a_ray_leaves_a_solid_after_its_last_part() {
        let cases: [(&[[Real; 2]], Option<Real>); 7] = [
            (&[[0.0, 2.0]], Some(1.5)),
            (&[[0.0, 2.0], [3.0, 4.0]], Some(1.5)),
            (&[[0.0, 2.0], [2.0, 4.0]], Some(3.5)),
            (&[[0.0, 2.0], [1.0, 4.0]], Some(3.5)),
            (&[[0.0, 2.0], [0.0, 4.0]], Some(3.5)),
            (&[[0.0, 4.0], [1.0, 2.0]], Some(3.5)),
            (&[[1.0, 2.0]], None),
        ];
        // The first ray meets the diagonals of all faces.
        for beside in [Vec3::ZERO, Vec3::new(0.0, 0.3, -0.4)] {
            let ray = Ray::new(0.5 * Vec3::X + beside, Vec3::X);
            for (boxes, expected) in cases {
                let (mut mesh, store) = (row(boxes), MeshStore::default());
                for outward in [1.0, -1.0] {
                    let exit = store.view(&mesh).unwrap().exit(&ray, Some(outward));
                    assert_eq!(exit, expected.map(|length| (length, Vec3::X)), "{boxes:?}");
                    mesh.reverse();
                }
            }
        }
    }

    /// Would catch a list that loses the nearest hits when it is full.
    #[test]
    fn the_nearest_hits_of_many_are_kept() {
        let ends = (0..300).map(|i| f64::from(i * 7919 % 300 + 1) as Real);
        let boxes: Vec<[Real; 2]> = ends.map(|end| [-end, end]).collect();
        let (mesh, store) = (row(&boxes), MeshStore::default());
        let hits = store.view(&mesh).unwrap().hits(&Ray::new(Vec3::new(0.0, 0.3, -0.4), Vec3::X));
        assert!(hits.len() >= MOST_HITS / 2);
        assert!(hits.iter().zip(1..).all(|(hit, i)| hit.time_of_impact == i as Real));
    }
}
