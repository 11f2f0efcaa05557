//! A view of a run at one time.

use std::cell::OnceCell;

use super::tensors::{equivalent_stress, fitted_strain, places, virial_stress};
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
    /// 1 − bonds left over bonds at the start.
    Damage,
    /// Elastic energy density, J/m³.
    StrainEnergyDensity,
    /// Loads, N/m³.
    ExternalForce,
    /// What supports exert on held points, N/m³.
    Reaction,
    /// Virial stress, Pa: ½ Σ f ⊗ (ξ + η) over the bonds of a point. Of operators that list their bonds; else not a number.
    Stress,
    /// Strain of the displacement gradient that fits a point's bonds best. As stress.
    Strain,
    /// Volume of the point, m³; its area on a surface, m². The same at all times.
    Volume,
    /// Kinetic energy density ½ ρ v², J/m³.
    KineticEnergyDensity,
    /// Dilatation of a state-based material: the relative change of volume, in the plane of area. Else not a number.
    Dilatation,
    /// Equivalent stress, Pa: von Mises' of the virial stress; in the plane of the components within it, in a bar the size of the stress. As stress.
    EquivalentStress,
    /// Equivalent plastic strain. Of materials that yield; else not a number.
    PlasticStrain,
    /// 1 where a point has yielded, 0 elsewhere. As plastic strain.
    YieldFlag,
    /// Temperature, K. Of materials that expand with it; else not a number.
    Temperature,
}

impl Field {
    /// Fields that are written if nothing else is asked for.
    pub const USUAL: [Self; 5] = [
        Self::Displacement,
        Self::Velocity,
        Self::ForceDensity,
        Self::Damage,
        Self::StrainEnergyDensity,
    ];

    /// All fields.
    pub const ALL: [Self; 16] = [
        Self::Displacement,
        Self::Velocity,
        Self::ForceDensity,
        Self::Damage,
        Self::StrainEnergyDensity,
        Self::ExternalForce,
        Self::Reaction,
        Self::Stress,
        Self::Strain,
        Self::Volume,
        Self::KineticEnergyDensity,
        Self::Dilatation,
        Self::EquivalentStress,
        Self::PlasticStrain,
        Self::YieldFlag,
        Self::Temperature,
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
            Self::Stress => "Stress",
            Self::Strain => "Strain",
            Self::Volume => "Volume",
            Self::KineticEnergyDensity => "Kinetic_Energy_Density",
            Self::Dilatation => "Dilatation",
            Self::EquivalentStress => "Equivalent_Stress",
            Self::PlasticStrain => "Plastic_Strain",
            Self::YieldFlag => "Yield_Flag",
            Self::Temperature => "Temperature",
        }
    }

    /// SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Displacement => "m",
            Self::Velocity => "m/s",
            Self::ForceDensity | Self::ExternalForce | Self::Reaction => "N/m³",
            Self::Stress | Self::EquivalentStress => "Pa",
            Self::Damage
            | Self::Strain
            | Self::Dilatation
            | Self::PlasticStrain
            | Self::YieldFlag => "",
            Self::StrainEnergyDensity | Self::KineticEnergyDensity => "J/m³",
            Self::Volume => "m³",
            Self::Temperature => "K",
        }
    }

    /// Whether it is a vector field, component-major.
    pub fn is_vector(self) -> bool {
        matches!(
            self,
            Self::Displacement
                | Self::Velocity
                | Self::ForceDensity
                | Self::ExternalForce
                | Self::Reaction
        )
    }

    /// Whether it is a symmetric tensor field, component-major in the order of [`Field::components`].
    pub fn is_tensor(self) -> bool {
        matches!(self, Self::Stress | Self::Strain)
    }

    /// Whether it is made of single bonds.
    pub fn is_of_bonds(self) -> bool {
        self.is_tensor() || self == Self::EquivalentStress
    }

    /// Names of the components in a body of a dimension, none for a scalar.
    pub fn components(self, dimension: usize) -> &'static [&'static str] {
        if self.is_vector() {
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

/// The energy account of a body, J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energies {
    /// ½ Σ ρ V v².
    pub kinetic: f64,
    /// Stored in bonds.
    pub elastic: f64,
    /// Lost to breaking.
    pub dissipated: f64,
    /// Work of loads, supports and changing temperatures since the start.
    pub work: f64,
    /// Kinetic and elastic energy at the start.
    pub initial: f64,
    /// What the scheme's own conserved energy differs from kinetic + elastic, less that difference at the start
    /// ([`crate::time::Integrator::energy_correction`]).
    pub scheme: f64,
}

impl Energies {
    /// kinetic + elastic + dissipated + scheme − work − initial: zero but for the nonlinearity of the forces, of order dt², if nothing is lost.
    pub fn balance(&self) -> f64 {
        self.kinetic + self.elastic + self.dissipated + self.scheme - self.work - self.initial
    }
}

/// Energies at the start of a run, J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StartEnergy {
    /// Kinetic and elastic energy.
    pub energy: f64,
    /// The scheme's correction.
    pub scheme: f64,
}

