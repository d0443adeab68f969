//! Tables, made by pivoting rows.

use std::fmt;

use serde_json::Value;

use super::row::{Row, text};
use crate::metrics::{geometric_mean, ratio};

/// Characters of a line at most.
const WIDTH: usize = 100;

/// A table for the terminal.
#[derive(Clone, Debug)]
pub struct Table {
    pub title: String,
    /// Names of the columns.
    pub header: Vec<String>,
    /// Cells, line by line.
    pub lines: Vec<Vec<String>>,
    /// Explanations below the table.
    pub notes: Vec<String>,
    /// Number of columns that say what a line is about; they are repeated where a table is split.
    key_count: usize,
}

/// A table to be made of rows.
pub struct TableSpec<'a> {
    title: String,
    study: &'a str,
    keys: &'a [&'a str],
    total: Option<usize>,
    columns: Vec<Column>,
    notes: Vec<String>,
}

/// A column: its name, and a function of the rows of a line and of all rows.
pub struct Column {
    header: String,
    /// Only rows of this backend count.
    backend: Option<String>,
    cell: Box<Cell>,
}

type Cell = dyn Fn(&[&Row], &[&Row]) -> Option<String>;

fn column(header: &str, cell: impl Fn(&[&Row], &[&Row]) -> Option<String> + 'static) -> Column {
    Column { header: header.to_owned(), backend: None, cell: Box::new(cell) }
}

/// A column of the number or text at `path`. Counts are summed over the rows of a line.
pub fn number(header: &str, path: &'static str) -> Column {
    column(header, move |rows, _| {
        let values = rows.iter().map(|row| row.get(path)).collect::<Option<Vec<&Value>>>()?;
        match values[..] {
            [] | [Value::Null] => None,
            [value] if value.is_f64() => value.as_f64().map(three_digits),
            [value] => Some(text(value)),
            ref values => {
                let sum: Option<u64> = values.iter().map(|value| value.as_u64()).sum();
                Some(sum.map_or_else(String::new, |sum| sum.to_string()))
            }
        }
    })
}

/// A column of minimum and median of the summary at `path`; of one number if only one was measured.
pub fn time(header: &str, path: &'static str) -> Column {
    column(header, move |rows, _| {
        let [row] = rows else { return Some(String::new()) };
        let number = |name: &str| row.get(path)?.get(name)?.as_f64();
        let median = three_digits(number("median")?);
        let is_single = number("count")? == 1.0;
        Some(if is_single { median } else { three_digits(number("min")?) + " / " + &median })
    })
}

/// A column of wrong contacts by kind, summed over the rows of a line.
pub fn errors(header: &str, path: &'static str) -> Column {
    column(header, move |rows, _| {
        let sum = |kind: &str| -> Option<u64> {
            let path = format!("{path}.{kind}");
            rows.iter().filter_map(|row| row.get(&path)?.as_u64()).reduce(|a, b| a + b)
        };
        let kinds = ["missed", "phantom", "wrong_depth", "wrong_normal"].map(sum);
        let kinds: Vec<String> = kinds.into_iter().flatten().map(|n| n.to_string()).collect();
        let true_pairs = sum("true_pairs")?;
        let is_judged = true_pairs > 0 || sum("mesh_pairs")? > 0;
        is_judged.then(|| format!("{} of {true_pairs}", kinds.join("+")))
    })
}

/// A column of ratios, as a geometric mean over the rows of a line. Each divides the number at `path`
/// of `base` for the same keys by the row's own number.
pub fn faster(header: &str, path: &'static str, base: impl ToString) -> Column {
    ratios(header, path, base, ratio)
}

/// A column of the inverse ratios, for quantities where more is better.
pub fn greater(header: &str, path: &'static str, base: impl ToString) -> Column {
    ratios(header, path, base, |base, own| ratio(own, base))
}

fn ratios(
    header: &str,
    path: &'static str,
    base: impl ToString,
    ratio: fn(f64, f64) -> Option<f64>,
) -> Column {
    let base = base.to_string();
    column(header, move |rows, all| {
        let ratios = rows.iter().filter_map(|row| {
            let is_base = |other: &&&Row| other.backend == base && other.keys == row.keys;
            ratio(all.iter().find(is_base)?.number(path), row.number(path))
        });
        geometric_mean(ratios).map(|ratio| format!("{ratio:.2}x"))
    })
}

