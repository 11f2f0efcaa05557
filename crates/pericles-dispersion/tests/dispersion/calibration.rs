//! Calibrated bond constants compared with the moduli and fracture energies of bodies.

use std::sync::Arc;

use crate::common::boxed;
use pericles::family::{BondList, VolumeCorrection};
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondConstants, BondMaterial, Calibration, CrackPlane, ElasticModulus, Fracture,
    FractureCalibration, Modulus, PairLaw, StressState,
};
use pericles::operator::{BondBody, BondForm};
use pericles::space::{PointCloud, rectangular_cells};
use pericles_dispersion::BondLattice;

const DX: f64 = 1e-3;
const YOUNG: f64 = 72e9;
const ENERGY: f64 = 135.0;
const STATES: [StressState; 4] = [
    StressState::Uniaxial,
    StressState::PlaneStress,
    StressState::PlaneStrain,
    StressState::Spatial,
];
const CORRECTIONS: [VolumeCorrection; 3] = [
    VolumeCorrection::None,
    VolumeCorrection::Linear,
    VolumeCorrection::Extended,
];

fn glass(calibration: Calibration, fracture: Fracture) -> BondMaterial {
    BondMaterial {
        law: PairLaw::Linear,
        density: 2440.0,
        modulus: Modulus {
            value: ElasticModulus::Young(YOUNG),
            calibration,
        },
        horizon: 3.0 * DX,
        influence: Influence::default(),
        volume_correction: VolumeCorrection::Extended,
        fracture,
    }
}

fn breaking(calibration: FractureCalibration) -> Fracture {
    Fracture::Energy {
        energy: ENERGY,
        calibration,
    }
}

fn functions() -> Vec<Influence> {
    let gaussian = InfluenceFunction::Gaussian {
        length: 1.5 * DX,
        cutoff: None,
    };
    let cosines = InfluenceFunction::Cosines {
        wavenumber: 500.0,
        coefficients: vec![2.0, 0.5, 0.2],
    };
    let tabulated = InfluenceFunction::Tabulated {
        table: vec![(0.0, 1.0), (DX, 2.0), (3.0 * DX, 0.5)],
    };
    [
        InfluenceFunction::Constant,
        InfluenceFunction::Conical,
        InfluenceFunction::Inverse,
        InfluenceFunction::Power { exponent: 0.5 },
        gaussian,
        cosines,
        tabulated,
    ]
    .into_iter()
    .flat_map(|function| {
        [ActsOn::Stretch, ActsOn::Displacement].map(|acts_on| Influence {
            function: function.clone(),
            acts_on,
        })
    })
    .collect()
}

fn section(state: StressState) -> f64 {
    match state {
        StressState::Spatial => 1.0,
        _ => 0.2,
    }
}

/// Young's modulus of the continuum with this constant c, from the integrated energy of a uniform dilation.
fn young_of(state: StressState, c: f64, alpha: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 20_000;
    let dimension = state.dimension() as i32;
    let dr = 3.0 * DX / STEPS as f64;
    let moment: f64 = (0..STEPS)
        .map(|k| (k as f64 + 0.5) * dr)
        .map(|r| alpha(r) * r.powi(dimension) * dr)
        .sum();
    // W = ½ ∫ ½ c α ε² r dV over all directions, and W = E ε² times a factor of the stress state.
    let sphere = [2.0, std::f64::consts::TAU, 2.0 * std::f64::consts::TAU][state.dimension() - 1];
    let energy = 0.25 * c * section(state) * sphere * moment;
    energy
        / match state {
            StressState::Uniaxial => 0.5,
            StressState::PlaneStress => 1.0 / (1.0 - 1.0 / 3.0),
            // E/((1 + ν)(1 − 2ν))
            StressState::PlaneStrain => 1.0 / (1.25 * 0.5),
            // 9/2 K, K = 2E/3
            StressState::Spatial => 3.0,
        }
}

