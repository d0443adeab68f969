//! The page of all studies.

use std::fs;

use sbbk_lab::backend::Backend;
use sbbk_lab::report::{Section, write_html};
use sbbk_lab::study::Progress;
use sbbk_lab::study::cost::{CostPlan, cost};

use super::support;

/// Would catch cost that is attributed to another size or does not grow, exponents of other points,
/// and a page without a table, a diagram, the command or the machine.
#[test]
fn cost_grows_and_is_shown_on_a_page() {
    let plan = CostPlan { heads: vec![10, 40], details: vec![6, 24], few: 10, ..CostPlan::quick() };
    let study = cost(&plan, &Progress::hidden());
    for backend in ["stock", "sbbk"] {
        let exponents = support::rows(&study, "cost: exponents", backend);
        for row in exponents {
            let exponent = row.number("collision_detection");
            assert!(exponent > 0.1 && exponent < 2.5, "{row:?}");
        }
        let counts: Vec<u64> =
            support::rows(&study, "cost", backend).iter().map(|row| row.count("count")).collect();
        assert_eq!(counts, [10, 40, 288, 4608]);
    }
    assert_eq!(plan.backends, [Backend::Stock, Backend::Sbbk]);
    assert_eq!(support::line_counts(&study), [8, 4]);
    support::report(&study);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page.html");
    let machine = study.environment.to_string();
    let section = Section { title: "Cost & more", text: "Text.", results: study };
    write_html(&path, "Title", "the command", &[section]).unwrap();
    let page = fs::read_to_string(path).unwrap();
    for part in ["Cost &amp; more", "the command", &machine, "<svg", "triangles a mesh</td>"] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!([page.matches("<table").count(), page.matches("<tr>").count()], [2, 2 + 8 + 4]);
}
