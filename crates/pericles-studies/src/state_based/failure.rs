//! Fracture energy of linear peridynamic solids: rigid separation of halves, and cracks along lattice planes.

use pericles::family::VolumeCorrection;
use pericles::material::{
    BondFailure, CrackPlane, FractureCalibration, IsotropicInfluence, LinearSolid,
    LinearSolidConstants, StressState, StretchDefinition,
};
use pericles_run::RunError;

use super::separation::energy_spent;
use super::stencil::{bonds, weighted_volume};
use super::{influence_of, solid, state_of};
use crate::data::{Case, Found};
use crate::row::{Row, Rule};

/// Requested fracture energy, J/m².
const G0: f64 = 1e-3;

/// Failure of the argument `criterion`: a definition of the critical stretch, or the bond energy.
fn failure_of(case: &Case<'_>, calibration: FractureCalibration) -> Result<BondFailure, RunError> {
    let stretch = |definition| BondFailure::Stretch {
        fracture_energy: G0,
        definition,
        calibration,
    };
    let energy = BondFailure::BondEnergy {
        fracture_energy: G0,
        calibration,
    };
    let criteria = [
        ("stretch (bond)", stretch(StretchDefinition::Bond)),
        ("stretch (closing)", stretch(StretchDefinition::Closing)),
        ("stretch (iso)", stretch(StretchDefinition::Isotropic)),
        ("bond energy", energy),
    ];
    case.one_of("criterion", &criteria)
}

/// Work of separation of two halves over G₀, with w = 1 and full volumes.
pub(super) fn separation(case: &Case<'_>) -> Result<Found, RunError> {
    let failure = failure_of(case, FractureCalibration::Continuum)?;
    let spent = energy_spent(
        state_of(case)?,
        case.count("m")?,
        case.number("nu")?,
        failure,
    )?;
    Ok(Found::default().value("value", spent.map(|spent| spent / G0)))
}

/// Rows of limits calibrated on the lattice: the mean over the planes is the requested energy, and that of each
/// plane equals the sum over the layers of points beside it. Isotropic functions that are negative near the horizon
/// are refused.
pub(super) fn planes(case: &Case<'_>) -> Result<Found, RunError> {
    let (state, name) = (state_of(case)?, case.text("name")?);
    let failure = failure_of(case, FractureCalibration::Lattice)?;
    let material = LinearSolid {
        failure,
        ..solid(
            0.2,
            case.count("m")?,
            influence_of(case)?,
            VolumeCorrection::None,
        )
    };
    let sides = vec![1.0; state.dimension()];
    let rows = match material.constants_on(&sides, 1.0, state) {
        Ok(constants) => of_planes(&name, &material, &constants, state),
        Err(refused) => {
            let horizon = material.horizon;
            let found = IsotropicInfluence::of_lattice(&sides, horizon, VolumeCorrection::None)?;
            let label = format!("weight at the horizon of a function that is refused: {name}");
            vec![
                Row::new(label, "", Some(1.0 - found.coefficient()))
                    .judged(0.0, Rule::AtMost)
                    .note(refused.to_string()),
            ]
        }
    };
    Ok(rows.into())
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
    // Planes (10) and (11), or (100), (110) and (111).
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

/// Energy per area of a crack between two layers of points whose normal has `order` ones and otherwise zeros. Only
/// the bonds across it are stretched by the critical stretch, or store the critical energy.
///
/// A point k + 1/2 layers from the plane has the fraction p_k = (1/m) Σ ω r² of bonds that cross it. Per area the
/// points of a layer represent the distance h of layers. Hence G = s₀² h Σ_k (B p_k + A D p_k²) of both sides, or
/// w_c h Σ_k Σ b V over the bonds that cross.
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
