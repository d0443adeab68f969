//! The first time at which two meshes, moving along a line against each other, come within a
//! distance.
//!
//! The distance of two triangles is a convex function of time, as triangles are convex. Newton's
//! method from the start,
//!
//! ```text
//! t ← t + (d(t) - target) / -(n(t)·v)
//! n: from the closest point of triangle 1 to that of triangle 2
//! ```
//!
//! never passes the first time of impact. There is no impact if the distance no longer falls. While
//! the closest features stay the same and include a face or are two edges, the distance is linear
//! in time and one step arrives. Over two meshes, a search with lower bounds of times finds the
//! earliest of all pairs.
//!
//! The later of two bounds counts. Boxes that move along a line overlap on an axis of frame 1
//! during an interval. They overlap on all three axes during the intersection (the slabs of a ray
//! against the Minkowski sum). Volumes with a gap need at least the gap over the speed.
//!
//! # Rounding
//!
//! The offset and the reach come from [`PairFrame`], conservative by its rounding. The velocity is
//! exact in frame 1. A quotient loses at most `γ_4`, and the target distance added to the reach
//! `γ_2`. Intervals start earlier and end later by `γ_8`.

use glamx::{DVec3, Vec3};
use wide::f32x4;

use crate::contact::{TriangleContact, contact};
use crate::simd::Spread;
use crate::traverse::{Along, NodeLanes, PairFrame, Placement, Toward};
use crate::tree::Tree;
use crate::volumes::rounding::gamma;

use super::seek::{BestNormal, FOUND, LowerBound, Pruned, SearchScratch, seek};
use super::triangles::{FoundPair, TrianglePair};

/// The definition of an impact.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct CastOptions {
    /// The latest time of interest.
    pub max_time: f32,
    /// Distance that counts as an impact; zero or more.
    pub target_distance: f32,
    /// True if triangles within the target distance at the start count even if they do not
    /// approach.
    pub stop_at_penetration: bool,
}

/// An impact.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Cast<P = FoundPair> {
    /// When, as a multiple of the velocity.
    pub time: f64,
    /// Both parts and their contact then. Mesh 2 has *moved* in a [`FoundPair`].
    pub pair: P,
    /// True if the parts are closer than the target distance, or cross, at the start.
    pub is_penetrating: bool,
}

/// A triangle pair has come as close as the target if it is this much farther, as a share of edges
/// and travel. At this share of the speed it does not approach. Higher: impacts are early by as
/// much. Lower: rounding keeps them from being noticed before the steps are used up.
const ARRIVED: f64 = 1.0e-12;

/// Difference of times that counts as none, as a share. Higher: later impacts count. Lower:
/// rounding tells the impacts of parallel faces apart, and a cast computes all of them.
const AT_ONCE: f64 = 1.0e-11;

/// Distance at the start, in target distances, up to which a body may slide along the other.
/// Higher: slower casts. Lower: rounding lets bodies that slide catch on edges within walls.
const NEAR_TARGET: f64 = 1.001;

/// Target distances that are tried before zero, and the ratio of each to the last one. More: more
/// time beside walls. Fewer: impacts that begin to count below the target distance are late.
const TARGETS: usize = 12;
const NEXT_TARGET: f32 = 0.75;

/// Steps of Newton's method. Grazing impacts gain a binary digit a step; others take two or three
/// steps.
const STEP_LIMIT: usize = 100;

/// Returns the first impact that `counts`. Mesh 2 is placed at `placement` in the frame of mesh 1
/// and moves by `velocity` there. Returns `None` without an impact until `options.max_time`, and
/// for NaN or infinite numbers.
pub fn cast(
    trees: (&Tree, &Tree),
    placement: Placement,
    velocity: Vec3,
    options: CastOptions,
    scratch: &mut SearchScratch,
    counts: impl Fn(&Cast) -> bool,
) -> Option<Cast> {
    let CastOptions { max_time, target_distance, .. } = options;
    if !options.is_possible() || !velocity.is_finite() || !placement.is_finite() {
        return None;
    }
    let mut frame = PairFrame::new(trees, placement, 0.0);
    let speed = velocity.as_dvec3().length();
    let bound = Sweep {
        velocity,
        inverse_speed: ((1.0 / speed) as f32) * (1.0 - gamma(4)),
        target: target_distance * (1.0 + gamma(4)),
    };
    let limit = max_time.min(f32::MAX);
    let mut sweep = Pruned { frame: &mut frame, bound, limit, normal: None };
    // Only earlier impacts matter.
    let (mut latest, mut first) = (f64::from(max_time), None::<Cast>);
    let velocity = velocity.as_dvec3();
    seek(trees, &mut sweep, scratch, |sweep, batch1, batch2| {
        if sweep.are_leaves_beyond(batch1, batch2) {
            return;
        }
        for lane1 in 0..batch1.count() {
            for lane2 in 0..batch2.count() {
                if sweep.limit == FOUND {
                    return;
                }
                let (one, two) = (batch1.triangle(lane1), batch2.triangle(lane2));
                let cast =
                    Cast::of_triangles(&placement, one, two, velocity, &options, latest, &counts);
                let is_first = |cast: &Cast| first.is_none_or(|first| cast.time < first.time);
                if let Some(cast) = cast.filter(is_first) {
                    (first, latest) = (Some(cast), cast.time);
                    sweep.normal = normal_of(sweep, target_distance, &cast);
                    let is_over = cast.time <= 0.0 || sweep.are_meshes_beyond(trees);
                    sweep.limit = if is_over { FOUND } else { (cast.time as f32).next_up() };
                }
            }
        }
    });
    first
}

