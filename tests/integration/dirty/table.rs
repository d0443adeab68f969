use super::*;
use std::fmt::{Display, Write};

/// End of the name of a row with flags.
const FLAG: &str = " + flag";

/// Measurement of one scene.
pub(super) struct Case {
    pub row: String,
    pub column: &'static str,
    pub shown: String,
    pub is_right: bool,
}

impl Case {
    /// Marks the row if meshes have flags.
    pub(super) fn new(
        name: impl Display,
        flags: TriMeshFlags,
        column: &'static str,
        shown: impl Display,
        is_right: bool,
    ) -> Self {
        let row = format!("{name}{}", if flags.is_empty() { "" } else { FLAG });
        Self { row, column, shown: shown.to_string(), is_right }
    }
}

/// Prints a table. Panics unless exactly the cases `known` are wrong: rows, and columns with commas
/// between them. Cases with flags that are as without flags are left out.
pub(super) fn judge(title: &str, cases: &[Case], known: &[(&str, &str)]) {
    let is_repeat = |case: &Case| {
        let base = case.row.strip_suffix(FLAG);
        cases.iter().any(|other| {
            (Some(other.row.as_str()), other.column) == (base, case.column)
                && (&other.shown, other.is_right) == (&case.shown, case.is_right)
        })
    };
    let cases: Vec<&Case> = cases.iter().filter(|case| !is_repeat(case)).collect();
    println!("{}", table(title, &cases));
    let wrong: BTreeSet<(&str, &str)> = (cases.iter().filter(|case| !case.is_right))
        .map(|case| (case.row.as_str(), case.column))
        .collect();
    let known: BTreeSet<(&str, &str)> = known
        .iter()
        .flat_map(|&(row, columns)| columns.split(", ").map(move |column| (row, column)))
        .collect();
    let [fresh, mended] = [wrong.difference(&known), known.difference(&wrong)];
    let [fresh, mended] = [fresh, mended].map(|cases| cases.collect::<Vec<_>>());
    assert!(fresh.is_empty(), "{title}: these fail: {fresh:#?}, and these are mended: {mended:#?}");
    assert!(mended.is_empty(), "{title}: mended, take them from the list: {mended:#?}");
}

fn table(title: &str, cases: &[&Case]) -> String {
    let (mut rows, mut columns): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
    for case in cases {
        for (names, name) in [(&mut rows, case.row.as_str()), (&mut columns, case.column)] {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    let [first, width] = [
        rows.iter().map(|row| row.len()).max(),
        cases.iter().flat_map(|case| [case.shown.len() + 1, case.column.len()]).max(),
    ]
    .map(|most| most.unwrap_or(0));
    let mut text = format!("\n{title}; ! is wrong\n{:first$}", "");
    columns.iter().for_each(|column| write!(text, " {column:>width$}").unwrap());
    for row in rows {
        write!(text, "\n{row:first$}").unwrap();
        for column in &columns {
            let case = cases.iter().find(|case| case.row == row && case.column == *column);
            let shown = case.map_or(String::new(), |case| {
                format!("{}{}", case.shown, if case.is_right { ' ' } else { '!' })
            });
            write!(text, " {shown:>width$}").unwrap();
        }
    }
    text
}
