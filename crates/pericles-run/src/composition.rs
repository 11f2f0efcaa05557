//! What works together: the schemes and what they need, the forms of forces, what they offer and what they do not represent. Refusals follow from the same lists, and the tables of the book are written
//! by [`tables`].

use std::fmt::Write;

use pericles::operator::{Feature, Limit};
use pericles::time::{
    AdaptiveRungeKutta, DiscreteGradient, Implicit, InnerSolver, MultiTimeStep, Relaxation, Respa,
};
use pericles::{Need, Requirement, StepKind};
use pericles_deck::Scheme as DeckScheme;
use pericles_statics::StaticScheme;
use pericles_waves::absorbing::LatticeScheme;
use pericles_waves::{ForceForm, Trigonometric};

/// A scheme, or several with the same needs.
#[derive(Debug, Clone, Copy)]
pub struct Scheme {
    /// In words.
    pub words: &'static str,
    /// Names in decks.
    pub names: &'static [&'static str],
    /// Where within a step it takes the forces.
    pub kind: StepKind,
    /// What it needs of a system.
    pub requirements: &'static [Requirement],
}

/// A form in which forces are computed.
#[derive(Debug, Clone, Copy)]
pub struct Form {
    /// In words.
    pub words: &'static str,
    /// The word in decks.
    pub name: &'static str,
    /// The needs of schemes that its forces meet.
    pub offers: &'static [Need],
    /// The choice that a deck makes; none for surfaces and state-based bodies, which have no other form.
    pub choice: Option<ForceForm>,
}

/// Needs that concern the form of forces.
const OF_FORMS: [Need; 3] = [Need::DoublePrecision, Need::FiniteReach, Need::SumOverBonds];

/// All schemes.
pub const SCHEMES: [Scheme; 13] = [
    Scheme {
        words: "velocity Verlet",
        names: &["velocity-verlet"],
        kind: StepKind::EndOfStep,
        requirements: &[],
    },
    Scheme {
        words: "relaxation (static states)",
        names: &["relaxation"],
        kind: StepKind::Stages,
        requirements: Relaxation::REQUIREMENTS,
    },
    Scheme {
        words: "static (Newton–Krylov)",
        names: &["static"],
        kind: StepKind::Stages,
        requirements: StaticScheme::REQUIREMENTS,
    },
    Scheme {
        words: "Runge–Kutta of order 3 and 4",
        names: &["rk3", "rk4"],
        kind: StepKind::Stages,
        requirements: &[],
    },
    Scheme {
        words: "Dormand–Prince",
        names: &["dormand-prince"],
        kind: StepKind::Stages,
        requirements: AdaptiveRungeKutta::REQUIREMENTS,
    },
    Scheme {
        words: "Runge–Kutta with two time steps",
        names: &["rk3-mts", "rk4-mts"],
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
        words: "list of bonds (any body)",
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
        words: "bonds of surfaces",
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
    /// Why the form does not represent a feature of a body; none if it does.
    pub fn refusal_of_feature(&self, feature: Feature) -> Option<&'static str> {
        let limits = self.choice.map_or(&[][..], ForceForm::limits);
        Limit::refusal(limits, feature.into())
    }
}

impl Scheme {
    /// Why the scheme cannot step forces of a form; none if it can.
    pub fn refusal_of_form(&self, form: &Form) -> Option<&'static str> {
        self.refusal(|need| !OF_FORMS.contains(&need) || form.offers.contains(&need))
    }

    /// Why the scheme cannot step a system with a certain condition; none if it can.
    pub fn refusal_of_condition(&self, condition: Condition) -> Option<&'static str> {
        let unmet = self.refusal(|need| !condition.breaks(need));
        let kinds = condition.kinds();
        let kind_fits = kinds.is_empty() || kinds.contains(&self.kind);
        match unmet {
            None if !kind_fits => Some(OTHER_KERNELS),
            unmet => unmet,
        }
    }

    fn refusal(&self, meets: impl Fn(Need) -> bool) -> Option<&'static str> {
        let unmet = self.requirements.iter().find(|one| !meets(one.need));
        unmet.map(|one| one.reason)
    }
}

