//! Time integration: orders, conservation, independence of what was evaluated before.

use std::f64::consts::PI;
use std::sync::Arc;

use pericles::Temperature;
use pericles_heat::{Condition, DiffusingField, Exchange, FieldOptions, Kind, Problem, Scheme};

use crate::support::*;

/// A periodic bar with a cosine wave, and its decay rate 1/s.
fn wave() -> (Problem, Vec<f64>, f64) {
    let (cells, dx) = (24, 1e-3);
    let cloud = periodic(1, cells, dx);
    let diffusion = body(cloud.clone(), 3e-3, 45.0).build().unwrap();
    let capacity = 3.6e6 * cloud.volumes()[0];
    let values: Vec<f64> = (0..cells)
        .map(|i| 300.0 + 10.0 * (2.0 * PI * cloud.point(i)[0] / (cells as f64 * dx)).cos())
        .collect();
    let flow = flow(&diffusion, &values);
    let rate = -flow[0] / (capacity * (values[0] - 300.0));
    (
        Problem::new(diffusion, vec![capacity; cells], vec![]).unwrap(),
        values,
        rate,
    )
}

fn advanced(scheme: Scheme, steps: u32, end: f64) -> (Vec<f64>, f64) {
    let (problem, values, rate) = wave();
    let options = FieldOptions {
        scheme,
        step: Some(end / f64::from(steps)),
        dissipation: 0.0,
    };
    let field = DiffusingField::new(problem, options, 0.0, values.clone())
        .unwrap()
        .shared();
    let mut out = vec![0.0; values.len()];
    field.temperatures_into(end, &mut out);
    let decay = (-rate * end).exp();
    let exact: Vec<f64> = values
        .iter()
        .map(|value| 300.0 + (value - 300.0) * decay)
        .collect();
    (out.clone(), largest_difference(&out, &exact))
}

#[test]
fn the_observed_orders_are_those_of_the_schemes() {
    let (problem, values, rate) = wave();
    let end = 1.0 / rate;
    let limit = problem.explicit_limit(&values);
    let coarse = (end / (0.9 * limit)).ceil() as u32;
    for (scheme, steps, order) in [
        (Scheme::Explicit, coarse, 1.0),
        (Scheme::BackwardEuler, 40, 1.0),
        (Scheme::Trapezoidal, 10, 2.0),
    ] {
        let errors = [1, 2, 4].map(|finer| advanced(scheme, finer * steps, end).1);
        for pair in errors.windows(2) {
            let observed = (pair[0] / pair[1]).log2();
            assert!((observed - order).abs() < 0.1, "{scheme:?}: {errors:?}");
        }
    }
}

#[test]
fn explicit_sub_steps_remain_stable_and_within_the_initial_range_for_any_step() {
    let (problem, _, _) = wave();
    let limit = problem.explicit_limit(&noise(24));
    let options = FieldOptions {
        scheme: Scheme::Explicit,
        step: None,
        dissipation: 0.0,
    };
    let start = noise(24);
    let low = start.iter().copied().fold(f64::INFINITY, f64::min);
    let high = start.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for factor in [0.3, 1.0, 7.7, 200.0] {
        let (problem, _, _) = wave();
        let field = DiffusingField::new(problem, options, 0.0, start.clone())
            .unwrap()
            .shared();
        let mut out = vec![0.0; 24];
        field.temperatures_into(factor * limit, &mut out);
        assert!(
            out.iter().all(|value| (low..=high).contains(value)),
            "{factor}"
        );
    }
}

/// A plate with every kind of condition.
fn plate(scheme: Scheme, step: Option<f64>) -> DiffusingField {
    let cloud = box_of(2, 20, 1e-3);
    let layer = |axis: usize, low: f64, high: f64| -> Vec<u32> {
        let inside = |i: &u32| (low..high).contains(&cloud.point(*i as usize)[axis]);
        (0..cloud.len() as u32).filter(inside).collect()
    };
    let (left, right) = (layer(0, 0.0, 3e-3), layer(0, 17e-3, 20e-3));
    let (bottom, top) = (layer(1, 0.0, 1e-3), layer(1, 19e-3, 20e-3));
    let area = |points: &[u32]| vec![20e-3 * 3e-3 / points.len() as f64; points.len()];
    let conditions = vec![
        Condition {
            name: "left".into(),
            points: left,
            kind: Kind::Prescribed(Arc::new(|_, t| 300.0 + 50.0 * t)),
        },
        Condition {
            name: "right".into(),
            kind: Kind::Exchange {
                law: Exchange::Linear,
                coefficient: 5e3,
                ambient: number(350.0),
                area: area(&right),
            },
            points: right,
        },
        Condition {
            name: "bottom".into(),
            kind: Kind::Exchange {
                law: Exchange::FourthPower,
                coefficient: 0.9 * 5.670_374_419e-8,
                ambient: number(1200.0),
                area: area(&bottom),
            },
            points: bottom,
        },
        Condition {
            name: "top".into(),
            kind: Kind::Inflow {
                density: Arc::new(|_, t| 1e5 * t),
                measure: area(&top),
            },
            points: top,
        },
        Condition {
            name: "all".into(),
            points: (0..cloud.len() as u32).collect(),
            kind: Kind::Inflow {
                density: number(-2e6),
                measure: cloud.volumes().to_vec(),
            },
        },
    ];
    let diffusion = body(cloud.clone(), 3e-3, 45.0).build().unwrap();
    let capacity = cloud
        .volumes()
        .iter()
        .map(|volume| 3.6e6 * volume)
        .collect();
    let problem = Problem::new(diffusion, capacity, conditions).unwrap();
    DiffusingField::new(
        problem,
        FieldOptions {
            scheme,
            step,
            dissipation: 0.0,
        },
        0.0,
        noise(cloud.len()),
    )
    .unwrap()
}

