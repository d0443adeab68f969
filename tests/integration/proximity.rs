use crate::prelude::*;

/// Brute force in f64 about a question.
pub struct Proximity<'a> {
    pub question: Question<'a>,
    /// Least signed distance of two subshapes.
    pub least: f64,
    /// Signed distance of two subshapes, in the order of the host.
    pub of: &'a dyn Fn([u32; 2]) -> f64,
    pub tolerance: f64,
}

impl Proximity<'_> {
    /// Panics unless distance, intersection, closest points and contact are true. The last two look
    /// up to `margin`.
    pub fn check(&self, dispatcher: &impl QueryDispatcher, margin: Real, says: &str) {
        let says = format!("{says}: {}", self.least);
        self.check_distance(dispatcher, &says);
        self.check_contact(dispatcher, margin, &says);
    }

    fn is_near(&self, distance: Real, truth: f64) -> bool {
        (f64::from(distance) - truth).abs() <= self.tolerance
    }

    fn check_distance(&self, dispatcher: &impl QueryDispatcher, says: &str) {
        let Self { question, least, tolerance, .. } = *self;
        let ([g1, g2], pos12) = (question.host_shapes(), question.pos12());
        let found = dispatcher.distance(&pos12, g1, g2).unwrap();
        assert!(self.is_near(found.distance, least.max(0.0)), "{says} {found:?}");
        let own = (self.of)([found.subshape1, found.subshape2]);
        assert!(self.is_near(found.distance, own.max(0.0)), "{says} {found:?} {own}");

        let found = dispatcher.intersection_test(&pos12, g1, g2).unwrap();
        let is_sure = least.abs() > tolerance;
        assert!(!is_sure || found.intersecting == (least < 0.0), "{says}");
        if found.intersecting {
            assert!((self.of)([found.subshape1, found.subshape2]) <= tolerance, "{says}");
        }
    }

    fn check_contact(&self, dispatcher: &impl QueryDispatcher, margin: Real, says: &str) {
        let Self { question, least, tolerance, .. } = *self;
        let ([g1, g2], pos12) = (question.host_shapes(), question.pos12());
        let is_beyond = least >= f64::from(margin) - tolerance;
        match dispatcher.closest_points(&pos12, g1, g2, margin).unwrap() {
            ClosestPoints::Intersecting => assert!(least <= tolerance, "{says}"),
            ClosestPoints::Disjoint => assert!(is_beyond, "{says}"),
            ClosestPoints::WithinMargin(point1, point2) => {
                let between = (point1 - pos12 * point2).length();
                assert!(least >= -tolerance && self.is_near(between, least), "{says}");
            }
        }
        let Some(contact) = dispatcher.contact(&pos12, g1, g2, margin).unwrap() else {
            assert!(is_beyond, "{says}");
            return;
        };
        assert!(self.is_near(contact.dist, least), "{says} {contact:?}");
        let own = (self.of)([contact.subshape1, contact.subshape2]);
        assert!(self.is_near(contact.dist, own), "{says} {contact:?} {own}");
        let way = pos12 * contact.point2 - contact.point1;
        let off = way - contact.normal1 * contact.dist;
        assert!(f64::from(off.length()) <= tolerance, "{says} {contact:?}");
        let opposite = pos12.rotation * contact.normal2 + contact.normal1;
        assert!(opposite.length() < 1.0e-5, "{says} {contact:?}");
    }
}

/// Shape 2 moves along a line.
#[derive(Clone, Copy)]
pub struct LinearCast<'a> {
    pub question: Question<'a>,
    /// In the frame of shape 1.
    pub velocity: Vec3,
    pub options: ShapeCastOptions,
}

impl<'a> LinearCast<'a> {
    pub fn ask(&self, dispatcher: &dyn QueryDispatcher) -> Option<ShapeCastHit> {
        let ([g1, g2], pos12) = (self.question.host_shapes(), self.question.pos12());
        dispatcher.cast_shapes(&pos12, self.velocity12(), g1, g2, self.options).unwrap()
    }

    /// The question at a time.
    pub fn at(&self, time: Real) -> Question<'a> {
        let mut pose = self.question.pose;
        pose.translation += self.velocity * time;
        self.question.at(pose)
    }

    /// In the order of the host.
    fn velocity12(&self) -> Vec3 {
        let Question { pose, is_flipped, .. } = self.question;
        if is_flipped { -(pose.rotation.inverse() * self.velocity) } else { self.velocity }
    }

    /// Panics unless `hit` is the first time at which nothing is left to the target distance, by
    /// brute force.
    pub fn check(
        &self,
        hit: Option<ShapeCastHit>,
        left: impl Fn(Real) -> f64,
        looks: usize,
        tolerance: f64,
        says: &str,
    ) {
        let until = hit.map_or(self.options.max_time_of_impact, |hit| hit.time_of_impact);
        for look in 0..looks {
            let time = until * look as Real / looks as Real;
            assert!(left(time) > 0.0, "{says}: earlier, at {time} before {until}");
        }
        let Some(hit) = hit else {
            assert!(left(until) > 0.0, "{says}");
            return;
        };
        assert!(left(until).abs() <= tolerance, "{says}: {hit:?} {}", left(until));
        assert_eq!(hit.status, ShapeCastStatus::Converged, "{says}");
        let pos12 = self.at(until).pos12();
        let between = pos12 * hit.witness2 - hit.witness1;
        let off = between - hit.normal1 * self.options.target_distance;
        assert!(f64::from(off.length()) <= 2.0 * tolerance, "{says} {hit:?}");
        let opposite = pos12.rotation * hit.normal2 + hit.normal1;
        assert!(opposite.length() < 1.0e-5, "{says} {hit:?}");
        assert!(hit.normal1.dot(self.velocity12()) < 0.0, "{says} {hit:?}");
    }
}
