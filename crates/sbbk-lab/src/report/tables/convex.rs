//! A mesh against convex shapes and compounds.

use super::super::Grid;
use super::super::format::errors;
use super::cells;
use super::race::{FRESH_NOTE, Raced, Shown, motion_note, race, ratio_note};
use crate::metrics::ErrorCount;
use crate::study::contacts::{Mode, Side};
use crate::study::convex::{Convex, ConvexRow};

/// Times and errors of first and steady queries, kind by kind: of convex shapes, and of compounds.
pub fn convex(study: &Convex) -> [Grid; 2] {
    let (compounds, convex) = study.rows.iter().cloned().partition(|row| row.part_count.is_some());
    [of_kinds(study, "convex shapes", convex), of_kinds(study, "compounds", compounds)]
}

fn of_kinds(study: &Convex, kinds: &str, rows: Vec<ConvexRow>) -> Grid {
    let Convex { mesh, triangle_count, prediction, .. } = study;
    Grid {
        title: format!(
            "A mesh against {kinds}: {mesh} of {triangle_count} triangles, prediction \
             distance {prediction}; microseconds a query"
        ),
        notes: vec![
            FRESH_NOTE.to_owned(),
            motion_note("all its answers"),
            "every other place or motion is asked with the mesh first".to_owned(),
            ratio_note(),
            "errors: lost + added + wrong depth, of the true contacts in all answers, against \
             Parry's routine run afresh on every triangle (and part); added is what Parry's own distance denies, too; \
             1 % of the prediction distance may go either way, depths are wrong from 5 % on"
                .to_owned(),
        ],
        ..race(&["shape", "places or motions"], &rows)
    }
}

impl Raced for ConvexRow {
    type Errors = ErrorCount;

    fn sides(&self) -> &[Side<ErrorCount>; 2] {
        &self.sides
    }

    fn description(&self, _: Mode) -> Vec<String> {
        cells![self.kind, self.place_count]
    }
}

impl Shown for ErrorCount {
    fn shown(&self) -> String {
        errors(self)
    }
}
