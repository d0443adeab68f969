//! Contacts of mesh pairs at every scale.

use super::super::Grid;
use super::super::format::{min_median, times};
use super::{TIME_NOTE, cells};
use crate::metrics::{geometric_mean, ratio};
use crate::study::contacts::{
    ContactErrors, Contacts, ExactnessRow, FAST, GeneratorRow, Measured, PAIR_LIMIT, SLOW,
    SPEED_CASE, STEP_COUNT, SpeedRow,
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

/// A way to ask, and its measurement in the rows `R`.
type Mode<R> = (String, fn(&R) -> Vec<String>, fn(&R) -> [Measured; 2]);

/// The three ways to ask.
fn modes() -> [String; 3] {
    let motion = |share| format!("steady, {share} a step");
    ["fresh".to_owned(), motion(SLOW), motion(FAST)]
}

/// First and steady queries.
pub fn queries(rows: &[SpeedRow]) -> Grid {
    let [fresh, slow, fast] = modes();
    let motions = |row: &SpeedRow| cells![row.mesh, row.triangle_count, row.motion_count];
    let modes: [Mode<SpeedRow>; 3] = [
        (
            fresh,
            |row| cells![row.mesh, row.triangle_count, row.pose_count],
            |row| row.sides.each_ref().map(|side| side.fresh),
        ),
        (slow, motions, |row| row.sides.each_ref().map(|side| side.slow)),
        (fast, motions, |row| row.sides.each_ref().map(|side| side.fast)),
    ];
    let [size, prediction] = SPEED_CASE;
    Grid {
        title: format!(
            "Speed of mesh pairs: {size} units across, prediction distance {prediction}; \
             microseconds a query"
        ),
        header: vec![
            "query",
            "mesh",
            "triangles",
            "poses or motions",
            "stock",
            "sbbk",
            "ratio",
            "errors, stock",
            "errors, sbbk",
        ],
        text_columns: 2,
        rows: modes.iter().flat_map(|mode| race(mode, rows)).collect(),
        notes: vec![
            "fresh: nothing known about the pair, trees built; to free the manifolds is part of it"
                .to_owned(),
            motion_note("of its middle and its end"),
            format!("{TIME_NOTE}, both in turn; ratio: of minima; mean: geometric"),
            ERROR_NOTE.to_owned(),
            DIRECT_NOTE.to_owned(),
        ],
    }
}

/// The contact generators alone.
pub fn contact_generators(rows: &[GeneratorRow]) -> Grid {
    let [fresh, slow, fast] = modes();
    let slow_pairs = |row: &GeneratorRow| {
        cells![row.mesh, row.triangle_count, row.slow_pairs, row.slow_crossing]
    };
    let modes: [Mode<GeneratorRow>; 3] = [
        (fresh, slow_pairs, |row| row.sides.each_ref().map(|side| side.fresh)),
        (slow, slow_pairs, |row| row.sides.each_ref().map(|side| side.slow)),
        (
            fast,
            |row| cells![row.mesh, row.triangle_count, row.fast_pairs, row.fast_crossing],
            |row| row.sides.each_ref().map(|side| side.fast),
        ),
    ];
    Grid {
        title: "Contact generators: the same true pairs of triangles, nanoseconds a pair"
            .to_owned(),
        header: vec![
            "contacts",
            "mesh",
            "triangles",
            "pairs",
            "crossing",
            "parry",
            "sbbk",
            "ratio",
            "errors, parry",
            "errors, sbbk",
        ],
        text_columns: 2,
        rows: modes.iter().flat_map(|mode| race(mode, rows)).collect(),
        notes: vec![
            "pairs of the motions above that are within the prediction distance throughout; \
             fresh: a new manifold for each, allocated and freed, in the middle of the motion"
                .to_owned(),
            motion_note("of its end"),
            format!("{TIME_NOTE}, both in turn; ratio: of minima; mean: geometric"),
            ERROR_NOTE.to_owned(),
        ],
    }
}

fn motion_note(judged: &str) -> String {
    format!(
        "steady: {STEP_COUNT} steps in a straight line while turning, which move the surface by up \
         to {SLOW} or {FAST} prediction distances each, with what the query before left; errors \
         {judged}"
    )
}

/// A row for each mesh, and one for the geometric mean of the ratios.
fn race<R>((name, description, measured): &Mode<R>, rows: &[R]) -> Vec<Vec<String>> {
    let ratio_of = |row: &R| {
        let [stock, sbbk] = measured(row);
        ratio(stock.time.min, sbbk.time.min)
    };
    let mut table: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            let [stock, sbbk] = measured(row);
            let results = cells![
                min_median(&stock.time),
                min_median(&sbbk.time),
                times(ratio_of(row)),
                errors(&stock.errors),
                errors(&sbbk.errors),
            ];
            [vec![name.clone()], description(row), results].concat()
        })
        .collect();
    let totals = [0, 1].map(|side| rows.iter().map(|row| measured(row)[side].errors).sum());
    let [stock, sbbk] = totals.map(|total: ContactErrors| errors(&total));
    let mean = times(geometric_mean(rows.iter().filter_map(ratio_of)));
    let blank_count = rows.first().map_or(0, |row| description(row).len() + 1);
    let blanks = vec![String::new(); blank_count];
    table.push([cells![name, "mean, or all"], blanks, cells![mean, stock, sbbk]].concat());
    table
}

pub(super) fn errors(errors: &ContactErrors) -> String {
    let ContactErrors { pairs, wrong_normal, .. } = errors;
    let [missed, phantom, wrong_depth] = [pairs.missed, pairs.phantom, pairs.wrong_depth];
    format!("{missed}+{phantom}+{wrong_depth}+{wrong_normal} of {}", pairs.true_pairs)
}
