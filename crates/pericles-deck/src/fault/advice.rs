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
            Self::EmptySet { advice, .. } => advice.clone(),
            Self::OverlappingPieces { .. } => {
                "move one of them: points of different pieces must be at least half of a cell apart; points one cell apart touch".into()
            }
            Self::PrescribedTwice { .. } => {
                "choose other points, set this component to \"free\", or give both tables the same value, function and `until`".into()
            }
            Self::ThinFineSet { .. } => {
                "make the set thicker along this axis, or extend it to the surface of the body".into()
            }
            Self::FineSetsOverlap { .. } => "define one set that is the union of both".into(),
            Self::EmptyMaterial { .. } => {
                "later assignments replace all of its points: put the larger set first".into()
            }
            Self::NoMaterial { .. } => {
                "assign one with [[assign]], or define [materials.default] for all points without an assignment".into()
            }
            Self::NotShared { .. } => {
                "materials of a body may differ in density, elastic constants, failure and, if bond-based, horizon; set all other keys once, in [material]".into()
            }
            Self::BadExpression { allowed, .. } | Self::BadCondition { allowed, .. } => {
                (*allowed).into()
            }
            Self::TwoCourses { .. } => "remove `function`".into(),
            Self::BadSurfaceFile { .. } => {
                "a surface must be closed, connected and consistently oriented, unless open, several or flip = true; `pericles geodesics FILE` reports details".into()
            }
            Self::LostValue { .. } => "change the expression, or end the run or the load (`until`) earlier; the expression, and for motions its derivatives, must be finite throughout the run".into(),
            Self::NeverStops { .. } => {
                "reaction_below needs a set with a [[constraint]], damage_above a material with fracture".into()
            }
            Self::UnknownArea { .. } => "set `area`, such as \"100 mm2\"".into(),
            Self::NoFields { .. } => "remove these fields".into(),
            Self::NoExactSolution { .. } => "remove [exact], or change the deck".into(),
            Self::EmptyWindow { .. } => {
                "use a larger window, or move the centre of the exact solution into the body".into()
            }
            Self::LongSum { .. } => {
                "move exact.centre into the body, use a larger width, or shorten the run; the number of terms is 2 (distance from the centre + 6 c end)/width".into()
            }
            Self::BadPoints { .. } => {
                "expected: one line `x y z block volume` per point, in m and m³; a relative path starts at the deck's folder".into()
            }
            Self::BadMesh { .. } => {
                "`pericles mesh FILE --unit UNIT` lists the contents of a file; a relative path starts at the deck's folder".into()
            }
            Self::OtherDimension { found, .. } => format!(
                "set dimension = {found}; surface elements of a solid mesh only define sets"
            ),
            Self::OtherElementSize { .. } => {
                "remove `spacing` to use the mean element size, or correct `unit`".into()
            }
            Self::NoFaces { .. } => {
                "allowed: a face set of a mesh, or a `layer`; use a `traction` with `area` for other sets".into()
            }
            Self::BadCrackFile { .. } => {
                "expected: a file of triangles (STL, OBJ, PLY, OFF, Gmsh, VTU or VTP); a relative path starts at the deck's folder".into()
            }
            Self::LargeFile { .. } => {
                "use a smaller file; the limit is the free memory of the machine, or the given limit".into()
            }
            Self::BadTemperatureFile { points, .. } => format!(
                "expected: one line for each of the {points} points, in the order of the field files (listed points: of their file), with the temperature in K; a relative path starts at the deck's folder"
            ),
            Self::BadInitialFile { points, .. } => format!(
                "expected: one line for each of the {points} points, in the order of the field files (listed points: of their file), with displacement components in m, then velocity components in m/s; a relative path starts at the deck's folder"
            ),
            Self::OtherSpacing { section: Some(section), .. } => format!(
                "check `spacing`, and the units of the file: coordinates in m, volumes in m³; `{section}` is part of the volumes"
            ),
            Self::OtherSpacing { .. } => "check `spacing`, and the units of the file: coordinates in m, volumes in m³".into(),
            Self::UnstableTable { .. } => {
                "use lower_bound = \"auto\" (the default), or another method, decay or horizon; time.allow_unstable = true accepts the deck for `pericles dispersion`".into()
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
            Self::Exclusive { .. } | Self::TwoCourses { .. } | Self::PrescribedTwice { .. } => {
                "conflict"
            }
            Self::Misplaced { .. } => "not allowed here",
            Self::WrongKind { .. } => "wrong type",
            Self::NotANumber { .. } => "not a number",
            Self::Comma { .. } => "comma",
            Self::UnknownUnit { .. } => "unknown unit",
            Self::WrongUnit { .. } => "wrong unit",
            Self::OutOfRange { .. } => "out of range",
            Self::WrongLength { .. } => "wrong length",
            Self::OtherSpacing { .. } | Self::OtherElementSize { .. } => "different size",
            Self::OtherDimension { .. } => "different dimension",
            Self::NoFaces { .. } => "no faces",
            Self::BadName { .. }
            | Self::BadExpression { .. }
            | Self::BadCondition { .. }
            | Self::BadPoints { .. }
            | Self::BadMesh { .. }
            | Self::BadCrackFile { .. }
            | Self::BadInitialFile { .. }
            | Self::BadTemperatureFile { .. }
            | Self::BadSurfaceFile { .. } => "invalid",
            Self::NothingPrescribed => "all components free",
            Self::BadOverride { .. } => "invalid override",
            Self::EmptySet { .. } | Self::EmptyMaterial { .. } => "no points",
            Self::NoMaterial { .. } => "incomplete",
            Self::NotShared { .. } => "differs",
            Self::BadDiscretisation { .. } => "inconsistent",
            Self::Undivided { .. } => "not divisible",
            Self::TooManyProcesses { .. } => "too small",
            Self::LostValue { .. } => "not finite",
            Self::NeverStops { .. } => "never met",
            Self::ThinFineSet { .. } => "too thin",
            Self::FineSetsOverlap { .. } | Self::OverlappingPieces { .. } => "overlap",
            Self::UnknownArea { .. } => "unknown area",
            Self::NoFields { .. } => "not available",
            Self::NoExactSolution { .. } => "does not apply",
            Self::EmptyWindow { .. } => "no points",
            Self::LongSum { .. } => "too many terms",
            Self::TooLarge { .. } | Self::LongHistory { .. } | Self::LargeFile { .. } => {
                "too large"
            }
            Self::UnstableTable { .. } => "unstable",
            Self::Model(_) => "invalid",
        }
    }
}
