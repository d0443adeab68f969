//! The comparison as files and as a picture: Diagram 1, and time against error.

use super::look::Look;
use super::panel::{Panel, Scale, Series};
use super::{Grid, PAPER, ResultRow, Results, tables};
use crate::backend::Backend;
use crate::metrics::{Environment, ErrorCount, Summary, ratio};
use crate::study::{Comparison, MeshRow, PileStudy};

impl Results for Comparison {
    fn environment(&self) -> &Environment {
        &self.environment
    }

    fn tables(&self) -> Vec<Grid> {
        tables::all(self)
    }

    fn rows(&self) -> Vec<ResultRow> {
        let mut rows = Vec::new();
        for row in &self.helicopter {
            let scene = format!("{} ball", row.ball);
            rows.push(ResultRow::new("helicopter", scene, row).recycling(true));
        }
        for pile in &self.piles {
            let scene = || pile.scene.clone();
            rows.extend(pile.runs.iter().map(|row| {
                ResultRow::new("pile, whole runs", scene(), row).recycling(pile.contact_recycling)
            }));
            let same_poses = pile.same_poses.iter();
            rows.extend(same_poses.map(|row| ResultRow::new("pile, same poses", scene(), row)));
        }
        for row in self.cut.iter().flat_map(|cut| &cut.rows) {
            rows.push(ResultRow::new("cut at depth", "mesh ball".to_owned(), row));
        }
        for row in &self.meshes {
            rows.push(ResultRow::new("trees and first queries", row.mesh.clone(), row));
        }
        rows
    }

    /// Time of collision detection and the ratios of these times by number of heads, and time
    /// against error for meshes of several sizes.
    fn panels(&self) -> Vec<Panel> {
        let piles: Vec<&PileStudy> = self.piles.iter().filter(|p| p.contact_recycling).collect();
        vec![times(&piles), ratios(&piles), time_against_error(&self.meshes)]
    }
}

/// Median time of broad and narrow phase in whole runs; NaN where a backend did not run.
fn detection(pile: &PileStudy, backend: Backend) -> f64 {
    let row = pile.runs.iter().find(|row| row.backend == backend);
    row.map_or(f64::NAN, |row| row.collision_detection.median)
}

fn times(piles: &[&PileStudy]) -> Panel {
    let series = Backend::ALL.map(|backend| Series {
        label: backend.to_string(),
        look: Look::Backend(backend),
        is_connected: true,
        points: piles.iter().map(|p| (p.heads as f64, detection(p, backend))).collect(),
    });
    Panel {
        title: "Broad and narrow phase".to_owned(),
        x_label: "monkey heads".to_owned(),
        y_label: "ms a step, whole runs".to_owned(),
        scale: Scale::FromZero,
        series: series.into(),
    }
}

fn ratios(piles: &[&PileStudy]) -> Panel {
    let series = [Backend::Stock, Backend::AabbOnly].map(|backend| Series {
        label: format!("{backend} : sbbk"),
        look: Look::Backend(backend),
        is_connected: true,
        points: piles
            .iter()
            .filter_map(|pile| {
                let ratio = ratio(detection(pile, backend), detection(pile, Backend::Sbbk))?;
                Some((pile.heads as f64, ratio))
            })
            .collect(),
    });
    let paper = Series {
        label: "the paper's aabb : sbbk".to_owned(),
        look: Look::Paper,
        is_connected: false,
        points: vec![(PAPER.heads as f64, PAPER.time_ratio())],
    };
    Panel {
        title: "Diagram 1: how many times faster".to_owned(),
        x_label: "monkey heads".to_owned(),
        y_label: "ratio of times, broad and narrow phase".to_owned(),
        scale: Scale::FromZero,
        series: series.into_iter().chain([paper]).collect(),
    }
}

fn time_against_error(rows: &[MeshRow]) -> Panel {
    let series = |backend: Backend, point: fn(&MeshRow) -> Option<(f64, f64)>| Series {
        label: backend.to_string(),
        look: Look::Backend(backend),
        is_connected: false,
        points: rows.iter().filter_map(point).collect(),
    };
    Panel {
        title: "Time against error, first queries".to_owned(),
        x_label: "µs for each true triangle pair".to_owned(),
        y_label: "wrong triangle pairs for 100 true ones".to_owned(),
        scale: Scale::FromZero,
        series: vec![
            series(Backend::Stock, |row| point(row.stock_queries, row.stock_error)),
            series(Backend::Sbbk, |row| point(row.sbbk_queries, row.sbbk_error)),
        ],
    }
}

/// Time and error of one mesh.
fn point(milliseconds: Summary, error: ErrorCount) -> Option<(f64, f64)> {
    let time = ratio(1e3 * milliseconds.median, error.true_pairs as f64)?;
    Some((time, 100.0 * error.share()?))
}
