//! The influence function of a material.

use pericles::family::VolumeCorrection;
use pericles::kernel::{ClassOffset, ClassTable, Influence, InfluenceFunction};
use pericles::material::{StateInfluence, StressState};
use pericles_deck_derive::DeckTable;
use pericles_dispersion::tuning::{Combination, Method, ScalingModel, TunedTable, Tuning, Weights};
use serde::{Deserialize, Serialize};

use crate::declaration::DeckKeys;
use crate::fault::Fault;
use crate::form::described;
use crate::quantity::Quantity;
use crate::range::{POSITIVE, Range};
use crate::reader::{Item, Table};

/// Discretisation for which an influence function is made; none where the deck is invalid.
pub(crate) struct Setting {
    pub(crate) dimension: Option<usize>,
    pub(crate) state: Option<StressState>,
    /// Spacing, m.
    pub(crate) spacing: Option<f64>,
    /// Whether the spacing is unknown before a mesh is read.
    pub(crate) automatic: bool,
    /// Whether all cells are squares or cubes of one size.
    pub(crate) cells: bool,
    /// Horizon, m.
    pub(crate) horizon: Option<f64>,
    pub(crate) correction: Option<VolumeCorrection>,
}

/// The influence function of a material.
pub(crate) struct InfluenceRead {
    pub(crate) influence: Influence,
    /// The tuning result, if it is tuned.
    pub(crate) tuned: Option<TunedTable>,
}

/// Reads the influence function of a material.
pub(crate) fn influence(table: &Table<'_>, setting: &Setting) -> Option<InfluenceRead> {
    let table = table.table_or_empty("influence")?;
    let mut tuned = None;
    let function = function(&table, setting, &mut tuned);
    let acts_on = table.worded("acts_on", "argument");
    // Without the function, the allowed keys are unknown.
    let influence = Influence {
        function: function?,
        acts_on: acts_on?,
    };
    if let (Some(dimension), Some(horizon)) = (setting.dimension, setting.horizon) {
        table.accept(influence.check(dimension, horizon));
    }
    table.finish();
    Some(InfluenceRead { influence, tuned })
}

/// Reads the influence function of a state-based material. The default is the conical one, which is nearest
/// to isotropic on most lattices.
pub(crate) fn state_influence(table: &Table<'_>, setting: &Setting) -> Option<StateInfluence> {
    const FORMS: [(&str, Option<Form>); 7] = [
        ("conical", Some(Form::Conical)),
        ("constant", Some(Form::Constant)),
        ("inverse", Some(Form::Inverse)),
        ("power", Some(Form::Power)),
        ("gaussian", Some(Form::Gaussian)),
        ("tabulated", Some(Form::Tabulated)),
        ("isotropic", None),
    ];
    let table = table.table_or_empty("influence")?;
    table.forbid(
        "acts_on",
        "the influence function of a state-based material multiplies the bond extension; remove the key",
    );
    let form = table.choice_or_first("function", "influence function", &FORMS);
    let influence = match form? {
        None => StateInfluence::Isotropic,
        Some(form) => {
            let function = of_form(form, &table, setting, &mut None)?;
            if let (Some(dimension), Some(horizon)) = (setting.dimension, setting.horizon) {
                let influence = Influence {
                    function: function.clone(),
                    ..Influence::default()
                };
                table.accept(influence.check(dimension, horizon));
            }
            StateInfluence::Function(function)
        }
    };
    table.finish();
    Some(influence)
}

#[derive(Clone, Copy)]
enum Form {
    Constant,
    Conical,
    Inverse,
    Power,
    Gaussian,
    Tabulated,
    Cosines,
    Classes,
    Tuned,
}

fn function(
    table: &Table<'_>,
    setting: &Setting,
    tuned_table: &mut Option<TunedTable>,
) -> Option<InfluenceFunction> {
    const FORMS: [(&str, Form); 9] = [
        ("constant", Form::Constant),
        ("conical", Form::Conical),
        ("inverse", Form::Inverse),
        ("power", Form::Power),
        ("gaussian", Form::Gaussian),
        ("tabulated", Form::Tabulated),
        ("cosines", Form::Cosines),
        ("lattice-classes", Form::Classes),
        ("tuned", Form::Tuned),
    ];
    let form = table.choice_or_first("function", "influence function", &FORMS)?;
    of_form(form, table, setting, tuned_table)
}

/// Reads the keys of a kind of function.
fn of_form(
    form: Form,
    table: &Table<'_>,
    setting: &Setting,
    tuned_table: &mut Option<TunedTable>,
) -> Option<InfluenceFunction> {
    match form {
        Form::Constant => Some(InfluenceFunction::Constant),
        Form::Conical => Some(InfluenceFunction::Conical),
        Form::Inverse => Some(InfluenceFunction::Inverse),
        Form::Power => Some(InfluenceFunction::Power {
            exponent: table.required("exponent")?.quantity(Quantity::Number)?,
        }),
        Form::Gaussian => {
            let length = table
                .required("length")
                .and_then(|item| item.positive(Quantity::Length));
            let cutoff = table.maybe("cutoff", |item| item.positive(Quantity::Length));
            Some(InfluenceFunction::Gaussian {
                length: length?,
                cutoff: cutoff?,
            })
        }
        Form::Tabulated => tabulated(table, setting),
        Form::Cosines => cosines(table, setting),
        Form::Classes | Form::Tuned if !setting.cells => {
            if let Some(item) = table.optional("function") {
                item.out_of_range(
                    "a function of the bond length; bond classes require square and cubic cells, with one `spacing` for all axes",
                );
            }
            None
        }
        Form::Classes => classes(table, setting),
        Form::Tuned => {
            let found = tuned(table, setting)?;
            let influence = table.accept(found.influence(setting.dimension?, setting.spacing?))?;
            *tuned_table = Some(found);
            Some(influence.function)
        }
    }
}

