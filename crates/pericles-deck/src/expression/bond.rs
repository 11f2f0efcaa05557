//! Expressions of the stress and strain at a bond.

use std::fmt;
use std::sync::Arc;

use pericles::material::BondState;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Compiled, Malformed, grammar};
use exmex::Express;

/// A quantity at a bond.
#[derive(Debug, Clone, Copy)]
enum Variable {
    Stress(usize, usize),
    Strain(usize, usize),
    PrincipalStress(usize),
    PrincipalStrain(usize),
    EquivalentStress,
    NormalStress,
    ShearStress,
    Stretch,
    Place(usize),
    Time,
    Temperature,
}

/// Names of variables and their least dimension.
const VARIABLES: [(&str, usize, Variable); 27] = [
    ("stress_xx", 1, Variable::Stress(0, 0)),
    ("stress_yy", 2, Variable::Stress(1, 1)),
    ("stress_zz", 3, Variable::Stress(2, 2)),
    ("stress_xy", 2, Variable::Stress(0, 1)),
    ("stress_yz", 3, Variable::Stress(1, 2)),
    ("stress_xz", 3, Variable::Stress(0, 2)),
    ("strain_xx", 1, Variable::Strain(0, 0)),
    ("strain_yy", 2, Variable::Strain(1, 1)),
    ("strain_zz", 3, Variable::Strain(2, 2)),
    ("strain_xy", 2, Variable::Strain(0, 1)),
    ("strain_yz", 3, Variable::Strain(1, 2)),
    ("strain_xz", 3, Variable::Strain(0, 2)),
    ("stress_1", 1, Variable::PrincipalStress(0)),
    ("stress_2", 2, Variable::PrincipalStress(1)),
    ("stress_3", 3, Variable::PrincipalStress(2)),
    ("strain_1", 1, Variable::PrincipalStrain(0)),
    ("strain_2", 2, Variable::PrincipalStrain(1)),
    ("strain_3", 3, Variable::PrincipalStrain(2)),
    ("equivalent_stress", 1, Variable::EquivalentStress),
    ("normal_stress", 1, Variable::NormalStress),
    ("shear_stress", 1, Variable::ShearStress),
    ("stretch", 1, Variable::Stretch),
    ("x", 1, Variable::Place(0)),
    ("y", 2, Variable::Place(1)),
    ("z", 3, Variable::Place(2)),
    ("t", 1, Variable::Time),
    ("temperature", 1, Variable::Temperature),
];

impl Variable {
    fn value(self, bond: &BondState) -> f64 {
        match self {
            Self::Stress(a, b) => 0.5 * (bond.stress[a][b] + bond.stress[b][a]),
            Self::Strain(a, b) => 0.5 * (bond.strain[a][b] + bond.strain[b][a]),
            Self::PrincipalStress(k) => bond.principal_stresses()[k],
            Self::PrincipalStrain(k) => bond.principal_strains()[k],
            Self::EquivalentStress => bond.equivalent_stress(),
            Self::NormalStress => bond.normal_stress(),
            Self::ShearStress => bond.shear_stress(),
            Self::Stretch => bond.stretch,
            Self::Place(c) => bond.at.place[c],
            Self::Time => bond.at.t,
            Self::Temperature => bond.at.temperature,
        }
    }

    /// Returns whether it is the position, time or temperature of the bond.
    fn is_of_place(self) -> bool {
        matches!(self, Self::Place(_) | Self::Time | Self::Temperature)
    }
}

/// A compiled function of stress (Pa) and strain at a bond.
#[derive(Clone)]
pub struct BondExpression {
    text: Arc<str>,
    compiled: Arc<Compiled>,
    /// Its variables in the order of their values.
    variables: Arc<[Variable]>,
}

impl BondExpression {
    /// Parses an expression for a body of a dimension.
    pub(crate) fn parse(text: &str, dimension: usize) -> Result<Self, Malformed> {
        let known = VARIABLES.iter().filter(|(_, least, _)| *least <= dimension);
        let names: Vec<&str> = known.map(|(name, ..)| *name).collect();
        let grouped = grammar::group_powers(text, &names)?;
        let compiled = Compiled::parse(&grouped).map_err(|error| Malformed {
            reason: format!("it is not a valid expression: {error}"),
        })?;
        let variable = |name: &String| {
            let found = VARIABLES.iter().find(|(known, ..)| known == name);
            found.map(|(.., variable)| *variable)
        };
        let variables: Vec<Variable> = compiled.var_names().iter().filter_map(variable).collect();
        if variables.iter().all(|variable| variable.is_of_place()) {
            return Err(Malformed {
                reason: format!(
                    "it depends on no stress or strain; variables: {}",
                    names.join(", ")
                ),
            });
        }
        Ok(Self {
            text: text.into(),
            compiled: compiled.into(),
            variables: variables.into(),
        })
    }

