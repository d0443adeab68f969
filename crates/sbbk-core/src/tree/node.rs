//! The runtime layout of a tree.
//!
//! An inner node stores the volumes of its *two children*, lane by lane. A simultaneous descent
//! compares the children of two nodes at once, and reads these four volumes together. The volume of
//! a node is therefore in its parent, at a [`Slot`].

use glamx::Vec3;
use wide::f32x4;

use crate::simd::{PerChild, V3, each};
use crate::volumes::rounding::{HalfLength, centre_extent};
use crate::volumes::{Aabb, Kdop, SLABS, directions};

/// Greatest number of triangles in a leaf, and lanes of the triangle test.
pub const BATCH: usize = 4;

/// An inner node or a leaf, as a packed word.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) struct Link(u32);

impl Link {
    const LEAF_BIT: u32 = 1 << 31;
    /// The largest node or leaf number. Two bits are spare: a [`Slot`] doubles node numbers.
    pub(crate) const MAX_INDEX: u32 = (1 << 30) - 1;
    /// The link of a lane without a child.
    pub(super) const NONE: Self = Self(u32::MAX);

    pub(super) fn inner(node: u32) -> Self {
        debug_assert!(node <= Self::MAX_INDEX);
        Self(node)
    }

    pub(super) fn leaf(leaf: u32) -> Self {
        debug_assert!(leaf <= Self::MAX_INDEX);
        Self(leaf | Self::LEAF_BIT)
    }

    /// Returns true for a leaf.
    pub(crate) fn is_leaf(self) -> bool {
        self.0 & Self::LEAF_BIT != 0
    }

    /// The number of the leaf or the inner node.
    pub(crate) fn index(self) -> u32 {
        self.0 & !Self::LEAF_BIT
    }
}

/// The place of a node's volume: an inner node and a lane.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Slot(u32);

impl Slot {
    /// The root of any tree.
    pub(crate) const ROOT: Self = Self(0);

    pub(crate) fn new(node: u32, lane: usize) -> Self {
        Self(node << 1 | lane as u32)
    }

    /// The inner node that holds the volume.
    pub(crate) fn node(self) -> u32 {
        self.0 >> 1
    }

    /// The lane of the volume in that node.
    pub(crate) fn lane(self) -> usize {
        (self.0 & 1) as usize
    }
}

/// The children of an inner node: intervals along the axes of boxes, or along all slabs of k-DOPs.
/// The first three slabs are the box.
#[derive(Copy, Clone, Debug)]
pub(super) struct Pair<const COUNT: usize> {
    pub(super) centre: [PerChild<f32>; COUNT], // 8 · COUNT
    pub(super) extent: [PerChild<HalfLength>; COUNT], // 4 · COUNT
    pub(super) links: [Link; 2],               // 8
}
const _: () = assert!(size_of::<Pair<3>>() == 44 && size_of::<Pair<9>>() == 116);

impl<const COUNT: usize> Pair<COUNT> {
    pub(super) const EMPTY: Self = Self {
        centre: [[0.0; 2]; COUNT],
        extent: [[HalfLength::NONE; 2]; COUNT],
        links: [Link::NONE; 2],
    };

    /// Sets a child from the ends of its intervals.
    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, link: Link, min: &[f32; COUNT], max: &[f32; COUNT]) {
        self.links[lane] = link;
        for axis in 0..COUNT {
            (self.centre[axis][lane], self.extent[axis][lane]) =
                centre_extent(min[axis], max[axis]);
        }
    }
}

/// Intervals of two children along the axes of boxes, or along all slabs of k-DOPs.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Intervals<'a, const COUNT: usize> {
    pub(crate) centre: &'a [PerChild<f32>; COUNT],
    /// Half-lengths.
    pub(crate) extent: &'a [PerChild<HalfLength>; COUNT],
}

/// The children of an inner node of either layer.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Children<'a> {
    pub(crate) boxes: Intervals<'a, 3>,
    /// Present in the k-DOP layers.
    pub(crate) kdops: Option<Intervals<'a, SLABS>>,
    pub(crate) links: &'a [Link; 2],
}

impl<'a> Children<'a> {
    pub(super) fn from_aabbs(pair: &'a Pair<3>) -> Self {
        let boxes = Intervals { centre: &pair.centre, extent: &pair.extent };
        Self { boxes, kdops: None, links: &pair.links }
    }

    pub(super) fn from_kdops(pair: &'a Pair<SLABS>) -> Self {
        let kdops = Intervals { centre: &pair.centre, extent: &pair.extent };
        let boxes = Intervals { centre: box_of(kdops.centre), extent: box_of(kdops.extent) };
        Self { boxes, kdops: Some(kdops), links: &pair.links }
    }

