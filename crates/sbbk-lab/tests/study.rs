//! The experiments on a small scale, and what reports make of them.

mod support;

use std::collections::HashSet;
use std::path::Path;

use sbbk_lab::backend::Backend;
use sbbk_lab::metrics::RunPlan;
use sbbk_lab::report::{tables, write_csv, write_json, write_plot};
use sbbk_lab::scene::HelicopterBallDrop;
use sbbk_lab::study::{
    ComparePlan, Comparison, CutRow, HelicopterPlan, Hierarchy, PilePlan, Progress, SamePosesPlan,
    compare, cut,
};

/// Everything that `compare` does, in about a second.
fn small() -> Comparison {
    let quick = ComparePlan::quick();
    let plan = ComparePlan {
        helicopter: HelicopterPlan { repeats: 2, steps: 40 },
        heads: vec![5, 10],
        heads_without_recycling: 5,
        pile: PilePlan {
            repeats: 1,
            run: RunPlan { steps: 24, sample_every: 10, ..quick.pile.run },
            same_poses: quick.pile.same_poses.map(|plan| SamePosesPlan {
                repeats: 1,
                sample_size: 10,
                ..plan
            }),
            ..quick.pile
        },
        details: vec![4],
        head: None,
    };
    compare(&plan, &Progress::hidden()).unwrap()
}

/// Would catch an experiment or a backend that is left out, a table whose cells slip into the
/// next column, and files that lack what the tables show.
#[test]
fn a_comparison_covers_everything_and_can_be_reported() {
    let comparison = small();
    for row in &comparison.helicopter {
        assert_eq!(row.frames_per_second.count, 2);
        assert_eq!(row.steps, 40);
    }
    assert_eq!(comparison.helicopter.len(), 2 * Backend::ALL.len());
    let piles: Vec<_> = (comparison.piles.iter())
        .map(|pile| (pile.heads, pile.contact_recycling, pile.runs.len(), pile.same_poses.len()))
        .collect();
    assert_eq!(piles, [(5, true, 3, 4), (10, true, 3, 4), (5, false, 3, 0)]);
    assert_eq!(comparison.meshes.len(), 2);

    let grids = tables::all(&comparison);
    assert_eq!(grids.len(), 8);

    let report = support::report(&comparison);
    assert_eq!(report.json["piles"][1]["runs"][2]["backend"], "sbbk");
    let studies: HashSet<&str> = report.csv.iter().map(|line| &line[0]).collect();
    assert_eq!(studies.len(), 5, "{studies:?}");
    assert!(report.svg.contains("the paper"));
}

/// Would catch a panic, or silence, where a file cannot be written.
#[test]
fn a_file_that_cannot_be_written_is_named() {
    let comparison = Comparison {
        helicopter: Vec::new(),
        piles: Vec::new(),
        cut: None,
        meshes: Vec::new(),
        ..small()
    };
    let path = Path::new("no/such/folder/out");
    for error in
        [write_json(&comparison, path), write_csv(&comparison, path), write_plot(&comparison, path)]
    {
        let message = error.unwrap_err().to_string();
        assert!(message.contains("no/such/folder/out"), "{message}");
    }
}

/// Would catch a cut that prunes true contacts, or one that does not cut: deeper cuts report no
/// more triangles, k-DOPs no more than boxes, and no cut fewer than truly touch.
#[test]
fn cuts_close_in_on_the_truth() {
    let study = cut(&HelicopterBallDrop::default()).unwrap().unwrap();
    let [aabb, sbbk] = Hierarchy::ALL.map(|hierarchy| -> Vec<CutRow> {
        let rows = study.rows.iter().filter(|row| row.hierarchy == hierarchy);
        rows.copied().collect()
    });
    assert_eq!(aabb.len(), sbbk.len());
    for rows in [&aabb, &sbbk] {
        assert!(rows.is_sorted_by(|a, b| a.triangle_count >= b.triangle_count));
        assert!(rows.is_sorted_by(|a, b| a.volume >= b.volume));
        assert!(rows[0].triangle_count > 4 * rows[rows.len() - 1].triangle_count);
        assert!(rows[rows.len() - 1].triangle_count >= study.true_triangle_count);
    }
    for (aabb, sbbk) in aabb.iter().zip(&sbbk) {
        assert!(sbbk.pair_count <= aabb.pair_count && sbbk.volume <= aabb.volume);
    }
    let last = aabb.len() - 1;
    assert!(sbbk[last].volume < aabb[last].volume);
    assert!(study.true_triangle_count > 0);
}