/// Returns the first impact at a place where the bodies are nearest to each other. Bodies that
/// slide within the target distance come to other parts of a wall all the time. From farther away,
/// the first impact always is at such a place. `first_impact` finds the first one that counts.
/// `are_within` tells if the bodies are within a distance at the start.
pub fn first_minimum<C>(
    options: &CastOptions,
    first_impact: impl Fn(&dyn Fn(&C) -> bool) -> Option<C>,
    is_minimum: impl Fn(&C) -> bool,
    are_within: impl Fn(f64) -> bool,
) -> Option<C> {
    let first = first_impact(&|_| true)?;
    let CastOptions { target_distance: target, stop_at_penetration, .. } = *options;
    let may_slide = !stop_at_penetration
        && target > 0.0
        && !is_minimum(&first)
        && are_within(NEAR_TARGET * f64::from(target));
    if may_slide { first_impact(&is_minimum) } else { Some(first) }
}

/// Returns the first impact that `counts`, among those at a target distance and at less and less.
/// An impact at distance zero always counts. `cast` returns the impact at a target distance, from
/// the impact at the last one. `distance` returns the distance of an impact.
pub fn first_that_counts<C>(
    target_distance: f32,
    cast: impl Fn(f32, Option<&C>) -> Option<C>,
    distance: impl Fn(&C) -> f64,
    counts: impl Fn(&C) -> bool,
) -> Option<C> {
    let (mut target, mut last) = (target_distance, None);
    for _ in 0..TARGETS {
        let found = cast(target, last.as_ref())?;
        if counts(&found) {
            return Some(found);
        }
        // Targets beyond the distance at the start have the same impact.
        target = NEXT_TARGET * target.min((distance(&found) as f32).max(0.0));
        last = Some(found);
    }
    cast(0.0, None)
}

impl CastOptions {
    /// True if some impact can meet these options.
    pub fn is_possible(&self) -> bool {
        let Self { max_time, target_distance, .. } = *self;
        max_time >= 0.0 && target_distance >= 0.0 && target_distance.is_finite()
    }
}

impl Cast {
    /// Returns the first impact of two triangles until `latest` that [counts](first_that_counts).
    /// Takes indices and corners as [`FoundPair::of`] does. Triangle 2 moves by `velocity` in frame
    /// 1.
    #[inline]
    pub fn of_triangles(
        placement: &Placement,
        (triangle1, corners1): (u32, [Vec3; 3]),
        (triangle2, corners2): (u32, [Vec3; 3]),
        velocity: DVec3,
        options: &CastOptions,
        latest: f64,
        counts: impl Fn(&Self) -> bool,
    ) -> Option<Self> {
        let pair = TrianglePair::new(placement, corners1, corners2);
        let cast = |target_distance: f32, _: Option<&Self>| {
            let (options, target) =
                (CastOptions { target_distance, ..*options }, f64::from(target_distance));
            if !boxes_meet(&pair, velocity, target, latest) {
                return None;
            }
            let (time, contact) = first_impact(&pair, velocity, &options, latest)?;
            let is_penetrating = time == 0.0 && contact.distance < target;
            let pair = FoundPair::new([triangle1, triangle2], &pair, contact);
            Some(Self { time, pair, is_penetrating })
        };
        first_that_counts(options.target_distance, cast, |cast| cast.pair.contact.distance, counts)
    }
}

/// True if the boxes of the triangles come within the target distance early enough.
#[inline(always)]
fn boxes_meet(pair: &TrianglePair, velocity: DVec3, target: f64, latest: f64) -> bool {
    // Written out, as `array::map` is not always inlined: a cast took 1.2 times as long.
    let [corners1, corners2] = &pair.corners;
    let ((min1, max1), (min2, max2)) = (bounds(corners1), bounds(corners2));
    let slack = target + 1.0e-12 * ((max1 - min1) + (max2 - min2)).element_sum();
    let (near, far) = (min1 - max2 - slack, max1 - min2 + slack);
    let (mut start, mut end) = (0.0, latest);
    for axis in 0..3 {
        // Zero speed gives infinite times, of both signs unless the boxes pass each other.
        let speed = velocity[axis];
        let (a, b) = (near[axis] / speed, far[axis] / speed);
        start = f64::max(start, a.min(b));
        end = f64::min(end, a.max(b));
    }
    start <= end * (1.0 + 1.0e-12)
}

