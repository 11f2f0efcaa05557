//! Damping layers and Rayleigh damping of a model, and their stable steps.

use pericles::boundary::{
    DampedSteps, DampingLayer, DampingProfile, RayleighDamping, RayleighRates,
};
use pericles::space::{Face, PointCloud};
use pericles::time::Integrator;
use pericles::{PericlesError, PointScalar, StepKind, System};
use pericles_deck::{BoundaryCondition, BuildError, KeyPath};

use super::assembler::Assembler;
use super::constants::MaterialConstants;
use super::rejection::at_path;
use super::step::Steps;

impl Assembler<'_> {
    /// Returns the damping layers with their numbers in the deck.
    ///
    /// # Errors
    /// The body is a surface.
    pub(super) fn damping_layers(
        &self,
        density: &PointScalar,
        constants: Option<&MaterialConstants>,
    ) -> Result<Vec<(usize, Face, DampingProfile)>, BuildError> {
        let is_layer = |boundary: &BoundaryCondition| {
            matches!(boundary, BoundaryCondition::DampingLayer { .. })
        };
        let (Some(solid), Some(constants)) = (self.model.body.solid(), constants) else {
            return match self.model.boundaries.iter().position(is_layer) {
                None => Ok(Vec::new()),
                Some(k) => {
                    let reason = "a closed surface has no sides".into();
                    let error = PericlesError::BadDampingLayer { reason };
                    Err(at_path(KeyPath::from("boundary").index(k), error.into()))
                }
            };
        };
        // The first of several materials.
        let modulus = constants.longitudinal_modulus(solid.state);
        let speed = (modulus / density.at(0)).sqrt();
        let layer = |(k, boundary): (usize, &BoundaryCondition)| {
            let BoundaryCondition::DampingLayer {
                face,
                thickness,
                reflection,
                power,
            } = *boundary
            else {
                return None;
            };
            let profile = DampingProfile::of_reflection(thickness, reflection, power, speed);
            Some((k, face, profile))
        };
        let boundaries = self.model.boundaries.iter().enumerate();
        Ok(boundaries.filter_map(layer).collect())
    }

    /// Returns the factors of mass- and stiffness-proportional damping; zero without damping.
    pub(super) fn rayleigh_rates(&self) -> RayleighRates {
        let damping = self.model.damping;
        damping.map_or_else(RayleighRates::default, |damping| RayleighRates {
            mass: damping.mass,
            stiffness: damping.stiffness,
        })
    }

    /// Adds mass- and stiffness-proportional damping.
    pub(super) fn add_rayleigh_damping(
        &self,
        system: &mut System,
        integrator: &dyn Integrator,
    ) -> Result<(), BuildError> {
        let rates = self.rayleigh_rates();
        if rates == RayleighRates::default() {
            return Ok(());
        }
        let (kind, needed) = (integrator.step_kind(), rates.step_kinds());
        if integrator.is_static() || !needed.contains(&kind) {
            let error = PericlesError::BoundaryScheme {
                what: "this damping of motion",
                scheme: integrator.name(),
                kind,
                needed,
            };
            return Err(at_path("damping", error.into()));
        }
        let damping = RayleighDamping::new(rates, kind, system.masses(), system.domain());
        let damping = damping.map_err(|error| at_path("damping", error.into()))?;
        system.add_boundary(Box::new(damping));
        Ok(())
    }

    /// Adds the damping layers.
    pub(super) fn add_damping_layers(
        &self,
        system: &mut System,
        layers: Vec<(usize, Face, DampingProfile)>,
        kind: StepKind,
        steps: &Steps,
    ) -> Result<(), BuildError> {
        let damped = DampedSteps {
            kind,
            dt: steps.dt,
            frequency: steps.frequency.map(|frequency| frequency.estimate),
        };
        for (k, face, profile) in layers {
            let path = KeyPath::from("boundary").index(k);
            let reject = |error: PericlesError| at_path(&path, error.into());
            let layer = DampingLayer::new(system.cloud(), system.density(), face, profile, damped);
            system.add_boundary(Box::new(layer.map_err(reject)?));
        }
        Ok(())
    }
}

/// Returns the largest damping rate of a point, 1/s. All processes must call it together. Rates of layers add up in corners, and of opposite layers where
/// they overlap.
pub(super) fn strongest(layers: &[(usize, Face, DampingProfile)], cloud: &PointCloud) -> f64 {
    let along = |axis: usize| {
        let depth_of = |upper: bool| {
            let layers = layers
                .iter()
                .filter(move |(_, face, _)| face.axis == axis && face.upper == upper);
            layers.fold(
                (0.0, 0.0),
                |(depth, strength): (f64, f64), (.., profile)| {
                    (depth.max(profile.thickness), strength + profile.strength)
                },
            )
        };
        let [(low, a), (high, b)] = [false, true].map(depth_of);
        let [first, last] = cloud.extent(axis);
        let length = last - first + cloud.cell_side(axis);
        if low + high > length { a + b } else { a.max(b) }
    };
    (0..cloud.dimension()).map(along).sum()
}