#[test]
fn bond_constants_reproduce_the_modulus_for_every_influence_function() {
    for state in STATES {
        let sides = vec![DX; state.dimension()];
        for influence in functions() {
            let c = |calibration| {
                let material = BondMaterial {
                    influence: influence.clone(),
                    ..glass(calibration, Fracture::Unbreakable)
                };
                material
                    .constants_on(&sides, section(state), state)
                    .unwrap()
                    .micromodulus
            };
            let alpha = |r| influence.alpha(r, 3.0 * DX);
            let own = young_of(state, c(Calibration::Continuum), alpha);
            assert!((own / YOUNG - 1.0).abs() < 1e-4, "{state:?} {influence:?}");
            // Constant influence function on the same body.
            let constant = Influence {
                function: InfluenceFunction::Constant,
                acts_on: influence.acts_on,
            };
            let alpha = |r| constant.alpha(r, 3.0 * DX);
            let unmodified = young_of(state, c(Calibration::Unmodified), alpha);
            assert!(
                (unmodified / YOUNG - 1.0).abs() < 1e-4,
                "{state:?} {influence:?}"
            );
        }
    }
}

#[test]
fn constant_micromodulus_in_one_dimension_has_the_closed_form() {
    // C(r) = c: E = ½ ∫ c ξ² dξ = c δ³/3.
    let delta = 3.0 * DX;
    let bar = BondMaterial {
        influence: Influence {
            function: InfluenceFunction::Constant,
            acts_on: ActsOn::Displacement,
        },
        ..glass(Calibration::Unmodified, Fracture::Unbreakable)
    };
    let constants = bar.constants_on(&[DX], 1.0, StressState::Uniaxial).unwrap();
    assert!((constants.micromodulus * delta.powi(3) / (3.0 * YOUNG) - 1.0).abs() < 1e-13);
    // Σ κ r² over δ³/3 with half the volume at the horizon: (1 + 4 + 9/2)/9.
    assert!((constants.stiffness_error - (9.5 / 9.0 - 1.0)).abs() < 1e-12);
}

/// Energy density of a uniform dilation in the interior of a body, divided by that of the continuum.
fn dilation(cloud: &Arc<PointCloud>, material: &BondMaterial, state: StressState) -> f64 {
    let constants = material.constants(cloud, state).unwrap();
    let body = BondBody::new(cloud, material, &constants);
    let operator = body.operator(BondForm::List).unwrap().operator;
    let strain = 1e-6;
    let u: Vec<f64> = cloud.positions().iter().map(|x| strain * x).collect();
    let mut density = vec![0.0; cloud.len()];
    operator.add_energy_density(0.0, &u, &mut density);
    let [low, high] = cloud.bounds();
    let middle = cloud.nearest(std::array::from_fn(|c| 0.5 * (low[c] + high[c])));
    let exact = match state {
        StressState::PlaneStress => 1.5 * YOUNG,
        StressState::PlaneStrain => 1.6 * YOUNG,
        _ => 3.0 * YOUNG,
    };
    density[middle] / (exact * strain * strain)
}

#[test]
fn lattice_calibration_is_exact_for_anisotropic_spacing() {
    let bodies = [
        (
            StressState::PlaneStress,
            vec![16e-3, 16e-3],
            vec![DX, 2.0 * DX],
        ),
        (
            StressState::PlaneStrain,
            vec![12e-3, 16e-3],
            vec![0.75 * DX, DX],
        ),
        (
            StressState::Spatial,
            vec![9e-3, 12e-3, 15e-3],
            vec![0.75 * DX, 1.0 * DX, 1.25 * DX],
        ),
    ];
    for (state, size, sides) in bodies {
        let cloud = rectangular_cells([0.0; 3], &size, &sides, section(state), &[]).unwrap();
        let cloud = Arc::new(cloud);
        for correction in CORRECTIONS {
            for calibration in [Calibration::Lattice, Calibration::Continuum] {
                let material = BondMaterial {
                    volume_correction: correction,
                    horizon: 3.0 * DX,
                    ..glass(calibration, Fracture::Unbreakable)
                };
                let error = material.constants(&cloud, state).unwrap().stiffness_error;
                let measured = dilation(&cloud, &material, state) - 1.0;
                assert!(
                    (error - measured).abs() < 1e-9,
                    "{sides:?} {correction:?}: {error} {measured}"
                );
                if calibration == Calibration::Lattice {
                    assert!(measured.abs() < 1e-9);
                }
            }
        }
    }
}

fn planes(constants: &BondConstants) -> Vec<(String, f64)> {
    let share = |plane: &CrackPlane| plane.energy() / constants.fracture_energy;
    let planes = constants.crack_planes.iter();
    planes
        .map(|plane| (plane.to_string(), share(plane)))
        .collect()
}