    /// Returns whether it is a function of the stress of a point, whatever strains and directions of bonds are.
    pub(crate) fn is_of_stress(&self) -> bool {
        self.variables.iter().all(|variable| {
            matches!(
                variable,
                Variable::Stress(..) | Variable::PrincipalStress(_) | Variable::EquivalentStress
            )
        })
    }

    /// Returns whether it also depends on position, time or temperature.
    pub fn varies(&self) -> bool {
        self.variables.iter().any(|variable| variable.is_of_place())
    }

    /// Returns whether it depends on the temperature.
    pub fn depends_on_temperature(&self) -> bool {
        let is_temperature = |variable: &Variable| matches!(variable, Variable::Temperature);
        self.variables.iter().any(is_temperature)
    }

    /// Returns the text of the expression.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the value at a bond; NaN where it is undefined.
    pub fn value(&self, bond: &BondState) -> f64 {
        let mut values = [0.0; VARIABLES.len()];
        for (value, variable) in values.iter_mut().zip(&*self.variables) {
            *value = variable.value(bond);
        }
        // The number of values is right, which is the only possible error.
        let values = &values[..self.variables.len()];
        self.compiled.eval(values).unwrap_or(f64::NAN)
    }
}

/// Serialises as its text.
impl Serialize for BondExpression {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text)
    }
}

impl<'de> Deserialize<'de> for BondExpression {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::parse(&text, 3)
            .map_err(|malformed| D::Error::custom(format!("`{text}`: {}", malformed.reason)))
    }
}

impl fmt::Debug for BondExpression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "BondExpression({:?})", self.text)
    }
}

/// Compares the texts.
impl PartialEq for BondExpression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::material::BondPlace;

    /// Row and column of the tensor components, in the order of their names.
    const PLACES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];

    /// Every name is the quantity that it says, alone and within sums, for a stress without symmetry about the bond.
    #[test]
    fn variables_are_the_quantities_of_their_names() {
        let stress = [[3.0, 1.0, -0.5], [1.0, -2.0, 0.7], [-0.5, 0.7, 0.4]];
        let strain = stress.map(|row| row.map(|s: f64| 0.01 * s + 0.001));
        let bond = BondState {
            dimension: 3,
            stress,
            strain,
            direction: [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0],
            stretch: 0.02,
            at: BondPlace {
                place: [1.0, 2.0, 3.0],
                t: 4.0,
                temperature: 5.0,
            },
        };
        let value = |text: &str| BondExpression::parse(text, 3).unwrap().value(&bond);
        for (k, (a, b)) in PLACES.into_iter().enumerate() {
            let axes = ["xx", "yy", "zz", "xy", "yz", "xz"][k];
            assert_eq!(value(&format!("stress_{axes}")), stress[a][b]);
            assert_eq!(value(&format!("strain_{axes}")), strain[a][b]);
        }
        let mises =
            "sqrt(((stress_1-stress_2)^2 + (stress_2-stress_3)^2 + (stress_3-stress_1)^2)/2)";
        assert!((value("equivalent_stress") - value(mises)).abs() < 1e-13);
        assert!((value("stress_1 + stress_2 + stress_3") - 1.4).abs() < 1e-14);
        let place = value("0*stretch + x + 10*y + 100*z + 1000*t + 10000*temperature");
        assert_eq!(place, 54_321.0);
        assert!(BondExpression::parse("x + t", 3).is_err());
        let trace = value("strain_xx + strain_yy + strain_zz");
        assert!((value("strain_1 + strain_2 + strain_3") - trace).abs() < 1e-16);
        assert_eq!(value("e*stretch"), std::f64::consts::E * 0.02);
        let traction = stress.map(|row| (2.0 * row[0] - row[1] + 2.0 * row[2]) / 3.0);
        let square: f64 = traction.iter().map(|x| x * x).sum();
        assert!((value("normal_stress^2 + shear_stress^2") - square).abs() < 1e-13);
        let mixed = "sqrt((normal_stress/2)^2 + (shear_stress/4)^2) + exp(strain_xx) - 1";
        let expected = (value("normal_stress") / 2.0).hypot(value("shear_stress") / 4.0);
        assert!((value(mixed) - expected - 0.031f64.exp_m1()).abs() < 1e-14);
    }

    #[test]
    fn expressions_have_the_components_of_the_body() {
        for (dimension, text, says) in [
            (2, "stress_zz / 1e6", "unknown name `stress_zz`"),
            (2, "stress_3 / 1e6", "unknown name `stress_3`"),
            (1, "stress_2", "unknown name `stress_2`"),
            (2, "z*stretch", "unknown name `z`"),
            (2, "x + 1", "depends on no stress or strain"),
            (2, "2 + 1", "depends on no stress or strain"),
            (2, "stress_xx/", "ends"),
        ] {
            let malformed = BondExpression::parse(text, dimension).unwrap_err();
            assert!(
                malformed.reason.contains(says),
                "{text}: {}",
                malformed.reason
            );
        }
    }
}
