//! Candidates of a descent with slack are complete while the plan reuses them.

use crate::prelude::*;

const BALL: Sphere = Sphere { centre: Vec3::new(0.3, -0.2, 0.1), radius: 0.7 };

const BODY: MovingBody = MovingBody { ball: BALL, is_ball: false };

/// Points of frame 1, and points of frame 2 in [`BALL`].
struct Points([Vec<Vec3>; 2]);

impl Points {
    fn random(random: &mut Random) -> Self {
        let still = (0..40).map(|_| random.vector(1.5)).collect();
        let in_ball = |_| BALL.centre + random.vector(1.0).normalize_or_zero() * BALL.radius;
        Self([still, (0..40).map(in_ball).collect()])
    }

    /// Points of frame 1, and the middle of [`BALL`].
    fn around_ball(random: &mut Random) -> Self {
        Self([Self::random(random).0[0].clone(), vec![BALL.centre]])
    }

    /// The distances of all pairs of points that are at most `margin` apart.
    fn within(&self, placement: &Placement, margin: f64) -> BTreeMap<(usize, usize), f64> {
        let Self([one, two]) = self;
        let pairs = one.iter().enumerate().flat_map(|(i, &origin)| {
            let distance = move |(j, &x)| ((i, j), placement.to_frame1(x, origin).length());
            two.iter().enumerate().map(distance)
        });
        pairs.filter(|(_, distance)| *distance <= margin).collect()
    }
}

/// Walks with jumps and changes of stride and prediction distance, against brute force at each
/// step. Would catch candidates used for too long, a travel that is too small, and a wrong margin.
#[test]
fn candidates_are_complete_while_they_are_reused() {
    let mut random = Random(61);
    let (mut reused, mut skipped, mut found) = (0, 0, 0);
    for walk in 0..90 {
        let is_ball = walk % 3 == 0;
        let body = MovingBody { ball: BALL, is_ball };
        let points =
            if is_ball { Points::around_ball(&mut random) } else { Points::random(&mut random) };
        let of_shapes = SlackLimits { steps: 16.0, greatest: 8.0 };
        let limits = [SlackLimits::TRIANGLES, of_shapes][walk % 2];
        let (mut slack, mut pose) = (Slack::default(), random.pose(0.5));
        let (mut stride, mut prediction) = (1e-3, 0.05_f32);
        // The distance of each candidate when it was last known, plus the travel then.
        let (mut candidates, mut margin_of_descent) = (BTreeMap::new(), f32::NAN);
        for step in 0..200 {
            match random.range(0.0, 50.0) as u32 {
                0 => pose = random.pose(0.5),
                1 => stride = [0.0, 1e-5, 1e-3, 5e-3, 5e-2][step % 5],
                2 => prediction = [0.0, 0.02, 0.05, 0.2][step % 4],
                _ => pose = random.near(&pose, stride),
            }
            let placement = Placement::new(&pose);
            let expected = points.within(&placement, prediction.into());
            match slack.plan(body, &placement, prediction, limits) {
                SlackPlan::Descend { margin } => {
                    assert!(margin >= prediction);
                    assert_eq!(slack.travel(), 0.0);
                    let known = points.within(&placement, margin.into());
                    (candidates, margin_of_descent) = (known, margin);
                }
                SlackPlan::Reuse { margin } => {
                    reused += 1;
                    assert_eq!(margin, margin_of_descent);
                    let limit = f64::from(prediction) + slack.travel();
                    for (pair, distance) in &expected {
                        let Some(clear) = candidates.get(pair) else {
                            panic!("{pair:?}, {distance} apart, was not found");
                        };
                        assert!(*clear <= limit, "{pair:?} is skipped");
                    }
                    let now = points.within(&placement, f64::INFINITY);
                    for (pair, clear) in &mut candidates {
                        // Skip candidates out of reach, like a caller.
                        if *clear <= limit {
                            *clear = now[pair] + slack.travel();
                        } else {
                            skipped += 1;
                        }
                    }
                }
            }
            found += expected.len();
        }
    }
    assert!(reused > 5000 && skipped > 20_000 && found > 4000, "{reused}, {skipped}, {found}");
}

