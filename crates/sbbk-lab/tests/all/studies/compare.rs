//! The experiments on a small scale, and what reports make of them.

use std::collections::HashSet;
use std::path::Path;

use sbbk_lab::backend::Backend;
use sbbk_lab::metrics::RunPlan;
use sbbk_lab::report::{Results, Row};
use sbbk_lab::study::compare::{ComparePlan, compare};
use sbbk_lab::study::{HelicopterPlan, PilePlan, Progress, SamePosesPlan};

use super::support;

/// Everything that `compare` does, in about a second.
fn small() -> Results {
    let quick = ComparePlan::quick();
    let plan = ComparePlan {
        helicopter: HelicopterPlan { repeats: 2, steps: 40 },
        heads: vec![5, 10],
        heads_without_recycling: 5,
        pile: PilePlan {
            repeats: 1,
            run: RunPlan { steps: 24, sample_every: 10, ..quick.pile.run },
            same_poses: Some(SamePosesPlan { repeats: 1, sample_size: 10 }),
            ..quick.pile
        },
        details: vec![4],
        head: None,
    };
    compare(&plan, &Progress::hidden())
}

/// Would catch an experiment or a backend that is left out, a table whose cells slip into the
/// next column, and files that lack what the tables show.
#[test]
fn a_comparison_covers_everything_and_can_be_reported() {
    let comparison = small();
    let count = |study: &str, backend: Backend| {
        support::rows(&comparison, study, &backend.to_string()).len()
    };
    // Two balls, and the paper's; three piles, and the paper's; two piles with recycling; two
    // meshes.
    let counts = ["helicopter", "pile, whole runs", "pile, same poses", "trees and first queries"]
        .map(|study| Backend::ALL.map(|backend| count(study, backend)));
    assert_eq!(counts, [[2, 3, 3], [3, 4, 4], [2; 3], [2, 0, 2]]);
    for row in support::rows(&comparison, "trees and first queries", "sbbk") {
        assert!(row.count("errors.true_pairs") > row.count("pose_count"), "{row:?}");
        assert_eq!(row.wrong("errors"), 0, "{row:?}");
        assert!(row.number("time.min") > 0.0 && row.number("build.min") > 0.0, "{row:?}");
        assert!(row.count("bytes") > 0);
    }
    let fps = support::rows(&comparison, "helicopter", "sbbk")[1];
    assert_eq!((fps.count("frames_per_second.count"), fps.count("steps")), (2, 40));
    assert_eq!(comparison.tables.len(), 5);
    assert!(
        comparison.tables[0].lines[1].contains(&"1.11x".to_owned()),
        "{}",
        comparison.tables[0]
    );

    let report = support::report(&comparison);
    let studies: HashSet<&str> = report.csv.iter().map(|line| &line[0]).collect();
    assert_eq!(studies.len(), 4, "{studies:?}");
    assert!(report.svg.contains("the paper"));
}

/// Would catch a panic, or silence, where a file cannot be written.
#[test]
fn a_file_that_cannot_be_written_is_named() {
    let rows = vec![Row::new("study", "stock").with("time", 1.0)];
    let results = Results::new(rows, Vec::new(), Vec::new());
    let path = Path::new("no/such/folder/out");
    for error in [results.write_json(path), results.write_csv(path), results.write_plot(path)] {
        let message = error.unwrap_err().to_string();
        assert!(message.contains("no/such/folder/out"), "{message}");
    }
}
