//! The tables of the documentation, filled with the numbers of a study.
//!
//! `docs/data/tables.txt` describes tables, bars and verdicts. A placeholder is `{FUNCTION BACKEND:
//! SCENE / PATH}`:
//!
//! * FUNCTION, which may be left out, joins the numbers of all rows. `sum` and `max` speak for
//!   themselves. `ms` is the largest of numbers in microseconds. `wrong` counts wrong contacts.
//!   `ratio` divides stock's numbers by the backend's and takes the geometric mean. `least` takes
//!   the smallest ratio. `boxes` is `ratio` for the backend `aabb-only`. `count` counts the
//!   numbers, `zeros` those that are 0, and `slower` those in microseconds that are above stock's.
//! * BACKEND: without it, the one that the header gives to the column.
//! * SCENE: parts, joined by ` & `, of `STUDY, KEY VALUE, KEY VALUE`; each must end before a comma.
//! * PATH: quantity and statistic, such as `step.median`.

use std::collections::HashMap;
use std::fmt;

use super::bars::bars;
use super::row::WRONG;
use crate::metrics::geometric_mean;

const SPECS: &str = include_str!("../../../../docs/data/tables.txt");
const FUNCTIONS: [&str; 10] =
    ["sum", "max", "wrong", "ratio", "boxes", "least", "ms", "count", "zeros", "slower"];
/// A time is above stock's beyond this factor and this many microseconds.
const NOISE: f64 = 1.05;
const IGNORED: f64 = 1.0;
/// What stands for a number that was not measured.
const MISSING: &str = "–";

/// A table of the documentation.
#[derive(Debug)]
pub struct Table {
    pub name: &'static str,
    /// The header, and the lines that have a number.
    lines: Vec<Vec<String>>,
}

/// Makes the tables of a study, of which `csv` has the numbers.
pub fn tables(study: &str, csv: &str) -> Vec<Table> {
    let data = Data::parse(csv);
    let specs = SPECS.split("\n\n").filter_map(|spec| {
        let (head, body) = spec.split_once('\n')?;
        let (name, of) = head.strip_prefix("table ")?.split_once(' ')?;
        (of == study).then(|| Table { name, lines: lines(body, &data) })
    });
    specs.filter(|table| table.lines.len() > 1).collect()
}

/// Returns the main finding of a study from its CSV; nothing if it has no description.
pub(super) fn verdict(study: &str, csv: &str) -> String {
    let text = spec_of("verdict ", study).unwrap_or_default();
    Data::parse(csv).fill(&text.replace('\n', " "), "sbbk")
}

/// Returns the bars of a study from its CSV; nothing if it has no description.
pub(super) fn picture(study: &str, csv: &str) -> String {
    let (text, data) = (spec_of("bars ", study).unwrap_or_default(), Data::parse(csv));
    let ratio = |line: &'static str| {
        let (label, ratio) = line.split_once(" | ")?;
        Some((label, data.fill(ratio, "sbbk").parse().ok()?))
    };
    bars(&text.lines().filter_map(ratio).collect::<Vec<_>>())
}

/// Returns the description of a kind for a study.
fn spec_of(kind: &str, study: &str) -> Option<&'static str> {
    let mut specs = SPECS.split("\n\n").filter_map(|spec| spec.strip_prefix(kind));
    specs
        .find_map(|spec| spec.split_once('\n').filter(|(name, _)| *name == study))
        .map(|(_, text)| text)
}

impl Table {
    /// The table as Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: &Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut lines = self.lines.iter().map(line);
        let rule = format!("|---|{}\n", "---:|".repeat(self.lines[0].len() - 1));
        lines.next().into_iter().chain([rule]).chain(lines).collect()
    }
}

/// Columns of a printed table at most, unless its words are longer.
const MOST_COLUMNS: usize = 100;

/// Spaces between two columns.
const GAP: usize = 3;

