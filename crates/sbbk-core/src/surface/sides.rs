//! Sides of triangles: the body or nothing, by winding numbers that rays count.
//!
//! A ray from a point inside a closed surface leaves the surface once more than it enters. This
//! holds for triangle soups, T-junctions, doubled triangles and parts that overlap, and needs no
//! adjacency. Rays of one point disagree only as far as the surface is open.
//!
//! Source: Jacobson, Kavan, Sorkine-Hornung, *Robust Inside-Outside Segmentation using Generalized
//! Winding Numbers*, 2013. Their number is the mean over all rays.

use std::cell::{Cell, OnceCell};
use std::ops::ControlFlow;

use glamx::DVec3;

use super::Surface;
use super::memo::{Memo, PlaceMemo};
use super::rays::{Hit, Hits, RayTriangles, TIE, direction, hit, shortest, winding};
use super::triangle::{area_vector, depth_within, longest_side, meeting};
use super::twins::Components;

/// The body or nothing, in front of a triangle and behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Nothing in front, the body behind.
    Outer,
    /// The body in front, nothing behind.
    Turned,
    /// The body on both sides, everywhere: a wall within, or a part of another component.
    Inner,
    /// Nothing on either side.
    Sheet,
}

impl Side {
    /// Sign with which the normal of the triangle leads out of the body; `None` unless the body is
    /// on one side.
    #[inline]
    pub fn outward(self) -> Option<f64> {
        match self {
            Self::Outer => Some(1.0),
            Self::Turned => Some(-1.0),
            Self::Inner | Self::Sheet => None,
        }
    }
}

/// Distance from a triangle at which rays start, as a share of its longest side. Higher: thin
/// plates are sheets. Lower: rounding decides about walls that touch.
const OFFSET: f64 = 1.0e-4;

/// A choice of the rays of a triangle.
#[derive(Clone, Copy)]
struct Choice {
    /// Least sine of the angle with the triangle.
    steep: f64,
    /// Number of lines to choose from. The shortest line within the bounds of the mesh is taken.
    of: u32,
}

/// Higher sine: rays differ less. Lower: these graze walls. More lines: slower choice. Fewer: rays
/// run along wide levels, and meet all that stands there.
const STEEP: Choice = Choice { steep: 0.5, of: 8 };

/// [`STEEP`] of samples of a mesh. Higher sine: fewer rays leave through holes near the triangle.
/// Lower: rounding decides where rays start.
const ANY: Choice = Choice { steep: 0.02, of: 1 };

/// Distance of tested points from a triangle that meets another, as a share of the longest side.
/// Higher: narrow parts outside have no contacts. Lower: rays start on that triangle.
const BESIDE: f64 = 10.0 * OFFSET;

/// Distance of tested points from a corner, as a share of its distance from the middle. Higher:
/// more searches for triangles that meet. Lower: rays start on walls that meet at the corner.
const AT_CORNER: f64 = 0.05;

/// Places of tested points along the segment in which two triangles meet. More: slower. Fewer:
/// corners outside are missed.
const ALONG: [f64; 3] = [0.05, 0.5, 0.95];

/// Triangles that meet another and are tested at most. A triangle that meets more is a face.
/// Higher: slower. Lower: walls that others meet have contacts.
const MOST_MEETINGS: usize = 64;

/// Offset in the sequence of ray directions between successive triangles. Fewer: rays of neighbours
/// are alike.
const SHIFT: u32 = 17;

/// Number of triangles after which rays repeat. It is prime, so that no row of a regular mesh has
/// the same rays as the next.
const SHIFTS: u32 = 1009;

/// Finds the side of a triangle of a closed surface. Takes two rays if these find a face, else
/// more. Takes less time with a `surface`, as rays count closed components as they are.
pub fn side(
    triangles: &impl RayTriangles,
    surface: Option<&Surface>,
    triangle: u32,
    memo: &PlaceMemo,
) -> Side {
    RayMesh::with(triangles, surface, memo).side(triangle)
}

/// Returns the sign of the winding number of a closed mesh around a point, by two rays. It is 1
/// within the body, -1 within faces that lead inwards, and 0 elsewhere. `None` if the rays
/// disagree, as they may where the point is on the surface. Takes less time with a `surface`.
pub fn winding_sign(
    triangles: &impl RayTriangles,
    surface: Option<&Surface>,
    point: DVec3,
    memo: &PlaceMemo,
) -> Option<i32> {
    RayMesh::with(triangles, surface, memo).winding_sign(point)
}

