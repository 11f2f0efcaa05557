//! Linear operators by convolution compared with direct sums.

use std::sync::Arc;

use pericles::PericlesError;
use pericles::family::{BondList, Crack, VolumeCorrection};
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, BondStretch, Calibration, ElasticModulus, Fracture, LinearBond, Modulus,
    PairForce, PairLaw, StressState,
};
use pericles::operator::{BondForce, DamageMeasure, Force, LinearOperator, PointSubset};
use pericles::space::{Grid, PointCloud, Region, Shape};
use pericles_waves::linear::NoConvolution;
use pericles_waves::linear::{ConvolutionForce, Ends, Route, Toeplitz};
use proptest::prelude::*;

const ROUTES: [Route; 3] = [Route::Banded, Route::OverlapSave, Route::OneTransform];
const DX: f64 = 0.01;

/// Random numbers in (−1, 1).
fn noise(len: usize) -> Vec<f64> {
    (0..len)
        .map(|k| ((k as f64 * 12.9898).sin() * 43758.5453).fract())
        .collect()
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| x.abs().max(m))
}

fn applied(operator: &dyn LinearOperator, u: &[f64]) -> Vec<f64> {
    let mut out = vec![f64::NAN; u.len()];
    operator.apply_into(u, &mut out);
    out
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap()
        .install(work)
}

fn assert_close(a: &[f64], b: &[f64], tolerance: f64, name: &str) {
    let scale = largest(b).max(f64::MIN_POSITIVE);
    for (i, (a, b)) in a.iter().zip(b).enumerate() {
        assert!(
            (a - b).abs() <= tolerance * scale,
            "{name}: entry {i}: {a} {b}, scale {scale}"
        );
    }
}

/// y_i = Σ_{r≠0} t_r (u_{i+r} − u_i), or the product with `centre`, from the definition.
fn naive_line(
    u: &[f64],
    centre: Option<f64>,
    below: &[f64],
    above: &[f64],
    ends: Ends,
) -> Vec<f64> {
    let n = u.len() as i64;
    (0..n)
        .map(|i| {
            let mut sum = centre.unwrap_or(0.0) * u[i as usize];
            for (sign, coefficients) in [(-1, below), (1, above)] {
                for (r, t) in coefficients.iter().enumerate() {
                    let j = i + sign * (r as i64 + 1);
                    let there = match ends {
                        Ends::Periodic => u[j.rem_euclid(n) as usize],
                        _ if (0..n).contains(&j) => u[j as usize],
                        Ends::Zero => 0.0,
                        Ends::Free => continue,
                    };
                    let own = if centre.is_some() { 0.0 } else { u[i as usize] };
                    sum += t * (there - own);
                }
            }
            sum
        })
        .collect()
}

#[test]
fn all_routes_of_a_line_equal_the_direct_sum() {
    for (nodes, reach) in [
        (1, 0),
        (1, 3),
        (2, 1),
        (5, 7),
        (64, 64),
        (100, 3),
        (1000, 40),
        (1021, 300),
        (5000, 1),
    ] {
        let u = noise(nodes);
        let above: Vec<f64> = (0..reach)
            .map(|r| 1.0 / (1.0 + r as f64) + 0.1 * (r as f64).sin())
            .collect();
        let below: Vec<f64> = (0..reach).map(|r| (r as f64 * 0.3).cos()).collect();
        for ends in [Ends::Free, Ends::Zero, Ends::Periodic] {
            let mut cases = vec![
                (
                    "stencil",
                    Toeplitz::stencil(nodes, &above, ends),
                    naive_line(&u, None, &above, &above, ends),
                ),
                (
                    "differences",
                    Toeplitz::differences(nodes, &below, &above, ends),
                    naive_line(&u, None, &below, &above, ends),
                ),
            ];
            if ends != Ends::Free {
                cases.push((
                    "product",
                    Toeplitz::product(nodes, 0.7, &below, &above, ends),
                    naive_line(&u, Some(0.7), &below, &above, ends),
                ));
            }
            for (form, operator, expected) in cases {
                let mut operator = operator.unwrap();
                let chosen = applied(&operator, &u);
                assert_close(&chosen, &expected, 1e-13, form);
                for route in ROUTES {
                    operator = operator.with_route(route);
                    let name = format!("{form} {nodes} {reach} {ends:?} {route:?}");
                    assert_eq!(operator.route(), route);
                    assert_close(&applied(&operator, &u), &expected, 1e-13, &name);
                }
            }
        }
    }
}

