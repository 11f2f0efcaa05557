//! Physical quantities of numbers in decks.

use crate::dimension::Dimension;
use crate::units;

/// A physical quantity with its SI unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    Number,
    Length,
    Area,
    Time,
    Density,
    SurfaceDensity,
    Modulus,
    Traction,
    SurfaceEnergy,
    EnergyDensity,
    Velocity,
    ForceDensity,
    Temperature,
    Expansion,
    Conductivity,
    SpecificHeat,
    HeatFlux,
    HeatSource,
    HeatTransfer,
    Rate,
    Stiffness,
    Mass,
    Inertia,
}

impl Quantity {
    pub(crate) fn dimension(self) -> Dimension {
        match self {
            Self::Number => Dimension::NONE,
            Self::Length => Dimension::new(0, 1, 0),
            Self::Area => Dimension::new(0, 2, 0),
            Self::Time => Dimension::new(0, 0, 1),
            Self::Density => Dimension::new(1, -3, 0),
            Self::SurfaceDensity => Dimension::new(1, -2, 0),
            Self::Modulus | Self::Traction | Self::EnergyDensity => Dimension::new(1, -1, -2),
            Self::SurfaceEnergy | Self::Stiffness => Dimension::new(1, 0, -2),
            Self::Mass => Dimension::new(1, 0, 0),
            Self::Inertia => Dimension::new(1, 2, 0),
            Self::Velocity => Dimension::new(0, 1, -1),
            Self::ForceDensity => Dimension::new(1, -2, -2),
            Self::Rate => Dimension::new(0, 0, -1),
            Self::Temperature => Dimension::kelvin(1),
            Self::Expansion => Dimension::kelvin(-1),
            Self::Conductivity => Dimension::new(1, 1, -3).per_kelvin(),
            Self::SpecificHeat => Dimension::new(0, 2, -2).per_kelvin(),
            Self::HeatFlux => Dimension::new(1, 0, -3),
            Self::HeatSource => Dimension::new(1, -1, -3),
            Self::HeatTransfer => Dimension::new(1, 0, -3).per_kelvin(),
        }
    }

    /// Returns the name with an article.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Number => "a number without a unit",
            Self::Length => "a length",
            Self::Area => "an area",
            Self::Time => "a time",
            Self::Density => "a mass density",
            Self::SurfaceDensity => "a mass per area",
            Self::Modulus => "a modulus",
            Self::Traction => "a force per area",
            Self::SurfaceEnergy => "an energy per area",
            Self::EnergyDensity => "an energy per volume",
            Self::Velocity => "a velocity",
            Self::ForceDensity => "a force per volume",
            Self::Rate => "a rate",
            Self::Stiffness => "a stiffness",
            Self::Mass => "a mass",
            Self::Inertia => "a moment of inertia",
            Self::Temperature => "a temperature",
            Self::Expansion => "a coefficient of thermal expansion",
            Self::Conductivity => "a thermal conductivity",
            Self::SpecificHeat => "a specific heat capacity",
            Self::HeatFlux => "a heat flux",
            Self::HeatSource => "a heat source per volume",
            Self::HeatTransfer => "a heat transfer coefficient",
        }
    }

    /// Returns the name without an article.
    pub(crate) fn noun(self) -> &'static str {
        match self {
            Self::Number => "number",
            _ => self
                .name()
                .trim_start_matches("an ")
                .trim_start_matches("a "),
        }
    }

    /// Returns an example as in decks.
    pub(crate) fn example(self) -> &'static str {
        match self {
            Self::Number => "25 %",
            Self::Length => "0.25 mm",
            Self::Area => "1 mm2",
            Self::Time => "25 ns",
            Self::Density => "2440 kg/m3",
            Self::SurfaceDensity => "2 kg/m2",
            Self::Modulus => "72 GPa",
            Self::Traction => "12 MPa",
            Self::SurfaceEnergy => "135 J/m2",
            Self::EnergyDensity => "5 J/m3",
            Self::Velocity => "20 m/s",
            Self::ForceDensity => "48 GN/m3",
            Self::Rate => "100 1/s",
            Self::Stiffness => "3 MN/m",
            Self::Mass => "1.5 kg",
            Self::Inertia => "0.2 kg·m2",
            Self::Temperature => "293.15 K",
            Self::Expansion => "12e-6 1/K",
            Self::Conductivity => "45 W/m/K",
            Self::SpecificHeat => "460 J/kg/K",
            Self::HeatFlux => "5 kW/m2",
            Self::HeatSource => "2 MW/m3",
            Self::HeatTransfer => "25 W/m2/K",
        }
    }

    /// Returns the unit of plain numbers; empty for dimensionless numbers.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Number => "",
            Self::Length => "m",
            Self::Area => "m2",
            Self::Time => "s",
            Self::Density => "kg/m3",
            Self::SurfaceDensity => "kg/m2",
            Self::Modulus | Self::Traction => "Pa",
            Self::SurfaceEnergy => "J/m2",
            Self::EnergyDensity => "J/m3",
            Self::Velocity => "m/s",
            Self::ForceDensity => "N/m3",
            Self::Rate => "1/s",
            Self::Stiffness => "N/m",
            Self::Mass => "kg",
            Self::Inertia => "kg·m2",
            Self::Temperature => "K",
            Self::Expansion => "1/K",
            Self::Conductivity => "W/m/K",
            Self::SpecificHeat => "J/kg/K",
            Self::HeatFlux => "W/m2",
            Self::HeatSource => "W/m3",
            Self::HeatTransfer => "W/m2/K",
        }
    }

    /// Returns what is allowed, with an example: `a length such as "0.25 mm" or a plain number in m`.
    pub(crate) fn expected(self) -> String {
        let example = self.example();
        match self {
            Self::Number => format!("a plain number such as 0.25 or \"{example}\""),
            _ => format!(
                "{} such as \"{example}\" or a plain number in {}",
                self.name(),
                self.unit()
            ),
        }
    }
}

