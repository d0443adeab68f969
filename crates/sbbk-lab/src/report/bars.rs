//! Pictures in text: one bar a ratio, and a line at 1.

use std::fmt::Write;

/// Columns of the longest bar.
const LONGEST: f64 = 60.0;

/// Draws labelled ratios of stock's time and SBBK's, below an empty line. Nothing without ratios.
pub(super) fn bars(ratios: &[(&str, f64)]) -> String {
    let Some(largest) = ratios.iter().map(|(_, ratio)| *ratio).reduce(f64::max) else {
        return String::new();
    };
    let column = |ratio: f64| (LONGEST * ratio / largest.max(1.0)).round() as usize;
    let label_width = ratios.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
    let before_line = label_width + 1 + column(1.0);
    let mut text = format!("\n{:before_line$}1\n", "stock's time : SBBK's");
    for (label, ratio) in ratios {
        let bar = (1..=column(ratio.max(1.0))).map(|at| match at {
            at if at == column(1.0) => '|',
            at if at <= column(*ratio) => '█',
            _ => ' ',
        });
        let bar: String = bar.collect();
        writeln!(text, "{label:label_width$}  {bar} {ratio:.2}").expect("strings can be written");
    }
    text
}

/// Would catch bars of wrong lengths, and a line beside 1.
#[test]
fn bars_have_the_lengths_of_the_ratios() {
    let text = bars(&[("a", 4.0), ("long", 0.5)]);
    let lines: Vec<&str> = text.lines().collect();
    let line_at = |line: &str| line.chars().position(|char| char == '|');
    assert_eq!(lines[2].matches('█').count(), 59);
    assert_eq!(lines[3].matches('█').count(), 8);
    assert_eq!(line_at(lines[2]), line_at(lines[3]));
    assert_eq!(bars(&[]), "");
}
