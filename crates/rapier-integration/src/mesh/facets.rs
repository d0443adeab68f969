//! The triangles of a mesh with their adjacency, sides and strays.

use std::ops::ControlFlow;

use glamx::DVec3;
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Real, Vector};
use parry3d::shape::TriMesh;
use sbbk_core::contact::Feature;
use sbbk_core::surface::strays::has_strays;
use sbbk_core::surface::{
    Around, Facets, MinimumCones, PlaceMemo, SMALL_COMPONENT, Side, Surface, minimum_cones, side,
    winding_sign,
};

use super::flags::TriangleFlags;
use super::neighbours::{Neighbours, has_front, sliver};
use super::rays::MeshRays;

/// The triangles of a mesh with their adjacency and [strays](sbbk_core::surface::strays).
#[derive(Copy, Clone)]
pub(crate) struct MeshFacets<'a> {
    pub(super) mesh: &'a TriMesh,
    pub(super) twins: Twins<'a>,
    pub(super) memo: &'a PlaceMemo,
    /// Side of all triangles but walls within. `None` if rays find the sides.
    pub(super) declared: Option<Side>,
}

/// Twins and flags of the triangles of a mesh.
#[derive(Copy, Clone)]
pub(super) enum Twins<'a> {
    All(&'a Surface, &'a [TriangleFlags]),
    Near(&'a Neighbours),
}

impl<'a> Twins<'a> {
    /// Returns the surface of a mesh that is analysed as a whole.
    fn surface(self) -> Option<&'a Surface> {
        match self {
            Self::All(surface, _) => Some(surface),
            Self::Near(_) => None,
        }
    }
}

/// Least distance of a part that is alone from all others, in radii of the part. Higher: parts near
/// each other take more rays. Lower: walls between parts have contacts, though rays pass these.
const ALONE: Real = 2.0e-4;

