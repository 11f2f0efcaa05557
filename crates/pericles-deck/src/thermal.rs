//! `[thermal]`: thermal expansion by a prescribed or computed temperature, and heat conduction.

use std::path::PathBuf;

use pericles_deck_derive::{DeckKeys, DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

use crate::component::Component;
use crate::course::TimeHistory;
use crate::declaration::DeckKeys;
use crate::property::Property;
use crate::range::{Range, at_least};
use crate::reader::Table;
use crate::scope::{Scope, material_name, set_name};

/// Thermal expansion and heat conduction. The stress-free strain is α (T − T₀). Without `conductivity` the temperature T
/// is prescribed; with a time function g(t) it is T₀ + g(t) (T − T₀). With `conductivity` and `specific_heat` the
/// temperature is computed from ρ c ∂T/∂t = ∫ κ (T′ − T) dx′ + q, where κ conducts the heat of Fourier's law with
/// conductivity k.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = ThermalScope<'s>, exactly_one("temperature", "file"))]
pub struct Thermal {
    /// Coefficient of thermal expansion α of all materials without their own (steel: 12e-6), a number or an expression of
    /// position. With heat conduction it is optional. Bodies with scheme = "thermal" in `[time]` do not move and do not expand.
    ///
    /// In 1/K; none for a body that conducts heat only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(quantity = Expansion, scope = scope.deck.of_place(), required_if(!scope.conducts))]
    pub expansion: Option<Property>,
    /// Temperature T, a number or an expression of position and time; with heat conduction the initial temperature, an
    /// expression of position. A temperature that changes with time does work, which the energy balance counts as
    /// external work.
    ///
    /// In K; none if a file gives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(quantity = Temperature, scope = scope.deck.variables(!scope.conducts))]
    pub temperature: Option<Component>,
    /// Text file with one line per point of the body: its temperature T (K). Points are in the order of the field files
    /// (listed points: of their own file). Replaces `temperature`.
    ///
    /// A relative path starts at the deck's folder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Time function that multiplies the difference to the reference temperature.
    #[serde(default, skip_serializing_if = "TimeHistory::is_constant")]
    #[deck(or_empty, scope = false, default, forbid_if(scope.conducts, INITIAL))]
    pub function: TimeHistory,
    /// Reference temperature T₀ without thermal strain. Required with `expansion`, and for time functions of
    /// temperatures.
    ///
    /// In K.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(quantity = Temperature, required_if(expansion != Some(&None)))]
    pub reference: Option<f64>,
    /// Heat conduction; none if the temperature is prescribed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(flatten, with = conduction, scope = scope.with_reference(reference), check = Conduction::check_keys)]
    pub conduction: Option<Conduction>,
    /// Thermal constants by material. Missing constants are taken from `[thermal]`.
    #[serde(default, rename = "material")]
    #[deck(key = "material")]
    pub materials: Vec<MaterialThermal>,
}

/// Thermal constants by material. Any number of tables. Missing constants are taken from `[thermal]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = ThermalScope<'s>)]
pub struct MaterialThermal {
    /// Name of the material: its table in `[materials]`, or the name of the body's material.
    #[deck(with = material_name, scope = scope.deck)]
    pub name: String,
    /// Coefficient of thermal expansion α of this material, a number or an expression of position.
    ///
    /// In 1/K.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(quantity = Expansion, scope = scope.deck.of_place(), required_if(!scope.conducts))]
    pub expansion: Option<Property>,
    /// Thermal conductivity k of this material, a number or an expression of position.
    ///
    /// In W/(m K).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(quantity = Conductivity, range = CONDUCTIVITIES, scope = scope.deck.of_place(), forbid_if(!scope.conducts, OF_BODY))]
    pub conductivity: Option<Property>,
    /// Specific heat capacity c of this material, a number or an expression of position.
    ///
    /// In J/(kg K).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(quantity = SpecificHeat, range = POSITIVE, scope = scope.deck.of_place(), forbid_if(!scope.conducts, OF_BODY))]
    pub specific_heat: Option<Property>,
}

/// Heat conduction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = ThermalScope<'s>)]
pub struct Conduction {
    /// Thermal conductivity k of all materials without their own (steel: 45 W/m/K), a number or an expression of position.
    /// A linear temperature field in the interior of a lattice conducts exactly k.
    ///
    /// In W/(m K).
    #[deck(quantity = Conductivity, range = CONDUCTIVITIES, scope = scope.deck.of_place())]
    pub conductivity: Property,
    /// Specific heat capacity c of all materials without their own (steel: 460 J/kg/K), a number or an expression of
    /// position. The heat capacity per volume is ρ c.
    ///
    /// In J/(kg K).
    #[deck(quantity = SpecificHeat, range = POSITIVE, scope = scope.deck.of_place())]
    pub specific_heat: Property,
    /// Time integration of the temperature. `explicit`: forward Euler method in sub-steps below its limit of stability.
    /// `trapezoidal`: trapezoidal rule, second order. `backward-euler`: backward Euler method, first order, damps all
    /// oscillations. `steady`: steady state of the conditions at each time.
    #[serde(default)]
    #[deck(default)]
    pub scheme: ConductionScheme,
    /// Length of the thermal steps, shorter or longer than those of the body. Between their ends the temperature is
    /// linear in time. Default: the temperature advances with the steps of the body.
    ///
    /// In s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(quantity = Time, range = POSITIVE)]
    pub step: Option<f64>,
    /// Conductivity of bonds between materials. `harmonic`: 2 k₁ k₂/(k₁ + k₂), conductors in series. `arithmetic`:
    /// (k₁ + k₂)/2.
    #[serde(default)]
    #[deck(default)]
    pub interface: ConductivityMean,
    /// Whether bonds between points with incomplete families conduct more, so that a unit temperature gradient along each
    /// axis of the surface conducts the same as in the interior. Default: true.
    #[serde(default = "Conduction::default_surface_correction")]
    #[deck(default = true)]
    pub surface_correction: bool,
    /// Part of its conductance that a broken bond keeps: 0 for insulating cracks, 1 for cracks without effect on the
    /// heat.
    #[serde(default)]
    #[deck(range = FRACTION, default = 0.0)]
    pub broken_conductance: f64,
    /// Share of the energy dissipated by fracture, softening, plastic flow and viscosity that becomes heat at the points
    /// that dissipate it (for plastic flow the Taylor–Quinney coefficient, 0.9 for many metals). Default: 0, no heat. Not
    /// counted: damping, contact, absorbing boundaries, and the energy that static schemes release after bonds broke. Not
    /// for scheme = "steady".
    #[serde(default)]
    #[deck(
        range = FRACTION,
        default = 0.0,
        forbid_if(is_steady(scheme), STORES_NO_HEAT),
        allow_if(!is_steady(scheme) || dissipation == Some(&0.0), STORES_NO_HEAT)
    )]
    pub dissipation: f64,
    /// Thermal conditions on sets. Surfaces without a condition are insulated.
    #[serde(default, rename = "condition")]
    #[deck(key = "condition")]
    pub conditions: Vec<ThermalCondition>,
}