/// Reads the unit of lengths in a table, m, and the quantity of its numbers.
fn unit(table: &Table<'_>, setting: &Setting) -> Option<(Option<f64>, Quantity)> {
    const UNITS: [(&str, usize); 3] = [("length", 0), ("spacing", 1), ("horizon", 2)];
    let unit = table.choice_or_first("r", "unit of lengths", &UNITS)?;
    reject_spacing(table, setting, unit == 1);
    let quantity = if unit == 0 {
        Quantity::Length
    } else {
        Quantity::Number
    };
    Some((
        [Some(1.0), setting.spacing, setting.horizon][unit],
        quantity,
    ))
}

/// Rejects lengths in spacings if the spacing is unknown before a mesh is read.
fn reject_spacing(table: &Table<'_>, setting: &Setting, counts_spacings: bool) {
    if setting.automatic && counts_spacings {
        table.report(Fault::OutOfRange {
            value: "spacing".into(),
            allowed: "another unit `r`, or a `spacing` in [body]; the spacing of this mesh is unknown before the mesh is read".into(),
        });
    }
}

/// Reads a table whose first column is a length, in metres, spacings or horizons.
fn tabulated(table: &Table<'_>, setting: &Setting) -> Option<InfluenceFunction> {
    let unit = unit(table, setting);
    let rows = table
        .required("table")
        .and_then(|item| item.list("a list of pairs [r, value]"));
    let (scale, quantity) = unit?;
    let pairs: Vec<Option<(f64, f64)>> = rows?.iter().map(|row| pair(row, quantity)).collect();
    let pairs: Vec<(f64, f64)> = pairs.into_iter().collect::<Option<_>>()?;
    let scale = scale?;
    Some(InfluenceFunction::Tabulated {
        table: pairs.iter().map(|(r, value)| (r * scale, *value)).collect(),
    })
}

/// Reads a₀ + Σ a_j cos(j w r/unit).
fn cosines(table: &Table<'_>, setting: &Setting) -> Option<InfluenceFunction> {
    const UNITS: [(&str, usize); 2] = [("spacing", 0), ("horizon", 1)];
    let unit = table.choice_or_first("r", "unit of lengths", &UNITS);
    reject_spacing(table, setting, unit == Some(0));
    let wavenumber = table
        .required("wavenumber")
        .and_then(|item| item.positive(Quantity::Number));
    let list = table
        .required("coefficients")
        .and_then(|item| item.list("a list of numbers a0, a1, …"));
    let coefficients: Vec<Option<f64>> = list?
        .iter()
        .map(|item| item.quantity(Quantity::Number))
        .collect();
    let coefficients = coefficients.into_iter().collect::<Option<_>>();
    let scale = [setting.spacing, setting.horizon][unit?]?;
    Some(InfluenceFunction::Cosines {
        wavenumber: wavenumber? / scale,
        coefficients: coefficients?,
    })
}

/// Reads a value per class of lattice bonds, such as `[[[1, 0], 3.7], [[1, 1], 2.9]]`.
fn classes(table: &Table<'_>, setting: &Setting) -> Option<InfluenceFunction> {
    let rows = table
        .required("table")?
        .list("a list of pairs [[i, j, …], value]")?;
    let entries: Vec<Option<(ClassOffset, f64)>> =
        rows.iter().map(|row| class(row, setting)).collect();
    let entries: Vec<(ClassOffset, f64)> = entries.into_iter().collect::<Option<_>>()?;
    let (dimension, spacing) = (setting.dimension?, setting.spacing?);
    let classes = table.accept(ClassTable::new(dimension, spacing, &entries))?;
    Some(InfluenceFunction::Classes(classes))
}

fn class(row: &Item<'_>, setting: &Setting) -> Option<(ClassOffset, f64)> {
    let items = row.exactly(2, "a pair [[i, j, …], value]")?;
    let value = items[1].quantity(Quantity::Number);
    let steps = items[0].exactly(setting.dimension?, "one whole number per axis")?;
    let mut offset = [0; 3];
    for (step, item) in offset.iter_mut().zip(&steps) {
        let whole = item.within(
            Quantity::Number,
            "a whole number of spacings from −100 to 100",
            |x| x.fract() == 0.0 && x.abs() <= 100.0,
        )?;
        *step = whole as i32;
    }
    Some((offset, value?))
}

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

described!(Tuning: TuningForm, Weights: WeightsForm);

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

/// Reads the tuning options and optimises the coefficients for this grid.
fn tuned(table: &Table<'_>, setting: &Setting) -> Option<TunedTable> {
    let tuning = Tuning::read_keys(table, setting.dimension)?;
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

fn pair(row: &Item<'_>, quantity: Quantity) -> Option<(f64, f64)> {
    let items = row.exactly(2, "a pair [r, value]")?;
    let (r, value) = (
        items[0].quantity(quantity),
        items[1].quantity(Quantity::Number),
    );
    Some((r?, value?))
}