proptest! {
    #[test]
    fn random_lines_equal_the_direct_sum(nodes in 1usize..400, reach in 0usize..300, seed in 0usize..1000, symmetric: bool, ends in 0usize..3) {
        let ends = [Ends::Free, Ends::Zero, Ends::Periodic][ends];
        let numbers = noise(nodes + 2 * reach + seed);
        let numbers = &numbers[seed..];
        let (u, t) = numbers.split_at(nodes);
        let (below, above) = t.split_at(reach);
        let below = if symmetric { above } else { below };
        let expected = naive_line(u, None, below, above, ends);
        let size: f64 = below.iter().chain(above).map(|t| t.abs()).sum();
        let mut operator = Toeplitz::differences(nodes, below, above, ends).unwrap();
        for route in ROUTES {
            operator = operator.with_route(route);
            let y = applied(&operator, u);
            for i in 0..nodes {
                prop_assert!((y[i] - expected[i]).abs() <= 1e-14 * size, "{route:?} {i}: {} {}", y[i], expected[i]);
            }
        }
    }
}

#[test]
fn long_lines_are_independent_of_route_and_threads() {
    let nodes = 150_001;
    let u = noise(nodes);
    for reach in [7, 60, 700] {
        let weights: Vec<f64> = (1..=reach).map(|r| 1.0 / f64::from(r)).collect();
        for ends in [Ends::Free, Ends::Periodic] {
            let line = || Toeplitz::stencil(nodes, &weights, ends).unwrap();
            let reference = applied(&line().with_route(Route::Banded), &u);
            for route in ROUTES {
                let one = on_threads(1, || applied(&line().with_route(route), &u));
                let three = on_threads(3, || applied(&line().with_route(route), &u));
                assert_eq!(one, three, "{route:?}");
                assert_close(&one, &reference, 1e-13, &format!("{route:?}"));
            }
        }
    }
}

#[test]
fn constant_fields_on_a_line_give_exactly_zero() {
    let weights = noise(30);
    for route in ROUTES {
        for ends in [Ends::Free, Ends::Periodic] {
            let line = Toeplitz::stencil(3000, &weights, ends)
                .unwrap()
                .with_route(route);
            assert!(applied(&line, &[1e6 / 3.0; 3000]).iter().all(|&y| y == 0.0));
        }
    }
}

#[test]
fn large_rigid_shift_loses_no_digits() {
    let weights: Vec<f64> = (1..=50).map(|r| 1.0 / f64::from(r)).collect();
    let wave: Vec<f64> = (0..4000).map(|i| (f64::from(i) * 0.01).sin()).collect();
    // A power of two keeps the sum exact enough to compare: 2^20 + u leaves 32 bits for u.
    let shifted: Vec<f64> = wave
        .iter()
        .map(|u| (u * 2f64.powi(30)).round() / 2f64.powi(30))
        .collect();
    let far: Vec<f64> = shifted.iter().map(|u| u + 2f64.powi(20)).collect();
    for route in ROUTES {
        let line = Toeplitz::stencil(4000, &weights, Ends::Free)
            .unwrap()
            .with_route(route);
        assert_eq!(applied(&line, &far), applied(&line, &shifted), "{route:?}");
    }
}

#[test]
fn invalid_lines_are_errors() {
    let bad = |result: Result<Toeplitz, PericlesError>| {
        result.is_err_and(|error| error.extension::<NoConvolution>().is_some())
    };
    assert!(bad(Toeplitz::stencil(10, &[1.0, f64::NAN], Ends::Free)));
    assert!(bad(Toeplitz::differences(
        10,
        &[1.0],
        &[1.0, 2.0],
        Ends::Zero
    )));
    assert!(bad(Toeplitz::product(10, 1.0, &[1.0], &[1.0], Ends::Free)));
    assert!(bad(Toeplitz::product(
        10,
        f64::INFINITY,
        &[1.0],
        &[1.0],
        Ends::Zero
    )));
    assert!(matches!(
        Toeplitz::stencil(0, &[1.0], Ends::Free),
        Err(PericlesError::EmptyBody)
    ));
}

