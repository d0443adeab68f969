//! The study of the front as files and as a picture.

use super::look::Look;
use super::panel::{Panel, Scale, Series};
use super::{Grid, ResultRow, Results, tables};
use crate::metrics::{Environment, ratio};
use crate::study::front::{FrontMotion, FrontRow, FrontStudy, Variant};

/// The variants that are drawn.
const DRAWN: [Variant; 4] = [Variant::Fresh, Variant::Paper, Variant::Adaptive, Variant::Slack];

fn panel(study: &FrontStudy, motion: FrontMotion) -> Panel {
    let rows = || study.rows.iter().filter(move |row| row.motion == motion);
    let series = DRAWN.into_iter().enumerate().map(|(number, variant)| Series {
        label: variant.to_string(),
        look: Look::Other(number),
        is_connected: true,
        points: rows().filter_map(|row| point(row, variant)).collect(),
    });
    Panel {
        title: format!("Traversal, {motion}"),
        x_label: "triangles of each mesh".to_owned(),
        y_label: "times faster than fresh descents".to_owned(),
        scale: Scale::FromZero,
        series: series.collect(),
    }
}

fn point(row: &FrontRow, variant: Variant) -> Option<(f64, f64)> {
    let time = |variant| {
        row.variants.iter().find(|row| row.variant == variant).map(|row| row.traversal.min)
    };
    Some((row.triangle_count as f64, ratio(time(Variant::Fresh)?, time(variant)?)?))
}

impl Results for FrontStudy {
    fn environment(&self) -> &Environment {
        &self.environment
    }

    fn tables(&self) -> Vec<Grid> {
        tables::front(self)
    }

    fn rows(&self) -> Vec<ResultRow> {
        let rows = self.rows.iter().flat_map(|row| {
            row.variants.iter().map(move |variant| {
                let FrontRow { motion, mesh, triangle_count, .. } = row;
                let scene = format!("{motion}, {mesh} of {triangle_count} triangles");
                ResultRow::named("front", scene, variant.variant.to_string(), variant)
            })
        });
        rows.collect()
    }

    /// How many times faster than a fresh descent the variants are, by the size of the mesh, for each kind of motion.
    fn panels(&self) -> Vec<Panel> {
        FrontMotion::ALL.map(|motion| panel(self, motion)).into()
    }
}