impl Table {
    /// Returns the widths of the columns. The widest ones are narrowed until the table fits, but
    /// not below their words.
    fn widths(&self) -> Vec<usize> {
        let longest = |column: usize, length: fn(&str) -> usize| {
            self.lines.iter().map(|line| length(&line[column])).max().unwrap_or(0)
        };
        let word = |cell: &str| cell.split(' ').map(|word| word.chars().count()).max().unwrap_or(0);
        let columns = 0..self.lines[0].len();
        let least: Vec<usize> = columns.clone().map(|column| longest(column, word)).collect();
        let mut widths: Vec<usize> =
            columns.map(|column| longest(column, |cell| cell.chars().count())).collect();
        while widths.iter().sum::<usize>() + GAP * (widths.len() - 1) > MOST_COLUMNS {
            let can_shrink = (0..widths.len()).filter(|&column| widths[column] > least[column]);
            let Some(widest) = can_shrink.max_by_key(|&column| widths[column]) else { break };
            widths[widest] -= 1;
        }
        widths
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let widths = self.widths();
        self.lines.iter().try_for_each(|line| {
            let cells: Vec<Vec<String>> =
                line.iter().zip(&widths).map(|(cell, width)| wrapped(cell, *width)).collect();
            let height = cells.iter().map(Vec::len).max().unwrap_or(0);
            (0..height).try_for_each(|part| {
                let text = |column: usize| cells[column].get(part).map_or("", |part| part);
                let mut printed = format!("{:1$}", text(0), widths[0]);
                for (column, width) in widths.iter().enumerate().skip(1) {
                    printed += &format!("{:GAP$}{:>width$}", "", text(column));
                }
                writeln!(f, "{}", printed.trim_end())
            })
        })
    }
}

/// Breaks a text between words into lines of a width. Longer words have a line of their own.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last_mut().expect("there is one");
        if last.is_empty() {
            *last += word;
        } else if last.chars().count() + 1 + word.chars().count() <= width {
            *last = format!("{last} {word}");
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

/// Lines of a table. The first line of a description is the header, in which `name = backend` gives
/// a column a backend. A row with one cell has it in all columns.
fn lines(description: &str, data: &Data) -> Vec<Vec<String>> {
    let rows = description.lines().filter(|line| !line.is_empty());
    let mut rows = rows.map(|line| line.split('|').map(str::trim).collect::<Vec<&str>>());
    let header = rows.next().unwrap_or_default();
    let columns = header.iter().map(|column| column.split_once(" = ").unwrap_or((column, "sbbk")));
    let columns: Vec<(&str, &str)> = columns.collect();
    let names = columns.iter().map(|(name, backend)| data.fill(name, backend)).collect();
    let line = |row: Vec<&str>| -> Vec<String> {
        let cell = |index: usize| row.get(index).or(row.get(1).filter(|_| row.len() == 2));
        let cells = columns.iter().enumerate();
        let filled = |(index, (_, backend)): (usize, &(&str, &str))| {
            cell(index).map_or_else(String::new, |cell| data.fill(cell, backend))
        };
        cells.map(filled).collect()
    };
    let has_number = |line: &Vec<String>| {
        line[1..].iter().any(|cell| cell.contains(|c: char| c.is_ascii_digit()))
    };
    [names].into_iter().chain(rows.map(line).filter(has_number)).collect()
}

/// Numbers of a CSV file.
struct Data(Vec<Number>);

struct Number {
    scene: String,
    backend: String,
    path: String,
    value: f64,
}

impl Data {
    /// Reads the lines of [`super::Results::csv`].
    fn parse(text: &str) -> Self {
        let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
        let numbers = lines.filter_map(|line| {
            let [study, scene, backend, quantity, statistic, value] =
                cells(line).try_into().ok()?;
            let path = match &*statistic {
                "value" => quantity,
                statistic => format!("{quantity}.{statistic}"),
            };
            let (scene, value) = (format!("{study}, {scene}"), value.parse().unwrap_or(f64::NAN));
            Some(Number { scene, backend, path, value })
        });
        Self(numbers.collect())
    }

    /// Numbers of a backend at a path, by scene. All parts of the pattern must end a key.
    fn find(&self, backend: &str, scene: &str, path: &str) -> HashMap<&str, f64> {
        let ends_key = |number: &Number, part: &str| {
            let mut ends = number.scene.match_indices(part).map(|(at, _)| at + part.len());
            ends.any(|end| number.scene[end..].is_empty() || number.scene[end..].starts_with(','))
        };
        let is_found = |number: &&Number| {
            number.backend == backend
                && number.path == path
                && scene.split(" & ").all(|part| part == "all" || ends_key(number, part))
        };
        self.0.iter().filter(is_found).map(|n| (&*n.scene, n.value)).collect()
    }

    /// Fills the placeholders of a text.
    fn fill(&self, text: &str, backend: &str) -> String {
        let mut parts = text.split('{');
        let mut filled = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let (placeholder, rest) = part.split_once('}').expect("each `{` has a `}`");
            filled += self.evaluate(placeholder, backend).as_deref().unwrap_or(MISSING);
            filled += rest;
        }
        filled
    }

    /// Value of a placeholder; `None` without a number.
    fn evaluate(&self, placeholder: &str, backend: &str) -> Option<String> {
        let (scene, path) = placeholder.rsplit_once(" / ")?;
        let (function, scene) = match scene.split_once(' ') {
            Some((word, rest)) if FUNCTIONS.contains(&word) => (word, rest),
            _ => ("", scene),
        };
        // Names of studies have colons, too.
        let is_backend = |name: &str| self.0.iter().any(|number| number.backend == name);
        let own = scene.split_once(": ").filter(|(name, _)| is_backend(name));
        let (backend, scene) = own.unwrap_or((backend, scene));
        self.value(function, backend, scene, path)
    }

    fn value(&self, function: &str, backend: &str, scene: &str, path: &str) -> Option<String> {
        let sum = |path: &str| self.find(backend, scene, path).into_values().sum::<f64>();
        if function == "wrong" {
            let wrong = WRONG.map(|kind| sum(&format!("{path}.{kind}"))).into_iter().sum();
            let all = sum(&format!("{path}.true_pairs"));
            return (all > 0.0).then(|| format!("{} of {}", thousands(wrong), thousands(all)));
        }
        let found = self.find(backend, scene, path);
        let values = || found.values().copied();
        let pairs = |base| {
            let base = self.find(base, scene, path);
            let pair = |(scene, value): (&&str, &f64)| Some([*base.get(scene)?, *value]);
            found.iter().filter_map(pair).collect::<Vec<[f64; 2]>>()
        };
        let ratios = |base| pairs(base).into_iter().map(|[base, value]| base / value);
        let is_slower = |[base, value]: &&[f64; 2]| *value > (NOISE * base).max(base + IGNORED);
        let number = match function {
            "sum" if !found.is_empty() => return Some(thousands(sum(path))),
            "count" if !found.is_empty() => return Some(thousands(found.len() as f64)),
            "zeros" if !found.is_empty() => {
                let zeros = values().filter(|number| *number == 0.0).count();
                return Some(format!("{zeros} of {}", found.len()));
            }
            "slower" => return Some(pairs("stock").iter().filter(is_slower).count().to_string()),
            "max" => values().reduce(f64::max),
            "ms" => values().reduce(f64::max).map(|number| 1e-3 * number),
            "ratio" => geometric_mean(ratios("stock")),
            "boxes" => geometric_mean(ratios("aabb-only")),
            "least" => ratios("stock").reduce(f64::min),
            _ => values().next().filter(|_| found.len() == 1),
        }?;
        Some(if number.abs() >= 1000.0 { thousands(number) } else { three_digits(number) })
    }
}