/// Columns of the times of stock and SBBK, their ratio, and the errors of both.
pub fn sides() -> Vec<Column> {
    vec![
        time("stock", "time").of("stock"),
        time("sbbk", "time").of("sbbk"),
        faster("ratio", "time.min", "stock").of("sbbk"),
        errors("errors, stock", "errors").of("stock"),
        errors("errors, sbbk", "errors").of("sbbk"),
    ]
}

impl Column {
    /// Counts only rows of this backend.
    pub fn of(self, backend: impl ToString) -> Self {
        Self { backend: Some(backend.to_string()), ..self }
    }

    fn show(&self, line: &[&Row], all: &[&Row]) -> String {
        let counts = |row: &&&Row| self.backend.as_ref().is_none_or(|name| row.backend == *name);
        let rows: Vec<&Row> = line.iter().filter(counts).copied().collect();
        (self.cell)(&rows, all).unwrap_or_else(|| "-".to_owned())
    }
}

impl<'a> TableSpec<'a> {
    /// A table of one part of a study, with a line for all rows that agree in the `keys`, of which
    /// `backend` may be one.
    pub fn new(
        title: impl Into<String>,
        study: &'a str,
        keys: &'a [&'a str],
        columns: impl IntoIterator<Item = Column>,
    ) -> Self {
        let columns = columns.into_iter().collect();
        Self { title: title.into(), study, keys, total: None, columns, notes: Vec::new() }
    }

    /// Adds a line of sums and means for all rows that agree in so many of the first keys.
    pub fn total(self, key_count: impl Into<Option<usize>>) -> Self {
        Self { total: key_count.into(), ..self }
    }

    /// Adds an explanation.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    pub fn of(self, rows: &[Row]) -> Table {
        let Self { title, study, keys, total, columns, notes } = self;
        let rows: Vec<&Row> = rows.iter().filter(|row| row.study == study).collect();
        let cells = |row: &Row, count: usize| -> Vec<String> {
            let value = |key: &&str| match *key {
                "backend" => row.backend.clone(),
                key => row.get(key).map_or_else(String::new, text),
            };
            keys[..count].iter().map(value).collect()
        };
        let mut lines = Vec::new();
        for lead in groups(&rows, |row| cells(row, total.unwrap_or(0))) {
            let show = |group: &[&Row]| columns.iter().map(|c| c.show(group, &rows)).collect();
            for group in groups(&lead, |row| cells(row, keys.len())) {
                lines.push([cells(group[0], keys.len()), show(&group)].concat());
            }
            if let Some(lead_keys) = total {
                let mut line = cells(lead[0], lead_keys);
                line.push("all, or mean".to_owned());
                line.resize(keys.len(), String::new());
                lines.push([line, show(&lead)].concat());
            }
        }
        let names = keys.iter().map(|key| match *key {
            "contact_recycling" => "recycling".to_owned(),
            key => key.replace('_', " "),
        });
        let header = names.chain(columns.iter().map(|column| column.header.clone())).collect();
        Table { title, header, lines, notes, key_count: keys.len() }
    }
}

/// Groups rows by a key, in the order in which the keys first appear.
fn groups<'a>(rows: &[&'a Row], key: impl Fn(&Row) -> Vec<String>) -> Vec<Vec<&'a Row>> {
    let mut groups: Vec<(Vec<String>, Vec<&Row>)> = Vec::new();
    for &row in rows {
        let key = key(row);
        match groups.iter_mut().find(|group| group.0 == key) {
            Some(group) => group.1.push(row),
            None => groups.push((key, vec![row])),
        }
    }
    groups.into_iter().map(|group| group.1).collect()
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Keys that are the same in all lines are part of the title.
        let is_constant = |&key: &usize| {
            self.lines.len() > 1 && self.lines.iter().all(|line| line[key] == self.lines[0][key])
        };
        let (constant, keys): (Vec<usize>, Vec<usize>) = (0..self.key_count).partition(is_constant);
        let constant = constant.iter().map(|&key| (&self.header[key], &self.lines[0][key]));
        let constant: String = constant.map(|(name, value)| format!("; {name}: {value}")).collect();
        writeln!(f, "{}", wrapped(&(self.title.clone() + &constant), ""))?;
        let width = |column: usize| {
            let cells = [&self.header].into_iter().chain(&self.lines);
            cells.map(|line| line[column].chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.header.len()).map(width).collect();
        let mut shown = keys.clone();
        for column in self.key_count..self.header.len() {
            let width: usize = shown.iter().map(|&c| widths[c] + 3).sum();
            if width + widths[column] + 4 > WIDTH && shown.len() > keys.len() {
                self.draw(f, &shown, &widths)?;
                writeln!(f)?;
                shown.clone_from(&keys);
            }
            shown.push(column);
        }
        self.draw(f, &shown, &widths)?;
        self.notes.iter().try_for_each(|note| writeln!(f, "{}", wrapped(note, "  ")))
    }
}

