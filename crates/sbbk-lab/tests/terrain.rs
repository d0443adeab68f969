//! The study of terrains on a small scale, and what reports make of it.

mod support;

use sbbk_lab::backend::Backend;
use sbbk_lab::scene::Ground;
use sbbk_lab::study::Progress;
use sbbk_lab::study::terrain::{HEAD_COUNT, TerrainPlan, terrain};

/// Would catch places without contacts, wrong contacts, numbers of triangles that are not those of the mesh, heads that fall
/// through, and reports that lose a way to answer.
#[test]
fn heads_stay_on_terrains_and_contacts_are_right() {
    let plan = TerrainPlan { cells: vec![32], place_count: 3, repeats: 1, fall_steps: 90 };
    let study = terrain(&plan, &Progress::hidden()).unwrap();
    let ways: Vec<_> = study.rows.iter().map(|row| (row.backend, row.ground)).collect();
    let on_meshes = [(Backend::Stock, Ground::Mesh), (Backend::Sbbk, Ground::Mesh)];
    assert_eq!(ways, [&on_meshes[..], &[(Backend::Sbbk, Ground::HeightField)]].concat());
    for row in &study.rows[1..] {
        assert!(row.errors.true_pairs > 50 && row.errors.wrong() == 0, "{row:?}");
    }
    assert!(study.rows[2].cells_read.is_some_and(|count| count < 1000.0));
    let left: Vec<_> = study.falls.iter().map(|fall| (fall.backend, fall.left())).collect();
    let [stock, sbbk] = [Backend::Stock, Backend::Sbbk];
    assert_eq!(left, [(stock, 0), (sbbk, HEAD_COUNT), (sbbk, HEAD_COUNT)]);

    let report = support::report(&study);
    assert_eq!(report.json["falls"][0]["heads_above"][0], HEAD_COUNT);
    let above = report.csv.iter().filter(|line| &line[4] == "heads_above");
    assert_eq!(above.count(), 3 * plan.fall_steps);
    assert!(report.svg.contains("sbbk, height field"));
}