/// A ball that spins in place moves nothing, so its candidates serve for ever.
#[test]
fn a_spinning_ball_keeps_its_candidates() {
    for (is_ball, is_reused) in [(true, true), (false, false)] {
        let body = MovingBody { ball: Sphere { centre: Vec3::ZERO, radius: 1.0 }, is_ball };
        let mut slack = Slack::default();
        let mut plans = (0..10).map(|i| {
            let turn = Quat::from_rotation_x(0.5 * i as f32);
            let placement = Placement::new(&Pose3::from_rotation(turn));
            slack.plan(body, &placement, 0.02, SlackLimits::TRIANGLES)
        });
        plans.by_ref().take(2).for_each(drop);
        assert_eq!(plans.all(|plan| matches!(plan, SlackPlan::Reuse { .. })), is_reused);
    }
}

/// The margin of the second of two queries, the ball shifted by `step` between them, and whether a
/// third one there reuses the candidates.
fn margin_after(step: f32, prediction: f32) -> (f32, bool) {
    let mut slack = Slack::default();
    let at = |x: f32| Placement::new(&Pose3::translation(x, 0.0, 0.0));
    let first = slack.plan(BODY, &at(0.0), prediction, SlackLimits::TRIANGLES);
    assert_eq!(first, SlackPlan::Descend { margin: prediction }, "a first query looks farther");
    match slack.plan(BODY, &at(step), prediction, SlackLimits::TRIANGLES) {
        SlackPlan::Descend { margin } => {
            let again = slack.plan(BODY, &at(step), prediction, SlackLimits::TRIANGLES);
            (margin, again == SlackPlan::Reuse { margin })
        }
        plan => panic!("{plan:?} without a descent to reuse"),
    }
}

/// Would catch slack that jitter uses up, that does not grow with the motion or grows without end,
/// and slack for fast motion.
#[test]
fn slack_grows_with_the_motion_up_to_a_limit() {
    let prediction = 0.02;
    let near = |found: f32, expected: f32| (found - expected).abs() < 1e-5 * prediction;
    for (step, share) in
        [(0.0, 0.1), (0.01, 0.1), (0.05, 0.4), (0.1, 0.8), (0.15, 1.0), (0.33, 1.0)]
    {
        let (margin, kept) = margin_after(step * prediction, prediction);
        assert!(near(margin, prediction * (1.0 + share)) && kept, "{margin} at {step}");
    }
    for step in [0.34, 1.0, 1000.0] {
        assert_eq!(margin_after(step * prediction, prediction), (prediction, false));
    }
    // Nothing can be kept within a distance of zero, as there is no scale for slack.
    assert_eq!(margin_after(0.0, 0.0), (0.0, false));
}

/// Would catch a small body all of whose pairs are candidates.
#[test]
fn slack_of_a_small_body_is_a_share_of_its_radius() {
    for prediction in [0.2, 1.0, 100.0] {
        for step in [0.0, 1e-3, 0.01, 0.02, 0.1, 10.0] {
            let (margin, _) = margin_after(step, prediction);
            assert!(margin <= prediction + 0.1 * BALL.radius, "{margin} at {step}, {prediction}");
        }
        assert!(margin_after(0.02, prediction).1, "no slack for slow motion at {prediction}");
    }
}

/// Would catch candidates that are kept after a pose that is not finite, and a panic.
#[test]
fn queries_that_are_not_finite_are_descents() {
    let good = Placement::new(&Pose3::IDENTITY);
    for broken in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let bad_pose = Placement::new(&Pose3::translation(broken, 0.0, 0.0));
        for (placement, prediction) in [(&bad_pose, 0.02), (&good, broken)] {
            let mut slack = Slack::default();
            for _ in 0..2 {
                slack.plan(BODY, &good, 0.02, SlackLimits::TRIANGLES);
            }
            let again = slack.clone().plan(BODY, &good, 0.02, SlackLimits::TRIANGLES);
            assert!(matches!(again, SlackPlan::Reuse { .. }), "{again:?}");
            let plan = slack.plan(BODY, placement, prediction, SlackLimits::TRIANGLES);
            // No pair is within a distance below zero, so any candidates are complete.
            if prediction == f32::NEG_INFINITY {
                assert!(matches!(plan, SlackPlan::Reuse { .. }));
                continue;
            }
            let SlackPlan::Descend { margin } = plan else { panic!("{plan:?}") };
            assert_eq!(margin.to_bits(), prediction.to_bits());
            let next = slack.plan(BODY, &good, 0.02, SlackLimits::TRIANGLES);
            assert!(matches!(next, SlackPlan::Descend { .. }), "{next:?}");
        }
    }
}
