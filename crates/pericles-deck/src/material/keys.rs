//! Keys that all materials of solids have.

use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::operator::DamageMeasure;
use pericles_waves::ForceForm;

use crate::body::BodyRead;
use crate::influence::Setting;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::Frame;
use crate::set::SetNames;
use crate::vocabulary::HORIZONS;

/// Refuses tables of former releases that could not be rewritten.
pub(crate) fn forbid_former_tables(table: &Table<'_>) {
    table.forbid(
        "part",
        "define materials in [materials.NAME] and assign them to sets with [[assign]]",
    );
    table.forbid("inclusion", "give `stiffness` in [[assign]]");
    table.forbid(
        "interface",
        "bonds between two materials have tables [[interface]]",
    );
}

pub(super) fn density(table: &Table<'_>) -> Option<f64> {
    let item = table.required("density");
    item.and_then(|item| item.positive(Quantity::Density))
}

pub(super) fn volume_correction(table: &Table<'_>) -> Option<VolumeCorrection> {
    table.worded("volume_correction", "volume correction")
}

pub(super) fn no_fail(table: &Table<'_>, sets: &SetNames) -> Option<Vec<String>> {
    let item = table.optional("no_fail");
    item.map_or(Some(Vec::new()), |item| sets.references(&item))
}

/// What an influence function is made for.
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
    }
}

/// How bonds are kept.
pub(super) fn form(table: &Table<'_>) -> Option<ForceForm> {
    table.worded("bonds", "form of bonds")
}

/// A horizon as written.
pub(super) enum Extent<'a> {
    /// m
    Finite(f64),
    /// As far as the influence function goes.
    Infinite(Item<'a>),
}

impl Extent<'_> {
    pub(super) fn length(&self) -> Option<f64> {
        match self {
            Self::Finite(horizon) => Some(*horizon),
            Self::Infinite(_) => None,
        }
    }

    /// The horizon in metres, for a function that is known.
    pub(super) fn with(
        self,
        influence: Option<&Influence>,
        dimension: Option<usize>,
    ) -> Option<f64> {
        /// Lengths of a Gaussian beyond which it is below 1e-21 of its height.
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
                    "\"infinite\" needs a function that decays: influence = { function = \"gaussian\", length = … } without a cutoff",
                );
                None
            }
        }
    }
}

/// The horizon, given as a length or as a multiple of the spacing.
pub(super) fn horizon<'a>(table: &Table<'a>, frame: Frame) -> Option<Extent<'a>> {
    if frame.is_automatic() {
        table.forbid(
            "horizon_ratio",
            "the spacing of this mesh is not known before it is read: give `horizon` as a length (usual: 3 times the mean size that `pericles mesh` prints), or `spacing` in [body]",
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
            // Horizons are mostly whole multiples of the spacing, up to round-off.
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

pub(super) fn damage(table: &Table<'_>) -> Option<Option<DamageMeasure>> {
    let given = table.has("damage");
    let table = table.table_or_empty("damage")?;
    let count = table.choice_or_first(
        "measure",
        "measure of damage",
        &[("volume", false), ("count", true)],
    );
    let count_precut = table.or("count_precut", false, |item| item.boolean());
    table.finish();
    let measure = DamageMeasure {
        count: count?,
        count_precut: count_precut?,
    };
    Some(given.then_some(measure))
}
