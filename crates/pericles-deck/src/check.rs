//! Ranges of a model's numbers: a deck is refused for them while it is read, a model made by a program is checked here.

use pericles::PericlesError;
use pericles::kernel::Influence;
use pericles::material::{ElasticModulus, Fracture, Modulus, StressState};
use pericles::observe::{Field, Schedule};
use pericles::space::{Region, Shape};
use pericles_manifold::{PowerMaterial, SurfaceBond};

use crate::body::{Lattice, Quadrature, SolidShape, VertexAreas};
use crate::boundary::BoundaryCondition;
use crate::conditions::LoadAmplitude;
use crate::exact::{Exact, KnownSolution, Pulse};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::material::{Inclusion, Material};
use crate::model::{Body, Model, Solid};
use crate::output::{Checkpoint, Output};
use crate::remark::{BuildError, ModelProblem, Remark};
use crate::scheme::{FineRegion, FineStep, Scheme};
use crate::set::Members;
use crate::stop::StopCondition;
use crate::surface::SurfaceBody;
use crate::time::{Time, TimeStep};

const POSITIVE: &str = "allowed: a positive number";
const COUNT: &str = "allowed: a whole number of at least 1";

impl Model {
    /// Refuses numbers out of their ranges, which are those of decks: a model that was read from a deck is never refused.
    ///
    /// # Errors
    /// All numbers out of their ranges, with their keys.
    pub fn check(&self) -> Result<(), BuildError> {
        let mut check = Check::default();
        let body = KeyPath::from("body");
        match &self.body {
            Body::Solid(solid) => check.solid(&body, solid),
            Body::Surface(surface) => check.surface(surface),
        }
        for set in &self.sets {
            if let Members::Region(region) = &set.members {
                check.region(&KeyPath::from("sets").key(&set.name), region);
            }
        }
        check.conditions(self);
        check.boundaries(&self.boundaries);
        if let Some(exact) = &self.exact {
            check.exact(exact);
        }
        check.time(&self.time);
        check.output(&self.output, self.body.dimension().clamp(1, 3));
        check.checkpoint(self.checkpoint);
        match check.problems.is_empty() {
            true => Ok(()),
            false => Err(BuildError::of(check.problems)),
        }
    }
}

/// What was found.
#[derive(Default)]
struct Check {
    problems: Vec<ModelProblem>,
}

impl Check {
    /// Wants a value to be in its range.
    fn within(&mut self, right: bool, key: KeyPath, value: impl ToString, allowed: &str) {
        if !right {
            let (value, allowed) = (value.to_string(), allowed.to_owned());
            let fault = Fault::OutOfRange { value, allowed };
            self.problems.push(Remark::new(key, fault));
        }
    }

    fn positive(&mut self, key: KeyPath, value: f64) {
        self.within(value > 0.0 && value.is_finite(), key, value, POSITIVE);
    }

    /// Wants a number to be between two, both excluded.
    fn between(&mut self, key: KeyPath, value: f64, [low, high]: [f64; 2]) {
        let allowed = format!("allowed: a number above {low} and below {high}");
        self.within(value > low && value < high, key, value, &allowed);
    }

    fn count(&mut self, key: KeyPath, value: impl Into<u64>) {
        let value = value.into();
        self.within(value > 0, key, value, COUNT);
    }

    fn axis(&mut self, key: KeyPath, axis: usize) {
        self.within(axis < 3, key, axis, "allowed: 0, 1 or 2");
    }

    fn engine<T>(&mut self, key: KeyPath, result: Result<T, PericlesError>) {
        if let Err(error) = result {
            self.problems.push(Remark::new(key, error.into()));
        }
    }
}

