//! Results of several studies on one page.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use super::{Panel, ReportError, Results, Table, replace_file};

const STYLE: &str = "\
    body { font: 15px/1.45 system-ui, sans-serif; color: #1b1e22; max-width: 75em; \
           margin: 2em auto; padding: 0 1em; } \
    h2 { margin-top: 2em; border-bottom: 1px solid #c5ccd3; } \
    table { border-collapse: collapse; font-size: .85em; font-variant-numeric: tabular-nums; } \
    caption { text-align: left; font-weight: 600; padding: .6em 0 .3em; } \
    th, td { padding: .15em .6em; border-bottom: 1px solid #dde2e7; text-align: right; } \
    th { border-bottom: 2px solid #59626b; vertical-align: bottom; } \
    td { white-space: nowrap; } \
    .text { text-align: left; white-space: normal; } \
    .wide { overflow-x: auto; } \
    .notes { font-size: .8em; color: #59626b; margin: .3em 0 1.2em; } \
    svg { max-width: 100%; height: auto; } \
    @media print { body { font-size: 9pt; max-width: none; } section { break-before: page; } \
                   table, svg { break-inside: avoid; } .wide { overflow: visible; } }";

/// A study on the page.
pub struct Section {
    /// What it is about.
    pub title: &'static str,
    /// What a reader must know.
    pub text: &'static str,
    /// What it found.
    pub results: Results,
}

/// Writes a page with the tables and diagrams of some studies, the machine, and the command that
/// made it.
///
/// Errors: the file cannot be written.
pub fn write_html(
    path: &Path,
    title: &str,
    command: &str,
    sections: &[Section],
) -> Result<(), ReportError> {
    replace_file(path, |path| fs::write(path, page(title, command, sections)))
}

fn page(title: &str, command: &str, sections: &[Section]) -> String {
    let mut page = String::new();
    let title = escaped(title);
    let _ = write!(
        page,
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n<h1>{title}</h1>\n\
         <p><code>{}</code></p>\n",
        escaped(command)
    );
    if let Some(section) = sections.first() {
        let _ = writeln!(page, "<p>{}</p>", escaped(&section.results.environment.to_string()));
    }
    for Section { title, text, results } in sections {
        let _ = write!(page, "<section>\n<h2>{}</h2>\n<p>{}</p>\n", escaped(title), escaped(text));
        if !results.panels.is_empty() {
            let _ = writeln!(page, "{}", Panel::draw_all(&results.panels));
        }
        results.tables.iter().for_each(|table| add_table(&mut page, table));
        page.push_str("</section>\n");
    }
    page.push_str("</html>\n");
    page
}

fn add_table(page: &mut String, table: &Table) {
    let line = |cells: &[String], tag: &str| {
        let cells = cells.iter().enumerate().map(|(column, cell)| {
            let class = if table.is_text(column) { " class=\"text\"" } else { "" };
            format!("<{tag}{class}>{}</{tag}>", escaped(cell))
        });
        format!("<tr>{}</tr>\n", cells.collect::<String>())
    };
    let head = line(&table.header, "th");
    let body: String = table.lines.iter().map(|cells| line(cells, "td")).collect();
    let notes: Vec<String> = table.notes.iter().map(|note| escaped(note)).collect();
    let _ = write!(
        page,
        "<div class=\"wide\"><table><caption>{}</caption>\n<thead>{head}</thead>\n\
         <tbody>{body}</tbody></table></div>\n<p class=\"notes\">{}</p>\n",
        escaped(&table.title),
        notes.join("<br>")
    );
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
