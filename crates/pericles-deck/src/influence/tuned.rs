//! Tuned influence functions: method, coefficients and dispersion errors.

use pericles::kernel::ClassOffset;
use pericles_deck_derive::DeckTable;
use pericles_dispersion::Stability;
use pericles_dispersion::tuning::{
    Assessment, BondClass, Combination, DispersionError, Method, ScalingModel, TunedTable, Tuning,
    Weights,
};
use serde::{Deserialize, Serialize};

use super::Setting;
use crate::form::described;
use crate::quantity::Quantity;
use crate::range::{POSITIVE, Range};
use crate::reader::Table;

/// Options of tuned kernels; the scope is the dimension of the body.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "Tuning", deny_unknown_fields)]
#[deck(remote = Tuning, scope = Option<usize>)]
struct TuningForm {
    /// tuned: functional of the dispersion residual R = ω² − V²|k|² on the boundary of the irreducible Brillouin
    /// zone that is minimised or set to zero. `least-squares`: ∮ R²; `point-collocation`: R at points;
    /// `subdomain-collocation`: ∫ R over segments; `galerkin`: ∫ w R with the contributions w of the classes to ω²;
    /// `galerkin-literal`: 1D only, all weights w from the classes; `absolute`: ∮ |R|.
    #[serde(with = "crate::form")]
    #[deck(default = Method::ALL[0])]
    method: Method,
    /// tuned: how the residuals of pressure waves (p) and shear waves (s) enter the functional F. `separated`: Σ
    /// F(R_p)² + F(R_s)²; `absolute`: Σ F(|R_p| + |R_s|)²; `signed-sum`: F(R_p + R_s) = 0, mostly unstable. method
    /// = "least-squares" needs `separated`.
    #[serde(with = "crate::form")]
    #[deck(default = Combination::ALL[0])]
    combination: Combination,
    #[serde(with = "crate::form")]
    #[deck(flatten)]
    weights: Weights,
    /// tuned: lower bound of the coefficients. "auto": none if the unconstrained kernel is stable, otherwise 0 (3D,
    /// and some horizons from 4 spacings in 2D); "none": no bound, unstable kernels are rejected; or a number.
    /// Bodies whose bonds break need a positive bound such as 0.5.
    #[serde(default)]
    #[deck(flatten, key = "lower_bound", with = lower_bound)]
    lower_bound: Option<f64>,
}

#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "Weights", deny_unknown_fields)]
#[deck(remote = Weights, scope = Option<usize>)]
struct WeightsForm {
    /// tuned, 2D and 3D: weight of the residuals of pressure waves.
    #[deck(
        key = "pressure_weight",
        range = POSITIVE,
        default = 1.0,
        forbid_if(scope == Some(1), ONE_WAVE)
    )]
    pressure: f64,
    /// tuned, 2D and 3D: weight of the residuals of shear waves.
    #[deck(
        key = "shear_weight",
        range = POSITIVE,
        default = 1.0,
        forbid_if(scope == Some(1), ONE_WAVE)
    )]
    shear: f64,
    /// tuned: decay wave number of the weight exp(−(|k| Δx/decay)²) of the residual at wave vector k, in rad per
    /// spacing; emphasises long waves. "none": equal weights, as published.
    #[serde(default)]
    #[deck(range = DECAYS, none = NONE, default = Some(Weights::DECAY))]
    decay: Option<f64>,
}

const NONE: &str = "none";
const AUTO: &str = "auto";
const ONE_WAVE: &str = "weights have no effect on a bar, which has pressure waves only";
const DECAYS: Range =
    POSITIVE.described("a positive number of rad per spacing (usual: 1), or \"none\"");

/// Reads the lower bound; none also for "auto", which means no bound if the kernel is stable without one, otherwise zero.
fn lower_bound<S>(table: &Table<'_>, _: S) -> Option<Option<f64>> {
    match table.optional("lower_bound") {
        Some(item) if item.is_keyword(AUTO) || item.is_keyword(NONE) => Some(None),
        Some(item) => item.quantity(Quantity::Number).map(Some),
        None => {
            table.record("lower_bound", AUTO);
            Some(None)
        }
    }
}

/// Optimises the coefficients for this grid.
pub(super) fn tuned(table: &Table<'_>, tuning: Tuning, setting: &Setting) -> Option<TunedTable> {
    let bound = table.optional("lower_bound");
    let is_automatic = bound.is_none_or(|item| item.word() == Some(AUTO));
    let spacing = setting.spacing?;
    let ratio = setting.horizon? / spacing;
    let model = table.accept(ScalingModel::new(
        setting.state?,
        ratio,
        setting.correction?,
    ))?;
    table.accept(match is_automatic {
        true => model.tune_stable(tuning),
        false => model.tune(tuning),
    })
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "TunedTable", deny_unknown_fields)]
struct TunedTableForm {
    #[serde(with = "crate::form")]
    tuning: Tuning,
    #[serde(with = "crate::form")]
    classes: Vec<BondClass>,
    alpha: Vec<f64>,
    active: Vec<usize>,
    #[serde(with = "crate::form")]
    condition: f64,
    #[serde(with = "crate::form")]
    kkt: f64,
    #[serde(with = "crate::form")]
    functionals: Vec<Vec<f64>>,
    #[serde(with = "crate::form")]
    assessment: Assessment,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "BondClass", deny_unknown_fields)]
struct BondClassForm {
    offset: ClassOffset,
    length: f64,
    multiplicity: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Assessment", deny_unknown_fields)]
struct AssessmentForm {
    #[serde(with = "crate::form")]
    error: DispersionError,
    #[serde(with = "crate::form")]
    constraints: Vec<f64>,
    #[serde(with = "crate::form")]
    stability: Stability,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "DispersionError", deny_unknown_fields)]
struct DispersionErrorForm {
    #[serde(with = "crate::form")]
    absolute: f64,
    #[serde(with = "crate::form")]
    ratio: f64,
    #[serde(with = "crate::form")]
    square: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Stability", deny_unknown_fields)]
struct StabilityForm {
    #[serde(with = "crate::form")]
    smallest: f64,
    #[serde(with = "crate::form")]
    smallest_at: [f64; 3],
    #[serde(with = "crate::form")]
    omega_max: f64,
    #[serde(with = "crate::form")]
    omega_max_at: [f64; 3],
}

described!(
    Tuning: TuningForm,
    Weights: WeightsForm,
    TunedTable: TunedTableForm,
    BondClass: BondClassForm,
    Assessment: AssessmentForm,
    DispersionError: DispersionErrorForm,
    Stability: StabilityForm,
);
