//! The floor of collision detection on a small scale.

use sbbk_lab::study::Progress;
use sbbk_lab::study::floor::{FloorPlan, floor};

/// Would catch recorded manifolds that a world is given for the wrong pair, or not at all: it would part
/// from the world that they are of.
#[test]
fn worlds_with_written_manifolds_stay_equal() {
    let plan = FloorPlan { heads: vec![10], steps: 80, repeats: 1 };
    let rows = floor(&plan, &Progress::hidden()).rows;
    assert_eq!(rows.len(), 4);
    for row in &rows {
        assert_eq!(row.get("are_equal"), Some(&true.into()));
        assert!(row.number("solver.median") > 0.0);
    }
}
