//! Snapshots: read-only views of a run at one time.

use std::borrow::Cow;

use super::energies::{Energies, StartEnergy};
use super::field::{Field, FieldNeed, FieldValues};
use crate::error::{PericlesError, Result};
use crate::space::PointCloud;
use crate::system::System;
use crate::time::{InnerIterations, State};

/// A body and its state at one time.
pub struct Snapshot<'a> {
    system: &'a System,
    state: &'a State,
    start: StartEnergy,
    scheme: f64,
    inner: Option<InnerIterations>,
    whole: Option<&'a PointCloud>,
    fields: FieldValues<'a>,
}

impl<'a> Snapshot<'a> {
    /// Makes a view of a state, with the energies at the start of the run and the correction of the scheme at this
    /// state.
    pub fn new(system: &'a System, state: &'a State, start: StartEnergy, scheme: f64) -> Self {
        Self {
            system,
            state,
            start,
            scheme,
            inner: None,
            whole: None,
            fields: FieldValues::new(system, state),
        }
    }

    /// Adds the statistics of the inner iterations of the scheme.
    pub fn with_inner(mut self, inner: Option<InnerIterations>) -> Self {
        self.inner = inner;
        self
    }

    /// Sets the points of the whole body, of which the system has a part.
    pub fn with_whole(mut self, whole: Option<&'a PointCloud>) -> Self {
        self.whole = whole;
        self
    }

    /// Returns whether this process writes the results. Observers run on all processes that share a body, because their values
    /// require communication, and only the first one writes files.
    pub fn is_written(&self) -> bool {
        self.system.domain().is_first()
    }

    /// Returns the points of the whole body on the process that writes the results, and own points on the others.
    ///
    /// # Panics
    /// If the process that writes the results of a divided body has not received its points; see [`Snapshot::with_whole`].
    pub fn whole_cloud(&self) -> &'a PointCloud {
        let domain = self.system.domain();
        assert!(
            self.whole.is_some() || !domain.is_divided() || !domain.is_first(),
            "observers of the whole body need its points"
        );
        self.whole.unwrap_or(self.system.cloud())
    }

    /// Returns a field on the points of the whole body, as [`Snapshot::field`] for a body that is not divided, on the process
    /// that writes the results; `None` on the others. All processes must call it together.
    pub fn whole(&self, field: Field) -> Option<Cow<'_, [f64]>> {
        self.system.domain().gather(self.field(field))
    }

    /// Returns the statistics of the inner iterations, for schemes that iterate.
    pub fn inner_iterations(&self) -> Option<InnerIterations> {
        self.inner
    }

    /// Returns the system.
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// Returns the state.
    pub fn state(&self) -> &'a State {
        self.state
    }

    /// Checks that a field is available for this body. Stress and strain are sums over single bonds, which
    /// convolutions, plane waves and surfaces do not provide; dilatation requires a state-based material, plastic
    /// strain a material that yields, temperature a body with thermal expansion or conduction, flux one with conduction.
    ///
    /// # Errors
    /// A field that is not available.
    pub fn check(&self, field: Field) -> Result<()> {
        let Some(need) = field.need().filter(|need| !need.is_met(self.system)) else {
            return Ok(());
        };
        let field = field.name();
        let of = match need {
            FieldNeed::Bonds => return Err(PericlesError::NoSuchField { field }),
            FieldNeed::Dilatation => "state-based materials (model = \"state-based\")",
            FieldNeed::Plasticity => "materials with a `yield_stress`",
            FieldNeed::Temperature => "bodies with thermal expansion or conduction ([thermal])",
            FieldNeed::Conduction => "bodies with heat conduction ([thermal] conductivity)",
        };
        Err(PericlesError::NoMaterialOfField { field, of })
    }

    /// Returns a field, vectors component-major; NaN if [`Snapshot::check`] rejects it.
    pub fn field(&self, field: Field) -> &[f64] {
        self.fields.get(field)
    }

    /// Returns the energy balance.
    pub fn energies(&self) -> Energies {
        Energies {
            kinetic: self.system.kinetic_energy(&self.state.v),
            elastic: self.system.operator().energy(self.state.t, &self.state.u),
            dissipated: self.system.operator().dissipated(),
            contact: self.system.contact_energy(self.state.t, &self.state.u),
            contact_dissipated: self.system.contact_dissipated(),
            bodies: self.system.body_kinetic_energy(),
            work: self.system.ledger().work,
            initial: self.start.energy + self.start.dissipated,
            scheme: self.scheme - self.start.scheme,
        }
    }
}