/// Limit of the tests for walls. Walls count as faces beyond this limit.
#[derive(Clone, Copy)]
pub(super) struct WallLimit {
    /// Work limit, in triangles near rays. Higher: meshes of open parts in each other are slower.
    /// Lower: walls within such meshes have contacts.
    work: i64,
    /// True if others use the memo of walls. Known walls then count as new ones, so a side does not
    /// depend on these others.
    is_shared: bool,
}

impl WallLimit {
    /// The limit for the side of one triangle.
    pub(super) const SIDE: Self = Self { work: 4000, is_shared: true };

    /// The limit for a side if closed components are not known.
    const UNKNOWN: Self = Self { work: 100_000, is_shared: true };

    /// The limit for all samples of a mesh.
    pub(super) const MESH: Self = Self { work: 400_000, is_shared: false };
}

/// Work of a ray beside the triangles that it comes near.
const WORK_OF_RAY: i64 = 16;

/// The triangles of a mesh, with the components and walls that are known.
pub(super) struct RayMesh<'a, T> {
    pub(super) triangles: &'a T,
    /// `None`: no component is known to be closed.
    components: Option<&'a Components>,
    /// Walls that rays have met.
    pub(super) memo: &'a PlaceMemo,
    /// Triangles that rays have come near.
    work: Cell<i64>,
    /// Work that tests for walls may still take.
    left: Cell<i64>,
    limit: WallLimit,
}

impl<'a, T: RayTriangles> RayMesh<'a, T> {
    pub(super) fn new(
        triangles: &'a T,
        components: Option<&'a Components>,
        memo: &'a PlaceMemo,
        limit: WallLimit,
    ) -> Self {
        let (work, left) = (Cell::new(0), Cell::new(limit.work));
        Self { triangles, components, memo, work, left, limit }
    }

    /// Rays for one side or one point. They use the closed components of a known surface.
    fn with(triangles: &'a T, surface: Option<&'a Surface>, memo: &'a PlaceMemo) -> Self {
        let limit = if surface.is_some() { WallLimit::SIDE } else { WallLimit::UNKNOWN };
        let components = surface.and_then(|surface| surface.adjacency.components.as_ref());
        Self::new(triangles, components, memo, limit)
    }

    pub(super) fn is_exhausted(&self) -> bool {
        self.left.get() < 0
    }

    /// Finds the side of a triangle.
    pub(super) fn side(&self, triangle: u32) -> Side {
        let (first, is_sure) = self.sample(triangle, 0);
        if first == Side::Outer {
            return first;
        }
        let sample = |i| self.sample(triangle, i).0;
        let second = if is_sure { first } else { sample(1) };
        let is_doubted = second != first && second == sample(2);
        let side = if is_doubted { second } else { first };
        // A point is outside only if two pairs of rays say so: single rays pass where boxes are
        // flush.
        let is_inner_at = |start| {
            let mut rays = (0..2).filter_map(|i| Rays::new(self, triangle, start, i, STEEP));
            rays.any(|rays| rays.side_without_walls() == Side::Inner)
        };
        let is_face = side == Side::Inner && self.is_partly_outside(triangle, is_inner_at);
        if is_face { Side::Outer } else { side }
    }

    /// Returns the sign of the winding number around a point, if two rays agree. Many layers count
    /// as a body. A ray that only meets closed components, within triangles, cannot be wrong.
    pub(super) fn winding_sign(&self, point: DVec3) -> Option<i32> {
        let rays = Rays::from_point(self, point)?;
        let sign = |i| rays.winding(i, |other| self.counts(other)).map_or(1, i32::signum);
        let one = sign(0);
        (rays.is_exact.get() || one == sign(1)).then_some(one)
    }

    /// Returns the side of a triangle by a ray to the front, and by one to the back if the first
    /// does not tell both. A ray from a face to the back may leave through a triangle that is wound
    /// the other way. Also returns true if the rays cannot be wrong.
    fn sample(&self, triangle: u32, i: u32) -> (Side, bool) {
        let rays = Rays::from_middle(self, triangle, i, STEEP);
        let Some(rays) = rays else { return (Side::Sheet, false) };
        let leaves_turned = || rays.winding(1, |_| true).is_some_and(|back| back < 0);
        let side = match rays.side_without_walls() {
            Side::Sheet if leaves_turned() => Side::Outer,
            side => side,
        };
        (side, rays.is_exact.get())
    }

    /// Like [`sample`](Self::sample), with rays of any slope. A place within the body is no hole,
    /// so the rays need not leave out walls there.
    pub(super) fn sample_of_mesh(&self, triangle: u32, i: u32) -> Side {
        let Some(rays) = Rays::from_middle(self, triangle, i, ANY) else { return Side::Sheet };
        match rays.side(|_| true) {
            Side::Inner => Side::Inner,
            _ => rays.side_without_walls(),
        }
    }

