//! Which bonds break at a static state.

use pericles::operator::On;
use pericles::{StepEnd, System};

/// Which over-stretched bonds break at a static state, before the next one is sought at the same loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BreakingRule {
    /// Those whose stretch over the critical stretch is at least this part of the largest: a crack grows bond by bond, and equally stretched bonds break together.
    WorstFirst {
        /// The part, above 0 and at most 1.
        fraction: f64,
    },
    /// All of them: fewer static states, more broken bonds.
    All,
}

impl Default for BreakingRule {
    fn default() -> Self {
        Self::WorstFirst { fraction: 0.98 }
    }
}

impl BreakingRule {
    /// Breaks bonds at displacement `u`. Returns the energy that the body lost at `u` and that was not booked as dissipated, J; none if no bond broke. `work` is for forces.
    ///
    /// The worst bonds are those that exceed their critical stretch in displacements scaled down by a common factor. They dissipate their energy there, as they would have if loads had grown in steps too
    /// small to stretch them further; what the body loses beyond that it gives up like the energy released after bonds broke. Where the scaled displacements do not single out the same points, as in large rotations or
    /// for bonds that break by their energy, and in path-dependent bodies, whose history goes on from the states they were in, all over-stretched bonds break, and dissipate their energy at `u`.
    pub fn apply(self, system: &mut System, t: f64, u: &[f64], work: &mut [f64]) -> Option<f64> {
        let broken = system.operator().broken_bonds();
        let mut beyond = 0.0;
        match self {
            Self::WorstFirst { .. } if system.operator().capabilities().path_dependent => {
                end_step(system, t, u, work);
            }
            Self::WorstFirst { fraction } => match scaled(system, u, fraction) {
                Scaled::Nothing => return None,
                Scaled::All => end_step(system, t, u, work),
                Scaled::By(down) => {
                    let energy = system.operator().energy(t, u);
                    let booked = system.operator().dissipated();
                    end_step(system, t, &down, work);
                    let lost = energy - system.operator().energy(t, u);
                    beyond = lost - (system.operator().dissipated() - booked);
                }
            },
            Self::All => end_step(system, t, u, work),
        }
        (system.operator().broken_bonds() > broken).then_some(beyond)
    }
}

fn end_step(system: &mut System, t: f64, u: &[f64], work: &mut [f64]) {
    system.end_step_on(&StepEnd::sub_step(t, 0.0, u), &On::All, work);
}

/// Displacements in which only the bonds that are to break are over-stretched.
enum Scaled {
    /// No bond is.
    Nothing,
    /// The displacements themselves.
    All,
    /// The displacements times a factor below 1.
    By(Vec<f64>),
}

fn scaled(system: &System, u: &[f64], fraction: f64) -> Scaled {
    let marks = |u: &[f64], part: f64| {
        let mut marks = vec![false; system.points()];
        if let Some(breaking) = system.operator().capabilities().breaking {
            breaking.mark_endangered(u, part, &mut marks);
        }
        marks
    };
    let any = |part: f64| marks(u, part).contains(&true);
    if !any(1.0) {
        return Scaled::Nothing;
    }
    /// Stretches beyond this multiple of the critical one are not told apart.
    const LARGEST: f64 = 1e6;
    let (mut low, mut high): (f64, f64) = (1.0, 2.0);
    while any(high) {
        (low, high) = (high, 2.0 * high);
        if high > LARGEST {
            return Scaled::All;
        }
    }
    /// Relative accuracy of the largest stretch, well below what a fraction leaves out.
    const ACCURACY: f64 = 1e-5;
    while high - low > ACCURACY * low {
        let middle = 0.5 * (low + high);
        *(if any(middle) { &mut low } else { &mut high }) = middle;
    }
    let part = fraction * low;
    if part <= 1.0 {
        return Scaled::All;
    }
    let down: Vec<f64> = u.iter().map(|u| u / part).collect();
    if marks(u, part) == marks(&down, 1.0) {
        Scaled::By(down)
    } else {
        Scaled::All
    }
}
