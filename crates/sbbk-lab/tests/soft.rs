//! The study of deformable meshes on a small scale.

mod support;

use sbbk_lab::study::Progress;
use sbbk_lab::study::soft::{SoftPlan, soft};

/// Would catch a scene in which nothing touches, a judge that looks at the vertices of another step (then even SBBK's exact
/// contacts would be wrong), contacts lost by a refit, and reports that lose steps or frames.
#[test]
fn soft_heads_touch_and_nothing_is_lost() {
    let plan =
        SoftPlan { heads: 1, steps: 45, repeats: 1, judged_every: 5, detail: 12, frames: 20 };
    let study = soft(&plan, &Progress::hidden()).unwrap();
    let errors = study.heads[1].errors;
    assert!(errors.true_pairs > 100, "{errors:?}");
    assert_eq!((errors.missed, errors.phantom, errors.wrong_depth), (0, 0, 0), "{errors:?}");
    let refit = &study.refit;
    assert!(refit.contacts > 1000, "{}", refit.contacts);
    assert_eq!((refit.lost, refit.added), (0, 0));
    assert!(refit.by_frame.iter().all(|frame| frame.contacts == frame.refitted_contacts));

    let report = support::report(&study);
    assert_eq!(report.json["refit"]["by_frame"][19]["lost"], 0);
    let lines = |quantity| report.csv.iter().filter(|line| &line[4] == quantity).count();
    assert_eq!((lines("queries_by_step"), lines("by_frame")), (2 * 45, 20 * 8));
    assert!(report.svg.contains("refit of all layers"));
}
