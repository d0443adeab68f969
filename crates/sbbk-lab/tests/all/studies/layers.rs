//! The study of layers on a small scale.

use sbbk_lab::mesh;
use sbbk_lab::study::Progress;
use sbbk_lab::study::layers::{LayersPlan, layers};

use super::support;

/// Would catch a plan that is not measured, and one that is compared with another pair's default.
#[test]
fn every_plan_is_measured_on_every_pair() {
    let pairs = vec![
        [mesh::ball(1.0, 4), mesh::ball(1.0, 4)],
        [mesh::floor(4.0, 6), mesh::torus(0.7, 0.3, 8, 6)],
    ];
    let plan = LayersPlan { pairs, approach_count: 1, repeats: 1 };
    let study = layers(&plan, &Progress::hidden());
    let modes = 3;
    assert_eq!(study.rows.len(), 2 * (11 + 6 * modes));
    assert!(study.rows.iter().all(|row| row.number("time") > 0.0));
    assert_eq!(support::line_counts(&study), [2, 2 * modes]);
}
