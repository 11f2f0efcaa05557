//! Checks of `[body]`, materials and interfaces.

use pericles::material::StressState;

use crate::body::VertexAreas;
use crate::declaration::{Check, DeckValue};
use crate::key_path::KeyPath;
use crate::model::{Model, Solid};
use crate::set::SetNames;
use crate::surface::{SurfaceBody, SurfaceScope};

impl Check {
    pub(super) fn solid(&mut self, key: &KeyPath, solid: &Solid) {
        solid.shape.check(key, self);
        let section = ["body.area", "body.thickness", "body"];
        let dimension = solid.shape.dimension();
        let right = (1..=3).contains(&dimension);
        self.within(right, key.key("dimension"), dimension, "allowed: 1, 2 or 3");
        if !right {
            return;
        }
        self.positive(section[dimension - 1].into(), solid.shape.section());
        let fits = match solid.state {
            StressState::Uniaxial => dimension == 1,
            StressState::PlaneStress | StressState::PlaneStrain => dimension == 2,
            StressState::Spatial => dimension == 3,
        };
        let allowed = "allowed: uniaxial in one dimension, plane stress or plane strain in two, spatial in three";
        self.within(fits, key.key("plane"), solid.state.name(), allowed);
        solid.material.check(solid.state, dimension, self);
    }

    /// Checks further materials, assignments and interfaces.
    pub(super) fn several(&mut self, model: &Model) {
        let (solid, dimension) = (model.body.solid(), model.body.dimension().clamp(1, 3));
        let own = solid.map(|solid| solid.material.name());
        let others = model.materials.iter().map(|other| other.name.as_str());
        let names: Vec<&str> = own.into_iter().chain(others).collect();
        let allowed = "allowed: the name of a material of the body";
        for (path, _, name) in model.assigned_materials() {
            self.within(names.contains(&name), path, name, allowed);
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

    pub(super) fn surface(&mut self, surface: &SurfaceBody) {
        if let VertexAreas::Same(area) = surface.areas {
            self.positive("body.areas".into(), area);
        }
        let sets = SetNames::any();
        let scope = SurfaceScope {
            spacing: None,
            sets: &sets,
        };
        surface.material.check("material".into(), scope, self);
    }
}
