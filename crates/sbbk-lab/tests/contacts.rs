//! The contact study on a small scale, and what reports make of it.

mod support;

use std::collections::HashSet;
use std::sync::LazyLock;

use sbbk_lab::backend::Backend;
use sbbk_lab::mesh;
use sbbk_lab::report::tables;
use sbbk_lab::study::Progress;
use sbbk_lab::study::contacts::{ApproachedMesh, Contacts, ContactsPlan, contacts};

/// A ball and a torus in all nine cases of the standard plan, in a few seconds.
static SMALL: LazyLock<Contacts> = LazyLock::new(|| {
    let meshes = [mesh::ball(1.0, 4), mesh::torus(0.7, 0.3, 16, 8)];
    let plan = ContactsPlan {
        meshes: meshes.map(|mesh| ApproachedMesh { mesh, approach_count: 2 }).into(),
        case_repeats: 1,
        speed_repeats: 1,
        ..ContactsPlan::standard()
    };
    let contacts = contacts(&plan, &Progress::hidden()).unwrap();
    assert_eq!(contacts.exactness.len(), plan.cases().len());
    assert_eq!(
        contacts.exactness.iter().map(|row| row.pose_count).sum::<usize>(),
        plan.pose_count()
    );
    contacts
});

/// Would catch poses at which nothing is near or nothing crosses, a judge that finds no fault with
/// anybody or does not look at normals, and any wrong contact of SBBK.
#[test]
fn every_case_has_contacts_and_sbbk_has_them_right() {
    let contacts = &*SMALL;
    for row in &contacts.exactness {
        let [stock, sbbk] = &row.sides;
        assert_eq!([stock.backend, sbbk.backend], [Backend::Stock, Backend::Sbbk]);
        assert!(row.apart > 0 && row.crossing > 0, "{row:?}");
        assert_eq!(sbbk.errors.wrong(), 0, "{row:?}");
        assert_eq!(sbbk.errors.pairs.true_pairs, row.apart + row.crossing);
        assert!(2 * sbbk.errors.judged_normals > row.apart + row.crossing, "{row:?}");
        assert!(stock.query.min > 0.0 && sbbk.query.min > 0.0);
    }
    // Triangles of a centimetre and less are small against Parry's tolerances.
    let small = contacts.exactness.iter().filter(|row| row.case.size < 1.0);
    let stock = small.map(|row| row.sides[0].errors);
    let (missed, normals) = stock.fold((0, 0), |(missed, normals), errors| {
        (missed + errors.pairs.missed, normals + errors.wrong_normal)
    });
    assert!(missed > 0 && normals > 0, "{missed} {normals}");
    for row in &contacts.speed {
        assert_eq!((row.pose_count, row.motion_count), (10, 10));
        let sbbk = &row.sides[1];
        for measured in [sbbk.fresh, sbbk.slow, sbbk.fast] {
            assert!(measured.errors.pairs.true_pairs > 0 && measured.time.min > 0.0);
            assert_eq!(measured.errors.wrong(), 0, "{row:?}");
        }
    }
    for row in &contacts.generators {
        assert!(row.slow_pairs > row.slow_crossing && row.slow_crossing > 0, "{row:?}");
        for side in &row.sides {
            for (measured, pairs) in [
                (side.fresh, row.slow_pairs),
                (side.slow, row.slow_pairs),
                (side.fast, row.fast_pairs),
            ] {
                assert_eq!(measured.errors.pairs.true_pairs, pairs);
                assert!(measured.time.min > 0.0);
            }
        }
        assert_eq!(row.sides[1].slow.errors.wrong(), 0, "{row:?}");
    }
}

/// Would catch a table whose cells slip into the next column, and files that lack what the tables
/// show.
#[test]
fn the_study_can_be_reported() {
    let contacts = &*SMALL;
    let grids = tables::contacts(contacts);
    // Nine sizes and distances, two meshes, and twice three ways to ask of two meshes each.
    let row_counts: Vec<_> = grids.iter().map(|grid| grid.rows.len()).collect();
    assert_eq!(row_counts, [10, 3, 9, 9]);

    let report = support::report(contacts);
    assert_eq!(report.json["exactness"][17]["sides"][1]["errors"]["missed"], 0);
    let scenes: HashSet<_> = report
        .csv
        .iter()
        .filter(|line| &line[0] == "contacts: exactness")
        .map(|line| line[1].to_owned())
        .collect();
    assert_eq!(scenes.len(), 18, "{scenes:?}");
    let is_steady =
        |line: &&csv::StringRecord| &line[4] == "slow" && &line[5] == "errors.wrong_normal";
    assert_eq!(report.csv.iter().filter(is_steady).count(), 8);
    assert!(report.svg.contains("wrong contacts"));
}
