//! One diagram of several: series over linear axes from zero, or over logarithmic ones.

use std::ops::Range;
use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
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
/// The legend above the line of zero, in pixels from the upper left of the axes.
const LOW_LEGEND: (i32, i32) = (8, 228);
/// Space above the largest value, as a factor: room for the legend as well.
const HEADROOM: (f64, f64) = (1.08, 1.3);
/// Series for whose legend there is room; each further one needs this much more.
const LEGEND_ROOM: (usize, f64) = (4, 0.15);

/// One diagram.
pub(super) struct Panel {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub scale: Scale,
    pub series: Vec<Series>,
}

/// What the axes are like.
#[derive(Clone, Copy)]
pub(super) enum Scale {
    /// Linear, from zero to the largest value.
    FromZero,
    /// Logarithmic, over whole powers of ten. Points up to `zero` are drawn there, where the
    /// vertical axis says 0.
    Logarithmic { zero: f64 },
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
        let points = || self.series.iter().flat_map(Series::finite_points);
        let (xs, ys) = (points().map(|point| point.0), points().map(|point| self.height(point.1)));
        match self.scale {
            Scale::FromZero => {
                let further = self.series.len().saturating_sub(LEGEND_ROOM.0);
                let headroom = HEADROOM.1 + LEGEND_ROOM.1 * further as f64;
                let [x, y] = [limit(xs, HEADROOM.0), limit(ys, headroom)];
                let labels = (|value: &f64| plain(*value, x), |value: &f64| plain(*value, y));
                self.draw_over(area, (0.0..x, 0.0..y), labels)
            }
            Scale::Logarithmic { zero } => {
                // Half a power of ten below leaves room for the markers of zero.
                let (x, y) = (decades(xs), 0.3 * zero..decades(ys).end);
                let is_zero = |value: f64| value < 3.0 * zero;
                let y_label =
                    |&value: &f64| if is_zero(value) { plain(0.0, 10.0) } else { power(value) };
                let axes = (x.log_scale(), y.log_scale());
                self.draw_over(area, axes, (|&value: &f64| power(value), y_label))
            }
        }
    }

    /// Curves that rise from zero leave the upper left free; on logarithmic axes nothing is between
    /// zero and the smallest other values.
    fn legend(&self) -> SeriesLabelPosition {
        match self.scale {
            Scale::FromZero => SeriesLabelPosition::UpperLeft,
            Scale::Logarithmic { .. } => {
                SeriesLabelPosition::Coordinate(LOW_LEGEND.0, LOW_LEGEND.1)
            }
        }
    }

    /// Where a value stands on the vertical axis.
    fn height(&self, value: f64) -> f64 {
        match self.scale {
            Scale::FromZero => value,
            Scale::Logarithmic { zero } => value.max(zero),
        }
    }

    fn draw_over<'a, X, Y>(
        &self,
        area: &DrawingArea<SVGBackend<'a>, Shift>,
        axes: (X, Y),
        labels: (impl Fn(&f64) -> String, impl Fn(&f64) -> String),
    ) -> DrawResult<'a>
    where
        X: AsRangedCoord<Value = f64, CoordDescType: ValueFormatter<f64>>,
        Y: AsRangedCoord<Value = f64, CoordDescType: ValueFormatter<f64>>,
    {
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", TITLE_SIZE))
            .margin(14)
            .y_label_area_size(LABEL_AREA.0)
            .x_label_area_size(LABEL_AREA.1)
            .build_cartesian_2d(axes.0, axes.1)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_desc(&self.x_label)
            .y_desc(&self.y_label)
            .x_labels(6)
            .y_labels(7)
            .x_label_formatter(&labels.0)
            .y_label_formatter(&labels.1)
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
            let points = || series.finite_points().map(|(x, y)| (x, self.height(y)));
            if series.is_connected {
                chart.draw_series(LineSeries::new(points(), colour.stroke_width(2)))?;
            }
            chart.draw_series(points().map(mark))?.label(&series.label).legend(key);
        }
        chart
            .configure_series_labels()
            .position(self.legend())
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

/// The largest value and some space above.
fn limit(values: impl Iterator<Item = f64>, headroom: f64) -> f64 {
    let largest = values.fold(0.0, f64::max);
    if largest > 0.0 { headroom * largest } else { 1.0 }
}

/// The powers of ten between which all values lie.
fn decades(values: impl Iterator<Item = f64>) -> Range<f64> {
    let logarithms = values.filter(|value| *value > 0.0).map(f64::log10);
    let [least, largest] = logarithms.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], value| {
        [a.min(value.floor()), b.max(value.ceil())]
    });
    if least < largest { 10f64.powf(least)..10f64.powf(largest) } else { 1.0..10.0 }
}

/// A power of ten as a label.
fn power(value: f64) -> String {
    let exponent = value.log10().round() as i32;
    if (-3..=3).contains(&exponent) {
        return format!("{}", 10f64.powi(exponent));
    }
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let superscript = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    format!("10{}", exponent.to_string().chars().map(superscript).collect::<String>())
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
