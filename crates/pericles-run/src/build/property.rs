//! Values of the properties of materials that are functions.
//!
//! A material keeps one number for each of its constants: that of a property given as a function is the mean over the points
//! of the material, and every point has a factor. Constants that follow from the numbers, such as bond constants, wave speeds
//! and warnings, are those of the mean; forces, masses and limits of bonds have the factors of their points.

use pericles::units::{quantity, significant};
use pericles_deck::{MaterialProperty, PropertyFunction};

/// Smallest, mean and largest value of a property that is a function, over the points of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct PropertyRange {
    /// Name of the material; `None` if it is that of the whole body.
    pub material: Option<String>,
    /// The key.
    pub key: &'static str,
    /// The SI unit; empty for dimensionless numbers.
    pub unit: &'static str,
    /// Smallest value.
    pub least: f64,
    /// Mean value over the points.
    pub mean: f64,
    /// Largest value.
    pub most: f64,
    /// Whether it depends on the temperature; the values are those at the start.
    pub is_heated: bool,
}

/// The properties of the materials of a body that are functions.
#[derive(Debug, Default)]
pub(super) struct Properties {
    all: Vec<Evaluated>,
}

/// No functions.
pub(super) static CONSTANT: Properties = Properties { all: Vec::new() };

/// A property at the points of its material.
#[derive(Debug)]
pub(super) struct Evaluated {
    pub(super) property: MaterialProperty,
    pub(super) function: PropertyFunction,
    /// The number of the material in the model, which the function multiplies.
    pub(super) scale: f64,
    /// Values relative to the mean at the points of the material; 1 at other points.
    pub(super) factors: Vec<f64>,
    /// Whether each point has the material.
    pub(super) has_material: Vec<bool>,
    /// Whether the critical stretch of the material follows from its fracture energy and its modulus.
    pub(super) breaks_by_energy: bool,
    pub(super) range: PropertyRange,
}

impl Properties {
    /// Creates the properties of a body.
    pub(super) fn new(all: Vec<Evaluated>) -> Self {
        Self { all }
    }

    /// Returns the ranges of all properties.
    pub(super) fn ranges(&self) -> Vec<PropertyRange> {
        self.all.iter().map(|own| own.range.clone()).collect()
    }

    /// Returns the values of a property of all points relative to those of their materials; `None` if no material has a
    /// function of it.
    pub(super) fn factors(&self, property: MaterialProperty) -> Option<Vec<f64>> {
        let mut found = self.all.iter().filter(|own| own.property == property);
        let mut factors = found.next()?.factors.clone();
        for own in found {
            multiply(&mut factors, &own.factors);
        }
        Some(factors)
    }

    /// Returns all properties.
    pub(super) fn all(&self) -> &[Evaluated] {
        &self.all
    }

    /// Returns whether any material has a function of a property.
    pub(super) fn vary(&self, property: MaterialProperty) -> bool {
        self.all.iter().any(|own| own.property == property)
    }
}

pub(super) fn multiply(values: &mut [f64], factors: &[f64]) {
    for (value, factor) in values.iter_mut().zip(factors) {
        *value *= factor;
    }
}

/// Formats a value of a property, with a prefix of its unit where that is usual.
pub(crate) fn shown(value: f64, unit: &str) -> String {
    match unit {
        "Pa" | "J/m²" => quantity(value, unit),
        _ => format!("{} {unit}", significant(value, 4))
            .trim_end()
            .to_owned(),
    }
}
