//! The energy balance of a state.

/// The energy balance of a body, J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energies {
    /// Kinetic energy ½ Σ ρ V v².
    pub kinetic: f64,
    /// Elastic energy of the bonds.
    pub elastic: f64,
    /// Energy dissipated by fracture and inelastic deformation.
    pub dissipated: f64,
    /// Energy stored by contact.
    pub contact: f64,
    /// Energy dissipated by dampers and friction of contact.
    pub contact_dissipated: f64,
    /// Kinetic energy of rigid bodies that move freely.
    pub bodies: f64,
    /// Work of loads, constraints, temperature changes and prescribed motions of rigid bodies since the start.
    pub work: f64,
    /// Kinetic and stored energy at the start, including contact and rigid bodies, and energy that the body had dissipated
    /// in an earlier run.
    pub initial: f64,
    /// Difference between the energy that the scheme conserves and kinetic + elastic energy, minus that difference
    /// at the start ([`crate::time::Integrator::energy_correction`]).
    pub scheme: f64,
}

impl Energies {
    /// Error of the energy balance: kinetic + elastic + dissipated + scheme − work − initial, where contact and rigid
    /// bodies count with their parts. It is zero up to rounding for linear forces and of order dt² for nonlinear
    /// forces and contact.
    pub fn balance(&self) -> f64 {
        let touching = self.contact + self.contact_dissipated + self.bodies;
        self.kinetic + self.elastic + self.dissipated + self.scheme - self.work - self.initial
            + touching
    }
}

/// Energies at the start of a run, J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StartEnergy {
    /// Kinetic and elastic energy.
    pub energy: f64,
    /// Energy that the body had dissipated in an earlier run.
    pub dissipated: f64,
    /// Correction of the scheme.
    pub scheme: f64,
}
