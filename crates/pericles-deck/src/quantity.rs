//! What a number in a deck stands for.

use crate::units::Dimension;

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
            Self::SurfaceEnergy => Dimension::new(1, 0, -2),
            Self::Velocity => Dimension::new(0, 1, -1),
            Self::ForceDensity => Dimension::new(1, -2, -2),
        }
    }

    /// In words, with an article.
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
        }
    }

    /// What is allowed, with an example: `a length such as "0.25 mm" or a plain number in m`.
    pub(crate) fn expected(self) -> String {
        let (example, unit) = match self {
            Self::Number => return "a plain number such as 0.25 or \"25 %\"".into(),
            Self::Length => ("0.25 mm", "m"),
            Self::Area => ("1 mm2", "m2"),
            Self::Time => ("25 ns", "s"),
            Self::Density => ("2440 kg/m3", "kg/m3"),
            Self::SurfaceDensity => ("2 kg/m2", "kg/m2"),
            Self::Modulus => ("72 GPa", "Pa"),
            Self::Traction => ("12 MPa", "Pa"),
            Self::SurfaceEnergy => ("135 J/m2", "J/m2"),
            Self::EnergyDensity => ("5 J/m3", "J/m3"),
            Self::Velocity => ("20 m/s", "m/s"),
            Self::ForceDensity => ("48 GN/m3", "N/m3"),
        };
        format!(
            "{} such as \"{example}\" or a plain number in {unit}",
            self.name()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units;

    #[test]
    fn the_examples_have_the_dimension_they_explain() {
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
        ] {
            let expected = quantity.expected();
            let example = expected.split('"').nth(1).unwrap();
            let unit = expected.rsplit(' ').next().unwrap();
            for text in [example.to_owned(), format!("1 {unit}")] {
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
