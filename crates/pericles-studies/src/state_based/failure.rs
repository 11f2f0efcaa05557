//! What it costs to tear a linear peridynamic solid: halves pulled apart, and cracks along the planes of its lattice.

use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, CrackPlane, FractureCalibration, LinearSolid, LinearSolidConstants,
    StateInfluence, StressState, StretchDefinition,
};
use pericles_run::RunError;

use super::separation::energy_spent;
use super::stencil::{bonds, weighted_volume};
use super::{influence_words, solid, state_words};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "state-based/failure",
    paper: "Foster, Silling & Chen 2011, Int. J. Multiscale Comput. Eng. 9",
    title: "Fracture energy of linear peridynamic solids: rigid separation, planes of the lattice",
    run,
};

/// The fracture energy asked for, J/m².
const G0: f64 = 1e-3;

/// Poisson's ratios of the table.
const RATIOS: [f64; 4] = [0.1, 0.25, 1.0 / 3.0, 0.4];

fn run(_: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    for (state, spacings, values) in separations() {
        for ((words, failure), values) in criteria(FractureCalibration::Continuum)
            .into_iter()
            .zip(values)
        {
            for (nu, expected) in RATIOS.into_iter().zip(values) {
                let spent = energy_spent(state, spacings, nu, failure)?;
                let state = state_words(state);
                let case =
                    format!("halves pulled apart: {state}, m = {spacings}, {words}, ν = {nu:.2}");
                let found = spent.map(|spent| spent / G0);
                rows.push(Row::new(case, "", found).within_share(expected, 0.02));
            }
        }
    }
    rows.extend(planes()?);
    Ok(rows)
}

/// The three definitions of the critical stretch, and the bond energy.
fn criteria(calibration: FractureCalibration) -> [(&'static str, BondFailure); 4] {
    let stretch = |definition| BondFailure::Stretch {
        fracture_energy: G0,
        definition,
        calibration,
    };
    [
        ("stretch (bond)", stretch(StretchDefinition::Bond)),
        ("stretch (closing)", stretch(StretchDefinition::Closing)),
        ("stretch (iso)", stretch(StretchDefinition::Isotropic)),
        (
            "bond energy",
            BondFailure::BondEnergy {
                fracture_energy: G0,
                calibration,
            },
        ),
    ]
}

/// Energy spent over G₀ with w = 1 and whole volumes, by criterion and Poisson's ratio, to the two or three digits of the table.
fn separations() -> [(StressState, usize, [[f64; 4]; 4]); 2] {
    [
        (
            StressState::Spatial,
            3,
            [
                [0.92, 1.032, 1.18, 1.47],
                [1.08, 1.032, 0.99, 0.93],
                [3.74, 1.032, 0.59, 0.37],
                [1.105, 1.104, 1.104, 1.105],
            ],
        ),
        (
            StressState::PlaneStrain,
            6,
            [
                [0.90, 0.992, 1.11, 1.35],
                [1.04, 0.992, 0.95, 0.89],
                [2.38, 0.992, 0.61, 0.39],
                [0.997, 0.998, 0.997, 0.997],
            ],
        ),
    ]
}

/// Limits calibrated on the lattice: the mean over the planes is the energy asked for, and that of each plane the sum over the layers of points beside it.
fn planes() -> Result<Vec<Row>, RunError> {
    let lattice = criteria(FractureCalibration::Lattice);
    let [_, closing, _, energy] = lattice;
    let mut rows = Vec::new();
    for state in [StressState::PlaneStrain, StressState::Spatial] {
        for spacings in [3, 4, 5] {
            let gaussian = InfluenceFunction::Gaussian {
                length: 0.5 * spacings as f64,
                cutoff: None,
            };
            for influence in [
                StateInfluence::Function(InfluenceFunction::Constant),
                StateInfluence::Function(InfluenceFunction::Conical),
                StateInfluence::Function(gaussian),
                StateInfluence::Isotropic,
            ] {
                for (words, failure) in [closing, energy] {
                    let state_word = state_words(state);
                    let of = influence_words(&influence);
                    let case = format!("{state_word}, m = {spacings}, {of}, {words}");
                    let material = LinearSolid {
                        failure,
                        ..solid(0.2, spacings, influence.clone(), VolumeCorrection::None)
                    };
                    let sides = vec![1.0; state.dimension()];
                    match material.constants_on(&sides, 1.0, state) {
                        Ok(constants) => {
                            rows.extend(of_planes(&case, &material, &constants, state))
                        }
                        // Weights that are negative near the horizon.
                        Err(refused) => {
                            rows.push(Row::new(case, "", None).note(format!("refused: {refused}")));
                        }
                    }
                }
            }
        }
    }
    Ok(rows)
}

fn of_planes(
    case: &str,
    material: &LinearSolid,
    constants: &LinearSolidConstants,
    state: StressState,
) -> Vec<Row> {
    let planes = &constants.crack_planes;
    let mean = CrackPlane::mean(planes) / G0;
    let mut rows = vec![
        Row::new(format!("mean over planes over G₀: {case}"), "", Some(mean)).within(1.0, 1e-10),
    ];
    // (10) and (11), or (100), (110) and (111).
    for (plane, order) in planes.iter().zip(1..) {
        let found = plane.energy() / G0;
        let expected = of_layers(material, constants, state.dimension(), order) / G0;
        rows.push(
            Row::new(format!("plane {plane} over G₀: {case}"), "", Some(found))
                .within_share(expected, 1e-6)
                .note(format!("{:+.1} %", 100.0 * (expected - 1.0))),
        );
    }
    rows
}

/// Energy per area of a crack between two layers of points, the normal of which has `order` ones and otherwise zeros, where only the bonds across it are stretched by the critical stretch, or store the
/// critical energy.
///
/// A point k + 1/2 layers from the plane has the share p_k = (1/m) Σ ω r² of bonds that cross it. Per area the points of a layer take the distance h of layers. So G = s₀² h Σ_k (B p_k + A D p_k²) of both sides,
/// or w_c h Σ_k Σ b V over the bonds that cross.
fn of_layers(
    material: &LinearSolid,
    constants: &LinearSolidConstants,
    dimension: usize,
    order: usize,
) -> f64 {
    let (horizon, correction) = (material.horizon, material.volume_correction);
    let bonds = bonds(dimension, &constants.influence, horizon, correction);
    let m = weighted_volume(&bonds);
    let distance = 1.0 / (order as f64).sqrt();
    let layers = |xi: [i32; 3]| xi[..order].iter().sum::<i32>();
    let furthest = bonds.iter().map(|bond| layers(bond.xi)).max();
    let limits = constants.limits;
    let of_layer = |k: i32| {
        let across = bonds.iter().filter(|bond| layers(bond.xi) > k);
        if limits.stretch.is_infinite() {
            // Bonds at the horizon whose influence vanishes do no work and do not break.
            let worked = across.filter(|bond| bond.weight > 1e-5 * bond.volume);
            return limits.energy * worked.map(|bond| bond.volume).sum::<f64>();
        }
        let share: f64 = across
            .map(|bond| bond.weight * bond.length * bond.length / m)
            .sum();
        let dilatational = constants.dilatational * dimension as f64 * share * share;
        limits.stretch.powi(2) * (constants.deviatoric * share + dilatational)
    };
    distance * (0..furthest.unwrap_or(0)).map(of_layer).sum::<f64>()
}