impl MeshFacets<'_> {
    fn flags(&self, triangle: u32) -> &TriangleFlags {
        match self.twins {
            Twins::All(_, flags) => &flags[triangle as usize],
            Twins::Near(known) => &known.of(self.mesh, triangle).flags,
        }
    }

    /// Returns the side of a triangle of a closed mesh. Takes two rays the first time.
    pub(crate) fn side(self, triangle: u32) -> Side {
        self.flags(triangle).side().unwrap_or_else(|| {
            let first = self.first_of_group(triangle).filter(|&first| first != triangle);
            let is_face = first.is_some_and(|first| self.side(first) == Side::Outer);
            let rays = MeshRays(self.mesh);
            let found = || side(&rays, self.twins.surface(), triangle, self.memo);
            let side = if is_face { Side::Outer } else { found() };
            self.flags(triangle).set_side(side);
            side
        })
    }

    /// Returns what counts as the side of a triangle. A double counts as a wall within, so it has
    /// no contacts.
    #[inline]
    pub(super) fn declared_side(self, triangle: u32) -> Side {
        match self.declared {
            _ if self.is_double(triangle) => Side::Inner,
            Some(Side::Sheet) => Side::Sheet,
            Some(declared) if self.side(triangle) != Side::Inner => declared,
            _ => self.side(triangle),
        }
    }

    /// Returns the sign of the winding number of a closed mesh around a point, if two rays agree.
    pub(super) fn winding_sign(self, point: Vector) -> Option<i32> {
        let rays = MeshRays(self.mesh);
        winding_sign(&rays, self.twins.surface(), point.as_dvec3(), self.memo)
    }

    /// Returns true if an earlier triangle has the same corners.
    pub(crate) fn is_double(self, triangle: u32) -> bool {
        match self.twins {
            Twins::All(surface, _) => surface.is_double(triangle),
            Twins::Near(known) => known.of(self.mesh, triangle).is_double(),
        }
    }

    /// Returns true if the winding of a triangle tells the front of a sheet.
    pub(crate) fn has_front(self, triangle: u32) -> bool {
        if self.twins.surface().is_some_and(Surface::is_oriented) {
            return true;
        }
        let flags = self.flags(triangle);
        flags.has_front().unwrap_or_else(|| {
            let has_front = has_front(self.mesh, triangle);
            flags.set_front(has_front);
            has_front
        })
    }

    /// Returns the first triangle at a hub or of a small component. If that triangle is a face, so
    /// are all.
    fn first_of_group(self, triangle: u32) -> Option<u32> {
        let Twins::All(surface, _) = self.twins else { return None };
        let of_hub = surface.first_at_hub(*self.mesh.triangle(triangle).vertices());
        of_hub.or_else(|| {
            surface.has_small_components().then(|| self.first_of_component(triangle))?
        })
    }

    /// Returns the first triangle of a small closed component that is alone in its box.
    fn first_of_component(self, triangle: u32) -> Option<u32> {
        let (mut part, mut at) = (vec![triangle], 0);
        let mut bounds = self.mesh.triangle(triangle).local_aabb();
        while let Some(&of) = part.get(at) {
            for twin in (3 * of..3 * of + 3).map(|half_edge| self.twin(half_edge)) {
                let other = twin? / 3;
                if !part.contains(&other) {
                    bounds.merge(&self.mesh.triangle(other).local_aabb());
                    part.push(other);
                }
            }
            at += 1;
            if part.len() > SMALL_COMPONENT {
                return None;
            }
        }
        // A vertex may be NaN.
        let bounds = bounds.loosened((ALONE * bounds.half_extents().length()).max(0.0));
        let is_alone = self.mesh.bvh().intersect_aabb(&bounds).all(|other| part.contains(&other));
        part.into_iter().min().filter(|_| is_alone)
    }

    /// Searches the strays of a feature, in about 1 µs, and keeps in the flags if there are any.
    #[cold]
    fn find_strays(self, triangle: u32, feature: Feature) {
        let surface = Around { facets: self, side: Side::Sheet };
        let found = has_strays(&surface, triangle, feature);
        if let Feature::Vertex(_) = feature {
            // Once for all triangles of a fan.
            for half_edge in surface.ring(triangle, feature).0 {
                let vertex = Feature::Vertex((half_edge % 3) as u8);
                self.flags(half_edge / 3).set(vertex, found);
            }
        } else {
            self.flags(triangle).set(feature, found);
        }
    }

    #[cold]
    fn find_cones(self, triangle: u32) -> MinimumCones {
        let cones = minimum_cones(&self, triangle);
        self.flags(triangle).set_cones(cones);
        cones
    }
}

impl Facets for MeshFacets<'_> {
    #[inline]
    fn twin(&self, half_edge: u32) -> Option<u32> {
        match self.twins {
            Twins::All(surface, _) => surface.twin(half_edge),
            Twins::Near(known) => known.of(self.mesh, half_edge / 3).twin(half_edge % 3),
        }
    }

    #[inline(always)]
    fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        let triangle = self.mesh.indices()[half_edge as usize / 3];
        self.mesh.vertices()[triangle[(half_edge as usize + i) % 3] as usize].as_dvec3()
    }

    #[inline]
    fn is_whole(&self, triangle: u32, feature: Feature) -> bool {
        self.flags(triangle).is_whole(feature).unwrap_or_else(|| {
            self.find_strays(triangle, feature);
            self.flags(triangle).is_whole(feature) != Some(false)
        })
    }

    fn near(&self, corners: [DVec3; 2], visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        let near = box_between(corners);
        // Doubles change no result. They are skipped where no search is needed to find them.
        let is_double = |triangle: &u32| match self.twins {
            Twins::All(all, _) => all.is_double(*triangle),
            Twins::Near(_) => sliver(self.mesh, *triangle).is_some(),
        };
        let near = self.mesh.bvh().intersect_aabb(&near);
        let _ = near.filter(|triangle| !is_double(triangle)).try_for_each(visit);
    }

    fn outward(&self, triangle: u32) -> f64 {
        self.declared_side(triangle).outward().unwrap_or(0.0)
    }

    /// Triangles whose neighbours are not all known have none, as these take a search each.
    #[inline]
    fn cones(&self, triangle: u32) -> MinimumCones {
        let Twins::All(_, flags) = self.twins else { return MinimumCones::ALL };
        flags[triangle as usize].cones().unwrap_or_else(|| self.find_cones(triangle))
    }

    fn memo(&self) -> Option<&PlaceMemo> {
        Some(self.memo)
    }
}

