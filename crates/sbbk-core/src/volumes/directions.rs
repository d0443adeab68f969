//! The direction sets of the k-DOPs: which slabs a [`Kdop`](super::Kdop) has, and how a direction of
//! another frame is written in them.
//!
//! All directions have components in {-1, 0, 1}, so that a projection is a sum without products.
//! They are not normalised: a margin `m` between two slabs is `m·|d|` in their coordinates.
//!
//! # Correspondence
//!
//! Two trees of bodies turned against each other have different slabs. Zachmann (*Rapid Collision
//! Detection by Dynamically Aligned DOP-Trees*, 1998) writes a direction `b` of tree 1, seen in the
//! frame of tree 2, as a combination of three directions of tree 2 with non-negative coefficients,
//! `b = c₁·d₁ + c₂·d₂ + c₃·d₃`. For every point x of a node of tree 2 then
//! `b·x = Σ cᵢ (dᵢ·x) <= Σ cᵢ maxᵢ`: a bound for 3 multiply-adds, conservative for any node by LP weak
//! duality, and tight when the three directions are adjacent, as they then share a vertex of the
//! k-DOP's prototype.
//!
//! No search is needed for the triple. The sets are symmetric under all permutations and sign changes of
//! the axes, so sort the components, `x >= y >= z >= 0`; the cone that contains `b` follows:
//!
//! | k | cone, sorted components | coefficients |
//! |---|---|---|
//! | 14 | (1,0,0), (1,1,1), (1,1,-1) | `x - y`, `(y + z)/2`, `(y - z)/2` |
//! | 18 | (1,0,0), (1,1,0), (1,0,1) if `x >= y + z` | `x - y - z`, `y`, `z` |
//! | 18 | (1,1,0), (1,0,1), (0,1,1) else | `(x + y - z)/2`, `(x + z - y)/2`, `(y + z - x)/2` |
//! | 26 | (1,0,0), (1,1,0), (1,1,1) | `x - y`, `y - z`, `z` |

use glamx::{DVec3, Vec3};

/// Marker for the slab counts that have a direction set: 7, 9 and 13 (k = 14, 18, 26).
#[derive(Copy, Clone, Debug)]
pub struct Directions<const AXES: usize>;

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Directions<7> {}
    impl Sealed for super::Directions<9> {}
    impl Sealed for super::Directions<13> {}
}

/// One value a slab.
pub type Slabs<const AXES: usize> = [f32; AXES];

/// A set of directions that is closed under the symmetries of the cube. Sealed: an unsupported k does
/// not compile.
pub trait DirectionSet<const AXES: usize>: sealed::Sealed {
    /// The slabs' directions, one of each opposite two. The first three are x, y and z.
    const DIRECTIONS: [Vec3; AXES];

    /// The cone of three adjacent directions that contains the direction with components
    /// `x >= y >= z >= 0`, with their coefficients.
    fn cone(sorted: DVec3) -> [(DVec3, f64); 3];

    /// `direction` as a non-negative combination of three adjacent directions of the set: for each the
    /// slab's index and the coefficient, negative where the slab's opposite direction is meant.
    fn correspondence(direction: DVec3) -> [(usize, f64); 3] {
        let order = descending_order(direction.abs());
        let sign = |axis: usize| if direction[axis] < 0.0 { -1.0 } else { 1.0 };
        let sorted = DVec3::from_array(order.map(|axis| direction[axis].abs()));
        Self::cone(sorted).map(|(canonical, coefficient)| {
            let mut member = DVec3::ZERO;
            for (rank, axis) in order.into_iter().enumerate() {
                member[axis] = canonical[rank] * sign(axis);
            }
            let (slab, sign) = slab_of(&Self::DIRECTIONS, member.as_vec3());
            (slab, sign * coefficient)
        })
    }
}

const fn d(x: i8, y: i8, z: i8) -> Vec3 {
    Vec3::new(x as f32, y as f32, z as f32)
}

const FACES: [Vec3; 3] = [d(1, 0, 0), d(0, 1, 0), d(0, 0, 1)];
const EDGES: [Vec3; 6] =
    [d(1, 1, 0), d(1, -1, 0), d(1, 0, 1), d(1, 0, -1), d(0, 1, 1), d(0, 1, -1)];
const CORNERS: [Vec3; 4] = [d(1, 1, 1), d(1, 1, -1), d(1, -1, 1), d(1, -1, -1)];

/// The sets one after the other; `AXES` must be the sum of their sizes.
const fn concatenate<const AXES: usize>(sets: [&[Vec3]; 3]) -> [Vec3; AXES] {
    let mut all = [Vec3::ZERO; AXES];
    let mut filled = 0;
    let mut set = 0;
    while set < sets.len() {
        let mut i = 0;
        while i < sets[set].len() {
            all[filled] = sets[set][i];
            filled += 1;
            i += 1;
        }
        set += 1;
    }
    assert!(filled == AXES);
    all
}

impl DirectionSet<7> for Directions<7> {
    const DIRECTIONS: [Vec3; 7] = concatenate([&FACES, &CORNERS, &[]]);

    fn cone(s: DVec3) -> [(DVec3, f64); 3] {
        [
            (DVec3::new(1.0, 0.0, 0.0), s.x - s.y),
            (DVec3::new(1.0, 1.0, 1.0), 0.5 * (s.y + s.z)),
            (DVec3::new(1.0, 1.0, -1.0), 0.5 * (s.y - s.z)),
        ]
    }
}

impl DirectionSet<9> for Directions<9> {
    const DIRECTIONS: [Vec3; 9] = concatenate([&FACES, &EDGES, &[]]);

    fn cone(s: DVec3) -> [(DVec3, f64); 3] {
        let (edge_xy, edge_xz) = (DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 0.0, 1.0));
        if s.x >= s.y + s.z {
            [(DVec3::new(1.0, 0.0, 0.0), s.x - s.y - s.z), (edge_xy, s.y), (edge_xz, s.z)]
        } else {
            [
                (edge_xy, 0.5 * (s.x + s.y - s.z)),
                (edge_xz, 0.5 * (s.x + s.z - s.y)),
                (DVec3::new(0.0, 1.0, 1.0), 0.5 * (s.y + s.z - s.x)),
            ]
        }
    }
}

impl DirectionSet<13> for Directions<13> {
    const DIRECTIONS: [Vec3; 13] = concatenate([&FACES, &EDGES, &CORNERS]);

    fn cone(s: DVec3) -> [(DVec3, f64); 3] {
        [
            (DVec3::new(1.0, 0.0, 0.0), s.x - s.y),
            (DVec3::new(1.0, 1.0, 0.0), s.y - s.z),
            (DVec3::new(1.0, 1.0, 1.0), s.z),
        ]
    }
}

/// The axes from the largest component to the smallest.
fn descending_order(v: DVec3) -> [usize; 3] {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| v[j].total_cmp(&v[i]));
    order
}

/// The slab whose direction is `member` or its opposite, and which of the two (1 or -1).
fn slab_of(directions: &[Vec3], member: Vec3) -> (usize, f64) {
    let length_squared = member.length_squared();
    for (slab, direction) in directions.iter().enumerate() {
        let dot = direction.dot(member);
        if dot.abs() == length_squared && direction.length_squared() == length_squared {
            return (slab, f64::from(dot.signum()));
        }
    }
    // Reached for NaN directions only, where nothing overlaps anyway.
    (0, f64::NAN)
}
