//! Conductances: exact conductivity, equality of stencil and list, eigenvalues, conservation.

use std::f64::consts::PI;
use std::sync::Arc;

use pericles::PointScalar;
use pericles::family::VolumeCorrection;
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::lanes::InstructionSet;
use pericles::space::{PointCloud, rectangular_cells};
use pericles_heat::{DiffusionBody, Interface};

use crate::support::*;

/// A linear field and the flux of the lattice point nearest to the middle.
fn middle_flux(body: &DiffusionBody, gradient: [f64; 3]) -> ([f64; 3], f64) {
    let cloud = &body.cloud;
    let diffusion = body.build().unwrap();
    let values: Vec<f64> = (0..cloud.len())
        .map(|i| 300.0 + (0..3).map(|c| gradient[c] * cloud.point(i)[c]).sum::<f64>())
        .collect();
    let (n, d) = (cloud.len(), cloud.dimension());
    let mut flux = vec![0.0; d * n];
    diffusion.flux_into(&values, &mut flux);
    let [low, high] = cloud.bounds();
    let middle = cloud.nearest(std::array::from_fn(|c| 0.5 * (low[c] + high[c])));
    let flow = flow(&diffusion, &values)[middle];
    (
        std::array::from_fn(|c| if c < d { flux[c * n + middle] } else { 0.0 }),
        flow,
    )
}

