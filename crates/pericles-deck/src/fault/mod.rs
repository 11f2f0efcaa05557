//! Kinds of wrong in a deck, and what is allowed instead.

mod advice;
mod words;

use pericles::PericlesError;
use pericles::units::quantity;

use crate::wording::{bytes, count, names, shortened, spot};

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
    #[error("unknown key `{}` in {table}", shortened(key))]
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
    #[error("the expression `{}` cannot be used: {reason}", shortened(text))]
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
    #[error("the condition `{}` cannot be used: {reason}", shortened(text))]
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
    /// A mesh, surface or outline that gives no points.
    #[error("{reason}")]
    BadMesh {
        /// What is wrong, with the file and the place in it.
        reason: String,
    },
    /// A mesh of another dimension.
    #[error("the mesh has elements of dimension {found}, the body has dimension {given}")]
    OtherDimension {
        /// The dimension in the deck.
        given: usize,
        /// That of the elements.
        found: usize,
    },
    /// A spacing that is not that of a mesh.
    #[error(
        "the mean size of the elements is {}, the spacing is given as {}",
        quantity(*found, "m"), quantity(*given, "m")
    )]
    OtherElementSize {
        /// The spacing in the deck, m.
        given: f64,
        /// The mean size of the elements, m.
        found: f64,
    },
    /// A pressure without a face.
    #[error(
        "the set `{}` has no face that a pressure could act on",
        shortened(set)
    )]
    NoFaces {
        /// The set.
        set: String,
    },
    /// A surface of triangles that is no pre-crack.
    #[error("{reason}")]
    BadCrackFile {
        /// What is wrong, with the file and the place in it.
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
    #[error(
        "`{}` depends on time already and takes no time function",
        shortened(text)
    )]
    TwoCourses {
        /// The expression.
        text: String,
    },
    /// A unit that does not exist.
    #[error("unknown unit `{}` in `{value}`", shortened(unit))]
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
    #[error("the name `{}` cannot be used: {reason}", shortened(name))]
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
    #[error("the override `{}` cannot be applied: {reason}", shortened(text))]
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
    /// Points, grids and sets that do not belong together.
    #[error("the discretisation cannot be assembled: {reason}")]
    BadDiscretisation {
        /// What does not fit.
        reason: String,
    },
    /// A set without points.
    #[error("the set `{}` selects no point", shortened(set))]
    EmptySet {
        /// The set.
        set: String,
    },
    /// A material that is assigned, but to no point.
    #[error("no point has the material `{}`", shortened(material))]
    EmptyMaterial {
        /// Its name.
        material: String,
    },
    /// Points without a material.
    #[error(
        "{points} of {of} points have no material, such as that at {} m",
        spot(place)
    )]
    NoMaterial {
        /// How many.
        points: usize,
        /// All points.
        of: usize,
        /// One of them, m.
        place: Vec<f64>,
    },
    /// A material that differs from the body's in what all bonds share.
    #[error("`{key}` in {table} differs from that of the other materials")]
    NotShared {
        /// The key.
        key: &'static str,
        /// The table.
        table: String,
    },
    /// A set with the fine time step that bonds reach across.
    #[error(
        "the fine set `{set}` is {} thick along {axis}; it must be at least as thick as its longest bond, {}, or bonds of points with the coarse step pass over it",
        quantity(*extent, "m"), quantity(*reach, "m")
    )]
    ThinFineSet {
        /// The set.
        set: String,
        /// Its extent, m.
        extent: f64,
        /// Along this axis.
        axis: char,
        /// Length of its longest bond, m.
        reach: f64,
    },
    /// Two sets with the fine time step that share points.
    #[error("the fine sets `{first}` and `{second}` share points, such as point {point}")]
    FineSetsOverlap {
        /// One set.
        first: String,
        /// The other.
        second: String,
        /// A shared point, in the user's numbering.
        point: usize,
    },
    /// A load whose area cannot be guessed.
    #[error("the area that the traction acts on cannot be told: {reason}")]
    UnknownArea {
        /// Why.
        reason: &'static str,
    },
    /// A field that the forces do not have.
    #[error("{fields} not available here: {reason}")]
    NoFields {
        /// Which, with the verb.
        fields: &'static str,
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

impl Fault {
    /// Whether the model is refused for the memory it needs.
    pub fn is_too_large(&self) -> bool {
        matches!(
            self,
            Self::TooLarge { .. } | Self::LongHistory { .. } | Self::LargeFile { .. }
        )
    }
}
