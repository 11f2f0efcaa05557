//! Temperatures of points, the thermal stretch of bonds, and yield stresses that depend on the temperature.
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
    latest: Arc<Latest>,
}

/// Values of all points at the last time at which they were computed.
#[derive(Debug, Default)]
struct Latest(Mutex<Option<Kept>>);

#[derive(Debug)]
struct Kept {
    t: f64,
    revision: u64,
    values: Arc<Vec<f64>>,
}

impl Latest {
    /// Returns the values at a time, which `compute` returns unless they are known.
    fn at(
        &self,
        t: f64,
        temperature: &dyn Temperature,
        compute: impl FnOnce() -> Vec<f64>,
    ) -> Arc<Vec<f64>> {
        let revision = temperature.revision();
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_valid = |known: &Kept| known.t == t && known.revision == revision;
        match &*kept {
            Some(known) if is_valid(known) || temperature.is_steady() => known.values.clone(),
            _ => {
                let values = Arc::new(compute());
                *kept = Some(Kept {
                    t,
                    revision,
                    values: values.clone(),
                });
                values
            }
        }
    }

    /// Returns the last values; `None` if there are none.
    fn values(&self) -> Option<Arc<Vec<f64>>> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Some(kept.as_ref()?.values.clone())
    }
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
            latest: Arc::default(),
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

    /// Returns the temperatures of all own points, followed by ghosts, at a time, K. All processes must call it together.
    pub fn temperatures(&self, t: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.cloud.len()];
        self.temperature.temperatures_into(t, &mut values);
        self.cloud.domain().with_ghosts(&values).into_owned()
    }

    /// Returns τ of all own points, followed by ghosts, at a time; zero at t = −∞, before the body is
    /// heated. All processes must call it together.
    pub fn stretches(&self, t: f64) -> Arc<Vec<f64>> {
        if t == f64::NEG_INFINITY {
            return Arc::new(self.unheated());
        }
        self.latest
            .at(t, &*self.temperature, || self.stretches_at(t))
    }

    /// Returns τ at the time of the last force evaluation, for output; zero before.
    pub fn latest(&self) -> Arc<Vec<f64>> {
        let known = self.latest.values();
        known.unwrap_or_else(|| Arc::new(self.unheated()))
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

/// A function of a point and its temperature.
pub trait OfTemperature: fmt::Debug + Send + Sync {
    /// Returns the value at a point for its temperature, K.
    fn value(&self, point: usize, temperature: f64) -> f64;
}

/// The yield stress of every own point relative to that of its material.
#[derive(Debug, Clone)]
pub enum YieldFactor {
    /// Factors that are constant in time.
    Constant(Arc<Vec<f64>>),
    /// Factors that depend on the temperature.
    Heated(HeatedFactor),
}

/// A factor of every own point that depends on its temperature.
#[derive(Debug, Clone)]
pub struct HeatedFactor {
    temperature: Arc<dyn Temperature>,
    factor: Arc<dyn OfTemperature>,
    points: usize,
    latest: Arc<Latest>,
}

impl HeatedFactor {
    /// Creates a factor of the points of a body.
    pub fn new(
        temperature: Arc<dyn Temperature>,
        factor: Arc<dyn OfTemperature>,
        points: usize,
    ) -> Self {
        Self {
            temperature,
            factor,
            points,
            latest: Arc::default(),
        }
    }

    fn values_at(&self, t: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.points];
        self.temperature.temperatures_into(t, &mut values);
        for (i, value) in values.iter_mut().enumerate() {
            *value = self.factor.value(i, *value);
        }
        values
    }
}

impl YieldFactor {
    /// Returns the number of points.
    pub fn points(&self) -> usize {
        match self {
            Self::Constant(values) => values.len(),
            Self::Heated(heated) => heated.points,
        }
    }

    /// Returns the factors at a time. All processes must call it together.
    pub fn at(&self, t: f64) -> Arc<Vec<f64>> {
        match self {
            Self::Constant(values) => values.clone(),
            Self::Heated(heated) => {
                (heated.latest).at(t, &*heated.temperature, || heated.values_at(t))
            }
        }
    }

    /// Returns the factors at the time of the last call of [`YieldFactor::at`]; those at t = 0 before.
    pub fn latest(&self) -> Arc<Vec<f64>> {
        match self {
            Self::Constant(values) => values.clone(),
            Self::Heated(heated) => heated.latest.values().unwrap_or_else(|| self.at(0.0)),
        }
    }

    /// Returns a point whose factor at the time of the last evaluation is not positive and finite, with the factor.
    pub fn lost(&self) -> Option<(usize, f64)> {
        let Self::Heated(_) = self else { return None };
        let values = self.latest();
        let lost = values
            .iter()
            .position(|value| !(*value > 0.0 && value.is_finite()));
        lost.map(|point| (point, values[point]))
    }
}

/// Forces whose stiffness and yield stress may vary from point to point.
pub trait Pointwise {
    /// Multiplies the elastic moduli of every own point by a factor.
    ///
    /// # Errors
    /// A number of factors other than the number of points; factors that are not positive.
    fn set_stiffness(&mut self, factors: Vec<f64>) -> Result<()>;

    /// Multiplies the yield stress of every own point by a factor.
    ///
    /// # Errors
    /// A number of factors other than the number of points.
    fn set_yield(&mut self, factor: YieldFactor) -> Result<()>;
}
