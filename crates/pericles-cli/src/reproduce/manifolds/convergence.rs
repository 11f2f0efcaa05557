//! The breathing eigenvalue under refinement.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use pericles::Archive;
use pericles::cache::{Cache, Key};
use pericles_deck::Resources;

use super::super::row::Row;
use super::super::{Context, Study};
use super::modes::breathing;
use super::{PAPER, STANDARD, change};
use crate::error::CliError;

/// The study.
pub(super) const STUDY: Study = Study {
    id: "manifolds/convergence",
    paper: PAPER,
    title: "The lowest eigenvalue of a sphere under refinement (beyond the paper)",
    run: study,
};

/// α, and 2π ∫ (1 − cos t) sin t t^−(2+2α) dt up to 0.5: the eigenvalue of the continuum for u = x.
const CONTINUUM: [(f64, f64); 5] = [
    (0.0001, 0.38072),
    (0.25, 0.72096),
    (0.5, 1.53856),
    (0.75, 4.38811),
    (0.999, 1568.5),
];

/// Distances do not depend on α: they are found once for each mesh.
#[derive(Default)]
struct Kept(Mutex<HashMap<String, Archive>>);

impl Kept {
    fn arrays(&self) -> MutexGuard<'_, HashMap<String, Archive>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Cache for Kept {
    fn load(&self, key: &Key) -> Option<Archive> {
        self.arrays().get(&key.digest()).cloned()
    }

    fn store(&self, key: &Key, arrays: &Archive) {
        self.arrays().insert(key.digest(), arrays.clone());
    }
}

fn study(context: &Context<'_>) -> Result<Vec<Row>, CliError> {
    let levels: &[u32] = if context.full { &[3, 4, 5] } else { &[3, 4] };
    let finest = *levels.last().unwrap_or(&3);
    let kept = Kept::default();
    let mut rows = Vec::new();
    for (alpha, continuum) in CONTINUUM {
        for &level in levels {
            let changes = [
                change("material.alpha", alpha),
                change("body.level", level),
                change("geodesics.method", "exact"),
                change("material.self_cell", true),
            ];
            let model = STANDARD.deck(&changes)?.build_with(Resources {
                cache: &kept,
                ..Resources::default()
            })?;
            let ratio = breathing(&model.system)? / continuum;
            let case = format!("exact distances and the own cell, α = {alpha}, level {level}");
            let row = Row::new(case, "", Some(ratio));
            rows.push(match (level, alpha <= 0.5) {
                (5, true) => row.within(1.0, 0.01),
                (5, false) => row.within(1.0, 0.02),
                (4, _) => row.within(1.0, 0.025),
                _ => row.within(1.0, 0.045),
            });
        }
        for &level in levels {
            let changes = [change("material.alpha", alpha), change("body.level", level)];
            let model = STANDARD.deck(&changes)?.build_with(Resources {
                cache: &kept,
                ..Resources::default()
            })?;
            let ratio = breathing(&model.system)? / continuum;
            let case =
                format!("distances along edges, as in the paper, α = {alpha}, level {level}");
            let row = Row::new(case, "", Some(ratio));
            rows.push(if level == finest && alpha <= 0.25 {
                row.within(0.71, 0.02).note(
                    "does not converge: distances along edges stay too long, however fine the mesh",
                )
            } else {
                row
            });
        }
    }
    Ok(rows)
}