#[test]
fn content_and_inflows_balance_for_every_condition_and_unsteady_scheme() {
    for (scheme, step) in [
        (Scheme::Explicit, None),
        (Scheme::Trapezoidal, Some(0.02)),
        (Scheme::BackwardEuler, Some(0.03)),
    ] {
        let field = plate(scheme, step).shared();
        let before = field.content(0.0);
        for t in [0.011, 0.1, 0.5] {
            let (content, flows) = (field.content(t), field.flows(t));
            let inflow: f64 = flows.iter().sum();
            let scale: f64 = content.abs().max(flows.iter().map(|flow| flow.abs()).sum());
            let error = (content - before - inflow) / scale;
            assert!(error.abs() < 1e-12, "{scheme:?} t = {t}: {error:e}");
        }
        let flows = field.flows(0.5);
        assert!(flows.iter().all(|flow| *flow != 0.0), "{flows:?}");
    }
}

#[test]
fn the_values_at_a_time_do_not_depend_on_what_was_evaluated_before() {
    for scheme in [
        Scheme::Explicit,
        Scheme::Trapezoidal,
        Scheme::BackwardEuler,
        Scheme::Steady,
    ] {
        for step in [None, Some(0.05)] {
            let n = 400;
            let at = |field: &DiffusingField, t: f64| {
                let mut out = vec![0.0; n];
                field.shared().temperatures_into(t, &mut out);
                out
            };
            let direct = at(&plate(scheme, step), 0.07);
            let wandering = plate(scheme, step);
            for t in [0.2, 0.0, 0.03, 0.07, 0.111] {
                at(&wandering, t);
            }
            assert_eq!(at(&wandering, 0.07), direct, "{scheme:?} {step:?}");
        }
    }
}

#[test]
fn a_steady_state_is_the_limit_of_implicit_steps() {
    let cloud = box_of(2, 16, 1e-3);
    let make = |scheme, step| {
        let left = (0..cloud.len() as u32)
            .filter(|&i| cloud.point(i as usize)[0] < 3e-3)
            .collect();
        let right: Vec<u32> = (0..cloud.len() as u32)
            .filter(|&i| cloud.point(i as usize)[0] > 13e-3)
            .collect();
        let conditions = vec![
            prescribed("left", left, 290.0),
            Condition {
                name: "right".into(),
                kind: Kind::Exchange {
                    law: Exchange::FourthPower,
                    coefficient: 5.670_374_419e-8,
                    ambient: number(1500.0),
                    area: vec![16e-3 * 3e-3 / right.len() as f64; right.len()],
                },
                points: right,
            },
        ];
        let diffusion = body(cloud.clone(), 3e-3, 45.0).build().unwrap();
        let capacity = cloud
            .volumes()
            .iter()
            .map(|volume| 3.6e6 * volume)
            .collect();
        let problem = Problem::new(diffusion, capacity, conditions).unwrap();
        DiffusingField::new(
            problem,
            FieldOptions {
                scheme,
                step,
                dissipation: 0.0,
            },
            0.0,
            vec![300.0; cloud.len()],
        )
        .unwrap()
    };
    let mut steady = vec![0.0; cloud.len()];
    make(Scheme::Steady, None)
        .shared()
        .temperatures_into(1.0, &mut steady);
    let mut late = vec![0.0; cloud.len()];
    make(Scheme::BackwardEuler, Some(500.0))
        .shared()
        .temperatures_into(5e3, &mut late);
    assert!(
        largest_difference(&steady, &late) < 1e-8,
        "{:e}",
        largest_difference(&steady, &late)
    );
    assert!(largest(&steady) > 300.0);
}