#[test]
fn crack_plane_energies_equal_sums_over_lattice_bonds() {
    let normals = [
        vec![("(1)", [1.0, 0.0, 0.0])],
        vec![("(10)", [1.0, 0.0, 0.0]), ("(11)", [1.0, 1.0, 0.0])],
        vec![
            ("(100)", [1.0, 0.0, 0.0]),
            ("(110)", [1.0, 1.0, 0.0]),
            ("(111)", [1.0, 1.0, 1.0]),
        ],
    ];
    for state in STATES {
        let dimension = state.dimension();
        let sides = vec![DX; dimension];
        for correction in CORRECTIONS {
            for influence in functions().into_iter().take(5) {
                let material = BondMaterial {
                    influence,
                    volume_correction: correction,
                    ..glass(
                        Calibration::Continuum,
                        breaking(FractureCalibration::Lattice),
                    )
                };
                let section = section(state);
                let found = material.constants_on(&sides, section, state).unwrap();
                let lattice = BondLattice::of_material(&sides, section, &material, &found).unwrap();
                let stretch = found.critical_stretch;
                let named = planes(&found);
                assert_eq!(named.len(), dimension);
                for ((name, share), (expected, normal)) in named.iter().zip(&normals[dimension - 1])
                {
                    assert_eq!(name, expected);
                    let energy = lattice.crack_energy(*normal) * material.density * stretch.powi(2);
                    assert!(
                        (share * ENERGY / energy - 1.0).abs() < 1e-9,
                        "{state:?} {name}"
                    );
                }
                // The mean over the planes is the requested fracture energy.
                let mean = named.iter().map(|(_, share)| share).sum::<f64>() / dimension as f64;
                assert!((mean - 1.0).abs() < 1e-12);
                assert!((found.fracture_energy / ENERGY - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn cutting_a_plate_dissipates_the_fracture_energy() {
    let (state, thickness) = (StressState::PlaneStrain, 0.2);
    let cloud = boxed([0.0; 3], &[24e-3, 24e-3], DX, thickness);
    for (correction, expected) in [
        // The lattice value on average; with the continuum's critical stretch a crack along the grid costs this
        // factor more.
        (VolumeCorrection::None, 1.026),
        (VolumeCorrection::Extended, 1.034),
        (VolumeCorrection::Linear, 0.823),
    ] {
        let [lattice, continuum] = [FractureCalibration::Lattice, FractureCalibration::Continuum]
            .map(|calibration| {
                let material = BondMaterial {
                    volume_correction: correction,
                    ..glass(Calibration::Continuum, breaking(calibration))
                };
                let constants = material.constants(&cloud, state).unwrap();
                // Between two rows, and along a diagonal that passes no point.
                let row = cut(&cloud, &material, &constants, [0.0, 1.0], 12e-3);
                let half = 0.5f64.sqrt();
                let diagonal = cut(&cloud, &material, &constants, [half, half], 24.5e-3 * half);
                let [(_, a), (_, b)] = &planes(&constants)[..] else {
                    panic!("two planes");
                };
                assert!((row / (a * ENERGY * thickness) - 1.0).abs() < 1e-9);
                assert!((diagonal / (b * ENERGY * thickness) - 1.0).abs() < 1e-9);
                [row, diagonal].map(|energy| energy / (ENERGY * thickness))
            });
        assert!((0.5 * (lattice[0] + lattice[1]) - 1.0).abs() < 1e-9);
        assert!((continuum[0] - expected).abs() < 1e-3, "{continuum:?}");
    }
}

/// Energy per length of a line with this unit normal and distance from the origin: sum over the bonds that cross
/// its middle part at the critical stretch, over a whole number of lattice periods.
fn cut(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    constants: &BondConstants,
    normal: [f64; 2],
    distance: f64,
) -> f64 {
    const PERIODS: f64 = 4.0;
    let bonds = BondList::new(cloud, material.horizon, material.volume_correction).unwrap();
    let along = [-normal[1], normal[0]];
    let dot = |a: [f64; 2], x: [f64; 3]| a[0] * x[0] + a[1] * x[1];
    let middle = dot(along, [12e-3, 12e-3, 0.0]);
    // A diagonal repeats after √2 spacings.
    let length = PERIODS * DX * if normal[0] > 0.0 { 2.0f64.sqrt() } else { 1.0 };
    // Avoids the crossing points of bonds, which lie symmetrically.
    let from = middle + 0.137 * DX;
    let mut energy = 0.0;
    for i in 0..cloud.len() {
        for (_, j) in bonds.family(i) {
            let (a, b) = (cloud.point(i), cloud.point(j));
            let (low, high) = (dot(normal, a) - distance, dot(normal, b) - distance);
            if low < 0.0 && high > 0.0 {
                let share = low / (low - high);
                let place = dot(along, a) + share * (dot(along, b) - dot(along, a));
                if (from..from + length).contains(&place) {
                    let xi = bonds.vector(i, j);
                    let alpha = material.influence.alpha_of(xi, material.horizon);
                    let kappa = bonds.volume_factor(i, j);
                    let volumes = cloud.volumes()[i] * cloud.volumes()[j];
                    let stretch = constants.critical_stretch;
                    let stiffness = constants.micromodulus * alpha * kappa * volumes;
                    energy += 0.5 * stiffness * bonds.length(i, j) * stretch * stretch;
                }
            }
        }
    }
    energy / length
}

#[test]
fn crack_plane_energies_with_anisotropic_spacing() {
    let sides = [DX, 0.75 * DX];
    let material = glass(Calibration::Lattice, breaking(FractureCalibration::Lattice));
    let state = StressState::PlaneStress;
    let found = material.constants_on(&sides, 0.2, state).unwrap();
    let lattice = BondLattice::of_material(&sides, 0.2, &material, &found).unwrap();
    let named = planes(&found);
    let expected = [
        ("(10)", [1.0, 0.0, 0.0]),
        ("(01)", [0.0, 1.0, 0.0]),
        ("(11)", [1.0 / sides[0], 1.0 / sides[1], 0.0]),
    ];
    assert_eq!(named.len(), 3);
    for ((name, share), (plane, normal)) in named.iter().zip(expected) {
        assert_eq!(name, plane);
        let size = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt();
        let energy = lattice.crack_energy(normal.map(|x| x / size))
            * material.density
            * found.critical_stretch.powi(2);
        assert!((share * ENERGY / energy - 1.0).abs() < 1e-9, "{name}");
    }
    let mean = 0.5 * (0.5 * (named[0].1 + named[1].1) + named[2].1);
    assert!((mean - 1.0).abs() < 1e-12);
}

#[test]
fn bodies_without_a_lattice_use_the_continuum_fracture_energy() {
    let grid = boxed([0.0; 3], &[8e-3, 8e-3], DX, 0.2);
    let free = PointCloud::new(2, grid.positions().to_vec(), grid.volumes().to_vec(), 0.2).unwrap();
    let state = StressState::PlaneStrain;
    let constants = |cloud: &PointCloud, calibration| {
        glass(Calibration::Continuum, breaking(calibration))
            .constants(cloud, state)
            .unwrap()
    };
    let listed = constants(&free, FractureCalibration::Lattice);
    let continuum = constants(&grid, FractureCalibration::Continuum);
    assert_eq!(
        listed.fracture_calibration,
        Some(FractureCalibration::Continuum)
    );
    assert!((listed.critical_stretch / continuum.critical_stretch - 1.0).abs() < 1e-12);
    assert!(listed.crack_planes.is_empty() && continuum.crack_planes.len() == 2);
}

#[test]
fn a_horizon_of_one_spacing_has_no_shear_stiffness() {
    let short = BondMaterial {
        horizon: DX,
        volume_correction: VolumeCorrection::None,
        ..glass(Calibration::Lattice, Fracture::Unbreakable)
    };
    for state in &STATES[1..] {
        let sides = vec![DX; state.dimension()];
        let constants = short.constants_on(&sides, 1.0, *state).unwrap();
        assert_eq!(constants.shear_error, -1.0);
        // Compared with the elastic constants of the lattice: C₁₂ = C₄₄ over E/(5/4 · ½) · ¼ and the like.
        let usual = glass(Calibration::Continuum, Fracture::Unbreakable);
        let constants = usual.constants_on(&sides, 1.0, *state).unwrap();
        let lattice = BondLattice::of_material(&sides, 1.0, &usual, &constants).unwrap();
        let shear = match state {
            StressState::PlaneStress => YOUNG / (2.0 * (1.0 + 1.0 / 3.0)),
            _ => YOUNG / 2.5,
        };
        let error = lattice.elasticity(0, 1, 0, 1) * usual.density / shear - 1.0;
        assert!((constants.shear_error - error).abs() < 1e-9, "{state:?}");
    }
}
