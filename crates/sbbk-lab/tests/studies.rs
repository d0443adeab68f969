//! Every study on a small scale: its rows fill its tables, its verdict has numbers, and SBBK is
//! right.

use clap::ValueEnum;
use rapier3d::geometry::TriMeshFlags;
use sbbk_core::surface::SurfaceKind;
use sbbk_lab::backend::Backend;
use sbbk_lab::mesh;
use sbbk_lab::progress::Progress;
use sbbk_lab::report::{Results, Row, tables};
use sbbk_lab::study::compare::{ComparePlan, compare};
use sbbk_lab::study::contacts::{ContactsPlan, contacts};
use sbbk_lab::study::convex::{ConvexPlan, convex};
use sbbk_lab::study::everyday::{EverydayPlan, Subject, advise, everyday};
use sbbk_lab::study::hard::random::{Family, Options, RandomPlan, random};
use sbbk_lab::study::hard::{self, Column, HardPlan, Settings};
use sbbk_lab::study::one_step::{OneStepPlan, one_step};

/// Checks the shown text and the files, and returns the wrong contacts of stock and of SBBK at any
/// of some paths.
fn check(results: &Results, errors: &[&str]) -> [u64; 2] {
    let text = results.to_string();
    let verdict = text.lines().next().unwrap_or_default();
    assert!(verdict.starts_with("VERDICT: ") && !verdict.contains("NaN"), "{verdict}");
    let tables = tables(results.study, &results.csv());
    assert!(!tables.is_empty(), "{text}");
    assert!(results.csv().lines().count() > results.rows.len(), "{}", results.csv());
    let wrong = |backend: &str| {
        let rows = results.rows.iter().filter(|row| row.backend == backend);
        rows.flat_map(|row| errors.iter().map(|path| row.wrong(path))).sum::<u64>()
    };
    [wrong("stock"), wrong("sbbk")]
}

#[test]
fn compare_measures_both_experiments_of_the_paper() {
    let plan = ComparePlan { drops: 2, heads: vec![30], ..ComparePlan::quick() };
    let results = compare(&plan, &Progress::hidden());
    let [stock, sbbk] = check(&results, &["fresh", "updated", "fresh_error"]);
    assert!(stock > 0 && sbbk == 0, "{stock} {sbbk}");
}

#[test]
fn contacts_are_judged_in_every_case() {
    let meshes = vec![(mesh::monkey_head_with(6), 1)];
    let plan = ContactsPlan { meshes, ..ContactsPlan::quick() };
    let results = contacts(&plan, &Progress::hidden());
    let [stock, sbbk] = check(&results, &["errors"]);
    assert!(stock > 500 && sbbk == 0, "{stock} {sbbk}");
    let mut judged = results.rows.iter().filter(|row| !row.study.contains("default"));
    assert!(judged.all(|row| row.count("errors.true_pairs") > 0));
}

#[test]
fn convex_shapes_and_compounds_are_judged() {
    let plan = ConvexPlan { mesh: mesh::monkey_head_with(6), repeats: 1, ..ConvexPlan::quick() };
    let results = convex(&plan, &Progress::hidden());
    let [stock, sbbk] = check(&results, &["errors"]);
    assert!(stock > 500 && sbbk == 0, "{stock} {sbbk}");
}

#[test]
fn more_substeps_come_nearer_to_the_converged_step() {
    let plan = OneStepPlan {
        heads: 20,
        backends: vec![Backend::Stock, Backend::Sbbk],
        substeps: vec![1, 16],
        moments: vec![60, 90],
        reference_substeps: 128,
    };
    let results = one_step(&plan, &Progress::hidden());
    check(&results, &[]);
    let errors: Vec<f64> = results.rows.iter().map(|row| row.number("error.median")).collect();
    let [_, sbbk, stock16, sbbk16] = errors[..] else { panic!("{errors:?}") };
    assert!(sbbk16 > 0.0 && sbbk16 < 0.7 * sbbk && sbbk16 < 0.5 * stock16, "{errors:?}");
}

fn everyday_plan() -> EverydayPlan {
    EverydayPlan {
        grounds: vec![
            (16, 1.0, TriMeshFlags::empty()),
            (16, 0.5, TriMeshFlags::FIX_INTERNAL_EDGES),
        ],
        bodies: 10,
        steps: 30,
        repeats: 1,
        cells: 64,
        world_cells: 64,
        small_meshes: 100,
        deformable_cells: 48,
        heads: 8,
        query_cells: vec![24],
        ..EverydayPlan::quick()
    }
}

