//! The nine slab directions of an 18-DOP, and other directions as their sums.
//!
//! All directions have components in {-1, 0, 1}, so that a projection is a sum without products.
//! They are not normalised: a margin `m` between two slabs is `m·|d|` in their coordinates.
//!
//! # Correspondence
//!
//! Two trees of bodies turned against each other have different slabs. Zachmann (*Rapid Collision
//! Detection by Dynamically Aligned DOP-Trees*, 1998) writes a direction `b` of tree 1, seen in the
//! frame of tree 2, as a combination of three directions of tree 2 with non-negative coefficients,
//! `b = c₁·d₁ + c₂·d₂ + c₃·d₃`. For every point x of a node of tree 2 then `b·x = Σ cᵢ (dᵢ·x) <= Σ
//! cᵢ maxᵢ`. This bound takes 3 multiply-adds and is conservative for any node by LP weak duality.
//! It is tight when the three directions are adjacent, as they then share a vertex of the k-DOP's
//! prototype.
//!
//! The triple needs no search. The set is symmetric under all permutations and sign changes of the
//! axes. Sort the components, `x >= y >= z >= 0`; the cone that contains `b` follows:
//!
//! | sorted components | directions | coefficients |
//! |---|---|---|
//! | `x >= y + z` | (1,0,0), (1,1,0), (1,0,1) | `x - y - z`, `y`, `z` |
//! | else | (0,1,1), (1,1,0), (1,0,1) | `(y + z - x)/2`, `(x + y - z)/2`, `(x + z - y)/2` |

use std::ops::{Add, Sub};

use glamx::{DVec3, Vec3};

/// Number of slabs of a k-DOP: half of k = 18.
pub const SLABS: usize = 9;

/// The direction of each slab: the faces of a cube, which are the axes of the box, and its edges.
pub const DIRECTIONS: [Vec3; SLABS] = [
    d(1, 0, 0),
    d(0, 1, 0),
    d(0, 0, 1),
    d(1, 1, 0),
    d(1, -1, 0),
    d(1, 0, 1),
    d(1, 0, -1),
    d(0, 1, 1),
    d(0, 1, -1),
];

const fn d(x: i8, y: i8, z: i8) -> Vec3 {
    Vec3::new(x as f32, y as f32, z as f32)
}

/// The projections of a point, or of a lane of points, on all directions.
///
/// Written out: `x·0 + y·1 + z·1` costs three products that no compiler may leave out.
#[inline(always)]
pub fn project<T>([x, y, z]: [T; 3]) -> [T; SLABS]
where
    T: Copy + Add<Output = T> + Sub<Output = T>,
{
    [x, y, z, x + y, x - y, x + z, x - z, y + z, y - z]
}

/// Writes `direction` as a non-negative combination of three adjacent directions. Returns each
/// slab's index and coefficient, negative where the slab's opposite direction is meant.
#[inline]
pub fn correspondence(direction: DVec3) -> [(usize, f64); 3] {
    let magnitude = direction.abs();
    let negative = direction.to_array().map(|component| usize::from(component < 0.0));
    let [x, y, z] = descending_axes(magnitude);
    let (is_beyond, coefficients) = coefficients(descending(magnitude));
    let first = if is_beyond { edge(negative, y, z) } else { (x, negative[x]) };
    let slabs = [first, edge(negative, x, y), edge(negative, x, z)];
    let term = |i: usize| {
        let (slab, is_opposite) = slabs[i];
        (slab, [1.0, -1.0][is_opposite] * coefficients[i])
    };
    [term(0), term(1), term(2)]
}

/// The slab of an edge of the cube in the plane of two axes, and 1 where its opposite direction is
/// meant. `negative` is 1 for axes along which the edge lies below the middle.
#[inline(always)]
fn edge(negative: [usize; 3], one: usize, other: usize) -> (usize, usize) {
    let differ = negative[one] ^ negative[other];
    (1 + 2 * (one + other) + differ, negative[one.min(other)])
}

/// True beyond the face between the cones, and the coefficients of the direction with components
/// `x >= y >= z >= 0`.
#[inline(always)]
fn coefficients(s: DVec3) -> (bool, [f64; 3]) {
    // There, half of the deficit goes to the two shared members.
    let beyond = s.x - s.y - s.z;
    let half = 0.5 * smaller(beyond, 0.0);
    (beyond < 0.0, [larger(beyond, -0.5 * beyond), s.y + half, s.z + half])
}

/// The axes from the largest component to the smallest.
#[inline(always)]
fn descending_axes(DVec3 { x, y, z }: DVec3) -> [usize; 3] {
    let [x_before_y, y_before_z, x_before_z] = [x >= y, y >= z, x >= z].map(usize::from);
    let mut axes = [0; 3];
    axes[2 - x_before_y - x_before_z] = 0;
    axes[1 + x_before_y - y_before_z] = 1;
    axes[y_before_z + x_before_z] = 2;
    axes
}

/// The components from the largest to the smallest. Any order if one is NaN.
#[inline(always)]
fn descending(DVec3 { x, y, z }: DVec3) -> DVec3 {
    let (high, low) = (larger(x, y), smaller(x, y));
    DVec3::new(larger(high, z), larger(low, smaller(high, z)), smaller(low, z))
}

/// The larger of two numbers in one instruction, which `f64::max` is not.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::Random;

    /// Would catch a direction outside of the cone that the table gives it.
    #[test]
    fn coefficients_of_sorted_directions_are_not_negative() {
        let mut random = Random(11);
        for _ in 0..10_000 {
            let sorted = descending(random.vector(1.0).abs().as_dvec3());
            assert!(coefficients(sorted).1.into_iter().all(|c| c >= -1e-15), "{sorted:?}");
        }
    }
}
