//! The direction sets of the k-DOPs: which slabs a [`Kdop`](super::Kdop) has, and how a direction
//! of another frame is written in them.
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
//! cᵢ maxᵢ`: a bound for 3 multiply-adds, conservative for any node by LP weak duality, and tight
//! when the three directions are adjacent, as they then share a vertex of the k-DOP's prototype.
//!
//! No search is needed for the triple. The sets are symmetric under all permutations and sign
//! changes of the axes, so sort the components, `x >= y >= z >= 0`; the cone that contains `b`
//! follows:
//!
//! | k | cone, sorted components | coefficients |
//! |---|---|---|
//! | 14 | (1,0,0), (1,1,1), (1,1,-1) | `x - y`, `(y + z)/2`, `(y - z)/2` |
//! | 18 | (1,0,0), (1,1,0), (1,0,1) if `x >= y + z` | `x - y - z`, `y`, `z` |
//! | 18 | (0,1,1), (1,1,0), (1,0,1) else | `(y + z - x)/2`, `(x + y - z)/2`, `(x + z - y)/2` |
//! | 26 | (1,0,0), (1,1,0), (1,1,1) | `x - y`, `y - z`, `z` |

use std::ops::{Add, Sub};

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

/// A member of a direction set: components in {-1, 0, 1}.
#[doc(hidden)]
pub type Member = [i8; 3];

/// The slab of a direction, and its sign there.
type Slab = (u8, i8);

/// By [`member_index`].
type SlabTable = [Slab; 27];

/// The slabs of a cone's members, by the [`code`] of a direction in it.
type ConeTable = [[Slab; 3]; 128];

/// A set of directions that is closed under the symmetries of the cube. Sealed: an unsupported k
/// does not compile.
pub trait DirectionSet<const AXES: usize>: sealed::Sealed {
    /// The slabs' directions, one of each opposite two. The first three are x, y and z.
    const DIRECTIONS: [Vec3; AXES];

    /// The members of the cones of directions with components `x >= y >= z >= 0`; twice the same
    /// where there is one.
    #[doc(hidden)]
    const CONES: [[Member; 3]; 2];

    #[doc(hidden)]
    const SLABS: ConeTable = cone_table(&Self::DIRECTIONS, &Self::CONES);

    /// The projections of a point on all directions. Written out, as `x·0 + y·1 + z·1` costs three
    /// products that no compiler may leave out; fitting k-DOPs was a tenth of a build.
    #[inline]
    fn project(point: Vec3) -> Slabs<AXES> {
        Self::project_components(point.to_array())
    }

    /// The same for one point or a lane of several. Hidden, as only the crate calls it.
    #[doc(hidden)]
    fn project_components<T: Component>(components: [T; 3]) -> [T; AXES];

    /// Which cone contains the direction with components `x >= y >= z >= 0`, and the coefficients of
    /// its members. Hidden, as only the crate and its tests call it.
    #[doc(hidden)]
    fn coefficients(sorted: DVec3) -> (usize, [f64; 3]);

    /// `direction` as a non-negative combination of three adjacent directions of the set: for each
    /// the slab's index and the coefficient, negative where the slab's opposite direction is meant.
    /// Which they are is read from a table: sorting axes and turning members took twice the time of
    /// it all.
    #[inline]
    fn correspondence(direction: DVec3) -> [(usize, f64); 3] {
        let magnitude = direction.abs();
        let (cone, coefficients) = Self::coefficients(descending(magnitude));
        let slabs = &Self::SLABS[code(direction, magnitude, cone)];
        let term = |i: usize| {
            let (slab, sign) = slabs[i];
            (usize::from(slab), f64::from(sign) * coefficients[i])
        };
        [term(0), term(1), term(2)]
    }
}

/// A coordinate of one point, or of several in lanes.
#[doc(hidden)]
pub trait Component: Copy + Add<Output = Self> + Sub<Output = Self> {}

impl<T: Copy + Add<Output = Self> + Sub<Output = Self>> Component for T {}

/// Where a member stands in a [`SlabTable`].
const fn member_index([x, y, z]: Member) -> usize {
    (9 * (x + 1) + 3 * (y + 1) + (z + 1)) as usize
}