fn influences() -> Vec<Influence> {
    let functions = [
        InfluenceFunction::Constant,
        InfluenceFunction::Conical,
        InfluenceFunction::Inverse,
        InfluenceFunction::Gaussian {
            length: 0.02,
            cutoff: None,
        },
        // Signed, as a tuned kernel may be.
        InfluenceFunction::Tabulated {
            table: vec![(0.01, 3.0), (0.02, -0.2), (0.03, 0.5)],
        },
    ];
    let mut all = Vec::new();
    for function in functions {
        for acts_on in [ActsOn::Stretch, ActsOn::Displacement] {
            all.push(Influence {
                function: function.clone(),
                acts_on,
            });
        }
    }
    all
}

fn body(cells: &[usize], hole: bool) -> Arc<PointCloud> {
    let size: Vec<f64> = cells.iter().map(|&n| n as f64 * DX).collect();
    let mut centre = [0.0; 3];
    for (c, side) in size.iter().enumerate() {
        centre[c] = 0.4 * side;
    }
    let holes = if hole {
        vec![Region::Ball {
            centre,
            radius: 0.013,
        }]
    } else {
        vec![]
    };
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.3, -0.1, 0.7],
            size,
        },
        spacing: DX,
        section: if cells.len() == 3 { 1.0 } else { 0.02 },
        holes,
    };
    // In units of 0.01 m the sides are whole numbers of cells only up to round-off, which the grid accepts.
    Arc::new(grid.points().unwrap())
}

fn material(influence: Influence, correction: VolumeCorrection, m: f64) -> BondMaterial {
    BondMaterial {
        law: PairLaw::Linear,
        density: 1000.0,
        modulus: Modulus {
            value: ElasticModulus::Young(2e9),
            calibration: Calibration::Continuum,
        },
        horizon: m * DX,
        influence,
        volume_correction: correction,
        fracture: Fracture::Unbreakable,
    }
}

fn state(dimension: usize) -> StressState {
    [
        StressState::Uniaxial,
        StressState::PlaneStress,
        StressState::Spatial,
    ][dimension - 1]
}

fn bond_force<const D: usize>(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
) -> BondForce<LinearBond, D> {
    let constants = material.constants(cloud, state(D)).unwrap();
    let bonds = BondList::new(cloud, material.horizon, material.volume_correction).unwrap();
    BondForce::new(
        cloud.clone(),
        bonds,
        material,
        &constants,
        &[],
        DamageMeasure::default(),
    )
    .unwrap()
}

fn convolution<const D: usize>(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    periodic: [bool; D],
) -> ConvolutionForce<D> {
    let constants = material.constants(cloud, state(D)).unwrap();
    ConvolutionForce::new(cloud.clone(), material, &constants, &[], periodic).unwrap()
}

/// Calls `check` for bodies × influence functions × volume corrections × horizons.
fn for_each_case<const D: usize>(check: impl Fn(&str, &Arc<PointCloud>, &BondMaterial)) {
    let bodies: Vec<(Vec<usize>, Vec<f64>)> = match D {
        1 => vec![(vec![40], vec![1.0, 3.0, 7.3, 60.0]), (vec![1], vec![3.0])],
        2 => vec![
            (vec![17, 12], vec![2.0, 3.015]),
            (vec![9, 30], vec![8.0, 12.0]),
            (vec![1, 14], vec![3.0]),
            (vec![13, 1], vec![3.0]),
        ],
        _ => vec![(vec![8, 7, 9], vec![3.0]), (vec![6, 3, 5], vec![2.0, 20.0])],
    };
    for (cells, horizons) in bodies {
        for hole in [false, true] {
            if hole && cells.iter().any(|&n| n < 3) {
                continue;
            }
            let cloud = body(&cells, hole);
            for &m in &horizons {
                for influence in influences() {
                    for correction in [
                        VolumeCorrection::None,
                        VolumeCorrection::Linear,
                        VolumeCorrection::Extended,
                    ] {
                        let material = material(influence.clone(), correction, m);
                        // A single point has no family in the list.
                        if cloud.len() > 1 && material.constants(&cloud, state(D)).is_ok() {
                            let name = format!("{cells:?} hole {hole} m {m} {material:?}");
                            check(&name, &cloud, &material);
                        }
                    }
                }
            }
        }
    }
}

