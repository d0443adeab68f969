//! Contacts of mesh pairs at every scale.

use super::super::Grid;
use super::cells;
use super::race::{FRESH_NOTE, Raced, Shown, motion_note, race, ratio_note};
use crate::study::contacts::{
    ContactErrors, Contacts, ExactnessRow, GeneratorRow, Mode, PAIR_LIMIT, SPEED_CASE, Side,
    SpeedRow,
};

/// What the columns of errors hold.
pub(super) const ERROR_NOTE: &str =
    "errors: missed + phantom + wrong depth + wrong normal, of the true pairs judged";

/// Who was asked.
const DIRECT_NOTE: &str = "dispatchers called directly: contact skins and contact recycling, which \
                           are Rapier's, have no part in it";

/// All tables of the contact study.
pub fn contacts(contacts: &Contacts) -> Vec<Grid> {
    let Contacts { exactness, speed, generators, .. } = contacts;
    vec![by_size(exactness), by_mesh(exactness), queries(speed), contact_generators(generators)]
}

/// Right and wrong contacts of all meshes, by their size and the prediction distance.
pub fn by_size(rows: &[ExactnessRow]) -> Grid {
    let key = |row: &ExactnessRow| cells![row.case.size, row.case.prediction];
    exactness("Exactness by size: all meshes", ["size", "prediction"], rows, key)
}

/// Right and wrong contacts at all sizes and prediction distances, by mesh.
pub fn by_mesh(rows: &[ExactnessRow]) -> Grid {
    let key = |row: &ExactnessRow| cells![row.case.mesh, row.case.triangle_count];
    let title = "Exactness by mesh: all sizes and distances";
    let grid = exactness(title, ["mesh", "triangles"], rows, key);
    Grid { notes: exactness_notes(rows), ..grid }
}

/// Sums up the rows of each key, in the order in which the keys first appear, and all of them.
fn exactness(
    title: &str,
    [key1, key2]: [&'static str; 2],
    rows: &[ExactnessRow],
    key: impl Fn(&ExactnessRow) -> Vec<String>,
) -> Grid {
    let mut keys: Vec<Vec<String>> = Vec::new();
    for key in rows.iter().map(&key) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let groups = keys.into_iter().map(|group| {
        let sums = sums(rows.iter().filter(|row| key(row) == group));
        [group, sums].concat()
    });
    let all = [cells!["all", ""], sums(rows.iter())].concat();
    Grid {
        title: title.to_owned(),
        header: vec![
            key1,
            key2,
            "poses",
            "true, apart",
            "crossing",
            "stock: missed",
            "phantom",
            "wrong depth",
            "wrong normal",
            "sbbk: missed",
            "phantom",
            "wrong depth",
            "wrong normal",
        ],
        text_columns: 1,
        rows: groups.chain([all]).collect(),
        notes: Vec::new(),
    }
}

/// How the tables of exactness are to be read.
fn exactness_notes(rows: &[ExactnessRow]) -> Vec<String> {
    let uncrossed = rows.iter().filter(|row| row.crossing == 0).count();
    vec![
        "pairs of triangles, against brute force in f64; true: within the prediction distance, \
         with a band of 1 % of it for missed and phantom; wrong depth: off by more than 5 % of it"
            .to_owned(),
        "wrong normal: off by more than 0.1 degrees, where the depth is right and the true normal \
         the only one"
            .to_owned(),
        format!(
            "poses: from 0.95 prediction distances apart to 6 % of the size inside; less deep \
             where there would be more than {PAIR_LIMIT} contacts, so that nothing crosses in \
             {uncrossed} of {} cases",
            rows.len()
        ),
        DIRECT_NOTE.to_owned(),
    ]
}

/// Poses, true pairs, and the errors of both sides.
fn sums<'a>(rows: impl Iterator<Item = &'a ExactnessRow> + Clone) -> Vec<String> {
    let sum = |count: fn(&ExactnessRow) -> usize| rows.clone().map(count).sum::<usize>();
    let truth = [sum(|row| row.pose_count), sum(|row| row.apart), sum(|row| row.crossing)];
    let errors = [0, 1].map(|side| {
        let errors: ContactErrors = rows.clone().map(|row| row.sides[side].errors).sum();
        let pairs = errors.pairs;
        [pairs.missed, pairs.phantom, pairs.wrong_depth, errors.wrong_normal]
    });
    truth.into_iter().chain(errors.concat()).map(|count| count.to_string()).collect()
}

/// First and steady queries.
pub fn queries(rows: &[SpeedRow]) -> Grid {
    let [size, prediction] = SPEED_CASE;
    Grid {
        title: format!(
            "Speed of mesh pairs: {size} units across, prediction distance {prediction}; \
             microseconds a query"
        ),
        notes: vec![
            FRESH_NOTE.to_owned(),
            motion_note("its middle and its end"),
            ratio_note(),
            ERROR_NOTE.to_owned(),
            DIRECT_NOTE.to_owned(),
        ],
        ..race(&["mesh", "triangles", "poses or motions"], rows)
    }
}

impl Raced for SpeedRow {
    type Errors = ContactErrors;

    fn sides(&self) -> &[Side<ContactErrors>; 2] {
        &self.sides
    }

    fn description(&self, mode: Mode) -> Vec<String> {
        let is_fresh = mode == Mode::Fresh;
        let count = if is_fresh { self.pose_count } else { self.motion_count };
        cells![self.mesh, self.triangle_count, count]
    }
}

/// The contact generators alone.
pub fn contact_generators(rows: &[GeneratorRow]) -> Grid {
    Grid {
        title: "Contact generators, Parry's and SBBK's: the same true pairs of triangles, \
                nanoseconds a pair"
            .to_owned(),
        notes: vec![
            "pairs of the motions above that are within the prediction distance throughout; \
             fresh: a new manifold for each, allocated and freed, in the middle of the motion"
                .to_owned(),
            motion_note("its end"),
            ratio_note(),
            ERROR_NOTE.to_owned(),
        ],
        ..race(&["mesh", "triangles", "pairs", "crossing"], rows)
    }
}

impl Raced for GeneratorRow {
    type Errors = ContactErrors;

    fn sides(&self) -> &[Side<ContactErrors>; 2] {
        &self.sides
    }

    fn description(&self, mode: Mode) -> Vec<String> {
        let [pairs, crossing] = match mode {
            Mode::Fresh | Mode::Slow => [self.slow_pairs, self.slow_crossing],
            Mode::Fast => [self.fast_pairs, self.fast_crossing],
        };
        cells![self.mesh, self.triangle_count, pairs, crossing]
    }
}

impl Shown for ContactErrors {
    fn shown(&self) -> String {
        let Self { pairs, wrong_normal, .. } = self;
        let [missed, phantom, wrong_depth] = [pairs.missed, pairs.phantom, pairs.wrong_depth];
        format!("{missed}+{phantom}+{wrong_depth}+{wrong_normal} of {}", pairs.true_pairs)
    }
}
