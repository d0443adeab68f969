//! What the tests of the studies share.

use std::fs;

use csv::StringRecord;
use sbbk_lab::report::{Results, Row};
use serde_json::Value;

/// The files of a study, read again.
pub struct Report {
    pub json: Value,
    /// Study, scene, recycling, backend, quantity, statistic and value of each number.
    pub csv: Vec<StringRecord>,
    pub svg: String,
}

/// Writes all files. Panics where a table is empty or a line has more or fewer cells than its
/// header, and where a file is not what it should be.
pub fn report(results: &Results) -> Report {
    for table in &results.tables {
        assert!(!table.lines.is_empty(), "{}", table.title);
        let is_full = |line: &Vec<String>| line.len() == table.header.len();
        assert!(table.lines.iter().all(is_full), "{table}");
    }
    let folder = tempfile::tempdir().unwrap();
    let [json, csv, svg] =
        ["json", "csv", "svg"].map(|end| folder.path().join("out").with_extension(end));
    results.write_json(&json).unwrap();
    results.write_csv(&csv).unwrap();
    results.write_plot(&svg).unwrap();
    let mut lines = csv::Reader::from_path(csv).unwrap();
    let report = Report {
        json: serde_json::from_slice(&fs::read(json).unwrap()).unwrap(),
        csv: lines.records().map(Result::unwrap).collect(),
        svg: fs::read_to_string(svg).unwrap(),
    };
    assert!(report.svg.starts_with("<svg"));
    assert_eq!(report.json["rows"].as_array().unwrap().len(), results.rows.len());
    report
}

/// Number of lines of each table.
pub fn line_counts(results: &Results) -> Vec<usize> {
    results.tables.iter().map(|table| table.lines.len()).collect()
}

/// The rows of one part of a study, of one backend.
pub fn rows<'a>(results: &'a Results, study: &str, backend: &str) -> Vec<&'a Row> {
    let rows = results.rows.iter();
    rows.filter(|row| row.study == study && row.backend == backend).collect()
}
