//! Range checks of `[body]` and `[material]`.

use pericles::kernel::Influence;
use pericles::material::{
    BondFailure, ElasticModulus, Fracture, InterfaceStiffness, Modulus, StressState,
    SurfaceCorrection,
};

use crate::body::{VertexAreas, piece_path};
use crate::declaration::{Check, DeckKeys, DeckValue};
use crate::fault::Fault;
use crate::interface::InterfaceFailure;
use crate::key_path::KeyPath;
use crate::material::{Material, MaterialModel, difference};
use crate::model::{Model, Solid};
use crate::remark::Remark;
use crate::set::SetNames;
use crate::state_based::StateBased;
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
        self.material(&solid.material, solid.state, dimension);
    }

    fn material(&mut self, material: &Material, state: StressState, dimension: usize) {
        let key = KeyPath::from("material");
        self.model(&key, &material.model, state, dimension);
        if let MaterialModel::StateBased(_) = &material.model {
            let allowed = "allowed: none, energy or ghosts; the weighted volume already accounts for missing bonds";
            let right = material.surface_correction != SurfaceCorrection::Volume;
            self.within(right, key.key("surface_correction"), "volume", allowed);
        }
    }

    fn model(
        &mut self,
        key: &KeyPath,
        model: &MaterialModel,
        state: StressState,
        dimension: usize,
    ) {
        self.positive(key.key("density"), model.density());
        self.positive(key.key("horizon"), model.horizon());
        match model {
            MaterialModel::Bonds(bonds) => {
                self.modulus(key, &bonds.modulus, state);
                self.fracture(key, &bonds.fracture);
                self.influence(key, &bonds.influence, dimension, bonds.horizon);
            }
            MaterialModel::StateBased(solid) => self.state_based(key, solid, state, dimension),
            MaterialModel::Correspondence(given) => {
                self.state_based(key, &given.as_state_based(), state, dimension);
                if let Some(anisotropy) = &given.anisotropy {
                    let path = key.key("anisotropy");
                    anisotropy.check_keys(&path, (), self);
                    self.engine(path, anisotropy.stiffness());
                }
                if let Some(plasticity) = &given.plasticity {
                    self.engine(key.key("yield_stress"), plasticity.check());
                }
            }
        }
    }

    /// Checks further materials, assignments and interfaces.
    pub(super) fn several(&mut self, model: &Model) {
        let (solid, dimension) = (model.body.solid(), model.body.dimension().clamp(1, 3));
        let own = solid.map(|solid| solid.material.name());
        let others = model.materials.iter().map(|other| other.name.as_str());
        let names: Vec<&str> = own.into_iter().chain(others).collect();
        if let Some(solid) = solid {
            for other in &model.materials {
                let key = KeyPath::from("materials").key(&other.name);
                self.model(&key, &other.model, solid.state, dimension);
                if let Some(name) = difference(&solid.material.model, &other.model) {
                    let table = key.to_string();
                    let fault = Fault::NotShared { key: name, table };
                    self.problems.push(Remark::new(key.key(name), fault));
                }
            }
        }
        let allowed = "allowed: the name of a material of the body";
        for (k, assignment) in model.assignments.iter().enumerate() {
            let key = KeyPath::from("assign").index(k);
            if let Some(name) = &assignment.material {
                let known = names.contains(&name.as_str());
                self.within(known, key.key("material"), name, allowed);
            }
        }
        for (k, piece) in solid
            .iter()
            .flat_map(|solid| solid.shape.pieces())
            .enumerate()
        {
            if let Some(name) = &piece.material {
                let known = names.contains(&name.as_str());
                self.within(known, piece_path(k).key("material"), name, allowed);
            }
        }
        for (k, interface) in model.interfaces.iter().enumerate() {
            let key = KeyPath::from("interface").index(k);
            if let Some(pair) = &interface.between {
                let known = pair.iter().all(|name| names.contains(&name.as_str()));
                let allowed = "allowed: the names of two different materials of the body";
                let right = known && pair[0] != pair[1];
                self.within(right, key.key("between"), pair.join(", "), allowed);
            }
            if let (Some(InterfaceStiffness::Modulus(modulus)), Some(solid)) =
                (&interface.stiffness, solid)
            {
                self.modulus(&key, modulus, solid.state);
            }
            match &interface.failure {
                Some(InterfaceFailure::Bonds(fracture)) => self.fracture(&key, fracture),
                Some(InterfaceFailure::StateBased(failure)) => self.failure(&key, failure),
                None => {}
            }
        }
    }

    fn state_based(
        &mut self,
        key: &KeyPath,
        state_based: &StateBased,
        state: StressState,
        dimension: usize,
    ) {
        let solid = &state_based.solid;
        self.engine(key.clone(), solid.elastic.resolve(state));
        self.failure(key, &solid.failure);
        if let Some(criterion) = &state_based.criterion {
            self.engine(key.key("strength"), criterion.criterion());
        }
        if let Some(influence) = state_based.given_influence() {
            self.influence(key, &influence, dimension, solid.horizon);
        }
    }

    fn failure(&mut self, key: &KeyPath, failure: &BondFailure) {
        match *failure {
            BondFailure::Unbreakable | BondFailure::ByCriterion => {}
            BondFailure::CriticalStretch(stretch) => {
                self.positive(key.key("critical_stretch"), stretch);
            }
            BondFailure::Stretch {
                fracture_energy, ..
            }
            | BondFailure::BondEnergy {
                fracture_energy, ..
            } => self.positive(key.key("fracture_energy"), fracture_energy),
        }
    }

    fn modulus(&mut self, key: &KeyPath, modulus: &Modulus, state: StressState) {
        let (name, value) = match modulus.value {
            ElasticModulus::Young(value) => ("youngs_modulus", value),
            ElasticModulus::Bulk(value) => ("bulk_modulus", value),
            ElasticModulus::Shear(value) => ("shear_modulus", value),
        };
        self.positive(key.key(name), value);
        self.engine(key.key(name), modulus.value.young(state));
    }

    fn fracture(&mut self, key: &KeyPath, fracture: &Fracture) {
        match *fracture {
            Fracture::Unbreakable => {}
            Fracture::CriticalStretch(stretch) => {
                self.positive(key.key("critical_stretch"), stretch);
            }
            Fracture::Energy { energy, .. } => self.positive(key.key("fracture_energy"), energy),
        }
    }

    fn influence(&mut self, key: &KeyPath, influence: &Influence, dimension: usize, horizon: f64) {
        self.engine(key.key("influence"), influence.check(dimension, horizon));
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
