//! The contact study as files and as a picture.

use serde_json::json;

use super::against::time_against_error;
use super::{Grid, Panel, ResultRow, Results, tables};
use crate::metrics::Environment;
use crate::study::contacts::{Contacts, ExactnessRow, ExactnessSide, Mode, SpeedRow};

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

    /// Time against error: first queries in all cases, and the queries of the speed tables in motion.
    fn panels(&self) -> Vec<Panel> {
        let fresh = |side: usize| {
            let side = move |row: &ExactnessRow| {
                let ExactnessSide { query, errors, .. } = &row.sides[side];
                (*query, errors.share())
            };
            self.exactness.iter().map(side).collect()
        };
        let steady = |side: usize| {
            let side = move |row: &SpeedRow| {
                let modes = [Mode::Slow, Mode::Fast].map(|mode| row.sides[side].measured(mode));
                modes.map(|measured| (measured.time, measured.errors.share()))
            };
            self.speed.iter().flat_map(side).collect()
        };
        let first =
            format!("First queries: {} cases of mesh, size and distance", self.exactness.len());
        let motion = "Queries in motion, 2 units across, distance 0.02".to_owned();
        vec![time_against_error(first, fresh), time_against_error(motion, steady)]
    }
}
