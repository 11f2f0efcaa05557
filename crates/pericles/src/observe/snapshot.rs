//! Snapshots: read-only views of a run at one time.

use std::borrow::Cow;
use std::cell::OnceCell;

use super::energies::{Energies, StartEnergy};
use super::fragments::Fragments;
use super::tensors::{equivalent_stress, fitted_strain, places, principal_stresses, virial_stress};
use crate::error::{PericlesError, Result};
use crate::operator::BondView;
use crate::space::PointCloud;
use crate::system::System;
use crate::time::{InnerIterations, State};

/// A field on the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// u, m.
    Displacement,
    /// v, m/s.
    Velocity,
    /// Internal and external force density, N/m³.
    ForceDensity,
    /// Damage: 1 − unbroken bonds / initial bonds.
    Damage,
    /// Elastic energy density, J/m³.
    StrainEnergyDensity,
    /// Force density of loads, N/m³.
    ExternalForce,
    /// Reaction force density of constraints, N/m³.
    Reaction,
    /// Force density of contact, with dampers and friction, N/m³.
    ContactForce,
    /// Virial stress, Pa: ½ Σ f ⊗ (ξ + η) over the bonds of a point. NaN if the force does not list its bonds.
    Stress,
    /// Strain of the displacement gradient fitted to the bonds of a point by least squares. NaN if the force does
    /// not list its bonds.
    Strain,
    /// Volume of the point, m³, or its area on a surface, m²; constant in time.
    Volume,
    /// Kinetic energy density ½ ρ v², J/m³.
    KineticEnergyDensity,
    /// Dilatation of a state-based material: the relative change of volume, or of area in two dimensions. NaN for
    /// other materials.
    Dilatation,
    /// Equivalent stress, Pa: von Mises stress of the virial stress; in two dimensions of the in-plane components,
    /// in a bar the absolute value. NaN if the force does not list its bonds.
    EquivalentStress,
    /// Equivalent plastic strain; NaN for materials that do not yield.
    PlasticStrain,
    /// 1 where a point has yielded, else 0; NaN for materials that do not yield.
    YieldFlag,
    /// Temperature, K; NaN for bodies without thermal expansion and heat conduction.
    Temperature,
    /// Heat flux, W/m²; NaN for bodies without heat conduction.
    HeatFlux,
    /// Von Mises stress, Pa: the same numbers as [`Field::EquivalentStress`].
    VonMisesStress,
    /// Principal stresses, Pa: eigenvalues of the virial stress in descending order, as many as the body has dimensions. As stress.
    PrincipalStress,
    /// Half the size of a point's cell, m: ½ (V / section)^(1/dimension). The same at all times.
    Radius,
    /// Number of the point in the user's numbering, from 0. The same at all times.
    PointId,
    /// Number of the fragment that the point belongs to, from 0 in the order of the first points. 0 for bodies whose bonds do not break.
    FragmentId,
}

impl Field {
    /// Fields written by default.
    pub const USUAL: [Self; 5] = [
        Self::Displacement,
        Self::Velocity,
        Self::ForceDensity,
        Self::Damage,
        Self::StrainEnergyDensity,
    ];

    /// All fields.
    pub const ALL: [Self; 23] = [
        Self::Displacement,
        Self::Velocity,
        Self::ForceDensity,
        Self::Damage,
        Self::StrainEnergyDensity,
        Self::ExternalForce,
        Self::Reaction,
        Self::ContactForce,
        Self::Stress,
        Self::Strain,
        Self::Volume,
        Self::KineticEnergyDensity,
        Self::Dilatation,
        Self::EquivalentStress,
        Self::PlasticStrain,
        Self::YieldFlag,
        Self::Temperature,
        Self::HeatFlux,
        Self::VonMisesStress,
        Self::PrincipalStress,
        Self::Radius,
        Self::PointId,
        Self::FragmentId,
    ];

