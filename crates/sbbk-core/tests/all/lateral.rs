//! Lateral culling rejects only pairs whose exact contact is aslant, now and after a motion.

use crate::prelude::*;
use sbbk_core::contact::contact;
use sbbk_core::leaf::LateralCulling;

const REACH: f32 = 0.02;
const DISTANCE: f32 = 0.25 * REACH;
const COSINE: f32 = 0.87;
/// Radius of the ball whose motion is bounded.
const RADIUS: f32 = 10.0 * REACH;

/// A triangle of the other mesh near the origin of its frame, and one of mesh 1.
struct Pair {
    corners: [[Vec3; 3]; 2],
    pose: Pose3,
    far: f32,
}

impl Pair {
    /// Frames that are `far` from the triangles; `round` says where corners may be, and `thin` how
    /// high triangles are, as a share of their length.
    fn new(random: &mut Random, [far, thin]: [f32; 2], round: impl Fn(Vec3) -> Vec3) -> Self {
        let size = random.range(0.3, 1.5) * REACH;
        let rotation = random.rotation();
        let pose = Pose3::from_parts(random.vector(far), rotation);
        let triangle = |random: &mut Random| {
            let [a, along, across] = [(); 3].map(|()| round(random.vector(size)));
            [a, a + along, a + 0.5 * along + thin * across]
        };
        let two = triangle(random);
        let aside = round(random.vector(2.0 * REACH));
        let one = triangle(random).map(|corner| pose * (corner + aside));
        Self { corners: [one, two], pose, far }
    }

    fn is_found(&self, travel: f32, culling: Option<&LateralCulling>) -> bool {
        let placement = Placement::new(&self.pose);
        let frame: PairFrame = PairFrame::within([self.far + 1.0; 2], placement, REACH + travel);
        let test = LeafTest::new(&frame);
        let [one, two] = self.corners.map(|corners| LeafBatch::gather(&[0], |_| corners));
        let mut is_found = false;
        test.survivors_in_front(culling, &one, &two, |_, _| true, |_, _| is_found = true);
        is_found
    }

    /// A pose that is `travel` away for points of the ball.
    fn moved(&self, random: &mut Random, travel: f32) -> Placement {
        let now = Placement::new(&self.pose);
        let is_turning = random.bits().is_multiple_of(2);
        let turn = random.vector(if is_turning { 0.3 / RADIUS } else { 0.0 });
        let by = random.vector(1.0).normalize();
        let at = |share: f32| {
            let turn = Pose3::from_parts(share * by, glamx::Quat::from_scaled_axis(share * turn));
            Placement::new(&(self.pose * turn))
        };
        let bound = |share: f32| at(share).motion_bound(&now, Vec3::ZERO, RADIUS);
        let mut share = travel;
        while bound(share) > f64::from(travel) {
            share *= 0.99;
        }
        at(share)
    }

    fn contact(&self, placement: &Placement) -> Option<(TriangleContact, f64)> {
        let [one, two] = self.corners;
        let one = one.map(Vec3::as_dvec3);
        let two = two.map(|corner| placement.to_frame1(corner, Vec3::ZERO));
        let contact = contact(&one, &two, f64::from(REACH))?;
        let cosine = [one, two].map(|[a, b, c]| {
            let normal = (b - a).cross(c - a);
            normal.dot(contact.normal).abs() / normal.length()
        });
        Some((contact, cosine[0].min(cosine[1])))
    }
}

/// The number of culled pairs, and of their contacts.
fn check(
    random: &mut Random,
    pairs: usize,
    far_and_thin: [f32; 2],
    round: impl Fn(Vec3) -> Vec3,
) -> [usize; 2] {
    let mut counts = [0; 2];
    for i in 0..pairs {
        let travel = [0.0, 0.1, 0.5][i % 3] * REACH;
        let beside = LateralCulling::new(DISTANCE, COSINE, REACH, travel);
        let pair = Pair::new(random, far_and_thin, &round);
        let is_found = pair.is_found(travel, Some(&beside));
        if is_found || !pair.is_found(travel, None) {
            continue;
        }
        counts[0] += 1;
        let now = Placement::new(&pair.pose);
        let later = (0..if travel > 0.0 { 20 } else { 0 }).map(|_| pair.moved(random, travel));
        let places: Vec<_> = later.chain([now]).collect();
        for (contact, cosine) in places.iter().filter_map(|placement| pair.contact(placement)) {
            counts[1] += 1;
            let features = [contact.features.feature1(), contact.features.feature2()];
            assert!(!features.contains(&Feature::Face), "{:?}", pair.corners);
            assert!(contact.distance > f64::from(DISTANCE), "{:?}", pair.corners);
            assert!(cosine < f64::from(COSINE), "{cosine}: {:?}", pair.corners);
        }
    }
    counts
}

/// Would catch a gap, a height or a slope that rounding, a motion or a sliver makes too great.
#[test]
fn culled_triangles_have_aslant_contacts_only() {
    let random = &mut Random(1);
    for (far, least) in [(0.0, 2000), (3.0, 500), (30.0, 0)] {
        let [beside, touching] = check(random, 60_000, [far, 1.0], |corner| corner);
        assert!(beside >= least && touching >= least, "{far}: {beside}, {touching}");
    }
}

/// The planes of needles are uncertain by rounding.
#[test]
fn culled_needles_have_aslant_contacts_only() {
    let random = &mut Random(3);
    for thin in [1.0e-1, 1.0e-2, 1.0e-3, 1.0e-4, 1.0e-5, 1.0e-6] {
        for far in [0.0, 3.0, 30.0] {
            check(random, 20_000, [far, thin], |corner| corner);
        }
    }
}

/// Corners in a row, and right angles.
#[test]
fn culled_triangles_of_a_lattice_have_aslant_contacts_only() {
    let random = &mut Random(2);
    for cell in [0.25, 1.0 / 3.0, 0.5] {
        let cell = cell * REACH;
        let [beside, touching] =
            check(random, 60_000, [0.0, 1.0], |corner| (corner / cell).round() * cell);
        assert!(beside > 500 && touching > 500, "{cell}: {beside}, {touching}");
    }
}
