//! Body with smaller cells and a smaller horizon in its middle: effect of the interface on a uniform strain.

use pericles::operator::PointSubset;
use pericles::solve::{SolveLimits, Work, conjugate_gradient};
use pericles::time::highest_frequency;
use pericles_deck::Deck;
use pericles_run::{Assembly, RunError};

use super::problem::{Method, Problem};
use crate::common::largest;
use crate::data::{Case, Found};
use crate::decks::deck;

const STRAIN: f64 = 1e-4;

/// Marks points farther from the interface, and from the edges of the body, than a horizon of the large cells.
struct Places {
    interface: Vec<bool>,
    surface: Vec<bool>,
}

impl Places {
    fn of(assembly: &Assembly, deck: &Deck) -> Self {
        let (cloud, horizon) = (&assembly.cloud, deck.model.body.horizon());
        let [low, high] = cloud.bounds();
        // The part with smaller cells is a box in the middle; its boundary is derived from the cells.
        let small = |i: usize| cloud.cell_size(i) < 0.9 * cloud.spacing();
        let span = |c: usize| {
            (0..cloud.len()).filter(|&i| small(i)).fold(
                [f64::INFINITY, f64::NEG_INFINITY],
                |[least, most], i| {
                    let (x, half) = (cloud.point(i)[c], 0.5 * cloud.cell_size(i));
                    [least.min(x - half), most.max(x + half)]
                },
            )
        };
        let parts = [span(0), span(1)];
        let near = |x: f64, edge: f64| (x - edge).abs() < 1.2 * horizon;
        let places = |test: &dyn Fn([f64; 3]) -> bool| {
            (0..cloud.len()).map(|i| test(cloud.point(i))).collect()
        };
        Self {
            interface: places(&|x| {
                let inside = |c: usize| {
                    x[c] > parts[c][0] - 1.2 * horizon && x[c] < parts[c][1] + 1.2 * horizon
                };
                inside(0)
                    && inside(1)
                    && (0..2).any(|c| near(x[c], parts[c][0]) || near(x[c], parts[c][1]))
            }),
            surface: places(&|x| (0..2).any(|c| near(x[c], low[c]) || near(x[c], high[c]))),
        }
    }
}

/// Uniform strain: the remaining force inside the grids over E e/δ, where it must vanish.
pub(super) fn patch_test(case: &Case<'_>) -> Result<Found, RunError> {
    Ok(Patch::of(case, &[])?.inside.into())
}

/// Ratios of the force at the interface and of the error of the displacement to those with the spacing `half`.
pub(super) fn patch_test_ratio(case: &Case<'_>) -> Result<Found, RunError> {
    let of = |name| -> Result<Patch, RunError> {
        let spacing = case.number(name)?;
        Patch::of(case, &[format!("body.spacing={spacing:?}")])
    };
    let (coarse, fine) = (of("spacing")?, of("half")?);
    Ok([
        ("interface", coarse.interface / fine.interface),
        ("balanced", coarse.balanced / fine.balanced),
        ("force", coarse.interface),
        ("surface", coarse.surface),
        ("error", coarse.balanced),
    ]
    .into())
}

/// Remaining force of a body under uniform strain over E e/δ, and the error of the equilibrium displacement with the
/// boundary prescribed.
struct Patch {
    inside: f64,
    interface: f64,
    surface: f64,
    balanced: f64,
}

impl Patch {
    fn of(case: &Case<'_>, changes: &[String]) -> Result<Self, RunError> {
        let assembly = Problem::of(case)?.assembly(Method::Verlet, changes)?;
        let deck = deck(case, changes)?;
        let places = Places::of(&assembly, &deck);
        let (cloud, system) = (&assembly.cloud, &assembly.system);
        let n = cloud.len();
        let mut strained = vec![0.0; 2 * n];
        for i in 0..n {
            strained[i] = STRAIN * cloud.point(i)[0];
        }
        let mut force = vec![0.0; 2 * n];
        let operator = system.operator();
        operator.add_force(0.0, &strained, PointSubset::All, &mut force);
        // Force density over E e/δ, the scale of the force at a free surface.
        let young = assembly.constants.as_ref().map_or(f64::NAN, |c| c.young());
        let scale = young * STRAIN / deck.model.body.horizon();
        let largest = |of: &dyn Fn(usize) -> bool| {
            (0..n)
                .filter(|&i| of(i))
                .map(|i| force[i].hypot(force[n + i]) / scale)
                .fold(0.0, f64::max)
        };
        Ok(Self {
            inside: largest(&|i| !places.interface[i] && !places.surface[i]),
            interface: largest(&|i| places.interface[i] && !places.surface[i]),
            surface: largest(&|i| places.surface[i]),
            balanced: balanced_error(&assembly, &strained, &places)?,
        })
    }
}

/// max |u − u_strained| over e L, where K u = 0 with the points near the boundary prescribed at the uniform strain.
fn balanced_error(assembly: &Assembly, strained: &[f64], places: &Places) -> Result<f64, RunError> {
    let system = &assembly.system;
    let n = system.points();
    let volumes = system.cloud().volumes();
    let held = |entry: usize| places.surface[entry % n];
    // −V f is symmetric and positive: both ends of a bond use the product of the volumes.
    let stiffness = |u: &[f64], out: &mut [f64]| {
        out.fill(0.0);
        system.operator().add_force(0.0, u, PointSubset::All, out);
        for (entry, x) in out.iter_mut().enumerate() {
            *x *= if held(entry) {
                0.0
            } else {
                -volumes[entry % n]
            };
        }
    };
    let mut right = vec![0.0; 2 * n];
    stiffness(strained, &mut right);
    right.iter_mut().for_each(|x| *x = -*x);
    let mut correction = vec![0.0; 2 * n];
    let limits = SolveLimits {
        relative: 1e-10,
        iterations: 5000,
        ..SolveLimits::default()
    };
    conjugate_gradient(
        &mut |x, out| stiffness(x, out),
        &right,
        &mut correction,
        &limits,
        &mut Work::new(2 * n),
    )?;
    let [low, high] = system.cloud().bounds();
    Ok(largest(&correction) / (STRAIN * (high[0] - low[0])))
}

/// Ratio of the stable steps of large and small cells.
pub(super) fn frequencies(case: &Case<'_>) -> Result<Found, RunError> {
    let assembly = Problem::of(case)?.assembly(Method::of(case, "method")?, &[])?;
    let whole = highest_frequency(&assembly.system, &assembly.state.u)?.estimate;
    let coarse = assembly.frequency.map(|frequency| frequency.estimate);
    Ok(Found::default().value("value", coarse.map(|coarse| whole / coarse)))
}
