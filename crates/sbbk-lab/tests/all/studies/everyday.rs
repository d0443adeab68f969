//! The study of everyday scenes on a small scale, and what reports make of it.

use sbbk_lab::report::Row;
use sbbk_lab::study::Progress;
use sbbk_lab::study::everyday::{EverydayPlan, GroundPlan, everyday};

use super::support;

/// Would catch scenes in which nothing touches or moves, a comparison that counts nothing or finds
/// every contact different, contacts of whole pairs that SBBK loses or adds, a judge that blames the
/// wrong side, robots without meshes, rows without a side or a verdict, and reports that lose a
/// group.
#[test]
fn contacts_are_compared_in_every_scene() {
    let ground = |cell, fixes_edges| GroundPlan { cells: 16, cell, fixes_edges };
    let plan = EverydayPlan {
        grounds: vec![ground(1.0, false), ground(0.5, true)],
        bodies: 20,
        steps: 40,
        repeats: 1,
        cells: 64,
        world_cells: 64,
        small_meshes: 300,
        deformable_cells: 48,
        heads: 8,
        query_cells: vec![24],
        ..EverydayPlan::quick()
    };
    let study = everyday(&plan, &Progress::hidden()).unwrap();
    let of = |backend: &str| -> Vec<&Row> {
        study.rows.iter().filter(|row| row.backend == backend).collect()
    };
    let (stock, sbbk) = (of("stock"), of("sbbk"));
    assert_eq!(stock.len(), sbbk.len());
    for (stock, sbbk) in stock.iter().zip(&sbbk) {
        assert!(stock.study == sbbk.study && stock.keys == sbbk.keys);
        assert!(sbbk.get("verdict").is_some(), "{sbbk:?}");
        if sbbk.study == "everyday: queries" {
            assert!(sbbk.count("answers.true_pairs") > 0, "{sbbk:?}");
            assert_eq!(sbbk.wrong("answers"), 0, "{sbbk:?}");
        } else {
            assert!(stock.number("detection.median") > 0.0, "{stock:?}");
            assert!(stock.number("detection.max") >= stock.number("detection.p99"), "{stock:?}");
            assert!(sbbk.number("mesh_mebibytes") > 0.0, "{sbbk:?}");
            assert_eq!(sbbk.count("pairs.missed") + sbbk.count("pairs.phantom"), 0, "{sbbk:?}");
        }
    }
    for row in sbbk.iter().filter(|row| row.study == "everyday: bodies on terrains") {
        assert!(row.count("pairs.true_pairs") > 10, "{row:?}");
        assert!(row.count("triangles_of_pairs.true_pairs") > row.count("pairs.true_pairs"));
    }
    let robots = sbbk.iter().filter(|row| {
        row.get("scene").and_then(|scene| scene.as_str()).is_some_and(|name| name.contains("URDF"))
    });
    let touching = |row: &&&Row| row.count("triangles_of_pairs.true_pairs") > 100;
    assert_eq!(robots.filter(touching).count(), 2);

    let wrong = |rows: &[&Row]| rows.iter().map(|row| row.wrong("judged")).sum::<u64>();
    assert!(wrong(&stock) > 100 * wrong(&sbbk).max(1), "{} {}", wrong(&stock), wrong(&sbbk));

    assert_eq!(support::line_counts(&study), [14 + 2, 7, 4, 4, 1, 51 + 17]);
    assert!(support::report(&study).svg.contains("manifolds, no workspace"));
}
