//! Compatibility of schemes, force kernels and features: requirements of the schemes, capabilities and limits of the
//! force kernels. Error messages use the same lists; [`tables`] writes the tables of the book.

use std::fmt::Write;

use pericles::operator::{Feature, Limit};
use pericles::time::{
    AdaptiveRungeKutta, DiscreteGradient, Implicit, InnerSolver, MultiTimeStep, Relaxation, Respa,
    RungeKutta,
};
use pericles::{Need, Requirement, StepKind};
use pericles_deck::Scheme as DeckScheme;
use pericles_heat::FixedBody;
use pericles_statics::StaticScheme;
use pericles_waves::absorbing::LatticeScheme;
use pericles_waves::{ForceForm, Trigonometric};

/// A scheme, or several with the same requirements.
#[derive(Debug, Clone, Copy)]
pub struct Scheme {
    /// The name in tables.
    pub words: &'static str,
    /// The words in decks.
    pub names: &'static [&'static str],
    /// Where within a step forces are evaluated.
    pub kind: StepKind,
    /// Requirements on the system.
    pub requirements: &'static [Requirement],
}

/// A force kernel.
#[derive(Debug, Clone, Copy)]
pub struct Form {
    /// The name in tables.
    pub words: &'static str,
    /// The word in decks.
    pub name: &'static str,
    /// The needs of schemes that it satisfies.
    pub offers: &'static [Need],
    /// The choice in decks; `None` for surfaces and state-based bodies, which have a single form.
    pub choice: Option<ForceForm>,
}

/// Needs that concern the force kernel.
const OF_FORMS: [Need; 3] = [Need::DoublePrecision, Need::FiniteReach, Need::SumOverBonds];

/// All schemes.
pub const SCHEMES: [Scheme; 14] = [
    Scheme {
        words: "velocity Verlet",
        names: &["velocity-verlet"],
        kind: StepKind::EndOfStep,
        requirements: &[],
    },
    Scheme {
        words: "adaptive dynamic relaxation, FIRE (static states)",
        names: &["adaptive-dynamic-relaxation", "fire"],
        kind: StepKind::Stages,
        requirements: Relaxation::REQUIREMENTS,
    },
    Scheme {
        words: "Newton–Krylov (static states)",
        names: &["static"],
        kind: StepKind::Stages,
        requirements: StaticScheme::REQUIREMENTS,
    },
    Scheme {
        words: "fixed body (heat conduction only)",
        names: &["thermal"],
        kind: StepKind::Stages,
        requirements: FixedBody::REQUIREMENTS,
    },
    Scheme {
        words: "Runge–Kutta of orders 3 and 4",
        names: &["rk3", "rk4"],
        kind: StepKind::Stages,
        requirements: RungeKutta::REQUIREMENTS,
    },
    Scheme {
        words: "Dormand–Prince",
        names: &["dormand-prince"],
        kind: StepKind::Stages,
        requirements: AdaptiveRungeKutta::REQUIREMENTS,
    },
    Scheme {
        words: "multirate Runge–Kutta",
        names: &["multirate-rk3", "multirate-rk4"],
        kind: StepKind::Stages,
        requirements: MultiTimeStep::REQUIREMENTS,
    },
    Scheme {
        words: "r-RESPA",
        names: &["respa"],
        kind: StepKind::Kicks,
        requirements: Respa::REQUIREMENTS,
    },
    Scheme {
        words: "Newmark: P(EC)ᵏ, Anderson",
        names: &["newmark"],
        kind: InnerSolver::FixedPoint.step_kind(),
        requirements: InnerSolver::FixedPoint.requirements(),
    },
    Scheme {
        words: "Newmark: Newton–Krylov",
        names: &["newmark"],
        kind: InnerSolver::NewtonKrylov.step_kind(),
        requirements: InnerSolver::NewtonKrylov.requirements(),
    },
    Scheme {
        words: "discrete gradient",
        names: &["discrete-gradient"],
        kind: StepKind::Middle,
        requirements: DiscreteGradient::REQUIREMENTS,
    },
    Scheme {
        words: "implicit midpoint",
        names: &["implicit-midpoint"],
        kind: StepKind::Middle,
        requirements: Implicit::REQUIREMENTS,
    },
    Scheme {
        words: "trapezoidal rule",
        names: &["trapezoidal"],
        kind: StepKind::Middle,
        requirements: Implicit::REQUIREMENTS,
    },
    Scheme {
        words: "trigonometric",
        names: &["trigonometric"],
        kind: StepKind::Flow,
        requirements: Trigonometric::REQUIREMENTS,
    },
];

