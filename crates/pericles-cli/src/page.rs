//! `report`: a self-contained HTML page about a run.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use base64::prelude::{BASE64_STANDARD, Engine as _};
use pericles_io::{IoError, escaped, write_atomically};
use pericles_run::sweep::{SweepResults, is_sweep};
use pericles_run::units::{bytes, count, quantity, significant};
use pericles_run::{Results, file_name};
use serde_json::Value;

use crate::args::ReportArgs;
use crate::charts::{Scales, of_table};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::info;
use crate::plot;

/// Most pictures per field; of more, evenly spaced ones are shown.
const MOST_PICTURES: usize = 6;

const STYLE: &str = "\
body { font: 16px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h1 { margin-bottom: .5rem; } h2 { margin-top: 2.5rem; border-bottom: 1px solid #ccc; }
img { max-width: 100%; } figure { margin: 1rem 0; } figcaption { color: #555; }
.thumbnails { display: grid; grid-template-columns: repeat(3, 1fr); gap: 1rem; } .thumbnails figure { margin: 0; font-size: 14px; }
table { border-collapse: collapse; } td, th { padding: .15rem 1rem .15rem 0; vertical-align: top; text-align: left; }
td:first-child { color: #555; white-space: nowrap; } .runs td { white-space: nowrap; }
nav a { margin-right: 1rem; } .wide { overflow-x: auto; } .runs { margin-bottom: 1rem; } .runs th { vertical-align: bottom; }
pre { background: #f6f6f6; padding: 1rem; overflow-x: auto; font-size: 14px; } .warning { background: #fff4d6; padding: .5rem 1rem; margin: .5rem 0; }
@media print { body { max-width: none; margin: 0; font-size: 11px; } nav { display: none; } figure, tr, .warning { break-inside: avoid; } h2 { break-after: avoid; } pre { white-space: pre-wrap; } .wide { overflow: visible; } }";

/// Writes the report of a run or a parameter sweep.
///
/// # Errors
/// The folder has no results or damaged files, or the page cannot be written.
pub(crate) fn report(args: &ReportArgs) -> Result<Exit, CliError> {
    let page = match is_sweep(&args.dir) {
        true => of_sweep(&SweepResults::open(&args.dir)?)?,
        false => of_run(&Results::open(&args.dir)?)?,
    };
    let path = args
        .out
        .clone()
        .unwrap_or_else(|| args.dir.join("report.html"));
    write_atomically(&path, |file| file.write_all(page.as_bytes()))?;
    console::print(format_args!("{}", path.display()))?;
    Ok(Exit::Done)
}

/// Returns the report of a run: summary, warnings, pictures, time histories, energy balance, model, deck, machine.
fn of_run(results: &Results) -> Result<String, CliError> {
    let title = match results.text("/title") {
        "" => results.folder().display().to_string(),
        title => title.to_owned(),
    };
    let mut page = Page::default();
    page.summary(&info::lines(results)?);
    let warnings = ["/model/warnings", "/audit/warnings"];
    let warnings = warnings
        .iter()
        .flat_map(|pointer| results.texts(pointer))
        .map(|warning| format!("<p class=\"warning\">{}</p>\n", escaped(warning)));
    let warnings: Vec<String> = warnings.collect();
    if !warnings.is_empty() {
        page.heading("Warnings");
        page.html += &warnings.concat();
    }
    page.pictures(results)?;
    page.histories(results)?;
    if results.value("/audit").is_some_and(Value::is_object) {
        page.heading("Energy balance");
        page.values(results.value("/audit"), results);
    }
    page.heading("Model");
    page.values(results.value("/model"), results);
    page.source(results);
    page.heading("Machine");
    page.values(results.value("/program"), results);
    page.values(results.value("/progress"), results);
    Ok(page.finished(&title))
}

/// Returns the report of a sweep: summary, table of the runs, charts of scalars, last pictures of the runs.
fn of_sweep(sweep: &SweepResults) -> Result<String, CliError> {
    let mut page = Page::default();
    let mut lines = vec![("deck", sweep.deck_file().to_owned())];
    lines.extend(
        sweep
            .keys()
            .map(|(key, values)| ("key", format!("{key} = {}", values.join(", ")))),
    );
    page.summary(&lines);
    page.heading("Runs");
    let table = sweep.table();
    let (rows, omitted) = informative(table.rows());
    for part in narrow(&rows) {
        page.table(&part);
    }
    if !omitted.is_empty() {
        let text = format!("Zero in all runs: {}.", omitted.join(", "));
        page.text(format_args!("<p>{}</p>\n", escaped(&text)));
    }
    page.heading("Charts");
    for scalar in plot::usual_scalars(sweep) {
        let values = sweep
            .runs()
            .filter_map(|(_, results)| pericles_run::scalar(&results?, &scalar).ok());
        if values.into_iter().all(|(value, _)| value == 0.0) {
            continue;
        }
        let chart = sweep.chart(None, &scalar)?;
        let png = chart.width(1000).to_png("chart")?;
        page.figure(&png, &format!("{} of each run", scalar.replace('_', " ")));
    }
    let last = sweep
        .runs()
        .filter_map(|(name, results)| Some((name.to_owned(), results?.pictures().pop()?)));
    let last: Vec<(String, PathBuf)> = last.collect();
    if !last.is_empty() {
        page.heading("Pictures");
        page.thumbnails(
            last.iter()
                .map(|(name, path)| (name.clone(), path.as_path())),
        )?;
    }
    let deck = file_name(Path::new(sweep.deck_file()));
    Ok(page.finished(&format!("Parameter sweep of {deck}")))
}

/// Returns a table without the columns that are zero or empty in all rows below the header, and the names of those that are
/// zero.
fn informative(rows: &[Vec<String>]) -> (Vec<Vec<String>>, Vec<String>) {
    let Some((header, runs)) = rows.split_first() else {
        return (Vec::new(), Vec::new());
    };
    let is_zero = |text: &String| text.parse::<f64>().is_ok_and(|number| number == 0.0);
    let is_omitted = |column: usize| {
        runs.iter()
            .all(|run| run[column].is_empty() || is_zero(&run[column]))
    };
    let kept: Vec<usize> = (0..header.len()).filter(|&k| !is_omitted(k)).collect();
    let of_row = |row: &Vec<String>| kept.iter().map(|&column| row[column].clone()).collect();
    let omitted = (0..header.len()).filter(|k| runs.iter().any(|run| is_zero(&run[*k])));
    let omitted = omitted.filter(|&k| is_omitted(k));
    let omitted = omitted.map(|column| header[column].clone()).collect();
    (rows.iter().map(of_row).collect(), omitted)
}

/// Divides a table into tables that are not wider than a page, each with the first column.
fn narrow(rows: &[Vec<String>]) -> Vec<Vec<Vec<String>>> {
    /// Most columns beside the first one.
    const COLUMNS: usize = 6;
    let columns = rows.first().map_or(0, Vec::len);
    let starts = (1..columns).step_by(COLUMNS);
    let part = |start: usize| {
        let end = columns.min(start + COLUMNS);
        let row = |row: &Vec<String>| [&row[..1], &row[start..end]].concat();
        rows.iter().map(row).collect()
    };
    starts.map(part).collect()
}

/// The HTML text after the title.
#[derive(Default)]
struct Page {
    html: String,
    headings: Vec<&'static str>,
}

impl Page {
    /// Adds the deck with its overrides, or the model as JSON.
    fn source(&mut self, results: &Results) {
        if let Some(model) = results.value("/model_data/model") {
            self.heading("Model data");
            self.values(Some(model), results);
            return;
        }
        self.heading("Deck");
        let overrides: Vec<&str> = results.texts("/deck/overrides").collect();
        self.text(format_args!(
            "<p>{}</p>\n",
            escaped(results.text("/deck/file"))
        ));
        if !overrides.is_empty() {
            self.text(format_args!(
                "<p>Overrides on the command line: {}</p>\n",
                escaped(&overrides.join(", "))
            ));
        }
        self.text(format_args!(
            "<pre>{}</pre>\n",
            escaped(results.text("/deck/source"))
        ));
    }

    fn text(&mut self, text: std::fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        let _ = self.html.write_fmt(text);
    }

    fn heading(&mut self, heading: &'static str) {
        self.text(format_args!("<h2 id=\"{0}\">{0}</h2>\n", escaped(heading)));
        self.headings.push(heading);
    }

    /// Adds the summary, which comes first.
    fn summary(&mut self, lines: &[(&str, String)]) {
        self.text(format_args!("<table>\n"));
        for (name, value) in lines {
            let value = escaped(value).replace('\n', "<br>");
            self.text(format_args!("<tr><td>{name}</td><td>{value}</td></tr>\n"));
        }
        self.text(format_args!("</table>\n"));
    }

    /// Completes the page with its title and contents.
    fn finished(self, title: &str) -> String {
        let title = escaped(title);
        let links = self.headings.iter();
        let links = links.map(|heading| format!("<a href=\"#{0}\">{0}</a>", escaped(heading)));
        let links: Vec<String> = links.collect();
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{title}</title>\n<style>\n{STYLE}\n</style>\n<h1>{title}</h1>\n<nav>{}</nav>\n{}</html>\n",
            links.join("\n"),
            self.html
        )
    }

    /// Adds a table with a header.
    fn table(&mut self, rows: &[Vec<String>]) {
        self.text(format_args!("<div class=\"wide\"><table class=\"runs\">\n"));
        for (number, row) in rows.iter().enumerate() {
            let is_header = number == 0;
            let cell = if is_header { "th" } else { "td" };
            let cells = row.iter().map(|text| {
                let text = match text.parse::<f64>() {
                    Ok(value) if value.fract() != 0.0 => significant(value, 4),
                    _ => text.clone(),
                };
                let mut text = escaped(&text);
                if is_header {
                    // Long names may continue on the next line.
                    text = text.replace('_', "_<wbr>").replace('.', ".<wbr>");
                }
                format!("<{cell}>{text}</{cell}>")
            });
            let cells: String = cells.collect();
            self.text(format_args!("<tr>{cells}</tr>\n"));
        }
        self.text(format_args!("</table></div>\n"));
    }

    /// Adds small pictures side by side.
    fn thumbnails<'a>(
        &mut self,
        pictures: impl Iterator<Item = (String, &'a Path)>,
    ) -> Result<(), CliError> {
        self.text(format_args!("<div class=\"thumbnails\">\n"));
        for (caption, path) in pictures {
            let png = std::fs::read(path).map_err(|error| IoError::reading(path, error))?;
            self.figure(&png, &caption);
        }
        self.text(format_args!("</div>\n"));
        Ok(())
    }

    fn figure(&mut self, png: &[u8], caption: &str) {
        let caption = escaped(caption);
        self.text(format_args!(
            "<figure><img alt=\"{caption}\" src=\"data:image/png;base64,{}\"><figcaption>{caption}</figcaption></figure>\n",
            BASE64_STANDARD.encode(png)
        ));
    }

    /// Adds the pictures of every field, evenly spaced in time, the last one first.
    fn pictures(&mut self, results: &Results) -> Result<(), CliError> {
        let mut series: Vec<(String, Vec<PathBuf>)> = Vec::new();
        for path in results.pictures() {
            let stem = path
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            let field = stem
                .rsplit_once('-')
                .map_or(stem.as_str(), |(field, _)| field)
                .to_owned();
            match series.iter_mut().find(|(name, _)| *name == field) {
                Some((_, paths)) => paths.push(path),
                None => series.push((field, vec![path])),
            }
        }
        if !series.is_empty() {
            self.heading("Pictures");
        }
        for (field, paths) in series {
            let caption =
                |path: &Path| format!("{} ({})", field.replace('_', " "), file_name(path));
            // The last one large, earlier ones as thumbnails.
            let shown = spread(&paths);
            let Some((last, earlier)) = shown.split_last() else {
                continue;
            };
            let png = std::fs::read(last).map_err(|error| IoError::reading(last, error))?;
            self.figure(&png, &caption(last));
            if !earlier.is_empty() {
                self.thumbnails(earlier.iter().map(|path| (caption(path), *path)))?;
            }
            if paths.len() > MOST_PICTURES {
                let text = format!(
                    "{MOST_PICTURES} of {} pictures of {field} shown; all are in the folder pictures/",
                    paths.len()
                );
                self.text(format_args!("<p>{}</p>\n", escaped(&text)));
            }
        }
        Ok(())
    }

    /// Adds the charts of all tables.
    fn histories(&mut self, results: &Results) -> Result<(), CliError> {
        let mut is_first = true;
        for table in results.tables() {
            let file = file_name(&table);
            for chart in of_table(&table, &Scales::of(results), |_| true)? {
                if std::mem::take(&mut is_first) {
                    self.heading("Time histories");
                }
                let png = chart.drawn().width(1000).to_png(&file)?;
                self.figure(&png, &format!("{} ({file})", chart.name));
            }
        }
        Ok(())
    }

    /// Adds a table of the values of an object, rounded and with units; keys of nested objects follow a comma.
    fn values(&mut self, object: Option<&Value>, results: &Results) {
        let mut rows = Vec::new();
        let unit = |key: &str| results.unit_of(key);
        collect(object.unwrap_or(&Value::Null), "", &unit, &mut rows);
        self.text(format_args!("<table>\n"));
        for (name, value) in rows {
            self.text(format_args!(
                "<tr><td>{}</td><td>{}</td></tr>\n",
                escaped(&name),
                escaped(&value)
            ));
        }
        self.text(format_args!("</table>\n"));
    }
}

fn collect(
    value: &Value,
    name: &str,
    unit: &dyn Fn(&str) -> String,
    rows: &mut Vec<(String, String)>,
) {
    let text = match value {
        Value::Object(object) => {
            for (key, value) in object {
                let name = match name {
                    "" => key.clone(),
                    outer => format!("{outer}, {key}"),
                };
                collect(value, &name, unit, rows);
            }
            return;
        }
        Value::Null => return,
        Value::Array(items) if items.is_empty() => return,
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| shown(name, item, unit)).collect();
            items.join(", ")
        }
        other => shown(name, other, unit),
    };
    rows.push((name.replace('_', " "), text));
}

