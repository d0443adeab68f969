//! Diagrams of several series of points, side by side in one picture.

use std::f64::consts::TAU;
use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::Row;
use crate::backend::Backend;

/// Width and height of a panel without its legend, in pixels.
const PANEL_SIZE: (u32, u32) = (520, 440);
const TEXT: (&str, u32) = ("sans-serif", 15);
const MARKER_RADIUS: f64 = 6.0;
/// Entries side by side in the legend, the height of a row, and where its text starts, in pixels.
const LEGEND_COLUMNS: usize = 2;
const LEGEND_ROW: u32 = 22;
const LEGEND_LEFT: u32 = 74;
/// Stands for no wrong contact at all, in wrong contacts for 100 true ones: less than one contact
/// of all in any study.
const NONE_WRONG: f64 = 1e-4;

/// One diagram.
#[derive(Clone, Debug)]
pub struct Panel {
    title: String,
    labels: [&'static str; 2],
    scale: Scale,
    series: Vec<Series>,
}

/// What the axes are like.
#[derive(Clone, Copy, Debug)]
pub enum Scale {
    /// From zero to the largest value.
    Linear,
    /// Over whole powers of ten.
    Logarithmic,
    /// The same; heights of zero are drawn at this one, which is less than all others.
    ZeroAt(f64),
}

/// Colour and marker of a series. The colours are Okabe and Ito's, which the colour-blind can tell
/// apart; the markers do for black and white.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    colour: RGBColor,
    corners: u32,
    /// Direction of the first corner, as a share of a turn.
    start: f64,
}

#[derive(Clone, Debug)]
struct Series {
    label: String,
    look: Look,
    is_connected: bool,
    points: Vec<[f64; 2]>,
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn<'a> = Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>>;

impl Look {
    /// Some that differ.
    pub const ALL: [Self; 6] = [
        Self::new(0, 0, 0, 4, 0.125),
        Self::new(213, 94, 0, 3, 0.75),
        Self::new(0, 114, 178, 16, 0.0),
        Self::new(0, 158, 115, 4, 0.0),
        Self::new(204, 121, 167, 3, 0.25),
        Self::new(86, 180, 233, 5, 0.75),
    ];

    const fn new(r: u8, g: u8, b: u8, corners: u32, start: f64) -> Self {
        Self { colour: RGBColor(r, g, b), corners, start }
    }

    /// That of a backend: the first four, in its order.
    pub fn of(backend: Backend) -> Self {
        Self::ALL[backend as usize]
    }

    /// A regular polygon about the origin, in pixels.
    fn corners(self, radius: f64) -> Vec<(i32, i32)> {
        let corner = |index: u32| {
            let turn = self.start + f64::from(index) / f64::from(self.corners);
            let (sin, cos) = (TAU * turn).sin_cos();
            ((radius * cos).round() as i32, (radius * sin).round() as i32)
        };
        (0..self.corners).map(corner).collect()
    }
}

impl Panel {
    /// Axes without points; `labels` of the horizontal and of the vertical one.
    pub fn new(title: impl Into<String>, labels: [&'static str; 2], scale: Scale) -> Self {
        Self { title: title.into(), labels, scale, series: Vec::new() }
    }

    /// Adds points, from left to right, and a line through them. Those that are not finite, or have
    /// no logarithm where the axis is logarithmic, are left out.
    pub fn line(self, label: &str, look: Look, points: impl Iterator<Item = [f64; 2]>) -> Self {
        self.series(label, look, true, points)
    }

    /// Adds points without a line.
    pub fn points(self, label: &str, look: Look, points: impl Iterator<Item = [f64; 2]>) -> Self {
        self.series(label, look, false, points)
    }

    /// Time against error over logarithmic axes, from the rows' `time` in µs and `errors`. The last
    /// series is on top: stock's small squares leave SBBK's circles to be seen.
    pub fn time_against_error<'a>(
        title: impl Into<String>,
        rows: impl Iterator<Item = &'a Row> + Clone,
    ) -> Self {
        let labels = ["µs a query", "wrong contacts for 100 true ones"];
        let point =
            |row: &Row| Some([row.number("time.median"), 100.0 * row.error_share("errors")?]);
        let panel = Self::new(title, labels, Scale::ZeroAt(NONE_WRONG));
        panel.backends(&[Backend::Sbbk, Backend::Stock], rows, false, point)
    }

    /// Adds what `point` makes of the rows of each backend: a line, or points alone.
    pub fn backends<'a>(
        self,
        backends: &[Backend],
        rows: impl Iterator<Item = &'a Row> + Clone,
        is_line: bool,
        point: impl Fn(&Row) -> Option<[f64; 2]>,
    ) -> Self {
        backends.iter().fold(self, |panel, &backend| {
            let rows = rows.clone().filter(|row| row.is("backend", backend));
            let (label, look) = (backend.to_string(), Look::of(backend));
            panel.series(&label, look, is_line, rows.filter_map(&point))
        })
    }

