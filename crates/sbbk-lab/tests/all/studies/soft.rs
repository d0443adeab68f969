//! The study of deformable meshes on a small scale.

use sbbk_lab::study::Progress;
use sbbk_lab::study::soft::{SoftPlan, soft};

use super::support;

/// Would catch a scene in which nothing touches, a judge that looks at the vertices of another step
/// (then even SBBK's exact contacts would be wrong), and reports that lose steps.
#[test]
fn soft_heads_touch_and_nothing_is_lost() {
    let plan = SoftPlan { heads: 1, steps: 45, repeats: 1, judged_every: 5 };
    let study = soft(&plan, &Progress::hidden());
    let sbbk = support::rows(&study, "soft heads, ms", "sbbk")[0];
    assert!(sbbk.count("errors.true_pairs") > 100, "{sbbk:?}");
    assert_eq!(sbbk.wrong("errors"), 0, "{sbbk:?}");

    let report = support::report(&study);
    let lines = |quantity| report.csv.iter().filter(|line| &line[4] == quantity).count();
    assert_eq!(lines("queries_by_step"), 2 * 45);
    assert!(report.svg.contains("sbbk"));
}
