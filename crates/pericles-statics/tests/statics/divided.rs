//! Static states of bodies divided among several processes are bitwise identical to those of a single process, with the same
//! numbers of iterations.

use std::sync::Arc;

use pericles::PointScalar;
use pericles::division::part_of;
use pericles::domain::{Comm, Threads};
use pericles::family::{EndRule, VolumeCorrection};
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, GivenConstants, LinearSolid, StateInfluence, Strains, StressState,
};
use pericles::operator::{BondForm, LinearSolidBody};
use pericles::prelude::*;
use pericles_statics::{BreakingRule, StaticOptions, StaticScheme};

use crate::bodies::points;

const REACH: f64 = 3.6;

/// A plate with a hole, without symmetry.
fn plate() -> Arc<PointCloud> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![22.0, 15.0],
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![Region::Ball {
            centre: [14.0, 9.0, 0.0],
            radius: 1.7,
        }],
    };
    Arc::new(grid.points().unwrap())
}

fn block() -> Arc<PointCloud> {
    Arc::new(Grid::block([9.0, 6.0, 5.0], 1.0).points().unwrap())
}

/// The part of a process: oblique stripes, so that no part is a range of numbers or a box.
fn part(whole: &Arc<PointCloud>, comm: Arc<dyn Comm>) -> Arc<PointCloud> {
    let size = comm.size();
    let [_, end] = whole.bounds();
    let owner = |k: usize| {
        let [x, y, _] = whole.point(k);
        ((x + 0.4 * y) / (end[0] + 0.4 * end[1]) * size as f64) as u32
    };
    let owners: Vec<u32> = (0..whole.len())
        .map(|k| owner(k).min(size as u32 - 1))
        .collect();
    Arc::new(part_of(whole, &owners, REACH, comm).unwrap())
}

/// Forces of a body and its failure.
#[derive(Clone, Copy)]
enum Material {
    Bonds(PairLaw, BondForm, Option<f64>),
    Solid(Strains, BondForm, BondFailure),
}

#[derive(Clone, Copy)]
struct Case {
    body: fn() -> Arc<PointCloud>,
    material: Material,
    breaking: BreakingRule,
    /// Whether opposite loads act on a body without constraints, instead of displacements of its ends.
    is_free: bool,
    steps: u64,
}

fn notch() -> Crack {
    Crack::Segment {
        from: [0.0, 7.0],
        to: [6.0, 7.0],
    }
}

impl Case {
    fn new(body: fn() -> Arc<PointCloud>, material: Material) -> Self {
        Self {
            body,
            material,
            breaking: BreakingRule::default(),
            is_free: false,
            steps: 2,
        }
    }