impl Table {
    /// Draws some columns: keys to the left, numbers to the right.
    fn draw(&self, f: &mut fmt::Formatter<'_>, shown: &[usize], widths: &[usize]) -> fmt::Result {
        let rule: Vec<String> = widths.iter().map(|&width| "-".repeat(width)).collect();
        [&self.header, &rule].into_iter().chain(&self.lines).try_for_each(|line| {
            for &column in shown {
                let (cell, width) = (&line[column], widths[column]);
                match column < self.key_count {
                    true => write!(f, "| {cell:<width$} ")?,
                    false => write!(f, "| {cell:>width$} ")?,
                }
            }
            writeln!(f, "|")
        })
    }
}

/// Breaks a text into indented lines.
pub(super) fn wrapped(text: &str, indent: &str) -> String {
    let mut lines = vec![indent.to_owned()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("there is one");
        if line.chars().count() + word.chars().count() >= WIDTH {
            lines.push(format!("{indent}  {word}"));
        } else {
            line.push_str(if line.len() > indent.len() { " " } else { "" });
            line.push_str(word);
        }
    }
    lines.join("\n")
}

/// Three significant digits, with an exponent only below a thousandth: `0.123`, `12.3`, `1230`.
pub fn three_digits(value: f64) -> String {
    let decimals = match value.abs() {
        magnitude if magnitude >= 100.0 => 0,
        magnitude if magnitude >= 10.0 => 1,
        magnitude if magnitude >= 1.0 => 2,
        magnitude if magnitude >= 1.0e-3 || magnitude == 0.0 => 3,
        _ => return format!("{value:.1e}"),
    };
    format!("{value:.decimals$}")
}

/// Would catch cells in another place, and ratios upside down or to the base of other keys. Would
/// catch totals over rows of other lines, too, and sums that lose a kind of error.
#[test]
fn rows_are_pivoted() {
    use serde_json::json;

    let row = |mode: &str, backend: &str, time: f64, missed: usize| {
        let errors = json!({ "missed": missed, "phantom": 0, "wrong_depth": 1, "true_pairs": 9 });
        let time = json!({ "count": 2, "min": time, "median": 2.0 * time });
        let row = Row::new("race", backend).key("mode", mode).key("mesh", mode.len());
        row.with("time", time).with("errors", errors)
    };
    let rows = [
        row("fresh", "stock", 8.0, 3),
        row("fresh", "sbbk", 4.0, 0),
        row("slow", "stock", 8.0, 4),
        row("slow", "sbbk", 1.0, 0),
        Row::new("another", "stock"),
    ];
    let columns = || sides().into_iter().chain(sides());
    let table = TableSpec::new("a word ".repeat(40), "race", &["mode"], columns()).total(0);
    let table = table.of(&rows);
    let expected = [
        ["fresh", "8.00 / 16.0", "4.00 / 8.00", "2.00x", "3+0+1 of 9", "0+0+1 of 9"],
        ["slow", "8.00 / 16.0", "1.00 / 2.00", "8.00x", "4+0+1 of 9", "0+0+1 of 9"],
        ["all, or mean", "", "", "4.00x", "7+0+2 of 18", "0+0+2 of 18"],
    ];
    assert_eq!(table.lines.iter().map(|line| &line[..6]).collect::<Vec<_>>(), expected);
    // Wide tables are split.
    let text = table.to_string();
    assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
    assert_eq!(text.matches("errors, sbbk").count(), 2, "{text}");
}
