//! Thermal strain: the temperature of every point, and the stretch that it would have without stress.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use crate::error::{PericlesError, Result};
use crate::scalar::PointScalar;
use crate::space::{PointCloud, check_length};

/// Temperatures of the points of a body as a function of time, prescribed or solved for.
pub trait Temperature: fmt::Debug + Send + Sync {
    /// Sets the temperature of every own point at a time, K.
    fn temperatures_into(&self, t: f64, out: &mut [f64]);

    /// Whether it is the same at all times.
    fn is_steady(&self) -> bool {
        false
    }
}

/// The thermal stretch τ = α (T − T₀) of every point, dimensionless: forces are zero where all bonds have this stretch.
///
/// In plane strain the bonds of bond-based and state-based materials, which lie in the plane, need α (1 + ν) in place of α, because the strain across the plane is prevented.
#[derive(Debug, Clone)]
pub struct ThermalExpansion {
    temperature: Arc<dyn Temperature>,
    reference: f64,
    coefficient: PointScalar,
    cloud: Arc<PointCloud>,
    kept: Arc<Mutex<Option<Kept>>>,
}

/// The stretches found last.
#[derive(Debug)]
struct Kept {
    t: f64,
    stretches: Arc<Vec<f64>>,
}

impl ThermalExpansion {
    /// The expansion of the points of a body with the coefficient α (1/K) and the stress-free temperature T₀ (K).
    ///
    /// # Errors
    /// Coefficients that are not one for each point, or not finite; a reference temperature that is not finite.
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

    /// Whether temperatures are the same at all times.
    pub fn is_steady(&self) -> bool {
        self.temperature.is_steady()
    }

    /// Sets the temperature of every own point at a time, K.
    pub fn temperatures_into(&self, t: f64, out: &mut [f64]) {
        self.temperature.temperatures_into(t, out);
    }

    /// τ of all own points, with that of ghosts behind them, at a time. Zero at t = −∞: the body before it was heated. Every process must ask at the same time.
    pub fn stretches(&self, t: f64) -> Arc<Vec<f64>> {
        if t == f64::NEG_INFINITY {
            return Arc::new(self.unheated());
        }
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        match &*kept {
            Some(known) if known.t == t || self.is_steady() => known.stretches.clone(),
            _ => {
                let stretches = Arc::new(self.stretches_at(t));
                *kept = Some(Kept {
                    t,
                    stretches: stretches.clone(),
                });
                stretches
            }
        }
    }

    /// τ at the time that forces were computed for last, for output; zero before.
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

/// Forces of a material that can expand with temperature.
pub trait Expandable {
    /// Gives the material a thermal expansion from now on.
    ///
    /// # Errors
    /// Materials whose limits or corrections are not defined with thermal strain.
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()>;
}
