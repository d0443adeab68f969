use std::cell::RefCell;

use glamx::{DVec3, Pose3, Quat, Vec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use sbbk_core::field::FieldFrame;
use sbbk_core::traverse::{Placement, TestedBox};
use sbbk_core::volumes::Aabb;

use super::grid::Grid;
use super::oracle::{Tally, pairs_within, placed};
use crate::support::{Random, Soup, bumpy_ball, lattice_soup, soup};

/// Runs `case` for many seeds, all with one tally.
fn run(cases: u32, least_count: usize, case: impl Fn(u64, &mut Tally) -> Result<(), String>) {
    let tally = RefCell::new(Tally::default());
    let config = Config { failure_persistence: None, ..Config::with_cases(cases) };
    let checked = |seed: u64| case(seed, &mut tally.borrow_mut()).map_err(TestCaseError::fail);
    TestRunner::new(config).run(&any::<u64>(), checked).unwrap();
    tally.into_inner().finish(least_count);
}

fn scaled(soup: &Soup, factor: f32) -> Soup {
    Soup { vertices: soup.vertices.iter().map(|v| factor * v).collect(), ..soup.clone() }
}

fn some_mesh(random: &mut Random) -> Soup {
    match random.bits() % 3 {
        0 => bumpy_ball(5, 0.2),
        1 => soup(random, 60, 0.3),
        _ => soup(random, 8, 1.2),
    }
}

/// Would catch cells cut off at the edge of a range, triangles of a neighbour, a diagonal taken for
/// the other, rows taken for columns, and a scale, of either sign, that is forgotten somewhere.
#[test]
fn random_hills() {
    run(400, 5_000, |seed, tally| {
        let random = &mut Random(seed);
        let cells = [1 + random.bits() as usize % 14, 1 + random.bits() as usize % 11];
        let sign = |random: &mut Random| if random.bits().is_multiple_of(4) { -1.0 } else { 1.0 };
        let mut length = |low, high| random.range(low, high) * sign(random);
        let scale = Vec3::new(length(2.0, 6.0), length(0.2, 2.0), length(2.0, 6.0));
        let grid = Grid::hills(random, cells, scale);
        let mesh = some_mesh(random);
        let pose = random.pose(2.0);
        tally.check(&grid, &mesh, &pose, [0.0, 0.02, 0.3][seed as usize % 3])
    });
}

/// Corners on corners, edges on edges, faces in one plane, boxes that end on a grid line;
/// degenerate triangles. Would catch a bound that leaves out what just touches.
#[test]
fn lattices() {
    run(200, 20_000, |seed, tally| {
        let random = &mut Random(seed);
        let grid = Grid::lattice(random, [10, 8]);
        let mesh = lattice_soup(random, 20, 3);
        let turn = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2 * (seed % 4) as f32);
        let turn = [turn, Quat::from_xyzw(0.5, 0.5, 0.5, 0.5), Quat::IDENTITY][seed as usize % 3];
        let whole = |random: &mut Random, count: u64| (random.bits() % count) as f32;
        let at = Vec3::new(whole(random, 9) - 4.0, whole(random, 4) - 2.0, whole(random, 7) - 3.0);
        tally.check(&grid, &mesh, &Pose3::from_parts(at, turn), [0.0, 1.0, 0.5][seed as usize % 3])
    });
}

/// The same from a ten-thousandth to a million units, with a field much larger than the mesh and
/// far off its middle, where its f32 corners are rough. Would catch a rounding that is not allowed
/// for, and tolerances that are not relative.
#[test]
fn huge_and_tiny() {
    run(250, 5_000, |seed, tally| {
        let random = &mut Random(seed);
        let size = [1e-4, 1e-2, 1.0, 1e3, 1e6][seed as usize % 5];
        let spread = [1.0, 30.0][random.bits() as usize % 2];
        let cells = [24, 24];
        // Cells of 0.3 units, or of 9 units; 7 or 216 units in all.
        let scale = size * Vec3::new(7.2 * spread, 1.0, 7.2 * spread);
        let grid = Grid::hills(random, cells, scale);
        let mesh = scaled(&some_mesh(random), size);
        let corner = size * 3.0 * spread;
        let shift = Vec3::new(random.range(-corner, corner), 0.0, random.range(-corner, corner));
        let pose = Pose3::from_parts(shift + size * random.vector(0.6), random.rotation());
        tally.check(&grid, &mesh, &pose, size * [0.0, 0.02][random.bits() as usize % 2])
    });
}

/// Quaternions slightly off unit length scale the mesh. Would catch a margin or a box that does not
/// grow with it.
#[test]
fn rotations_that_scale() {
    run(150, 3_000, |seed, tally| {
        let random = &mut Random(seed);
        let grid = Grid::hills(random, [9, 9], Vec3::new(4.0, 0.5, 4.0));
        let mesh = some_mesh(random);
        let turn = random.rotation() * random.range(0.9, 1.1);
        tally.check(&grid, &mesh, &Pose3::from_parts(random.vector(1.0), turn), 0.05)
    });
}

/// A box is ruled out only where no triangle in it comes within the margin: and it often is. Would
/// catch a test of the root box that drops contacts, or that never says no.
#[test]
fn boxes_are_ruled_out_rightly() {
    let (mut met, mut ruled_out, mut over_the_field) = (0, 0, 0);
    for seed in 0..600 {
        let random = &mut Random(seed);
        let grid = Grid::hills(random, [12, 7], Vec3::new(5.0, 1.0, 5.0));
        let mesh = scaled(&some_mesh(random), 0.4);
        let pose = random.pose(3.0);
        let corners = || mesh.vertices.iter().copied();
        let aabb = Aabb {
            min: corners().fold(Vec3::INFINITY, Vec3::min),
            max: corners().fold(Vec3::NEG_INFINITY, Vec3::max),
        };
        let margin = [0.0, 0.05][seed as usize % 2];
        let placement = Placement::new(&pose);
        if FieldFrame::new(&grid, &placement, margin).meets(TestedBox::new(aabb.min, aabb.max), ())
        {
            met += 1;
        } else {
            let lost = pairs_within(&grid, &mesh, &pose, f64::from(margin));
            assert!(lost.is_empty(), "case {seed}: {lost:?}");
            ruled_out += 1;
            let is_over = |x: &DVec3| x.x.abs().max(x.z.abs()) < 2.4;
            over_the_field += usize::from(placed(&mesh, &pose).as_flattened().iter().all(is_over));
        }
    }
    let counts = (met, ruled_out, over_the_field);
    assert!(met > 100 && ruled_out > 100 && over_the_field > 30, "{counts:?}");
}
