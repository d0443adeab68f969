//! The tables of a comparison, with the paper's rows among ours.

mod contacts;
mod convex;
mod determinism;
mod front;
mod helicopter;
mod meshes;
mod pile;
mod queries;
mod race;
mod soak;
mod soft;
mod terrain;

pub use contacts::{by_mesh, by_size, contact_generators, contacts, queries};
pub use convex::convex;
pub use determinism::{fingerprints, threads};
pub use front::front;
pub use helicopter::{frames, overlapping_area};
pub use meshes::costs;
pub use pile::{accuracy, runs, same_poses, sizes};
pub use queries::one_answer;
pub use soak::soak;
pub use soft::{refit, soft_heads};
pub use terrain::terrains;

use super::Grid;
use crate::study::Comparison;

/// What the columns of errors hold.
const ERROR_NOTE: &str = "errors: missed + phantom + wrong depth, of the true triangle pairs in \
                          the sample, against brute force in f64";

/// What the columns of times hold.
const TIME_NOTE: &str = "times: min / median over the repeats";

/// A row of cells, each by its `Display`.
macro_rules! cells {
    ($($cell:expr),* $(,)?) => {
        vec![$($cell.to_string()),*]
    };
}
use cells;

/// All tables of a comparison, in the order of the paper.
pub fn all(comparison: &Comparison) -> Vec<Grid> {
    let (recycled, unrecycled): (Vec<_>, Vec<_>) =
        comparison.piles.iter().partition(|pile| pile.contact_recycling);
    let mut tables = vec![frames(&comparison.helicopter)];
    tables.extend(comparison.cut.as_ref().map(overlapping_area));
    tables.extend(recycled.last().map(|pile| runs(pile)));
    tables.extend(unrecycled.iter().map(|pile| runs(pile)));
    tables.push(sizes(&recycled));
    tables.push(same_poses(&recycled));
    tables.push(accuracy(&comparison.piles));
    tables.push(costs(&comparison.meshes));
    tables
}
