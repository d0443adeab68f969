//! Fills the tables of docs/measurements.md with the numbers of docs/data/*.csv.
//!
//! ```text
//! cargo run --release -p sbbk-lab --bin tables
//! ```

use std::fs;

use sbbk_lab::cli::Outcome;
use sbbk_lab::report::tables;

const PAGE: &str = "docs/measurements.md";
const DATA: &str = "docs/data";

/// Fills the tables for which there are data.
fn main() -> Outcome {
    let mut page = fs::read_to_string(PAGE)?;
    for file in fs::read_dir(DATA)? {
        let path = file?.path();
        if path.extension().is_none_or(|extension| extension != "csv") {
            continue;
        }
        let study = path.file_stem().unwrap_or_default().to_string_lossy();
        for table in tables(&study, &fs::read_to_string(&path)?) {
            match replaced(&page, table.name, &table.markdown()) {
                Some(filled) => page = filled,
                None => println!("{PAGE} has no table {}", table.name),
            }
        }
    }
    Ok(fs::write(PAGE, page)?)
}

/// Replaces what stands between the marks of a table.
fn replaced(page: &str, name: &str, table: &str) -> Option<String> {
    let mark = format!("<!-- table: {name} -->\n");
    let start = page.find(&mark)? + mark.len();
    let end = start + page[start..].find("<!-- end -->")?;
    Some(format!("{}{table}{}", &page[..start], &page[end..]))
}
