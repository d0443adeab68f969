//! The study of convex shapes and compounds on a small scale, and what reports make of it.

use csv::StringRecord;
use sbbk_lab::mesh;
use sbbk_lab::report::Row;
use sbbk_lab::study::convex::{ConvexPlan, convex};
use sbbk_lab::study::{Progress, STEP_COUNT};

use super::support;

/// Would catch a kind that nothing touches, a judge that takes parts of compounds for each other
/// (then all their contacts are wrong) or finds no fault at all, any wrong contact of SBBK's, at any
/// size and in motion, and reports that lose a kind.
#[test]
fn sbbks_contacts_are_right() {
    let plan = ConvexPlan {
        mesh: mesh::monkey_head_with(6),
        approach_count: 1,
        repeats: 1,
        meshes: vec![mesh::monkey_head_with(6)],
        sizes: vec![0.01, 2.0],
        predictions: vec![0.0001, 0.02],
        ..ConvexPlan::standard()
    };
    let study = convex(&plan, &Progress::hidden());
    for row in &study.rows {
        let is_steady = row.get("mode").is_some_and(|mode| mode != "fresh");
        let places = if row.is("depth", "deep") { 2 } else { 5 };
        let queries = places * if is_steady { STEP_COUNT as u64 / 4 + 1 } else { 1 };
        assert_eq!(row.count("errors.mesh_pairs"), queries, "{row:?}");
        assert!(is_steady || row.count("errors.true_pairs") > 0, "{row:?}");
        assert!(row.backend == "stock" || row.wrong("errors") == 0, "{row:?}");
    }
    let sum = |backend: &str, count: &dyn Fn(&Row) -> u64| {
        study.rows.iter().filter(|row| row.backend == backend).map(count).sum::<u64>()
    };
    let stocks = sum("stock", &|row| row.wrong("errors"));
    let reported = sum("sbbk", &|row| row.count("errors.reported"));
    assert!(stocks > 500 && reported > 3000, "{stocks} wrong, {reported} reported");
    let compounds = support::rows(&study, "compounds: queries, µs", "sbbk");
    let mut parts: Vec<u64> = compounds.iter().map(|row| row.count("part_count")).collect();
    parts.dedup();
    assert_eq!(parts, [3, 8, 24]);

    // Four modes, touching and deep; two sizes; two prediction distances, one of them larger than
    // the smaller mesh.
    assert_eq!(support::line_counts(&study), [8 * 17, 8 * 4, 2 * 20, 3]);
    let report = support::report(&study);
    let of_all = |line: &&StringRecord| &line[4] == "errors" && &line[5] == "missed";
    assert_eq!(report.csv.iter().filter(of_all).count(), 19 * (8 + 3) * 2);
}