/// `[body]` and `[material]`.
impl Check {
    fn solid(&mut self, key: &KeyPath, solid: &Solid) {
        self.positive(key.key("spacing"), solid.shape.spacing());
        let section = ["body.area", "body.thickness", "body"];
        let dimension = match &solid.shape {
            SolidShape::Lattice(lattice) => {
                self.lattice(key, lattice);
                lattice.grid.dimension()
            }
            SolidShape::Points(file) => file.dimension,
        };
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

    fn lattice(&mut self, key: &KeyPath, lattice: &Lattice) {
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
            let allowed = "allowed: a spacing for each side of a box";
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
        for (k, hole) in lattice.grid.holes.iter().enumerate() {
            self.region(&key.key("hole").index(k), hole);
        }
        for (k, part) in lattice.finer.iter().enumerate() {
            let key = key.key("refine").index(k);
            let right = (2..=16).contains(&part.ratio);
            let allowed = "allowed: a whole number from 2 to 16";
            self.within(right, key.key("ratio"), part.ratio, allowed);
            self.region(&key, &part.region);
        }
    }

    fn region(&mut self, key: &KeyPath, region: &Region) {
        match region {
            Region::Cylinder { axis, .. } => self.axis(key.key("axis"), *axis),
            Region::Polygon { corners } => {
                let allowed = "allowed: at least 3 corners";
                let right = corners.len() >= 3;
                self.within(right, key.key("corners"), corners.len(), allowed);
            }
            Region::Union(parts) | Region::Intersection(parts) => {
                for part in parts {
                    self.region(key, part);
                }
            }
            Region::Complement(part) => self.region(key, part),
            Region::All
            | Region::Box { .. }
            | Region::Ball { .. }
            | Region::HalfSpace { .. }
            | Region::Layer { .. } => {}
        }
    }

    fn material(&mut self, material: &Material, state: StressState, dimension: usize) {
        let key = KeyPath::from("material");
        let bonds = &material.bonds;
        self.positive(key.key("density"), bonds.density);
        self.positive(key.key("horizon"), bonds.horizon);
        self.modulus(&key, &bonds.modulus, state);
        self.fracture(&key, &bonds.fracture);
        self.influence(&key, &bonds.influence, dimension, bonds.horizon);
        self.inclusions(&material.inclusions);
        for (k, part) in material.parts.iter().enumerate() {
            let key = key.key("part").index(k);
            self.positive(key.key("density"), part.density);
            self.modulus(&key, &part.modulus, state);
            self.fracture(&key, &part.fracture);
        }
        let pairs = material.interface.critical_stretches.iter().enumerate();
        for (k, (pair, stretch)) in pairs {
            let key = KeyPath::from("material.interface.pair").index(k);
            self.positive(key.key("critical_stretch"), *stretch);
            let known = |&number: &u8| usize::from(number) <= material.parts.len();
            let right = pair.iter().all(known) && pair[0] != pair[1];
            let allowed = "allowed: the numbers of two different materials, 0 for the body's, from 1 on for the parts'";
            self.within(right, key.key("between"), format!("{pair:?}"), allowed);
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

    fn inclusions(&mut self, inclusions: &[Inclusion]) {
        for (k, inclusion) in inclusions.iter().enumerate() {
            let key = KeyPath::from("material.inclusion").index(k);
            self.positive(key.key("stiffness"), inclusion.stiffness);
        }
    }

    fn surface(&mut self, surface: &SurfaceBody) {
        if let VertexAreas::Same(area) = surface.areas {
            self.positive("body.areas".into(), area);
        }
        let PowerMaterial {
            density,
            kappa,
            alpha,
            p,
            horizon,
            bond,
            self_cell,
            critical_stretch,
        } = surface.material;
        let key = KeyPath::from("material");
        self.positive(key.key("density"), density);
        self.positive(key.key("kappa"), kappa);
        self.between(key.key("alpha"), alpha, [0.0, 1.0]);
        let allowed = "allowed: a number of at least 2";
        self.within(p >= 2.0 && p.is_finite(), key.key("p"), p, allowed);
        self.positive(key.key("horizon"), horizon);
        let laplacian = p == 2.0 && bond == SurfaceBond::Displacement;
        let allowed = "allowed: false, unless p = 2 and bond = \"displacement\"";
        self.within(
            !self_cell || laplacian,
            key.key("self_cell"),
            "true",
            allowed,
        );
        // Infinite for bonds that never break.
        let right = critical_stretch > 0.0;
        self.within(
            right,
            key.key("critical_stretch"),
            critical_stretch,
            POSITIVE,
        );
        self.inclusions(&surface.inclusions);
    }
}

/// What acts on the body.
impl Check {
    fn conditions(&mut self, model: &Model) {
        for (k, initial) in model.initial.iter().enumerate() {
            if let Some(random) = initial.random_velocity {
                let key = KeyPath::from("initial").index(k).key("random_velocity");
                self.positive(key.key("radius"), random.radius);
            }
        }
        for (k, motion) in model.prescribe.iter().enumerate() {
            let key = KeyPath::from("prescribe").index(k);
            if let Some(until) = motion.until {
                self.positive(key.key("until"), until);
            }
        }
        for (k, load) in model.loads.iter().enumerate() {
            let key = KeyPath::from("load").index(k);
            if let LoadAmplitude::Traction {
                area: Some(area), ..
            } = load.amplitude
            {
                self.positive(key.key("area"), area);
            }
            let [from, until] = load.window();
            let allowed = "allowed: a time later than `from`";
            self.within(from < until, key.key("until"), until, allowed);
        }
    }

    fn boundaries(&mut self, boundaries: &[BoundaryCondition]) {
        for (k, boundary) in boundaries.iter().enumerate() {
            let key = KeyPath::from("boundary").index(k);
            match boundary {
                BoundaryCondition::Absorbing {
                    plan,
                    exterior_data,
                    ..
                } => {
                    if let Some(tolerance) = plan.tolerance {
                        self.between(key.key("tolerance"), tolerance, [1e-14, 1.0]);
                    }
                    if let Some(depth) = exterior_data {
                        self.positive(key.key("exterior_data"), *depth);
                    }
                }
                BoundaryCondition::DampingLayer {
                    thickness,
                    reflection,
                    power,
                    ..
                } => {
                    self.positive(key.key("thickness"), *thickness);
                    self.between(key.key("reflection"), *reflection, [1e-12, 1.0]);
                    let right = (0.0..=10.0).contains(power);
                    let allowed = "allowed: a number from 0 to 10";
                    self.within(right, key.key("power"), power, allowed);
                }
            }
        }
    }

    fn exact(&mut self, exact: &Exact) {
        let key = KeyPath::from("exact");
        let length = match exact.solution {
            KnownSolution::NonlocalPulse { pulse, length } => {
                self.positive(key.key("width"), pulse.width);
                length
            }
            KnownSolution::LocalPulse(Pulse { width, .. }) => width,
            KnownSolution::StretchedBar { length, .. } | KnownSolution::BarMode { length, .. } => {
                length
            }
        };
        self.positive(key.key("length"), length);
        if let Some(window) = exact.window {
            self.positive(key.key("window"), window);
        }
    }
}

/// `[time]`, `[output]` and `[checkpoint]`.
impl Check {
    fn time(&mut self, time: &Time) {
        let key = KeyPath::from("time");
        self.positive(key.key("end"), time.end);
        match time.step {
            TimeStep::Auto { safety } => {
                let right = safety > 0.0 && safety <= 1.0;
                let allowed = "allowed: a number above 0 and at most 1";
                self.within(right, key.key("safety"), safety, allowed);
            }
            TimeStep::Fixed(dt) => self.positive(key.key("dt"), dt),
            TimeStep::Equal(count) => self.count(key.key("load_steps"), count),
        }
        match &time.scheme {
            Scheme::RungeKutta3 { alpha } => self.alpha(&key, *alpha),
            Scheme::MultiTimeStep3 { alpha, fine, .. } => {
                self.alpha(&key, *alpha);
                self.fine(&key, fine);
            }
            Scheme::MultiTimeStep4 { fine, .. } | Scheme::Respa { fine } => self.fine(&key, fine),
            Scheme::DormandPrince { tolerance } | Scheme::DiscreteGradient { tolerance } => {
                self.between(key.key("tolerance"), *tolerance, [0.0, 1.0]);
            }
            Scheme::Newmark(options) => {
                self.positive(key.key("tolerance"), options.tolerance);
                self.count(key.key("iterations"), options.iterations);
            }
            Scheme::Relaxation(options) => {
                self.between(key.key("tolerance"), options.tolerance, [0.0, 1.0]);
                self.count(key.key("iterations"), options.iterations);
            }
            Scheme::VelocityVerlet
            | Scheme::RungeKutta4
            | Scheme::Implicit { .. }
            | Scheme::Trigonometric(_) => {}
        }
        for (k, stop) in time.stop_when.iter().enumerate() {
            let key = key.key("stop_when").index(k);
            match stop.condition {
                StopCondition::ReactionBelow(share) => {
                    self.between(key.key("reaction_below"), share, [0.0, 1.0]);
                }
                StopCondition::DamageAbove(damage) => {
                    let allowed = "allowed: a damage of at least 0 and below 1";
                    let right = (0.0..1.0).contains(&damage);
                    self.within(right, key.key("damage_above"), damage, allowed);
                }
            }
        }
    }

    fn alpha(&mut self, key: &KeyPath, alpha: f64) {
        let right = alpha != 0.0 && alpha.is_finite();
        self.within(right, key.key("alpha"), alpha, "allowed: any number but 0");
    }

    fn fine(&mut self, key: &KeyPath, fine: &FineStep) {
        self.count(key.key("ratio"), fine.ratio);
        if let FineRegion::Adaptive(follow) = &fine.region {
            let key = key.key("adaptive");
            self.count(key.key("every"), follow.every);
            self.count(key.key("layers"), follow.layers);
            self.between(key.key("threshold"), follow.threshold, [0.0, 1.0]);
        }
    }

    fn output(&mut self, output: &Output, dimension: usize) {
        let key = KeyPath::from("output");
        self.schedule(&key.key("fields"), output.fields);
        self.schedule(&key.key("history"), output.history);
        self.schedule(&key.key("fragments"), output.fragments.schedule);
        if let Some(cracks) = output.cracks {
            self.schedule(&key.key("cracks"), cracks.schedule);
        }
        for (field, component) in &output.extremes {
            self.component(
                key.key("history").key("extremes"),
                *field,
                *component,
                dimension,
            );
        }
        if let Some(rate) = output.energy_bound {
            self.positive(key.key("energy_bound"), rate);
        }
        for (k, picture) in output.pictures.iter().enumerate() {
            let key = key.key("picture").index(k);
            self.schedule(&key, picture.schedule);
            self.component(
                key.key("field"),
                picture.field,
                picture.component,
                dimension,
            );
        }
    }

    /// Wants a component of a field to exist.
    fn component(
        &mut self,
        key: KeyPath,
        field: Field,
        component: Option<usize>,
        dimension: usize,
    ) {
        if let Some(component) = component {
            let known = field.components(dimension).len();
            let allowed = format!("allowed: a component below {known}");
            self.within(component < known, key, component, &allowed);
        }
    }

    fn schedule(&mut self, key: &KeyPath, schedule: Schedule) {
        match schedule {
            Schedule::Never => {}
            Schedule::Every(steps) => self.count(key.key("every"), steps),
            Schedule::Interval(interval) => self.positive(key.key("interval"), interval),
            Schedule::Count(count) => self.count(key.key("count"), count),
        }
    }

    fn checkpoint(&mut self, checkpoint: Checkpoint) {
        let key = KeyPath::from("checkpoint");
        match checkpoint {
            Checkpoint::Wall(seconds) => self.positive(key.key("wall"), seconds),
            Checkpoint::Every(steps) => self.count(key.key("every"), steps),
            Checkpoint::Interval(interval) => self.positive(key.key("interval"), interval),
        }
    }
}