    fn series(
        mut self,
        label: &str,
        look: Look,
        is_connected: bool,
        points: impl Iterator<Item = [f64; 2]>,
    ) -> Self {
        let place = |[x, y]: [f64; 2]| match self.scale {
            Scale::Linear => [x, y],
            Scale::Logarithmic => [x.log10(), y.log10()],
            Scale::ZeroAt(zero) => [x.log10(), y.max(zero).log10()],
        };
        let points: Vec<_> = points
            .filter(|[x, y]| x.is_finite() && y.is_finite())
            .map(place)
            .filter(|[x, y]| x.is_finite() && y.is_finite())
            .collect();
        if !points.is_empty() {
            self.series.push(Series { label: label.to_owned(), look, is_connected, points });
        }
        self
    }

    /// All panels as an SVG picture.
    pub(super) fn draw_all(panels: &[Self]) -> String {
        let rows = panels.iter().map(|panel| panel.series.len().div_ceil(LEGEND_COLUMNS)).max();
        let legend = LEGEND_ROW * rows.unwrap_or(0) as u32 + LEGEND_ROW / 2;
        let size = (PANEL_SIZE.0 * panels.len().max(1) as u32, PANEL_SIZE.1 + legend);
        let mut picture = String::new();
        let draw = |area: Area<'_>| -> Drawn<'_> {
            area.fill(&WHITE)?;
            for (panel, area) in panels.iter().zip(area.split_evenly((1, panels.len()))) {
                let (axes, legend) = area.split_vertically(PANEL_SIZE.1);
                panel.draw(&axes)?;
                panel.draw_legend(&legend)?;
            }
            area.present()
        };
        let area = SVGBackend::with_string(&mut picture, size).into_drawing_area();
        draw(area).expect("a picture in memory is always written");
        picture
    }

    /// The range of an axis: of the values themselves, or of their logarithms.
    fn range(&self, axis: usize) -> Range<f64> {
        let values = self.series.iter().flat_map(|series| &series.points).map(|point| point[axis]);
        let [least, most] = values
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| {
                [least.min(value), most.max(value)]
            });
        match self.scale {
            Scale::Linear => 0.0..if most > 0.0 { 1.08 * most } else { 1.0 },
            _ if least > most => 0.0..1.0,
            // Half a power of ten below leaves room for the markers of zero.
            Scale::ZeroAt(zero) if axis == 1 => zero.log10() - 0.5..most.ceil().max(1.0),
            _ => least.floor()..most.ceil().max(least.floor() + 1.0),
        }
    }

    fn label(&self, axis: usize, end: f64, value: f64) -> String {
        let is_near = |other: f64| (value - other).abs() < 1e-6;
        match self.scale {
            Scale::Linear => format!("{value:.*}", usize::from(end < 10.0)),
            Scale::ZeroAt(zero) if axis == 1 && is_near(zero.log10()) => "0".to_owned(),
            _ if !is_near(value.round()) => String::new(),
            _ => power(value.round() as i32),
        }
    }

    fn draw<'a>(&self, area: &Area<'a>) -> Drawn<'a> {
        let [x, y] = [0, 1].map(|axis| self.range(axis));
        let ticks = |range: &Range<f64>, linear| match self.scale {
            Scale::Linear => linear,
            _ => (range.end - range.start) as usize + 1,
        };
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", 19))
            .margin(14)
            .y_label_area_size(62)
            .x_label_area_size(44)
            .build_cartesian_2d(x.clone(), y.clone())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_desc(self.labels[0])
            .y_desc(self.labels[1])
            .x_labels(ticks(&x, 6))
            .y_labels(ticks(&y, 7))
            .x_label_formatter(&|value| self.label(0, x.end, *value))
            .y_label_formatter(&|value| self.label(1, y.end, *value))
            .label_style(TEXT)
            .draw()?;
        for Series { look, is_connected, points, .. } in &self.series {
            let points = || points.iter().map(|&[x, y]| (x, y));
            if *is_connected {
                chart.draw_series(LineSeries::new(points(), look.colour.stroke_width(2)))?;
            }
            chart.draw_series(points().map(|at| {
                EmptyElement::at(at)
                    + Polygon::new(look.corners(MARKER_RADIUS), look.colour.filled())
            }))?;
        }
        Ok(())
    }

    /// Below the axes, where nothing of the data can be.
    fn draw_legend<'a>(&self, area: &Area<'a>) -> Drawn<'a> {
        let column_width = (PANEL_SIZE.0 - LEGEND_LEFT) / LEGEND_COLUMNS as u32;
        for (index, Series { label, look, .. }) in self.series.iter().enumerate() {
            let [row, column] = [index / LEGEND_COLUMNS, index % LEGEND_COLUMNS];
            let left = (LEGEND_LEFT + column as u32 * column_width) as i32;
            let middle = (row as u32 * LEGEND_ROW + LEGEND_ROW / 2) as i32;
            let style = TEXT.into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(
                &(EmptyElement::at((left, middle))
                    + Polygon::new(look.corners(MARKER_RADIUS), look.colour.filled())),
            )?;
            area.draw(&Text::new(label.clone(), (left + 14, middle), style))?;
        }
        Ok(())
    }
}

/// A power of ten as a label.
fn power(exponent: i32) -> String {
    if (-3..=3).contains(&exponent) {
        return format!("{}", 10f64.powi(exponent));
    }
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let superscript = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    format!("10{}", exponent.to_string().chars().map(superscript).collect::<String>())
}
