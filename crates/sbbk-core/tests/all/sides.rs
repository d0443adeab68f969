//! Sides of triangles against points of boxes that overlap.

use crate::prelude::*;
use crate::surface::shapes::{cube, mapped, together};
use sbbk_core::surface::{RayTriangles, side, winding_sign};
use std::cell::Cell;
use std::ops::ControlFlow;

/// The middle and the half-lengths of a box.
type Cuboid = [Vec3; 2];

/// Boxes in a cube of this many units. On a lattice many touch, are flush, or lie in each other.
fn boxes(random: &mut Random, count: usize, size: u64, is_lattice: bool) -> Vec<Cuboid> {
    let mut steps = |low: u64, count: u64| {
        let mut step = |()| {
            let exact = (low + random.below(count)) as f32;
            if is_lattice { exact } else { exact + random.range(-0.4, 0.4) }
        };
        Vec3::from_array([(); 3].map(&mut step))
    };
    (0..count).map(|_| [steps(0, size), 0.5 * steps(1, 4)]).collect()
}

/// Twelve triangles a box, with outward normals. The first two are its bottom.
fn soup(boxes: &[Cuboid]) -> Soup {
    let cuboid = |[middle, half]: &Cuboid| mapped(cube(), |v| middle + 2.0 * v * half);
    together(boxes.iter().map(cuboid))
}

/// Returns true if the boxes cover both sides of a triangle at a place.
fn is_covered(boxes: &[Cuboid], place: DVec3, normal: DVec3) -> bool {
    [1.0e-5, -1.0e-5].into_iter().all(|offset| {
        let point = place + offset * normal;
        let holds = |[middle, half]: &Cuboid| {
            (point - middle.as_dvec3()).abs().cmplt(half.as_dvec3()).all()
        };
        boxes.iter().any(holds)
    })
}

/// Also counts directions, so that the test cannot pass without any.
#[test]
fn ways_behind_all_triangles_of_a_ring_begin_in_the_solid() {
    let mut random = Random(8);
    let (mut found, mut missed) = (0, 0);
    for round in 0..20 {
        let soup = bumpy_ball(5 + round, 0.4);
        let (surface, memo) = (soup.surface(), PlaceMemo::default());
        let around = Around { facets: soup.facets(&surface), side: Side::Outer };
        for _ in 0..200 {
            let triangle = random.below(soup.triangles.len() as u64) as u32;
            let i = random.below(3) as usize;
            let direction = random.direction();
            let corners = soup.triangles[triangle as usize];
            let at = |i: usize| soup.vertices[corners[i % 3] as usize].as_dvec3();
            let [vertex, edge] = [Feature::Vertex(i as u8), Feature::Edge(i as u8)];
            for (feature, place) in [(vertex, at(i)), (edge, at(i).midpoint(at(i + 1)))] {
                let point = place + 1.0e-4 * direction;
                let is_inside = winding_sign(&soup, None, point, &memo) == Some(1);
                if around.leads_behind_all(triangle, feature, direction) {
                    assert!(is_inside, "round {round}: {feature:?} of {triangle}, {direction}");
                    found += 1;
                } else {
                    missed += u32::from(is_inside);
                }
            }
        }
    }
    assert!(found > 1000 && missed < found, "{found} found, {missed} missed");
}

/// Counts triangles that are covered in part or not, and wholly, each by whether they are found to
/// be walls within.
///
/// `is_analysed`: components are known to be closed.
fn walls_within(is_lattice: bool, is_analysed: bool) -> [[u32; 2]; 2] {
    let mut random = Random(5);
    let mut counts = [[0; 2]; 2];
    for _ in 0..30 {
        let boxes = boxes(&mut random, 12, 6, is_lattice);
        let (soup, memo) = (soup(&boxes), PlaceMemo::default());
        let surface = soup.surface();
        for (triangle, corners) in (0..).zip(&soup.triangles) {
            let [a, b, c] = corners.map(|corner| soup.vertices[corner as usize].as_dvec3());
            let normal = (b - a).cross(c - a).normalize();
            let is_wall = (0..400).all(|_| {
                let [u, v] = [(); 2].map(|()| random.within(0.0, 1.0));
                let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
                is_covered(&boxes, a + u * (b - a) + v * (c - a), normal)
            });
            let surface = is_analysed.then_some(&surface);
            let found = side(&soup, surface, triangle, &memo) == Side::Inner;
            counts[usize::from(is_wall)][usize::from(found)] += 1;
        }
    }
    counts
}

