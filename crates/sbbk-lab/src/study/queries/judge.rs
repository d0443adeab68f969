//! Brute force in f64 as the judge of answers.

use std::iter::Sum;
use std::ops::Add;

use glamx::{DPose3, DVec3, Pose3};
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use sbbk_core::truth::pairs_within;
use serde::Serialize;

use super::ask::{Answered, Placed, Query, motion};

/// How wrong answers are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(super) struct QueryErrors {
    /// Answers judged.
    pub judged: usize,
    /// Answers that say the opposite of the truth, or nothing where there is something.
    pub wrong: usize,
    /// The largest error of the other ones, in sizes of the mesh. Of a time of impact: the distance
    /// left then.
    pub largest: f64,
}

impl Add for QueryErrors {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            judged: self.judged + other.judged,
            wrong: self.wrong + other.wrong,
            largest: self.largest.max(other.largest),
        }
    }
}

impl Sum for QueryErrors {
    fn sum<I: Iterator<Item = Self>>(errors: I) -> Self {
        errors.fold(Self::default(), Self::add)
    }
}

/// Errors beyond this, in sizes, are wrong answers.
const WRONG: f64 = 1.0e-3;
/// Distances below this, in sizes, may count as touching or not: f32 poses are no better.
const UNDECIDED: f64 = 1.0e-6;
/// Times before an impact at which nothing must meet.
const MARCH: usize = 8;

/// A mesh and its size, for the judge.
pub(super) struct Judge {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    size: f64,
}

impl Judge {
    pub fn new(shape: &SharedShape, size: Real) -> Self {
        let mesh = shape.as_trimesh().expect("only meshes are asked about");
        let vertices = mesh.vertices().iter().map(|v| v.as_dvec3()).collect();
        Self { vertices, triangles: mesh.indices().to_vec(), size: f64::from(size) }
    }

    /// All signed distances up to `margin`.
    fn distances(&self, pos12: &Pose3, margin: f64) -> Vec<f64> {
        let (v, t) = (&self.vertices, &self.triangles);
        let rotation = pos12.rotation.as_dquat().normalize();
        let pose = DPose3::from_parts(pos12.translation.as_dvec3(), rotation);
        pairs_within(v, t, v, t, pose, margin).iter().map(|pair| pair.distance).collect()
    }

    /// The least signed distance, if it is at most `margin`.
    fn least(&self, pos12: &Pose3, margin: f64) -> Option<f64> {
        self.distances(pos12, margin).into_iter().reduce(f64::min)
    }

    pub fn judge(&self, query: Query, placed: &Placed, answer: Answered) -> QueryErrors {
        let error = match answer {
            Answered::Distance(reported) => self.distance_error(query, &placed.pos12, reported),
            Answered::Meet(meet) => {
                let least = self.least(&placed.pos12, UNDECIDED * self.size);
                let truth = least.is_some_and(|d| d <= 0.0);
                let is_undecided = least.is_some_and(|d| d.abs() < UNDECIDED * self.size);
                if meet == truth || is_undecided { Some(0.0) } else { None }
            }
            Answered::Time(time) => time.and_then(|time| self.time_error(query, placed, time)),
            Answered::Pairs(count) => self.count_error(&placed.pos12, count),
        };
        match error.map(|error| error / self.size).filter(|error| *error < WRONG) {
            Some(largest) => QueryErrors { judged: 1, wrong: 0, largest },
            None => QueryErrors { judged: 1, wrong: 1, largest: 0.0 },
        }
    }

    fn distance_error(&self, query: Query, pos12: &Pose3, reported: Option<Real>) -> Option<f64> {
        let reported = f64::from(reported?);
        let truth = self.least(pos12, reported.max(0.0) + WRONG * self.size)?;
        let truth = if query == Query::Contact { truth } else { truth.max(0.0) };
        Some((reported - truth).abs())
    }

    /// The distance left at the time of impact; none if the meshes cross before.
    fn time_error(&self, query: Query, placed: &Placed, time: Real) -> Option<f64> {
        let pose_at = |time: Real| match query {
            Query::NonlinearCast => motion(placed, self.size as Real).position_at_time(time),
            _ => {
                let translation = placed.pos12.translation - placed.direction * time;
                Pose3 { translation, ..placed.pos12 }
            }
        };
        let crosses = |step: usize| {
            let time = time * (step as Real / MARCH as Real);
            self.least(&pose_at(time), 0.0).is_some_and(|d| d < -UNDECIDED * self.size)
        };
        if (0..MARCH).any(crosses) {
            return None;
        }
        self.least(&pose_at(time), WRONG * self.size).map(f64::abs)
    }

    /// Nothing, if as many pairs meet as reported, but for those that hardly do or do not.
    fn count_error(&self, pos12: &Pose3, reported: usize) -> Option<f64> {
        let slack = UNDECIDED * self.size;
        let distances = self.distances(pos12, slack);
        let certain = distances.iter().filter(|distance| **distance < -slack).count();
        (certain..=distances.len()).contains(&reported).then_some(0.0)
    }
}
