//! What is allowed instead of a fault.

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
            Self::MissingKey { synonyms, .. } => format!("also called {}", names(synonyms)),
            Self::MissingChoice { .. } => "exactly one of them must be given".into(),
            Self::Exclusive { allowed, .. } => format!("allowed: only one of {}", names(allowed)),
            Self::Misplaced { allowed, .. }
            | Self::OutOfRange { allowed, .. }
            | Self::BadOverride { allowed, .. } => allowed.clone(),
            Self::NotANumber { expected, .. } => format!("expected {expected}"),
            Self::Comma { .. } => {
                "fractions have a point, \"32.5 GPa\"; thousands have no mark; a list stands in brackets, [1, 2]".into()
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
                "give a number for at least one component, or leave the whole table out".into()
            }
            Self::EmptySet { .. } => {
                "a set needs at least one cell centre; make the region larger (a layer is at least half a spacing deep)".into()
            }
            Self::PrescribedTwice { .. } => {
                "give other points, say \"free\" along this axis, or leave one of the two out".into()
            }
            Self::ThinFineSet { .. } => {
                "make the set thicker along this axis, or extend it to the face of the body".into()
            }
            Self::FineSetsOverlap { .. } => "define one set that is the union of both".into(),
            Self::EmptyMaterial { .. } => {
                "later assignments replace all of its points: put the larger set first".into()
            }
            Self::NoMaterial { .. } => {
                "assign one to them with [[assign]], or call the material of all points without an assignment [materials.default]".into()
            }
            Self::NotShared { .. } => {
                "the materials of a body differ in density, elastic constants, failure and, if they are bond-based, horizon; give all else once, in [material]".into()
            }
            Self::BadExpression { .. } => "such as { expression = \"1e-3 * exp(-(x/0.01)^2)\" }, in SI units".into(),
            Self::TwoCourses { .. } => "leave `function` out".into(),
            Self::BadSurfaceFile { .. } => {
                "a surface is closed, in one part and oriented outwards, unless open, several or flip = true; `pericles geodesics FILE` tells more".into()
            }
            Self::LostValue { .. } => "its expression must have a finite value, and that of a motion finite derivatives, at all times of the run; end the run or the load (`until`) before, or change it".into(),
            Self::NeverStops { .. } => {
                "reaction_below needs a set that a [[prescribe]] holds, damage_above a material that can break".into()
            }
            Self::UnknownArea { .. } => "give `area`, such as \"100 mm2\"".into(),
            Self::NoFields { .. } => "leave these fields out".into(),
            Self::NoExactSolution { .. } => "leave [exact] out, or change the deck".into(),
            Self::EmptyWindow { .. } => {
                "give a larger window, or move the centre of the exact solution into the body".into()
            }
            Self::LongSum { .. } => {
                "the number of terms is 2 (distance from the centre + 6 c end)/width: move exact.centre into the body, give a larger width, or shorten the run".into()
            }
            Self::BadCondition { .. } => {
                "such as where = \"x > 0.01 && y < 0.02 || block == 2\", in m".into()
            }
            Self::BadPoints { .. } => {
                "a file of points has a line `x y z block volume` for each, in m and m³; a relative path starts at the deck's folder".into()
            }
            Self::BadMesh { .. } => {
                "`pericles mesh FILE --unit UNIT` lists what is in a file; a relative path starts at the deck's folder".into()
            }
            Self::OtherDimension { found, .. } => format!(
                "allowed: dimension = {found}; surface elements of a solid mesh only define sets"
            ),
            Self::OtherElementSize { .. } => {
                "leave `spacing` out to take the mean size, or correct `unit`".into()
            }
            Self::NoFaces { .. } => {
                "allowed: a face set of a mesh or a `layer`; other sets take a `traction` with its `area`".into()
            }
            Self::BadCrackFile { .. } => {
                "a pre-crack is a file of triangles (STL, OBJ, PLY, OFF, Gmsh, VTU or VTP); a relative path starts at the deck's folder".into()
            }
            Self::LargeFile { .. } => {
                "the limit is what the machine has free, or what was given as the most".into()
            }
            Self::BadInitialFile { points, .. } => format!(
                "the file has a line for each of the {points} points, in the order of the field files (listed points: of their file): the components of the displacement in m, then those of the velocity in m/s; a relative path starts at the deck's folder"
            ),
            Self::OtherSpacing { section: Some(section), .. } => format!(
                "places in the file are in m and volumes in m³; `{section}` is part of the volumes"
            ),
            Self::OtherSpacing { .. } => "places in the file are in m and volumes in m³".into(),
            Self::UnstableTable { .. } => {
                "use lower_bound = \"auto\" (the default), another method, another decay or another horizon; time.allow_unstable = true accepts the deck for `pericles dispersion`".into()
            }
            Self::TooLarge { .. } => {
                "a larger spacing or a shorter horizon needs less; lengths without a unit are in m".into()
            }
            Self::LongHistory { .. } => {
                "fewer or longer steps need less, as do exponentials (give a `tolerance`)".into()
            }
            // Their own text says what is allowed.
            Self::WrongKind { .. } | Self::BadDiscretisation { .. } | Self::Model(_) => {
                return None;
            }
        })
    }

    fn label(&self) -> &'static str {
        match self {
            Self::Syntax { .. } => "here",
            Self::UnknownKey { home: Some(_), .. } => "not here",
            Self::UnknownKey {
                nearest: Some(_), ..
            }
            | Self::UnknownWord {
                nearest: Some(_), ..
            } => "misspelt?",
            Self::UnknownKey { .. } | Self::UnknownWord { .. } => "not known",
            Self::MissingKey { .. } | Self::MissingChoice { .. } => "incomplete",
            Self::Exclusive { .. } | Self::TwoCourses { .. } | Self::PrescribedTwice { .. } => {
                "one too many"
            }
            Self::Misplaced { .. } => "not here",
            Self::WrongKind { .. } => "wrong kind of value",
            Self::NotANumber { .. } => "no number",
            Self::Comma { .. } => "a comma",
            Self::UnknownUnit { .. } => "unknown unit",
            Self::WrongUnit { .. } => "wrong unit",
            Self::OutOfRange { .. } => "out of range",
            Self::WrongLength { .. } => "wrong length",
            Self::OtherSpacing { .. } | Self::OtherElementSize { .. } => "another size",
            Self::OtherDimension { .. } => "another dimension",
            Self::NoFaces { .. } => "no faces",
            Self::BadName { .. }
            | Self::BadExpression { .. }
            | Self::BadCondition { .. }
            | Self::BadPoints { .. }
            | Self::BadMesh { .. }
            | Self::BadCrackFile { .. }
            | Self::BadInitialFile { .. }
            | Self::BadSurfaceFile { .. } => "not usable",
            Self::NothingPrescribed => "all free",
            Self::BadOverride { .. } => "cannot be applied",
            Self::EmptySet { .. } | Self::EmptyMaterial { .. } => "no points here",
            Self::NoMaterial { .. } => "incomplete",
            Self::NotShared { .. } => "not shared",
            Self::BadDiscretisation { .. } => "not of these points",
            Self::LostValue { .. } => "not finite",
            Self::NeverStops { .. } => "never met",
            Self::ThinFineSet { .. } => "too thin",
            Self::FineSetsOverlap { .. } => "overlap",
            Self::UnknownArea { .. } => "which area?",
            Self::NoFields { .. } => "not available",
            Self::NoExactSolution { .. } => "of another problem",
            Self::EmptyWindow { .. } => "no point",
            Self::LongSum { .. } => "too many terms",
            Self::TooLarge { .. } | Self::LongHistory { .. } | Self::LargeFile { .. } => {
                "too large"
            }
            Self::UnstableTable { .. } => "unstable",
            Self::Model(_) => "refused",
        }
    }
}