/// Four walls of a house, and six slabs around a room. Boxes that meet have flush faces and an edge
/// in common. Would catch components that count as open, as four triangles share an edge.
#[test]
fn flush_boxes_with_a_common_edge_have_faces() {
    let boxes_around = |axes: &[usize], half: Vec3, thickness: f32| -> Vec<Cuboid> {
        let sides = axes.iter().flat_map(|&axis| [(axis, 1.0), (axis, -1.0)]);
        let cuboid = |(axis, side): (usize, f32)| {
            let (mut middle, mut half) = (Vec3::ZERO, half);
            middle[axis] = side * (half[axis] - thickness);
            half[axis] = thickness;
            [middle, half]
        };
        sides.map(cuboid).collect()
    };
    for thickness in [0.05, 0.1, 0.25, 0.5] {
        let walls = boxes_around(&[0, 2], Vec3::new(2.5, 1.5, 2.5), thickness);
        let slabs = boxes_around(&[0, 1, 2], Vec3::splat(2.5), thickness);
        for boxes in [walls, slabs] {
            let (soup, memo) = (soup(&boxes), PlaceMemo::default());
            let surface = soup.surface();
            assert_eq!(surface.kind(), SurfaceKind::Solid);
            for triangle in 0..soup.count() {
                let side = side(&soup, Some(&surface), triangle, &memo);
                assert_eq!(side, Side::Outer, "triangle {triangle}, {thickness} thick");
            }
        }
    }
}

/// Would catch a floor that is a wall within, as a pillar stands on its middle.
#[test]
fn only_triangles_covered_everywhere_are_walls_within() {
    let settings = [(false, 0), (true, 1)];
    let settings = settings.map(|setting| [false, true].map(|is_analysed| (setting, is_analysed)));
    for ((is_lattice, most), is_analysed) in settings.into_iter().flatten() {
        let counts @ [[faces, holes], [missed, walls]] = walls_within(is_lattice, is_analysed);
        println!("{faces} faces, {holes} holes; {walls} walls within, {missed} others");
        assert!(faces > 2000 && 100 * holes <= most * faces, "{counts:?}");
        assert!(walls > 100 && 4 * missed < walls, "{counts:?}");
    }
}

/// Would catch a triangle that counts as a wall within, as its normal points inward.
#[test]
fn triangles_wound_the_other_way_are_turned() {
    for (rings, nth) in [(6, 1000), (10, 50), (10, 9)] {
        let mut soup = bumpy_ball(rings, 0.1);
        soup.triangles.iter_mut().step_by(nth).for_each(|triangle| triangle.swap(1, 2));
        let (surface, memo) = (soup.surface(), PlaceMemo::default());
        for is_analysed in [true, false] {
            let surface = is_analysed.then_some(&surface);
            let (mut wrong, mut walls) = (0, 0);
            for triangle in 0..soup.count() {
                let is_turned = (triangle as usize).is_multiple_of(nth);
                let right = if is_turned { Side::Turned } else { Side::Outer };
                let found = side(&soup, surface, triangle, &memo);
                wrong += u32::from(found != right);
                walls += u32::from(found == Side::Inner);
            }
            println!("{wrong} of {} wrong, {walls} walls; each {nth}th turned", soup.count());
            // Rays that pass many turned triangles count wrong.
            assert!(walls == 0 && 200 * wrong <= soup.count(), "{wrong}, {walls} walls");
        }
    }
}

/// Triangles that count the rays they meet.
struct Counted {
    soup: Soup,
    hits: Cell<usize>,
}

impl RayTriangles for Counted {
    fn count(&self) -> u32 {
        self.soup.count()
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.soup.corners(triangle)
    }

    fn bounds(&self) -> [DVec3; 2] {
        self.soup.bounds()
    }

    fn near(&self, triangle: u32, slack: f64, visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        self.soup.near(triangle, slack, visit);
    }

