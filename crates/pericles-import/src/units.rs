//! Units of the numbers of an input file.

use pericles_deck::in_unit;

use crate::table;

/// A consistent system of units.
#[derive(Debug, Clone, PartialEq)]
pub struct Units {
    /// The unit of length in m, of stress in Pa, of time in s.
    length: f64,
    stress: f64,
    time: f64,
    names: [String; 3],
}

/// A quantity of an input file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    Length,
    Time,
    Stress,
    Density,
    Velocity,
    /// Energy per area.
    FractureEnergy,
    /// Force per volume.
    ForceDensity,
}

impl Default for Units {
    /// SI units.
    fn default() -> Self {
        Self {
            length: 1.0,
            stress: 1.0,
            time: 1.0,
            names: ["m", "Pa", "s"].map(str::to_owned),
        }
    }
}

impl Units {
    /// Parses the units of length, stress and time, such as `mm,MPa,s`.
    ///
    /// # Errors
    /// A message that describes what is expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let names: Vec<&str> = text.split(',').map(str::trim).collect();
        let in_si = |name: &str, si| in_unit(&format!("1 {name}"), si).filter(|unit| *unit > 0.0);
        let units = match names[..] {
            [length, stress, time] => {
                let values = (in_si(length, "m"), in_si(stress, "Pa"), in_si(time, "s"));
                let names = [length, stress, time].map(str::to_owned);
                match values {
                    (Some(length), Some(stress), Some(time)) => Some(Self {
                        length,
                        stress,
                        time,
                        names,
                    }),
                    _ => None,
                }
            }
            _ => None,
        };
        units
            .ok_or_else(|| "expected the units of length, stress and time, such as mm,MPa,s".into())
    }

    /// Returns the factor that converts a quantity to SI units.
    pub(crate) fn factor(&self, quantity: Quantity) -> f64 {
        let (length, stress, time) = (self.length, self.stress, self.time);
        match quantity {
            Quantity::Length => length,
            Quantity::Time => time,
            Quantity::Stress => stress,
            Quantity::Density => stress * (time / length).powi(2),
            Quantity::Velocity => length / time,
            Quantity::FractureEnergy => stress * length,
            Quantity::ForceDensity => stress / length,
        }
    }

    /// Returns a quantity in SI units, as TOML.
    pub(crate) fn number(&self, value: f64, quantity: Quantity) -> String {
        table::number(self.value(value, quantity))
    }

    /// Returns a vector of a quantity in SI units, as TOML.
    pub(crate) fn numbers(&self, values: &[f64], quantity: Quantity) -> String {
        table::list(values.iter().map(|value| self.number(*value, quantity)))
    }

    /// Returns a quantity in SI units; converted ones without the rounding error of the last digits.
    pub(crate) fn value(&self, value: f64, quantity: Quantity) -> f64 {
        match self.factor(quantity) {
            1.0 => value,
            factor => table::rounded(value * factor, 12),
        }
    }

    /// Returns the name of the unit of length.
    pub(crate) fn length_name(&self) -> &str {
        &self.names[0]
    }

    /// Returns the names of the units of length, stress and time; `None` for SI units.
    pub(crate) fn names(&self) -> Option<String> {
        (*self != Self::default()).then(|| self.names.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derived_units_follow_from_length_stress_and_time() {
        let units = Units::parse("mm, MPa, s").unwrap();
        let expected = [
            // t/mm³, N/mm, N/mm³
            (Quantity::Density, 1e12),
            (Quantity::FractureEnergy, 1e3),
            (Quantity::ForceDensity, 1e9),
            (Quantity::Velocity, 1e-3),
        ];
        for (quantity, factor) in expected {
            assert!(
                (units.factor(quantity) / factor - 1.0).abs() < 1e-12,
                "{quantity:?}"
            );
        }
        assert_eq!(units.number(2.7e-9, Quantity::Density), "2700");
        assert_eq!(
            Units::default().number(0.1 + 0.2, Quantity::Length),
            "0.30000000000000004"
        );
        for wrong in [
            "",
            "mm",
            "mm,MPa",
            "mm,s,MPa",
            "mm,MPa,s,K",
            "mm,MPa,parsec",
        ] {
            assert!(Units::parse(wrong).is_err(), "{wrong}");
        }
    }
}
