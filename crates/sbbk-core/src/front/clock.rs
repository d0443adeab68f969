//! How far two meshes may have moved against each other, as one number that grows.
//!
//! A gap `g` was measured at the placement `P`; at `Q` it is at least `g - d(P, Q)`, with `d` the
//! [`motion_bound`](Placement::motion_bound). To ask that for thousands of gaps of different ages
//! with one comparison each, `d` is bounded by way of *anchors*, one placement after the other.
//! With `A` the anchor at the time of `P`, `B` that at the time of `Q`, and `O` the sum of the
//! distances from anchor to anchor, the triangle inequality gives
//!
//! `d(P, Q) <= d(P, A) + (O_B - O_A) + d(B, Q) = (O_B + d(B, Q)) - (O_A - d(P, A))`.
//!
//! The first bracket is the *time* of `Q`, the second the *stamp* of `P`: a gap lasts while `g +
//! stamp > time + margin`.
//!
//! Bodies on their way get a new anchor at each query: time is the length of the way then. A body
//! at rest that jitters keeps its anchor: its way grows, and its distance from the anchor does not.

use crate::traverse::Placement;
use crate::volumes::Sphere;

/// Queries after which it is decided anew whether a pair rests. Fewer: slow turning is taken for
/// jitter. More: a pair that comes to rest is noticed later.
const WINDOW: u32 = 8;
/// A pair rests while it gets no farther than this share of its way. Higher: stamps of moving pairs
/// lose what they are away from the anchor. Lower: jitter with a little drift is taken for motion.
const RESTING_SHARE: f64 = 0.5;

/// Measures the way.
#[derive(Clone, Debug, Default)]
pub(super) struct Clock {
    state: Option<State>,
}

#[derive(Copy, Clone, Debug)]
struct State {
    last: Placement,
    anchor: Placement,
    /// The sum of the distances between anchors.
    offset: f64,
    rests: bool,
    window: Window,
}

/// The last few queries.
#[derive(Copy, Clone, Debug)]
struct Window {
    start: Placement,
    way: f64,
    queries: u32,
}

/// The time of a query.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Reading {
    /// The motion since the query before; infinite if there was none.
    pub(super) step: f64,
    /// See the module's documentation.
    pub(super) time: f64,
    /// Likewise, for gaps that are measured now.
    pub(super) stamp: f64,
}

impl Clock {
    /// The time of a query with the placement `now`. `ball` is around mesh 2, in its frame.
    pub(super) fn advance(&mut self, now: &Placement, ball: &Sphere) -> Reading {
        let from = |earlier: &Placement| now.motion_bound(earlier, ball.centre, ball.radius);
        let Some(state) = &mut self.state else {
            let window = Window { start: *now, way: 0.0, queries: 0 };
            let state = State { last: *now, anchor: *now, offset: 0.0, rests: false, window };
            self.state = Some(state);
            return Reading { step: f64::INFINITY, time: 0.0, stamp: 0.0 };
        };
        let step = from(&state.last);
        state.last = *now;
        state.window.way += step;
        state.window.queries += 1;
        let mut away = if state.rests { from(&state.anchor) } else { step };
        let mut keeps_anchor = state.rests;
        if state.window.queries == WINDOW {
            let near = RESTING_SHARE * state.window.way;
            state.rests = from(&state.window.start) <= near;
            keeps_anchor &= state.rests && away <= near;
            state.window = Window { start: *now, way: 0.0, queries: 0 };
        }
        if !keeps_anchor {
            state.offset += away;
            state.anchor = *now;
            away = 0.0;
        }
        Reading { step, time: state.offset + away, stamp: state.offset - away }
    }

    /// Starts again at zero; stamps from before are void.
    pub(super) fn restart(&mut self) {
        if let Some(state) = &mut self.state {
            state.anchor = state.last;
            state.offset = 0.0;
        }
    }

    /// Forgets all placements.
    pub(super) fn clear(&mut self) {
        self.state = None;
    }
}

#[cfg(test)]
mod tests {
    use glamx::{Pose3, Quat, Vec3};

    use super::*;

    const BALL: Sphere = Sphere { centre: Vec3::new(0.5, 0.0, 0.0), radius: 2.0 };

    fn place(x: f32, angle: f32) -> Placement {
        Placement::new(&Pose3::from_parts(Vec3::X * x, Quat::from_rotation_y(angle)))
    }

    /// Would catch a bound that a change of anchors makes too small: for all pairs of queries of a
    /// way that drifts, jitters, jumps and drifts again.
    #[test]
    fn no_two_queries_are_farther_apart_than_the_clock_says() {
        let way = (0..200).map(|i| {
            let t = i as f32;
            let jitter = 0.01 * (t * 2.3).sin();
            match i {
                0..40 => place(0.01 * t, 0.02 * t),
                40..100 => place(0.4 + jitter, 0.8 - 2.0 * jitter),
                100..120 => place(7.0 + jitter, 0.1 * jitter),
                _ => place(0.001 * t, (0.05 * t).sin()),
            }
        });
        let mut clock = Clock::default();
        let queries: Vec<_> = way.map(|now| (now, clock.advance(&now, &BALL))).collect();
        for (j, (later, reading)) in queries.iter().enumerate() {
            for (earlier, stamped) in &queries[..j] {
                let moved = later.motion_bound(earlier, BALL.centre, BALL.radius);
                assert!(
                    moved <= reading.time - stamped.stamp + 1e-9,
                    "{moved} {reading:?} {stamped:?}"
                );
            }
        }
    }

    /// Would catch a clock that runs on while nothing gets anywhere.
    #[test]
    fn the_clock_stands_still_for_a_pair_that_jitters() {
        let mut clock = Clock::default();
        let times: Vec<_> =
            (0..1000).map(|i| clock.advance(&place(0.01 * (i as f32).sin(), 0.0), &BALL)).collect();
        let way: f64 = times[1..].iter().map(|reading| reading.step).sum();
        assert!(way > 5.0, "{way}");
        assert!(times[999].time < 0.2, "{:?}", times[999]);
        assert!(times[999].stamp > times[20].stamp - 0.05);
    }
}
