//! Kinds of time steps, which determine the boundaries with memory that a scheme supports.

/// Time within a step at which a scheme evaluates the forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepKind {
    /// Once, at the end of the step: velocity Verlet.
    EndOfStep,
    /// In the middle of the step, through an equation for the whole step: the implicit midpoint rule and, for
    /// linear forces, the trapezoidal rule and the discrete gradient.
    Middle,
    /// Never: the step is a function of the stiffness, which reaches beyond any layer of ghosts.
    Flow,
    /// At stages or in sub-steps.
    Stages,
    /// At separate times for parts of the force, between which boundaries act: r-RESPA, and Newmark's method solved
    /// by Newton's method.
    Kicks,
}

impl StepKind {
    /// Names of the schemes of this kind that boundaries with memory support, as in decks, for messages.
    pub fn schemes(self) -> &'static [&'static str] {
        match self {
            Self::EndOfStep => &["velocity-verlet"],
            Self::Middle => &["implicit-midpoint", "trapezoidal", "discrete-gradient"],
            Self::Stages => &[
                "rk3",
                "rk4",
                "dormand-prince",
                "multirate-rk3",
                "multirate-rk4",
            ],
            Self::Flow => &["trigonometric"],
            Self::Kicks => &["respa"],
        }
    }

    /// End of a message that explains why boundaries with memory do not support such steps; empty if no explanation
    /// is needed.
    pub(crate) fn why_not(self) -> &'static str {
        match self {
            Self::Flow => {
                "; its step multiplies by cos(dt W), a series that reaches beyond any layer of ghosts"
            }
            Self::EndOfStep | Self::Middle | Self::Stages | Self::Kicks => "",
        }
    }
}

/// Lists the schemes of some kinds, such as `velocity-verlet, implicit-midpoint or trapezoidal`.
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
