//! Cracks in a quenched plate: their spacing against depth at several severities of the quench.

use std::rc::Rc;

use pericles_run::RunError;

use super::ran;
use crate::data::{Case, Found};
use crate::decks::deck;

/// Depths at which cracks are counted, m.
const DEPTHS: [f64; 4] = [0.7e-3, 1.5e-3, 2.5e-3, 3.2e-3];
/// Damage above which a point belongs to a crack.
const THRESHOLD: f64 = 0.3;
/// Temperature of the plate before the quench, K.
const HOT: f64 = 600.0;

/// End state of a quench.
struct Quenched {
    /// Width of the plate over the number of cracks at each depth, m; the width itself without cracks.
    spacings: [f64; DEPTHS.len()],
    bonds: u64,
    /// Error of the energy balance over the dissipated energy.
    balance: f64,
}

impl Quenched {
    /// Returns the end of a quench, which is computed once per study.
    fn of(case: &Case<'_>, change: f64) -> Result<Rc<Self>, RunError> {
        case.once(format!("quench by {change}"), || Self::run(case, change))
    }

    fn run(case: &Case<'_>, change: f64) -> Result<Self, RunError> {
        let cold = format!("thermal.condition.0.temperature={:?}", HOT - change);
        let run = ran(&deck(case, &[cold])?)?;
        let cloud = run.system().cloud();
        let mut damage = vec![0.0; cloud.len()];
        run.system().operator().damage_into(&mut damage);
        let [x, y] = [cloud.axis(0), cloud.axis(1)];
        let dx = cloud.spacing();
        let width = x.iter().fold(0.0, |most: f64, x| most.max(*x)) + 0.5 * dx;
        let spacing = |depth: f64| {
            let row = |&i: &usize| (y[i] - depth).abs() <= 0.5 * dx && damage[i] > THRESHOLD;
            let mut places: Vec<f64> = (0..cloud.len()).filter(row).map(|i| x[i]).collect();
            places.sort_by(f64::total_cmp);
            // Damaged points further apart than twice the spacing belong to different cracks.
            let gaps = places
                .windows(2)
                .filter(|pair| pair[1] - pair[0] > 2.5 * dx);
            let cracks = gaps.count() + usize::from(!places.is_empty());
            width / cracks.max(1) as f64
        };
        let energies = run.snapshot().energies();
        Ok(Self {
            spacings: DEPTHS.map(spacing),
            bonds: run.system().operator().broken_bonds(),
            balance: energies.balance().abs() / energies.dissipated,
        })
    }

    fn shown(&self) -> String {
        let pairs = DEPTHS.iter().zip(self.spacings);
        let texts = pairs.map(|(depth, spacing)| {
            format!("{:.1} mm at depth {:.1} mm", 1e3 * spacing, 1e3 * depth)
        });
        texts.collect::<Vec<_>>().join(", ")
    }
}

/// Largest relative decrease from one value to the next; zero for an ascending sequence.
fn decrease(values: &[f64]) -> f64 {
    let steps = values.windows(2).map(|pair| 1.0 - pair[1] / pair[0]);
    steps.fold(0.0, f64::max)
}

/// One severity: the decrease of the crack spacing with depth, which is zero if crack arrest leaves fewer cracks at
/// greater depths.
pub(super) fn one(case: &Case<'_>) -> Result<Found, RunError> {
    let quenched = Quenched::of(case, case.number("change")?)?;
    Ok(Found::default()
        .value("decrease", decrease(&quenched.spacings))
        .value("balance", quenched.balance)
        .value("bonds", quenched.bonds as f64)
        .text("spacings", quenched.shown()))
}

/// Several severities, the strongest first: the decrease of the spacing at any depth from one severity to the next.
pub(super) fn several(case: &Case<'_>) -> Result<Found, RunError> {
    let mut all = Vec::new();
    for change in ["strong", "middle", "weak"] {
        all.push(Quenched::of(case, case.number(change)?)?.spacings);
    }
    let at = |depth: usize| decrease(&all.iter().map(|one| one[depth]).collect::<Vec<_>>());
    let most = (0..DEPTHS.len()).map(at).fold(0.0, f64::max);
    Ok(Found::default().value("decrease", most))
}
