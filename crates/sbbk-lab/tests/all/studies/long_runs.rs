//! The determinism and soak studies, in small.

use sbbk_lab::scene::MonkeyPile;
use sbbk_lab::study::Progress;
use sbbk_lab::study::determinism::{DeterminismPlan, broken, determinism};
use sbbk_lab::study::soak::{SoakPlan, soak};

use super::support;

/// Would catch a way that is left out, rows that are compared across backends, and a study that
/// calls different worlds the same.
#[test]
fn runs_are_compared_within_a_backend() {
    let plan = DeterminismPlan {
        scenes: vec![Box::new(MonkeyPile::with_heads(2))],
        steps: 60,
        thread_counts: vec![1, 2],
    };
    let mut found = determinism(&plan, &Progress::hidden());
    let runs = |backend| {
        let rows = support::rows(&found, "determinism", backend);
        rows.iter().map(|row| row.keys["run"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(runs("stock"), ["1 threads", "2 threads", "again"]);
    assert_eq!(runs("sbbk"), ["1 threads", "2 threads", "again", "forgetful"]);
    assert!(found.rows.iter().all(|row| row.count("manifold_count") > 0));
    assert!(broken(&found).is_empty());
    let hash = found.rows[3].get("fingerprint").unwrap().as_str().unwrap();
    assert!(found.tables[0].to_string().contains(hash), "{}", found.tables[0]);

    let stocks = found.rows[0].values["fingerprint"].clone();
    found.rows[6].values["fingerprint"] = stocks;
    assert_eq!(broken(&found).len(), 1, "the worlds of stock and SBBK differ");
}

/// Would catch trees that stay when their meshes are gone, an idle cache without bound, and a lost
/// contact where bodies and meshes come and go.
#[test]
fn nothing_is_left_behind() {
    let plan = SoakPlan {
        steps: 800,
        spawn_every: 2,
        body_limit: 10,
        window: 400,
        sample_every: 20,
        sample_size: 5,
    };
    let (soak, end) = soak(&plan, &Progress::hidden());
    assert_eq!((soak.rows.len(), end.wrong, end.trees_left), (2, 0, 0));
    assert!(soak.tables[0].title.starts_with("400 bodies"), "{}", soak.tables[0]);
    let last = &soak.rows[1];
    assert!(last.count("tree_builds") > 100, "{last:?}");
    assert!(last.count("trees") < 90, "{last:?}");
    let true_pairs: u64 = soak.rows.iter().map(|row| row.count("errors.true_pairs")).sum();
    assert!(true_pairs > 300, "{true_pairs}");
}
