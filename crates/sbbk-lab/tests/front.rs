//! The study of the front on a small scale, and what reports make of it.

mod support;

use sbbk_lab::mesh;
use sbbk_lab::report::tables;
use sbbk_lab::study::Progress;
use sbbk_lab::study::front::{FrontMotion, FrontPlan, STEP_COUNT, Variant, front};

/// Would catch a variant that answers wrongly, motions in which nothing touches or that are not what they are called,
/// parts of the front that do nothing, and reports that lose a column or a row.
#[test]
fn all_variants_agree_and_can_be_reported() {
    let meshes = vec![mesh::ball(1.0, 6), mesh::torus(0.7, 0.3, 24, 12)];
    let plan = FrontPlan { meshes, approach_count: 1, repeats: 1 };
    let study = front(&plan, &Progress::hidden()).unwrap();
    assert_eq!(study.rows.len(), 2 * FrontMotion::ALL.len());
    for row in &study.rows {
        assert_eq!(row.query_count, 5 * (STEP_COUNT + 1));
        assert_eq!(row.variants.iter().map(|row| row.variant).collect::<Vec<_>>(), Variant::ALL);
        let fresh = &row.variants[0];
        assert!(fresh.pairs > 1.0 && fresh.node_tests > 10.0, "{row:?}");
        for variant in &row.variants {
            assert_eq!(variant.differing, 0, "{:?}: {variant:?}", row.motion);
            assert_eq!(variant.pairs, fresh.pairs);
            assert!(variant.leaf_pairs > 0.0 && variant.traversal.min > 0.0);
        }
        let tests =
            |variant| row.variants.iter().find(|row| row.variant == variant).unwrap().node_tests;
        match row.motion {
            FrontMotion::Slow | FrontMotion::Resting => {
                for variant in [Variant::Adaptive, Variant::Slack] {
                    assert!(2.0 * tests(variant) < fresh.node_tests, "{row:?}");
                }
                assert!(tests(Variant::Paper) < fresh.node_tests);
            }
            FrontMotion::Fast | FrontMotion::Tumbling => {
                assert!(tests(Variant::Adaptive) < 1.05 * fresh.node_tests, "{row:?}");
                assert!(tests(Variant::Paper) > tests(Variant::Adaptive), "{row:?}");
            }
        }
    }

    for journey in &study.journeys {
        let [stock, sbbk] = &journey.sides;
        assert_eq!((journey.teleport_count, journey.differing), (4, 0), "{journey:?}");
        assert_eq!(sbbk.errors.pairs.wrong() + sbbk.errors.wrong_normal, 0, "{journey:?}");
        assert!(sbbk.errors.pairs.true_pairs > 5, "{journey:?}");
        assert_eq!(stock.errors.pairs.true_pairs, sbbk.errors.pairs.true_pairs);
    }

    let grids = tables::front(&study);
    let row_counts: Vec<_> = grids.iter().map(|grid| grid.rows.len()).collect();
    assert_eq!(row_counts, [8 * 5, 4 * 5, 3]);
    let report = support::report(&study);
    assert_eq!(report.json["rows"][7]["variants"][4]["differing"], 0);
    let node_tests: Vec<_> = report.csv.iter().filter(|line| &line[4] == "node_tests").collect();
    assert!(node_tests.iter().any(|line| &line[3] == "(e) slack + c" && &line[5] == "value"));
    assert_eq!(node_tests.len(), 40);
    assert!(report.svg.contains("Traversal, tumbling"));
}
