//! `[thermal]`: thermal expansion by a prescribed or computed temperature, and heat conduction.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::component::{Component, Variables, component};
use crate::course::{self, TimeHistory};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::SetNames;
use crate::vocabulary::THERMAL_CONDITIONS;

/// Thermal expansion and heat conduction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// Coefficient of thermal expansion α, 1/K, of all materials without their own; none for a body that conducts heat
    /// only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expansion: Option<f64>,
    /// Constants by material.
    #[serde(default, rename = "material")]
    pub materials: Vec<MaterialThermal>,
    /// Temperature, K, unless a file gives it; the initial one with heat conduction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Component>,
    /// File with the temperature of every point; a relative path starts at the deck's folder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Time function that multiplies the difference to the reference temperature.
    #[serde(default, skip_serializing_if = "TimeHistory::is_constant")]
    pub function: TimeHistory,
    /// Reference temperature without thermal strain, K; needed for expansion and for time functions of temperatures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<f64>,
    /// Heat conduction; none if the temperature is prescribed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conduction: Option<Conduction>,
}

/// Thermal constants of a material; none for the constants of the body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialThermal {
    /// The name of the material.
    pub name: String,
    /// α, 1/K.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expansion: Option<f64>,
    /// k, W/(m K).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conductivity: Option<f64>,
    /// c, J/(kg K).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specific_heat: Option<f64>,
}

/// Heat conduction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Conduction {
    /// Conductivity k, W/(m K), of all materials without their own.
    pub conductivity: f64,
    /// Specific heat capacity c, J/(kg K), of all materials without their own.
    pub specific_heat: f64,
    /// Time integration.
    #[serde(default)]
    pub scheme: ConductionScheme,
    /// Thermal time step, s; none for the time step of the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// Mean conductivity of bonds between materials.
    #[serde(default)]
    pub interface: ConductivityMean,
    /// Whether bonds of points with incomplete families are corrected.
    #[serde(default = "yes")]
    pub surface_correction: bool,
    /// Part of its conductance that a broken bond keeps.
    #[serde(default)]
    pub broken_conductance: f64,
    /// Share of the energy dissipated by fracture and inelastic deformation that becomes heat.
    #[serde(default)]
    pub dissipation: f64,
    /// `[[thermal.condition]]`
    #[serde(default, rename = "condition")]
    pub conditions: Vec<ThermalCondition>,
}

fn yes() -> bool {
    true
}

/// Time integration of heat conduction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ConductionScheme {
    /// Forward Euler method in stable sub-steps.
    #[default]
    Explicit,
    /// Trapezoidal rule.
    Trapezoidal,
    /// Backward Euler method.
    BackwardEuler,
    /// Steady state at each time.
    Steady,
}

/// Mean conductivity of bonds between two materials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ConductivityMean {
    /// 2 k₁ k₂/(k₁ + k₂).
    #[default]
    Harmonic,
    /// (k₁ + k₂)/2.
    Arithmetic,
}

/// A thermal condition on a set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThermalCondition {
    /// Name of the set.
    pub set: String,
    /// The condition.
    pub amplitude: ThermalAmplitude,
    /// Area of the set for flux, convection and radiation, m²; none for the area of its face.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<f64>,
    /// Time function: multiplies flux and source, and the difference of temperatures to the reference temperature.
    #[serde(default, skip_serializing_if = "TimeHistory::is_constant")]
    pub function: TimeHistory,
}

/// A thermal condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ThermalAmplitude {
    /// Prescribed temperature, K.
    Temperature(Component),
    /// Heat flux into the body, W/m².
    Flux(Component),
    /// Heat source, W/m³.
    Source(Component),
    /// Heat flux h (T∞ − T).
    Convection {
        /// h, W/(m² K).
        coefficient: f64,
        /// T∞, K.
        ambient: Component,
    },
    /// Heat flux ε σ (T∞⁴ − T⁴).
    Radiation {
        /// ε.
        emissivity: f64,
        /// T∞, K.
        ambient: Component,
    },
}

/// Keys of the temperature.
const TEMPERATURES: &[&str] = &["temperature", "file"];

/// Keys that heat conduction needs together.
const CONDUCTION: &[&str] = &["conductivity", "specific_heat"];

/// Why steady states have no heat from dissipated energy.
pub(crate) const STORES_NO_HEAT: &str = "with scheme = \"steady\" the temperature stores no heat; use scheme = \"explicit\", \"trapezoidal\" or \"backward-euler\"";

