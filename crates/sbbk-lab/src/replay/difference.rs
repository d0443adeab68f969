//! The first difference of two runs.

use crate::prelude::*;

/// Depths of a pair of bodies that differ by more than this, in units, are not the same contact.
/// It is a fifth of Rapier's prediction distance, which is taken for the distance of pairs without
/// a contact.
const DIFFERS: f32 = 0.004;
const PREDICTION: f32 = 0.02;

/// The first contact that is not the same in two runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Difference {
    pub step: usize,
    /// The objects.
    pub pair: [usize; 2],
    /// Where it is.
    pub point: [f32; 3],
    /// The distance in the first run, or none: no contact.
    pub distances: [Option<f32>; 2],
}

impl Difference {
    /// The largest difference of the first step in which there is one.
    pub fn first(one: &Recorder, other: &Recorder) -> Option<Self> {
        let mut steps = one.deepest.iter().zip(&other.deepest).enumerate();
        steps.find_map(|(step, (one, other))| {
            let pairs = one.keys().chain(other.keys().filter(|pair| !one.contains_key(*pair)));
            let differences = pairs.filter_map(|pair| {
                let found = [one.get(pair), other.get(pair)];
                let distances = found.map(|found| found.map(|found| found.distance));
                let [a, b] = distances.map(|distance| distance.unwrap_or(PREDICTION));
                let point = found.into_iter().flatten().next().map_or(Vec3::ZERO, |f| f.point);
                let difference =
                    Self { step: step + 1, pair: *pair, point: point.to_array(), distances };
                ((a - b).abs() > DIFFERS).then_some(((a - b).abs(), difference))
            });
            // Ties go to the first pair, as the order of a map varies.
            let largest = differences
                .max_by(|(a, one), (b, other)| a.total_cmp(b).then(other.pair.cmp(&one.pair)));
            largest.map(|(_, difference)| difference)
        })
    }
}
