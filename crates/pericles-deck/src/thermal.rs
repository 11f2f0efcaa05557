//! `[thermal]`: thermal expansion by a prescribed temperature.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::component::{Component, Variables, component};
use crate::course::{self, TimeHistory};
use crate::quantity::Quantity;
use crate::reader::Table;

/// Thermal expansion under a prescribed temperature.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// Coefficient of thermal expansion α, 1/K, of all materials without their own.
    pub expansion: f64,
    /// Coefficients by material.
    #[serde(default, rename = "material")]
    pub materials: Vec<MaterialExpansion>,
    /// Temperature, K, unless a file gives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Component>,
    /// File with the temperature of every point; a relative path starts at the deck's folder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Time function that multiplies the difference to the reference temperature.
    #[serde(default, skip_serializing_if = "TimeHistory::is_constant")]
    pub function: TimeHistory,
    /// Reference temperature without thermal strain, K.
    pub reference: f64,
}

/// The coefficient of thermal expansion of a material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialExpansion {
    /// The name of the material.
    pub name: String,
    /// α, 1/K.
    pub expansion: f64,
}

/// Keys of the temperature.
const TEMPERATURES: &[&str] = &["temperature", "file"];

/// Largest allowed coefficient, above that of any solid, 1/K.
pub(crate) const LARGEST: f64 = 0.01;

pub(crate) fn read(
    table: Table<'_>,
    dimension: Option<usize>,
    names: &[String],
) -> Option<Thermal> {
    let variables = Variables {
        dimension,
        time: true,
    };
    let expansion = expansion(&table);
    let (temperature, file) = match table.exactly_one(TEMPERATURES) {
        Some(("file", item)) => (None, item.text().map(PathBuf::from)),
        Some((_, item)) => (component(&item, Quantity::Temperature, variables), None),
        None => (None, None),
    };
    let function = course::function(&table);
    let reference = table
        .required("reference")
        .and_then(|item| item.quantity(Quantity::Temperature));
    let tables = table.tables("material").into_iter();
    let materials: Vec<_> = tables.map(|table| of_material(table, names)).collect();
    table.finish();
    if temperature.is_none() && file.is_none() {
        return None;
    }
    let materials: Vec<MaterialExpansion> = materials.into_iter().collect::<Option<_>>()?;
    Some(Thermal {
        expansion: expansion?,
        materials,
        temperature,
        file,
        function: function?,
        reference: reference?,
    })
}

fn expansion(table: &Table<'_>) -> Option<f64> {
    table.required("expansion")?.within(
        Quantity::Expansion,
        "a number from -0.01 to 0.01 in 1/K (steel: 12e-6)",
        |value| value.abs() <= LARGEST,
    )
}

fn of_material(table: Table<'_>, names: &[String]) -> Option<MaterialExpansion> {
    let name = table.required("name").and_then(|item| {
        let name = item.text()?;
        if names.contains(&name) {
            return Some(name);
        }
        item.unknown_word("material", &name, names.iter().map(String::as_str));
        None
    });
    let expansion = expansion(&table);
    table.finish();
    Some(MaterialExpansion {
        name: name?,
        expansion: expansion?,
    })
}
