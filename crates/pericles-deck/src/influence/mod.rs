//! The influence function of a material.

mod tuned;

use pericles::family::VolumeCorrection;
use pericles::kernel::{ActsOn, ClassOffset, ClassTable, Influence, InfluenceFunction};
use pericles::material::StressState;
use pericles_deck_derive::{DeckKeys, DeckTable, DeckWords};
use pericles_dispersion::tuning::{TunedTable, Tuning};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use self::tuned::tuned;
use crate::declaration::DeckTable;
use crate::fault::Fault;
use crate::form::{Described, described};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};

/// Discretisation for which an influence function is made; none where the deck is invalid.
#[derive(Clone, Copy)]
pub(crate) struct Setting {
    pub(crate) dimension: Option<usize>,
    pub(crate) state: Option<StressState>,
    /// Spacing, m.
    pub(crate) spacing: Option<f64>,
    /// Whether the spacing is unknown before the file of the body is read.
    pub(crate) automatic: bool,
    /// Whether all cells are squares or cubes of one size.
    pub(crate) cells: bool,
    /// Horizon, m.
    pub(crate) horizon: Option<f64>,
    pub(crate) correction: Option<VolumeCorrection>,
    /// Whether the function weights the bond extensions of a state-based or correspondence material.
    pub(crate) is_state_based: bool,
}

/// Reads the influence function of a material, with the tuning result if it is tuned; no function if it follows from the
/// lattice.
pub(crate) fn influence(
    table: &Table<'_>,
    setting: &Setting,
) -> Option<(Option<Influence>, Option<TunedTable>)> {
    let inner = || table.table_or_empty("influence");
    let given = GivenInfluence::read_table(inner()?, setting)?;
    let (table, mut tuned) = (inner()?, None);
    let function = given.function.made(&table, setting, &mut tuned)?;
    let influence = function.map(|function| Influence {
        function,
        acts_on: given.acts_on,
    });
    if let (Some(influence), Some(dimension), Some(horizon)) =
        (&influence, setting.dimension, setting.horizon)
    {
        table.accept(influence.check(dimension, horizon));
    }
    Some((influence, tuned))
}

/// Influence function: weight of a bond as a function of its length.
#[derive(DeckTable)]
#[deck(scope = &'s Setting)]
struct GivenInfluence {
    #[deck(flatten)]
    function: GivenFunction,
    /// Quantity that the influence function multiplies: the bond stretch or the relative displacement.
    #[deck(
        default = ActsOn::Stretch,
        forbid_if(
            scope.is_state_based,
            "the influence function of a state-based material multiplies the bond extension; remove the key"
        )
    )]
    acts_on: ActsOn,
}