    fn along(&self, start: DVec3, direction: DVec3, visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        self.soup.along(start, direction, &mut |triangle| {
            let middle = self.corners(triangle).into_iter().sum::<DVec3>() / 3.0 - start;
            let off = middle - middle.dot(direction).max(0.0) * direction;
            if off.length() > 1.0 {
                return ControlFlow::Continue(());
            }
            self.hits.set(self.hits.get() + 1);
            visit(triangle)
        });
    }
}

/// Would catch rays along a wide level, and searches for walls at all that these rays meet.
#[test]
fn a_side_takes_as_long_in_a_wide_level_as_in_a_narrow_one() {
    let hits = |width: u64, is_analysed: bool| {
        let mut random = Random(7);
        let boxes: Vec<Cuboid> = (0..width * width)
            .map(|i| {
                let place = [i % width, i / width].map(|at| at as f32);
                [Vec3::new(place[0], random.range(0.0, 0.2), place[1]), Vec3::new(0.52, 0.5, 0.52)]
            })
            .collect();
        let (soup, memo) = (soup(&boxes), PlaceMemo::default());
        let surface = soup.surface();
        let counted = Counted { soup, hits: Cell::default() };
        // The box in the middle.
        let first = 12 * (width * (width / 2) + width / 2) as u32;
        for triangle in first..first + 12 {
            side(&counted, is_analysed.then_some(&surface), triangle, &memo);
        }
        counted.hits.get()
    };
    for is_analysed in [true, false] {
        let [narrow, wide] = [5, 20].map(|width| hits(width, is_analysed));
        println!("{narrow} hits in a narrow level, {wide} in a wide one");
        assert!(narrow > 100 && wide < 2 * narrow, "{narrow} {wide}");
    }
}

/// Boxes without a bottom, each in many others. Would catch searches for walls that are bounded for
/// one ray only.
#[test]
fn meshes_of_open_parts_in_each_other_are_analysed_soon() {
    for count in [100, 400] {
        let mut random = Random(9);
        let mut soup = soup(&boxes(&mut random, count, 4, false));
        let sides = soup.triangles.chunks(12).flat_map(|of_box| &of_box[2..]);
        soup.triangles = sides.copied().collect();
        let surface = soup.surface();
        let counted = Counted { soup, hits: Cell::default() };
        sbbk_core::surface::kind(&counted);
        let of_kind = counted.hits.take();
        let memo = PlaceMemo::default();
        for triangle in 0..50 {
            side(&counted, Some(&surface), triangle, &memo);
        }
        let of_sides = counted.hits.take();
        println!("{count} boxes: {of_kind} triangles for the kind, {of_sides} for 50 sides");
        assert!(of_kind < 1_000_000 && of_sides < 5_000_000, "{of_kind} {of_sides}");
    }
}

/// Eight slabs with flush tops that overlap by 0.1. Would catch rays that count two flush faces
/// once, and rays that skip a face near their start.
#[test]
fn ends_of_flush_slabs_in_each_other_are_walls_within() {
    let slab = |k: usize| {
        let middle = [k % 4, k / 4].map(|at| 5.0 * at as f32);
        [Vec3::new(middle[0] - 7.5, -0.25, middle[1] - 2.5), Vec3::new(2.55, 0.25, 2.55)]
    };
    let slabs: Vec<Cuboid> = (0..8).map(slab).collect();
    let (soup, memo) = (soup(&slabs), PlaceMemo::default());
    let surface = soup.surface();
    let mut ends = 0;
    for triangle in 0..soup.count() {
        let corners = soup.corners(triangle);
        let outward = [DVec3::X, DVec3::Z].map(|axis| {
            let most = if axis == DVec3::X { 10.0 } else { 5.0 };
            corners.iter().all(|corner| corner.dot(axis).abs() > most)
        });
        let is_end = !outward.contains(&true)
            && corners.iter().any(|corner| corner.y < 0.0)
            && corners.iter().any(|corner| corner.y > -0.5);
        if is_end {
            ends += 1;
            assert_eq!(side(&soup, Some(&surface), triangle, &memo), Side::Inner, "{corners:?}");
        }
    }
    assert_eq!(ends, 2 * (12 + 8));
}
