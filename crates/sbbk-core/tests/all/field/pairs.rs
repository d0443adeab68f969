use super::grid::Grid;
use super::{Tally, bounds, found, meets, pairs_within, placed, tree};
use crate::prelude::*;

const BAD: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

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

/// A field, a mesh, its pose and the margin.
type Case = (Grid, Soup, Pose3, f32);

/// Scales of either sign.
fn hills(random: &mut Random) -> Case {
    let cells = [1 + random.bits() as usize % 14, 1 + random.bits() as usize % 11];
    let mut length = |low, high| {
        let sign = if random.bits().is_multiple_of(4) { -1.0 } else { 1.0 };
        random.range(low, high) * sign
    };
    let scale = Vec3::new(length(2.0, 6.0), length(0.2, 2.0), length(2.0, 6.0));
    let (grid, mesh) = (Grid::hills(random, cells, scale), some_mesh(random));
    (grid, mesh, random.pose(2.0), [0.0, 0.02, 0.3][random.bits() as usize % 3])
}

/// Corners on corners, edges on edges, faces in one plane, boxes that end on a grid line,
/// degenerate triangles.
fn lattices(random: &mut Random) -> Case {
    let (grid, mesh) = (Grid::lattice(random, [10, 8]), lattice_soup(random, 20, 3));
    let turn = Quat::from_rotation_y(FRAC_PI_2 * (random.bits() % 4) as f32);
    let turns = [turn, Quat::from_xyzw(0.5, 0.5, 0.5, 0.5), Quat::IDENTITY];
    let turn = turns[random.bits() as usize % 3];
    let mut whole = |count: u64| (random.bits() % count) as f32;
    let at = Vec3::new(whole(9) - 4.0, whole(4) - 2.0, whole(7) - 3.0);
    (grid, mesh, Pose3::from_parts(at, turn), [0.0, 1.0, 0.5][random.bits() as usize % 3])
}

/// From a ten-thousandth to a million units; the mesh may be far from the middle of the field,
/// where corners in f32 are rough.
fn huge_and_tiny(random: &mut Random) -> Case {
    let size = [1e-4, 1e-2, 1.0, 1e3, 1e6][random.bits() as usize % 5];
    let spread = [1.0, 30.0][random.bits() as usize % 2];
    let scale = size * Vec3::new(7.2 * spread, 1.0, 7.2 * spread);
    let grid = Grid::hills(random, [24, 24], scale);
    let mesh = scaled(&some_mesh(random), size);
    let corner = size * 3.0 * spread;
    let shift = Vec3::new(random.range(-corner, corner), 0.0, random.range(-corner, corner));
    let pose = Pose3::from_parts(shift + size * random.vector(0.6), random.rotation());
    (grid, mesh, pose, size * [0.0, 0.02][random.bits() as usize % 2])
}

/// Quaternions that are not of unit length scale the mesh.
fn scaling_rotations(random: &mut Random) -> Case {
    let grid = Grid::hills(random, [9, 9], Vec3::new(4.0, 0.5, 4.0));
    let mesh = some_mesh(random);
    let turn = random.rotation() * random.range(0.9, 1.1);
    (grid, mesh, Pose3::from_parts(random.vector(1.0), turn), 0.05)
}

/// Triangles with a NaN or infinite corner are holes.
fn holes(random: &mut Random) -> Case {
    let bad = BAD[random.bits() as usize % 3];
    let grid = Grid::new([12, 12], Vec3::new(5.0, 1.0, 5.0), |_, _| match random.bits() % 5 {
        0 => bad,
        _ => random.range(-0.3, 0.3),
    });
    let mesh = soup(random, 40, 0.4);
    (grid, mesh, random.pose(1.0), 0.05)
}

/// Fields without extent along an axis.
fn flat(random: &mut Random) -> Case {
    let mut scale = Vec3::new(5.0, 1.0, 5.0);
    scale[random.bits() as usize % 3] = 0.0;
    let (grid, mesh) = (Grid::hills(random, [6, 6], scale), soup(random, 30, 0.5));
    (grid, mesh, random.pose(0.5), 0.05)
}

#[test]
fn descents_find_all_pairs_within_the_margin() {
    type Cases = [(fn(&mut Random) -> Case, u64, usize); 6];
    let cases: Cases = [
        (hills, 400, 5000),
        (lattices, 200, 20_000),
        (huge_and_tiny, 250, 5000),
        (scaling_rotations, 150, 3000),
        (holes, 60, 1000),
        (flat, 120, 900),
    ];
    for (case, count, least) in cases {
        let mut tally = Tally::default();
        for seed in 0..count {
            let (grid, mesh, pose, margin) = case(&mut Random(seed));
            tally.check(&grid, &mesh, &pose, margin);
        }
        tally.finish(least);
    }
}

