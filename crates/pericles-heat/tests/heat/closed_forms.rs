//! Closed forms of Fourier's law: slabs with fixed and insulated ends, a half-space with convection.

use std::f64::consts::PI;

use pericles::Temperature;
use pericles_heat::{
    Condition, DiffusingField, DiffusionBody, Exchange, FieldOptions, Kind, Problem, Scheme,
};

use crate::support::*;

const K: f64 = 45.0;
const CAPACITY: f64 = 3.6e6;
const LENGTH: f64 = 0.1;

fn field(
    body: &DiffusionBody,
    conditions: Vec<Condition>,
    start: &dyn Fn(f64) -> f64,
    step: f64,
) -> DiffusingField {
    let cloud = &body.cloud;
    let capacity = cloud
        .volumes()
        .iter()
        .map(|volume| CAPACITY * volume)
        .collect();
    let problem = Problem::new(body.build().unwrap(), capacity, conditions).unwrap();
    let options = FieldOptions {
        scheme: Scheme::Trapezoidal,
        step: Some(step),
        dissipation: 0.0,
    };
    let values = cloud.axis(0).iter().map(|&x| start(x)).collect();
    DiffusingField::new(problem, options, 0.0, values).unwrap()
}

/// Largest error at time t relative to 100 K at points between 0 and LENGTH.
fn error(field: &DiffusingField, body: &DiffusionBody, t: f64, exact: &dyn Fn(f64) -> f64) -> f64 {
    let mut values = vec![0.0; body.cloud.len()];
    field.shared().temperatures_into(t, &mut values);
    let places = body.cloud.axis(0).iter().zip(&values);
    let inside = places.filter(|(x, _)| (0.0..LENGTH).contains(*x));
    inside.fold(0.0, |most: f64, (x, value)| {
        most.max((value - exact(*x)).abs() / 100.0)
    })
}

fn orders(errors: &[f64]) -> Vec<f64> {
    errors
        .windows(2)
        .map(|pair| (pair[0] / pair[1]).log2())
        .collect()
}

/// A bar from −δ to LENGTH + δ, whose outer layers continue the field as an odd function beyond the ends.
#[test]
fn a_slab_with_fixed_ends_follows_the_fourier_series_with_order_two() {
    let diffusivity = K / CAPACITY;
    let t = 0.1 * LENGTH * LENGTH / diffusivity;
    let at_m = |cells: usize, m: usize| {
        let dx = LENGTH / cells as f64;
        let cloud = {
            let grid = pericles::space::Grid {
                shape: pericles::space::Shape::Box {
                    origin: [-(m as f64) * dx, 0.0, 0.0],
                    size: vec![LENGTH + 2.0 * m as f64 * dx],
                },
                spacing: dx,
                section: 1e-4,
                holes: vec![],
            };
            std::sync::Arc::new(grid.points().unwrap())
        };
        let body = body(cloud.clone(), m as f64 * dx, K);
        let outer: Vec<u32> = (0..cloud.len() as u32)
            .filter(|&i| !(0.0..LENGTH).contains(&cloud.axis(0)[i as usize]))
            .collect();
        let exact = move |x: f64, t: f64| {
            let term = |n: f64| {
                (n * PI * x / LENGTH).sin() * (-(n * PI / LENGTH).powi(2) * diffusivity * t).exp()
            };
            300.0 + 100.0 * term(1.0) + 30.0 * term(3.0)
        };
        let places = cloud.axis(0).to_vec();
        let condition = Condition {
            name: "ends".into(),
            points: outer,
            kind: Kind::Prescribed(std::sync::Arc::new(move |i, t| exact(places[i], t))),
        };
        let field = field(&body, vec![condition], &|x| exact(x, 0.0), t / 400.0);
        error(&field, &body, t, &|x| exact(x, t))
    };
    let fixed_m = [25, 50, 100].map(|cells| at_m(cells, 3));
    for order in orders(&fixed_m) {
        // From above: 2.10 and 2.06 were observed before the bound was chosen.
        assert!((1.9..2.15).contains(&order), "{fixed_m:?} {order}");
    }
    assert!(fixed_m[2] < 2e-4, "{fixed_m:?}");
    // δ → 0 at growing m as well: m = 2, 3, 4 for spacings L/20, L/60, L/160.
    let both = [(20, 2), (60, 3), (160, 4)].map(|(cells, m)| at_m(cells, m));
    assert!(
        both[1] < 0.35 * both[0] && both[2] < 0.35 * both[1],
        "{both:?}"
    );
}

#[test]
fn a_slab_with_insulated_ends_converges_to_the_fourier_series() {
    let diffusivity = K / CAPACITY;
    let t = 0.1 * LENGTH * LENGTH / diffusivity;
    let exact = |x: f64, t: f64| {
        300.0 + 100.0 * (PI * x / LENGTH).cos() * (-(PI / LENGTH).powi(2) * diffusivity * t).exp()
    };
    let of = |cells: usize, surface_correction: bool| {
        let dx = LENGTH / cells as f64;
        let cloud = std::sync::Arc::new(
            pericles::space::Grid::bar(LENGTH, dx, 1e-4)
                .points()
                .unwrap(),
        );
        let body = DiffusionBody {
            surface_correction,
            ..body(cloud, 3.0 * dx, K)
        };
        let field = field(&body, vec![], &|x| exact(x, 0.0), t / 400.0);
        error(&field, &body, t, &|x| exact(x, t))
    };
    for surface_correction in [false, true] {
        let errors = [25, 50, 100].map(|cells| of(cells, surface_correction));
        for order in orders(&errors) {
            assert!((order - 2.0).abs() < 0.1, "{surface_correction} {errors:?}");
        }
    }
}

#[test]
fn a_half_space_with_convection_converges_to_the_closed_form() {
    let diffusivity = K / CAPACITY;
    let (h, ambient) = (2000.0, 400.0);
    // The front has not reached the far end.
    let t = (0.25 * LENGTH).powi(2) / (4.0 * diffusivity);
    let exact = |x: f64| {
        let (s, hk) = (2.0 * (diffusivity * t).sqrt(), h / K);
        let erfc = libm::erfc;
        let second = (hk * x + hk * hk * diffusivity * t).exp() * erfc(x / s + 0.5 * hk * s);
        300.0 + (ambient - 300.0) * (erfc(x / s) - second)
    };
    let of = |cells: usize, surface_correction: bool| {
        let dx = LENGTH / cells as f64;
        let cloud = std::sync::Arc::new(
            pericles::space::Grid::bar(LENGTH, dx, 1e-4)
                .points()
                .unwrap(),
        );
        let body = DiffusionBody {
            surface_correction,
            ..body(cloud, 3.0 * dx, K)
        };
        let condition = Condition {
            name: "left".into(),
            points: vec![0],
            kind: Kind::Exchange {
                law: Exchange::Linear,
                coefficient: h,
                ambient: number(ambient),
                area: vec![1e-4],
            },
        };
        let field = field(&body, vec![condition], &|_| 300.0, t / 400.0);
        error(&field, &body, t, &exact)
    };
    // The heat enters the cell at the surface, so that the order is one; it is approached from below.
    let [plain, corrected] =
        [false, true].map(|correction| [100, 200, 400].map(|cells| of(cells, correction)));
    eprintln!("{plain:?} {corrected:?}");
    for order in orders(&corrected) {
        assert!(order > 0.8, "{corrected:?}");
    }
    assert!(corrected[2] < 3e-3, "{corrected:?}");
    assert!(corrected[2] < plain[2], "{corrected:?} {plain:?}");
}
