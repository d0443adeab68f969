//! A mesh and a shape of one kind: the ways of one to the other, and what both sides answer there.

use glamx::{Quat, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;

use super::errors::Judge;
use super::kinds::{Kind, Upright};
use crate::metrics::Sequence;
use crate::report::Row;
use crate::scene::random;
use crate::study::motion::{Approach, Mode, Place};
use crate::study::pair::Contest;

/// Of the queries of a motion one in so many is judged, the first and the last among them.
const JUDGED: usize = 4;

/// A mesh and a shape.
pub(super) struct Pair<'a> {
    pub contest: &'a Contest,
    pub mesh: &'a SharedShape,
    pub kind: &'a Kind,
    pub prediction: Real,
    judge: Judge,
}

impl<'a> Pair<'a> {
    pub fn new(
        contest: &'a Contest,
        mesh: &'a SharedShape,
        kind: &'a Kind,
        prediction: Real,
    ) -> Self {
        Self { contest, mesh, kind, prediction, judge: Judge::new(mesh, &kind.shape) }
    }

    /// A random way of the mesh to the shape.
    pub fn approach(
        contest: &Contest,
        mesh: &SharedShape,
        kind: &Kind,
        random: &mut Rand32,
    ) -> Approach {
        let shapes = [&kind.shape, mesh];
        let Some(upright) = kind.floor else {
            return Approach::random(contest.sbbk(), shapes, random);
        };
        let rotation = match upright {
            Upright::Yes => Quat::IDENTITY,
            Upright::No => random::rotation(random),
        };
        let [x, z] = [(); 2].map(|()| 20.0 * random.rand_float() - 10.0);
        Approach::along(Vec3::Y, rotation, Vec3::new(x, 0.0, z), contest.sbbk(), shapes)
            .expect("what comes from above to a floor touches it")
    }

    /// The queries at some places, every other time with the mesh first.
    pub fn sequences(&self, places: &[Place], mode: Mode) -> Vec<Sequence> {
        let sequence = |(index, place): (usize, &Place)| {
            let shapes = [&self.kind.shape, self.mesh];
            let mut sequence = mode.sequence(shapes, place, self.prediction);
            if is_mesh_first(index) {
                sequence.shapes.reverse();
                sequence.poses.iter_mut().for_each(|pose| *pose = pose.inverse());
            }
            sequence
        };
        places.iter().enumerate().map(sequence).collect()
    }

    /// The errors of both sides.
    pub fn rows(&self, study: &'static str, sequences: &[Sequence]) -> [Row; 2] {
        let errors = self.contest.errors(sequences, |index, step| {
            let pos12 = &sequences[index].poses[step];
            (step % JUDGED == 0)
                .then(|| self.judge.truth(pos12, is_mesh_first(index), self.prediction))
        });
        let parts = self.kind.shape.as_compound().map(|compound| compound.shapes().len());
        let row = |side: usize| {
            Row::new(study, Contest::BACKENDS[side])
                .key("shape", self.kind.name)
                .with("part_count", parts)
                .with("errors", errors[side])
        };
        [row(0), row(1)]
    }
}

fn is_mesh_first(index: usize) -> bool {
    index.is_multiple_of(2)
}