/// All forms.
pub const FORMS: [Form; 7] = [
    Form {
        words: "neighbour list (any body)",
        name: "list",
        offers: &OF_FORMS,
        choice: Some(ForceForm::List),
    },
    Form {
        words: "stencil (grids)",
        name: "grid",
        offers: &OF_FORMS,
        choice: Some(ForceForm::Grid),
    },
    Form {
        words: "stencil, single precision",
        name: "grid-f32",
        offers: &[],
        choice: Some(ForceForm::FloatGrid),
    },
    Form {
        words: "surfaces",
        name: "surface",
        offers: &OF_FORMS,
        choice: None,
    },
    Form {
        words: "state-based bodies",
        name: "state-based",
        offers: &[Need::DoublePrecision, Need::FiniteReach],
        choice: None,
    },
    Form {
        words: "convolution (grids, linear)",
        name: "convolution",
        offers: &[Need::DoublePrecision],
        choice: Some(ForceForm::Convolution),
    },
    Form {
        words: "plane waves (periodic, linear)",
        name: "spectral",
        offers: &[Need::DoublePrecision],
        choice: Some(ForceForm::Spectral),
    },
];

impl Form {
    /// Returns why the kernel does not represent a feature of a body, or `None` if it does.
    pub fn rejection_of_feature(&self, feature: Feature) -> Option<&'static str> {
        let limits = self.choice.map_or(&[][..], ForceForm::limits);
        Limit::rejection(limits, feature.into())
    }
}

impl Scheme {
    /// Returns why the scheme is not compatible with a force kernel, or `None` if it is.
    pub fn rejection_of_form(&self, form: &Form) -> Option<&'static str> {
        self.rejection(|need| !OF_FORMS.contains(&need) || form.offers.contains(&need))
    }

    /// Returns why the scheme is not compatible with a condition, or `None` if it is.
    pub fn rejection_of_condition(&self, condition: Condition) -> Option<&'static str> {
        let unmet = self.rejection(|need| !condition.breaks(need));
        unmet.or(match condition.kinds() {
            Some((kinds, reason)) if !kinds.contains(&self.kind) => Some(reason),
            _ => None,
        })
    }

    fn rejection(&self, meets: impl Fn(Need) -> bool) -> Option<&'static str> {
        let unmet = self.requirements.iter().find(|one| !meets(one.need));
        unmet.map(|one| one.reason)
    }
}

/// Returns whether a scheme has a need.
pub(crate) fn has_need(scheme: &DeckScheme, need: Need) -> bool {
    requirements(scheme).iter().any(|one| one.need == need)
}

/// Returns the requirements of the scheme of a model.
pub fn requirements(scheme: &DeckScheme) -> &'static [Requirement] {
    match scheme {
        DeckScheme::VelocityVerlet => &[],
        DeckScheme::RungeKutta3 { .. } | DeckScheme::RungeKutta4 => RungeKutta::REQUIREMENTS,
        DeckScheme::DormandPrince { .. } => AdaptiveRungeKutta::REQUIREMENTS,
        DeckScheme::MultiTimeStep3 { .. } | DeckScheme::MultiTimeStep4 { .. } => {
            MultiTimeStep::REQUIREMENTS
        }
        DeckScheme::Respa { .. } => Respa::REQUIREMENTS,
        DeckScheme::Newmark(options) => options.solver.requirements(),
        DeckScheme::DiscreteGradient { .. } => DiscreteGradient::REQUIREMENTS,
        DeckScheme::ImplicitMidpoint { .. } | DeckScheme::Trapezoidal { .. } => {
            Implicit::REQUIREMENTS
        }
        DeckScheme::Trigonometric(_) => Trigonometric::REQUIREMENTS,
        DeckScheme::AdaptiveDynamicRelaxation { .. } | DeckScheme::Fire(_) => {
            Relaxation::REQUIREMENTS
        }
        DeckScheme::Static(_) => StaticScheme::REQUIREMENTS,
        DeckScheme::Thermal => FixedBody::REQUIREMENTS,
    }
}

/// Conditions of a system besides its forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// Prescribed motion.
    Supports,
    /// Prescribed motion that ends before the run.
    ReleasedPoints,
    /// Breaking bonds.
    Breaking,
    /// Exact absorbing boundaries.
    AbsorbingEnds,
    /// Damping layers.
    DampingLayers,
    /// Open boundaries of plates.
    OpenSides,
    /// Elastic contact between points, and with impactors of prescribed motion.
    Contact,
    /// Contact with damping or friction.
    DampedContact,
    /// Free impactors.
    FreeImpactors,
    /// Points that become active during the run.
    Activation,
}

impl Condition {
    /// All conditions.
    pub const ALL: [Self; 10] = [
        Self::Supports,
        Self::ReleasedPoints,
        Self::Breaking,
        Self::AbsorbingEnds,
        Self::DampingLayers,
        Self::OpenSides,
        Self::Contact,
        Self::DampedContact,
        Self::FreeImpactors,
        Self::Activation,
    ];

