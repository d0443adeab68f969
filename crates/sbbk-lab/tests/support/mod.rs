//! What the tests of the studies share.

use std::fs;

use csv::StringRecord;
use sbbk_lab::report::{Grid, Results, write_csv, write_json, write_plot};
use serde_json::Value;

/// The files of a study, read again.
pub struct Report {
    pub json: Value,
    /// Study, scene, recycling, backend, quantity, statistic and value of each number.
    pub csv: Vec<StringRecord>,
    pub svg: String,
}

/// Writes all files. Panics where a table is empty or a row has more or fewer cells than its header, and where a file
/// is not what it should be.
pub fn report(results: &impl Results) -> Report {
    for Grid { title, header, rows, .. } in results.tables() {
        assert!(!rows.is_empty(), "{title}");
        assert!(rows.iter().all(|row| row.len() == header.len()), "{title}");
    }
    let folder = tempfile::tempdir().unwrap();
    let [json, csv, svg] =
        ["json", "csv", "svg"].map(|end| folder.path().join("out").with_extension(end));
    write_json(results, &json).unwrap();
    write_csv(results, &csv).unwrap();
    write_plot(results, &svg).unwrap();
    let mut lines = csv::Reader::from_path(csv).unwrap();
    let report = Report {
        json: serde_json::from_slice(&fs::read(json).unwrap()).unwrap(),
        csv: lines.records().map(Result::unwrap).collect(),
        svg: fs::read_to_string(svg).unwrap(),
    };
    assert!(report.svg.starts_with("<svg"));
    report
}
