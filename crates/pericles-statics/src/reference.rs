//! Loads and displacements of supports at a reference time, of which a factor is searched.

use pericles::boundary::ProportionalLoading;
use pericles::operator::PointSubset;
use pericles::{Result, System};

use crate::error::StaticsError;

/// Loads and displacements of the supports at the reference time.
#[derive(Debug)]
pub struct Reference {
    /// The reference time, s.
    pub t: f64,
    /// Loads, N/m³.
    pub load: Vec<f64>,
    /// Displacements, m; only constrained entries are used.
    pub supports: Vec<f64>,
}

impl Reference {
    /// Returns loads and supports at a time, and makes the loads of the system multiples of them.
    pub fn of(system: &mut System, t: f64) -> Self {
        let zeros = || vec![0.0; system.dimension() * system.points()];
        let (mut load, mut supports) = (zeros(), zeros());
        system.place_on(t, &PointSubset::All, &mut supports);
        system.load_proportionally(ProportionalLoading {
            reference: t,
            factors: [1.0; 2],
        });
        system.load_density_into(t, &mut load);
        Self { t, load, supports }
    }

    /// Returns an error for systems in which loads and supports cannot be scaled: one factor must determine the state.
    pub fn check(
        system: &System,
        t: f64,
        refuse: impl Fn(&'static str) -> StaticsError,
    ) -> Result<()> {
        if system.operator().capabilities().thermal.is_some() {
            return Err(
                refuse("thermal strain is not scaled with the loads (remove [thermal])").into(),
            );
        }
        if system.has_interactions() {
            return Err(refuse(
                "contact forces are not multiples of the loads (remove [contact] and impactors)",
            )
            .into());
        }
        let zeros = || vec![0.0; system.dimension() * system.points()];
        let (mut load, mut supports) = (zeros(), zeros());
        system.place_on(t, &PointSubset::All, &mut supports);
        system.load_density_into(t, &mut load);
        let nothing = supports.iter().chain(&load).all(|x| *x == 0.0);
        if system.domain().all(nothing) {
            return Err(refuse(
                "no load and no prescribed displacement differs from zero at the end of the run",
            )
            .into());
        }
        Ok(())
    }
}

/// Returns a multiple of a vector.
pub fn scaled(by: f64, vector: &[f64]) -> Vec<f64> {
    vector.iter().map(|x| by * x).collect()
}
