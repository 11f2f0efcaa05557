//! The reference of deck keys, in Markdown.

use serde_json::Value as Json;

use super::{Schema, names};
use crate::range::POSITIVE_WORDS;
use crate::reader::{Form, TableSurvey, below};
use crate::step;

pub(super) fn document(schema: &Schema) -> String {
    let mut page = Page {
        schema,
        text: format!(
            "# Deck reference\n\n{}\n",
            include_str!("../language.md").trim_end()
        ),
    };
    page.section("");
    page.text += &step::reference();
    page.text += "\n## Shared forms\n\nForms of values shared by several keys.\n";
    for name in schema.survey.definitions() {
        // Tables of the deck have a section above.
        if schema.is_shared(name) {
            continue;
        }
        page.heading(3, &format!("`{name}`"));
        page.about(name);
        if schema.survey.table(name).is_some() {
            page.keys(name);
            page.tables_in(name);
        } else {
            let forms = page.forms(name);
            page.text += &format!("\nA value: {forms}.\n");
        }
    }
    page.text
}

/// The page under construction.
struct Page<'a> {
    schema: &'a Schema,
    text: String,
}

/// Returns a text in which `<` does not start an HTML tag; code spans are unchanged.
fn literal(text: &str) -> String {
    let parts = text.split('`').enumerate().map(|(k, part)| match k % 2 {
        0 => part.replace('<', "\\<"),
        _ => part.to_owned(),
    });
    parts.collect::<Vec<String>>().join("`")
}

impl Page<'_> {
    /// Writes the section of a table and of the tables in it.
    fn section(&mut self, place: &str) {
        let depth = place.split('.').filter(|step| !step.is_empty()).count();
        self.heading(2 + usize::from(depth > 1), &title(place));
        self.about(place);
        self.keys(place);
        self.tables_in(place);
    }

    /// Writes the sections of the tables in a table.
    fn tables_in(&mut self, place: &str) {
        let Some(table) = self.schema.survey.table(place) else {
            return;
        };
        let inner: Vec<String> = table
            .keys()
            .filter_map(|key| self.table_in(&below(place, key)))
            .collect();
        for place in inner {
            self.section(&place);
        }
    }

    fn heading(&mut self, level: usize, title: &str) {
        self.text += &format!("\n{} {title}\n", "#".repeat(level));
    }

    fn about(&mut self, place: &str) {
        let descriptions = &self.schema.descriptions;
        let text = descriptions.of_table(place);
        if let Some(text) = text.or_else(|| descriptions.of_key(place)) {
            self.text += &format!("\n{}\n", literal(text));
        }
    }

    /// Returns the place of the table that a value is, or of the tables that are its entries.
    fn table_in(&self, place: &str) -> Option<String> {
        self.schema
            .forms(place)
            .into_iter()
            .find_map(|form| match form {
                Form::Table => Some(place.to_owned()),
                Form::List { .. } => self.table_in(&format!("{place}[]")),
                _ => None,
            })
    }

    fn keys(&mut self, place: &str) {
        let Some(table) = self
            .schema
            .survey
            .table(place)
            .filter(|table| table.keys().next().is_some())
        else {
            return;
        };
        self.text += "\n| key | value | default | meaning |\n|---|---|---|---|\n";
        for key in table.keys() {
            let at = below(place, key);
            let names: Vec<String> = names(key).map(|name| format!("`{name}`")).collect();
            let mut meaning = self.schema.description(&at).unwrap_or_default().to_owned();
            for range in self.schema.ranges(&at) {
                meaning += &format!(" Allowed: {range}.");
            }
            let row = [
                names.join(", "),
                self.forms(&at),
                self.default(table, key, &at),
                meaning,
            ];
            let cells: Vec<String> = row
                .iter()
                .map(|cell| literal(cell).replace('|', "\\|"))
                .collect();
            self.text += &format!("| {} |\n", cells.join(" | "));
        }
        for (keys, needed) in table.choices() {
            let keys: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
            let count = if needed { "Exactly" } else { "At most" };
            self.text += &format!("\n{count} one of {}.\n", keys.join(", "));
        }
    }

    /// Returns the default of a key.
    fn default(&self, table: &TableSurvey, key: &str, place: &str) -> String {
        if table.needs(key) {
            return "required".into();
        }
        let defaults = self
            .schema
            .survey
            .value(place)
            .map(|value| &value.defaults[..]);
        let mut defaults: Vec<String> = defaults.unwrap_or_default().iter().map(plain).collect();
        defaults.dedup();
        defaults.join(" or ")
    }

    /// Returns the forms of a value.
    fn forms(&self, place: &str) -> String {
        let forms = self.schema.forms(place).into_iter();
        let mut texts: Vec<String> = forms.map(|form| self.form(place, form)).collect();
        texts.dedup();
        texts.join(", or ")
    }

    /// Returns the forms of the entries of a list.
    fn entries(&self, place: &str) -> String {
        let entries = self.forms(&format!("{place}[]"));
        if entries.contains(", or ") {
            format!("({entries})")
        } else {
            entries
        }
    }

    fn form(&self, place: &str, form: &Form) -> String {
        match form {
            Form::Text => "text".into(),
            Form::Boolean => "`true`, `false`".into(),
            Form::Count { range } => format!("integer ≥ {}", range.least()),
            Form::Number { quantity, allowed } => {
                let sign = if allowed.as_deref() == Some(POSITIVE_WORDS) {
                    "positive "
                } else {
                    ""
                };
                match quantity.unit() {
                    "" => format!("{sign}number"),
                    unit => format!("{sign}{} ({unit})", quantity.noun()),
                }
            }
            Form::Words(words) => {
                let words: Vec<String> = words.iter().map(|word| format!("`\"{word}\"`")).collect();
                words.join(", ")
            }
            Form::List { length } => {
                let count = length.map_or(String::new(), |length| format!("{length} × "));
                format!("list of {count}{}", self.entries(place))
            }
            Form::Vector => format!("vector of {}", self.entries(place)),
            Form::Table => format!("[table](#{})", anchor(&title(place))),
            Form::Names(name) => format!("[{name}](#{}) by name", anchor(name)),
            Form::Defined(name) => format!("[{name}](#{})", anchor(name)),
        }
    }
}

/// Returns the heading of a table in decks.
fn title(place: &str) -> String {
    let name = place.replace("[]", "");
    match place {
        "" => "The deck".into(),
        _ if place.ends_with("[]") => format!("[[{name}]]"),
        _ => format!("[{name}]"),
    }
}

/// Returns the anchor of a heading.
fn anchor(title: &str) -> String {
    let kept = title.to_lowercase().replace(' ', "-");
    kept.chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_'))
        .collect()
}

/// Returns a default as written in decks.
fn plain(value: &Json) -> String {
    match value {
        Json::Array(entries) if !entries.is_empty() => {
            match entries.iter().all(|entry| *entry == entries[0]) {
                true => plain(&entries[0]),
                false => format!("`{value}`"),
            }
        }
        Json::Number(number) => match number.as_f64() {
            Some(number) => format!("`{number}`"),
            None => format!("`{number}`"),
        },
        other => format!("`{other}`"),
    }
}
