//! Height fields against brute force over the triangles of all cells.

pub mod grid;
mod pairs;

use crate::prelude::*;
use grid::Grid;
use sbbk_core::field::{FieldFrame, FieldTriangle};
use sbbk_truth::contact;

/// A triangle of the field and one of the mesh.
type Pair = (FieldTriangle, u32);

fn tree(soup: &Soup) -> Tree {
    soup.tree(None)
}

/// Runs [`FieldFrame::meets`] for a box.
fn meets(grid: &Grid, pose: &Pose3, [min, max]: [Vec3; 2], margin: f32) -> bool {
    FieldFrame::new(grid, &Placement::new(pose), margin).meets(TestedBox::new(min, max))
}

/// The box around a mesh.
fn bounds(soup: &Soup) -> [Vec3; 2] {
    let vertices = || soup.vertices.iter().copied();
    [vertices().fold(Vec3::INFINITY, Vec3::min), vertices().fold(Vec3::NEG_INFINITY, Vec3::max)]
}

/// The triangles of a mesh in the frame of the field, in f64.
fn placed(soup: &Soup, pose: &Pose3) -> Vec<[DVec3; 3]> {
    let placement = Placement::new(pose);
    let corner = |i: u32| placement.to_frame1(soup.vertices[i as usize], Vec3::ZERO);
    soup.triangles.iter().map(|triangle| triangle.map(corner)).collect()
}

/// The signed distances of all pairs up to `margin`. Boxes are compared first, as most cells are
/// far.
fn pairs_within(grid: &Grid, soup: &Soup, pose: &Pose3, margin: f64) -> BTreeMap<Pair, f64> {
    let bounds = |[a, b, c]: [DVec3; 3]| (a.min(b).min(c), a.max(b).max(c));
    let mut pairs = BTreeMap::new();
    for (triangle, corners) in grid.all_triangles() {
        let (low1, high1) = bounds(corners);
        for (index, other) in placed(soup, pose).iter().enumerate() {
            let (low2, high2) = bounds(*other);
            if (low1 - high2).max(low2 - high1).max_element() > 1.001 * margin {
                continue;
            }
            let distance = contact(&corners, other).distance;
            if distance <= margin {
                pairs.insert((triangle, index as u32), distance);
            }
        }
    }
    pairs
}

/// The result of a descent, and its work. Panics if it finds a pair twice.
fn found(grid: &Grid, tree: &Tree, pose: &Pose3, margin: f32) -> (BTreeSet<Pair>, DescentCounts) {
    let placement = Placement::new(pose);
    let frame = FieldFrame::new(grid, &placement, margin);
    let mut found = BTreeSet::new();
    let counts = descend_field(tree, &frame, |triangle, index| {
        assert!(found.insert((triangle, index)), "{triangle:?} and {index} twice");
    });
    (found, counts)
}

/// Counts of true and found pairs.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    true_count: usize,
    found_count: usize,
}

impl Tally {
    /// Checks that a query finds every pair within the margin, and only existing triangles.
    fn check(&mut self, grid: &Grid, soup: &Soup, pose: &Pose3, margin: f32) {
        let (found, _) = found(grid, &tree(soup), pose, margin);
        let truth = pairs_within(grid, soup, pose, f64::from(margin));
        for (pair, distance) in &truth {
            assert!(
                found.contains(pair),
                "{pair:?} is lost, {distance} apart of {margin}: {soup:?} {grid:?}"
            );
        }
        assert!(found.iter().all(|(triangle, _)| grid.has(*triangle)), "{grid:?}");
        self.true_count += truth.len();
        self.found_count += found.len();
    }

    /// Panics unless there were enough true pairs and few others.
    fn finish(self, least_count: usize) {
        let Self { true_count, found_count } = self;
        assert!(true_count >= least_count, "only {true_count} pairs");
        assert!(found_count <= true_count + true_count / 2, "{found_count} for {true_count}");
    }
}
