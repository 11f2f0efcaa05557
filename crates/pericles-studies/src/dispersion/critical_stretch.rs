//! Critical stretches of two glasses with the original and the tuned influence functions, and crack energies on the
//! lattice.

use pericles::family::VolumeCorrection;
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, FractureCalibration, Modulus, PairLaw,
    StressState,
};
use pericles_dispersion::BondLattice;
use pericles_dispersion::tuning::{Method, influence_alebrahim, polygon};
use pericles_run::RunError;

use super::models::{model, tuned};
use crate::common::cells;
use crate::data::{Case, Found};

/// Spacing, m; the horizon is 0.75 mm.
const DX: f64 = 0.25e-3;

/// Influence function of the argument `influence`: α = 1, the printed cosines, the positive table, or its linear
/// interpolation.
fn influence(case: &Case<'_>) -> Result<Influence, RunError> {
    let model = model(StressState::PlaneStrain, 3.0)?;
    let table = tuned(&model, Method::LeastSquares, Some(0.5))?;
    let classes = table.influence(2, DX)?.function;
    let line = match &classes {
        InfluenceFunction::Classes(table) => polygon(table),
        other => other.clone(),
    };
    let functions = [
        ("α = 1", InfluenceFunction::Constant),
        ("cosines", influence_alebrahim(DX)),
        ("positive table", classes),
        ("polygon", line),
    ];
    Ok(Influence {
        function: case.one_of("influence", &functions)?,
        acts_on: ActsOn::Stretch,
    })
}

/// Critical stretch of a glass with Young's modulus `young` and fracture energy `energy`, and its ratio to the
/// `printed` one.
pub(super) fn critical_stretch(case: &Case<'_>) -> Result<Found, RunError> {
    let calibrations = [
        ("unmodified", Calibration::Unmodified),
        ("continuum", Calibration::Continuum),
    ];
    let cloud = cells([0.0; 3], vec![8.0 * DX; 2], DX)?;
    let material = BondMaterial {
        law: PairLaw::BondStretch,
        density: 1.0,
        modulus: Modulus {
            value: ElasticModulus::Young(case.number("young")?),
            calibration: case.one_of("calibration", &calibrations)?,
        },
        horizon: 3.0 * DX,
        influence: influence(case)?,
        volume_correction: VolumeCorrection::None,
        fracture: Fracture::Energy {
            energy: case.number("energy")?,
            calibration: FractureCalibration::Continuum,
        },
    };
    let found = material
        .constants(&cloud, StressState::PlaneStrain)?
        .critical_stretch;
    let over = case.optional("printed").map(|printed| found / printed);
    Ok(Found::from(found).value("over printed", over))
}

/// G over c s₀² D⁴ for a crack along a grid line or along the diagonal.
pub(super) fn crack_energy(case: &Case<'_>) -> Result<Found, RunError> {
    let half = 0.5f64.sqrt();
    let normals = [
        ("grid line", [0.0, 1.0, 0.0]),
        ("diagonal", [half, half, 0.0]),
    ];
    let influence = influence(case)?;
    // c = s₀ = D = 1; the table belongs to the spacing for which it was made.
    let lattice = BondLattice::new(&[1.0, 1.0], 3.0 + 1e-9, |_, xi, _| {
        influence.alpha_of(xi.map(|x| x * DX), 3.0 * DX)
    })?;
    Ok(lattice.crack_energy(case.one_of("line", &normals)?).into())
}