/// Influence function α(r) for bond length r ≤ δ. `constant`: 1; `conical`: 1 − r/δ; `inverse`: 1/r; `power`:
/// (r/δ)^exponent; `gaussian`: exp(−(r/length)²); `tabulated`: piecewise linear; `cosines`: a0 + Σ a_j cos(j ·
/// wavenumber · r); `lattice-classes`: one value per class of equivalent lattice bonds; `tuned`: lattice classes
/// optimised for low numerical dispersion on this grid and horizon; `isotropic`, state-based only: 1 − c r/δ with c
/// such that the shear modulus on square or cubic grids is isotropic. State-based materials have no `cosines`,
/// `lattice-classes` and `tuned`; their default is `conical`.
#[derive(DeckKeys)]
#[deck(
    tag = "function",
    what = "influence function",
    scope = &'s Setting,
    // The conical function is nearest to isotropic on most lattices.
    default = Some(if scope.is_state_based { "conical" } else { "constant" })
)]
enum GivenFunction {
    Constant,
    Conical,
    Inverse,
    Power {
        /// power: exponent of α = (r/δ)^exponent. The elastic modulus must be finite: above −2 in 1D, −3 in 2D, −4 in
        /// 3D.
        #[deck(quantity = Number)]
        exponent: f64,
    },
    Gaussian {
        /// gaussian: length l of α = exp(−(r/l)²).
        #[deck(quantity = Length, range = POSITIVE)]
        length: f64,
        /// gaussian: largest bond length. Default: the horizon.
        #[deck(quantity = Length, range = POSITIVE)]
        cutoff: Option<f64>,
    },
    Tabulated {
        /// tabulated, cosines: unit of r and 1/wavenumber: metres, spacings or horizons.
        #[deck(default = LengthUnit::Length)]
        r: LengthUnit,
        /// tabulated: pairs [r, value].
        #[deck(key = "table", required, with = pairs, scope = r.copied())]
        pairs: Vec<(f64, f64)>,
    },
    #[deck(allow_if(!scope.is_state_based, OF_LENGTH))]
    Cosines {
        /// tabulated, cosines: unit of r and 1/wavenumber: metres, spacings or horizons.
        #[deck(
            default = LengthUnit::Spacing,
            allow_if(r != Some(&LengthUnit::Length), "\"spacing\" or \"horizon\"")
        )]
        r: LengthUnit,
        /// cosines: lowest wave number, in rad per unit `r`.
        #[deck(range = POSITIVE)]
        wavenumber: f64,
        /// cosines: coefficients a0, a1, …
        #[deck(required, with = numbers)]
        coefficients: Vec<f64>,
    },
    #[deck(word = "lattice-classes", allow_if(!scope.is_state_based, OF_LENGTH), allow_if(scope.cells, NO_CLASSES))]
    Classes {
        /// lattice-classes: pairs [[i, j, …], value] with the bond vector in spacings.
        #[deck(key = "table", required, with = classes)]
        classes: Vec<(ClassOffset, f64)>,
    },
    #[deck(allow_if(!scope.is_state_based, OF_LENGTH), allow_if(scope.cells, NO_CLASSES))]
    Tuned(#[deck(flatten, scope = scope.dimension)] Tuning),
    #[deck(allow_if(scope.is_state_based, "another function; `isotropic` requires model = \"state-based\" or \"correspondence\""))]
    Isotropic,
}

/// Unit of the lengths in a table.
#[derive(Debug, Clone, Copy, PartialEq, DeckWords)]
#[deck(what = "unit of lengths")]
enum LengthUnit {
    Length,
    Spacing,
    Horizon,
}

const OF_LENGTH: &str = "\"conical\", \"constant\", \"inverse\", \"power\", \"gaussian\", \"tabulated\" or \"isotropic\" with model = \"state-based\" and \"correspondence\"";
const NO_CLASSES: &str = "a function of the bond length; bond classes require square and cubic cells, with one `spacing` for all axes";

impl GivenFunction {
    /// Returns the function in metres; none if it follows from the lattice. The outer option is none after reporting an error.
    fn made(
        self,
        table: &Table<'_>,
        setting: &Setting,
        tuned_table: &mut Option<TunedTable>,
    ) -> Option<Option<InfluenceFunction>> {
        Some(Some(match self {
            Self::Constant => InfluenceFunction::Constant,
            Self::Conical => InfluenceFunction::Conical,
            Self::Inverse => InfluenceFunction::Inverse,
            Self::Power { exponent } => InfluenceFunction::Power { exponent },
            Self::Gaussian { length, cutoff } => InfluenceFunction::Gaussian { length, cutoff },
            Self::Tabulated { r, pairs } => {
                let scale = r.metres(table, setting)?;
                let table = pairs.iter().map(|(r, value)| (r * scale, *value)).collect();
                InfluenceFunction::Tabulated { table }
            }
            Self::Cosines {
                r,
                wavenumber,
                coefficients,
            } => InfluenceFunction::Cosines {
                wavenumber: wavenumber / r.metres(table, setting)?,
                coefficients,
            },
            Self::Classes { classes } => {
                let classes = ClassTable::new(setting.dimension?, setting.spacing?, &classes);
                InfluenceFunction::Classes(table.accept(classes)?)
            }
            Self::Tuned(tuning) => {
                let found = tuned(table, tuning, setting)?;
                let made = found.influence(setting.dimension?, setting.spacing?);
                let function = table.accept(made)?.function;
                *tuned_table = Some(found);
                function
            }
            Self::Isotropic => return Some(None),
        }))
    }
}

