//! The contact study on a small scale, and what reports make of it.

use std::collections::HashSet;

use sbbk_lab::mesh;
use sbbk_lab::report::Row;
use sbbk_lab::study::Progress;
use sbbk_lab::study::contacts::{ApproachedMesh, ContactsPlan, contacts};

use super::support;

/// Would catch poses at which nothing is near or nothing crosses, a judge that finds no fault with
/// anybody or does not look at normals, any wrong contact of SBBK, and reports that lose a row.
#[test]
fn every_case_has_contacts_and_sbbk_has_them_right() {
    let meshes = [mesh::ball(1.0, 4), mesh::torus(0.7, 0.3, 16, 8)];
    let plan = ContactsPlan {
        meshes: meshes.map(|mesh| ApproachedMesh { mesh, approach_count: 2 }).into(),
        case_repeats: 1,
        speed_repeats: 1,
        ..ContactsPlan::standard()
    };
    let study = contacts(&plan, &Progress::hidden());
    let [exactness, queries, pairs] =
        ["contacts: exactness", "contacts: queries, µs", "contacts: pairs, ns"]
            .map(|part| ["stock", "sbbk"].map(|side| support::rows(&study, part, side)));
    let total = |rows: &[&Row], path| rows.iter().map(|row| row.count(path)).sum::<u64>();
    assert_eq!(exactness.each_ref().map(Vec::len), [18, 18]);
    assert_eq!(total(&exactness[1], "pose_count"), plan.pose_count() as u64);
    for row in &exactness[1] {
        let [apart, crossing] = ["apart", "crossing"].map(|path| row.count(path));
        assert!(apart > 0 && crossing > 0, "{row:?}");
        assert_eq!(row.count("errors.true_pairs"), apart + crossing);
        assert!(2 * row.count("errors.judged_normals") > apart + crossing, "{row:?}");
    }
    for part in [&exactness, &queries, &pairs] {
        for row in part.iter().flatten() {
            assert!(row.number("time.min") > 0.0 && row.count("errors.true_pairs") > 0, "{row:?}");
        }
        assert!(part[1].iter().all(|row| row.wrong("errors") == 0), "{:?}", part[1]);
    }
    // Triangles of a centimetre and less are small against Parry's tolerances.
    let small: Vec<&Row> =
        exactness[0].iter().copied().filter(|row| row.number("size") < 1.0).collect();
    assert!(total(&small, "errors.missed") > 0 && total(&small, "errors.wrong_normal") > 0);
    assert!(queries[1].iter().all(|row| row.count("sequence_count") == 10));
    for row in pairs.iter().flatten() {
        assert!(row.count("pair_count") > row.count("crossing") && row.count("crossing") > 0);
        assert_eq!(row.count("errors.true_pairs"), row.count("pair_count"));
    }

    // Nine sizes and distances, two meshes, and twice three ways to ask of two meshes each.
    assert_eq!(support::line_counts(&study), [10, 3, 9, 9]);
    let report = support::report(&study);
    let lines = report.csv.iter().filter(|line| &line[0] == "contacts: exactness");
    let scenes: HashSet<_> = lines.map(|line| line[1].to_owned()).collect();
    assert_eq!(scenes.len(), 18, "{scenes:?}");
    assert!(scenes.iter().any(|scene| scene.contains("prediction 0.02, size 0.1")), "{scenes:?}");
    let is_steady =
        |line: &&csv::StringRecord| line[1].contains("steady, 0.05") && &line[5] == "wrong_normal";
    assert_eq!(report.csv.iter().filter(is_steady).count(), 8);
    assert!(report.svg.contains("wrong contacts"));
}
