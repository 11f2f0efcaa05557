//! Stiffness, yield stress and strength that vary from point to point.

use std::sync::Arc;

use pericles::space::PointCloud;
use pericles::{HeatedFactor, OfTemperature, PointScalar, Temperature, YieldFactor};
use pericles_deck::{BuildError, KeyPath, MaterialModel, MaterialProperty, PropertyFunction};

use super::assembler::Assembler;
use super::body::BodyParts;
use super::discretisation::Discretisation;
use super::properties::not_of_model;
use super::property::{Evaluated, multiply};
use super::rejection::{at, at_path};
use super::resources::Resources;

impl Assembler<'_> {
    /// Sets the stiffnesses and yield stresses of points that functions of materials determine; `field` is the computed
    /// temperature.
    pub(super) fn vary(
        &self,
        parts: &mut BodyParts,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
        field: Option<Arc<dyn Temperature>>,
    ) -> Result<(), BuildError> {
        let Some(solid) = self.model.body.solid() else {
            return Ok(());
        };
        let modulus = match solid.material.model {
            // Bonds have the mean stiffness of their end points.
            MaterialModel::Bonds(_) => None,
            _ => self.properties.factors(MaterialProperty::YoungsModulus),
        };
        let is_yield = |own: &&Evaluated| own.property == MaterialProperty::YieldStress;
        let yields: Vec<&Evaluated> = self.properties.all().iter().filter(is_yield).collect();
        if modulus.is_none() && yields.is_empty() {
            return Ok(());
        }
        let Some(forces) = parts.bonds.operator.pointwise_mut() else {
            let fault = not_of_model(MaterialProperty::YoungsModulus);
            return Err(at_path("material.youngs_modulus", fault));
        };
        if let Some(factors) = modulus {
            let set = forces.set_stiffness(factors);
            set.map_err(|error| at("material.youngs_modulus", error))?;
        }
        if yields.is_empty() {
            return Ok(());
        }
        let path = KeyPath::from("material.yield_stress");
        let factors = self.properties.factors(MaterialProperty::YieldStress);
        let factor = match yields.iter().any(|own| own.range.is_heated) {
            false => YieldFactor::Constant(Arc::new(factors.unwrap_or_default())),
            true => {
                let temperature = match field {
                    Some(field) => field,
                    None => self.given_temperature(&path, discretisation, resources)?,
                };
                let law = HeatedYield {
                    cloud: discretisation.cloud.clone(),
                    all: yields.into_iter().map(OwnYield::of).collect(),
                };
                let points = discretisation.cloud.len();
                YieldFactor::Heated(HeatedFactor::new(temperature, Arc::new(law), points))
            }
        };
        (forces.set_yield(factor)).map_err(|error| at(path, error))
    }

    /// Multiplies densities by the factors of the functions of materials.
    pub(super) fn varying_density(&self, density: PointScalar) -> PointScalar {
        match self.properties.factors(MaterialProperty::Density) {
            None => density,
            Some(mut factors) => {
                for (i, factor) in factors.iter_mut().enumerate() {
                    *factor *= density.at(i);
                }
                PointScalar::PerPoint(factors)
            }
        }
    }

    /// Multiplies factors of strength by those of the functions of materials; `None` if strengths do not vary.
    pub(super) fn varying_strengths(&self, scattered: Option<Vec<f64>>) -> Option<Vec<f64>> {
        let mut all = scattered;
        for own in self.properties.all() {
            let factor: fn(f64) -> f64 = match own.property {
                MaterialProperty::CriticalStretch | MaterialProperty::Strength => |factor| factor,
                MaterialProperty::FractureEnergy => f64::sqrt,
                MaterialProperty::YoungsModulus if own.breaks_by_energy => {
                    |factor| 1.0 / factor.sqrt()
                }
                MaterialProperty::Density
                | MaterialProperty::YieldStress
                | MaterialProperty::YoungsModulus => continue,
            };
            let factors: Vec<f64> = own.factors.iter().map(|value| factor(*value)).collect();
            match &mut all {
                None => all = Some(factors),
                Some(all) => multiply(all, &factors),
            }
        }
        all
    }
}

/// The yield stresses of points at their temperatures, relative to the numbers of their materials.
#[derive(Debug)]
struct HeatedYield {
    cloud: Arc<PointCloud>,
    all: Vec<OwnYield>,
}

/// The yield stress of a material.
#[derive(Debug)]
struct OwnYield {
    has_material: Vec<bool>,
    function: PropertyFunction,
    /// Number of the model over the mean.
    ratio: f64,
}

impl OwnYield {
    fn of(own: &Evaluated) -> Self {
        Self {
            has_material: own.has_material.clone(),
            function: own.function.clone(),
            ratio: own.scale / own.range.mean,
        }
    }
}

impl OfTemperature for HeatedYield {
    fn value(&self, point: usize, temperature: f64) -> f64 {
        let own = self.all.iter().find(|own| own.has_material[point]);
        own.map_or(1.0, |own| {
            own.ratio * own.function.value(self.cloud.point(point), temperature)
        })
    }
}
