//! The study of the front on a small scale, and what reports make of it.

use sbbk_lab::mesh;
use sbbk_lab::study::Progress;
use sbbk_lab::study::front::{FrontPlan, front};

use super::support;

/// Would catch a variant that answers wrongly, motions in which nothing touches or that are not
/// what they are called, a front that does nothing, and reports that lose a column or a row.
#[test]
fn all_variants_agree_and_can_be_reported() {
    let meshes = vec![mesh::ball(1.0, 6), mesh::torus(0.7, 0.3, 24, 12)];
    let plan = FrontPlan { meshes, approach_count: 1, repeats: 1 };
    let study = front(&plan, &Progress::hidden());
    let variants =
        ["fresh descent", "front of the paper", "adaptive front", "slack, as the dispatcher"]
            .map(|variant| support::rows(&study, "front", variant));
    for ((fresh, paper), (adaptive, slack)) in
        variants[0].iter().zip(&variants[1]).zip(variants[2].iter().zip(&variants[3]))
    {
        assert!(fresh.number("pairs") > 1.0 && fresh.number("node_tests") > 10.0, "{fresh:?}");
        for row in [fresh, paper, adaptive, slack] {
            assert_eq!((&row.keys, row.count("differing")), (&fresh.keys, 0), "{row:?}");
            assert_eq!(row.number("pairs"), fresh.number("pairs"));
            assert!(row.number("leaf_pairs") > 0.0 && row.number("traversal.min") > 0.0);
        }
        let motion = fresh.keys["motion"].to_string();
        let [fresh, paper, adaptive, slack] =
            [fresh, paper, adaptive, slack].map(|row| row.number("node_tests"));
        match &*motion {
            "\"slow\"" | "\"resting, jitter\"" => {
                assert!(2.0 * adaptive < fresh && 2.0 * slack < fresh && paper < fresh);
            }
            _ => assert!(adaptive < 1.05 * fresh && paper > adaptive),
        }
    }
    assert_eq!(variants.map(|rows| rows.len()), [8; 4]);

    let journeys = ["stock", "sbbk"].map(|side| support::rows(&study, "front: journey, µs", side));
    for (stock, sbbk) in journeys[0].iter().zip(&journeys[1]) {
        assert_eq!((sbbk.count("teleport_count"), sbbk.count("differing")), (4, 0), "{sbbk:?}");
        assert_eq!(sbbk.wrong("errors"), 0, "{sbbk:?}");
        assert!(sbbk.count("errors.true_pairs") > 5, "{sbbk:?}");
        assert_eq!(stock.count("errors.true_pairs"), sbbk.count("errors.true_pairs"));
    }

    assert_eq!(support::line_counts(&study), [8 * 4, 4 * 4, 3]);
    let report = support::report(&study);
    let node_tests: Vec<_> = report.csv.iter().filter(|line| &line[4] == "node_tests").collect();
    assert!(node_tests.iter().any(|line| &line[3] == "adaptive front" && &line[5] == "value"));
    assert_eq!(node_tests.len(), 32);
    assert!(report.svg.contains("Traversal, tumbling"));
}
