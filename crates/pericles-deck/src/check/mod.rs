//! Range checks of models made by programs. Decks are checked while they are read.
//!
//! Declared tables have their checks ([`crate::declaration`]); rules that decks satisfy by their form are next to the types.

mod contact;

use pericles::material::StressState;

use crate::assign::{AssignScope, Assignable};
use crate::body::piece_path;
use crate::crack::CrackScope;
use crate::declaration::{Check, DeckValue};
use crate::exact::ExactScope;
use crate::key_path::KeyPath;
use crate::model::{Body, Model, Solid};
use crate::output::OutputScope;
use crate::range::POSITIVE;
use crate::region::Frame;
use crate::remark::BuildError;
use crate::scope::Scope;
use crate::set::SetNames;
use crate::thermal::ThermalScope;

impl Model {
    /// Rejects numbers out of range. Decks have the same ranges, so that a model read from a deck always passes.
    ///
    /// # Errors
    /// All numbers out of range, with their keys.
    pub fn check(&self) -> Result<(), BuildError> {
        let mut check = Check::default();
        match &self.body {
            Body::Solid(solid) => solid.check(&mut check),
            Body::Surface(surface) => surface.check(&mut check),
        }
        check.several(self);
        let frame = Frame::of_model(self.body.dimension());
        for set in &self.sets {
            let path = KeyPath::from("sets").key(&set.name);
            set.members.check(path, frame, &mut check);
        }
        check.contact(self);
        Scope::of_model(self.body.dimension(), |scope| check.declared(self, scope));
        let sets = SetNames::any();
        let cracks = CrackScope { frame, sets: &sets };
        self.cracks.check("crack".into(), cracks, &mut check);
        self.time.check("time".into(), &sets, &mut check);
        let output = OutputScope {
            dimension: Some(self.body.dimension().clamp(1, 3)),
            driven: false,
            surface: self.body.surface().is_some(),
            mesh: true,
            sets: &sets,
        };
        self.output.check("output".into(), output, &mut check);
        self.checkpoint.check("checkpoint".into(), (), &mut check);
        self.run.check("run".into(), (), &mut check);
        match check.problems.is_empty() {
            true => Ok(()),
            false => Err(BuildError::of(check.problems)),
        }
    }
}

impl Solid {
    /// Checks the shape, the stress state and the material of a body.
    fn check(&self, check: &mut Check) {
        let path = KeyPath::from("body");
        self.shape.check(&path, check);
        let dimension = self.shape.dimension();
        let right = (1..=3).contains(&dimension);
        let allowed = "allowed: 1, 2 or 3";
        check.within(right, path.key("dimension"), dimension, allowed);
        if !right {
            return;
        }
        let section = ["area", "thickness"].get(dimension - 1);
        let section = section.map_or(path.clone(), |key| path.key(key));
        check.number(section, self.shape.section(), POSITIVE);
        let fits = match self.state {
            StressState::Uniaxial => dimension == 1,
            StressState::PlaneStress | StressState::PlaneStrain => dimension == 2,
            StressState::Spatial => dimension == 3,
        };
        let allowed = "allowed: uniaxial in one dimension, plane stress or plane strain in two, spatial in three";
        check.within(fits, path.key("plane"), self.state.name(), allowed);
        self.material.check(self.state, dimension, check);
    }
}

impl Check {
    /// Checks further materials, assignments and interfaces.
    fn several(&mut self, model: &Model) {
        let (solid, dimension) = (model.body.solid(), model.body.dimension().clamp(1, 3));
        let own = solid.map(|solid| solid.material.name());
        let others = model.materials.iter().map(|other| other.name.as_str());
        let names: Vec<&str> = own.into_iter().chain(others).collect();
        let allowed = "allowed: the name of a material of the body";
        let assigned = model.assignments.iter().enumerate();
        let assigned = assigned.map(|(k, assignment)| {
            let path = KeyPath::from("assign").index(k);
            (path, &assignment.material)
        });
        let pieces = solid.map_or(&[][..], |solid| solid.shape.pieces());
        let pieces = pieces.iter().enumerate();
        let pieces = pieces.map(|(k, piece)| (piece_path(k), &piece.material));
        for (path, material) in assigned.chain(pieces) {
            if let Some(name) = material {
                let known = names.contains(&name.as_str());
                self.within(known, path.key("material"), name, allowed);
            }
        }
        let Some(solid) = solid else { return };
        for other in &model.materials {
            other.check(&solid.material.model, solid.state, dimension, self);
        }
        for (k, interface) in model.interfaces.iter().enumerate() {
            let path = KeyPath::from("interface").index(k);
            interface.check(&path, &names, solid.state, self);
        }
    }

    /// Checks the declared tables.
    fn declared(&mut self, model: &Model, scope: Scope<'_>) {
        if let Some(thermal) = &model.thermal {
            let scope = ThermalScope::new(thermal.conduction.is_some(), scope);
            thermal.check("thermal".into(), scope, self);
        }
        let assign = AssignScope {
            deck: scope,
            of: Assignable::Both,
        };
        model.assignments.check("assign".into(), assign, self);
        model.initial.check("initial".into(), scope, self);
        model.constraints.check("constraint".into(), scope, self);
        model.loads.check("load".into(), scope, self);
        if let Some(exact) = &model.exact {
            exact.check("exact".into(), ExactScope { gaussian: None }, self);
        }
        (model.activations).check("activation".into(), scope, self);
        model.probes.check("probe".into(), scope, self);
        if let Some(contact) = &model.contact {
            contact.check("contact".into(), scope, self);
        }
        model.impactors.check("impactor".into(), scope, self);
        if let Some(damping) = &model.damping {
            damping.check("damping".into(), scope, self);
        }
        model.boundaries.check("boundary".into(), scope, self);
    }
}