fn equals_the_bond_list<const D: usize>() {
    for_each_case::<D>(|name, cloud, material| {
        let list = bond_force::<D>(cloud, material);
        let fast = convolution::<D>(cloud, material, [false; D]);
        let n = cloud.len();
        let u: Vec<f64> = noise(D * n).iter().map(|r| 1e-3 * r).collect();
        let expected = applied(&list, &u);
        let force = applied(&fast, &u);
        assert_close(&force, &expected, 1e-12, name);
        assert_eq!(fast.directed_bonds(), list.directed_bonds(), "{name}");

        let mut densities = [vec![0.0; n], vec![0.0; n]];
        list.add_energy_density(0.0, &u, &mut densities[0]);
        fast.add_energy_density(0.0, &u, &mut densities[1]);
        assert_close(&densities[1], &densities[0], 1e-12, name);
        let (a, b) = (list.energy(0.0, &u), fast.energy(0.0, &u));
        let total: f64 = densities[0]
            .iter()
            .map(|w| w.abs() * cloud.volumes()[0])
            .sum();
        assert!((a - b).abs() <= 1e-12 * total, "{name}: {a} {b}");

        let density = |i: usize| 1000.0 + (i % 7) as f64;
        let (a, b) = (
            list.frequency_bound(&density),
            fast.frequency_bound(&density),
        );
        assert!(b >= a * (1.0 - 1e-12), "{name}: bound {b} below {a}");
        if !material.influence.is_signed(material.horizon) {
            assert!(b <= a * (1.0 + 1e-11), "{name}: bound {b} above {a}");
        }
        // A large smooth strain, for which neighbouring contributions cancel.
        let strained: Vec<f64> = (0..D * n)
            .map(|k| 0.01 * cloud.point(k % n)[k / n] + 5.0)
            .collect();
        assert_close(
            &applied(&fast, &strained),
            &applied(&list, &strained),
            1e-11,
            name,
        );
    });
}

#[test]
fn convolution_equals_the_bond_list_in_1d() {
    equals_the_bond_list::<1>();
}

#[test]
fn convolution_equals_the_bond_list_in_2d() {
    equals_the_bond_list::<2>();
}

#[test]
fn convolution_equals_the_bond_list_in_3d() {
    equals_the_bond_list::<3>();
}

fn conserves<const D: usize>(cells: [usize; D]) {
    for periodic in [[false; D], [true; D]] {
        let cloud = body(&cells, true);
        let material = material(Influence::default(), VolumeCorrection::Extended, 3.0);
        let operator = convolution::<D>(&cloud, &material, periodic);
        let n = cloud.len();
        let u = noise(D * n);
        let force = applied(&operator, &u);
        for c in 0..D {
            let part = &force[c * n..(c + 1) * n];
            let magnitude: f64 = part.iter().map(|f| f.abs()).sum();
            assert!(part.iter().sum::<f64>().abs() <= 1e-13 * magnitude);
        }
        if !periodic[0] {
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                if a.max(b) < D {
                    let moment: f64 = (0..n)
                        .map(|i| {
                            let x = cloud.point(i);
                            x[a] * force[b * n + i] - x[b] * force[a * n + i]
                        })
                        .sum();
                    let magnitude: f64 = force.iter().map(|f| f.abs()).sum();
                    assert!(moment.abs() <= 1e-13 * magnitude, "{moment} {magnitude}");
                }
            }
        }
        // Symmetry: v·f(u) = u·f(v).
        let v: Vec<f64> = noise(D * n + 9)[9..].to_vec();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (left, right) = (dot(&v, &force), dot(&u, &applied(&operator, &v)));
        let magnitude = largest(&force) * (D * n) as f64;
        assert!((left - right).abs() <= 1e-13 * magnitude);
        // The energy equals the sum of its density, and its gradient is the force.
        let mut density = vec![0.0; n];
        operator.add_energy_density(0.0, &u, &mut density);
        let total = density.iter().sum::<f64>() * cloud.volumes()[0];
        let energy = operator.energy(0.0, &u);
        assert!(energy > 0.0 && (energy - total).abs() <= 1e-12 * energy);
        let work = -0.5 * dot(&u, &force) * cloud.volumes()[0];
        assert!((energy - work).abs() <= 1e-12 * energy);
        assert!(density.iter().all(|&w| w > 0.0));
        // Rayleigh quotients of noise, and of the vector after 50 applications, stay below the bound.
        let bound = operator.frequency_bound(&|_| 2.0).powi(2);
        let mut x = u.clone();
        for _ in 0..50 {
            let image = applied(&operator, &x);
            let quotient = -dot(&x, &image) / dot(&x, &x) / 2.0;
            assert!(quotient > 0.0 && quotient <= bound, "{quotient} {bound}");
            let size = largest(&image);
            x = image.iter().map(|f| f / size).collect();
        }
        // Rigid translation.
        let mut shift = vec![0.0; D * n];
        for c in 0..D {
            shift[c * n..(c + 1) * n].fill(1.0 / (3.0 + c as f64));
        }
        assert!(applied(&operator, &shift).iter().all(|&f| f == 0.0));
        // Subsets, and accumulation.
        let mut parts = force.clone();
        let odd: Vec<u32> = (0..n as u32).filter(|i| i % 2 == 1).collect();
        operator.add_force(0.0, &u, PointSubset::Set(&odd), &mut parts);
        for i in (0..n).step_by(2) {
            operator.add_force(0.0, &u, PointSubset::Range(i..i + 1), &mut parts);
        }
        let twice: Vec<f64> = force.iter().map(|f| f + f).collect();
        assert_eq!(
            parts, twice,
            "the force on a point depends on the requested subset"
        );
        // Threads.
        for threads in [1, 3] {
            let again = on_threads(threads, || {
                applied(&convolution::<D>(&cloud, &material, periodic), &u)
            });
            assert_eq!(again, force, "{threads} threads");
        }
    }
}