/// Time integration of heat conduction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "scheme of heat conduction")]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "mean conductivity")]
pub enum ConductivityMean {
    /// 2 k₁ k₂/(k₁ + k₂).
    #[default]
    Harmonic,
    /// (k₁ + k₂)/2.
    Arithmetic,
}

/// Thermal conditions on sets. Any number of tables. Surfaces without a condition are insulated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = ThermalScope<'s>)]
pub struct ThermalCondition {
    /// Set of points to which the condition applies. Flux, convection and radiation act on the volume of the set; use a
    /// layer that is one cell deep.
    #[deck(with = set_name, scope = scope.deck)]
    pub set: String,
    /// The condition.
    #[deck(flatten)]
    pub amplitude: ThermalAmplitude,
    /// Area for flux, convection and radiation. Default: the area of the face of the layer, or of the face set of a mesh.
    ///
    /// In m².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(
        quantity = Area,
        range = POSITIVE,
        forbid_if(!acts_on_area(amplitude), "it requires `flux`, `convection` or `radiation`")
    )]
    pub area: Option<f64>,
    /// Time function: multiplies flux and source, and the difference of temperatures to the reference temperature.
    #[serde(default, skip_serializing_if = "TimeHistory::is_constant")]
    #[deck(
        or_empty,
        scope = false,
        default,
        forbid_if(is_of_temperature(amplitude) && !scope.has_reference, NO_REFERENCE)
    )]
    pub function: TimeHistory,
}