/// Returns a rounded value with the unit of its key.
fn shown(name: &str, value: &Value, unit: &dyn Fn(&str) -> String) -> String {
    let key = name.rsplit(", ").next().unwrap_or(name);
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => match (number.as_u64(), number.as_f64(), &*unit(key)) {
            (Some(whole), _, "B") => bytes(whole),
            (Some(whole), _, "") => count(whole),
            (_, Some(x), "") => significant(x, 4),
            (_, Some(x), unit) => quantity(x, unit),
            _ => number.to_string(),
        },
        Value::Bool(true) => "yes".into(),
        Value::Bool(false) => "no".into(),
        other => other.to_string(),
    }
}

/// Returns at most [`MOST_PICTURES`] evenly spaced entries, including the first and the last.
fn spread(paths: &[PathBuf]) -> Vec<&Path> {
    if paths.len() <= MOST_PICTURES {
        return paths.iter().map(PathBuf::as_path).collect();
    }
    let last = paths.len() - 1;
    let pick = |k: usize| paths[k * last / (MOST_PICTURES - 1)].as_path();
    (0..MOST_PICTURES).map(pick).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_are_zero_in_all_runs_are_named_below_the_table() {
        let row = |cells: [&str; 4]| cells.map(String::from).to_vec();
        let rows = [
            row(["run", "kinetic_energy [J]", "elastic_energy [J]", "dt [s]"]),
            row(["a", "0.0", "1.5", ""]),
            row(["b", "0", "0", ""]),
        ];
        let (kept, omitted) = informative(&rows);
        assert_eq!(kept[0], ["run", "elastic_energy [J]"]);
        assert_eq!(kept[2], ["b", "0"]);
        assert_eq!(omitted, ["kinetic_energy [J]"]);
    }

    #[test]
    fn wide_tables_are_divided_and_lose_no_column() {
        let rows: Vec<Vec<String>> = (0..2)
            .map(|row| (0..16).map(|k| format!("{row} {k}")).collect())
            .collect();
        let parts = narrow(&rows);
        assert!(
            parts
                .iter()
                .all(|part| part[1][0] == "1 0" && part[0].len() <= 7)
        );
        let columns = parts.iter().flat_map(|part| &part[1][1..]);
        assert!(columns.eq(&rows[1][1..]));
    }
}