/// What the scheme of a model needs of a system.
pub fn requirements(scheme: &DeckScheme) -> &'static [Requirement] {
    match scheme {
        DeckScheme::VelocityVerlet | DeckScheme::RungeKutta3 { .. } | DeckScheme::RungeKutta4 => {
            &[]
        }
        DeckScheme::DormandPrince { .. } => AdaptiveRungeKutta::REQUIREMENTS,
        DeckScheme::MultiTimeStep3 { .. } | DeckScheme::MultiTimeStep4 { .. } => {
            MultiTimeStep::REQUIREMENTS
        }
        DeckScheme::Respa { .. } => Respa::REQUIREMENTS,
        DeckScheme::Newmark(options) => options.solver.requirements(),
        DeckScheme::DiscreteGradient { .. } => DiscreteGradient::REQUIREMENTS,
        DeckScheme::Implicit { .. } => Implicit::REQUIREMENTS,
        DeckScheme::Trigonometric(_) => Trigonometric::REQUIREMENTS,
        DeckScheme::Relaxation(_) => Relaxation::REQUIREMENTS,
        DeckScheme::Static(_) => StaticScheme::REQUIREMENTS,
    }
}

/// What a system may have beside its forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// Prescribed motion.
    Supports,
    /// Prescribed motion that ends before the run.
    ReleasedPoints,
    /// Bonds that break.
    Breaking,
    /// Exact absorbing ends.
    AbsorbingEnds,
    /// Damping layers.
    DampingLayers,
}

impl Condition {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Supports,
        Self::ReleasedPoints,
        Self::Breaking,
        Self::AbsorbingEnds,
        Self::DampingLayers,
    ];

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Supports => "prescribed motion",
            Self::ReleasedPoints => "points that are let go",
            Self::Breaking => "breaking",
            Self::AbsorbingEnds => "absorbing ends",
            Self::DampingLayers => "damping layers",
        }
    }

    /// Whether a system with it does not meet a need.
    fn breaks(self, need: Need) -> bool {
        match self {
            Self::Supports | Self::ReleasedPoints | Self::Breaking => false,
            Self::AbsorbingEnds => matches!(need, Need::NoBoundaries | Need::NoMemory),
            Self::DampingLayers => need == Need::NoBoundaries,
        }
    }

    /// The kinds of steps that it is made for; empty if any.
    fn kinds(self) -> &'static [StepKind] {
        match self {
            Self::AbsorbingEnds => LatticeScheme::KINDS,
            Self::Supports | Self::ReleasedPoints | Self::Breaking | Self::DampingLayers => &[],
        }
    }
}

/// Why absorbing ends do not go with most kinds of steps.
const OTHER_KERNELS: &str = "the kernels of an absorbing end are made for a scheme: velocity-verlet, implicit-midpoint, trapezoidal or discrete-gradient";

/// The tables of schemes with forms and with conditions, and of features of bodies with forms, in Markdown, with the reasons of what is refused.
pub fn tables() -> String {
    let mut reasons = Reasons::default();
    let forms = FORMS.map(|form| form.words);
    let conditions = Condition::ALL.map(Condition::words);
    let mut text = head("scheme", &forms);
    let of_forms = SCHEMES.iter().map(|scheme| {
        let cells = FORMS.iter().map(|form| scheme.refusal_of_form(form));
        (scheme.words, cells.collect())
    });
    rows(&mut text, of_forms, &mut reasons);
    text.push('\n');
    text.push_str(&head("scheme", &conditions));
    let of_conditions = SCHEMES.iter().map(|scheme| {
        let cells = Condition::ALL.map(|condition| scheme.refusal_of_condition(condition));
        (scheme.words, cells.to_vec())
    });
    rows(&mut text, of_conditions, &mut reasons);
    text.push('\n');
    let chosen = FORMS.iter().filter(|form| form.choice.is_some());
    let chosen: Vec<&Form> = chosen.collect();
    let words: Vec<&str> = chosen.iter().map(|form| form.words).collect();
    text.push_str(&head("body", &words));
    let of_features = Feature::ALL.into_iter().map(|feature| {
        let cells = chosen.iter().map(|form| form.refusal_of_feature(feature));
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

/// Reasons in the order in which they are met first.
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

/// Adds rows; what has the same cells shares a row.
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