    /// The force of the points of a process; constants belong to the whole body.
    fn system(&self, whole: &PointCloud, cloud: &Arc<PointCloud>) -> System {
        let in_plane = whole.dimension() == 2;
        let state = if in_plane {
            StressState::PlaneStress
        } else {
            StressState::Spatial
        };
        match self.material {
            Material::Bonds(law, form, stretch) => {
                let mut material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0);
                material.law = law;
                if let Some(stretch) = stretch {
                    material = material.with_critical_stretch(stretch);
                }
                let mut body = Body::new(cloud.clone(), material).stress_state(state);
                if in_plane {
                    body = body.crack(notch());
                }
                body.form(form).build().unwrap()
            }
            Material::Solid(strains, form, failure) => {
                let solid = LinearSolid {
                    density: 1.0,
                    elastic: GivenConstants {
                        young: Some(1.0),
                        poisson_ratio: Some(0.3),
                        ..GivenConstants::default()
                    },
                    horizon: 3.0,
                    influence: StateInfluence::Function(InfluenceFunction::Conical),
                    volume_correction: VolumeCorrection::Linear,
                    failure,
                };
                let constants = solid.constants(whole, state).unwrap();
                let cracks = [(notch(), EndRule::Closed)];
                let body = LinearSolidBody {
                    strains,
                    cracks: if in_plane { &cracks } else { &[] },
                    ..LinearSolidBody::new(cloud, &constants, VolumeCorrection::Linear)
                };
                let force = body.operator(form).unwrap().operator;
                System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap()
            }
        }
    }

    /// Adds loads and supports on own points.
    fn act(&self, whole: &PointCloud, system: &mut System) {
        let top = whole.bounds()[1][1] - 1.5;
        let cloud = system.cloud().clone();
        let ramp = TimeFunction::Ramp {
            start: 0.0,
            duration: 1.0,
        };
        let ends = [
            points(&cloud, |x| x[1] > top),
            points(&cloud, |x| x[1] < 1.5),
        ];
        for (set, sign) in ends.into_iter().zip([1.0, -1.0]) {
            if self.is_free {
                let load = Load::new(set, [0.0, 1e-3 * sign, 0.0], ramp.clone());
                system.add_load(load).unwrap();
            } else {
                let across = (whole.dimension() == 3).then_some(0.0);
                let along = [Some(0.0), Some(0.1 * sign), across];
                system
                    .add_motion(PrescribedMotion::displacement(set, along, ramp.clone()))
                    .unwrap();
            }
        }
        if !self.is_free {
            let load = Load::new(points(&cloud, |x| x[0] > 6.0), [2e-4, 0.0, 0.0], ramp);
            system.add_load(load).unwrap();
        }
    }

    /// Runs the part of a process; returns its points, the displacements after each step, and numbers that all processes agree
    /// on.
    fn run(
        &self,
        whole: &PointCloud,
        cloud: Arc<PointCloud>,
    ) -> (Vec<usize>, Vec<Vec<u64>>, Vec<u64>) {
        let mut system = self.system(whole, &cloud);
        self.act(whole, &mut system);
        let options = StaticOptions {
            breaking: self.breaking,
            fix_rigid_modes: self.is_free,
            ..StaticOptions::default()
        };
        let scheme = StaticScheme::new(options, &system).unwrap();
        let state = State::of(&system);
        let dt = 1.0 / self.steps as f64;
        let mut run = Simulation::new(system, Box::new(scheme), state, dt, self.steps).unwrap();
        let (mut states, mut agreed) = (Vec::new(), Vec::new());
        run.run(|now| {
            let bits = now.state().u.iter().map(|u| u.to_bits());
            states.push(bits.collect());
            let iterations = now.integrator().inner_iterations().unwrap();
            let energies = now.snapshot().energies();
            let factor = now.system().load_factor().unwrap_or_default();
            let numbers = [energies.elastic, energies.work, energies.dissipated, factor];
            agreed.extend(numbers.map(f64::to_bits));
            agreed.extend([iterations.total, now.system().operator().broken_bonds()]);
            Control::Continue
        })
        .unwrap();
        let number = |k| cloud.domain().number(k);
        ((0..cloud.len()).map(number).collect(), states, agreed)
    }

    /// Compares runs on one to four processes with that of an undivided body; returns the number of broken bonds.
    fn check(&self, name: &str) -> u64 {
        let whole = (self.body)();
        let (n, d) = (whole.len(), whole.dimension());
        let (_, expected, agreed) = self.run(&whole, whole.clone());
        assert!(agreed[4] > 0, "{name}: no iterations");
        for size in [1, 2, 3, 4] {
            let parts = Threads::run(size, |comm| self.run(&whole, part(&whole, comm)));
            let mut found = vec![vec![0; d * n]; expected.len()];
            for (numbers, states, own) in &parts {
                assert_eq!(own, &agreed, "{name}, {size} processes");
                for (found, own) in found.iter_mut().zip(states) {
                    for (k, &u) in own.iter().enumerate() {
                        let (c, i) = (k / numbers.len(), k % numbers.len());
                        found[c * n + numbers[i]] = u;
                    }
                }
            }
            assert!(found == expected, "{name}, {size} processes");
        }
        agreed[agreed.len() - 1]
    }
}

#[test]
fn linear_bodies_of_lists_and_stencils_are_divided() {
    for form in [BondForm::List, BondForm::Grid] {
        let bonds = Material::Bonds(PairLaw::Linear, form, None);
        let solid = Material::Solid(Strains::Small, form, BondFailure::Unbreakable);
        for (name, material) in [("bonds", bonds), ("solid", solid)] {
            Case::new(plate, material).check(&format!("{name}, {form:?}"));
        }
        Case::new(block, bonds).check(&format!("block, {form:?}"));
    }
}

#[test]
fn nonlinear_bodies_are_divided() {
    let bonds = Material::Bonds(PairLaw::BondStretch, BondForm::Grid, None);
    let solid = Material::Solid(Strains::Finite, BondForm::Grid, BondFailure::Unbreakable);
    Case::new(plate, bonds).check("bonds");
    Case::new(block, solid).check("solid");
}

#[test]
fn bodies_without_constraints_are_divided() {
    for (name, body) in [
        ("plate", plate as fn() -> Arc<PointCloud>),
        ("block", block),
    ] {
        let material = Material::Bonds(PairLaw::Linear, BondForm::Fastest, None);
        let case = Case {
            is_free: true,
            ..Case::new(body, material)
        };
        case.check(name);
    }
}

#[test]
fn quasi_static_fracture_is_divided() {
    let bonds = |law| Material::Bonds(law, BondForm::List, Some(0.01));
    let solid = Material::Solid(
        Strains::Small,
        BondForm::Grid,
        BondFailure::CriticalStretch(0.01),
    );
    for (name, material) in [
        ("linear", bonds(PairLaw::Linear)),
        ("nonlinear", bonds(PairLaw::BondStretch)),
        ("solid", solid),
    ] {
        let events = Case {
            breaking: BreakingRule::events(1.0),
            steps: 4,
            ..Case::new(plate, material)
        };
        assert!(events.check(&format!("events, {name}")) > 0, "{name}");
        let steps = Case::new(plate, material);
        assert!(steps.check(&format!("load steps, {name}")) > 0, "{name}");
    }
}
