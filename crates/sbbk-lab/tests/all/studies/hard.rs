//! The study of hard scenes on a small scale.

use sbbk_lab::report::Row;
use sbbk_lab::study::Progress;
use sbbk_lab::study::hard::{Column, Group, HardPlan, hard};

use super::support;

/// Would catch scenes that nobody could pass, a control that is not judged or stands where meshes
/// are meant, flags that are not set, runs that are attributed to another column, and reports that
/// lose some.
#[test]
fn the_control_passes_and_sheets_hold_plain_meshes() {
    let plan = HardPlan {
        groups: vec![Group::Sunk, Group::Sheets],
        columns: vec![Column::Stock, Column::StockFlag, Column::Sbbk, Column::Control],
        recycling: vec![true],
        seeds: 1,
        shows_figures: true,
        ..HardPlan::quick()
    };
    let study = hard(&plan, &Progress::hidden()).unwrap();
    let verdicts = |column: Column, scene: &str| -> Vec<&Row> {
        let rows = support::rows(&study, "hard scenes", &column.to_string()).into_iter();
        let is_of = |row: &&Row| {
            row.get("scene").and_then(|name| name.as_str()).is_some_and(|name| name.contains(scene))
        };
        rows.filter(is_of).collect()
    };
    let passed = |rows: &[&Row]| rows.iter().all(|row| row.count("passed") == row.count("runs"));
    let controls = verdicts(Column::Control, "slab");
    assert!(controls.len() == 4 && passed(&controls), "{controls:?}");
    assert!(verdicts(Column::Control, "sheet").is_empty());
    for column in [Column::Stock, Column::Sbbk] {
        let sheets = verdicts(column, "sheet");
        assert!(sheets.len() == 4 && passed(&sheets), "{sheets:?}");
    }
    let fields = verdicts(Column::Sbbk, "height field");
    assert!(fields.len() == 2 && passed(&fields), "{fields:?}");
    assert!(!passed(&verdicts(Column::Stock, "height field")));
    // With the flag a sheet has a front only.
    assert!(passed(&verdicts(Column::StockFlag, "front")));
    assert!(verdicts(Column::StockFlag, "back").iter().all(|row| row.count("passed") == 0));

    assert_eq!(support::line_counts(&study), [10, 6 * 3 + 4 * 2]);
    assert!(support::report(&study).svg.contains("Hard scenes"));
}
