//! Studies of linear peridynamic solids, against tables computed by an independent implementation in another language.

mod failure;
mod lattice;
mod separation;
mod stencil;
mod surface;

use pericles::Result;
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{BondFailure, GivenConstants, LinearSolid, StateInfluence, StressState};
use pericles::space::{Grid, PointCloud, Shape};

use crate::study::Study;

/// The studies of this topic.
pub(super) const STUDIES: [Study; 3] = [lattice::STUDY, surface::STUDY, failure::STUDY];

/// A solid with E = 10 Pa and ρ = 1 kg/m³ on cells of 1 m, with a horizon of so many spacings and a millionth more, that does not break.
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

/// A horizon of so many spacings of 1 m, longer by a millionth so that rounding loses no bond.
fn horizon(spacings: usize) -> f64 {
    spacings as f64 * (1.0 + 1e-6)
}

/// A box of cells of 1 m.
fn cells(counts: &[usize]) -> Result<PointCloud> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: counts.iter().map(|&count| count as f64).collect(),
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    grid.points()
}

fn state_words(state: StressState) -> &'static str {
    match state {
        StressState::Spatial => "3D",
        StressState::PlaneStrain => "plane strain",
        StressState::PlaneStress => "plane stress",
        StressState::Uniaxial => "bar",
    }
}

fn function_words(function: &InfluenceFunction) -> &'static str {
    match function {
        InfluenceFunction::Constant => "w = 1",
        InfluenceFunction::Inverse => "w = δ/r",
        InfluenceFunction::Conical => "w = 1 − r/δ",
        InfluenceFunction::Gaussian { .. } => "Gaussian",
        _ => "another function",
    }
}

fn influence_words(influence: &StateInfluence) -> &'static str {
    match influence {
        StateInfluence::Function(function) => function_words(function),
        StateInfluence::Isotropic => "isotropic",
    }
}

fn correction_words(correction: VolumeCorrection) -> &'static str {
    match correction {
        VolumeCorrection::None => "whole volumes",
        _ => "partial volumes",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Row;
    use crate::study::Context;

    #[test]
    fn studies_hold() {
        let context = Context::without_figures();
        for study in &STUDIES {
            let rows = (study.run)(&context).unwrap();
            let failed: Vec<Row> = rows
                .into_iter()
                .filter(|row| row.pass() == Some(false))
                .collect();
            assert!(failed.is_empty(), "{}: {failed:#?}", study.id);
        }
    }
}
