//! The study of terrains on a small scale, and what reports make of it.

use sbbk_lab::report::Row;
use sbbk_lab::study::Progress;
use sbbk_lab::study::terrain::{TerrainPlan, terrain};

use super::support;

/// Would catch places without contacts, wrong contacts, numbers of triangles that are not those of
/// the mesh, heads that fall through, and reports that lose a way to answer.
#[test]
fn heads_stay_on_terrains_and_contacts_are_right() {
    let plan = TerrainPlan { cells: vec![32], place_count: 3, repeats: 1, fall_steps: 90 };
    let study = terrain(&plan, &Progress::hidden());
    let of = |part| -> Vec<&Row> { study.rows.iter().filter(|row| row.study == part).collect() };
    let way = |row: &&Row| (row.backend.clone(), row.keys["ground"].as_str().unwrap().to_owned());
    let way_of = |backend: &str, ground: &str| (backend.to_owned(), ground.to_owned());
    let queries = of("terrain: queries, µs");
    let ways: Vec<_> = queries.iter().map(way).collect();
    let expected = [("stock", "mesh"), ("sbbk", "mesh"), ("sbbk", "height field")];
    assert_eq!(ways, expected.map(|(backend, ground)| way_of(backend, ground)));
    for row in &queries[1..] {
        assert!(row.count("errors.true_pairs") > 50 && row.wrong("errors") == 0, "{row:?}");
    }
    assert!(queries[2].number("cells_read") < 1000.0);
    let falls = of("terrain: falling heads");
    let left: Vec<_> = falls.iter().map(|row| (way(row), row.count("left"))).collect();
    let expected =
        [("stock", "height field", 0), ("sbbk", "mesh", 16), ("sbbk", "height field", 16)];
    assert_eq!(left, expected.map(|(backend, ground, left)| (way_of(backend, ground), left)));

    let report = support::report(&study);
    let above = report.csv.iter().filter(|line| &line[4] == "heads_above");
    assert_eq!(above.count(), 3 * plan.fall_steps);
    assert!(report.svg.contains("sbbk, height field"));
}
