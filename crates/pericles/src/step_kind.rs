//! Kinds of steps, as far as boundaries with a memory depend on them.

/// Where within a step a scheme takes the forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepKind {
    /// At the end of the step, once: velocity Verlet.
    EndOfStep,
    /// At its middle, by an equation for the whole step: the implicit midpoint rule and, for linear forces, the trapezoidal rule and the discrete gradient.
    Middle,
    /// Nowhere: the step is a function of the stiffness, which reaches past any layer of ghosts.
    Flow,
    /// At stages, or in sub-steps.
    Stages,
    /// At times of their own, between which boundaries act: the parts of r-RESPA, and Newmark's method with Newton's.
    Kicks,
}

impl StepKind {
    /// The schemes of this kind that boundaries are made for, by their names in decks: for messages.
    pub fn schemes(self) -> &'static [&'static str] {
        match self {
            Self::EndOfStep => &["velocity-verlet"],
            Self::Middle => &["implicit-midpoint", "trapezoidal", "discrete-gradient"],
            Self::Stages => &["rk3", "rk4", "dormand-prince", "rk3-mts", "rk4-mts"],
            Self::Flow => &["trigonometric"],
            Self::Kicks => &["respa"],
        }
    }

    /// Why boundaries with a memory cannot follow such steps where one may expect that they can; the end of a message, else empty.
    pub(crate) fn why_not(self) -> &'static str {
        match self {
            Self::Flow => {
                ", whose step multiplies by cos(dt W): it reaches as far as its series does, past any layer of ghosts"
            }
            Self::EndOfStep | Self::Middle | Self::Stages | Self::Kicks => "",
        }
    }
}

/// The schemes of some kinds in words, such as `velocity-verlet, implicit-midpoint or trapezoidal`.
pub fn schemes_of(kinds: &[StepKind]) -> String {
    let names: Vec<&str> = kinds
        .iter()
        .flat_map(|kind| kind.schemes())
        .copied()
        .collect();
    match &names[..] {
        [] => String::new(),
        [one] => (*one).to_string(),
        [all @ .., last] => format!("{} or {last}", all.join(", ")),
    }
}
