use std::collections::{BTreeMap, BTreeSet};

use glamx::{DVec3, Pose3, Vec3};
use sbbk_core::field::{FieldFrame, FieldTriangle};
use sbbk_core::traverse::{DescentCounts, Placement};
use sbbk_core::tree::{BuildOptions, Tree};
use sbbk_core::truth::contact;

use super::grid::Grid;
use crate::support::{Soup, descend_field};

/// A triangle of the field and one of the mesh.
pub type Pair = (FieldTriangle, u32);

pub fn tree(soup: &Soup) -> Tree {
    Tree::build(&soup.vertices, &soup.triangles, &BuildOptions::default()).expect("valid")
}

/// The triangles of a mesh in the frame of the field, in f64.
pub fn placed(soup: &Soup, pose: &Pose3) -> Vec<[DVec3; 3]> {
    let placement = Placement::new(pose);
    let corner = |i: u32| placement.to_frame1(soup.vertices[i as usize], Vec3::ZERO);
    soup.triangles.iter().map(|triangle| triangle.map(corner)).collect()
}

/// The signed distances of all pairs up to `margin`, by brute force over all cells. Boxes are
/// compared first, as most cells are far off.
pub fn pairs_within(grid: &Grid, soup: &Soup, pose: &Pose3, margin: f64) -> BTreeMap<Pair, f64> {
    let placed = placed(soup, pose);
    let bounds = |corners: &[DVec3; 3]| {
        let [a, b, c] = *corners;
        (a.min(b).min(c), a.max(b).max(c))
    };
    let mut pairs = BTreeMap::new();
    for column in 0..grid.cells[0] {
        for row in 0..grid.cells[1] {
            let cell = [column, row];
            for (side, triangle) in grid.triangles_at(cell).iter().enumerate() {
                let Some(triangle) = triangle.filter(|t| t.iter().all(|x| x.is_finite())) else {
                    continue;
                };
                let triangle = triangle.map(Vec3::as_dvec3);
                let (low1, high1) = bounds(&triangle);
                for (index, other) in placed.iter().enumerate() {
                    let (low2, high2) = bounds(other);
                    if (low1 - high2).max(low2 - high1).max_element() > 1.001 * margin {
                        continue;
                    }
                    let distance = contact(&triangle, other).distance;
                    if distance <= margin {
                        pairs.insert((FieldTriangle { cell, side }, index as u32), distance);
                    }
                }
            }
        }
    }
    pairs
}

/// What the descent finds, and its work. No pair may be found twice.
pub fn found(
    grid: &Grid,
    tree: &Tree,
    pose: &Pose3,
    margin: f32,
) -> (BTreeSet<Pair>, DescentCounts) {
    let placement = Placement::new(pose);
    let frame = FieldFrame::new(grid, &placement, margin);
    let mut found = BTreeSet::new();
    let counts = descend_field(tree, &frame, |triangle, index| {
        assert!(found.insert((triangle, index)), "{triangle:?} and {index} twice");
    });
    (found, counts)
}

/// How many pairs were true, and how many were found.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    pub true_count: usize,
    pub found_count: usize,
}

impl Tally {
    /// Compares one query with brute force: every pair within the margin is found, and no pair that
    /// is far beyond it.
    pub fn check(
        &mut self,
        grid: &Grid,
        soup: &Soup,
        pose: &Pose3,
        margin: f32,
    ) -> Result<(), String> {
        let (found, _) = found(grid, &tree(soup), pose, margin);
        let truth = pairs_within(grid, soup, pose, f64::from(margin));
        if let Some((pair, distance)) = truth.iter().find(|(pair, _)| !found.contains(pair)) {
            return Err(format!("{pair:?} is lost, {distance} apart of {margin}"));
        }
        if let Some(pair) = found.iter().find(|(triangle, _)| is_missing(grid, *triangle)) {
            return Err(format!("{pair:?} does not exist"));
        }
        self.true_count += truth.len();
        self.found_count += found.len();
        Ok(())
    }

    /// Panics unless there was enough to judge, and little was found that is not true.
    pub fn finish(self, least_count: usize) {
        let Self { true_count, found_count } = self;
        assert!(true_count >= least_count, "only {true_count} pairs");
        assert!(found_count <= true_count + true_count / 2, "{found_count} for {true_count}");
    }
}

fn is_missing(grid: &Grid, FieldTriangle { cell, side }: FieldTriangle) -> bool {
    let is_outside = cell[0] >= grid.cells[0] || cell[1] >= grid.cells[1];
    is_outside || grid.triangles_at(cell)[side].is_none()
}