/// The lowest and the highest coordinates.
#[inline(always)]
fn bounds(&[a, b, c]: &[DVec3; 3]) -> (DVec3, DVec3) {
    (a.min(b).min(c), a.max(b).max(c))
}

/// Returns the time of impact of two triangles and the contact then.
fn first_impact(
    pair: &TrianglePair,
    velocity: DVec3,
    options: &CastOptions,
    latest: f64,
) -> Option<(f64, TriangleContact)> {
    let target = f64::from(options.target_distance);
    let edges = pair.touching_distance() / ARRIVED;
    let mut time = 0.0;
    let mut last: Option<TriangleContact> = None;
    for _ in 0..STEP_LIMIT {
        let travel = velocity * time;
        let mut contact = contact_after(pair, travel)?;
        let approach = -contact.normal.dot(velocity);
        let left = contact.distance - target;
        let slack = ARRIVED * (edges + travel.abs().element_sum());
        if left <= slack {
            let Some(last) = last else {
                let counts = options.stop_at_penetration || approach > ARRIVED * velocity.length();
                return counts.then_some((0.0, contact));
            };
            let beyond = travel + velocity * (2.0 * slack / approach);
            if target > slack && !is_within(pair, beyond, target - 0.5 * slack) {
                // They pass each other at the target distance, and only come nearer by a rounding.
                return None;
            }
            // Triangles that touch have no better normal than the last one before.
            contact.normal = last.normal;
            return Some((time, contact));
        }
        if approach <= 0.0 {
            return None;
        }
        time += left / approach;
        // Unlike "time > latest", this rejects a NaN.
        let in_time = time <= latest;
        if !in_time {
            return None;
        }
        last = Some(contact);
    }
    last.map(|contact| (time, contact))
}

/// Returns the contact of two triangles after a motion of triangle 2.
#[inline(always)]
fn contact_after(pair: &TrianglePair, travel: DVec3) -> Option<TriangleContact> {
    let [t1, t2] = &pair.corners;
    contact(t1, &t2.map(|v| v + travel), f64::INFINITY)
}

/// Returns true if two triangles are within a distance after a motion of triangle 2.
fn is_within(pair: &TrianglePair, travel: DVec3, distance: f64) -> bool {
    contact_after(pair, travel).is_some_and(|contact| contact.distance <= distance)
}

/// Lower bounds of times of impact.
struct Sweep {
    /// Velocity of mesh 2 against mesh 1, in frame 1.
    velocity: Vec3,
    /// Lower bound of one over the length of the velocity; infinite for no velocity.
    inverse_speed: f32,
    /// Upper bound of the distance that counts as an impact.
    target: f32,
}

/// The normal of an impact, as a bound of other times. Bodies are within the target distance no
/// sooner than along the normal. `None` for a grazing impact.
fn normal_of(
    sweep: &Pruned<'_, Sweep>,
    target: f32,
    Cast { time, pair, .. }: &Cast,
) -> Option<BestNormal> {
    let normal = pair.contact.normal;
    let approach = -normal.dot(sweep.bound.velocity.as_dvec3());
    let scale = (1.0 / approach) as f32 * (1.0 - gamma(8));
    let way = time * (1.0 - AT_ONCE) * approach + f64::from(target);
    let toward = Toward::new(sweep.frame, normal, way)?;
    let is_bound = approach > 0.0 && scale.is_finite();
    is_bound.then_some(BestNormal { toward, target: sweep.bound.target, scale })
}

impl LowerBound for Sweep {
    /// The earliest times, infinite where the nodes pass each other.
    #[inline(always)]
    fn of(&self, frame: &mut PairFrame, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> f32x4 {
        let target = f32x4::splat(self.target);
        let apart = frame.signed_gaps(nodes) - target;
        let mut start = (apart * f32x4::splat(self.inverse_speed)).fast_max(f32x4::ZERO);
        let mut end = f32x4::splat(f32::INFINITY);
        let rounding = f32x4::splat(frame.rounding[0]);
        let Along { offset, reach } = frame.along1(nodes, rounding);
        for axis in 0..3 {
            let speed = self.velocity[axis];
            let inverse = f32x4::splat(1.0 / speed.abs());
            let ahead = offset[axis] * f32x4::splat(1.0_f32.copysign(speed));
            let reach = reach[axis] + target;
            start = ((-reach - ahead) * inverse).fast_max(start);
            end = ((reach - ahead) * inverse).fast_min(end);
        }
        let start = start * f32x4::splat(1.0 - gamma(8));
        let passes = (end * f32x4::splat(1.0 + gamma(8))).simd_lt(start);
        passes.bitselect(f32x4::splat(f32::INFINITY), start)
    }
}