    /// The box of one child.
    pub fn aabb(&self, lane: usize) -> Aabb {
        let [min, max] = self.boxes.ends(lane).map(Vec3::from_array);
        Aabb { min, max }
    }

    /// The k-DOP of one child, in the k-DOP layers.
    pub fn kdop(&self, lane: usize) -> Option<Kdop> {
        self.kdops.map(|kdops| {
            let [min, max] = kdops.ends(lane);
            Kdop { min, max }
        })
    }
}

#[inline(always)]
fn box_of<T>(slabs: &[T; SLABS]) -> &[T; 3] {
    slabs.first_chunk().expect("every direction set starts with x, y and z")
}

impl<const COUNT: usize> Intervals<'_, COUNT> {
    /// The lower and the upper ends of one child's intervals.
    fn ends(&self, lane: usize) -> [[f32; COUNT]; 2] {
        let end = |sign: f32| {
            std::array::from_fn(|i| self.centre[i][lane] + sign * f32::from(self.extent[i][lane]))
        };
        [end(-1.0), end(1.0)]
    }
}

/// Up to [`BATCH`] triangles, lane by lane. Unused lanes repeat the last triangle.
#[derive(Copy, Clone, Debug)]
#[repr(C, align(16))]
pub struct LeafBatch {
    /// `corners[corner][axis][lane]`.
    pub(crate) corners: [[[f32; BATCH]; 3]; 3], // 144
    /// Indices of the triangles in the mesh.
    pub(crate) triangles: [u32; BATCH], // 16
}
const _: () = assert!(size_of::<LeafBatch>() == 160);

impl LeafBatch {
    /// A batch of different triangles, given by indices and corners.
    ///
    /// # Panics
    /// Panics unless there are 1 to [`BATCH`] triangles.
    #[inline]
    pub fn gather(members: &[u32], corners_of: impl Fn(u32) -> [Vec3; 3]) -> Self {
        assert!((1..=BATCH).contains(&members.len()), "{} triangles in a batch", members.len());
        let mut batch = Self { corners: [[[0.0; BATCH]; 3]; 3], triangles: [0; BATCH] };
        for lane in 0..BATCH {
            let triangle = members[lane.min(members.len() - 1)];
            batch.triangles[lane] = triangle;
            for (corner, position) in corners_of(triangle).into_iter().enumerate() {
                for axis in 0..3 {
                    batch.corners[corner][axis][lane] = position[axis];
                }
            }
        }
        batch
    }

    /// Number of triangles.
    #[inline]
    pub fn count(&self) -> usize {
        let [a, b, c, d] = self.triangles;
        1 + usize::from(b != a) + usize::from(c != b) + usize::from(d != c)
    }

    /// Indices of the triangles in the mesh.
    #[inline]
    pub fn triangles(&self) -> &[u32] {
        &self.triangles[..self.count()]
    }

    /// The corners of all triangles, over lanes.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> [V3<f32x4>; 3] {
        each(|corner| each(|axis| f32x4::new(self.corners[corner][axis])))
    }

    /// The k-DOP around all triangles.
    pub fn kdop(&self) -> Kdop {
        let (mut low, mut high) =
            ([f32x4::splat(f32::INFINITY); SLABS], [f32x4::splat(f32::NEG_INFINITY); SLABS]);
        for corner in self.lanes() {
            let projections = directions::project(corner);
            for slab in 0..SLABS {
                low[slab] = low[slab].fast_min(projections[slab]);
                high[slab] = high[slab].fast_max(projections[slab]);
            }
        }
        Kdop::from_ends(reduce(&low, f32x4::fast_min), reduce(&high, f32x4::fast_max))
    }

    /// Index and corners of the triangle in a lane.
    #[inline(always)]
    pub(crate) fn triangle(&self, lane: usize) -> (u32, [Vec3; 3]) {
        (self.triangles[lane], self.corners(lane))
    }

    /// The corners of the triangle in `lane`.
    #[inline]
    pub fn corners(&self, lane: usize) -> [Vec3; 3] {
        each(|corner| {
            let [x, y, z] = &self.corners[corner];
            Vec3::new(x[lane], y[lane], z[lane])
        })
    }
}

/// Combines the lanes of each value, four values at a time by transposing them.
#[inline(always)]
fn reduce(values: &[f32x4; SLABS], combine: impl Fn(f32x4, f32x4) -> f32x4) -> [f32; SLABS] {
    let mut reduced = [0.0; SLABS];
    for first in (0..SLABS).step_by(BATCH) {
        let lane = |i: usize| values[(first + i).min(SLABS - 1)];
        let [a, b, c, d] = f32x4::transpose([lane(0), lane(1), lane(2), lane(3)]);
        let combined = combine(combine(a, b), combine(c, d)).to_array();
        let count = BATCH.min(SLABS - first);
        reduced[first..first + count].copy_from_slice(&combined[..count]);
    }
    reduced
}