    /// Returns true if rays from a triangle meet nothing on either side.
    pub(super) fn is_bare(&self, triangle: u32, i: u32) -> bool {
        Rays::from_middle(self, triangle, i, ANY).is_some_and(|rays| rays.meet_nothing())
    }

    /// Returns true if rays count a triangle: it is of a closed component, or no wall within the
    /// body.
    fn counts(&self, triangle: u32) -> bool {
        let is_wall = || {
            let is_inner_at = |start| {
                let rays = Rays::new(self, triangle, start, 0, STEEP);
                rays.is_some_and(|rays| rays.is_inner(|_| true))
            };
            is_inner_at(middle(&self.triangles.corners(triangle)))
                && !self.is_partly_outside(triangle, is_inner_at)
        };
        if self.is_of_closed(triangle) || self.is_exhausted() {
            return true;
        }
        let before = self.work.get();
        let find = || ((is_wall(), self.work.get() - before), usize::MAX);
        let (is_wall, work) = Memo::answer(Some(&self.memo.walls), triangle, find);
        let work = if self.limit.is_shared { work } else { self.work.get() - before };
        self.left.set(self.left.get() - work);
        !is_wall
    }

    /// True if the winding number behind each triangle is one more than in front. False for two
    /// closed layers at one place.
    fn are_steps_of_one(&self) -> bool {
        self.components.is_some_and(|known| known.is_manifold)
    }

    /// True if all components are known to be closed.
    pub(super) fn is_closed(&self) -> bool {
        self.components.is_some_and(Components::are_closed)
    }

    /// True if the component of a triangle is known to be closed.
    fn is_of_closed(&self, triangle: u32) -> bool {
        self.components.is_some_and(|known| !known.open.contains(triangle))
    }