impl LengthUnit {
    /// Returns the unit in metres. Spacings are rejected if they are unknown before the file of the body is read.
    fn metres(self, table: &Table<'_>, setting: &Setting) -> Option<f64> {
        if setting.automatic && self == Self::Spacing {
            table.report(Fault::OutOfRange {
                value: "spacing".into(),
                allowed: "another unit `r`, or a `spacing` in [body]; the spacing of this body is unknown before its file is read".into(),
            });
        }
        match self {
            Self::Length => Some(1.0),
            Self::Spacing => setting.spacing,
            Self::Horizon => setting.horizon,
        }
    }
}

/// Reads pairs of a length and a value.
fn pairs(item: &Item<'_>, unit: Option<LengthUnit>) -> Option<Vec<(f64, f64)>> {
    let rows = item.list("a list of pairs [r, value]")?;
    let quantity = match unit? {
        LengthUnit::Length => Quantity::Length,
        LengthUnit::Spacing | LengthUnit::Horizon => Quantity::Number,
    };
    let pairs: Vec<Option<(f64, f64)>> = rows.iter().map(|row| pair(row, quantity)).collect();
    pairs.into_iter().collect()
}

fn numbers<S>(item: &Item<'_>, _: S) -> Option<Vec<f64>> {
    let items = item.list("a list of numbers a0, a1, …")?;
    let numbers: Vec<Option<f64>> = items
        .iter()
        .map(|item| item.quantity(Quantity::Number))
        .collect();
    numbers.into_iter().collect()
}

/// Reads a value per class of lattice bonds, such as `[[[1, 0], 3.7], [[1, 1], 2.9]]`.
fn classes(item: &Item<'_>, setting: &Setting) -> Option<Vec<(ClassOffset, f64)>> {
    let rows = item.list("a list of pairs [[i, j, …], value]")?;
    let entries: Vec<Option<(ClassOffset, f64)>> =
        rows.iter().map(|row| class(row, setting)).collect();
    entries.into_iter().collect()
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

fn pair(row: &Item<'_>, quantity: Quantity) -> Option<(f64, f64)> {
    let items = row.exactly(2, "a pair [r, value]")?;
    let (r, value) = (
        items[0].quantity(quantity),
        items[1].quantity(Quantity::Number),
    );
    Some((r?, value?))
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Influence", deny_unknown_fields)]
struct InfluenceForm {
    #[serde(with = "crate::form")]
    function: InfluenceFunction,
    #[serde(with = "crate::form")]
    acts_on: ActsOn,
}

#[derive(Serialize, Deserialize)]
#[serde(
    remote = "InfluenceFunction",
    rename_all = "snake_case",
    deny_unknown_fields
)]
enum InfluenceFunctionForm {
    Constant,
    Conical,
    Inverse,
    Power {
        exponent: f64,
    },
    Gaussian {
        length: f64,
        #[serde(default)]
        cutoff: Option<f64>,
    },
    Tabulated {
        table: Vec<(f64, f64)>,
    },
    Cosines {
        wavenumber: f64,
        coefficients: Vec<f64>,
    },
    Classes(#[serde(with = "crate::form")] ClassTable),
}

described!(Influence: InfluenceForm, InfluenceFunction: InfluenceFunctionForm);

/// Serialised form of a table of lattice classes.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ClassTableForm {
    dimension: usize,
    spacing: f64,
    table: Vec<(ClassOffset, f64)>,
}

impl Described for ClassTable {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let form = ClassTableForm {
            dimension: self.dimension(),
            spacing: self.spacing(),
            table: self.entries().to_vec(),
        };
        form.serialize(serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let form = ClassTableForm::deserialize(deserializer)?;
        Self::new(form.dimension, form.spacing, &form.table).map_err(D::Error::custom)
    }
}
