//! Bond failure at static states.

use pericles::operator::PointSubset;
use pericles::{StepEnd, System};

use crate::stretch::{any_endangered, endangered, largest_ratio, load_factor};

/// Rule that selects the bonds that break at a static state among those beyond their limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BreakingRule {
    /// Bonds whose ratio of stretch to critical stretch is at least a fraction of the largest ratio break:
    /// cracks grow bond by bond, and equally stretched bonds break together.
    WorstFirst {
        /// The fraction, above 0 and at most 1.
        fraction: f64,
    },
    /// All bonds beyond their limits break: fewer static states, more broken bonds.
    All,
    /// Event by event: each step scales loads and displacements of the supports by the factor at which the next
    /// bond reaches its critical stretch. The factor decreases during snap-back.
    Event {
        /// Time (s) at which loads and supports have the values that are scaled.
        reference: f64,
        /// Bonds within this fraction of the largest stretch break together; 0 for the most stretched bond alone.
        ties: f64,
    },
}

impl Default for BreakingRule {
    fn default() -> Self {
        Self::WorstFirst { fraction: 0.98 }
    }
}

impl BreakingRule {
    /// Returns the event-by-event rule. Bonds within 0.1 % of the largest stretch break together, so that
    /// symmetric bodies break symmetrically.
    pub fn events(reference: f64) -> Self {
        Self::Event {
            reference,
            ties: 1e-3,
        }
    }

    /// Breaks bonds at displacement `u`. Returns the energy that the body lost at `u` and that is not part of
    /// the dissipated energy, J; `None` if no bond broke. `work` is scratch memory for forces.
    ///
    /// The selected bonds are those that exceed their limits in displacements scaled down by a common factor. They
    /// dissipate their energy at the scaled displacements, as in the limit of small load steps; the remaining loss of
    /// the body counts as energy released after bonds broke. If other bonds exceed their limits in scaled displacements
    /// (large rotations), and in path-dependent bodies, all bonds beyond their limits break and dissipate their energy
    /// at `u`.
    pub fn apply(self, system: &mut System, t: f64, u: &[f64], work: &mut [f64]) -> Option<f64> {
        let broken = system.operator().broken_bonds();
        let mut beyond = 0.0;
        match self {
            Self::WorstFirst { .. } if system.operator().capabilities().path_dependent => {
                end_step(system, t, u, work);
            }
            Self::WorstFirst { fraction } => match scaled(system, u, fraction) {
                Scaled::Nothing if accumulates(system) => end_step(system, t, u, work),
                Scaled::Nothing => return None,
                Scaled::All => end_step(system, t, u, work),
                Scaled::By(down) => beyond = at(system, t, (&down, u), work),
            },
            Self::All => end_step(system, t, u, work),
            Self::Event { ties, .. } => {
                beyond = at(system, t, (&enlarged(system, u, ties), u), work)
            }
        }
        (system.operator().broken_bonds() > broken).then_some(beyond)
    }
}

/// Returns enlarged displacements in which the bonds within the fraction `ties` of the largest stretch exceed their
/// limits. Where points rotate by large angles, scaling stretches some bonds by more than `ties`; the factor is then
/// closer to 1.
fn enlarged(system: &System, u: &[f64], ties: f64) -> Vec<f64> {
    const SHARES: [f64; 4] = [1.0, 0.1, 0.01, 1e-3];
    let tied = endangered(system, u, 1.0 - ties);
    let by = |share: f64| -> Vec<f64> { u.iter().map(|u| (1.0 + share * ties) * u).collect() };
    let within = |up: &Vec<f64>| {
        let up = endangered(system, up, 1.0);
        let own = up.iter().zip(&tied).all(|(up, tied)| *tied || !*up);
        system.domain().all(own)
    };
    let found = SHARES.into_iter().map(by).find(within);
    found.unwrap_or_else(|| u.to_vec())
}

/// Breaks the bonds beyond their limits in `scaled` displacements, at which they dissipate their energy.
/// Returns the remaining loss of the body at `u`, J.
fn at(system: &mut System, t: f64, (scaled, u): (&[f64], &[f64]), work: &mut [f64]) -> f64 {
    let energy = system.stored_energy(t, u);
    let booked = system.operator().dissipated();
    end_step(system, t, scaled, work);
    let lost = energy - system.stored_energy(t, u);
    lost - (system.operator().dissipated() - booked)
}

fn end_step(system: &mut System, t: f64, u: &[f64], work: &mut [f64]) {
    system.end_step_on(&StepEnd::sub_step(t, 0.0, u), &PointSubset::All, work);
}

/// Returns whether the failure criterion accumulates along the deformation.
fn accumulates(system: &System) -> bool {
    let breaking = system.operator().capabilities().breaking;
    breaking.is_some_and(|breaking| breaking.accumulates())
}

/// Displacements in which only the selected bonds exceed their limits.
enum Scaled {
    /// No bond exceeds its limits.
    Nothing,
    /// The unscaled displacements.
    All,
    /// The displacements multiplied by a factor below 1.
    By(Vec<f64>),
}

fn scaled(system: &System, u: &[f64], fraction: f64) -> Scaled {
    if !any_endangered(system, u, 1.0) {
        return Scaled::Nothing;
    }
    /// Relative accuracy of the largest stretch, well below the fraction.
    const ACCURACY: f64 = 1e-5;
    let Some(largest) = largest_ratio(system, u, ACCURACY) else {
        return Scaled::All;
    };
    let part = fraction * largest;
    if part <= 1.0 {
        return Scaled::All;
    }
    let down = |part: f64| -> Vec<f64> { u.iter().map(|u| u / part).collect() };
    let selected = endangered(system, u, part);
    let by_ratio = down(part);
    if system
        .domain()
        .all(selected == endangered(system, &by_ratio, 1.0))
    {
        return Scaled::By(by_ratio);
    }
    // The criterion is not proportional to the displacements: the factor at which the first bond exceeds its limit.
    let Some(factor) = load_factor(system, u, ACCURACY) else {
        return Scaled::All;
    };
    let by_load = down((fraction / factor).max(1.0));
    let beyond = endangered(system, u, 1.0);
    let up = endangered(system, &by_load, 1.0);
    let own = up.iter().zip(&beyond).all(|(up, beyond)| *beyond || !*up);
    let any = !system.domain().all(!up.contains(&true));
    if any && system.domain().all(own) {
        Scaled::By(by_load)
    } else {
        Scaled::All
    }
}