/// A body at one time.
pub struct Snapshot<'a> {
    system: &'a System,
    state: &'a State,
    start: StartEnergy,
    scheme: f64,
    inner: Option<InnerIterations>,
    force: OnceCell<Vec<f64>>,
    damage: OnceCell<Vec<f64>>,
    energy_density: OnceCell<Vec<f64>>,
    kinetic_density: OnceCell<Vec<f64>>,
    external: OnceCell<Vec<f64>>,
    reaction: OnceCell<Vec<f64>>,
    stress: OnceCell<Vec<f64>>,
    strain: OnceCell<Vec<f64>>,
    dilatation: OnceCell<Vec<f64>>,
    equivalent_stress: OnceCell<Vec<f64>>,
    plastic_strain: OnceCell<Vec<f64>>,
    yielded: OnceCell<Vec<f64>>,
    temperature: OnceCell<Vec<f64>>,
}

impl<'a> Snapshot<'a> {
    /// A view of a state, with the energies of the run's start and the scheme's correction at this state.
    pub fn new(system: &'a System, state: &'a State, start: StartEnergy, scheme: f64) -> Self {
        Self {
            system,
            state,
            start,
            scheme,
            inner: None,
            force: OnceCell::new(),
            damage: OnceCell::new(),
            energy_density: OnceCell::new(),
            kinetic_density: OnceCell::new(),
            external: OnceCell::new(),
            reaction: OnceCell::new(),
            stress: OnceCell::new(),
            strain: OnceCell::new(),
            dilatation: OnceCell::new(),
            equivalent_stress: OnceCell::new(),
            plastic_strain: OnceCell::new(),
            yielded: OnceCell::new(),
            temperature: OnceCell::new(),
        }
    }

    /// The same with what the scheme's inner iterations did.
    pub fn with_inner(mut self, inner: Option<InnerIterations>) -> Self {
        self.inner = inner;
        self
    }

    /// What the scheme's inner iterations did, if it has some.
    pub fn inner_iterations(&self) -> Option<InnerIterations> {
        self.inner
    }

    /// The equation of motion.
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// The state.
    pub fn state(&self) -> &'a State {
        self.state
    }

    /// Whether a field can be computed for this body. Stress and strain are sums over single bonds, which convolutions, plane waves and surfaces do not have; only state-based materials have a dilatation, only materials that yield a plastic strain, and only bodies with thermal expansion a temperature.
    ///
    /// # Errors
    /// A field that cannot.
    pub fn check(&self, field: Field) -> Result<()> {
        let capabilities = self.system.operator().capabilities();
        let of = match field {
            Field::Dilatation if capabilities.dilatation.is_none() => {
                Some("state-based materials (model = \"state-based\")")
            }
            Field::PlasticStrain | Field::YieldFlag if capabilities.plastic.is_none() => {
                Some("materials with a `yield_stress`")
            }
            Field::Temperature if capabilities.thermal.is_none() => {
                Some("bodies with thermal expansion ([thermal])")
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

    /// A field; vectors component-major. Not numbers where [`Snapshot::check`] refuses it.
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
            Field::EquivalentStress => self.equivalent_stress.get_or_init(|| {
                let dimension = self.system.cloud().dimension();
                equivalent_stress(dimension, self.field(Field::Stress))
            }),
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
                if let Some(thermal) = self.system.operator().capabilities().thermal {
                    thermal.temperatures_into(t, &mut temperatures);
                }
                temperatures
            }),
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

    /// ½ ρ |v|² of every point, J/m³ (J/m² on surfaces).
    pub fn kinetic_energy_density(&self) -> Vec<f64> {
        let n = self.system.points();
        let square = |i: usize| -> f64 {
            self.state
                .v
                .chunks(n)
                .map(|component| component[i].powi(2))
                .sum()
        };
        (0..n)
            .map(|i| 0.5 * self.system.density().at(i) * square(i))
            .collect()
    }

    /// The energy account.
    pub fn energies(&self) -> Energies {
        Energies {
            kinetic: self.system.kinetic_energy(&self.state.v),
            elastic: self.system.operator().energy(self.state.t, &self.state.u),
            dissipated: self.system.operator().dissipated(),
            work: self.system.ledger().work,
            initial: self.start.energy,
            scheme: self.scheme - self.start.scheme,
        }
    }
}
