//! The study of convex shapes and compounds on a small scale, and what reports make of it.

use sbbk_lab::mesh;
use sbbk_lab::report::Row;
use sbbk_lab::study::convex::{ConvexPlan, convex};
use sbbk_lab::study::{Progress, STEP_COUNT};

use super::support;

/// Would catch a kind that nothing touches, a judge that takes parts of compounds for each other (then
/// all their contacts are wrong) or finds no fault with anybody, contacts lost by SBBK, and reports
/// that lose a kind.
#[test]
fn every_kind_has_contacts_and_first_ones_are_right() {
    let mesh = mesh::monkey_head_with(6);
    let plan = ConvexPlan { mesh, approach_count: 1, repeats: 1, ..ConvexPlan::standard() };
    let study = convex(&plan, &Progress::hidden()).unwrap();
    let sum = |backend: &str, is_fresh: bool, count: fn(&Row) -> u64| {
        let rows = study.rows.iter().filter(|row| row.backend == backend);
        let mode = |row: &&Row| (row.get("mode") == Some(&"fresh".into())) == is_fresh;
        rows.filter(mode).map(count).sum::<u64>()
    };
    for row in &study.rows {
        let is_fresh = row.get("mode") == Some(&"fresh".into());
        let queries = 5 * if is_fresh { 1 } else { STEP_COUNT as u64 + 1 };
        assert_eq!(row.count("errors.mesh_pairs"), queries, "{row:?}");
        assert!(!is_fresh || row.count("errors.true_pairs") > 0, "{row:?}");
        // The judge is Parry's routine. SBBK has its own for most shapes, and may differ in depth.
        let wrong = match &*row.backend {
            "sbbk" => row.count("errors.missed") + row.count("errors.phantom"),
            _ => row.wrong("errors"),
        };
        assert!(!is_fresh || wrong == 0, "{row:?}");
    }
    let missed = ["stock", "sbbk"].map(|side| sum(side, false, |row| row.count("errors.missed")));
    assert!(missed[1] <= missed[0], "{missed:?}");
    let wrong = ["stock", "sbbk"].map(|side| sum(side, false, |row| row.wrong("errors")));
    assert!(wrong[0] + wrong[1] > 0, "kept contacts of cylinders and cones are never quite right");
    let compounds = support::rows(&study, "compounds: queries, µs", "sbbk");
    let mut parts: Vec<u64> = compounds.iter().map(|row| row.count("part_count")).collect();
    parts.dedup();
    assert_eq!(parts, [3, 8, 24]);

    assert_eq!(support::line_counts(&study), [3 * 17, 3 * 4]);
    let report = support::report(&study);
    let lost = report.csv.iter().filter(|line| &line[5] == "missed");
    assert_eq!(lost.count(), 19 * 3 * 2);
}
