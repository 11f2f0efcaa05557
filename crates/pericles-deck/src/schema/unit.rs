//! Units of keys.

use std::sync::OnceLock;

use super::Schema;
use crate::reader::{Form, below};
use crate::vocabulary::canonical;

/// Returns the SI unit of the value of a key, such as `m` for `body.spacing`; empty for other
/// values and unknown keys.
pub fn unit_of_key(key: &str) -> &'static str {
    static SCHEMA: OnceLock<Schema> = OnceLock::new();
    let schema = SCHEMA.get_or_init(Schema::new);
    let mut place = String::new();
    let mut parts = key.split('.').peekable();
    while let Some(part) = parts.next() {
        place = match part.bytes().all(|byte| byte.is_ascii_digit()) {
            true => format!("{place}[]"),
            false => below(&place, canonical(part)),
        };
        let definition = schema
            .forms(&place)
            .into_iter()
            .find_map(|form| match form {
                // The next part is a name.
                Form::Names(definition) => Some((*definition, true)),
                // A value may also be a number with a unit.
                Form::Defined(definition) if parts.peek().is_some() => Some((*definition, false)),
                _ => None,
            });
        if let Some((definition, is_named)) = definition {
            if is_named {
                parts.next();
            }
            place = definition.into();
        }
    }
    let unit = schema
        .forms(&place)
        .into_iter()
        .find_map(|form| match form {
            Form::Number { quantity, .. } => Some(quantity.unit()),
            _ => None,
        });
    unit.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_keys_are_those_of_the_reader() {
        for (key, unit) in [
            ("body.spacing", "m"),
            ("body.dx", "m"),
            ("material.youngs_modulus", "Pa"),
            ("material.density", "kg/m3"),
            ("thermal.expansion", "1/K"),
            ("material.E", "Pa"),
            ("materials.soft.fracture_energy", "J/m2"),
            ("material.poissons_ratio", ""),
            ("load.0.from", "s"),
            ("time.end", "s"),
            ("title", ""),
            ("no.such.key", ""),
        ] {
            assert_eq!(unit_of_key(key), unit, "{key}");
        }
    }
}
