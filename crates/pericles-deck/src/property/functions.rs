//! Properties of a material that are functions.

use serde::{Deserialize, Serialize};

use super::{PropertyFunction, PropertyScope, function};
use crate::quantity::Quantity;
use crate::range::POSITIVE;
use crate::reader::{Item, Table};

/// A property that may be a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MaterialProperty {
    /// Mass density.
    Density,
    /// Young's modulus; the other moduli change in proportion.
    YoungsModulus,
    /// Critical stretch.
    CriticalStretch,
    /// Fracture energy.
    FractureEnergy,
    /// Largest principal stress that a bond bears.
    Strength,
    /// Yield stress.
    YieldStress,
}

impl MaterialProperty {
    const ALL: [Self; 6] = [
        Self::Density,
        Self::YoungsModulus,
        Self::CriticalStretch,
        Self::FractureEnergy,
        Self::Strength,
        Self::YieldStress,
    ];

    /// Returns the key.
    pub fn key(self) -> &'static str {
        match self {
            Self::Density => "density",
            Self::YoungsModulus => "youngs_modulus",
            Self::CriticalStretch => "critical_stretch",
            Self::FractureEnergy => "fracture_energy",
            Self::Strength => "strength",
            Self::YieldStress => "yield_stress",
        }
    }

    /// Returns the SI unit; empty for dimensionless numbers.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Density => "kg/m³",
            Self::FractureEnergy => "J/m²",
            Self::CriticalStretch => "",
            Self::YoungsModulus | Self::Strength | Self::YieldStress => "Pa",
        }
    }

    fn quantity(self) -> Quantity {
        match self {
            Self::Density => Quantity::Density,
            Self::CriticalStretch => Quantity::Number,
            Self::FractureEnergy => Quantity::SurfaceEnergy,
            Self::YoungsModulus | Self::YieldStress => Quantity::Modulus,
            Self::Strength => Quantity::Traction,
        }
    }

    /// Returns whether the value may depend on the temperature, which changes during a run.
    fn depends_on_temperature(self) -> bool {
        self == Self::YieldStress
    }
}

/// A property of a material that is a function. The function multiplies the number of the property, which is 1 in
/// models from decks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialFunction {
    /// The property.
    pub property: MaterialProperty,
    /// The function.
    pub function: PropertyFunction,
}

/// The properties of a material that are functions, each at most once.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct MaterialFunctions(pub Vec<MaterialFunction>);

impl MaterialFunctions {
    /// Returns whether all properties are constant.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the function of a property.
    pub fn of(&self, property: MaterialProperty) -> Option<&PropertyFunction> {
        let found = self.0.iter().find(|own| own.property == property);
        found.map(|own| &own.function)
    }

    /// Reads the functions of the table of a material, after its keys have been read.
    fn read(table: &Table<'_>, dimension: Option<usize>) -> Option<Self> {
        let read: Vec<Option<MaterialFunction>> = MaterialProperty::ALL
            .into_iter()
            .filter_map(|property| Some((property, table.read_before(property.key())?)))
            .filter(|(_, item)| item.is_table())
            .map(|(property, item)| {
                let scope = PropertyScope {
                    dimension,
                    temperature: property.depends_on_temperature(),
                };
                let function = function(&item, property.quantity(), POSITIVE, scope)?;
                Some(MaterialFunction { property, function })
            })
            .collect();
        read.into_iter().collect::<Option<_>>().map(Self)
    }
}

/// Reads the functions of the table of a material; the scope is the dimension of the body. The keys have been read.
pub(crate) fn functions(table: &Table<'_>, dimension: Option<usize>) -> Option<MaterialFunctions> {
    MaterialFunctions::read(table, dimension)
}

/// Returns the reader of the number of a property of a material: a positive number, or 1 for a function, which
/// [`functions`] reads.
pub(crate) fn number_of<S>(property: MaterialProperty) -> impl Fn(&Item<'_>, S) -> Option<f64> {
    move |item, _| match item.is_table() {
        true => Some(1.0),
        false => item.positive(property.quantity()),
    }
}