/// Greatest slope, as a sine, by which a surface may rise beside the point of an impact. Higher:
/// walls stop bodies that slide along them. Lower: rounding hides impacts of parallel faces.
const IMPACT_RISE: f64 = 1.0e-4;

/// Returns true if no triangle at the place of an impact leads towards the other body. `other` has
/// the unit direction to that body, and its distance. The search takes triangles by their boxes and
/// needs no twins.
pub(crate) fn is_minimum(mesh: &TriMesh, triangle: u32, place: DVec3, other: (DVec3, f64)) -> bool {
    let (known, memo) = (Neighbours::new(0), PlaceMemo::default());
    let twins = Twins::Near(&known);
    let facets = MeshFacets { mesh, twins, memo: &memo, declared: Some(Side::Sheet) };
    !Around { facets, side: Side::Sheet }.rises(triangle, place, other, IMPACT_RISE)
}

/// Returns the box between two corners in f32, grown by the rounding.
pub(crate) fn box_between(corners: [DVec3; 2]) -> Aabb {
    let [low, high] = corners.map(|corner| corner.as_vec3());
    Aabb::new(low - f32::EPSILON * low.abs(), high + f32::EPSILON * high.abs())
}

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use super::super::neighbours::places;
    use super::*;
    use oorandom::Rand32;
    use parry3d::shape::Cuboid;

    /// The soups have points, segments, duplicates, and edges with three triangles.
    #[test]
    fn local_twins_and_doubles_are_those_of_the_surface() {
        let (mut random, mut found, mut doubles, mut slivers) = (Rand32::new(1), 0, 0, 0);
        for round in 0..400 {
            let mut place = || Vector::from_array([(); 3].map(|()| random.rand_range(0..3) as f32));
            let vertices: Vec<Vector> = (0..12).map(|_| place()).collect();
            let mut corner = || random.rand_range(0..12);
            let triangles = (0..1 + round % 20).map(|_| [corner(), corner(), corner()]).collect();
            let mesh = TriMesh::new(vertices, triangles).expect("there are triangles");
            let whole = Surface::new(mesh.vertices(), mesh.indices(), &MeshRays(&mesh));
            let known = Neighbours::new(mesh.indices().len());
            let (twins, memo) = (Twins::Near(&known), &PlaceMemo::default());
            let facets = MeshFacets { mesh: &mesh, twins, memo, declared: None };
            for half_edge in 0..3 * mesh.indices().len() as u32 {
                let twin = whole.twin(half_edge);
                assert_eq!(facets.twin(half_edge), twin, "{half_edge} of {:?}", mesh.indices());
                found += u32::from(twin.is_some());
            }
            let places = mesh.triangles().map(|triangle| places(*triangle.vertices()));
            let places: Vec<_> = places.collect();
            for (i, corners) in places.iter().enumerate() {
                let is_repeated = places[..i].contains(corners);
                let triangle = i as u32;
                let is_sliver = sliver(&mesh, triangle).is_some();
                let told = [whole.is_double(triangle), facets.is_double(triangle)];
                let is_double = is_repeated || is_sliver;
                assert_eq!(told, [is_double; 2], "{triangle} of {:?}", mesh.indices());
                doubles += u32::from(is_repeated);
                slivers += u32::from(is_sliver);
            }
        }
        assert!(found > 1000 && doubles > 100 && slivers > 100, "{found} {doubles} {slivers}");
    }

    /// Grids with double triangles, walls on them, turned triangles, or a back. Would catch doubles
    /// and walls that take a front away, and fronts that are looked for in each query.
    #[test]
    fn triangles_that_are_wound_against_each_other_have_no_front() {
        let at = |x: usize, y: usize, z: f32| Vector::new(x as f32, z, y as f32);
        let corners = (0..25).map(|i| at(i % 5, i / 5, 0.0));
        let vertices: Vec<Vector> = corners.chain((0..5).map(|x| at(x, 2, 1.0))).collect();
        let cells = (0..16).map(|i| i / 4 * 5 + i % 4);
        let grid: Vec<_> = cells.flat_map(|i| [[i, i + 5, i + 1], [i + 1, i + 5, i + 6]]).collect();
        let turned = |of: &[[u32; 3]]| of.iter().map(|&[a, b, c]| [a, c, b]).collect::<Vec<_>>();
        let wall = (0..4).flat_map(|x| [[10 + x, 11 + x, 25 + x], [25 + x, 11 + x, 26 + x]]);
        let wall: Vec<_> = wall.collect();
        let (kept, rest) = grid.split_at(13);
        let forms = [
            (true, grid.clone()),
            (true, [&grid[..], &grid].concat()),
            (true, [&grid[..], &wall].concat()),
            (true, [&grid[..], &turned(&wall)].concat()),
            (false, [&grid[..], &turned(&grid)].concat()),
            (false, [kept, &turned(&rest[..1]), &rest[1..]].concat()),
        ];
        for (expected, triangles) in forms {
            let mesh = TriMesh::new(vertices.clone(), triangles).expect("there are triangles");
            let whole = Surface::new(mesh.vertices(), mesh.indices(), &MeshRays(&mesh));
            let flags = mesh.indices().iter().map(|_| TriangleFlags::default()).collect::<Vec<_>>();
            let known = Neighbours::new(mesh.indices().len());
            for twins in [Twins::All(&whole, &flags), Twins::Near(&known)] {
                let memo = &PlaceMemo::default();
                let facets = MeshFacets { mesh: &mesh, twins, memo, declared: None };
                assert_eq!(facets.has_front(13), expected, "{:?}", mesh.indices());
                let is_known = facets.flags(13).has_front() == Some(expected);
                assert!(is_known || whole.is_oriented(), "a front is looked for once");
            }
        }
    }

    /// Boxes are alone, touch, cross, or are within others. Would catch parts that share a wrong
    /// side.
    #[test]
    fn sides_of_small_parts_are_those_that_rays_find() {
        let (mut random, mut counts) = (Rand32::new(2), [0; 4]);
        for size in [3, 5, 9] {
            let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
            for _ in 0..30 {
                let mut steps = |range: Range<u32>| {
                    let mut step = || random.rand_range(range.clone()) as f32;
                    Vector::from_array([(); 3].map(|()| step()))
                };
                let (half, place) = (0.25 * steps(1..4), steps(0..size));
                let (own, of) = Cuboid::new(half).to_trimesh();
                let first = vertices.len() as u32;
                triangles.extend(of.into_iter().map(|corners| corners.map(|i| first + i)));
                vertices.extend(own.into_iter().map(|vertex| vertex + place));
            }
            let mesh = TriMesh::new(vertices, triangles).expect("there are boxes");
            let surface = Surface::new(mesh.vertices(), mesh.indices(), &MeshRays(&mesh));
            assert!(surface.has_small_components());
            let flags: Vec<_> = mesh.indices().iter().map(|_| TriangleFlags::default()).collect();
            let (twins, memo) = (Twins::All(&surface, &flags), &PlaceMemo::default());
            let facets = MeshFacets { mesh: &mesh, twins, memo, declared: None };
            for triangle in 0..flags.len() as u32 {
                let found = facets.side(triangle);
                let by_rays = side(&MeshRays(&mesh), Some(&surface), triangle, memo);
                assert_eq!(found, by_rays, "{triangle} of {size}");
                counts[found as usize] += 1;
            }
        }
        assert!(counts[0] > 100 && counts[2] > 100, "{counts:?}");
    }
}