fn thousands(count: f64) -> String {
    let digits = format!("{count:.0}");
    let parts: Vec<&[u8]> = digits.as_bytes().rchunks(3).rev().collect();
    parts.iter().map(|part| String::from_utf8_lossy(part)).collect::<Vec<_>>().join(",")
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

/// Cells of a line of CSV.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut is_quoted) = (vec![String::new()], false);
    for char in line.chars() {
        match char {
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(String::new()),
            _ => cells.last_mut().expect("there is one").push(char),
        }
    }
    cells
}

/// Would catch a number of another scene, backend or statistic, and cells in another column.
#[test]
fn placeholders_become_numbers() {
    let csv = "# date\nstudy,scene,backend,quantity,statistic,value\n\
               s: t,\"mesh a, size 1\",stock,time,min,8\ns: t,\"mesh a, size 1\",sbbk,time,min,2\n\
               s: t,\"mesh a, size 16\",stock,time,min,4\ns: t,\"mesh a, size 16\",sbbk,time,min,4\n\
               s,mesh b,sbbk,wrong,value,2000\n";
    let description = "mesh | stock = stock | SBBK = sbbk\nof 1 | {size 1 / time.min}\n\
                       both | {ratio s: t / time.min} | {sum mesh b / wrong}\n\
                       none | {size 7 / time.min}\n\
                       first | {least sbbk: mesh a & size 1 / time.min}x";
    let table = Table { name: "t", lines: lines(description, &Data::parse(csv)) };
    let expected = "| mesh | stock | SBBK |\n|---|---:|---:|\n| of 1 | 8.00 | 2.00 |\n\
                    | both | 1.00 | 2,000 |\n| first | 4.00x | 4.00x |\n";
    assert_eq!(table.markdown(), expected);
    assert_eq!(table.to_string().lines().nth(1), Some("of 1     8.00    2.00"));
}

/// Would catch words that are cut, and tables wider than a terminal.
#[test]
fn wide_tables_are_wrapped_between_words() {
    let cell = |word: &str, count: usize| vec![word; count].join(" ");
    let line = |count| vec![cell("label", count), cell("12", count), "3".to_owned()];
    let table = Table { name: "t", lines: vec![line(1), line(30)] };
    let text = table.to_string();
    assert!(text.lines().all(|line| line.chars().count() <= MOST_COLUMNS), "{text}");
    assert_eq!(text.matches("label").count(), 31);
    assert_eq!(text.matches("12").count(), 31);
}
