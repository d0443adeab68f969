//! New volumes for a mesh whose vertices have moved.
//!
//! The hierarchy stays as it was built; corners and volumes are computed anew, children before
//! parents (van den Bergen, *Efficient Collision Detection of Complex Deformable Models using AABB
//! Trees*, 1997). The walk is depth first, which is the order in which `pack.rs` lays out the k-DOP
//! layers, and hands each volume up by its ends: only what is stored is turned into centre and
//! half-length, so nothing is rounded twice and the volumes are those of a build.
//!
//! A leaf projects the corners of its four triangles in lanes, and reduces four slabs at a time by
//! transposing them.

use glamx::Vec3;
use wide::f32x4;

use super::node::{LeafBatch, Link, Pair};
use super::{BuildError, Tree, check_mesh};
use crate::volumes::{Aabb, DirectionSet, Directions, Kdop, Sphere};

/// How good a tree is, fitted to a mesh that has deformed since its build.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RefitCost {
    /// [`BuildStats::sah_cost`](super::BuildStats::sah_cost) of the build.
    pub built: f32,
    /// The same measure now.
    pub now: f32,
}

impl RefitCost {
    /// Growth of the cost from which on a build is advised. A build takes about as long as eleven
    /// refits. Lower: builds that save little. Higher: descents that visit more nodes than needed,
    /// in proportion.
    pub const REBUILD_AT: f32 = 2.0;

    /// Whether a tree built anew would pay soon.
    pub fn needs_rebuild(&self) -> bool {
        self.now > Self::REBUILD_AT * self.built
    }
}

impl<const AXES: usize> Tree<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// Fits all volumes to the mesh with its vertices where they are now; the triangles must be
    /// those of the build. Linear in the size of the mesh, and nothing is allocated.
    ///
    /// Boxes and k-DOPs are exactly as tight as those of a build with this hierarchy. The sphere is
    /// centred in the box of the vertices, and somewhat larger than a build's. [`Tree::stats`]
    /// stays that of the build.
    ///
    /// ```
    /// # use glamx::Vec3;
    /// # use sbbk_core::tree::{BuildOptions, Tree};
    /// let mut vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// let mut tree: Tree = Tree::build(&vertices, &triangles, &BuildOptions::default())?;
    /// vertices[3] *= 2.0;
    /// let cost = tree.refit(&vertices, &triangles)?;
    /// assert_eq!(tree.validate(), Ok(()));
    /// assert!(!cost.needs_rebuild());
    /// # Ok::<(), sbbk_core::tree::BuildError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Tree::build`] about the mesh, and [`BuildError::OtherTriangleCount`]. The tree is
    /// unchanged then.
    pub fn refit(
        &mut self,
        vertices: &[Vec3],
        triangles: &[[u32; 3]],
    ) -> Result<RefitCost, BuildError> {
        if triangles.len() != self.triangle_count as usize {
            let tree_count = self.triangle_count;
            return Err(BuildError::OtherTriangleCount { count: triangles.len(), tree_count });
        }
        let centre = survey(vertices, triangles)?;
        let root_link = self.aabb_pairs[0].links[0];
        let mut refit = Refit {
            vertices,
            triangles,
            aabb_pairs: &mut self.aabb_pairs,
            kdop_pairs: &mut self.kdop_pairs,
            leaves: &mut self.leaves,
            centre: centre.to_array().map(f32x4::splat),
            farthest_squared: f32x4::ZERO,
            cost: 0.0,
        };
        let root = refit.aabb(root_link);
        let (farthest_squared, cost) = (refit.farthest_squared, refit.cost);
        self.aabb_pairs[0].set(0, root_link, root.min.as_ref(), root.max.as_ref());
        self.magnitude = root.magnitude();
        if let Some(sphere) = &mut self.sphere {
            let farthest = farthest_squared.to_array().into_iter().fold(0.0, f32::max).sqrt();
            *sphere = Sphere::reaching(centre, farthest);
        }
        let root_area = root.half_area();
        let now = if root_area > 0.0 { cost / root_area } else { 0.0 };
        Ok(RefitCost { built: self.stats.sah_cost, now })
    }
}