const NEEDS: &str = "it requires `conductivity` and `specific_heat`";

pub(crate) fn read(
    table: Table<'_>,
    dimension: Option<usize>,
    (names, sets): (&[String], &SetNames),
) -> Option<Thermal> {
    let conducts = CONDUCTION.iter().any(|key| table.has(key));
    let variables = Variables {
        dimension,
        // The initial temperature of a body that conducts has no time.
        time: !conducts,
    };
    let expansion = match conducts {
        true => table.maybe("expansion", |item| expansion(&item)),
        false => table
            .required("expansion")
            .and_then(|item| expansion(&item))
            .map(Some),
    };
    let expands = !matches!(expansion, Some(None));
    let (temperature, file) = match table.exactly_one(TEMPERATURES) {
        Some(("file", item)) => (None, item.text().map(PathBuf::from)),
        Some((_, item)) => (component(&item, Quantity::Temperature, variables), None),
        None => (None, None),
    };
    let function = match conducts {
        false => course::function(&table),
        true => {
            table.forbid("function", "with heat conduction `temperature` is the initial one; set the function of a [[thermal.condition]]");
            Some(TimeHistory::default())
        }
    };
    let reference = match expands {
        true => table
            .required("reference")
            .and_then(|item| item.quantity(Quantity::Temperature))
            .map(Some),
        false => table.maybe("reference", |item| item.quantity(Quantity::Temperature)),
    };
    let conduction = match conducts {
        true => {
            let has_reference = !matches!(reference, Some(None));
            conduction(&table, dimension, (sets, has_reference)).map(Some)
        }
        false => {
            for key in [
                "scheme",
                "step",
                "interface",
                "surface_correction",
                "broken_conductance",
                "dissipation",
                "condition",
            ] {
                table.forbid(key, NEEDS);
            }
            Some(None)
        }
    };
    let tables = table.tables("material").into_iter();
    let materials: Vec<_> = tables
        .map(|table| of_material(table, names, conducts))
        .collect();
    table.finish();
    if temperature.is_none() && file.is_none() {
        return None;
    }
    let materials: Vec<MaterialThermal> = materials.into_iter().collect::<Option<_>>()?;
    Some(Thermal {
        expansion: expansion?,
        materials,
        temperature,
        file,
        function: function?,
        reference: reference?,
        conduction: conduction?,
    })
}

fn expansion(item: &Item<'_>) -> Option<f64> {
    item.quantity(Quantity::Expansion)
}

fn conductivity(item: &Item<'_>) -> Option<f64> {
    item.within(
        Quantity::Conductivity,
        "at least 0 W/m/K (steel: 45)",
        |k| k >= 0.0,
    )
}

fn conduction(
    table: &Table<'_>,
    dimension: Option<usize>,
    (sets, has_reference): (&SetNames, bool),
) -> Option<Conduction> {
    let k = table
        .required("conductivity")
        .and_then(|item| conductivity(&item));
    let specific_heat = table
        .required("specific_heat")
        .and_then(|item| item.positive(Quantity::SpecificHeat));
    let scheme = table.choice_or_first(
        "scheme",
        "scheme of heat conduction",
        &[
            ("explicit", ConductionScheme::Explicit),
            ("trapezoidal", ConductionScheme::Trapezoidal),
            ("backward-euler", ConductionScheme::BackwardEuler),
            ("steady", ConductionScheme::Steady),
        ],
    );
    let step = table.maybe("step", |item| item.positive(Quantity::Time));
    let interface = table.choice_or_first(
        "interface",
        "mean conductivity",
        &[
            ("harmonic", ConductivityMean::Harmonic),
            ("arithmetic", ConductivityMean::Arithmetic),
        ],
    );
    let surface_correction = table.or("surface_correction", true, |item| item.boolean());
    let broken_conductance = table.or("broken_conductance", 0.0, |item| {
        item.within(Quantity::Number, "a number from 0 to 1", |share| {
            (0.0..=1.0).contains(&share)
        })
    });
    let dissipation = match scheme {
        Some(ConductionScheme::Steady) => {
            table.forbid("dissipation", STORES_NO_HEAT);
            Some(0.0)
        }
        _ => table.or("dissipation", 0.0, |item| {
            item.within(Quantity::Number, "a number from 0 to 1", |share| {
                (0.0..=1.0).contains(&share)
            })
        }),
    };
    let conditions: Vec<Option<ThermalCondition>> = table
        .tables("condition")
        .into_iter()
        .map(|table| condition(table, dimension, (sets, has_reference)))
        .collect();
    Some(Conduction {
        conductivity: k?,
        specific_heat: specific_heat?,
        scheme: scheme?,
        step: step?,
        interface: interface?,
        surface_correction: surface_correction?,
        broken_conductance: broken_conductance?,
        dissipation: dissipation?,
        conditions: conditions.into_iter().collect::<Option<_>>()?,
    })
}

