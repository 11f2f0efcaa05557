//! Kinds of wrong in a deck, and what is allowed instead.

use miette::Severity;
use pericles::PericlesError;

use crate::build::bytes;
use crate::finding::Subject;

/// Kinds of wrong.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The text is no TOML.
    #[error("not valid TOML: {message}")]
    Syntax {
        /// What the parser found.
        message: String,
    },
    /// A key that does not belong here.
    #[error("unknown key `{key}` in {table}")]
    UnknownKey {
        /// The key.
        key: String,
        /// The table it stands in.
        table: String,
        /// The key that may have been meant.
        nearest: Option<String>,
        /// The table that it belongs to.
        home: Option<&'static str>,
        /// All keys that belong here.
        allowed: Vec<String>,
    },
    /// A key that is missing.
    #[error("{table} lacks `{key}`, which must be given")]
    MissingKey {
        /// The key.
        key: String,
        /// Other names of the key.
        synonyms: Vec<String>,
        /// The table it should stand in.
        table: String,
    },
    /// None of several keys of which one is needed.
    #[error("{table} lacks one of {}", names(allowed))]
    MissingChoice {
        /// The table.
        table: String,
        /// The keys.
        allowed: Vec<String>,
    },
    /// Several keys of which only one may be given.
    #[error("{} are given together in {table}", names(given))]
    Exclusive {
        /// The keys found.
        given: Vec<String>,
        /// The table.
        table: String,
        /// The keys to choose from.
        allowed: Vec<String>,
    },
    /// A key that has no meaning here.
    #[error("`{key}` has no place in {table}")]
    Misplaced {
        /// The key.
        key: String,
        /// The table.
        table: String,
        /// When it has.
        allowed: String,
    },
    /// A value of another kind.
    #[error("{found} (`{value}`) where this is needed: {expected}")]
    WrongKind {
        /// The value as written.
        value: String,
        /// What it is.
        found: &'static str,
        /// What is needed.
        expected: String,
    },
    /// A string that holds no number, or a number that is not finite.
    #[error("`{value}` is not a number")]
    NotANumber {
        /// The value as written.
        value: String,
        /// What is needed.
        expected: String,
    },
    /// A number with a comma.
    #[error("`{value}` has a comma")]
    Comma {
        /// The value as written.
        value: String,
    },
    /// An expression that cannot be read.
    #[error("the expression `{text}` cannot be used: {reason}")]
    BadExpression {
        /// The expression.
        text: String,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// A load or motion that ceases to have a value.
    #[error("the {what} on `{set}` has no finite value at t = {t:.4e} s, within the run")]
    LostValue {
        /// Load or prescribed motion.
        what: &'static str,
        /// Its set.
        set: String,
        /// When first, s.
        t: f64,
    },
    /// A stop condition that nothing can meet.
    #[error("the stop condition on `{set}` can never be met: {reason}")]
    NeverStops {
        /// The set.
        set: String,
        /// Why not.
        reason: &'static str,
    },
    /// A surface that cannot be had from its file.
    #[error("{file} gives no surface: {reason}")]
    BadSurfaceFile {
        /// The file.
        file: String,
        /// What is wrong, and where.
        reason: String,
    },
    /// A condition that cannot be read.
    #[error("the condition `{text}` cannot be used: {reason}")]
    BadCondition {
        /// The condition.
        text: String,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// Points that cannot be had from their file.
    #[error("{reason}")]
    BadPoints {
        /// What is wrong, with the file and the line in it.
        reason: String,
    },
    /// A file whose content does not fit into the memory.
    #[error("{reason}")]
    LargeFile {
        /// The file, and what it needs.
        reason: String,
    },
    /// An initial state that cannot be read from its file.
    #[error("{reason}")]
    BadInitialFile {
        /// What is wrong, with the file and the line in it.
        reason: String,
        /// The points of the body.
        points: usize,
    },
    /// Listed points whose volumes belong to another spacing.
    #[error(
        "the volumes of the listed points are those of cells of {found:.3e} m, not of {given:.3e} m"
    )]
    OtherSpacing {
        /// The spacing of the deck, m.
        given: f64,
        /// The size of the mean cell, m.
        found: f64,
        /// What volumes are divided by besides, by its name in `[body]`.
        section: Option<&'static str>,
    },
    /// A course over time for an expression that has its own.
    #[error("`{text}` depends on time by itself and takes no function of time besides")]
    TwoCourses {
        /// The expression.
        text: String,
    },
    /// A unit that does not exist.
    #[error("unknown unit `{unit}` in `{value}`")]
    UnknownUnit {
        /// The value as written.
        value: String,
        /// The unit.
        unit: String,
        /// The unit that may have been meant.
        nearest: Option<String>,
        /// What is needed.
        expected: String,
    },
    /// A unit of another dimension.
    #[error("`{value}` is not {expected}")]
    WrongUnit {
        /// The value as written.
        value: String,
        /// What is needed.
        expected: String,
        /// With an example.
        allowed: String,
    },
    /// A number out of its range.
    #[error("`{value}` is out of range")]
    OutOfRange {
        /// The value as written.
        value: String,
        /// The range.
        allowed: String,
    },
    /// A word that is not among those allowed.
    #[error("unknown {what} `{value}`")]
    UnknownWord {
        /// What the word names.
        what: &'static str,
        /// The value as written.
        value: String,
        /// The word that may have been meant.
        nearest: Option<String>,
        /// All words allowed.
        allowed: Vec<String>,
    },
    /// A list of the wrong length.
    #[error("`{value}` has {found} {}", if *found == 1 { "entry" } else { "entries" })]
    WrongLength {
        /// The value as written.
        value: String,
        /// Its length.
        found: usize,
        /// The length needed.
        allowed: String,
    },
    /// A name that cannot be used.
    #[error("the name `{name}` cannot be used: {reason}")]
    BadName {
        /// The name.
        name: String,
        /// Why.
        reason: &'static str,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A prescribed motion without a prescribed component.
    #[error("every component is free: nothing is prescribed")]
    NothingPrescribed,
    /// An override that cannot be applied.
    #[error("the override `{text}` cannot be applied: {reason}")]
    BadOverride {
        /// The override.
        text: String,
        /// Why.
        reason: String,
        /// What is allowed.
        allowed: String,
    },
    /// Two prescriptions of one motion.
    #[error(
        "{points} points have their motion along {axis} prescribed by [[prescribe]] number {earlier} already"
    )]
    PrescribedTwice {
        /// How many.
        points: usize,
        /// Along which axis.
        axis: char,
        /// The number of the earlier one in the deck, from 1.
        earlier: usize,
    },
    /// A set without points.
    #[error("the set `{set}` selects no point")]
    EmptySet {
        /// The set.
        set: String,
    },
    /// A part of another material without points.
    #[error("the part `{part}` has no point")]
    EmptyPart {
        /// Its name.
        part: String,
    },
    /// A load whose area cannot be guessed.
    #[error("the area that the traction acts on cannot be told: {reason}")]
    UnknownArea {
        /// Why.
        reason: &'static str,
    },
    /// An exact solution of another problem.
    #[error("this exact solution does not belong to this deck: {reason}")]
    NoExactSolution {
        /// Why.
        reason: &'static str,
    },
    /// A window of comparison without points.
    #[error(
        "the window of {window:.4e} m around x = {centre:.4e} m contains no point: the nearest one is {nearest:.4e} m away"
    )]
    EmptyWindow {
        /// Half its width, m.
        window: f64,
        /// Its middle, m.
        centre: f64,
        /// Distance of the nearest point, m.
        nearest: f64,
    },
    /// An exact solution that is too expensive.
    #[error(
        "the exact solution would need a sum of {terms:.1e} terms for each point at the end of the run; at most {most:.0e} are allowed"
    )]
    LongSum {
        /// Terms.
        terms: f64,
        /// Terms that are allowed.
        most: f64,
    },
    /// A body that would need more memory than there is.
    #[error(
        "the body would have {} points and need some {} of memory; {} may be taken",
        count(*points), bytes(*needed), bytes(*memory as f64)
    )]
    TooLarge {
        /// Its points, or how many there can be.
        points: f64,
        /// The estimate, bytes.
        needed: f64,
        /// What may be taken, bytes.
        memory: u64,
    },
    /// A history of an absorbing end that would need more memory than there is.
    #[error(
        "the history of {} steps would need some {} of memory; {} may be taken",
        count(*steps), bytes(*needed), bytes(*memory as f64)
    )]
    LongHistory {
        /// Steps of the run.
        steps: f64,
        /// The estimate, bytes.
        needed: f64,
        /// What may be taken, bytes.
        memory: u64,
    },
    /// Tuned coefficients with which waves grow.
    #[error(
        "the tuned coefficients make the lattice unstable: the smallest ω²/k² of its waves is {smallest:.3} E/ρ, it must be positive"
    )]
    UnstableTable {
        /// The smallest ω²/k² over E/ρ.
        smallest: f64,
    },
    /// The library refuses the value.
    #[error(transparent)]
    Model(#[from] PericlesError),
}

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
            Self::EmptyPart { .. } => "its set or blocks have none, or later parts have taken them".into(),
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
            Self::WrongKind { .. } | Self::Model(_) => return None,
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
            Self::OtherSpacing { .. } => "another size",
            Self::BadName { .. }
            | Self::BadExpression { .. }
            | Self::BadCondition { .. }
            | Self::BadPoints { .. }
            | Self::BadInitialFile { .. }
            | Self::BadSurfaceFile { .. } => "not usable",
            Self::NothingPrescribed => "all free",
            Self::BadOverride { .. } => "cannot be applied",
            Self::EmptySet { .. } | Self::EmptyPart { .. } => "no points here",
            Self::LostValue { .. } => "not finite",
            Self::NeverStops { .. } => "never met",
            Self::UnknownArea { .. } => "which area?",
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

/// A number of things, in groups of three digits; rounded where it is an estimate that nobody would count.
fn count(number: f64) -> String {
    if number >= 1e9 {
        return format!("{number:.1e}");
    }
    let digits = format!("{number:.0}");
    let mut grouped = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

/// `a`, `b` and `c`
fn names(words: &[String]) -> String {
    joined(words, '`')
}

/// "a", "b" and "c"
fn quoted(words: &[String]) -> String {
    joined(words, '"')
}

fn joined(words: &[String], mark: char) -> String {
    let words: Vec<String> = words
        .iter()
        .map(|word| format!("{mark}{word}{mark}"))
        .collect();
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => "none".into(),
    }
}