/// Parses a time as in decks: `"2h"`, `"90 min"`, or a plain number of seconds. None for other texts.
///
/// ```
/// assert_eq!(pericles_deck::seconds("2h"), Some(7200.0));
/// assert_eq!(pericles_deck::seconds("2 m"), None);
/// ```
pub fn seconds(text: &str) -> Option<f64> {
    measured(text, Quantity::Time)
}

/// Parses a length as in decks: `"0.5 mm"`, or a plain number of metres. None for other texts.
pub fn metres(text: &str) -> Option<f64> {
    measured(text, Quantity::Length)
}

/// Parses a quantity as in decks and returns it in an SI unit: a text with a unit, or a plain number. None for other texts and
/// for units of other quantities.
///
/// ```
/// assert_eq!(pericles_deck::in_unit("2 mm", "m"), Some(0.002));
/// assert_eq!(pericles_deck::in_unit("2 mm", "m2"), None);
/// ```
pub fn in_unit(text: &str, unit: &str) -> Option<f64> {
    let wanted = units::parse(&format!("1 {unit}")).ok()?.dimension?;
    let measure = units::parse(text).ok()?;
    (measure.dimension.unwrap_or(wanted) == wanted).then_some(measure.value)
}

/// Returns whether a text is a number with a unit as in decks, or a plain number.
///
/// ```
/// assert!(pericles_deck::is_quantity("5 m/s"));
/// assert!(!pericles_deck::is_quantity("5 * t"));
/// ```
pub fn is_quantity(text: &str) -> bool {
    units::parse(text).is_ok()
}

/// Returns the SI unit of a unit as in decks and the factor that converts to it. None for other texts and for temperatures
/// with their own zero.
///
/// ```
/// assert_eq!(pericles_deck::si_unit("kN"), Some((1000.0, "N".into())));
/// assert_eq!(pericles_deck::si_unit("furlong"), None);
/// assert_eq!(pericles_deck::si_unit("°C"), None);
/// ```
pub fn si_unit(unit: &str) -> Option<(f64, String)> {
    let of = |number: &str| units::parse(&format!("{number} {unit}")).ok();
    let (zero, one) = (of("0")?, of("1")?);
    let dimension = one.dimension.filter(|_| zero.value == 0.0)?;
    Some((one.value, dimension.name()))
}

fn measured(text: &str, quantity: Quantity) -> Option<f64> {
    let measure = units::parse(text).ok()?;
    let dimension = measure.dimension.unwrap_or(quantity.dimension());
    (dimension == quantity.dimension()).then_some(measure.value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_have_the_right_dimension() {
        use Quantity::*;
        for quantity in [
            Length,
            Area,
            Time,
            Density,
            Modulus,
            Traction,
            SurfaceEnergy,
            EnergyDensity,
            Velocity,
            ForceDensity,
            Temperature,
            Expansion,
            Conductivity,
            SpecificHeat,
            HeatFlux,
            HeatSource,
            HeatTransfer,
            Rate,
            Stiffness,
            Mass,
            Inertia,
        ] {
            let unit = quantity.unit();
            for text in [quantity.example().to_owned(), format!("1 {unit}")] {
                assert_eq!(
                    units::parse(&text).unwrap().dimension,
                    Some(quantity.dimension()),
                    "{text}"
                );
            }
            assert_eq!(units::parse(&format!("1 {unit}")).unwrap().value, 1.0);
        }
    }
}
