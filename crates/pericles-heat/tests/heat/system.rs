//! The field as a part of a system: expansion, broken bonds, checkpoints.

use std::sync::Arc;

use pericles::material::StressState;
use pericles::operator::{BondBody, BondForm};
use pericles::prelude::*;
use pericles::round_trip::check_resume;
use pericles::{PointScalar, ThermalExpansion};
use pericles_heat::{DiffusingField, FieldOptions, FixedBody, Problem, Scheme};

use crate::support::*;

pub fn bar(cells: usize, dx: f64) -> System {
    let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3.0 * dx);
    Body::new(
        Grid::bar(cells as f64 * dx, dx, 2e-4).points().unwrap(),
        steel,
    )
    .build()
    .unwrap()
}

/// A bar whose left end is hot; velocities, temperatures and expansion are coupled.
fn coupled(scheme: Scheme, step: Option<f64>) -> Simulation {
    let dx = 1e-3;
    let cloud = box_of(1, 40, dx);
    let diffusion = body(cloud.clone(), 3.0 * dx, 45e3).build().unwrap();
    let capacity = cloud
        .volumes()
        .iter()
        .map(|volume| 3.6e6 * volume)
        .collect();
    let problem = Problem::new(
        diffusion,
        capacity,
        vec![prescribed("left", vec![0, 1, 2], 400.0)],
    )
    .unwrap();
    let field = DiffusingField::new(
        problem,
        FieldOptions {
            scheme,
            step,
            dissipation: 0.0,
        },
        0.0,
        vec![300.0; cloud.len()],
    )
    .unwrap();
    let expansion = ThermalExpansion::new(
        cloud.clone(),
        Arc::new(field.shared()),
        300.0,
        PointScalar::Uniform(12e-6),
    )
    .unwrap();
    let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3.0 * dx);
    let constants = steel.constants(&cloud, StressState::Uniaxial).unwrap();
    let bonds = BondBody::new(&cloud, &steel, &constants)
        .operator(BondForm::List)
        .unwrap();
    let mut force = bonds.operator;
    force.expand(expansion).unwrap();
    let mut system = System::new(cloud, force, PointScalar::Uniform(7850.0)).unwrap();
    system.add_field(Box::new(field)).unwrap();
    Simulation::builder(system).end(4e-6).build().unwrap()
}

#[test]
fn a_resumed_run_with_conduction_and_expansion_is_bitwise_identical() {
    for scheme in [Scheme::Explicit, Scheme::Trapezoidal] {
        for step in [None, Some(3.3e-7)] {
            check_resume(|| coupled(scheme, step), [2, 9]).unwrap();
        }
    }
    let end = check_resume(|| coupled(Scheme::Explicit, None), [3]).unwrap();
    let u = end.f64s("state/u").unwrap();
    assert!(largest(u) > 0.0);
}

#[test]
fn a_fixed_body_only_conducts() {
    let dx = 1e-3;
    let mut system = bar(30, dx);
    let cloud = Arc::clone(system.cloud());
    let diffusion = body(cloud.clone(), 3.0 * dx, 45.0).build().unwrap();
    let capacity = cloud
        .volumes()
        .iter()
        .map(|volume| 3.6e6 * volume)
        .collect();
    let problem = Problem::new(diffusion, capacity, vec![]).unwrap();
    let options = FieldOptions {
        scheme: Scheme::Trapezoidal,
        step: None,
        dissipation: 0.0,
    };
    let field = DiffusingField::new(problem, options, 0.0, noise(cloud.len())).unwrap();
    let shared = field.shared();
    system.add_field(Box::new(field)).unwrap();
    let state = State::of(&system);
    let mut run = Simulation::new(system, Box::new(FixedBody), state, 0.5, 100).unwrap();
    run.run_to_end().unwrap();
    assert!(run.state().u.iter().all(|u| *u == 0.0));
    assert_eq!(run.system().evaluated_points(), 0);
    let [low, high] = shared.range(50.0);
    assert!(high - low < 1.0, "{low} {high}");
    let (before, after) = (shared.initial_content(), shared.content(50.0));
    assert!((after / before - 1.0).abs() < 1e-13);
}

#[test]
fn a_crack_insulates() {
    let dx = 1e-3;
    for share in [0.0, 0.5] {
        let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3.0 * dx);
        let crack = pericles::family::Crack::Segment {
            from: [-1.0, 0.01],
            to: [1.0, 0.01],
        };
        let plate = Grid::plate([0.02, 0.02], dx, 1e-3).points().unwrap();
        let mut system = Body::new(plate, steel)
            .stress_state(StressState::PlaneStress)
            .crack(crack)
            .build()
            .unwrap();
        let cloud = Arc::clone(system.cloud());
        let start: Vec<f64> = cloud
            .axis(1)
            .iter()
            .map(|&y| if y < 0.01 { 400.0 } else { 300.0 })
            .collect();
        let description = pericles_heat::DiffusionBody {
            broken_share: share,
            ..body(cloud.clone(), 3.0 * dx, 45.0)
        };
        let capacity = cloud
            .volumes()
            .iter()
            .map(|volume| 3.6e6 * volume)
            .collect();
        let problem = Problem::new(description.build().unwrap(), capacity, vec![]).unwrap();
        let options = FieldOptions {
            scheme: Scheme::Explicit,
            step: None,
            dissipation: 0.0,
        };
        let field = DiffusingField::new(problem, options, 0.0, start.clone()).unwrap();
        let shared = field.shared();
        system.add_field(Box::new(field)).unwrap();
        let mut values = vec![0.0; cloud.len()];
        pericles::Temperature::temperatures_into(&shared, 1.0, &mut values);
        let change = largest_difference(&values, &start);
        match share {
            0.0 => assert_eq!(change, 0.0),
            _ => assert!(change > 1.0, "{change}"),
        }
    }
}
