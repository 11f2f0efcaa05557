//! Range checks of `[body]` and `[material]`.

use pericles::kernel::Influence;
use pericles::material::{
    BondFailure, ElasticModulus, Fracture, InterfaceStiffness, Modulus, StressState,
    SurfaceCorrection,
};
use pericles::space::Shape;

use crate::body::{
    FilledCells, FilledShape, Lattice, Piece, Quadrature, RotationScope, SolidShape, VertexAreas,
    piece_path,
};
use crate::declaration::{Check, DeckKeys, DeckValue};
use crate::fault::Fault;
use crate::interface::InterfaceFailure;
use crate::key_path::KeyPath;
use crate::material::{Material, MaterialModel, difference};
use crate::model::{Model, Solid};
use crate::region::Frame;
use crate::remark::Remark;
use crate::set::{SetNames, bad_name};
use crate::state_based::StateBased;
use crate::surface::{SurfaceBody, SurfaceScope};

impl Check {
    pub(super) fn solid(&mut self, key: &KeyPath, solid: &Solid) {
        self.shape(key, &solid.shape);
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

    fn shape(&mut self, key: &KeyPath, shape: &SolidShape) {
        match shape {
            SolidShape::Lattice(lattice) => self.lattice(key, lattice),
            SolidShape::Points(points) => points.check_keys(key, (), self),
            SolidShape::Mesh(mesh) => mesh.check_keys(key, (), self),
            SolidShape::Filled(filled) => self.filled(key, filled),
            SolidShape::Pieces(pieces) => self.pieces(key, pieces),
        }
    }

    fn pieces(&mut self, key: &KeyPath, pieces: &[Piece]) {
        let allowed = "allowed: at least one piece";
        self.within(!pieces.is_empty(), key.key("piece"), pieces.len(), allowed);
        for (k, piece) in pieces.iter().enumerate() {
            let key = piece_path(k);
            let whole = piece.shape.pieces().is_empty()
                && !piece.shape.is_periodic()
                && !piece.shape.is_refined()
                && !piece.shape.has_gauss_nodes();
            let allowed =
                "allowed: a shape that is not periodic, with one point per cell and one cell size";
            self.within(whole, key.key("shape"), &piece.name, allowed);
            if whole {
                self.shape(&key, &piece.shape);
            }
            let first = &pieces[0].shape;
            let alike = first.dimension() == piece.shape.dimension()
                && first.section() == piece.shape.section();
            let allowed = "allowed: the dimension and the `area` or `thickness` of the body";
            self.within(alike, key.key("shape"), &piece.name, allowed);
            let known = pieces[..k].iter().any(|other| other.name == piece.name);
            let allowed = "allowed: a name that no other piece has";
            self.within(
                !known && bad_name(&piece.name).is_none(),
                key.key("name"),
                &piece.name,
                allowed,
            );
            if let Some(rotation) = piece.rotation {
                let scope = RotationScope::of_piece(Some(first.dimension()));
                rotation.check(key.key("rotation"), scope, self);
            }
        }
    }

    fn filled(&mut self, key: &KeyPath, filled: &FilledShape) {
        filled.check_keys(key, filled.dimension, self);
        let random = filled.positions.are_random();
        let right = filled.cells == FilledCells::Whole || !random;
        let allowed = "allowed: \"whole\" with random positions";
        self.within(right, key.key("cells"), "partial", allowed);
        let right = filled.is_on_lattice() || filled.finer.is_empty();
        let allowed = "allowed: with whole cells on a lattice";
        self.within(right, key.key("refine"), filled.finer.len(), allowed);
    }

    fn lattice(&mut self, key: &KeyPath, lattice: &Lattice) {
        self.positive(key.key("spacing"), lattice.grid.spacing);
        let frame = Frame::of_model(lattice.grid.dimension());
        lattice.grid.holes.check(key.key("hole"), frame, self);
        lattice.finer.check(key.key("refine"), frame, self);
        match &lattice.grid.shape {
            Shape::Box { size, .. } => {
                for (k, side) in size.iter().enumerate() {
                    self.positive(key.key("size").index(k), *side);
                }
            }
            Shape::Disc { radius, .. } | Shape::Ball { radius, .. } => {
                self.positive(key.key("radius"), *radius);
            }
            Shape::Cylinder {
                axis,
                radius,
                height,
                ..
            } => {
                self.axis(key.key("axis"), *axis);
                self.positive(key.key("radius"), *radius);
                self.positive(key.key("height"), *height);
            }
        }
        let sides = match &lattice.grid.shape {
            Shape::Box { size, .. } => size.len(),
            _ => 0,
        };
        if let Some(spacings) = &lattice.rectangular {
            let allowed = "allowed: one spacing per axis, for bars, plates and blocks only";
            let right = spacings.len() == sides;
            self.within(right, key.key("spacing"), spacings.len(), allowed);
            for (k, spacing) in spacings.iter().enumerate() {
                self.positive(key.key("spacing").index(k), *spacing);
            }
        }
        let gauss = lattice.quadrature == Quadrature::Gauss;
        let allowed = "allowed: \"midpoint\", except for a bar";
        self.within(
            !gauss || sides == 1,
            key.key("quadrature"),
            "gauss",
            allowed,
        );
        lattice.positions.check_keys(key, (), self);
        let plain = lattice.rectangular.is_none()
            && lattice.finer.is_empty()
            && !lattice.periodic
            && !gauss;
        let right = plain || !lattice.positions.are_random();
        let allowed = "allowed: \"lattice\" in periodic bodies, with Gauss nodes and with cells of several sizes";
        self.within(right, key.key("positions"), "random", allowed);
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
