//! Numbers as tables show them.

use crate::metrics::{ErrorCount, Summary};

/// A positive number with three significant digits, without exponent: `0.123`, `12.3`, `1230`.
pub(super) fn three_digits(value: f64) -> String {
    let decimals = match value.abs() {
        magnitude if magnitude >= 100.0 => 0,
        magnitude if magnitude >= 10.0 => 1,
        magnitude if magnitude >= 1.0 => 2,
        _ => 3,
    };
    format!("{value:.decimals$}")
}

/// Minimum and median; one number if only one was measured.
pub(super) fn min_median(summary: &Summary) -> String {
    if summary.count == 1 {
        return three_digits(summary.median);
    }
    format!("{} / {}", three_digits(summary.min), three_digits(summary.median))
}

/// A ratio, or a dash where there is none.
pub(super) fn times(ratio: Option<f64>) -> String {
    ratio.map_or("-".to_owned(), |ratio| format!("{ratio:.2}x"))
}

/// Missed, phantom and wrong pairs, of how many true ones; a dash where nothing was judged.
pub(super) fn errors(errors: &ErrorCount) -> String {
    if errors.mesh_pairs == 0 {
        return "-".to_owned();
    }
    let ErrorCount { missed, phantom, wrong_depth, true_pairs, .. } = errors;
    format!("{missed}+{phantom}+{wrong_depth} of {true_pairs}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch columns that pretend to a precision that was not measured, or drop one.
    #[test]
    fn three_significant_digits() {
        let shown = [0.0123, 0.5, 1.234, 12.34, 123.4, 12345.6].map(three_digits);
        assert_eq!(shown, ["0.012", "0.500", "1.23", "12.3", "123", "12346"]);
    }
}