/// Would catch scenes in which nothing touches, robots without meshes, and rows of one side.
#[test]
fn everyday_scenes_touch_and_are_judged() {
    let results = everyday(&everyday_plan(), &Progress::hidden());
    let [stock, sbbk] = check(&results, &["judged"]);
    assert!(stock > 100 * sbbk.max(1), "{stock} {sbbk}");
    let of = |name: &'static str| results.rows.iter().filter(move |row| row.backend == name);
    assert!(of("stock").zip(of("sbbk")).all(|(a, b)| (a.study, &a.keys) == (b.study, &b.keys)));
    let is_robot = |row: &&Row| row.keys.values().any(|key| key.contains("URDF"));
    let touches = |row: &Row| row.count("judged.true_pairs") > 10;
    // Contacts of meshes with the loader's flags are not judged.
    assert_eq!(of("sbbk").filter(is_robot).map(touches).collect::<Vec<_>>(), [false, true]);
}

/// Would catch scenes that no backend could pass, flags that are not set, and runs under the name
/// of another column.
#[test]
fn the_control_passes_and_sheets_hold_plain_meshes() {
    let columns = vec![Column::StockFlag, Column::Sbbk, Column::Control];
    let plan = HardPlan {
        groups: vec![hard::Group::Sunk, hard::Group::Sheets],
        settings: Settings { columns, ..Settings::default() },
        mesh: None,
    };
    let results = hard::hard(&plan, &Progress::hidden()).unwrap();
    check(&results, &[]);
    let passed = |column: Column, scene: &str| -> Vec<bool> {
        let rows = results.rows.iter().filter(|row| row.study == "hard scenes");
        let rows = rows.filter(|row| row.backend == column.to_string());
        let rows = rows.filter(|row| row.keys["scene"].contains(scene));
        rows.map(|row| row.count("passed") == 1).collect()
    };
    assert_eq!(passed(Column::Control, "slab"), [true; 4]);
    assert_eq!(passed(Column::Sbbk, "sheet"), [true; 4]);
    assert_eq!(passed(Column::Sbbk, "height field"), [true; 2]);
    // With the flag a sheet has a front only.
    assert_eq!(passed(Column::StockFlag, "front"), [true; 2]);
    assert_eq!(passed(Column::StockFlag, "back"), [false; 2]);
}

/// Would catch scenes that Rapier's own shapes could not pass, and scenes that differ by column.
/// Rings, gears and bowls are left out: their hulls have seams. Rapier's shapes drop some parts of
/// grippers.
#[test]
fn random_scenes_hold_with_rapiers_own_shapes() {
    let columns = vec![Column::Stock, Column::Sbbk, Column::Control];
    let settings = Settings { columns, ..Settings::default() };
    let options = Options { seed: 1, unit: None };
    let without = [Family::Chains, Family::Gears, Family::Bowls, Family::Grippers];
    let mut families = Family::value_variants().to_vec();
    families.retain(|family| !without.contains(family));
    let plan = RandomPlan { families, numbers: 0..2, options, settings };
    let results = random(&plan, &Progress::hidden()).unwrap();
    check(&results, &[]);
    let all = |column: Column, count: &str| {
        let rows = results.rows.iter().filter(|row| row.study == "random scenes");
        rows.filter(|row| row.backend == column.to_string())
            .map(|row| row.count(count))
            .sum::<u64>()
    };
    assert_eq!(all(Column::Control, "held"), all(Column::Control, "scenes"), "{results}");
    assert!(all(Column::Stock, "held") < all(Column::Sbbk, "held"), "{results}");
}

/// Would catch settings that do not fit the mesh, and the flag, which is never of use.
#[test]
fn advice_fits_the_mesh() {
    let inside_out = mesh::turned_inside_out(mesh::cuboid(glamx::Vec3::ONE, 2));
    let cases = [
        (mesh::torus(0.005, 0.002, 48, 24), SurfaceKind::Solid),
        (mesh::torus(1.0, 0.35, 120, 50), SurfaceKind::Solid),
        (mesh::hills(20.0, 40), SurfaceKind::Sheet),
        (inside_out, SurfaceKind::InsideOut),
    ];
    for (mesh, kind) in &cases {
        let advice = advise(&Subject::mesh(mesh), 15, &Progress::hidden());
        let text = advice.to_string();
        assert_eq!((advice.kind, text.lines().count()), (*kind, 4), "{text}");
        assert!(advice.speeds().iter().all(|speed| *speed > 0.0), "{text}");
        assert!(!text.contains("FIX_INTERNAL_EDGES") && !text.contains("NaN"), "{text}");
        assert_eq!(text.contains("prepare_shape"), mesh.triangle_count() > 8192, "{text}");
        assert_eq!(text.contains("pushes out mesh bodies"), *kind == SurfaceKind::Solid);
        assert_eq!(text.contains("inwards"), *kind == SurfaceKind::InsideOut, "{text}");
        assert_eq!(text.contains("length_unit = 0.014"), mesh.name == "torus" && advice.size < 0.1);
        for [stock, sbbk] in &advice.rows {
            assert!(sbbk.wrong("judged") <= stock.wrong("judged"), "{sbbk:?}");
        }
    }
}
