//! Fills the tables of docs/measurements.md with the numbers of docs/data/*.csv.
//!
//! ```text
//! cargo run --release -p sbbk-lab --bin tables
//! ```
//!
//! `docs/data/tables.txt` describes the tables. A placeholder is `{FUNCTION BACKEND: SCENE / PATH}`:
//!
//! * FUNCTION, if any, of all rows: `sum`, `max`, or `ms`, the largest of numbers in microseconds;
//!   `wrong`, the wrong contacts of errors; `ratio`, the geometric mean of stock's numbers over those
//!   of the backend; `least`, the least of these; `boxes`, the same as `ratio` for `aabb-only`.
//! * BACKEND: without it, the one that the header gives to the column.
//! * SCENE: parts, joined by ` & `, of `STUDY, KEY VALUE, KEY VALUE`; each must end before a comma.
//! * PATH: quantity and statistic, such as `step.median`.

use std::collections::HashMap;
use std::path::Path;
use std::{env, fs};

use sbbk_lab::cli::{Failure, Outcome};
use sbbk_lab::metrics::geometric_mean;
use sbbk_lab::report::three_digits;

const PAGE: &str = "docs/measurements.md";
const SPECS: &str = "docs/data/tables.txt";
const FUNCTIONS: [&str; 7] = ["sum", "max", "ms", "wrong", "ratio", "boxes", "least"];

/// Fills the tables of a checkout for which there are data.
fn main() -> Outcome {
    let root = env::args().nth(1).unwrap_or_else(|| ".".to_owned());
    let root = Path::new(&root);
    let specs = fs::read_to_string(root.join(SPECS))?;
    let mut page = fs::read_to_string(root.join(PAGE))?;
    for spec in specs.split("\n\n").filter(|spec| spec.starts_with("table ")) {
        let (head, body) = spec.split_once('\n').unwrap_or((spec, ""));
        let [_, name, file] = head.split_whitespace().collect::<Vec<_>>()[..] else {
            return Err(Failure::new(format!("{SPECS}: `{head}` is not `table NAME FILE`")));
        };
        let path = root.join("docs/data").join(file);
        let Ok(text) = fs::read_to_string(&path) else {
            println!("{name}: {} is missing", path.display());
            continue;
        };
        let table = table(body, &Data::parse(&text));
        let table = table.map_err(|error| Failure::new(format!("{name}: {error}")))?;
        let missing = || Failure::new(format!("{PAGE} has no {name}"));
        page = replaced(&page, name, &table).ok_or_else(missing)?;
        println!("{name}: from {}", text.lines().next().unwrap_or_default());
    }
    Ok(fs::write(root.join(PAGE), page)?)
}