/// A thermal condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[deck(exclusive, scope = ThermalScope<'s>)]
pub enum ThermalAmplitude {
    /// Prescribed temperature, a number or an expression of position and time.
    ///
    /// In K.
    Temperature(#[deck(quantity = Temperature, scope = scope.deck.variables(true))] Component),
    /// Heat flux into the body per area, a number or an expression of position and time.
    ///
    /// In W/m².
    Flux(#[deck(quantity = HeatFlux, scope = scope.deck.variables(true))] Component),
    /// Heat source per volume, a number or an expression of position and time.
    ///
    /// In W/m³.
    Source(#[deck(quantity = HeatSource, scope = scope.deck.variables(true))] Component),
    /// Convection: the heat flux into the body is h (T∞ − T).
    #[deck(table)]
    Convection {
        /// Heat transfer coefficient h.
        ///
        /// In W/(m² K).
        #[deck(quantity = HeatTransfer, range = at_least(0.0).described("at least 0 W/m2/K"))]
        coefficient: f64,
        /// Ambient temperature T∞, a number or an expression of position and time.
        ///
        /// In K.
        #[deck(quantity = Temperature, scope = scope.deck.variables(true))]
        ambient: Component,
    },
    /// Radiation: the heat flux into the body is ε σ (T∞⁴ − T⁴) with the Stefan–Boltzmann constant σ. Temperatures are
    /// absolute.
    #[deck(table)]
    Radiation {
        /// Emissivity ε, from 0 to 1.
        #[deck(range = FRACTION)]
        emissivity: f64,
        /// Ambient temperature T∞, a number or an expression of position and time.
        ///
        /// In K.
        #[deck(quantity = Temperature, scope = scope.deck.variables(true))]
        ambient: Component,
    },
}

/// Scope of thermal keys.
#[derive(Clone, Copy)]
pub(crate) struct ThermalScope<'s> {
    deck: Scope<'s>,
    /// Whether the body conducts heat; otherwise its temperature is prescribed.
    conducts: bool,
    /// Whether there is a reference temperature, or one that is invalid.
    has_reference: bool,
}

impl<'s> ThermalScope<'s> {
    /// Returns the scope of a table.
    pub(crate) fn of(table: &Table<'_>, deck: Scope<'s>) -> Self {
        let conducts = CONDUCTION.iter().any(|key| table.has(key));
        Self::new(conducts, deck)
    }

    pub(crate) fn new(conducts: bool, deck: Scope<'s>) -> Self {
        Self {
            deck,
            conducts,
            has_reference: false,
        }
    }

    fn with_reference(self, reference: Option<&Option<f64>>) -> Self {
        Self {
            has_reference: reference != Some(&None),
            ..self
        }
    }
}

/// Range of conductivities.
const CONDUCTIVITIES: Range = at_least(0.0).described("at least 0 W/m/K (steel: 45)");

/// Keys that heat conduction needs together.
const CONDUCTION: &[&str] = &["conductivity", "specific_heat"];

/// Why steady states have no heat from dissipated energy.
pub(crate) const STORES_NO_HEAT: &str = "with scheme = \"steady\" the temperature stores no heat; use scheme = \"explicit\", \"trapezoidal\" or \"backward-euler\"";

/// Why a temperature that is computed has no time function.
const INITIAL: &str = "with heat conduction `temperature` is the initial one; set the function of a [[thermal.condition]]";

/// Why a body without heat conduction has no constants of it.
const NEEDS: &str = "it requires `conductivity` and `specific_heat`";
const OF_BODY: &str = "it requires `conductivity` and `specific_heat` in [thermal]";

/// Why temperatures without a reference have no time function.
const NO_REFERENCE: &str = "the function multiplies the difference to the reference temperature; set `reference` in [thermal]";

fn is_steady(scheme: Option<&ConductionScheme>) -> bool {
    scheme == Some(&ConductionScheme::Steady)
}

fn acts_on_area(amplitude: Option<&ThermalAmplitude>) -> bool {
    use ThermalAmplitude::{Convection, Flux, Radiation};
    matches!(
        amplitude,
        None | Some(Flux(_) | Convection { .. } | Radiation { .. })
    )
}

fn is_of_temperature(amplitude: Option<&ThermalAmplitude>) -> bool {
    use ThermalAmplitude::{Convection, Radiation, Temperature};
    matches!(
        amplitude,
        Some(Temperature(_) | Convection { .. } | Radiation { .. })
    )
}

/// Reads the keys of heat conduction, if the table has them.
fn conduction(table: &Table<'_>, scope: ThermalScope<'_>) -> Option<Option<Conduction>> {
    if scope.conducts {
        return Conduction::read_keys(table, scope).map(Some);
    }
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