#[test]
fn a_steady_state_without_a_given_temperature_is_rejected() {
    let (problem, values, _) = wave();
    let options = FieldOptions {
        scheme: Scheme::Steady,
        step: None,
        dissipation: 0.0,
    };
    let mut field = DiffusingField::new(problem, options, 0.0, values).unwrap();
    let mut out = vec![0.0; 24];
    field.shared().temperatures_into(1.0, &mut out);
    assert!(out.iter().all(|value| value.is_nan()));
    let force = crate::system::bar(24, 1e-3);
    let body = pericles::BodyStep {
        t: 1.0,
        forces: force.operator(),
        dissipated: &[],
    };
    let error = pericles::SecondaryField::end_step(&mut field, body).unwrap_err();
    assert!(error.to_string().contains("not unique"), "{error}");
}

/// Largest number of products of a linear solution for the steady state between two faces.
fn products(dimension: usize, cells: usize) -> u64 {
    let cloud = box_of(dimension, cells, 1e-3);
    let side = cells as f64 * 1e-3;
    let layer = |low: f64, high: f64| -> Vec<u32> {
        let inside = |i: &u32| (low..high).contains(&cloud.axis(0)[*i as usize]);
        (0..cloud.len() as u32).filter(inside).collect()
    };
    let conditions = vec![
        prescribed("left", layer(0.0, 3e-3), 400.0),
        prescribed("right", layer(side - 3e-3, side), 300.0),
    ];
    let diffusion = body(cloud.clone(), 3e-3, 45.0).build().unwrap();
    let capacity = cloud
        .volumes()
        .iter()
        .map(|volume| 3.6e6 * volume)
        .collect();
    let problem = Problem::new(diffusion, capacity, conditions).unwrap();
    let options = FieldOptions {
        scheme: Scheme::Steady,
        step: None,
        dissipation: 0.0,
    };
    let start = noise(cloud.len());
    let field = DiffusingField::new(problem, options, 0.0, start).unwrap();
    let shared = field.shared();
    shared.content(1.0);
    shared.effort().most
}

#[test]
fn the_products_of_a_steady_state_do_not_grow_with_the_body() {
    let plates = [40, 80, 160].map(|cells| products(2, cells));
    let blocks = [12, 24].map(|cells| products(3, cells));
    eprintln!("products: {plates:?} {blocks:?}");
    assert!(
        plates.iter().chain(&blocks).all(|products| *products <= 20),
        "{plates:?} {blocks:?}"
    );
}

#[test]
fn long_implicit_steps_of_good_conductors_reach_the_accuracy_of_rounding() {
    // The temperature rises uniformly by flux · area · t/content; the difference across the bar vanishes with 1/k.
    let (cells, dx, flux, end) = (30, 1e-3, 1e4, 40.0);
    let cloud = box_of(2, cells, dx);
    let volume = cloud.volumes()[0];
    let heated: Vec<u32> = (0..cloud.len() as u32)
        .filter(|&i| cloud.point(i as usize)[1] > (cells as f64 - 1.0) * dx)
        .collect();
    let area = volume / dx;
    for k in [1e2, 1e5, 1e8] {
        for scheme in [Scheme::BackwardEuler, Scheme::Trapezoidal] {
            let body = pericles_heat::DiffusionBody {
                surface_correction: true,
                ..body(cloud.clone(), 3.0 * dx, k)
            };
            let condition = Condition {
                name: "top".into(),
                points: heated.clone(),
                kind: Kind::Inflow {
                    density: number(flux),
                    measure: vec![area; heated.len()],
                },
            };
            let capacity = vec![3.6e6 * volume; cloud.len()];
            let problem = Problem::new(body.build().unwrap(), capacity, vec![condition]).unwrap();
            let options = FieldOptions {
                scheme,
                step: Some(1.0),
                dissipation: 0.0,
            };
            let field = DiffusingField::new(problem, options, 0.0, vec![500.0; cloud.len()]);
            let mut values = vec![0.0; cloud.len()];
            field.unwrap().shared().temperatures_into(end, &mut values);
            let rise =
                flux * area * heated.len() as f64 * end / (3.6e6 * volume * cloud.len() as f64);
            let mean = values.iter().sum::<f64>() / cloud.len() as f64;
            assert!(
                ((mean - 500.0) / rise - 1.0).abs() < 1e-9,
                "{k} {scheme:?}: {mean}"
            );
            // The last change of the temperature is computed from the flows, with their rounding errors.
            let rounding = 1e-14 * mean * k / (3.6e6 * dx * dx);
            let farthest = values
                .iter()
                .fold(0.0, |most: f64, t| most.max((t - mean).abs()));
            let allowed = 2.0 * flux * cells as f64 * dx / k + rounding;
            assert!(farthest < allowed, "{k}: {farthest:e}, {allowed:e}");
        }
    }
}
