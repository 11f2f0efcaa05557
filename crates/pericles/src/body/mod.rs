//! Builder of bodies: points, materials, cracks, loads and constraints, from which a [`System`] is assembled.

mod materials;

use std::sync::Arc;

use crate::boundary::{Boundary, Load, PrescribedMotion};
use crate::error::{PericlesError, Result};
use crate::family::{Crack, EndRule};
use crate::material::{
    BondConstants, BondMaterial, InterfaceRule, PairForce, Softening, Strength, StressState,
    SurfaceCorrection,
};
use crate::operator::{
    AssembledBonds, BondBody, BondForm, CompositeBody, DamageMeasure, Feature, Features, Force,
};
use crate::space::{PointCloud, PointSet, check_points};
use crate::system::System;
use crate::thermal::ThermalExpansion;

/// Assembles the bonds of a custom pair law.
type Assemble = fn(&CompositeBody<'_>, BondForm) -> Result<AssembledBonds>;

/// Builder of a bond-based body; [`Body::build`] returns the [`System`] that integrators advance.
///
/// Horizon, influence function, volume correction, density and fracture are properties of the material. Everything
/// else has a default: no cracks, bonds that may break everywhere, the faster of stencil and neighbour list, no
/// loads, no constraints.
///
/// ```
/// use pericles::prelude::*;
///
/// // A plate of 40 mm × 20 mm with an edge crack, pulled apart at its top and bottom.
/// let plate = Grid::plate([0.04, 0.02], 0.5e-3, 1e-3).points()?;
/// let top = plate.select(&Region::layer("+y", 0.5e-3)?);
/// let bottom = plate.select(&Region::layer("-y", 0.5e-3)?);
/// let glass = BondMaterial::new(ElasticModulus::Young(72e9), 2440.0, 1.5e-3).with_fracture_energy(3.8);
///
/// let system = Body::new(plate, glass)
///     .stress_state(StressState::PlaneStress)
///     .crack(Crack::Segment { from: [0.0, 0.01], to: [0.01, 0.01] })
///     .motion(PrescribedMotion::velocity(top, [None, Some(1.0), None], TimeFunction::Constant))
///     .motion(PrescribedMotion::velocity(bottom, [None, Some(-1.0), None], TimeFunction::Constant))
///     .build()?;
/// assert_eq!(system.points(), 3200);
/// assert!(system.operator().can_break());
/// # Ok::<(), PericlesError>(())
/// ```
#[must_use]
pub struct Body {
    cloud: Arc<PointCloud>,
    material: BondMaterial,
    state: Option<StressState>,
    others: Vec<(PointSet, BondMaterial)>,
    interface: InterfaceRule,
    correction: SurfaceCorrection,
    cracks: Vec<(Crack, EndRule)>,
    no_fail: PointSet,
    damage: DamageMeasure,
    form: BondForm,
    assemble: Assemble,
    expansion: Option<ThermalExpansion>,
    softening: Option<Softening>,
    strengths: Vec<Strength>,
    forces: Vec<Box<dyn Force>>,
    loads: Vec<Load>,
    motions: Vec<PrescribedMotion>,
    boundaries: Vec<Box<dyn Boundary>>,
}

impl Body {
    /// A free body of one material. Pass the points as an [`Arc`] to use them afterwards.
    pub fn new(points: impl Into<Arc<PointCloud>>, material: BondMaterial) -> Self {
        Self {
            cloud: points.into(),
            material,
            state: None,
            others: Vec::new(),
            interface: InterfaceRule::default(),
            correction: SurfaceCorrection::default(),
            cracks: Vec::new(),
            no_fail: Vec::new(),
            damage: DamageMeasure::default(),
            form: BondForm::default(),
            assemble: |body, form| body.operator(form),
            expansion: None,
            softening: None,
            strengths: Vec::new(),
            forces: Vec::new(),
            loads: Vec::new(),
            motions: Vec::new(),
            boundaries: Vec::new(),
        }
    }

    /// Sets the stress state, which a two-dimensional body requires; bars and three-dimensional bodies have only
    /// one.
    pub fn stress_state(mut self, state: StressState) -> Self {
        self.state = Some(state);
        self
    }

    /// Assigns another material to a set of points. It has its own density, modulus and fracture parameters; pair
    /// law, horizon, influence function and volume correction must equal those of the first material. Where sets
    /// overlap, the last one applies.
    pub fn material(mut self, points: PointSet, material: BondMaterial) -> Self {
        self.others.push((points, material));
        self
    }

    /// Sets the stiffness of bonds between two materials; the default is the harmonic mean.
    pub fn interface(mut self, rule: InterfaceRule) -> Self {
        self.interface = rule;
        self
    }

    /// Sets the surface correction, which corrects the stiffness of bonds near free surfaces.
    pub fn surface_correction(mut self, correction: SurfaceCorrection) -> Self {
        self.correction = correction;
        self
    }

    /// Adds a pre-crack: bonds that cross it or touch its edge are removed.
    pub fn crack(mut self, crack: Crack) -> Self {
        self.cracks.push((crack, EndRule::Closed));
        self
    }

    /// Adds points whose bonds never break.
    pub fn no_fail(mut self, points: PointSet) -> Self {
        self.no_fail.extend(points);
        self
    }

    /// Sets the damage measure.
    pub fn damage(mut self, measure: DamageMeasure) -> Self {
        self.damage = measure;
        self
    }

    /// Sets the form of the bonds: neighbour list, stencil, or the faster of the two.
    pub fn form(mut self, form: BondForm) -> Self {
        self.form = form;
        self
    }

    /// Uses a custom pair law instead of the material's.
    ///
    /// The force density of a bond is c α κ V_j L::force(ξ, η). The constant c follows from the modulus of the
    /// material as for the built-in laws, so that a law with the force ξ·η/|ξ|² for small η has this modulus.
    pub fn pair_law<L: PairForce>(mut self) -> Self {
        self.assemble = |body, form| body.operator_of_law::<L>(form);
        self
    }

    /// Bonds that soften before they break, which are then a list. All materials have the same onset;
    /// [`HomogeneousBonds::softening`](crate::material::HomogeneousBonds::softening) determines it from a tensile
    /// strength.
    pub fn softening(mut self, softening: Softening) -> Self {
        self.softening = Some(softening);
        self
    }

    /// Keeps bonds elastic until the stress of one of their ends reaches the strength of its material. The strengths are
    /// those of the body's material and of the further ones, in their order; the onset of the softening law is not used.
    pub fn strengths(mut self, strengths: Vec<Strength>) -> Self {
        self.strengths = strengths;
        self
    }

    /// Adds thermal expansion of the bonds, which then use a neighbour list.
    pub fn expansion(mut self, expansion: ThermalExpansion) -> Self {
        self.expansion = Some(expansion);
        self
    }

    /// Adds another force between the points of the body.
    pub fn force(mut self, force: Box<dyn Force>) -> Self {
        self.forces.push(force);
        self
    }

    /// Adds a load.
    pub fn load(mut self, load: Load) -> Self {
        self.loads.push(load);
        self
    }

    /// Adds a prescribed displacement or velocity.
    pub fn motion(mut self, motion: PrescribedMotion) -> Self {
        self.motions.push(motion);
        self
    }

    /// Adds a boundary with a state of its own, such as a damping layer.
    pub fn boundary(mut self, boundary: Box<dyn Boundary>) -> Self {
        self.boundaries.push(boundary);
        self
    }

    /// Returns the bond constants of the first material on this body: micromodulus and critical stretch.
    ///
    /// # Errors
    /// Invalid material parameters ([`BondMaterial::constants`]); a two-dimensional body without a stress state.
    pub fn constants(&self) -> Result<BondConstants> {
        self.material.constants(&self.cloud, self.given_state()?)
    }

    /// Assembles the equation of motion of the body.
    ///
    /// # Errors
    /// A two-dimensional body without a stress state; invalid or incompatible materials; a horizon that reaches no
    /// neighbour; cracks without extent; a form that is not available for the body; points that the body does not
    /// have; two constraints on one component of a point.
    pub fn build(self) -> Result<System> {
        let state = self.given_state()?;
        let constants = self.material.constants(&self.cloud, state)?;
        check_points(
            "the points whose bonds never break",
            &self.no_fail,
            self.cloud.len(),
        )?;
        let mixture = self.mixture(&constants, state)?;
        let body = BondBody {
            cracks: &self.cracks,
            no_fail: &self.no_fail,
            damage: self.damage,
            ..BondBody::new(&self.cloud, &self.material, &constants)
        };
        let composite = CompositeBody {
            classes: mixture.classes.as_ref(),
            correction: self.correction,
            softening: self.softening,
            strengths: &self.strengths,
            ..CompositeBody::from(body)
        };
        let form = self.form;
        let expands = Features::default().with(Feature::ThermalExpansion, self.expansion.is_some());
        form.check(expands)?;
        let mut bonds = (self.assemble)(&composite, form)?;
        if let Some(expansion) = self.expansion {
            bonds.operator.expand(expansion)?;
        }
        let mut system = System::new(self.cloud, bonds.operator, mixture.density)?;
        for force in self.forces {
            system.add_force(force)?;
        }
        for load in self.loads {
            system.add_load(load)?;
        }
        for motion in self.motions {
            system.add_motion(motion)?;
        }
        for boundary in self.boundaries {
            system.add_boundary(boundary);
        }
        Ok(system)
    }

    fn given_state(&self) -> Result<StressState> {
        match (self.state, self.cloud.dimension()) {
            (Some(state), _) => Ok(state),
            (None, 1) => Ok(StressState::Uniaxial),
            (None, 3) => Ok(StressState::Spatial),
            (None, _) => Err(PericlesError::NotGiven {
                what: "the stress state of a two-dimensional body",
                allowed: "give PlaneStress or PlaneStrain",
            }),
        }
    }
}
