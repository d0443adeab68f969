use std::collections::BTreeSet;
use std::ops::RangeInclusive;

use glamx::{DVec3, Pose3, Vec3};
use sbbk_core::traverse::Placement;

use super::grid::Grid;
use super::oracle::{found, placed, tree};
use crate::support::{Random, Soup, bumpy_ball};

/// Waves of three units over square cells of a tenth of a unit, the same about the middle however
/// many there are.
fn waves(cells: usize) -> Grid {
    let at = |line: usize| 0.1 * (line as f32 - 0.5 * cells as f32);
    let scale = Vec3::new(0.1 * cells as f32, 1.0, 0.1 * cells as f32);
    Grid::new([cells, cells], scale, |column, row| {
        0.3 * (2.1 * at(column)).sin() * (1.7 * at(row)).cos()
    })
}

/// The columns and rows under the box around some points of the field's frame, one more at either
/// end for rounding.
fn under(grid: &Grid, points: &[DVec3], margin: f64) -> [RangeInclusive<usize>; 2] {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min) - margin;
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max) + margin;
    [0, 2].map(|axis| {
        let count = grid.cells[axis / 2];
        let line = |x: f64| {
            let cell = ((x / f64::from(grid.scale[axis]) + 0.5) * count as f64).floor();
            cell.clamp(0.0, count as f64 - 1.0) as usize
        };
        line(low[axis]).saturating_sub(1)..=line(high[axis]) + 1
    })
}

/// The corners of the box around a mesh, turned with it.
fn turned_box(mesh: &Soup, pose: &Pose3) -> Vec<DVec3> {
    let corners = || mesh.vertices.iter().copied();
    let low = corners().fold(Vec3::INFINITY, Vec3::min);
    let high = corners().fold(Vec3::NEG_INFINITY, Vec3::max);
    let placement = Placement::new(pose);
    let corner = |i: usize| Vec3::from_array([0, 1, 2].map(|k| [low, high][i >> k & 1][k]));
    (0..8).map(|i| placement.to_frame1(corner(i), Vec3::ZERO)).collect()
}

/// No triangle of a cell is compared that is not under the mesh, and no line of heights read that
/// is not under its box, turned with it: anywhere, over the edge of the field, above it and across
/// it. Would catch ranges that are too wide, or asked for a part of the mesh that is elsewhere.
#[test]
fn only_what_is_under_the_mesh_is_read() {
    let (grid, mesh) = (waves(200), bumpy_ball(10, 0.1));
    let tree = tree(&mesh);
    let mut compared = 0;
    for seed in 0..100 {
        let random = &mut Random(seed);
        let mut pose = random.pose(1.0);
        pose.translation *= Vec3::new(10.0, 1.3, 10.0);
        grid.asked.take();
        found(&grid, &tree, &pose, 0.02);
        let asked = grid.asked.take();
        let corners = placed(&mesh, &pose).concat();
        let [columns, rows] = under(&grid, &corners, 0.02);
        let strays: Vec<_> =
            asked.cells.iter().filter(|[c, r]| !columns.contains(c) || !rows.contains(r)).collect();
        assert!(strays.is_empty(), "case {seed}: {strays:?} are not under {columns:?}, {rows:?}");
        let [columns, _] = under(&grid, &turned_box(&mesh, &pose), 0.02);
        // A cell has a line at either end.
        let lines = *columns.start()..=columns.end() + 1;
        let is_under = |line: &usize| lines.contains(line);
        assert!(asked.lines.iter().all(is_under), "case {seed}: {:?}, not {lines:?}", asked.lines);
        compared += asked.cells.len();
    }
    assert!(compared > 5000, "only {compared} cells");
}

/// Cells are compared triangle by triangle only where a leaf's box reaches the surface. Would catch
/// a descent that does not look at heights.
#[test]
fn a_mesh_above_the_ground_compares_nothing() {
    let (grid, tree) = (waves(100), tree(&bumpy_ball(8, 0.1)));
    for height in [1.6, -1.6, 40.0] {
        grid.asked.take();
        let pose = Pose3::translation(0.3, height, 0.7);
        let (pairs, _) = found(&grid, &tree, &pose, 0.02);
        assert!(pairs.is_empty());
        assert!(grid.asked.take().cells.is_empty(), "cells were compared at {height}");
    }
}

/// A field of a million cells costs what a small one does. Would catch any work that grows with the
/// field.
#[test]
fn a_million_cells_cost_what_is_under_the_mesh() {
    let mesh = bumpy_ball(10, 0.1);
    let tree = tree(&mesh);
    let visit = |cells: usize, shift: f32| {
        let grid = waves(cells);
        let pose = Pose3::translation(0.04 + shift, 0.9, 0.07);
        let (pairs, counts) = found(&grid, &tree, &pose, 0.02);
        let half = cells as isize / 2;
        let centred = |line: usize| line as isize - half;
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
    assert!(large_counts.cells < 12 * 22 * 22, "{large_counts:?}");
    // Far from the middle, in a corner, and beside it.
    let (_, far) = visit(1000, 48.0);
    assert!(far.cells < 12 * 22 * 22, "{far:?}");
    let (pairs, beside) = visit(1000, 60.0);
    assert_eq!((pairs.len(), beside.cells), (0, 0));
}
