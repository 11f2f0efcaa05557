//! Range checks of models made by programs. Decks are checked while they are read.
//!
//! Declared tables have their checks ([`crate::declaration`]); the others have checks written by hand here.

mod body;
mod contact;

use crate::assign::{AssignScope, Assignable};
use crate::crack::CrackScope;
use crate::declaration::{Check, DeckValue};
use crate::exact::ExactScope;
use crate::key_path::KeyPath;
use crate::model::{Body, Model};
use crate::output::OutputScope;
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
        let body = KeyPath::from("body");
        match &self.body {
            Body::Solid(solid) => check.solid(&body, solid),
            Body::Surface(surface) => check.surface(surface),
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

impl Check {
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
