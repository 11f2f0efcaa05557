//! JSON Schema of decks, draft 2020-12.

use serde_json::{Map, Value as Json, json};

use super::{Schema, names};
use crate::quantity::Quantity;
use crate::range::POSITIVE_WORDS;
use crate::reader::{Form, below};
use crate::step::add_to_schema;

/// Regular expression of a decimal number without sign and with an optional unit.
const DIGITS: &str = r"(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?(\s*[^\s\d,].*)?\s*$";

pub(super) fn document(schema: &Schema) -> Json {
    let mut root = schema.table("");
    add_to_schema(&mut root);
    let mut definitions = Map::new();
    for (quantity, positive) in schema.quantities() {
        definitions.insert(title(quantity, positive), number(quantity, positive));
    }
    for name in schema.survey.definitions() {
        let mut definition = if schema.forms(name).is_empty() || schema.is_shared(name) {
            schema.table(name)
        } else {
            schema.value(name)
        };
        describe(&mut definition, schema.descriptions.of_table(name));
        definitions.insert(name.to_owned(), definition.into());
    }
    root.insert("$defs".into(), definitions.into());
    root.insert(
        "$schema".into(),
        "https://json-schema.org/draft/2020-12/schema".into(),
    );
    root.insert("title".into(), "Pericles deck".into());
    describe(&mut root, schema.descriptions.of_table(""));
    root.into()
}

impl Schema {
    /// Returns the schema of a table with its keys under all names.
    fn table(&self, place: &str) -> Map<String, Json> {
        let mut properties = Map::new();
        let (mut required, mut rules): (Vec<&str>, Vec<Json>) = (Vec::new(), Vec::new());
        if let Some(table) = self.survey.table(place) {
            let mut chosen: Vec<&str> = Vec::new();
            for (keys, needed) in table.choices() {
                chosen.extend(keys);
                rules.push(one_of(keys.iter().flat_map(|key| names(key)), needed));
            }
            for key in table.keys() {
                let value = self.value(&below(place, key));
                for name in names(key) {
                    properties.insert(name.to_owned(), value.clone().into());
                }
                if chosen.contains(&key) {
                    continue;
                }
                match (names(key).count(), table.needs(key)) {
                    (1, true) => required.push(key),
                    (1, false) => {}
                    (_, needed) => rules.push(one_of(names(key), needed)),
                }
            }
        }
        let mut object = Map::new();
        object.insert("type".into(), "object".into());
        object.insert("properties".into(), properties.into());
        object.insert("additionalProperties".into(), false.into());
        if !required.is_empty() {
            object.insert("required".into(), required.into());
        }
        if !rules.is_empty() {
            object.insert("allOf".into(), rules.into());
        }
        object
    }

    /// Returns the schema of a value with its description.
    fn value(&self, place: &str) -> Map<String, Json> {
        let forms = self.forms(place).into_iter();
        let mut alternatives: Vec<Map<String, Json>> =
            forms.map(|form| self.form(place, form)).collect();
        alternatives.dedup();
        let mut value = match alternatives.len() {
            1 => alternatives.remove(0),
            _ => object(json!({ "anyOf": alternatives })),
        };
        let mut text = self.description(place).unwrap_or_default().to_owned();
        let ranges = self.ranges(place);
        if !ranges.is_empty() {
            text += &format!(" Allowed: {}.", ranges.join("; or "));
        }
        describe(
            &mut value,
            Some(text.trim()).filter(|text| !text.is_empty()),
        );
        let defaults = self.survey.value(place).map(|value| &value.defaults[..]);
        if let Some([default]) = defaults {
            value.insert("default".into(), default.clone());
        }
        value
    }

    fn form(&self, place: &str, form: &Form) -> Map<String, Json> {
        object(match form {
            Form::Text => json!({ "type": "string" }),
            Form::Boolean => json!({ "type": "boolean" }),
            Form::Count { range } => json!({ "type": "integer", "minimum": range.least() as u64 }),
            Form::Number { quantity, allowed } => {
                reference(&title(*quantity, is_positive(allowed.as_deref())))
            }
            Form::Words(words) => json!({ "enum": words }),
            Form::List { length } => {
                let mut list =
                    json!({ "type": "array", "items": self.value(&format!("{place}[]")) });
                if let Some(length) = length {
                    list["minItems"] = (*length).into();
                    list["maxItems"] = (*length).into();
                }
                list
            }
            Form::Vector => {
                let entry = self.value(&format!("{place}[]"));
                let list =
                    json!({ "type": "array", "items": &entry, "minItems": 1, "maxItems": 3 });
                json!({ "anyOf": [entry, list] })
            }
            Form::Table if self.is_shared(place) => reference(place),
            Form::Table => return self.table(place),
            Form::Names(name) => {
                json!({ "type": "object", "additionalProperties": reference(name) })
            }
            Form::Defined(name) => reference(name),
        })
    }

    /// Returns all quantities of numbers, and whether they must be positive.
    fn quantities(&self) -> Vec<(Quantity, bool)> {
        let mut found = Vec::new();
        for form in self.survey.values().flat_map(|value| &value.forms) {
            if let Form::Number { quantity, allowed } = form {
                let one = (*quantity, is_positive(allowed.as_deref()));
                if !found.contains(&one) {
                    found.push(one);
                }
            }
        }
        found
    }
}

fn is_positive(allowed: Option<&str>) -> bool {
    allowed == Some(POSITIVE_WORDS)
}

/// Returns the schema of a number in SI units or a text with a unit.
fn number(quantity: Quantity, positive: bool) -> Json {
    let (plain, sign) = if positive {
        (
            json!({ "type": "number", "exclusiveMinimum": 0 }),
            r"^\s*\+?",
        )
    } else {
        (json!({ "type": "number" }), r"^\s*[-+]?")
    };
    json!({
        "description": quantity.expected(),
        "anyOf": [plain, { "type": "string", "pattern": format!("{sign}{DIGITS}") }],
        "examples": [quantity.example()],
    })
}

/// Returns the name of the definition of a quantity: `positive-mass-density`.
fn title(quantity: Quantity, positive: bool) -> String {
    let name = quantity.noun().replace(' ', "-");
    if positive {
        format!("positive-{name}")
    } else {
        name
    }
}

fn reference(name: &str) -> Json {
    json!({ "$ref": format!("#/$defs/{name}") })
}

/// Returns the rule that at most one, or exactly one, of several keys is given.
fn one_of(keys: impl Iterator<Item = &'static str>, needed: bool) -> Json {
    let mut alternatives: Vec<Json> = keys.map(|key| json!({ "required": [key] })).collect();
    if !needed {
        let none = json!({ "not": { "anyOf": alternatives } });
        alternatives.push(none);
    }
    json!({ "oneOf": alternatives })
}

fn describe(value: &mut Map<String, Json>, text: Option<&str>) {
    if let Some(text) = text {
        value.insert("description".into(), text.into());
    }
}

fn object(value: Json) -> Map<String, Json> {
    match value {
        Json::Object(members) => members,
        _ => Map::new(),
    }
}
