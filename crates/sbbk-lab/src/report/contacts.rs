//! The contact study as files and as a picture.

use serde_json::json;

use super::look::Look;
use super::panel::{Panel, Scale, Series};
use super::{Grid, ResultRow, Results, tables};
use crate::metrics::{Environment, Summary};
use crate::study::contacts::{CONTESTANTS, ContactErrors, Contacts, ExactnessRow, SpeedRow};

/// Stands for no wrong contact at all in the plot, in wrong contacts for 100 true ones: less than
/// one contact of all, so that nothing else is drawn there.
const NONE_WRONG: f64 = 1e-4;

/// A point for each measurement, by contestant.
fn panel(title: String, measurements: impl Fn(usize) -> Vec<(Summary, ContactErrors)>) -> Panel {
    // The last one drawn is on top: stock's small squares leave SBBK's circles to be seen.
    let series = [1, 0].map(|side| Series {
        label: CONTESTANTS[side].to_string(),
        look: Look::Backend(CONTESTANTS[side]),
        is_connected: false,
        points: measurements(side)
            .into_iter()
            .filter_map(|(time, errors)| Some((time.median, 100.0 * errors.share()?)))
            .collect(),
    });
    Panel {
        title,
        x_label: "µs a query".to_owned(),
        y_label: "wrong contacts for 100 true ones".to_owned(),
        scale: Scale::Logarithmic { zero: Some(NONE_WRONG) },
        series: series.into(),
    }
}

impl Results for Contacts {
    fn environment(&self) -> &Environment {
        &self.environment
    }

    fn tables(&self) -> Vec<Grid> {
        tables::contacts(self)
    }

    fn rows(&self) -> Vec<ResultRow> {
        let mut rows = Vec::new();
        for row in &self.exactness {
            let study = "contacts: exactness";
            let ExactnessRow { pose_count, apart, crossing, .. } = row;
            let truth = json!({ "pose_count": pose_count, "apart": apart, "crossing": crossing });
            rows.push(ResultRow::new(study, row.case.to_string(), &truth));
            let sides = row.sides.iter();
            rows.extend(sides.map(|side| ResultRow::new(study, row.case.to_string(), side)));
        }
        let name = |mesh: &str, triangles: usize| format!("{mesh} of {triangles} triangles");
        for row in &self.speed {
            let scene = || name(&row.mesh, row.triangle_count);
            let sides = row.sides.iter();
            rows.extend(sides.map(|side| ResultRow::new("contacts: queries, µs", scene(), side)));
        }
        for row in &self.generators {
            let scene = || name(&row.mesh, row.triangle_count);
            let sides = row.sides.iter();
            rows.extend(sides.map(|side| ResultRow::new("contacts: pairs, ns", scene(), side)));
        }
        rows
    }

    /// Time against error over logarithmic axes: first queries in all cases, and the queries of the
    /// speed tables in motion.
    fn panels(&self) -> Vec<Panel> {
        let fresh = |side: usize| {
            let side = move |row: &ExactnessRow| (row.sides[side].query, row.sides[side].errors);
            self.exactness.iter().map(side).collect()
        };
        let steady = |side: usize| {
            let side = move |row: &SpeedRow| {
                let side = &row.sides[side];
                [side.slow, side.fast].map(|measured| (measured.time, measured.errors))
            };
            self.speed.iter().flat_map(side).collect()
        };
        let case_count = self.exactness.len();
        vec![
            panel(format!("First queries: {case_count} cases of mesh, size and distance"), fresh),
            panel("Queries in motion, 2 units across, distance 0.02".to_owned(), steady),
        ]
    }
}