const fn slab_table(directions: &[Vec3]) -> SlabTable {
    let mut table = [(0, 0); 27];
    let mut slab = 0;
    while slab < directions.len() {
        let d = directions[slab];
        let member = [d.x as i8, d.y as i8, d.z as i8];
        table[member_index(member)] = (slab as u8, 1);
        table[member_index([-member[0], -member[1], -member[2]])] = (slab as u8, -1);
        slab += 1;
    }
    table
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

/// What each [`code`] stands for. Some orders are none: nothing is asked of these.
const fn cone_table(directions: &[Vec3], cones: &[[Member; 3]; 2]) -> ConeTable {
    let slabs = slab_table(directions);
    let mut table = [[(0, 0); 3]; 128];
    let mut code = 0;
    while code < table.len() {
        let [x_before_y, y_before_z, x_before_z] = [code & 1, code >> 1 & 1, code >> 2 & 1];
        // How many components are before each.
        let ranks =
            [2 - x_before_y - x_before_z, 1 + x_before_y - y_before_z, y_before_z + x_before_z];
        let mut i = 0;
        while i < 3 {
            let mut member = [0; 3];
            let mut axis = 0;
            while axis < 3 {
                let sign = 1 - 2 * (code >> (3 + axis) & 1) as i8;
                member[axis] = sign * cones[code >> 6][i][ranks[axis]];
                axis += 1;
            }
            table[code][i] = slabs[member_index(member)];
            i += 1;
        }
        code += 1;
    }
    table
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
    const CONES: [[Member; 3]; 2] = [[[1, 0, 0], [1, 1, 1], [1, 1, -1]]; 2];

    #[inline(always)]
    fn project_components<T: Component>([x, y, z]: [T; 3]) -> [T; 7] {
        let [a, b] = [x + y, x - y];
        [x, y, z, a + z, a - z, b + z, b - z]
    }

    #[inline(always)]
    fn coefficients(s: DVec3) -> (usize, [f64; 3]) {
        (0, [s.x - s.y, 0.5 * (s.y + s.z), 0.5 * (s.y - s.z)])
    }
}

impl DirectionSet<9> for Directions<9> {
    const DIRECTIONS: [Vec3; 9] = concatenate([&FACES, &EDGES, &[]]);
    const CONES: [[Member; 3]; 2] =
        [[[1, 0, 0], [1, 1, 0], [1, 0, 1]], [[0, 1, 1], [1, 1, 0], [1, 0, 1]]];

    #[inline(always)]
    fn project_components<T: Component>([x, y, z]: [T; 3]) -> [T; 9] {
        [x, y, z, x + y, x - y, x + z, x - z, y + z, y - z]
    }

    #[inline(always)]
    fn coefficients(s: DVec3) -> (usize, [f64; 3]) {
        // Beyond the face that both cones have, half of what is missing goes to its two members.
        let beyond = s.x - s.y - s.z;
        let half = 0.5 * smaller(beyond, 0.0);
        (usize::from(beyond < 0.0), [larger(beyond, -0.5 * beyond), s.y + half, s.z + half])
    }
}

impl DirectionSet<13> for Directions<13> {
    const DIRECTIONS: [Vec3; 13] = concatenate([&FACES, &EDGES, &CORNERS]);
    const CONES: [[Member; 3]; 2] = [[[1, 0, 0], [1, 1, 0], [1, 1, 1]]; 2];

    #[inline(always)]
    fn project_components<T: Component>([x, y, z]: [T; 3]) -> [T; 13] {
        let [a, b] = [x + y, x - y];
        [x, y, z, a, b, x + z, x - z, y + z, y - z, a + z, a - z, b + z, b - z]
    }

    #[inline(always)]
    fn coefficients(s: DVec3) -> (usize, [f64; 3]) {
        (0, [s.x - s.y, s.y - s.z, s.z])
    }
}

/// The components from the largest to the smallest. Any if one is NaN: then nothing overlaps anyway.
#[inline(always)]
fn descending(DVec3 { x, y, z }: DVec3) -> DVec3 {
    let (high, low) = (larger(x, y), smaller(x, y));
    DVec3::new(larger(high, z), larger(low, smaller(high, z)), smaller(low, z))
}

/// One instruction, as `f64::max` is not.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