#[test]
fn boxes_without_a_pair_within_the_margin_are_often_ruled_out() {
    let (mut met, mut ruled_out, mut over_the_field) = (0, 0, 0);
    for seed in 0..600 {
        let random = &mut Random(seed);
        let grid = Grid::hills(random, [12, 7], Vec3::new(5.0, 1.0, 5.0));
        let mesh = scaled(&some_mesh(random), 0.4);
        let pose = random.pose(3.0);
        let margin = [0.0, 0.05][seed as usize % 2];
        if meets(&grid, &pose, bounds(&mesh), margin) {
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

#[test]
fn non_finite_poses_and_margins_find_nothing() {
    let grid = Grid::new([10, 10], Vec3::new(5.0, 1.0, 5.0), |c, r| 0.01 * (c * r % 7) as f32);
    let tree = tree(&bumpy_ball(5, 0.1));
    let at = |pose: Pose3, margin| found(&grid, &tree, &pose, margin).0.len();
    assert!(at(Pose3::IDENTITY, 0.02) > 30);
    for bad in BAD {
        let shifts = Vec3::AXES.map(|axis| {
            Pose3::from_translation(Vec3::select(
                axis.cmpgt(Vec3::ZERO),
                Vec3::splat(bad),
                Vec3::ZERO,
            ))
        });
        let turn = Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(0.0, bad, 0.0, 1.0));
        for pose in shifts.into_iter().chain([turn]) {
            assert_eq!(at(pose, 0.02), 0, "{pose:?}");
            assert!(!meets(&grid, &pose, [Vec3::splat(-1.2), Vec3::splat(1.2)], 0.02), "{pose:?}");
        }
    }
    assert_eq!(at(Pose3::IDENTITY, f32::NAN), 0);
    // A rotation of zero scales the mesh to a point.
    at(Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(0.0, 0.0, 0.0, 0.0)), 0.02);
}

#[test]
fn boxes_touch_fields_without_extent_but_not_fields_without_cells() {
    let touches = |grid: &Grid, min, max| meets(grid, &Pose3::IDENTITY, [min, max], 0.0);
    for axis in 0..3 {
        let (mut scale, mut edge) = (Vec3::new(5.0, 1.0, 5.0), Vec3::ONE);
        (scale[axis], edge[axis]) = (0.0, 0.0);
        let grid = Grid::new([4, 4], scale, |_, _| 0.0);
        assert!(touches(&grid, -Vec3::ONE, edge) && touches(&grid, -edge, Vec3::ONE), "{axis}");
        let beyond = Vec3::AXES[axis] * 2.0;
        assert!(!touches(&grid, beyond - Vec3::ONE, beyond + Vec3::ONE), "{axis}");
        let empty = Grid::new([0, 0], scale, |_, _| 0.0);
        assert!(!touches(&empty, -Vec3::ONE, Vec3::ONE), "{axis}");
    }
}

/// The coordinates are exact; their middle is not.
#[test]
fn the_lower_end_of_a_box_far_from_the_origin_counts() {
    let (random, far) = (&mut Random(1), 8192.0);
    let pose = Pose3::translation(0.0, -far, 0.0);
    for _ in 0..1000 {
        let [low, high] = [0.0, 1000.0].map(|x| random.range(x + 1.0, x + 1000.0).floor() / 1024.0);
        let grid = Grid::new([2, 2], Vec3::new(5.0, 1.0, 5.0), |_, _| low);
        let ends = [Vec3::new(-1.0, far + low, -1.0), Vec3::new(1.0, far + high, 1.0)];
        assert!(meets(&grid, &pose, ends, 0.0), "{low} to {high}");
    }
}

/// Waves over square cells of a tenth of a unit, equal about the middle for any number of cells.
fn waves(cells: usize) -> Grid {
    let at = |line: usize| 0.1 * (line as f32 - 0.5 * cells as f32);
    let scale = Vec3::new(0.1 * cells as f32, 1.0, 0.1 * cells as f32);
    Grid::new([cells, cells], scale, |column, row| {
        0.3 * (2.1 * at(column)).sin() * (1.7 * at(row)).cos()
    })
}

#[test]
fn a_million_cells_cost_as_much_as_the_cells_under_the_mesh() {
    let tree = tree(&bumpy_ball(10, 0.1));
    let visit = |cells: usize, shift: f32| {
        let pose = Pose3::translation(0.04 + shift, 0.9, 0.07);
        let (pairs, counts) = found(&waves(cells), &tree, &pose, 0.02);
        let centred = |line: usize| line as isize - cells as isize / 2;
        let about_middle: BTreeSet<_> =
            pairs.iter().map(|(t, index)| (t.cell.map(centred), t.side, *index)).collect();
        (about_middle, counts)
    };
    let (small, small_counts) = visit(40, 0.0);
    let (large, large_counts) = visit(1000, 0.0);
    assert!(small.len() > 50, "{} pairs", small.len());
    assert_eq!(small, large);
    assert_eq!(small_counts.aabb_tests, large_counts.aabb_tests);
    assert_eq!(small_counts.cells, large_counts.cells);
    // 22 by 22 cells lie under the ball; each level of the tree may read them again.
    let [limit, corner] = [12 * 22 * 22, visit(1000, 48.0).1.cells];
    assert!(large_counts.cells < limit && corner < limit, "{large_counts:?} {corner}");
    let (pairs, beside) = visit(1000, 60.0);
    assert_eq!((pairs.len(), beside.cells), (0, 0));
}

#[test]
fn a_mesh_above_or_below_the_ground_finds_no_pair_after_few_cells() {
    let (grid, tree) = (waves(100), tree(&bumpy_ball(8, 0.1)));
    for height in [1.6, -1.6, 40.0] {
        let (pairs, counts) = found(&grid, &tree, &Pose3::translation(0.3, height, 0.7), 0.02);
        assert!(pairs.is_empty() && counts.cells < 5000, "{counts:?} at {height}");
    }
}
