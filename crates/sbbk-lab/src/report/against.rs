//! Time against error: a diagram with a point for each measurement.

use super::look::Look;
use super::panel::{Panel, Scale, Series};
use crate::metrics::Summary;
use crate::study::contacts::CONTESTANTS;

/// Stands for no wrong contact at all, in wrong contacts for 100 true ones: less than one contact of all in any
/// study, so that nothing else is drawn there.
const NONE_WRONG: f64 = 1e-4;

/// Over logarithmic axes, from the times in microseconds and the shares of wrong contacts of each contestant.
pub(super) fn time_against_error(
    title: String,
    measurements: impl Fn(usize) -> Vec<(Summary, Option<f64>)>,
) -> Panel {
    // The last one drawn is on top: stock's small squares leave SBBK's circles to be seen.
    let series = [1, 0].map(|side| Series {
        label: CONTESTANTS[side].to_string(),
        look: Look::Backend(CONTESTANTS[side]),
        is_connected: false,
        points: measurements(side)
            .into_iter()
            .filter_map(|(time, share)| Some((time.median, 100.0 * share?)))
            .collect(),
    });
    Panel {
        title,
        x_label: "µs a query".to_owned(),
        y_label: "wrong contacts for 100 true ones".to_owned(),
        scale: Scale::Logarithmic { zero: Some(NONE_WRONG) },
        series: series.into(),
    }
}