#[test]
fn convolution_conserves_momentum_is_symmetric_and_independent_of_subsets_and_threads() {
    conserves([60]);
    conserves([20, 31]);
    conserves([9, 11, 10]);
}

/// Force on a plane wave in a periodic box: −λ times the wave, with λ_ab = Σ_o K_ab(o) (1 − cos θ·o).
fn plane_wave<const D: usize>(cells: [usize; D], wave: [usize; D], m: f64) {
    let cloud = body(&cells, false);
    let n = cloud.len();
    for influence in influences() {
        let material = material(influence, VolumeCorrection::Extended, m);
        let constants = material.constants(&cloud, state(D)).unwrap();
        let operator = convolution::<D>(&cloud, &material, [true; D]);
        let theta: Vec<f64> = (0..D)
            .map(|c| 2.0 * std::f64::consts::PI * wave[c] as f64 / cells[c] as f64)
            .collect();
        let mut lambda = [[0.0; D]; D];
        let raw = m.ceil() as i64 + 1;
        let range = |c: usize| if c < D { -raw..=raw } else { 0..=0 };
        let mut full = 0.0;
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let o = [x, y, z];
                    let xi = o.map(|o| o as f64 * DX);
                    let r = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let reach = material.volume_correction.reach(material.horizon, DX);
                    if r == 0.0 || r > reach {
                        continue;
                    }
                    let k = constants.micromodulus
                        * material.influence.alpha(r, material.horizon)
                        * material.volume_correction.factor(r, material.horizon, DX)
                        * cloud.volumes()[0];
                    let phase: f64 = (0..D).map(|c| theta[c] * o[c] as f64).sum();
                    full += k.abs() / r;
                    for a in 0..D {
                        for b in 0..D {
                            lambda[a][b] += k * xi[a] * xi[b] / r.powi(3) * (1.0 - phase.cos());
                        }
                    }
                }
            }
        }
        let polarisation = [0.8, -0.5, 0.3];
        let lattice = cloud.lattice().unwrap();
        let phases: Vec<f64> = (0..n)
            .map(|i| {
                let at = lattice.coordinates(lattice.node[i]);
                (0..D).map(|c| theta[c] * f64::from(at[c])).sum::<f64>() + 0.4
            })
            .collect();
        let mut u = vec![0.0; D * n];
        for c in 0..D {
            for i in 0..n {
                u[c * n + i] = polarisation[c] * phases[i].cos();
            }
        }
        let force = applied(&operator, &u);
        for a in 0..D {
            let factor: f64 = (0..D).map(|b| lambda[a][b] * polarisation[b]).sum();
            for i in 0..n {
                let expected = -factor * phases[i].cos();
                assert!(
                    (force[a * n + i] - expected).abs() <= 1e-12 * full,
                    "{cells:?} {wave:?} {m}: {} {expected}",
                    force[a * n + i]
                );
            }
        }
    }
}

