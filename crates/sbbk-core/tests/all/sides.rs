//! Sides of triangles against points of boxes that overlap.

use crate::support::{Random, Soup, cube};
use glamx::{DVec3, Vec3};
use sbbk_core::surface::{PlaceMemo, Side, side};

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

/// Twelve triangles a box, with outward normals.
fn soup(boxes: &[Cuboid]) -> Soup {
    let mut soup = Soup { vertices: Vec::new(), triangles: Vec::new() };
    for [middle, half] in boxes {
        let cube = cube(1);
        let first = soup.vertices.len() as u32;
        soup.vertices.extend(cube.vertices.iter().map(|&corner| *middle + corner * *half));
        let outward = cube.triangles.iter().enumerate().map(|(i, &[a, b, c])| {
            let of = if i < 6 { [a, c, b] } else { [a, b, c] };
            of.map(|corner| first + corner)
        });
        soup.triangles.extend(outward);
    }
    soup
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

/// Counts triangles that are covered in part or not, and wholly, each by whether they are found to be walls within.
fn walls_within(is_lattice: bool) -> [[u32; 2]; 2] {
    let mut random = Random(5);
    let mut counts = [[0; 2]; 2];
    for _ in 0..30 {
        let boxes = boxes(&mut random, 12, 6, is_lattice);
        let (soup, memo) = (soup(&boxes), PlaceMemo::default());
        for (triangle, corners) in (0..).zip(&soup.triangles) {
            let [a, b, c] = corners.map(|corner| soup.vertices[corner as usize].as_dvec3());
            let normal = (b - a).cross(c - a).normalize();
            let is_wall = (0..400).all(|_| {
                let [u, v] = [(); 2].map(|()| random.within(0.0, 1.0));
                let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
                is_covered(&boxes, a + u * (b - a) + v * (c - a), normal)
            });
            let found = side(&soup, triangle, &memo) == Side::Inner;
            counts[usize::from(is_wall)][usize::from(found)] += 1;
        }
    }
    counts
}

/// Would catch a floor that is a wall within, as a pillar stands on its middle.
#[test]
fn only_triangles_covered_everywhere_are_walls_within() {
    for (is_lattice, most) in [(false, 0), (true, 1)] {
        let counts @ [[faces, holes], [missed, walls]] = walls_within(is_lattice);
        println!("{faces} faces, {holes} holes; {walls} walls within, {missed} others");
        assert!(faces > 2000 && 100 * holes <= most * faces, "{counts:?}");
        assert!(walls > 100 && 4 * missed < walls, "{counts:?}");
    }
}
