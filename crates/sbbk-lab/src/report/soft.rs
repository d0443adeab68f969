//! The study of deformable meshes as files and as a picture.

use super::look::Look;
use super::panel::{Panel, Scale, Series};
use super::{Grid, ResultRow, Results, tables};
use crate::backend::Backend;
use crate::metrics::{Environment, Summary};
use crate::study::soft::{RefitFrame, RefitStudy, Soft};

/// Markers along a curve, so that the curves of several can be told apart.
const MARKER_COUNT: usize = 18;

impl Results for Soft {
    fn environment(&self) -> &Environment {
        &self.environment
    }

    fn tables(&self) -> Vec<Grid> {
        vec![tables::soft_heads(self), tables::refit(self)]
    }

    fn rows(&self) -> Vec<ResultRow> {
        let heads = self.heads.iter();
        let heads = heads.map(|row| ResultRow::new("soft heads, ms", self.scene.clone(), row));
        let scene = format!("ball of {} triangles", self.refit.triangle_count);
        heads.chain([ResultRow::new("refit, ms", scene, &self.refit)]).collect()
    }

    /// Time of the queries of soft heads, time of refits, and contacts of the refitted mesh.
    fn panels(&self) -> Vec<Panel> {
        vec![heads(self), refits(&self.refit), contacts(&self.refit)]
    }
}

fn heads(study: &Soft) -> Panel {
    let series = study.heads.iter().map(|row| Series {
        label: row.backend.to_string(),
        look: Look::Backend(row.backend),
        is_connected: true,
        points: curve(&row.queries_by_step, |times| times.median),
    });
    Panel {
        title: "Soft heads fall on a helicopter".to_owned(),
        x_label: "step".to_owned(),
        y_label: "ms a step in queries, refits included".to_owned(),
        scale: Scale::FromZero,
        series: series.collect(),
    }
}

fn refits(study: &RefitStudy) -> Panel {
    let series = |label: &str, look: Look, time: fn(&RefitFrame) -> f64| Series {
        label: label.to_owned(),
        look,
        is_connected: true,
        // Frames differ little; the longest are other programs'.
        points: curve(&study.by_frame.iter().map(time).collect::<Vec<_>>(), |times| times.min),
    };
    Panel {
        title: format!("{} triangles deform", study.triangle_count),
        x_label: "frame".to_owned(),
        y_label: "ms a frame".to_owned(),
        scale: Scale::FromZero,
        series: vec![
            series("parry, set_vertices", Look::Backend(Backend::Stock), |frame| frame.parry),
            series("refit of all layers", Look::Backend(Backend::Sbbk), |frame| frame.all_layers),
            series("refit of AABBs only", Look::Backend(Backend::AabbOnly), |frame| {
                frame.aabb_only
            }),
        ],
    }
}

fn contacts(study: &RefitStudy) -> Panel {
    let series = |label: &str, look: Look, count: fn(&RefitFrame) -> usize| {
        let counts = study.by_frame.iter().map(|frame| count(frame) as f64);
        Series {
            label: label.to_owned(),
            look,
            is_connected: true,
            points: curve(&counts.collect::<Vec<_>>(), |counts| counts.median),
        }
    };
    // The last one drawn is on top, and the smallest.
    let refitted = Look::Backend(Backend::Sbbk);
    let built = Look::Backend(Backend::Stock);
    Panel {
        title: "Contacts of these triangles with a torus".to_owned(),
        x_label: "frame".to_owned(),
        y_label: "pairs of triangles".to_owned(),
        scale: Scale::FromZero,
        series: vec![
            series("refitted tree", refitted, |frame| frame.refitted_contacts),
            series("tree built in each frame", built, |frame| frame.contacts),
            series("lost or added", Look::Other(5), |frame| frame.lost + frame.added),
        ],
    }
}

/// Values by their index, a few at a time.
fn curve(values: &[f64], sum_up: fn(&Summary) -> f64) -> Vec<(f64, f64)> {
    let length = values.len().div_ceil(MARKER_COUNT).max(1);
    let chunks = values.chunks(length).enumerate();
    let point = |(chunk, values): (usize, &[f64])| {
        let middle = (chunk * length) as f64 + 0.5 * (values.len() - 1) as f64;
        Some((middle, sum_up(&Summary::of(values.iter().copied())?)))
    };
    chunks.filter_map(point).collect()
}
