//! Linear peridynamic solids compared with tables of an independent implementation in another language.

mod failure;
mod lattice;
mod separation;
mod stencil;
mod surface;

use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{BondFailure, GivenConstants, LinearSolid, StateInfluence, StressState};
use pericles::space::PointCloud;
use pericles_run::RunError;

use crate::common;
use crate::data::Case;
use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("state-based/lattice"),
        data!("state-based/surface"),
        data!("state-based/failure"),
    ],
    measures: &[
        ("shear", lattice::shear),
        ("isotropic-function", lattice::isotropic),
        ("stable-step", lattice::stable_step),
        ("highest-frequency", lattice::periodic_body),
        ("bar", surface::bar),
        ("separation", failure::separation),
        ("planes", failure::planes),
    ],
};

/// Unbreakable solid with E = 10 Pa and ρ = 1 kg/m³ on cells of 1 m, with a horizon of a whole number of spacings
/// plus one millionth.
fn solid(
    poisson_ratio: f64,
    spacings: usize,
    influence: StateInfluence,
    volume_correction: VolumeCorrection,
) -> LinearSolid {
    LinearSolid {
        density: 1.0,
        elastic: GivenConstants {
            young: Some(10.0),
            poisson_ratio: Some(poisson_ratio),
            ..GivenConstants::default()
        },
        horizon: horizon(spacings),
        influence,
        volume_correction,
        failure: BondFailure::Unbreakable,
    }
}

/// Horizon of a whole number of spacings of 1 m, increased by one millionth so that round-off loses no bond.
fn horizon(spacings: usize) -> f64 {
    spacings as f64 * (1.0 + 1e-6)
}

/// Box of cells of 1 m.
fn cells(counts: &[usize]) -> Result<PointCloud, RunError> {
    let size = counts.iter().map(|&count| count as f64).collect();
    common::cells([0.0; 3], size, 1.0)
}

/// Stress state of the argument `state`.
fn state_of(case: &Case<'_>) -> Result<StressState, RunError> {
    let states = [
        ("3D", StressState::Spatial),
        ("plane strain", StressState::PlaneStrain),
        ("plane stress", StressState::PlaneStress),
    ];
    case.one_of("state", &states)
}

/// Influence function of the argument `function`; the length of a Gaussian is half the horizon.
fn function_of(case: &Case<'_>) -> Result<InfluenceFunction, RunError> {
    let gaussian = InfluenceFunction::Gaussian {
        length: 0.5 * case.number("m")?,
        cutoff: None,
    };
    let functions = [
        ("w = 1", InfluenceFunction::Constant),
        ("w = δ/r", InfluenceFunction::Inverse),
        ("w = 1 − r/δ", InfluenceFunction::Conical),
        ("Gaussian", gaussian),
    ];
    case.one_of("function", &functions)
}

/// Influence function of the argument `function`, which may be `isotropic`.
fn influence_of(case: &Case<'_>) -> Result<StateInfluence, RunError> {
    match &case.text("function")?[..] {
        "isotropic" => Ok(StateInfluence::Isotropic),
        _ => function_of(case).map(StateInfluence::Function),
    }
}

/// Volume correction of the argument `volumes`.
fn correction_of(case: &Case<'_>) -> Result<VolumeCorrection, RunError> {
    let corrections = [
        ("whole volumes", VolumeCorrection::None),
        ("partial volumes", VolumeCorrection::Linear),
    ];
    case.one_of("volumes", &corrections)
}
