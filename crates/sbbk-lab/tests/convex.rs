//! The study of convex shapes and compounds on a small scale, and what reports make of it.

mod support;

use sbbk_lab::mesh;
use sbbk_lab::report::tables;
use sbbk_lab::study::Progress;
use sbbk_lab::study::contacts::{Mode, STEP_COUNT};
use sbbk_lab::study::convex::{ConvexPlan, convex, kinds};

/// Would catch a kind that nothing touches, a judge that takes parts of compounds for each other (then all their contacts
/// are wrong) or finds no fault with anybody, contacts lost by SBBK, and reports that lose a kind.
#[test]
fn every_kind_has_contacts_and_first_ones_are_right() {
    let mesh = mesh::monkey_head_with(6);
    let plan = ConvexPlan { mesh, approach_count: 1, repeats: 1, ..ConvexPlan::standard() };
    let study = convex(&plan, &Progress::hidden()).unwrap();
    assert_eq!(study.rows.len(), kinds().len());
    let (mut wrong_count, mut missed) = (0, [0, 0]);
    for row in &study.rows {
        let [stock, sbbk] = row.sides.each_ref().map(|side| side.measured(Mode::Fresh).errors);
        assert!(sbbk.true_pairs > 0 && sbbk.mesh_pairs == 5, "{row:?}");
        assert_eq!((stock.wrong(), sbbk.wrong()), (0, 0), "{row:?}");
        for mode in [Mode::Slow, Mode::Fast] {
            let [stock, sbbk] = row.sides.each_ref().map(|side| side.measured(mode).errors);
            assert_eq!(sbbk.mesh_pairs, 5 * (STEP_COUNT + 1));
            missed = [missed[0] + stock.missed, missed[1] + sbbk.missed];
            wrong_count += stock.wrong() + sbbk.wrong();
        }
    }
    assert!(missed[1] <= missed[0], "{missed:?}");
    assert!(wrong_count > 0, "kept contacts of cylinders and cones are never quite right");
    let parts: Vec<_> = study.rows.iter().filter_map(|row| row.part_count).collect();
    assert_eq!(parts, [3, 8, 24]);

    let [shapes, compounds] = tables::convex(&study);
    assert_eq!((shapes.rows.len(), compounds.rows.len()), (3 * 17, 3 * 4));
    let report = support::report(&study);
    assert_eq!(report.json["rows"][18]["part_count"], 24);
    let lost = report.csv.iter().filter(|line| &line[5] == "errors.missed");
    assert_eq!(lost.count(), 19 * 3 * 2);
}