#[test]
fn a_linear_field_conducts_exactly_the_heat_of_fourier_on_lattices() {
    let influences = [
        Influence::default(),
        Influence {
            function: InfluenceFunction::Conical,
            acts_on: ActsOn::Stretch,
        },
        Influence {
            function: InfluenceFunction::Gaussian {
                length: 2e-3,
                cutoff: None,
            },
            acts_on: ActsOn::Displacement,
        },
    ];
    let gradient = [700.0, -300.0, 450.0];
    for dimension in 1..=3 {
        let cells = [40, 18, 12][dimension - 1];
        for influence in &influences {
            for correction in [
                VolumeCorrection::None,
                VolumeCorrection::Linear,
                VolumeCorrection::Extended,
            ] {
                let body = DiffusionBody {
                    influence: influence.clone(),
                    correction,
                    ..body(box_of(dimension, cells, 1e-3), 3.015e-3, 45.0)
                };
                let (flux, _) = middle_flux(&body, gradient);
                for c in 0..dimension {
                    let error = flux[c] / (-45.0 * gradient[c]) - 1.0;
                    assert!(
                        error.abs() < 1e-12,
                        "{dimension} {influence:?} {correction:?}: {error:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn rectangular_cells_conduct_the_same_along_all_axes() {
    let cloud = rectangular_cells([0.0; 3], &[0.04, 0.03], &[1e-3, 1.5e-3], 1e-3, &[]).unwrap();
    let body = body(Arc::new(cloud), 4.5e-3, 12.0);
    let (flux, _) = middle_flux(&body, [500.0, 200.0, 0.0]);
    for (c, gradient) in [500.0, 200.0].into_iter().enumerate() {
        assert!(
            (flux[c] / (-12.0 * gradient) - 1.0).abs() < 1e-12,
            "{flux:?}"
        );
    }
}

#[test]
fn the_moments_of_the_continuum_are_the_limit_of_lattice_sums() {
    // The error of the lattice sum with partial volumes decreases with the ratio of horizon and spacing.
    let error = |m: f64| {
        let dx = 1e-3 / m;
        let cloud = box_of(2, (2.5 * m) as usize + 1, dx);
        let influence = Influence::default();
        let of_lattice = pericles_heat::PairConductivity::of_lattice(
            &influence,
            1e-3,
            VolumeCorrection::Extended,
            &cloud,
        )
        .unwrap();
        let of_continuum =
            pericles_heat::PairConductivity::of_continuum(&influence, 1e-3, 2, cloud.section())
                .unwrap();
        let xi = [5e-4, 0.0, 0.0];
        (of_lattice.value(xi) / of_continuum.value(xi) - 1.0).abs()
    };
    let errors = [3.0, 6.0, 12.0].map(error);
    let halves = |pair: &[f64]| pair[1] < 0.5 * pair[0];
    assert!(errors.windows(2).all(halves), "{errors:?}");
}

/// Two materials, a surface correction and broken bonds: everything that changes the conductance of a bond.
fn demanding(cloud: Arc<PointCloud>, interface: Interface, share: f64) -> DiffusionBody {
    let side = cloud.bounds()[1][0];
    let conductivity = |i: usize| {
        if cloud.point(i)[0] < 0.5 * side {
            45.0
        } else {
            2.0
        }
    };
    let conductivity = PointScalar::PerPoint((0..cloud.len()).map(conductivity).collect());
    DiffusionBody {
        conductivity,
        interface,
        surface_correction: true,
        broken_share: share,
        ..body(cloud, 3e-3, 1.0)
    }
}

#[test]
fn stencil_and_list_give_equal_flows() {
    for dimension in 1..=3 {
        let cells = [37, 19, 11][dimension - 1];
        for cloud in [
            box_of(dimension, cells, 1e-3),
            periodic(dimension, cells, 1e-3),
        ] {
            for interface in [Interface::Harmonic, Interface::Arithmetic] {
                for share in [0.0, 0.25] {
                    let body = demanding(cloud.clone(), interface, share);
                    let (grid, list) = (body.build().unwrap(), body.build_list().unwrap());
                    assert_eq!(grid.directed_bonds(), list.directed_bonds());
                    let values = noise(cloud.len());
                    let (a, b) = (flow(&grid, &values), flow(&list, &values));
                    assert!(largest_difference(&a, &b) < 1e-12 * largest(&a));
                    let (a, b) = (grid.diagonal(), list.diagonal());
                    assert!(largest_difference(&a, &b) < 1e-12 * largest(&a));
                }
            }
        }
    }
}

#[test]
fn flows_do_not_depend_on_instruction_sets_or_threads() {
    let body = demanding(box_of(3, 13, 1e-3), Interface::Harmonic, 0.0);
    let mut diffusion = body.build().unwrap();
    let values = noise(body.cloud.len());
    let expected = flow(&diffusion, &values);
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        assert_eq!(pool.install(|| flow(&diffusion, &values)), expected);
    }
    for set in InstructionSet::available() {
        diffusion.use_instruction_set(set);
        let found = flow(&diffusion, &values);
        assert!(largest_difference(&found, &expected) < 1e-13 * largest(&expected));
    }
}

#[test]
fn an_insulated_body_keeps_its_heat() {
    for interface in [Interface::Harmonic, Interface::Arithmetic] {
        let body = demanding(box_of(2, 40, 1e-3), interface, 0.0);
        let flow = flow(&body.build().unwrap(), &noise(body.cloud.len()));
        let total: f64 = flow.iter().sum();
        let size: f64 = flow.iter().map(|flow| flow.abs()).sum();
        assert!(total.abs() < 1e-14 * size, "{total:e} {size:e}");
    }
}

#[test]
fn plane_waves_of_a_periodic_body_are_eigenvectors_with_the_eigenvalues_of_the_infinite_lattice() {
    for dimension in 1..=3 {
        let cells = [32, 16, 10][dimension - 1];
        let (dx, k, horizon) = (1e-3, 45.0, 3e-3);
        let cloud = periodic(dimension, cells, dx);
        let body = body(cloud.clone(), horizon, k);
        let diffusion = body.build().unwrap();
        let correction = body.correction;
        let kappa = pericles_heat::PairConductivity::of_lattice(
            &body.influence,
            horizon,
            correction,
            &cloud,
        )
        .unwrap();
        for wave in [[1, 0, 0], [2, 1, 0], [3, 2, 1], [(cells / 2) as i32, 0, 0]] {
            let number: [f64; 3] = std::array::from_fn(|c| match c < dimension {
                true => 2.0 * PI * f64::from(wave[c]) / (cells as f64 * dx),
                false => 0.0,
            });
            let phase = |x: [f64; 3]| (0..3).map(|c| number[c] * x[c]).sum::<f64>();
            let values: Vec<f64> = (0..cloud.len())
                .map(|i| phase(cloud.point(i)).cos())
                .collect();
            let flow = flow(&diffusion, &values);
            // λ = Σ κ V V (1 − cos p·ξ), computed here with the integers of the lattice.
            let mut lambda = 0.0;
            let most = |c: usize| if c < dimension { -4..=4 } else { 0..=0 };
            let volume = cloud.volumes()[0];
            for x in most(0) {
                for y in most(1) {
                    for z in most(2) {
                        let xi = [x, y, z].map(|steps| f64::from(steps) * dx);
                        let r = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                        if r > 0.0 && r <= correction.reach(horizon, dx) {
                            let conductance = k
                                * kappa.value(xi)
                                * correction.factor(r, horizon, dx)
                                * volume
                                * volume;
                            lambda += conductance * 2.0 * (0.5 * phase(xi)).sin().powi(2);
                        }
                    }
                }
            }
            let expected: Vec<f64> = values.iter().map(|value| -lambda * value).collect();
            let error = largest_difference(&flow, &expected) / lambda;
            assert!(error < 1e-12, "{dimension} {wave:?}: {error:e}");
        }
    }
}