fn condition(
    table: Table<'_>,
    dimension: Option<usize>,
    (sets, has_reference): (&SetNames, bool),
) -> Option<ThermalCondition> {
    let variables = Variables {
        dimension,
        time: true,
    };
    let set = table.required("set").and_then(|item| sets.reference(&item));
    let ambient = |table: &Table<'_>| {
        let item = table.required("ambient")?;
        component(&item, Quantity::Temperature, variables)
    };
    let amplitude = table
        .exactly_one(THERMAL_CONDITIONS)
        .and_then(|(key, item)| {
            Some(match key {
                "temperature" => ThermalAmplitude::Temperature(component(
                    &item,
                    Quantity::Temperature,
                    variables,
                )?),
                "flux" => ThermalAmplitude::Flux(component(&item, Quantity::HeatFlux, variables)?),
                "source" => {
                    ThermalAmplitude::Source(component(&item, Quantity::HeatSource, variables)?)
                }
                "convection" => {
                    let table = item.table()?;
                    let coefficient = table.required("coefficient").and_then(|item| {
                        item.within(Quantity::HeatTransfer, "at least 0 W/m2/K", |h| h >= 0.0)
                    });
                    let ambient = ambient(&table);
                    table.finish();
                    ThermalAmplitude::Convection {
                        coefficient: coefficient?,
                        ambient: ambient?,
                    }
                }
                _ => {
                    let table = item.table()?;
                    let emissivity = table.required("emissivity").and_then(|item| {
                        item.within(Quantity::Number, "a number from 0 to 1", |e| {
                            (0.0..=1.0).contains(&e)
                        })
                    });
                    let ambient = ambient(&table);
                    table.finish();
                    ThermalAmplitude::Radiation {
                        emissivity: emissivity?,
                        ambient: ambient?,
                    }
                }
            })
        });
    let on_area = ["flux", "convection", "radiation"]
        .iter()
        .any(|key| table.has(key));
    let area = match on_area {
        true => table.maybe("area", |item| item.positive(Quantity::Area)),
        false => {
            table.forbid("area", "it requires `flux`, `convection` or `radiation`");
            Some(None)
        }
    };
    let of_temperature = ["temperature", "convection", "radiation"]
        .iter()
        .any(|key| table.has(key));
    let function = match of_temperature && !has_reference {
        false => course::function(&table),
        true => {
            table.forbid("function", "the function multiplies the difference to the reference temperature; set `reference` in [thermal]");
            Some(TimeHistory::default())
        }
    };
    table.finish();
    Some(ThermalCondition {
        set: set?,
        amplitude: amplitude?,
        area: area?,
        function: function?,
    })
}

fn of_material(table: Table<'_>, names: &[String], conducts: bool) -> Option<MaterialThermal> {
    let name = table.required("name").and_then(|item| {
        let name = item.text()?;
        if names.contains(&name) {
            return Some(name);
        }
        item.unknown_word("material", &name, names.iter().map(String::as_str));
        None
    });
    let (own_expansion, own_conductivity, own_heat) = match conducts {
        true => (
            table.maybe("expansion", |item| expansion(&item)),
            table.maybe("conductivity", |item| conductivity(&item)),
            table.maybe("specific_heat", |item| {
                item.positive(Quantity::SpecificHeat)
            }),
        ),
        false => {
            for key in CONDUCTION {
                table.forbid(
                    key,
                    "it requires `conductivity` and `specific_heat` in [thermal]",
                );
            }
            let expansion = table
                .required("expansion")
                .and_then(|item| expansion(&item));
            (expansion.map(Some), Some(None), Some(None))
        }
    };
    table.finish();
    Some(MaterialThermal {
        name: name?,
        expansion: own_expansion?,
        conductivity: own_conductivity?,
        specific_heat: own_heat?,
    })
}
