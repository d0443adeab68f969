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
//! | 18 | (1,1,0), (1,0,1), (0,1,1) else | `(x + y - z)/2`, `(x + z - y)/2`, `(y + z - x)/2` |
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

/// The slab of a direction and its sign there; by [`member_index`].
type SlabTable = [(u8, i8); 27];

/// A set of directions that is closed under the symmetries of the cube. Sealed: an unsupported k
/// does not compile.
pub trait DirectionSet<const AXES: usize>: sealed::Sealed {
    /// The slabs' directions, one of each opposite two. The first three are x, y and z.
    const DIRECTIONS: [Vec3; AXES];

    #[doc(hidden)]
    const SLABS: SlabTable = slab_table(&Self::DIRECTIONS);

    /// The projections of a point on all directions. Written out, as `x·0 + y·1 + z·1` costs three
    /// products that no compiler may leave out; fitting k-DOPs was a tenth of a build.
    #[inline]
    fn project(point: Vec3) -> Slabs<AXES> {
        Self::project_components(point.to_array())
    }

    /// The same for one point or a lane of several. Hidden, as only the crate calls it.
    #[doc(hidden)]
    fn project_components<T: Component>(components: [T; 3]) -> [T; AXES];

    /// The cone of three adjacent directions that contains the direction with components `x >= y >=
    /// z >= 0`, with their coefficients. Hidden, as only the crate and its tests call it.
    #[doc(hidden)]
    fn cone(sorted: DVec3) -> [(Member, f64); 3];

    /// `direction` as a non-negative combination of three adjacent directions of the set: for each
    /// the slab's index and the coefficient, negative where the slab's opposite direction is meant.
    #[inline]
    fn correspondence(direction: DVec3) -> [(usize, f64); 3] {
        let magnitude = direction.abs().to_array();
        let order = descending_order(magnitude);
        let [x, y, z] = order;
        let cone = Self::cone(DVec3::new(magnitude[x], magnitude[y], magnitude[z]));
        let signs = direction.to_array().map(|component| if component < 0.0 { -1 } else { 1 });
        let term = |i: usize| {
            let (canonical, coefficient) = cone[i];
            let mut member = [0; 3];
            for rank in 0..3 {
                member[order[rank]] = canonical[rank] * signs[order[rank]];
            }
            let (slab, sign) = Self::SLABS[member_index(member)];
            (usize::from(slab), f64::from(sign) * coefficient)
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

    #[inline(always)]
    fn project_components<T: Component>([x, y, z]: [T; 3]) -> [T; 7] {
        let [a, b] = [x + y, x - y];
        [x, y, z, a + z, a - z, b + z, b - z]
    }

    #[inline]
    fn cone(s: DVec3) -> [(Member, f64); 3] {
        [([1, 0, 0], s.x - s.y), ([1, 1, 1], 0.5 * (s.y + s.z)), ([1, 1, -1], 0.5 * (s.y - s.z))]
    }
}

impl DirectionSet<9> for Directions<9> {
    const DIRECTIONS: [Vec3; 9] = concatenate([&FACES, &EDGES, &[]]);

    #[inline(always)]
    fn project_components<T: Component>([x, y, z]: [T; 3]) -> [T; 9] {
        [x, y, z, x + y, x - y, x + z, x - z, y + z, y - z]
    }

    #[inline]
    fn cone(s: DVec3) -> [(Member, f64); 3] {
        let (edge_xy, edge_xz) = ([1, 1, 0], [1, 0, 1]);
        if s.x >= s.y + s.z {
            [([1, 0, 0], s.x - s.y - s.z), (edge_xy, s.y), (edge_xz, s.z)]
        } else {
            [
                (edge_xy, 0.5 * (s.x + s.y - s.z)),
                (edge_xz, 0.5 * (s.x + s.z - s.y)),
                ([0, 1, 1], 0.5 * (s.y + s.z - s.x)),
            ]
        }
    }
}

impl DirectionSet<13> for Directions<13> {
    const DIRECTIONS: [Vec3; 13] = concatenate([&FACES, &EDGES, &CORNERS]);

    #[inline(always)]
    fn project_components<T: Component>([x, y, z]: [T; 3]) -> [T; 13] {
        let [a, b] = [x + y, x - y];
        [x, y, z, a, b, x + z, x - z, y + z, y - z, a + z, a - z, b + z, b - z]
    }

    #[inline]
    fn cone(s: DVec3) -> [(Member, f64); 3] {
        [([1, 0, 0], s.x - s.y), ([1, 1, 0], s.y - s.z), ([1, 1, 1], s.z)]
    }
}

/// The axes from the largest component to the smallest. Not sorted if one is NaN: then nothing
/// overlaps anyway.
#[inline]
fn descending_order(v: [f64; 3]) -> [usize; 3] {
    let mut order = [0, 1, 2];
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if v[order[i]] < v[order[j]] {
            order.swap(i, j);
        }
    }
    order
}
