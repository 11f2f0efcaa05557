//! Keys of all materials of solids.

use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::StateInfluence;
use pericles::operator::DamageMeasure;
use pericles_deck_derive::DeckTable;
use pericles_waves::ForceForm;
use serde::{Deserialize, Serialize};

use crate::body::BodyRead;
use crate::declaration::DeckTable;
use crate::form::described;
use crate::influence::{Setting, influence};
use crate::property::{MaterialProperty, number_of};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::Frame;
use crate::set::SetNames;
use crate::vocabulary::HORIZONS;

pub(super) fn density(table: &Table<'_>) -> Option<f64> {
    let item = table.required("density");
    item.and_then(|item| number_of(&item, MaterialProperty::Density))
}

pub(super) fn volume_correction(table: &Table<'_>) -> Option<VolumeCorrection> {
    table.worded("volume_correction", "volume correction")
}

pub(super) fn no_fail(table: &Table<'_>, sets: &SetNames) -> Option<Vec<String>> {
    let item = table.optional("no_fail");
    item.map_or(Some(Vec::new()), |item| sets.references(&item))
}

/// Returns the discretisation for which an influence function is made.
pub(super) fn setting(
    body: &BodyRead,
    extent: Option<&Extent<'_>>,
    correction: Option<VolumeCorrection>,
) -> Setting {
    Setting {
        dimension: body.frame.dimension,
        state: body.state,
        spacing: body.frame.spacing,
        cells: body.frame.cells,
        automatic: body.frame.is_automatic(),
        horizon: extent.and_then(Extent::length),
        correction,
        is_state_based: false,
    }
}

/// Horizon, influence function and volume correction of a state-based or correspondence material.
pub(super) struct SolidFamily {
    pub(super) horizon: Option<f64>,
    pub(super) influence: Option<StateInfluence>,
    pub(super) volume_correction: Option<VolumeCorrection>,
}

impl SolidFamily {
    /// Reads the keys of a table.
    pub(super) fn read(table: &Table<'_>, body: &BodyRead) -> Self {
        let extent = horizon(table, body.frame);
        let volume_correction = volume_correction(table);
        let setting = Setting {
            is_state_based: true,
            ..setting(body, extent.as_ref(), volume_correction)
        };
        let influence = influence(table, &setting).map(|(influence, _)| influence);
        let given = influence.as_ref().and_then(Option::as_ref);
        Self {
            horizon: extent.and_then(|extent| extent.with(given, body.frame.dimension)),
            influence: influence.map(|given| {
                given.map_or(StateInfluence::Isotropic, |given| {
                    StateInfluence::Function(given.function)
                })
            }),
            volume_correction,
        }
    }
}

/// Reads the force kernel.
pub(super) fn form(table: &Table<'_>) -> Option<ForceForm> {
    table.worded("bonds", "force kernel")
}

/// A horizon as given in the deck.
pub(super) enum Extent<'a> {
    /// A length, m.
    Finite(f64),
    /// The extent of the influence function.
    Infinite(Item<'a>),
}

impl Extent<'_> {
    pub(super) fn length(&self) -> Option<f64> {
        match self {
            Self::Finite(horizon) => Some(*horizon),
            Self::Infinite(_) => None,
        }
    }

    /// Returns the horizon in metres for a given influence function.
    pub(super) fn with(
        self,
        influence: Option<&Influence>,
        dimension: Option<usize>,
    ) -> Option<f64> {
        /// Number of lengths beyond which a Gaussian is below 1e-21.
        const ALL: f64 = 7.0;
        let item = match self {
            Self::Finite(horizon) => return Some(horizon),
            Self::Infinite(item) => item,
        };
        match influence.map(|influence| (&influence.function, influence)) {
            Some((
                InfluenceFunction::Gaussian {
                    length,
                    cutoff: None,
                },
                influence,
            )) => {
                let horizon = ALL * length;
                item.accept(influence.check(dimension?, horizon))?;
                item.record(horizon);
                Some(horizon)
            }
            _ => {
                item.out_of_range(
                    "\"infinite\" requires influence = { function = \"gaussian\", length = … } without a cutoff",
                );
                None
            }
        }
    }
}

/// Reads the horizon, given as a length or as a multiple of the spacing.
pub(super) fn horizon<'a>(table: &Table<'a>, frame: Frame) -> Option<Extent<'a>> {
    if frame.is_automatic() {
        table.forbid(
            "horizon_ratio",
            "the spacing of this mesh is unknown before the mesh is read: set `horizon` to a length (usual: 3 times the mean size that `pericles mesh` prints), or set `spacing` in [body]",
        );
    }
    let spacing = frame.spacing;
    let (kind, item) = table.exactly_one(HORIZONS)?;
    if kind == "horizon" && item.is_keyword("infinite") {
        return Some(Extent::Infinite(item));
    }
    let length = match kind {
        "horizon" => item.within(
            Quantity::Length,
            "a length of at least one spacing (usual: 3 spacings), or \"infinite\"",
            // Allows for round-off: most horizons are whole multiples of the spacing.
            |horizon| horizon > 0.0 && spacing.is_none_or(|dx| horizon >= dx * (1.0 - 1e-9)),
        ),
        _ => {
            let ratio = item.within(
                Quantity::Number,
                "a number of at least 1 (usual: 3)",
                |ratio| ratio >= 1.0,
            );
            ratio.zip(spacing).map(|(ratio, dx)| ratio * dx)
        }
    };
    length.map(Extent::Finite)
}

/// Definition of the damage field.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "DamageMeasure", deny_unknown_fields)]
#[deck(remote = DamageMeasure)]
struct DamageMeasureForm {
    /// Damage of a point: volume fraction (`volume`) or number fraction (`count`) of its broken bonds.
    #[deck(flatten, key = "measure", with = counts)]
    count: bool,
    /// Count bonds cut by pre-cracks as broken.
    #[deck(default = false)]
    count_precut: bool,
}

described!(DamageMeasure: DamageMeasureForm);

fn counts<S>(table: &Table<'_>, _: S) -> Option<bool> {
    let words = [("volume", false), ("count", true)];
    table.choice_or_first("measure", "damage measure", &words)
}

/// Reads the damage measure, if it is given; its defaults are recorded in any case.
pub(super) fn damage(table: &Table<'_>) -> Option<Option<DamageMeasure>> {
    let measure = DamageMeasure::read_table(table.table_or_empty("damage")?, ())?;
    Some(table.has("damage").then_some(measure))
}
