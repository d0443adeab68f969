//! The determinism and soak studies, in small.

use sbbk_lab::backend::Backend;
use sbbk_lab::report::tables;
use sbbk_lab::scene::MonkeyPile;
use sbbk_lab::study::Progress;
use sbbk_lab::study::determinism::{DeterminismPlan, Way, determinism};
use sbbk_lab::study::soak::{SoakPlan, soak};

/// Would catch a way that is left out, rows that are compared across backends, and a study that
/// calls different worlds the same.
#[test]
fn runs_are_compared_within_a_backend() {
    let plan = DeterminismPlan {
        scenes: vec![Box::new(MonkeyPile::with_heads(2))],
        steps: 60,
        thread_counts: vec![1, 2],
    };
    let mut found = determinism(&plan, &Progress::hidden()).unwrap();
    let [stock, sbbk] = &found.rows[..] else { panic!("{} rows", found.rows.len()) };
    let ways = |runs: &[_]| {
        runs.iter()
            .map(|run: &sbbk_lab::study::determinism::DeterminismRun| run.way)
            .collect::<Vec<_>>()
    };
    assert_eq!(stock.backend, Backend::Stock);
    assert_eq!(ways(&stock.runs), [Way::Threads(1), Way::Threads(2), Way::Again]);
    let with_forgetful = [Way::Threads(1), Way::Threads(2), Way::Again, Way::Forgetful];
    assert_eq!(ways(&sbbk.runs), with_forgetful);
    assert!(sbbk.is_same() && sbbk.manifold_count > 0);
    assert_eq!(found.broken().count(), 0);
    let table = tables::fingerprints(&found).to_string();
    assert!(table.contains(&sbbk.runs[0].fingerprint.to_string()), "{table}");

    let stocks = found.rows[0].runs[0].fingerprint;
    found.rows[1].runs[3].fingerprint = stocks;
    assert_eq!(found.broken().count(), 1, "the worlds of stock and SBBK differ");
    assert!(tables::fingerprints(&found).to_string().contains("forgetful differ"));
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
    let soak = soak(&plan, &Progress::hidden()).unwrap();
    assert_eq!((soak.rows.len(), soak.body_count, soak.trees_left), (2, 400, 0));
    let last = &soak.rows[1];
    assert!(last.tree_builds > 100, "{} trees built", last.tree_builds);
    assert!(last.trees < 90, "{} trees kept, {} of them idle", last.trees, last.idle_trees);
    let errors = soak.errors();
    assert!(errors.true_pairs > 300, "{errors:?}");
    assert_eq!(errors.wrong(), 0, "{errors:?}");
}
