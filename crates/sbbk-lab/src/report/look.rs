//! Colours and markers of the plots.

use std::f64::consts::TAU;
use std::ops::Add;

use plotters::prelude::*;

use crate::backend::Backend;

/// How a series is drawn. The colours are of Okabe and Ito's palette, which the colour-blind can
/// tell apart; the markers do for black and white.
#[derive(Clone, Copy, Debug)]
pub enum Look {
    /// One of those that answer.
    Backend(Backend),
    /// The paper's figures.
    Paper,
    /// One of a few that are neither, by number.
    Other(usize),
}

/// A polygon in pixels about a place of an area.
type Mark<C, B> = <EmptyElement<C, B> as Add<Polygon<(i32, i32)>>>::Output;

/// Colours of the others; black first, as what is compared with comes first.
const OTHERS: [RGBColor; 6] = [
    RGBColor(0, 0, 0),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
];

impl Look {
    pub(super) fn colour(self) -> RGBColor {
        match self {
            Self::Backend(Backend::Stock) => RGBColor(0, 0, 0),
            Self::Backend(Backend::AabbOnly) => RGBColor(213, 94, 0),
            Self::Backend(Backend::Sbbk) => RGBColor(0, 114, 178),
            Self::Backend(Backend::SbbkParry) => RGBColor(0, 158, 115),
            Self::Paper => RGBColor(204, 121, 167),
            Self::Other(number) => OTHERS[number % OTHERS.len()],
        }
    }

    /// The marker at a place of an area: a regular polygon, with a radius in pixels.
    pub(super) fn mark<C, B: DrawingBackend>(self, at: C, radius: f64) -> Mark<C, B> {
        EmptyElement::at(at) + Polygon::new(self.corners(radius), self.colour().filled())
    }

    /// The corners of the marker about the origin, in pixels.
    fn corners(self, radius: f64) -> Vec<(i32, i32)> {
        // Number of corners, and the first one's direction as a share of a turn from the right.
        let (corners, start) = match self {
            Self::Backend(Backend::Stock) => (4, 0.125),
            Self::Backend(Backend::AabbOnly) => (3, 0.75),
            Self::Backend(Backend::Sbbk) => (16, 0.0),
            Self::Backend(Backend::SbbkParry) => (4, 0.0),
            Self::Paper => (3, 0.25),
            Self::Other(number) => (3 + number as u32 % 6, 0.25),
        };
        (0..corners)
            .map(|corner| {
                let (sin, cos) = (TAU * (start + f64::from(corner) / f64::from(corners))).sin_cos();
                ((radius * cos).round() as i32, (radius * sin).round() as i32)
            })
            .collect()
    }
}