    /// Returns the name in tables.
    pub fn words(self) -> &'static str {
        match self {
            Self::Supports => "prescribed motion",
            Self::ReleasedPoints => "released points",
            Self::Breaking => "breaking bonds",
            Self::AbsorbingEnds => "absorbing boundaries",
            Self::DampingLayers => "damping layers",
            Self::OpenSides => "open boundaries",
            Self::Contact => "contact",
            Self::DampedContact => "contact with damping or friction",
            Self::FreeImpactors => "free impactors",
            Self::Activation => "activation of points",
        }
    }

    /// Returns whether the condition violates a need.
    fn breaks(self, need: Need) -> bool {
        match self {
            Self::Supports | Self::ReleasedPoints | Self::Breaking => false,
            Self::AbsorbingEnds | Self::OpenSides => {
                matches!(need, Need::NoBoundaries | Need::NoMemory)
            }
            Self::DampingLayers => need == Need::NoBoundaries,
            Self::Contact => need == Need::NoInteractions,
            Self::DampedContact => {
                matches!(need, Need::NoInteractions | Need::ConservativeInteractions)
            }
            Self::Activation => need == Need::NoActivation,
            Self::FreeImpactors => matches!(need, Need::NoInteractions | Need::NoFreeBodies),
        }
    }

    /// Returns the supported kinds of steps with the reason; `None` if all are supported.
    fn kinds(self) -> Option<(&'static [StepKind], &'static str)> {
        match self {
            Self::AbsorbingEnds => Some((LatticeScheme::KINDS, OTHER_KERNELS)),
            Self::OpenSides => Some((&[StepKind::EndOfStep], VERLET_LAYERS)),
            _ => None,
        }
    }
}

/// Why absorbing boundaries require certain schemes.
const OTHER_KERNELS: &str = "the kernels of absorbing boundaries are available for velocity-verlet, implicit-midpoint, trapezoidal and discrete-gradient only";

/// Why open boundaries require velocity Verlet.
const VERLET_LAYERS: &str =
    "the layers of open boundaries advance and filter velocities once per step of velocity-verlet";

/// Returns Markdown tables of schemes with force kernels and conditions, and of features with force kernels, with the
/// reasons of incompatibilities.
pub fn tables() -> String {
    let mut reasons = Reasons::default();
    let forms = FORMS.map(|form| form.words);
    let conditions = Condition::ALL.map(Condition::words);
    let mut text = head("scheme", &forms);
    let of_forms = SCHEMES.iter().map(|scheme| {
        let cells = FORMS.iter().map(|form| scheme.rejection_of_form(form));
        (scheme.words, cells.collect())
    });
    rows(&mut text, of_forms, &mut reasons);
    text.push('\n');
    text.push_str(&head("scheme", &conditions));
    let of_conditions = SCHEMES.iter().map(|scheme| {
        let cells = Condition::ALL.map(|condition| scheme.rejection_of_condition(condition));
        (scheme.words, cells.to_vec())
    });
    rows(&mut text, of_conditions, &mut reasons);
    text.push('\n');
    let chosen = FORMS.iter().filter(|form| form.choice.is_some());
    let chosen: Vec<&Form> = chosen.collect();
    let words: Vec<&str> = chosen.iter().map(|form| form.words).collect();
    text.push_str(&head("body", &words));
    let of_features = Feature::ALL.into_iter().map(|feature| {
        let cells = chosen.iter().map(|form| form.rejection_of_feature(feature));
        (feature.words(), cells.collect())
    });
    rows(&mut text, of_features, &mut reasons);
    text.push('\n');
    for (k, reason) in reasons.0.iter().enumerate() {
        let mut sentence = reason.chars();
        let first: String = sentence
            .next()
            .into_iter()
            .flat_map(char::to_uppercase)
            .collect();
        // Writing to a string does not fail.
        let _ = writeln!(text, "{}. {first}{}.", k + 1, sentence.as_str());
    }
    text
}

/// Reasons in the order of their first use.
#[derive(Default)]
struct Reasons(Vec<&'static str>);

impl Reasons {
    fn number(&mut self, reason: &'static str) -> usize {
        let known = self.0.iter().position(|known| *known == reason);
        known.unwrap_or_else(|| {
            self.0.push(reason);
            self.0.len() - 1
        }) + 1
    }
}

fn head(first: &str, columns: &[&str]) -> String {
    let rule = "|---".repeat(columns.len() + 1);
    format!("| {first} | {} |\n{rule}|\n", columns.join(" | "))
}

/// Adds rows; entries with the same cells share a row.
fn rows<'a>(
    text: &mut String,
    all: impl Iterator<Item = (&'a str, Vec<Option<&'static str>>)>,
    reasons: &mut Reasons,
) {
    let mut grouped: Vec<(String, Vec<Option<&'static str>>)> = Vec::new();
    for (words, cells) in all {
        match grouped.iter_mut().find(|(_, known)| *known == cells) {
            Some((group, _)) => *group += &format!("; {words}"),
            None => grouped.push((words.to_owned(), cells)),
        }
    }
    for (words, cells) in &grouped {
        row(text, words, cells, reasons);
    }
}

fn row(text: &mut String, words: &str, cells: &[Option<&'static str>], reasons: &mut Reasons) {
    let _ = write!(text, "| {words} |");
    for cell in cells {
        let _ = match cell {
            None => write!(text, " ✓ |"),
            Some(reason) => write!(text, " ✗ {} |", reasons.number(reason)),
        };
    }
    text.push('\n');
}