/// Checks the mesh as a build does, and returns a centre for the sphere: the middle of the
/// vertices, used or not, as any centre will do.
fn survey(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Vec3, BuildError> {
    let mut bounds = Aabb::EMPTY;
    // Stays zero while all is finite: a test without branches.
    let mut poison = Vec3::ZERO;
    for &vertex in vertices {
        let smaller = |a: f32, b: f32| if a < b { a } else { b };
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        for axis in 0..3 {
            bounds.min[axis] = smaller(vertex[axis], bounds.min[axis]);
            bounds.max[axis] = larger(vertex[axis], bounds.max[axis]);
        }
        poison += vertex * 0.0;
    }
    let highest = triangles.as_flattened().iter().fold(0, |highest, &vertex| vertex.max(highest));
    if poison != Vec3::ZERO || highest as usize >= vertices.len() {
        // Says what is wrong, unless no triangle uses it.
        check_mesh(vertices, triangles)?;
        let first = triangles.first().map_or(Vec3::ZERO, |triangle| vertices[triangle[0] as usize]);
        return Ok(first);
    }
    Ok(bounds.centre())
}

/// A refit under way.
struct Refit<'a, const AXES: usize> {
    vertices: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    aabb_pairs: &'a mut [Pair<3>],
    kdop_pairs: &'a mut [Pair<AXES>],
    leaves: &'a mut [LeafBatch],
    /// Of the sphere, each coordinate in all lanes.
    centre: [f32x4; 3],
    /// Squared distance of the farthest corner so far, lane by lane.
    farthest_squared: f32x4,
    /// The sum over all nodes so far that [`BuildStats::sah_cost`](super::BuildStats::sah_cost)
    /// has.
    cost: f32,
}

/// The recursions are as deep as the tree, and `build.rs` bounds that: 94 levels for 2³⁰ triangles.
impl<const AXES: usize> Refit<'_, AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// The box of a node whose parent is in an AABB layer.
    fn aabb(&mut self, link: Link) -> Aabb {
        let index = link.index() as usize;
        if link.is_leaf() {
            let [min, max] = self.leaf(index, |corner| corner).map(Vec3::from_array);
            return self.charged(Aabb { min, max }, self.leaves[index].count());
        }
        let Some(pair) = self.aabb_pairs.get(index) else {
            return self.kdop_pair(index - self.aabb_pairs.len()).aabb();
        };
        let links = pair.links;
        let second = self.aabb(links[1]);
        let children = [self.aabb(links[0]), second];
        for (lane, Aabb { min, max }) in children.iter().enumerate() {
            self.aabb_pairs[index].set(lane, links[lane], min.as_ref(), max.as_ref());
        }
        self.charged(children[0].merge(&children[1]), 2)
    }

    /// The k-DOP of a node whose parent is in a k-DOP layer.
    fn kdop(&mut self, link: Link) -> Kdop<AXES> {
        let index = link.index() as usize;
        if link.is_leaf() {
            let [min, max] = self.leaf(index, Directions::<AXES>::project_components);
            let kdop = Kdop::of_projections(min, max);
            self.charged(kdop.aabb(), self.leaves[index].count());
            return kdop;
        }
        self.kdop_pair(index - self.aabb_pairs.len())
    }

    /// The k-DOP around both children of an inner node of the k-DOP layers.
    fn kdop_pair(&mut self, pair: usize) -> Kdop<AXES> {
        let links = self.kdop_pairs[pair].links;
        // The build goes on with the second child, so its nodes come first in memory.
        let second = self.kdop(links[1]);
        let children = [self.kdop(links[0]), second];
        for (lane, Kdop { min, max }) in children.iter().enumerate() {
            self.kdop_pairs[pair].set(lane, links[lane], min, max);
        }
        let merged = children[0].merge(&children[1]);
        self.charged(merged.aabb(), 2);
        merged
    }

    /// The box, added to the cost with the tests that a query in it takes.
    #[inline(always)]
    fn charged(&mut self, aabb: Aabb, tests: usize) -> Aabb {
        self.cost += aabb.half_area() * tests as f32;
        aabb
    }

    /// Gives a leaf its corners; returns the least and the largest of their projections.
    #[inline(always)]
    fn leaf<const N: usize>(
        &mut self,
        leaf: usize,
        project: impl Fn([f32x4; 3]) -> [f32x4; N],
    ) -> [[f32; N]; 2] {
        let batch = &mut self.leaves[leaf];
        // Written out, here and below: `array::map` is not inlined, and its way over the stack was
        // a third of a refit.
        let [a, b, c, d] = batch.triangles;
        let triangle = |triangle: u32| self.triangles[triangle as usize];
        let members = [triangle(a), triangle(b), triangle(c), triangle(d)];
        for corner in 0..3 {
            let point = |lane: usize| {
                let Vec3 { x, y, z } = self.vertices[members[lane][corner] as usize];
                f32x4::new([x, y, z, 0.0])
            };
            let [x, y, z, _] = f32x4::transpose([point(0), point(1), point(2), point(3)]);
            batch.corners[corner] = [x.to_array(), y.to_array(), z.to_array()];
            let [cx, cy, cz] = self.centre;
            let (dx, dy, dz) = (x - cx, y - cy, z - cz);
            self.farthest_squared = self.farthest_squared.fast_max(dx * dx + dy * dy + dz * dz);
        }
        batch.ends(project)
    }
}
