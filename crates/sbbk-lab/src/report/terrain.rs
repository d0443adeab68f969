//! The study of terrains as files and as a picture.

use super::look::Look;
use super::panel::{Panel, Scale, Series};
use super::{Grid, ResultRow, Results, tables};
use crate::backend::Backend;
use crate::metrics::{Environment, Summary};
use crate::scene::{Ground, Scene};
use crate::study::terrain::{Fall, Terrain, TerrainRow};

impl Results for Terrain {
    fn environment(&self) -> &Environment {
        &self.environment
    }

    fn tables(&self) -> Vec<Grid> {
        tables::terrains(self).into()
    }

    fn rows(&self) -> Vec<ResultRow> {
        let row = |row: &TerrainRow| {
            let scene = format!("{0} × {0} cells, {1}", row.cells, row.ground);
            ResultRow::new("terrain: queries, µs", scene, row)
        };
        let fall = |fall: &Fall| {
            let scene = Fall::scene(fall.ground).name();
            ResultRow::new("terrain: falling heads", scene, fall)
        };
        self.rows.iter().map(row).chain(self.falls.iter().map(fall)).collect()
    }

    /// Least time of a query by number of cells, and how many heads stay on a terrain.
    fn panels(&self) -> Vec<Panel> {
        vec![
            times(self, "First queries", |row| row.fresh),
            times(self, "Queries in slow motion", |row| row.steady),
            falls(&self.falls),
        ]
    }
}

fn times(study: &Terrain, title: &str, time: fn(&TerrainRow) -> Summary) -> Panel {
    let mut series: Vec<Series> = Vec::new();
    for row in &study.rows {
        let point = (f64::from(row.cells).powi(2), time(row).min);
        let label = label(row.backend, row.ground);
        match series.iter_mut().find(|series| series.label == label) {
            Some(series) => series.points.push(point),
            None => series.push(Series {
                label,
                look: look(row.backend, row.ground),
                is_connected: true,
                points: vec![point],
            }),
        }
    }
    Panel {
        title: title.to_owned(),
        x_label: "cells".to_owned(),
        y_label: "µs a query".to_owned(),
        scale: Scale::Logarithmic { zero: None },
        series,
    }
}

/// On the mesh, all stay as well; they would hide what happens on the field.
fn falls(falls: &[Fall]) -> Panel {
    let on_fields = falls.iter().filter(|fall| fall.ground == Ground::HeightField);
    let series = on_fields.map(|fall| {
        let seconds = |step: usize| (step + 1) as f64 / 60.0;
        let points = fall.heads_above.iter().enumerate().step_by(STEPS_A_POINT);
        Series {
            label: label(fall.backend, fall.ground),
            look: look(fall.backend, fall.ground),
            is_connected: true,
            points: points.map(|(step, &count)| (seconds(step), count as f64)).collect(),
        }
    });
    Panel {
        title: "Heads dropped on a height field".to_owned(),
        x_label: "seconds".to_owned(),
        y_label: "heads that are not under it".to_owned(),
        scale: Scale::FromZero,
        series: series.collect(),
    }
}

/// Steps from one marker to the next.
const STEPS_A_POINT: usize = 12;

fn label(backend: Backend, ground: Ground) -> String {
    format!("{backend}, {ground}")
}

fn look(backend: Backend, ground: Ground) -> Look {
    match (backend, ground) {
        (Backend::Sbbk, Ground::Mesh) => Look::Other(3),
        _ => Look::Backend(backend),
    }
}
