//! Stiffness error of a bar due to the missing bonds of its surface points.

use std::sync::Arc;

use pericles::material::{LinearSolid, SolidSurface, Strains, StressState};
use pericles::operator::{BondForm, Force, LinearSolidBody, PointSubset};
use pericles::solve::{SolveLimits, Work, conjugate_gradient};
use pericles_run::RunError;

use super::{cells, correction_of, influence_of, solid};
use crate::data::{Case, Found};

/// Ratio of the Young's modulus of a bar `count` cells long to that of the material: without and with surface
/// correction, with ghost layers, and inside the lattice.
pub(super) fn bar(case: &Case<'_>) -> Result<Found, RunError> {
    let (count, correction) = (case.count("count")?, correction_of(case)?);
    let material = solid(
        case.number("nu")?,
        case.count("m")?,
        influence_of(case)?,
        correction,
    );
    Ok([
        ("bare", measured(count, &material, SolidSurface::None)?),
        (
            "corrected",
            measured(count, &material, SolidSurface::Energy)?,
        ),
        ("ghosts", measured(count, &material, SolidSurface::Ghosts)?),
        ("inside", interior(&material)?),
    ]
    .into())
}

const STATE: StressState = StressState::PlaneStress;

/// Ratio of the Young's modulus of a plate twice as long as wide under plane stress, pulled at its end rows, to
/// that of the material, from the strain of its middle half.
fn measured(count: usize, material: &LinearSolid, surface: SolidSurface) -> Result<f64, RunError> {
    let length = count as f64;
    let cloud = Arc::new(cells(&[count, count / 2])?);
    let constants = material.constants(&cloud, STATE)?;
    let body = LinearSolidBody {
        strains: Strains::Small,
        surface,
        ..LinearSolidBody::new(&cloud, &constants, material.volume_correction)
    };
    let operator = body.operator(BondForm::Fastest)?.operator;
    let (n, along) = (cloud.len(), cloud.axis(0));
    let mut load = vec![0.0; 2 * n];
    for i in 0..n {
        load[i] = match along[i] {
            x if x < 1.0 => -1.0,
            x if x > length - 1.0 => 1.0,
            _ => 0.0,
        };
    }
    let u = equilibrium(&*operator, &load)?;
    let section = |place: f64| {
        let near = (0..n).filter(|&i| (along[i] - place).abs() < 0.6);
        let values: Vec<f64> = near.map(|i| u[i]).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let strain = (section(0.75 * length) - section(0.25 * length)) / (0.5 * length);
    Ok(1.0 / strain / constants.elastic.young())
}

/// The same ratio for the interior of the lattice: 4/E = 1/κ + 1/G of the diagonals.
fn interior(material: &LinearSolid) -> Result<f64, RunError> {
    let constants = material.constants_on(&[1.0; 2], 1.0, STATE)?;
    let elastic = constants.elastic;
    let shear = constants.lattice_shear.map_or(1.0, |shear| shear.diagonals) * elastic.shear();
    let kappa = elastic.dilatation_modulus(STATE);
    Ok(4.0 / (1.0 / kappa + 1.0 / shear) / elastic.young())
}

/// Displacement in equilibrium with the load; rigid motions stay zero, because the load has none.
fn equilibrium(operator: &dyn Force, load: &[f64]) -> Result<Vec<f64>, RunError> {
    let mut apply = |u: &[f64], out: &mut [f64]| {
        out.fill(0.0);
        operator.add_force(0.0, u, PointSubset::All, out);
        out.iter_mut().for_each(|force| *force = -*force);
    };
    let limits = SolveLimits {
        relative: 1e-9,
        iterations: 5000,
        ..SolveLimits::default()
    };
    let mut u = vec![0.0; load.len()];
    let mut work = Work::new(load.len());
    conjugate_gradient(&mut apply, load, &mut u, &limits, &mut work)?;
    Ok(u)
}
