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

/// The three directions that span each cone of sorted components.
const CONES: [[Member; 3]; 2] =
    [[[1, 0, 0], [1, 1, 0], [1, 0, 1]], [[0, 1, 1], [1, 1, 0], [1, 0, 1]]];

/// The three slabs of each [`code`].
const CONE_SLABS: [[Slab; 3]; 128] = cone_slabs();

/// A direction of a slab, or its opposite.
type Member = [i8; 3];

/// Index of a slab, and -1 where its opposite direction is meant.
type Slab = (u8, i8);

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
    let (cone, coefficients) = coefficients(descending(magnitude));
    let slabs = &CONE_SLABS[code(direction, magnitude, cone)];
    let term = |i: usize| {
        let (slab, sign) = slabs[i];
        (usize::from(slab), f64::from(sign) * coefficients[i])
    };
    [term(0), term(1), term(2)]
}

/// The cone that contains the direction with components `x >= y >= z >= 0`, and the coefficients
/// of its members.
#[inline(always)]
fn coefficients(s: DVec3) -> (usize, [f64; 3]) {
    // Beyond the face between the cones, half of the deficit goes to the two shared members.
    let beyond = s.x - s.y - s.z;
    let half = 0.5 * smaller(beyond, 0.0);
    (usize::from(beyond < 0.0), [larger(beyond, -0.5 * beyond), s.y + half, s.z + half])
}

/// The order of a direction's components, their signs and its cone, as bits.
#[inline(always)]
fn code(direction: DVec3, magnitude: DVec3, cone: usize) -> usize {
    let DVec3 { x, y, z } = magnitude;
    let order = [x >= y, y >= z, x >= z];
    let negative = direction.to_array().map(|component| component < 0.0);
    let bits = order.into_iter().chain(negative).enumerate();
    bits.fold(cone << 6, |code, (i, bit)| code | usize::from(bit) << i)
}

/// Fills the table of all codes. Codes of impossible orders are never looked up.
const fn cone_slabs() -> [[Slab; 3]; 128] {
    let mut table = [[(0, 0); 3]; 128];
    let mut code = 0;
    while code < table.len() {
        let [x_before_y, y_before_z, x_before_z] = [code & 1, code >> 1 & 1, code >> 2 & 1];
        // Rank of each component in descending order.
        let ranks =
            [2 - x_before_y - x_before_z, 1 + x_before_y - y_before_z, y_before_z + x_before_z];
        let mut i = 0;
        while i < 3 {
            let mut member = [0; 3];
            let mut axis = 0;
            while axis < 3 {
                let sign = 1 - 2 * (code >> (3 + axis) & 1) as i8;
                member[axis] = sign * CONES[code >> 6][i][ranks[axis]];
                axis += 1;
            }
            table[code][i] = slab_of(member);
            i += 1;
        }
        code += 1;
    }
    table
}

/// The slab of a member; slab 0 with sign 0 if none has this direction.
const fn slab_of([x, y, z]: Member) -> Slab {
    let mut slab = 0;
    while slab < SLABS {
        let d = DIRECTIONS[slab];
        let [dx, dy, dz] = [d.x as i8, d.y as i8, d.z as i8];
        if dx == x && dy == y && dz == z {
            return (slab as u8, 1);
        }
        if dx == -x && dy == -y && dz == -z {
            return (slab as u8, -1);
        }
        slab += 1;
    }
    (0, 0)
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