    /// Returns true if part of a triangle may be outside of the body, though its middle is within.
    /// `is_inner_at` tells whether a point is within.
    ///
    /// Tests points near the corners, and on both sides of each triangle that meets this one. The
    /// border of the outer part runs along such triangles.
    fn is_partly_outside(&self, triangle: u32, is_inner_at: impl Fn(DVec3) -> bool) -> bool {
        let corners = self.triangles.corners(triangle);
        let Some(normal) = area_vector(&corners).try_normalize() else { return false };
        let size = longest_side(&corners);
        // Rays skip triangles within this distance.
        let slack = OFFSET * size;
        if corners.iter().any(|corner| !is_inner_at(corner.lerp(middle(&corners), AT_CORNER))) {
            return true;
        }
        // Rays that start near the border may skip a face that is flush with it.
        let least = 0.5 * BESIDE * size;
        let is_outside =
            |point: DVec3| depth_within(&corners, normal, point) > least && !is_inner_at(point);
        let mut tested = 0;
        let mut meets_outside = |other: u32| {
            let other = self.triangles.corners(other);
            let Some(([start, end], across)) = meeting(&corners, &other, slack) else {
                return false;
            };
            tested += 1;
            let beside = BESIDE * size * across;
            tested > MOST_MEETINGS
                || ALONG.into_iter().any(|at| {
                    let point = start.lerp(end, at);
                    is_outside(point + beside) || is_outside(point - beside)
                })
        };
        let mut is_partly_outside = false;
        self.triangles.near(triangle, slack, &mut |other| {
            is_partly_outside = other != triangle && meets_outside(other);
            if is_partly_outside { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        is_partly_outside
    }
}

fn middle([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (*a + *b + *c) / 3.0
}

/// A ray to the front of a triangle and one to the back.
struct Rays<'a, T> {
    mesh: &'a RayMesh<'a, T>,
    start: DVec3,
    to_front: DVec3,
    /// Length at which they begin.
    skipped: f64,
    /// Hits of both rays, the nearest first; `None` for [too many](MOST_HITS).
    hits: [OnceCell<Option<Hits>>; 2],
    /// True if rounding decides about no hit of the rays so far.
    is_exact: Cell<bool>,
}

impl<'a, T: RayTriangles> Rays<'a, T> {
    /// Rays number `i` from a point of a triangle; `None` for one without an area.
    fn new(
        mesh: &'a RayMesh<'a, T>,
        triangle: u32,
        start: DVec3,
        i: u32,
        Choice { steep, of }: Choice,
    ) -> Option<Self> {
        let corners = mesh.triangles.corners(triangle);
        let up = area_vector(&corners).try_normalize()?;
        let (across, along) = up.any_orthonormal_pair();
        let ways = (of * i..of * (i + 1)).map(|i| {
            let key = f64::from(i) + f64::from(SHIFT * (triangle % SHIFTS));
            let [x, y, z] = direction(key, steep);
            z * up + x * across + y * along
        });
        let to_front = shortest(ways, start, mesh.triangles.bounds())?;
        let skipped = OFFSET * longest_side(&corners) / up.dot(to_front);
        let (hits, is_exact) = (Default::default(), Cell::new(true));
        Some(Self { mesh, start, to_front, skipped, hits, is_exact })
    }

    /// Rays number `i` from the middle of a triangle; `None` for one without an area.
    fn from_middle(
        mesh: &'a RayMesh<'a, T>,
        triangle: u32,
        i: u32,
        choice: Choice,
    ) -> Option<Self> {
        Self::new(mesh, triangle, middle(&mesh.triangles.corners(triangle)), i, choice)
    }

    /// Two opposite rays from a point; `None` for a point that is not finite.
    fn from_point(mesh: &'a RayMesh<'a, T>, start: DVec3) -> Option<Self> {
        let ways = (0..STEEP.of).map(|i| direction(i.into(), 0.0).into());
        let to_front = shortest(ways, start, mesh.triangles.bounds())?;
        start.is_finite().then(|| Self {
            mesh,
            start,
            to_front,
            skipped: 0.0,
            hits: Default::default(),
            is_exact: Cell::new(true),
        })
    }

    /// Returns the side that the rays find. Walls within the body count as nothing, unless the rays
    /// find a face with them.
    fn side_without_walls(&self) -> Side {
        let found = self.side(|_| true);
        if found == Side::Outer { found } else { self.side(|other| self.mesh.counts(other)) }
    }

    /// What the rays find if only triangles count for which `counts` is true.
    fn side(&self, counts: impl Fn(u32) -> bool) -> Side {
        let Some(front) = self.winding(0, &counts) else { return Side::Outer };
        let is_behind = if self.mesh.are_steps_of_one() {
            front >= 0
        } else {
            self.winding(1, &counts).is_none_or(|back| back >= 1)
        };
        match (front, is_behind || front >= 1 && self.have_ties()) {
            (1.., true) => Side::Inner,
            (_, true) => Side::Outer,
            // Also a triangle of a solid that is wound the other way.
            (1.. | ..=-1, false) => Side::Turned,
            (0, false) => Side::Sheet,
        }
    }

    /// True if triangles that a ray meets are flush. Rays from within may then count too few.
    fn have_ties(&self) -> bool {
        self.hits.iter().filter_map(|hits| hits.get()?.as_ref()).any(|hits| {
            let is_tie = |pair: &[Hit]| pair[1].length - pair[0].length <= TIE * pair[1].length;
            hits.windows(2).any(is_tie)
        })
    }

    /// True if neither ray meets a triangle.
    fn meet_nothing(&self) -> bool {
        (0..2).all(|i| self.all_hits(i).is_some_and(Hits::is_empty))
    }

    /// True if the body is in front. Takes one ray.
    fn is_inner(&self, counts: impl Fn(u32) -> bool) -> bool {
        self.winding(0, counts).is_some_and(|front| front >= 1)
    }

    /// The winding number that the ray to the front (0) or to the back (1) finds; `None` for too
    /// many hits.
    fn winding(&self, i: usize, counts: impl Fn(u32) -> bool) -> Option<i32> {
        Some(winding(self.all_hits(i)?.iter().filter(|hit| counts(hit.triangle))))
    }

    /// Returns the hits of the ray to the front (0) or to the back (1); `None` if there are too
    /// many.
    fn all_hits(&self, i: usize) -> Option<&Hits> {
        let direction = [self.to_front, -self.to_front][i];
        self.hits[i].get_or_init(|| self.hits(direction)).as_ref()
    }

    fn hits(&self, direction: DVec3) -> Option<Hits> {
        let (mut hits, mut is_full) = (Hits::new(), false);
        let mut work = WORK_OF_RAY;
        self.mesh.triangles.along(self.start, direction, &mut |triangle| {
            work += 1;
            let corners = self.mesh.triangles.corners(triangle).map(|corner| corner - self.start);
            let Some((length, sign, is_at_border)) = hit(&corners, direction) else {
                return ControlFlow::Continue(());
            };
            let is_exact = !is_at_border && self.mesh.is_of_closed(triangle);
            if !is_exact {
                self.is_exact.set(false);
            }
            if length <= self.skipped {
                return ControlFlow::Continue(());
            }
            is_full = hits.try_push(Hit { length, sign, triangle, is_exact }).is_err();
            if is_full { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        if is_full {
            self.is_exact.set(false);
        }
        self.mesh.work.set(self.mesh.work.get() + work);
        hits.sort_unstable_by(|a, b| a.length.total_cmp(&b.length));
        (!is_full).then_some(hits)
    }
}