#[test]
fn plane_waves_satisfy_the_lattice_dispersion_relation() {
    plane_wave([50], [3], 3.0);
    plane_wave([7], [2], 20.0);
    plane_wave([24, 15], [3, 5], 3.0);
    plane_wave([6, 5], [1, 2], 8.0);
    plane_wave([8, 9, 6], [1, 2, 3], 3.0);
    plane_wave([4, 3, 2], [1, 1, 1], 3.0);
}

#[test]
fn strips_may_be_periodic_along_one_axis() {
    // Sum over all pairs and images.
    let cloud = body(&[9, 6], true);
    let material = material(Influence::default(), VolumeCorrection::Extended, 4.0);
    let constants = material
        .constants(&cloud, StressState::PlaneStress)
        .unwrap();
    let n = cloud.len();
    let u = noise(2 * n);
    for periodic in [[true, false], [false, true]] {
        let operator = convolution::<2>(&cloud, &material, periodic);
        let lattice = cloud.lattice().unwrap();
        let mut expected = vec![0.0; 2 * n];
        for i in 0..n {
            for j in 0..n {
                let (a, b) = (
                    lattice.coordinates(lattice.node[i]),
                    lattice.coordinates(lattice.node[j]),
                );
                for image in -3..=3 {
                    let offset: [f64; 2] = std::array::from_fn(|c| {
                        let period = if periodic[c] {
                            image * lattice.shape[c] as i32
                        } else {
                            0
                        };
                        f64::from(b[c] - a[c] + period)
                    });
                    let xi = offset.map(|o| o * DX);
                    let r = (xi[0] * xi[0] + xi[1] * xi[1]).sqrt();
                    if r == 0.0 || r > 4.5 * DX * (1.0 - 1e-9) {
                        continue;
                    }
                    let k = constants.micromodulus
                        * material.volume_correction.factor(r, 4.0 * DX, DX)
                        * cloud.volumes()[0];
                    let along: f64 = (0..2).map(|c| xi[c] * (u[c * n + j] - u[c * n + i])).sum();
                    for c in 0..2 {
                        expected[c * n + i] += k * along / r.powi(3) * xi[c];
                    }
                }
            }
        }
        assert_close(&applied(&operator, &u), &expected, 1e-12, "strip");
    }
}

#[test]
fn bodies_without_a_convolution_are_errors() {
    let cloud = body(&[12, 12], false);
    let linear = material(Influence::default(), VolumeCorrection::None, 3.0);
    let rejected = |cloud: &Arc<PointCloud>, material: &BondMaterial, cracks: &[Crack]| {
        let constants = material.constants(cloud, StressState::PlaneStress).unwrap();
        let operator =
            ConvolutionForce::<2>::new(cloud.clone(), material, &constants, cracks, [false; 2]);
        operator.is_err_and(|error| error.extension::<NoConvolution>().is_some())
    };
    assert!(!rejected(&cloud, &linear, &[]));
    let stretch = BondMaterial {
        law: PairLaw::BondStretch,
        ..linear.clone()
    };
    assert!(!BondStretch::LINEAR && rejected(&cloud, &stretch, &[]));
    let breaking = BondMaterial {
        fracture: Fracture::CriticalStretch(0.01),
        ..linear.clone()
    };
    assert!(rejected(&cloud, &breaking, &[]));
    let crack = Crack::Segment {
        from: [0.3, -0.04],
        to: [0.36, -0.04],
    };
    assert!(rejected(&cloud, &linear, &[crack]));
    let loose = PointCloud::new(
        2,
        cloud.positions().to_vec(),
        cloud.volumes().to_vec(),
        0.02,
    );
    assert!(rejected(&Arc::new(loose.unwrap()), &linear, &[]));
    let short = ConvolutionForce::<2>::with_stiffness(
        cloud.clone(),
        0.5 * DX,
        VolumeCorrection::None,
        |_| 1.0,
        [false; 2],
    );
    assert!(matches!(short, Err(PericlesError::HorizonTooSmall { .. })));
    let infinite = ConvolutionForce::<2>::with_stiffness(
        cloud,
        3.0 * DX,
        VolumeCorrection::None,
        |xi: [f64; 3]| 1.0 / (xi[0].hypot(xi[1]) - DX),
        [false; 2],
    );
    assert!(infinite.is_err_and(|error| error.extension::<NoConvolution>().is_some()));
}
