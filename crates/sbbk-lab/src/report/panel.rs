//! One diagram of several: series over linear axes from zero.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::ReportError;
use super::look::Look;

/// Width and height of a panel, in pixels.
const PANEL_SIZE: (u32, u32) = (520, 440);
const TITLE_SIZE: u32 = 19;
const TEXT_SIZE: u32 = 15;
/// Width of the values beside the vertical axis, and height of those below the horizontal one.
const LABEL_AREA: (u32, u32) = (62, 44);
/// Radius of a marker, in pixels.
const MARKER_RADIUS: f64 = 6.0;
/// Space above the largest value, as a factor: room for the legend as well.
const HEADROOM: (f64, f64) = (1.08, 1.3);

/// One diagram.
pub(super) struct Panel {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub series: Vec<Series>,
}

/// Points of one kind. Points that are not finite are left out.
pub(super) struct Series {
    pub label: String,
    pub look: Look,
    /// Whether a line runs through the points.
    pub is_connected: bool,
    pub points: Vec<(f64, f64)>,
}

type DrawResult<'a> =
    Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>>;

impl Panel {
    /// Writes panels side by side as an SVG picture.
    ///
    /// Errors: the file cannot be written.
    pub fn write_all(panels: &[Self], path: &Path) -> Result<(), ReportError> {
        let size = (PANEL_SIZE.0 * panels.len() as u32, PANEL_SIZE.1);
        // The backend would only report an unwritable file by panicking when it is dropped.
        let mut picture = String::new();
        draw_all(panels, &SVGBackend::with_string(&mut picture, size).into_drawing_area())
            .map_err(|cause| ReportError::new(path, cause))?;
        std::fs::write(path, picture).map_err(|cause| ReportError::new(path, cause))
    }

    fn draw<'a>(&self, area: &DrawingArea<SVGBackend<'a>, Shift>) -> DrawResult<'a> {
        let limit = |headroom, coordinate: fn(&(f64, f64)) -> f64| {
            let points = self.series.iter().flat_map(Series::finite_points);
            let largest = points.map(|point| coordinate(&point)).fold(0.0, f64::max);
            if largest > 0.0 { headroom * largest } else { 1.0 }
        };
        let ranges = (limit(HEADROOM.0, |p| p.0), limit(HEADROOM.1, |p| p.1));
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", TITLE_SIZE))
            .margin(14)
            .y_label_area_size(LABEL_AREA.0)
            .x_label_area_size(LABEL_AREA.1)
            .build_cartesian_2d(0.0..ranges.0, 0.0..ranges.1)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_desc(&self.x_label)
            .y_desc(&self.y_label)
            .x_labels(6)
            .y_labels(7)
            .x_label_formatter(&|value| plain(*value, ranges.0))
            .y_label_formatter(&|value| plain(*value, ranges.1))
            .label_style(("sans-serif", TEXT_SIZE))
            .draw()?;
        for series in self.series.iter().filter(|series| series.finite_points().next().is_some()) {
            let colour = series.look.colour();
            let marker = series.look.marker(MARKER_RADIUS);
            let key = move |(x, y)| {
                let corners = marker.iter().map(|(dx, dy)| (x + 8 + dx, y + dy));
                Polygon::new(corners.collect::<Vec<_>>(), colour.filled())
            };
            let marker = series.look.marker(MARKER_RADIUS);
            let mark = |at| EmptyElement::at(at) + Polygon::new(marker.clone(), colour.filled());
            if series.is_connected {
                let line = LineSeries::new(series.finite_points(), colour.stroke_width(2));
                chart.draw_series(line)?;
            }
            chart.draw_series(series.finite_points().map(mark))?.label(&series.label).legend(key);
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", TEXT_SIZE))
            .draw()
    }
}

impl Series {
    fn finite_points(&self) -> impl Iterator<Item = (f64, f64)> {
        let is_finite = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
        self.points.iter().copied().filter(is_finite)
    }
}

/// A label of an axis that ends at `limit`: without decimals where they would all be zero.
fn plain(value: f64, limit: f64) -> String {
    let decimals = if limit >= 10.0 { 0 } else { 1 };
    format!("{value:.decimals$}")
}

fn draw_all<'a>(panels: &[Panel], area: &DrawingArea<SVGBackend<'a>, Shift>) -> DrawResult<'a> {
    area.fill(&WHITE)?;
    for (panel, area) in panels.iter().zip(area.split_evenly((1, panels.len()))) {
        panel.draw(&area)?;
    }
    area.present()
}
