//! Advice and labels of errors.

use miette::Severity;

use super::Fault;
use crate::subject::Subject;
use crate::wording::{names, quoted};

impl Subject for Fault {
    const SEVERITY: Severity = Severity::Error;

    fn advice(&self) -> Option<String> {
        let meant = |nearest: &Option<String>| match nearest {
            Some(word) => format!("did you mean `{word}`? "),
            None => String::new(),
        };
        Some(match self {
            Self::Syntax { .. } => "a deck is TOML: `key = value`, `[table]`, strings in quotes".into(),
            Self::UnknownKey { home: Some(home), .. } => format!("it belongs in {home}"),
            Self::UnknownKey {
                nearest, allowed, ..
            } => format!("{}allowed: {}", meant(nearest), names(allowed)),
            Self::MissingKey { synonyms, .. } if synonyms.is_empty() => return None,
            Self::MissingKey { synonyms, .. } => format!("alternative names: {}", names(synonyms)),
            Self::MissingChoice { .. } => "set exactly one of them".into(),
            Self::Exclusive { allowed, .. } => format!("set only one of {}", names(allowed)),
            Self::Misplaced { allowed, .. }
            | Self::OutOfRange { allowed, .. }
            | Self::BadOverride { allowed, .. } => allowed.clone(),
            Self::NotANumber { expected, .. } => format!("expected {expected}"),
            Self::Comma { .. } => {
                "write a decimal point, \"32.5 GPa\", no thousands separators, and lists in brackets, [1, 2]".into()
            }
            Self::UnknownUnit {
                nearest, expected, ..
            } => format!("{}expected {expected}", meant(nearest)),
            Self::WrongUnit { allowed, .. } => format!("expected {allowed}"),
            Self::UnknownWord {
                nearest, allowed, ..
            } => format!("{}allowed: {}", meant(nearest), quoted(allowed)),
            Self::WrongLength { allowed, .. } => allowed.clone(),
            Self::BadName { allowed, .. } => (*allowed).into(),
            Self::NothingPrescribed => {
                "set a number for at least one component, or remove the table".into()
            }
            Self::NotShared { .. } => {
                "materials of a body may differ in density, elastic constants, failure and, if bond-based, horizon; set all other keys once, in [material]".into()
            }
            Self::BadExpression { allowed, .. } | Self::BadCondition { allowed, .. } => {
                (*allowed).into()
            }
            Self::TwoCourses { .. } => "remove `function`".into(),
            Self::UnknownArea { .. } => "set `area`, such as \"100 mm2\"".into(),
            Self::NoFields { .. } => "remove these fields".into(),
            Self::NoExactSolution { .. } => "remove [exact], or change the deck".into(),
            Self::BadMesh { .. } => {
                "`pericles mesh FILE --unit UNIT` lists the contents of a file; a relative path starts at the deck's folder".into()
            }
            Self::NoFaces { .. } => {
                "allowed: a face set of a mesh, or a `layer`; use a `traction` with `area` for other sets".into()
            }
            Self::LargeFile { .. } => {
                "use a smaller file; the limit is the free memory of the machine, or the given limit".into()
            }
            Self::TooLarge { .. } => {
                "use a larger spacing or a smaller horizon; check lengths and their unit (default: m)".into()
            }
            Self::LongHistory { .. } => {
                "use fewer time steps, or exponentials (set `tolerance`)".into()
            }
            Self::Undivided { .. } => "run it without mpirun, with threads on one machine".into(),
            Self::TooManyProcesses { .. } => {
                "use fewer processes; parts of a lattice are boxes of whole cells".into()
            }
            Self::Other { advice, .. } => advice.clone(),
            // The message says what is allowed.
            Self::WrongKind { .. } | Self::BadDiscretisation { .. } | Self::Model(_) => {
                return None;
            }
        })
    }

    fn label(&self) -> &'static str {
        match self {
            Self::Syntax { .. } => "here",
            Self::UnknownKey { home: Some(_), .. } => "not allowed here",
            Self::UnknownKey {
                nearest: Some(_), ..
            }
            | Self::UnknownWord {
                nearest: Some(_), ..
            } => "typo?",
            Self::UnknownKey { .. } | Self::UnknownWord { .. } => "unknown",
            Self::MissingKey { .. } | Self::MissingChoice { .. } => "incomplete",
            Self::Exclusive { .. } | Self::TwoCourses { .. } => "conflict",
            Self::Misplaced { .. } => "not allowed here",
            Self::WrongKind { .. } => "wrong type",
            Self::NotANumber { .. } => "not a number",
            Self::Comma { .. } => "comma",
            Self::UnknownUnit { .. } => "unknown unit",
            Self::WrongUnit { .. } => "wrong unit",
            Self::OutOfRange { .. } => "out of range",
            Self::WrongLength { .. } => "wrong length",
            Self::NoFaces { .. } => "no faces",
            Self::BadName { .. }
            | Self::BadExpression { .. }
            | Self::BadCondition { .. }
            | Self::BadMesh { .. } => "invalid",
            Self::NothingPrescribed => "all components free",
            Self::BadOverride { .. } => "invalid override",
            Self::NotShared { .. } => "differs",
            Self::BadDiscretisation { .. } => "inconsistent",
            Self::Undivided { .. } => "not divisible",
            Self::TooManyProcesses { .. } => "too small",
            Self::UnknownArea { .. } => "unknown area",
            Self::NoFields { .. } => "not available",
            Self::NoExactSolution { .. } => "does not apply",
            Self::TooLarge { .. } | Self::LongHistory { .. } | Self::LargeFile { .. } => {
                "too large"
            }
            Self::Other { label, .. } => label,
            Self::Model(_) => "invalid",
        }
    }
}
