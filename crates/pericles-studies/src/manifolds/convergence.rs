//! The breathing eigenvalue under refinement.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use pericles::cache::{Cache, Key};
use pericles::{Archive, System};
use pericles_run::{Resources, RunError, build};

use super::modes::breathing;
use super::presets::{PAPER, STANDARD, change};
use crate::row::Row;
use crate::study::{Context, Study};

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

/// The quotient ∫ u·(−K u)/∫ |u|² of u = x, less that of the continuum, in per cent of it, for each α above and the levels 3, 4 and 5; recomputed by an independent code.
struct Quotients {
    method: &'static str,
    says: &'static str,
    /// How far they are known: half of their last digit.
    expected: [[f64; 3]; 5],
    tolerance: [f64; 5],
}

const ALONG_EDGES: Quotients = Quotients {
    method: "edge",
    says: "distances along edges, as in the paper",
    expected: [
        [-19.0, -29.0, -28.0],
        [-23.0, -29.0, -29.0],
        [-32.0, -33.0, -31.0],
        [-52.0, -47.0, -42.0],
        [-99.7, -99.6, -99.5],
    ],
    tolerance: [0.6, 0.6, 0.6, 0.6, 0.06],
};

const EXACT: Quotients = Quotients {
    method: "exact",
    says: "exact distances without the own cell",
    expected: [
        [-6.6, -0.5, -0.1],
        [-10.0, -2.4, -0.8],
        [-20.0, -8.8, -4.4],
        [-44.0, -30.0, -22.0],
        [-99.7, -99.5, -99.4],
    ],
    tolerance: [0.06, 0.6, 0.6, 0.6, 0.06],
};

/// Known at level 5 only.
const DIAGONALS: Quotients = Quotients {
    method: "edge-diagonals",
    says: "distances along edges and diagonals",
    expected: [
        [f64::NAN, f64::NAN, -7.3],
        [f64::NAN, f64::NAN, -7.9],
        [f64::NAN, f64::NAN, -11.0],
        [f64::NAN, f64::NAN, -26.0],
        [f64::NAN, f64::NAN, -99.4],
    ],
    tolerance: [0.06, 0.06, 0.6, 0.6, 0.06],
};

fn study(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let levels: &[u32] = if context.full { &[3, 4, 5] } else { &[3, 4] };
    let kept = Kept::default();
    let system = |level: u32, changes: &[String]| -> Result<System, RunError> {
        let mut changes = changes.to_vec();
        changes.push(change("body.level", level));
        // Nothing moves here, but a deck whose step is too long for a fine mesh is refused.
        changes.push(change("time.dt", "auto"));
        let resources = Resources {
            cache: &kept,
            ..Resources::default()
        };
        Ok(build(&STANDARD.deck(&changes)?, &resources)?.system)
    };
    let mut rows = Vec::new();
    for (number, (alpha, continuum)) in CONTINUUM.into_iter().enumerate() {
        for &level in levels {
            let changes = [
                change("material.alpha", alpha),
                change("geodesics.method", "exact"),
                change("material.self_cell", true),
            ];
            let ratio = breathing(&system(level, &changes)?)? / continuum;
            let case = format!(
                "eigenvalue over that of the continuum, exact distances and the own cell, α = {alpha}, level {level}"
            );
            let row = Row::new(case, "", Some(ratio));
            rows.push(match (level, alpha <= 0.5) {
                (5, true) => row.within(1.0, 0.01),
                (5, false) => row.within(1.0, 0.02),
                (4, _) => row.within(1.0, 0.025),
                _ => row.within(1.0, 0.045),
            });
        }
        for quotients in [ALONG_EDGES, DIAGONALS, EXACT] {
            for &level in levels {
                let expected = quotients.expected[number][level as usize - 3];
                if expected.is_nan() {
                    continue;
                }
                let changes = [
                    change("material.alpha", alpha),
                    change("geodesics.method", quotients.method),
                ];
                let ratio = quotient(&system(level, &changes)?) / continuum;
                let case = format!(
                    "quotient of u = x over that of the continuum, {}, α = {alpha}, level {level}",
                    quotients.says
                );
                let tolerance = 0.01 * quotients.tolerance[number];
                let row = Row::new(case, "", Some(ratio)).within(1.0 + 0.01 * expected, tolerance);
                rows.push(match quotients.method {
                    "edge" => row.note("does not converge: distances along edges stay too long, however fine the mesh"),
                    _ => row,
                });
            }
        }
    }
    Ok(rows)
}

/// ∫ u·(−K u)/∫ |u|² of u = x.
fn quotient(system: &System) -> f64 {
    let n = system.points();
    let mut u = system.cloud().positions().to_vec();
    u[n..].fill(0.0);
    let mut force = vec![0.0; 3 * n];
    system.operator().tangent_into(0.0, &u, &u, &mut force);
    let areas = system.cloud().volumes();
    let inner = |f: &[f64]| -> f64 { (0..n).map(|i| areas[i] * u[i] * f[i]).sum() };
    -inner(&force) / inner(&u)
}
