//! Thermal expansion: temperatures of points and the thermal stretch of bonds.
//!
//! A heated bond is a longer bond, (1 + τ) ξ with the thermal stretch τ, in every pair law.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use crate::error::{PericlesError, Result};
use crate::scalar::PointScalar;
use crate::space::{PointCloud, check_length};

/// Temperatures of the points of a body as a function of time, prescribed or computed.
pub trait Temperature: fmt::Debug + Send + Sync {
    /// Computes the temperature of every own point at a time, K.
    fn temperatures_into(&self, t: f64, out: &mut [f64]);

    /// Returns whether the temperatures are constant in time.
    fn is_steady(&self) -> bool {
        false
    }

    /// Returns a number that changes when the temperature at a given time may have changed: the temperature of a computed field
    /// depends on its last accepted state.
    fn revision(&self) -> u64 {
        0
    }
}

/// The thermal stretch τ = α (T − T₀) of every point (dimensionless): forces are zero if all bonds have this
/// stretch.
///
/// In plane strain bond-based and state-based materials need α (1 + ν) in place of α, because the out-of-plane
/// strain is prevented.
#[derive(Debug, Clone)]
pub struct ThermalExpansion {
    temperature: Arc<dyn Temperature>,
    reference: f64,
    coefficient: PointScalar,
    cloud: Arc<PointCloud>,
    kept: Arc<Mutex<Option<Kept>>>,
}

/// The last computed stretches.
#[derive(Debug)]
struct Kept {
    t: f64,
    revision: u64,
    stretches: Arc<Vec<f64>>,
}

impl ThermalExpansion {
    /// Makes the expansion of the points of a body with coefficient α (1/K) and stress-free temperature T₀ (K).
    ///
    /// # Errors
    /// Coefficients that are not one per point or not finite; a reference temperature that is not finite.
    pub fn new(
        cloud: Arc<PointCloud>,
        temperature: Arc<dyn Temperature>,
        reference: f64,
        coefficient: PointScalar,
    ) -> Result<Self> {
        let finite = |quantity, value: f64| match value.is_finite() {
            true => Ok(()),
            false => Err(PericlesError::OutOfRange {
                quantity,
                value,
                allowed: "a finite number",
            }),
        };
        finite("the stress-free temperature", reference)?;
        const COEFFICIENT: &str = "a coefficient of thermal expansion";
        match &coefficient {
            PointScalar::Uniform(value) => finite(COEFFICIENT, *value)?,
            PointScalar::PerPoint(values) => {
                check_length(
                    "the coefficients of thermal expansion",
                    values.len(),
                    cloud.len(),
                )?;
                values
                    .iter()
                    .try_for_each(|&value| finite(COEFFICIENT, value))?;
            }
        }
        Ok(Self {
            temperature,
            reference,
            coefficient,
            cloud,
            kept: Arc::default(),
        })
    }

    /// Returns whether the temperatures are constant in time.
    pub fn is_steady(&self) -> bool {
        self.temperature.is_steady()
    }

    /// Computes the temperature of every own point at a time, K.
    pub fn temperatures_into(&self, t: f64, out: &mut [f64]) {
        self.temperature.temperatures_into(t, out);
    }

    /// Returns τ of all own points, followed by ghosts, at a time; zero at t = −∞, before the body is
    /// heated. All processes must call it together.
    pub fn stretches(&self, t: f64) -> Arc<Vec<f64>> {
        if t == f64::NEG_INFINITY {
            return Arc::new(self.unheated());
        }
        let revision = self.temperature.revision();
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let is_valid = |known: &Kept| known.t == t && known.revision == revision;
        match &*kept {
            Some(known) if is_valid(known) || self.is_steady() => known.stretches.clone(),
            _ => {
                let stretches = Arc::new(self.stretches_at(t));
                *kept = Some(Kept {
                    t,
                    revision,
                    stretches: stretches.clone(),
                });
                stretches
            }
        }
    }

    /// Returns τ at the time of the last force evaluation, for output; zero before.
    pub fn latest(&self) -> Arc<Vec<f64>> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        match &*kept {
            Some(known) => known.stretches.clone(),
            None => Arc::new(self.unheated()),
        }
    }

    fn unheated(&self) -> Vec<f64> {
        let domain = self.cloud.domain();
        domain
            .with_ghosts(&vec![0.0; self.cloud.len()])
            .into_owned()
    }

    fn stretches_at(&self, t: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.cloud.len()];
        self.temperature.temperatures_into(t, &mut values);
        for (i, value) in values.iter_mut().enumerate() {
            *value = self.coefficient.at(i) * (*value - self.reference);
        }
        self.cloud.domain().with_ghosts(&values).into_owned()
    }
}

/// Forces of a material that supports thermal expansion.
pub trait Expandable {
    /// Adds a thermal expansion to the material.
    ///
    /// # Errors
    /// Materials whose failure criterion or corrections are not defined with thermal strain.
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()>;
}
