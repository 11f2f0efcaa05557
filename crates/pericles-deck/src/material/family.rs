//! Horizon, influence function and volume correction of a material.

use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles_deck_derive::DeckTable;
use pericles_dispersion::tuning::TunedTable;

use super::scope::MaterialScope;
use crate::influence::{Setting, influence};
use crate::quantity::Quantity;
use crate::range::{Range, at_least};
use crate::reader::{Item, Table};

/// Which points have bonds, and their weights.
#[derive(DeckTable)]
#[deck(scope = MaterialScope<'s>, exactly_one("horizon", "horizon_ratio"))]
pub(super) struct Family {
    /// Horizon δ, the largest bond length apart from partial volumes: with volume_correction = "extended", the default, bonds
    /// reach δ + Δx/2, the farthest cells that overlap the horizon. Required unless `horizon_ratio` is given. Bond-based
    /// materials of one body may have different horizons: a bond exists within the larger horizon of its end points, and its
    /// force is the mean of both force laws, each zero beyond its own horizon. "infinite", for a Gaussian influence function: 7
    /// times its length.
    #[deck(with = horizon)]
    horizon: Option<Extent>,
    /// Horizon ratio m = δ/Δx.
    #[deck(
        range = RATIOS,
        forbid_if(
            scope.body.frame.is_automatic(),
            "the spacing of this body is unknown before its file is read: set `horizon` to a length (usual: 3 times the mean cell size, which `pericles mesh` prints for meshes), or set `spacing` in [body]"
        )
    )]
    horizon_ratio: Option<f64>,
    /// Partial volume κ of cells at the edge of the horizon, for bond length r. `extended`: κ = min(1, (δ + Δx/2 − r)/Δx) for r <
    /// δ + Δx/2, with the influence function at min(r, δ); `linear`: the same for r ≤ δ, as in LAMMPS; `none`: κ = 1 for r ≤ δ.
    /// Not for bonds = "spectral".
    #[deck(default)]
    pub(super) volume_correction: VolumeCorrection,
    /// The influence function, none if it follows from the lattice, and its tuning result.
    #[deck(
        flatten,
        keys("influence"),
        with = weights,
        scope = (scope, length(horizon, horizon_ratio, scope), volume_correction.copied())
    )]
    pub(super) influence: (Option<Influence>, Option<TunedTable>),
}

const RATIOS: Range = at_least(1.0).described("a number of at least 1 (usual: 3)");

/// A horizon as given in the deck.
#[derive(Clone, Copy)]
enum Extent {
    /// A length, m.
    Finite(f64),
    /// The extent of the influence function.
    Infinite,
}

fn horizon(item: &Item<'_>, scope: MaterialScope<'_>) -> Option<Extent> {
    if item.is_keyword(INFINITE) {
        return Some(Extent::Infinite);
    }
    let spacing = scope.body.frame.spacing;
    let length = item.within(
        Quantity::Length,
        "a length of at least one spacing (usual: 3 spacings), or \"infinite\"",
        // Allows for round-off: most horizons are whole multiples of the spacing.
        |horizon| horizon > 0.0 && spacing.is_none_or(|dx| horizon >= dx * (1.0 - 1e-9)),
    );
    length.map(Extent::Finite)
}

/// Returns the horizon as far as it is known without the influence function, m.
fn length(
    horizon: Option<&Option<Extent>>,
    ratio: Option<&Option<f64>>,
    scope: MaterialScope<'_>,
) -> Option<f64> {
    match (horizon, ratio) {
        (Some(Some(Extent::Finite(horizon))), _) => Some(*horizon),
        (Some(None), Some(Some(ratio))) => Some(ratio * scope.body.frame.spacing?),
        _ => None,
    }
}

fn weights(
    table: &Table<'_>,
    (scope, horizon, correction): (MaterialScope<'_>, Option<f64>, Option<VolumeCorrection>),
) -> Option<(Option<Influence>, Option<TunedTable>)> {
    let frame = scope.body.frame;
    let setting = Setting {
        dimension: frame.dimension,
        state: scope.state(),
        spacing: frame.spacing,
        cells: frame.cells,
        automatic: frame.is_automatic(),
        horizon,
        correction,
        is_state_based: scope.is_solid(),
    };
    if table.word_of("horizon") == Some(INFINITE) && !is_gaussian(table) {
        table.optional("horizon")?.out_of_range(NEEDS_GAUSSIAN);
    }
    influence(table, &setting)
}

/// Returns whether the influence function is a Gaussian.
fn is_gaussian(table: &Table<'_>) -> bool {
    let inner = table.optional("influence").and_then(|item| item.table());
    inner.is_some_and(|inner| inner.word_of("function") == Some("gaussian"))
}

const INFINITE: &str = "infinite";
const NEEDS_GAUSSIAN: &str =
    "\"infinite\" requires influence = { function = \"gaussian\", length = … } without a cutoff";

impl Family {
    /// Returns the horizon in metres; none after reporting an error.
    pub(super) fn horizon(&self, table: &Table<'_>, scope: MaterialScope<'_>) -> Option<f64> {
        /// Number of lengths beyond which a Gaussian is below 1e-21.
        const ALL: f64 = 7.0;
        let Some(Extent::Infinite) = self.horizon else {
            return length(Some(&self.horizon), Some(&self.horizon_ratio), scope);
        };
        let item = table.optional("horizon")?;
        let gaussian = self
            .influence
            .0
            .as_ref()
            .and_then(|influence| match influence.function {
                InfluenceFunction::Gaussian {
                    length,
                    cutoff: None,
                } => Some((influence, length)),
                _ => None,
            });
        let Some((influence, length)) = gaussian else {
            item.out_of_range(NEEDS_GAUSSIAN);
            return None;
        };
        let horizon = ALL * length;
        item.accept(influence.check(scope.body.frame.dimension?, horizon))?;
        item.record(horizon);
        Some(horizon)
    }
}
