//! Snapshots: read-only views of a run at one time.

use std::borrow::Cow;
use std::cell::OnceCell;

use super::energies::{Energies, StartEnergy};
use super::field::Field;
use super::fragments::Fragments;
use super::tensors::{
    components, equivalent_stress, fitted_strain, places, principal_stresses, virial_stress,
};
use crate::error::{PericlesError, Result};
use crate::operator::BondView;
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
    force: OnceCell<Vec<f64>>,
    damage: OnceCell<Vec<f64>>,
    energy_density: OnceCell<Vec<f64>>,
    kinetic_density: OnceCell<Vec<f64>>,
    external: OnceCell<Vec<f64>>,
    contact: OnceCell<Vec<f64>>,
    reaction: OnceCell<Vec<f64>>,
    stress: OnceCell<Vec<f64>>,
    strain: OnceCell<Vec<f64>>,
    dilatation: OnceCell<Vec<f64>>,
    equivalent_stress: OnceCell<Vec<f64>>,
    plastic_strain: OnceCell<Vec<f64>>,
    yielded: OnceCell<Vec<f64>>,
    temperature: OnceCell<Vec<f64>>,
    heat_flux: OnceCell<Vec<f64>>,
    principal_stress: OnceCell<Vec<f64>>,
    radius: OnceCell<Vec<f64>>,
    numbers: OnceCell<Vec<f64>>,
    fragments: OnceCell<Vec<f64>>,
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
            force: OnceCell::new(),
            damage: OnceCell::new(),
            energy_density: OnceCell::new(),
            kinetic_density: OnceCell::new(),
            external: OnceCell::new(),
            contact: OnceCell::new(),
            reaction: OnceCell::new(),
            stress: OnceCell::new(),
            strain: OnceCell::new(),
            dilatation: OnceCell::new(),
            equivalent_stress: OnceCell::new(),
            plastic_strain: OnceCell::new(),
            yielded: OnceCell::new(),
            temperature: OnceCell::new(),
            heat_flux: OnceCell::new(),
            principal_stress: OnceCell::new(),
            radius: OnceCell::new(),
            numbers: OnceCell::new(),
            fragments: OnceCell::new(),
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
        let capabilities = self.system.operator().capabilities();
        let of = match field {
            Field::Dilatation if capabilities.dilatation.is_none() => {
                Some("state-based materials (model = \"state-based\")")
            }
            Field::PlasticStrain | Field::YieldFlag if capabilities.plastic.is_none() => {
                Some("materials with a `yield_stress`")
            }
            Field::Temperature if capabilities.thermal.is_none() && !self.conducts() => {
                Some("bodies with thermal expansion or conduction ([thermal])")
            }
            Field::HeatFlux if !self.conducts() => {
                Some("bodies with heat conduction ([thermal] conductivity)")
            }
            _ => None,
        };
        if let Some(of) = of {
            let field = field.name();
            return Err(PericlesError::NoMaterialOfField { field, of });
        }
        if field.is_of_bonds() && capabilities.bonds.is_none() {
            return Err(PericlesError::NoSuchField {
                field: field.name(),
            });
        }
        Ok(())
    }

    fn conducts(&self) -> bool {
        self.system.fields().next().is_some()
    }

    /// Returns a field, vectors component-major; NaN if [`Snapshot::check`] rejects it.
    pub fn field(&self, field: Field) -> &[f64] {
        let (t, u) = (self.state.t, &self.state.u);
        match field {
            Field::Displacement => u,
            Field::Velocity => &self.state.v,
            Field::ForceDensity => self.force.get_or_init(|| {
                let mut force = vec![0.0; u.len()];
                self.system.force_density_into(t, u, &mut force);
                force
            }),
            Field::Damage => self.damage.get_or_init(|| {
                let mut damage = vec![0.0; self.system.points()];
                self.system.operator().damage_into(&mut damage);
                damage
            }),
            Field::StrainEnergyDensity => self.energy_density.get_or_init(|| {
                let mut density = vec![0.0; self.system.points()];
                self.system
                    .operator()
                    .add_energy_density(t, u, &mut density);
                density
            }),
            Field::ContactForce => self.contact.get_or_init(|| {
                let mut force = vec![0.0; u.len()];
                self.system.add_contact_force(t, u, &mut force);
                force
            }),
            Field::ExternalForce => self.external.get_or_init(|| {
                let mut force = vec![0.0; u.len()];
                self.system.load_density_into(t, &mut force);
                force
            }),
            Field::Reaction => self.reaction.get_or_init(|| {
                let mut reaction = vec![0.0; u.len()];
                for motion in self.system.motions() {
                    motion.add_reaction(self.system.points(), &mut reaction);
                }
                reaction
            }),
            Field::Stress => self.stress.get_or_init(|| self.stress()),
            Field::Strain => self.strain.get_or_init(|| self.tensor(fitted_strain)),
            Field::Dilatation => self.dilatation.get_or_init(|| {
                let mut dilatation = vec![f64::NAN; self.system.points()];
                if let Some(view) = self.system.operator().capabilities().dilatation {
                    view.dilatation_into(t, u, &mut dilatation);
                }
                dilatation
            }),
            Field::EquivalentStress | Field::VonMisesStress => {
                self.equivalent_stress.get_or_init(|| {
                    let dimension = self.system.cloud().dimension();
                    equivalent_stress(dimension, self.field(Field::Stress))
                })
            }
            Field::PlasticStrain => self.plastic_strain.get_or_init(|| {
                let mut strain = vec![f64::NAN; self.system.points()];
                if let Some(view) = self.system.operator().capabilities().plastic {
                    view.plastic_strain_into(&mut strain);
                }
                strain
            }),
            Field::YieldFlag => self.yielded.get_or_init(|| {
                let strains = self.field(Field::PlasticStrain).iter();
                let flag = |strain: &f64| match strain.is_nan() {
                    true => f64::NAN,
                    false => f64::from(*strain > 0.0),
                };
                strains.map(flag).collect()
            }),
            Field::Temperature => self.temperature.get_or_init(|| {
                let mut temperatures = vec![f64::NAN; self.system.points()];
                match self.system.fields().next() {
                    Some(field) => field.values_into(t, &mut temperatures),
                    None => {
                        if let Some(thermal) = self.system.operator().capabilities().thermal {
                            thermal.temperatures_into(t, &mut temperatures);
                        }
                    }
                }
                temperatures
            }),
            Field::HeatFlux => self.heat_flux.get_or_init(|| {
                let mut flux = vec![f64::NAN; u.len()];
                if let Some(field) = self.system.fields().next() {
                    field.flux_into(t, &mut flux);
                }
                flux
            }),
            Field::PrincipalStress => self.principal_stress.get_or_init(|| {
                let dimension = self.system.cloud().dimension();
                principal_stresses(dimension, self.field(Field::Stress))
            }),
            Field::Radius => self.radius.get_or_init(|| {
                let cloud = self.system.cloud();
                let radius = |i: usize| 0.5 * cloud.cell_size(i);
                (0..cloud.len()).map(radius).collect()
            }),
            Field::PointId => self.numbers.get_or_init(|| {
                let cloud = self.system.cloud();
                let number = |i: usize| cloud.user_number(i) as f64;
                (0..cloud.len()).map(number).collect()
            }),
            Field::FragmentId => self
                .fragments
                .get_or_init(|| Fragments::numbers(self.system)),
            Field::Volume => self.system.cloud().volumes(),
            Field::KineticEnergyDensity => self
                .kinetic_density
                .get_or_init(|| self.kinetic_energy_density()),
        }
    }

    /// Returns the stress of the material, or the stress of the forces of bonds.
    fn stress(&self) -> Vec<f64> {
        match self.system.operator().capabilities().stress {
            Some(view) => components(self.system.cloud(), &view.stresses(&self.state.u)),
            None => self.tensor(virial_stress),
        }
    }

    fn tensor(
        &self,
        of_bonds: impl Fn(&PointCloud, &dyn BondView, &[f64]) -> Vec<f64>,
    ) -> Vec<f64> {
        let cloud = self.system.cloud();
        match self.system.operator().as_bonds() {
            Some(bonds) => of_bonds(cloud, bonds, &self.state.u),
            None => vec![f64::NAN; places(cloud.dimension()).len() * cloud.len()],
        }
    }

    /// Kinetic energy density ½ ρ |v|² of every point, J/m³ (J/m² on surfaces).
    pub fn kinetic_energy_density(&self) -> Vec<f64> {
        let n = self.system.points();
        let square = |i: usize| -> f64 {
            self.state
                .v
                .chunks(n.max(1))
                .map(|component| component[i].powi(2))
                .sum()
        };
        (0..n)
            .map(|i| 0.5 * self.system.density().at(i) * square(i))
            .collect()
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
