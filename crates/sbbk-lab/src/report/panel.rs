//! One diagram of several: series over linear axes from zero, or over logarithmic ones.

use std::ops::Range;
use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

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
/// Space beyond the largest value, as a factor.
const HEADROOM: f64 = 1.08;
/// The legend below the axes: entries side by side, height of a row, and where its text starts, in pixels.
const LEGEND_COLUMNS: usize = 2;
const LEGEND_ROW: u32 = 22;
const LEGEND_LEFT: u32 = 74;

/// One diagram.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Above it.
    pub title: String,
    /// What the horizontal axis shows.
    pub x_label: String,
    /// What the vertical axis shows.
    pub y_label: String,
    /// What both axes are like.
    pub scale: Scale,
    /// What is drawn, the last one on top.
    pub series: Vec<Series>,
}

/// What the axes are like.
#[derive(Clone, Copy, Debug)]
pub enum Scale {
    /// Linear, from zero to the largest value.
    FromZero,
    /// Logarithmic, over whole powers of ten.
    Logarithmic {
        /// Less than all values but zero, if they may be zero: such points are drawn here, where the
        /// vertical axis says 0.
        zero: Option<f64>,
    },
}

/// Points of one kind. Points that are not finite are left out.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name in the legend.
    pub label: String,
    /// Its colour and marker.
    pub look: Look,
    /// Whether a line runs through the points.
    pub is_connected: bool,
    /// From left to right.
    pub points: Vec<(f64, f64)>,
}

type DrawResult<'a> =
    Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>>;

impl Panel {
    /// Writes panels side by side as an SVG picture.
    ///
    /// Errors: the file cannot be written.
    pub(super) fn write_all(panels: &[Self], path: &Path) -> Result<(), ReportError> {
        let rows = panels.iter().map(|panel| panel.drawn().count().div_ceil(LEGEND_COLUMNS));
        let legend_height = LEGEND_ROW * rows.max().unwrap_or(0) as u32 + LEGEND_ROW / 2;
        let size = (PANEL_SIZE.0 * panels.len() as u32, PANEL_SIZE.1 + legend_height);
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
                let [x, y] = [limit(xs), limit(ys)];
                let labels = (|value: &f64| plain(*value, x), |value: &f64| plain(*value, y));
                self.draw_over(area, (0.0..x, 0.0..y), labels)
            }
            Scale::Logarithmic { zero } => {
                let (x, mut y) = (decades(xs), decades(ys));
                // Half a power of ten below leaves room for the markers of zero.
                y.start = zero.map_or(y.start, |zero| 0.3 * zero);
                let is_zero = |value: f64| zero.is_some_and(|zero| value < 3.0 * zero);
                let y_label =
                    |&value: &f64| if is_zero(value) { plain(0.0, 10.0) } else { power(value) };
                let axes = (x.log_scale(), y.log_scale());
                self.draw_over(area, axes, (|&value: &f64| power(value), y_label))
            }
        }
    }

    /// Where a value stands on the vertical axis.
    fn height(&self, value: f64) -> f64 {
        match self.scale {
            Scale::FromZero => value,
            Scale::Logarithmic { zero } => zero.map_or(value, |zero| value.max(zero)),
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
        for series in self.drawn() {
            let points = || series.finite_points().map(|(x, y)| (x, self.height(y)));
            if series.is_connected {
                let line = series.look.colour().stroke_width(2);
                chart.draw_series(LineSeries::new(points(), line))?;
            }
            chart.draw_series(points().map(|at| series.look.mark(at, MARKER_RADIUS)))?;
        }
        Ok(())
    }

    /// Where nothing of the data can be.
    fn draw_legend<'a>(&self, area: &DrawingArea<SVGBackend<'a>, Shift>) -> DrawResult<'a> {
        let column_width = (PANEL_SIZE.0 - LEGEND_LEFT) / LEGEND_COLUMNS as u32;
        for (index, series) in self.drawn().enumerate() {
            let [row, column] = [index / LEGEND_COLUMNS, index % LEGEND_COLUMNS];
            let left = (LEGEND_LEFT + column as u32 * column_width) as i32;
            let middle = (row as u32 * LEGEND_ROW + LEGEND_ROW / 2) as i32;
            let style = ("sans-serif", TEXT_SIZE).into_text_style(area);
            let style = style.pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&series.look.mark((left, middle), MARKER_RADIUS))?;
            area.draw(&Text::new(series.label.clone(), (left + 14, middle), style))?;
        }
        Ok(())
    }

    /// The series that have points.
    fn drawn(&self) -> impl Iterator<Item = &Series> {
        self.series.iter().filter(|series| series.finite_points().next().is_some())
    }
}

impl Series {
    fn finite_points(&self) -> impl Iterator<Item = (f64, f64)> {
        let is_finite = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
        self.points.iter().copied().filter(is_finite)
    }
}

/// The largest value and some space above.
fn limit(values: impl Iterator<Item = f64>) -> f64 {
    let largest = values.fold(0.0, f64::max);
    if largest > 0.0 { HEADROOM * largest } else { 1.0 }
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
        let (axes, legend) = area.split_vertically(PANEL_SIZE.1);
        panel.draw(&axes)?;
        panel.draw_legend(&legend)?;
    }
    area.present()
}
