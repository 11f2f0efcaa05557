//! `report`: a run on one page of HTML that needs no other file, to be mailed or kept.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use base64::prelude::{BASE64_STANDARD, Engine as _};
use pericles_io::{IoError, escaped, write_atomically};
use pericles_run::{Results, file_name};
use serde_json::Value;

use crate::args::ReportArgs;
use crate::charts;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::info;

/// Pictures of one field on the page; of more, so many evenly spread ones.
const MOST_PICTURES: usize = 6;

const STYLE: &str = "\
body { font: 16px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h1 { margin-bottom: 0; } h2 { margin-top: 2.5rem; border-bottom: 1px solid #ccc; }
img { max-width: 100%; } figure { margin: 1rem 0; } figcaption { color: #555; }
table { border-collapse: collapse; } td { padding: .15rem 1rem .15rem 0; vertical-align: top; } td:first-child { color: #555; white-space: nowrap; }
pre { background: #f6f6f6; padding: 1rem; overflow-x: auto; font-size: 14px; } .warning { background: #fff4d6; padding: .5rem 1rem; margin: .5rem 0; }";

/// Writes the page.
///
/// # Errors
/// A folder without results, files of it that are damaged, a page that exists or cannot be written.
pub(crate) fn report(args: &ReportArgs) -> Result<Exit, CliError> {
    let results = Results::open(&args.dir)?;
    let path = args
        .out
        .clone()
        .unwrap_or_else(|| args.dir.join("report.html"));
    let page = page(&results)?;
    write_atomically(&path, |file| file.write_all(page.as_bytes()))?;
    console::print(format_args!("{}", path.display()))?;
    Ok(Exit::Done)
}

fn page(results: &Results) -> Result<String, CliError> {
    let title = match results.text("/title") {
        "" => results.folder().display().to_string(),
        title => title.to_owned(),
    };
    let mut page = Page::default();
    page.text(format_args!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{0}</title>\n<style>\n{STYLE}\n</style>\n<h1>{0}</h1>\n",
        escaped(&title)
    ));
    page.text(format_args!("<p>{}</p>\n", escaped(&info::status(results))));
    for warning in results.texts("/model/warnings") {
        page.text(format_args!(
            "<p class=\"warning\">Warning: {}</p>\n",
            escaped(warning)
        ));
    }
    page.pictures(results)?;
    page.histories(results)?;
    page.heading("Model");
    page.values(results.value("/model"));
    if results.value("/audit").is_some_and(Value::is_object) {
        page.heading("Audit of energy and momentum (SI units)");
        page.values(results.value("/audit"));
    }
    page.source(results);
    page.heading("Machine");
    page.values(results.value("/program"));
    page.values(results.value("/progress"));
    page.text(format_args!("</html>\n"));
    Ok(page.html)
}

/// A page that grows.
#[derive(Default)]
struct Page {
    html: String,
}

impl Page {
    /// The deck as it was given, or the model as JSON.
    fn source(&mut self, results: &Results) {
        if let Some(model) = results.value("/model_data/model") {
            self.heading("Model data");
            self.text(format_args!(
                "<pre>{}</pre>\n",
                escaped(&format!("{model:#}"))
            ));
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
                "<p>Changed on the command line: {}</p>\n",
                escaped(&overrides.join(", "))
            ));
        }
        self.text(format_args!(
            "<pre>{}</pre>\n",
            escaped(results.text("/deck/source"))
        ));
    }

    fn text(&mut self, text: std::fmt::Arguments<'_>) {
        // A string takes any text.
        let _ = self.html.write_fmt(text);
    }

    fn heading(&mut self, heading: &str) {
        self.text(format_args!("<h2>{}</h2>\n", escaped(heading)));
    }

    fn figure(&mut self, png: &[u8], caption: &str) {
        let caption = escaped(caption);
        self.text(format_args!(
            "<figure><img alt=\"{caption}\" src=\"data:image/png;base64,{}\"><figcaption>{caption}</figcaption></figure>\n",
            BASE64_STANDARD.encode(png)
        ));
    }

    /// The pictures of every field, evenly spread in time.
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
            // The last one is the one to see first.
            for path in spread(&paths).into_iter().rev() {
                let png = std::fs::read(path).map_err(|error| IoError::reading(path, error))?;
                let name = file_name(path);
                self.figure(&png, &format!("{} ({name})", field.replace('_', " ")));
            }
            if paths.len() > MOST_PICTURES {
                let text = format!("{MOST_PICTURES} of {} pictures of {field}", paths.len());
                self.text(format_args!("<p>{}</p>\n", escaped(&text)));
            }
        }
        Ok(())
    }

    fn histories(&mut self, results: &Results) -> Result<(), CliError> {
        for table in results.tables() {
            let file = file_name(&table);
            let charts = charts::of_table(&table, |_| true)?;
            if !charts.is_empty() {
                self.heading(&file);
            }
            for chart in charts {
                let png = chart.drawn().width(1000).to_png(&file)?;
                self.figure(&png, &format!("{} ({file})", chart.name));
            }
        }
        Ok(())
    }

    /// The values of an object, those of objects in it behind a dot.
    fn values(&mut self, object: Option<&Value>) {
        let mut rows = Vec::new();
        collect(object.unwrap_or(&Value::Null), "", &mut rows);
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

fn collect(value: &Value, name: &str, rows: &mut Vec<(String, String)>) {
    let text = match value {
        Value::Object(object) => {
            for (key, value) in object {
                let key = key.replace('_', " ");
                let name = if name.is_empty() {
                    key
                } else {
                    format!("{name}, {key}")
                };
                collect(value, &name, rows);
            }
            return;
        }
        Value::Null => return,
        Value::String(text) => text.clone(),
        Value::Array(items) if items.is_empty() => return,
        Value::Array(items) => items
            .iter()
            .map(Value::to_string)
            .collect::<Vec<_>>()
            .join(", "),
        other => other.to_string(),
    };
    rows.push((name.to_owned(), text));
}

/// At most so many of a list, evenly spread, the first and the last among them.
fn spread(paths: &[PathBuf]) -> Vec<&Path> {
    if paths.len() <= MOST_PICTURES {
        return paths.iter().map(PathBuf::as_path).collect();
    }
    let last = paths.len() - 1;
    let pick = |k: usize| paths[k * last / (MOST_PICTURES - 1)].as_path();
    (0..MOST_PICTURES).map(pick).collect()
}