/// Replaces what stands between the marks of a table.
fn replaced(page: &str, name: &str, table: &str) -> Option<String> {
    let mark = format!("<!-- table: {name} -->\n");
    let start = page.find(&mark)? + mark.len();
    let end = start + page[start..].find("<!-- end -->")?;
    Some(format!("{}{table}{}", &page[..start], &page[end..]))
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
    /// Reads the lines of [`sbbk_lab::report::Results::csv`] that have contact recycling.
    fn parse(text: &str) -> Self {
        let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
        let numbers = lines.filter_map(|line| {
            let [study, scene, recycling, backend, quantity, statistic, value] =
                cells(line).try_into().ok()?;
            let path = match &*statistic {
                "value" => quantity,
                statistic => format!("{quantity}.{statistic}"),
            };
            let (scene, value) = (format!("{study}, {scene}"), value.parse().unwrap_or(f64::NAN));
            (recycling != "false").then_some(Number { scene, backend, path, value })
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

    /// Value of a placeholder.
    fn evaluate(&self, placeholder: &str, backend: &str) -> Result<String, String> {
        let unknown = || format!("`{{{placeholder}}}` has no number of `{backend}`");
        let (scene, path) = placeholder.rsplit_once(" / ").ok_or_else(unknown)?;
        let (function, scene) = match scene.split_once(' ') {
            Some((word, rest)) if FUNCTIONS.contains(&word) => (word, rest),
            _ => ("", scene),
        };
        let (backend, scene) = scene.split_once(": ").unwrap_or((backend, scene));
        let sum = |path: &str| self.find(backend, scene, path).into_values().sum::<f64>();
        let found = self.find(backend, scene, path);
        let values = || found.values().copied();
        let ratios = |base| {
            let base = self.find(base, scene, path);
            let ratio = |(scene, value): (&&str, &f64)| Some(base.get(scene)? / value);
            found.iter().filter_map(ratio).collect::<Vec<f64>>()
        };
        let number = match function {
            "wrong" => {
                let kinds = ["missed", "phantom", "wrong_depth", "wrong_normal"];
                let wrong = kinds.map(|kind| sum(&format!("{path}.{kind}"))).into_iter().sum();
                let all = sum(&format!("{path}.true_pairs"));
                return Ok(format!("{} of {}", thousands(wrong), thousands(all)));
            }
            _ if found.is_empty() => None,
            "sum" => return Ok(thousands(sum(path))),
            "max" => values().reduce(f64::max),
            "ms" => values().reduce(f64::max).map(|number| 1e-3 * number),
            "ratio" => geometric_mean(ratios("stock")),
            "boxes" => geometric_mean(ratios("aabb-only")),
            "least" => ratios("stock").into_iter().reduce(f64::min),
            _ if found.len() > 1 => return Err(format!("`{placeholder}` fits several rows")),
            _ => values().next(),
        };
        let number = number.ok_or_else(unknown)?;
        let is_count = number.abs() >= 1000.0;
        Ok(if is_count { thousands(number) } else { three_digits(number) })
    }
}

fn thousands(count: f64) -> String {
    let digits = format!("{count:.0}");
    let parts: Vec<&[u8]> = digits.as_bytes().rchunks(3).rev().collect();
    parts.iter().map(|part| String::from_utf8_lossy(part)).collect::<Vec<_>>().join(",")
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

/// Makes a table. The first line of a description is the header, in which `name = backend` gives
/// a column a backend. A row with one cell has it in all columns.
fn table(description: &str, data: &Data) -> Result<String, String> {
    let rows = description
        .lines()
        .filter(|line| !line.is_empty())
        .map(|line| line.split('|').map(str::trim).collect());
    let rows: Vec<Vec<&str>> = rows.collect();
    let (header, rows) = rows.split_first().ok_or("the description is empty")?;
    let columns = header.iter().map(|column| column.split_once(" = ").unwrap_or((column, "sbbk")));
    let columns: Vec<(&str, &str)> = columns.collect();
    let names = columns.iter().map(|(name, backend)| filled(name, backend, data));
    let names = names.collect::<Result<Vec<String>, String>>()?;
    let rule = "---:|".repeat(names.len() - 1);
    let mut text = format!("| {} |\n|---|{rule}\n", names.join(" | "));
    for row in rows {
        let cell = |index: usize| row.get(index).or(row.get(1).filter(|_| row.len() == 2));
        let mut line = vec![filled(row[0], columns[0].1, data)?];
        for (index, (_, backend)) in columns.iter().enumerate().skip(1) {
            line.push(cell(index).map_or(Ok(String::new()), |cell| filled(cell, backend, data))?);
        }
        text.push_str(&format!("| {} |\n", line.join(" | ")));
    }
    Ok(text)
}

/// Fills the placeholders of a text.
fn filled(text: &str, backend: &str, data: &Data) -> Result<String, String> {
    let mut parts = text.split('{');
    let mut filled = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (placeholder, rest) = part.split_once('}').ok_or("a `{` without a `}`")?;
        filled.push_str(&data.evaluate(placeholder, backend).unwrap_or_else(|error| {
            eprintln!("missing: {error}");
            "–".to_owned()
        }));
        filled.push_str(rest);
    }
    Ok(filled)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch a number of another scene, backend or statistic, and cells in another column.
    #[test]
    fn placeholders_become_numbers() {
        let csv = "# date\nstudy,scene,contact_recycling,backend,quantity,statistic,value\n\
                   s,\"mesh a, size 1\",,stock,time,min,8\ns,\"mesh a, size 1\",,sbbk,time,min,2\n\
                   s,\"mesh a, size 16\",,stock,time,min,4\ns,\"mesh a, size 16\",,sbbk,time,min,4\n\
                   s,\"mesh a, size 1\",false,sbbk,time,min,9\ns,mesh b,,sbbk,wrong,value,2000\n";
        let description = "mesh | stock = stock | SBBK = sbbk\nof 1 | {size 1 / time.min}\n\
                           both | {ratio all / time.min} | {sum mesh b / wrong}\n\
                           first | {least sbbk: mesh a & size 1 / time.min}x";
        let found = table(description, &Data::parse(csv)).unwrap();
        let expected = "| mesh | stock | SBBK |\n|---|---:|---:|\n| of 1 | 8.00 | 2.00 |\n\
                        | both | 1.00 | 2,000 |\n| first | 4.00x | 4.00x |\n";
        assert_eq!(found, expected);
        let missing = table("a | b\nc | {size 7 / time.min}", &Data::parse(csv)).unwrap();
        assert!(missing.ends_with("| c | – |\n"), "{missing}");
        let page = "x\n<!-- table: t -->\nold\n<!-- end -->\ny";
        let filled = replaced(page, "t", "new\n").unwrap();
        assert_eq!(filled, "x\n<!-- table: t -->\nnew\n<!-- end -->\ny");
    }
}