    /// Name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "Displacement",
            Self::Velocity => "Velocity",
            Self::ForceDensity => "Force_Density",
            Self::Damage => "Damage",
            Self::StrainEnergyDensity => "Strain_Energy_Density",
            Self::ExternalForce => "External_Force_Density",
            Self::Reaction => "Reaction_Density",
            Self::ContactForce => "Contact_Force_Density",
            Self::Stress => "Stress",
            Self::Strain => "Strain",
            Self::Volume => "Volume",
            Self::KineticEnergyDensity => "Kinetic_Energy_Density",
            Self::Dilatation => "Dilatation",
            Self::EquivalentStress => "Equivalent_Stress",
            Self::PlasticStrain => "Plastic_Strain",
            Self::YieldFlag => "Yield_Flag",
            Self::Temperature => "Temperature",
            Self::HeatFlux => "Heat_Flux",
            Self::VonMisesStress => "Von_Mises_Stress",
            Self::PrincipalStress => "Principal_Stress",
            Self::Radius => "Radius",
            Self::PointId => "Point_Id",
            Self::FragmentId => "Fragment_Id",
        }
    }

    /// SI unit of the field.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Displacement | Self::Radius => "m",
            Self::Velocity => "m/s",
            Self::ForceDensity | Self::ExternalForce | Self::Reaction | Self::ContactForce => {
                "N/m³"
            }
            Self::Stress
            | Self::EquivalentStress
            | Self::VonMisesStress
            | Self::PrincipalStress => "Pa",
            Self::Damage
            | Self::Strain
            | Self::Dilatation
            | Self::PlasticStrain
            | Self::YieldFlag
            | Self::PointId
            | Self::FragmentId => "",
            Self::StrainEnergyDensity | Self::KineticEnergyDensity => "J/m³",
            Self::Volume => "m³",
            Self::Temperature => "K",
            Self::HeatFlux => "W/m²",
        }
    }

    /// Returns whether the field has one component per dimension of the body, stored component-major.
    pub fn is_vector(self) -> bool {
        matches!(
            self,
            Self::Displacement
                | Self::Velocity
                | Self::ForceDensity
                | Self::ExternalForce
                | Self::Reaction
                | Self::ContactForce
                | Self::HeatFlux
                | Self::PrincipalStress
        )
    }

    /// Returns whether the values are whole numbers from 0 to 2³¹ − 1.
    pub fn is_integer(self) -> bool {
        matches!(self, Self::PointId | Self::FragmentId)
    }

    /// Returns whether the field is a symmetric tensor, stored component-major in the order of
    /// [`Field::components`].
    pub fn is_tensor(self) -> bool {
        matches!(self, Self::Stress | Self::Strain)
    }

    /// Returns whether the field is computed from single bonds.
    pub fn is_of_bonds(self) -> bool {
        let of_stress = [
            Self::EquivalentStress,
            Self::VonMisesStress,
            Self::PrincipalStress,
        ];
        self.is_tensor() || of_stress.contains(&self)
    }

    /// Names of the components for a body of a dimension; empty for scalars.
    pub fn components(self, dimension: usize) -> &'static [&'static str] {
        if self == Self::PrincipalStress {
            &["1", "2", "3"][..dimension]
        } else if self.is_vector() {
            &["x", "y", "z"][..dimension]
        } else if self.is_tensor() {
            match dimension {
                1 => &["xx"],
                2 => &["xx", "yy", "xy"],
                _ => &["xx", "yy", "zz", "xy", "yz", "xz"],
            }
        } else {
            &[]
        }
    }
}

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
    pub fn whole_cloud(&self) -> &'a PointCloud {
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

    /// Returns a field, vectors component-major; NaN if [`Snapshot::check`] refuses it.
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
            Field::Stress => self.stress.get_or_init(|| self.tensor(virial_stress)),
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
            initial: self.start.energy,
            scheme: self.scheme - self.start.scheme,
        }
    }
}
