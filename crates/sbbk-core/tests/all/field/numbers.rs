use glamx::{Pose3, Quat, Vec3};
use sbbk_core::field::FieldFrame;
use sbbk_core::traverse::{Placement, TestedBox};
use sbbk_core::volumes::Aabb;

use super::grid::Grid;
use super::oracle::{Tally, found, tree};
use crate::support::{Random, bumpy_ball, soup};

const BAD: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

fn plain() -> Grid {
    Grid::new([10, 10], Vec3::new(5.0, 1.0, 5.0), |column, row| 0.01 * (column * row % 7) as f32)
}

/// Nothing is found at poses and margins that are none, and nothing panics; where all is well
/// something is.
#[test]
fn poses_and_margins_that_are_none() {
    let (grid, tree) = (plain(), tree(&bumpy_ball(5, 0.1)));
    let whole = Aabb { min: Vec3::splat(-1.2), max: Vec3::splat(1.2) };
    assert!(found(&grid, &tree, &Pose3::IDENTITY, 0.02).0.len() > 30);
    let shifts = BAD.into_iter().flat_map(|bad| {
        let zero = Vec3::ZERO;
        [zero.with_x(bad), zero.with_y(bad), zero.with_z(bad)].map(Pose3::from_translation)
    });
    let turns = BAD.map(|bad| Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(0.0, bad, 0.0, 1.0)));
    for pose in shifts.chain(turns) {
        assert!(found(&grid, &tree, &pose, 0.02).0.is_empty(), "{pose:?}");
        let placement = Placement::new(&pose);
        assert!(
            !FieldFrame::new(&grid, &placement, 0.02)
                .meets(TestedBox::new(whole.min, whole.max), ()),
            "{pose:?}"
        );
    }
    assert!(found(&grid, &tree, &Pose3::IDENTITY, f32::NAN).0.is_empty());
    let no_map = Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(0.0, 0.0, 0.0, 0.0));
    found(&grid, &tree, &no_map, 0.02);
}

/// A triangle with a corner that is NaN or infinite is a hole, its neighbours are not. Would catch
/// a range ruled out as one of its heights compares with nothing.
#[test]
fn heights_that_are_none_are_holes() {
    let mut tally = Tally::default();
    for seed in 0..60 {
        let random = &mut Random(seed);
        let bad = BAD[seed as usize % 3];
        let grid = Grid::new([12, 12], Vec3::new(5.0, 1.0, 5.0), |_, _| match random.bits() % 5 {
            0 => bad,
            _ => random.range(-0.3, 0.3),
        });
        let mesh = soup(random, 40, 0.4);
        tally.check(&grid, &mesh, &random.pose(1.0), 0.05).unwrap();
    }
    tally.finish(1000);
}

/// Fields of no width or no height, and whole fields of holes.
#[test]
fn scales_that_are_nothing() {
    for scale in [Vec3::new(5.0, 0.0, 5.0), Vec3::new(0.0, 1.0, 5.0), Vec3::new(5.0, 1.0, 0.0)] {
        let mut tally = Tally::default();
        for seed in 0..40 {
            let random = &mut Random(seed);
            let grid = Grid::hills(random, [6, 6], scale);
            let mesh = soup(random, 30, 0.5);
            tally.check(&grid, &mesh, &random.pose(0.5), 0.05).unwrap();
        }
        tally.finish(300);
    }
    let mut grid = plain();
    grid.statuses.fill(3);
    assert!(found(&grid, &tree(&bumpy_ball(5, 0.1)), &Pose3::IDENTITY, 0.1).0.is_empty());
}

/// Would catch a box that touches a field of no extent along an axis and is left out, and one found
/// on a field without cells.
#[test]
fn fields_of_no_extent_are_touched() {
    let touches = |grid: &Grid, min: Vec3, max: Vec3| {
        FieldFrame::new(grid, &Placement::new(&Pose3::IDENTITY), 0.0)
            .meets(TestedBox::new(min, max), ())
    };
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

/// Would catch a box far from the origin of its mesh that loses its lower end to the rounding of its
/// middle.
#[test]
fn ends_of_far_boxes_count() {
    let (random, far) = (&mut Random(1), 8192.0);
    let placement = Placement::new(&Pose3::translation(0.0, -far, 0.0));
    for _ in 0..1000 {
        // Coordinates that are exact; that in the middle of them is not.
        let [low, high] = [0.0, 1000.0].map(|x| random.range(x + 1.0, x + 1000.0).floor() / 1024.0);
        let grid = Grid::new([2, 2], Vec3::new(5.0, 1.0, 5.0), |_, _| low);
        let [min, max] = [Vec3::new(-1.0, far + low, -1.0), Vec3::new(1.0, far + high, 1.0)];
        let frame = FieldFrame::new(&grid, &placement, 0.0);
        assert!(frame.meets(TestedBox::new(min, max), ()), "{low} to {high}");
    }
}
