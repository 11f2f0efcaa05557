//! Evaluation of properties of materials that are functions of position or temperature.

use std::sync::Arc;

use pericles::parallel::for_each_point;
use pericles::space::PointCloud;
use pericles::units::quantity;
use pericles::{PointScalar, Temperature};
use pericles_deck::{
    BuildError, Fault, KeyPath, MaterialFunctions, MaterialModel, MaterialProperty, Model,
    Property, Solid,
};

use super::assembler::Assembler;
use super::discretisation::Discretisation;
use super::property::{Evaluated, Properties, PropertyRange, shown};
use super::property_number::{has_stretch_of_energy, number_of, set_number};
use super::rejection::at_path;
use super::resources::Resources;

/// The functions of a material, its number and its model.
struct Own<'m> {
    number: usize,
    path: KeyPath,
    name: &'m str,
    functions: &'m MaterialFunctions,
    model: &'m MaterialModel,
}

impl<'m> Assembler<'m> {
    fn own_functions(&self, solid: &'m Solid) -> Vec<Own<'m>> {
        let own = &solid.material;
        let first = Own {
            number: 0,
            path: KeyPath::from("material"),
            name: own.name(),
            functions: &own.functions,
            model: &own.model,
        };
        let others = (1..).zip(&self.model.materials).map(|(number, other)| Own {
            number,
            path: KeyPath::from("materials").key(&other.name),
            name: &other.name,
            functions: &other.functions,
            model: &other.model,
        });
        std::iter::once(first).chain(others).collect()
    }

    /// Evaluates the functions of the materials at the points, and returns them with the model whose numbers are their means;
    /// `None` without functions. All processes must call it together.
    pub(super) fn properties(
        &self,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
    ) -> Result<Option<(Properties, Model)>, BuildError> {
        let Some(solid) = self.model.body.solid() else {
            return Ok(None);
        };
        let own = self.own_functions(solid);
        if own.iter().all(|own| own.functions.is_empty()) {
            return Ok(None);
        }
        let (cloud, sets) = (&*discretisation.cloud, &discretisation.sets);
        let (of_point, _) = self.materials_of_points(&solid.material, (cloud, sets))?;
        let of_point = of_point.unwrap_or_else(|| vec![0; cloud.len()]);
        let is_single = self.model.materials.is_empty();
        let mut model = self.model.clone();
        let mut all = Vec::new();
        for Own {
            number,
            path,
            name,
            functions,
            model: kept,
        } in own
        {
            let has_material: Vec<bool> = of_point
                .iter()
                .map(|&of| usize::from(of) == number)
                .collect();
            for one in &functions.0 {
                let path = path.key(one.property.key());
                let start = match one.function.depends_on_temperature() {
                    true => self.start_temperatures(&path, discretisation, resources)?,
                    false => Vec::new(),
                };
                let scale = number_of(kept, one.property);
                let Some(scale) = scale else {
                    return Err(at_path(&path, not_of_model(one.property)));
                };
                let value = |i: usize| {
                    let temperature = start.get(i).copied().unwrap_or(f64::NAN);
                    scale * one.function.value(cloud.point(i), temperature)
                };
                let values = Values {
                    path: &path,
                    text: one.function.text(),
                    unit: one.property.unit(),
                    allowed: POSITIVE,
                };
                let (values, [least, mean, most]) =
                    self.values_of((&has_material, &value), &values, discretisation)?;
                set_number(&mut model, number, one.property, mean);
                all.push(Evaluated {
                    property: one.property,
                    function: one.function.clone(),
                    scale,
                    factors: values
                        .iter()
                        .zip(&has_material)
                        .map(|(value, has)| if *has { value / mean } else { 1.0 })
                        .collect(),
                    has_material: has_material.clone(),
                    breaks_by_energy: has_stretch_of_energy(kept),
                    range: PropertyRange {
                        material: (!is_single).then(|| name.to_owned()),
                        key: one.property.key(),
                        unit: one.property.unit(),
                        least,
                        mean,
                        most,
                        is_heated: one.function.depends_on_temperature(),
                    },
                });
            }
        }
        Ok(Some((Properties::new(all), model)))
    }

    /// Returns the values of a property at the points that have it, and the smallest, mean and largest one. All processes
    /// must call it together.
    fn values_of(
        &self,
        (has, value): (&[bool], &(dyn Fn(usize) -> f64 + Sync)),
        what: &Values<'_>,
        discretisation: &Discretisation,
    ) -> Result<(Vec<f64>, [f64; 3]), BuildError> {
        let cloud = &*discretisation.cloud;
        let domain = cloud.domain();
        let values = for_each_point(cloud.len(), &|i| if has[i] { value(i) } else { 0.0 });
        let bad = (0..cloud.len()).find(|&i| has[i] && !(what.allowed.1)(values[i]));
        let checked = match bad {
            None => Ok(()),
            Some(i) => Err(what.fault(cloud, i, values[i])),
        };
        discretisation.agreed(checked)?;
        let count = domain.count(has.iter().filter(|has| **has).count() as u64);
        let of_points = |from: f64, with: fn(f64, f64) -> f64| {
            let own = values.iter().zip(has).filter(|(_, has)| **has);
            own.fold(from, |all, (value, _)| with(all, *value))
        };
        let most = domain.max(of_points(f64::NEG_INFINITY, f64::max));
        let least = -domain.max(-of_points(f64::INFINITY, f64::min));
        let mean = domain.sum(cloud.len(), |i| values[i]) / count.max(1) as f64;
        let mean = if least == most { least } else { mean };
        match count {
            // An assignment without points is rejected with the materials.
            0 => Ok((values, [1.0; 3])),
            _ => Ok((values, [least, mean, most])),
        }
    }

    /// Returns a property of every point from those of all materials, and its range if it is a function. All processes must
    /// call it together.
    pub(super) fn of_materials(
        &self,
        all: &[OfMaterial<'_>],
        (unit, allowed): (&'static str, Allowed),
        solid: &Solid,
        discretisation: &Discretisation,
    ) -> Result<PointScalar, BuildError> {
        let place = (&*discretisation.cloud, &discretisation.sets);
        // Assignments have been checked before.
        let (of_point, _) = self.materials_of_points(&solid.material, place)?;
        let number = |one: &OfMaterial<'_>| Some(one.factor * one.property.number()?);
        let numbers: Option<Vec<f64>> = all.iter().map(number).collect();
        let Some(numbers) = numbers else {
            let cloud = &*discretisation.cloud;
            let mut values = vec![0.0; cloud.len()];
            for (own, one) in all.iter().enumerate() {
                let has: Vec<bool> = match &of_point {
                    Some(of_point) => of_point.iter().map(|&of| usize::from(of) == own).collect(),
                    None => vec![own == 0; cloud.len()],
                };
                let what = Values {
                    path: &one.path,
                    text: match one.property {
                        Property::Number(number) => number.to_string(),
                        Property::Function(function) => function.text(),
                    },
                    unit,
                    allowed,
                };
                let value = |i: usize| one.property.value(cloud.point(i), f64::NAN);
                let (found, _) = self.values_of((&has, &value), &what, discretisation)?;
                for i in (0..cloud.len()).filter(|&i| has[i]) {
                    values[i] = one.factor * found[i];
                }
            }
            return Ok(PointScalar::PerPoint(values));
        };
        Ok(match of_point {
            Some(of_point) if numbers.iter().any(|value| *value != numbers[0]) => {
                let of = |&own: &u8| numbers.get(usize::from(own)).copied().unwrap_or(numbers[0]);
                PointScalar::PerPoint(of_point.iter().map(of).collect())
            }
            _ => PointScalar::Uniform(numbers.first().copied().unwrap_or_default()),
        })
    }

    /// Returns the temperatures of all points at the start of the run.
    fn start_temperatures(
        &self,
        path: &KeyPath,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
    ) -> Result<Vec<f64>, BuildError> {
        let mut start = vec![0.0; discretisation.cloud.len()];
        let temperature = self.given_temperature(path, discretisation, resources)?;
        temperature.temperatures_into(0.0, &mut start);
        Ok(start)
    }

    /// Returns the temperature that the model gives: the prescribed one, or the initial one of heat conduction.
    pub(super) fn given_temperature(
        &self,
        path: &KeyPath,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
    ) -> Result<Arc<dyn Temperature>, BuildError> {
        match &self.model.thermal {
            Some(thermal) => self.prescribed_temperature(thermal, discretisation, resources),
            None => Err(at_path(path, no_temperature())),
        }
    }
}

/// A property of a material: its key, its value, and a factor.
pub(super) struct OfMaterial<'a> {
    pub(super) path: KeyPath,
    pub(super) property: &'a Property,
    pub(super) factor: f64,
}

impl<'a> OfMaterial<'a> {
    /// A number of the model that is valid.
    pub(super) fn plain(property: &'a Property) -> Self {
        Self {
            path: KeyPath::from("material"),
            property,
            factor: 1.0,
        }
    }
}

/// Which values are allowed, in words and as a test.
pub(super) type Allowed = (&'static str, fn(f64) -> bool);

/// Positive numbers.
pub(super) const POSITIVE: Allowed = ("positive", |value| value > 0.0 && value.is_finite());
/// Numbers that are not negative.
pub(super) const NOT_NEGATIVE: Allowed = ("zero or positive", |value| {
    value >= 0.0 && value.is_finite()
});
/// Finite numbers.
pub(super) const FINITE: Allowed = ("finite", f64::is_finite);

/// A property for messages.
struct Values<'a> {
    path: &'a KeyPath,
    text: String,
    unit: &'static str,
    allowed: Allowed,
}

impl Values<'_> {
    /// Returns the error for a value that is not allowed.
    fn fault(&self, cloud: &PointCloud, i: usize, value: f64) -> BuildError {
        let place = cloud.point(i);
        let place: Vec<String> = (place[..cloud.dimension()].iter())
            .map(|x| quantity(*x, "m"))
            .collect();
        let reason = format!(
            "its value at ({}) is {}; it must be {} at all points of the material",
            place.join(", "),
            shown(value, self.unit),
            self.allowed.0
        );
        at_path(self.path, Fault::bad_expression(self.text.clone(), reason))
    }
}

fn no_temperature() -> Fault {
    Fault::OutOfRange {
        value: "a function of the temperature".into(),
        allowed: "allowed: with [thermal], whose `temperature` gives the temperature of the points"
            .into(),
    }
}

pub(super) fn not_of_model(property: MaterialProperty) -> Fault {
    Fault::OutOfRange {
        value: format!("a function as `{}`", property.key()),
        allowed: "allowed: for a material that has this constant".into(),
    }
}
