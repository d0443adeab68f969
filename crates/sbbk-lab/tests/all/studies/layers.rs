//! The study of layers on a small scale.

use sbbk_lab::mesh;
use sbbk_lab::report::Row;
use sbbk_lab::study::Progress;
use sbbk_lab::study::layers::{LayersPlan, layers};

use super::support;

/// Would catch a plan or a choice that is not measured, and a plan that is compared with another pair's
/// default.
#[test]
fn every_plan_is_measured_on_every_pair() {
    let pairs = vec![
        [mesh::ball(1.0, 4), mesh::ball(1.0, 4)],
        [mesh::floor(4.0, 6), mesh::torus(0.7, 0.3, 8, 6)],
    ];
    let plan = LayersPlan { pairs, approach_count: 1, repeats: 1 };
    let study = layers(&plan, &Progress::hidden());
    let modes = 3;
    let choices = 3;
    assert_eq!(study.rows.len(), 2 * (12 + 7 * modes) + choices);
    let is_measured = |row: &Row| row.number("time") > 0.0 || row.number("build") > 0.0;
    assert!(study.rows.iter().all(is_measured));
    assert_eq!(support::line_counts(&study), [2, 2 * modes, choices]);
}
