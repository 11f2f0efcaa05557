//! Errors in decks and models.

mod advice;
mod words;

use pericles::PericlesError;
use pericles::units::quantity;

use crate::wording::{bytes, count, names, shortened, spot};

/// Kinds of errors.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Invalid TOML.
    #[error("not valid TOML: {message}")]
    Syntax {
        /// The parser's message.
        message: String,
    },
    /// An unknown key.
    #[error("unknown key `{}` in {table}", shortened(key))]
    UnknownKey {
        /// The key.
        key: String,
        /// The table that contains it.
        table: String,
        /// The most similar allowed key.
        nearest: Option<String>,
        /// The table to which it belongs.
        home: Option<&'static str>,
        /// All allowed keys.
        allowed: Vec<String>,
    },
    /// A missing required key.
    #[error("{table} requires `{key}`")]
    MissingKey {
        /// The key.
        key: String,
        /// Other names of the key.
        synonyms: Vec<String>,
        /// The table that requires it.
        table: String,
    },
    /// Several alternative keys, none of which is given.
    #[error("{table} requires one of {}", names(allowed))]
    MissingChoice {
        /// The table.
        table: String,
        /// The keys.
        allowed: Vec<String>,
    },
    /// Several mutually exclusive keys.
    #[error("{} are given together in {table}", names(given))]
    Exclusive {
        /// The keys found.
        given: Vec<String>,
        /// The table.
        table: String,
        /// The keys of which one is allowed.
        allowed: Vec<String>,
    },
    /// A key that is not allowed in combination with other keys.
    #[error("`{key}` is not allowed in {table}")]
    Misplaced {
        /// The key.
        key: String,
        /// The table.
        table: String,
        /// When it is allowed.
        allowed: String,
    },
    /// A value of the wrong type.
    #[error("expected {expected}, found {found} (`{value}`)")]
    WrongKind {
        /// The value as written.
        value: String,
        /// Its type.
        found: &'static str,
        /// The expected type.
        expected: String,
    },
    /// A string without a number, or a number that is NaN or infinite.
    #[error("`{value}` is not a number")]
    NotANumber {
        /// The value as written.
        value: String,
        /// The expected quantity.
        expected: String,
    },
    /// A number with a comma.
    #[error("`{value}` contains a comma")]
    Comma {
        /// The value as written.
        value: String,
    },
    /// An invalid expression.
    #[error("the expression `{}` cannot be used: {reason}", shortened(text))]
    BadExpression {
        /// The expression.
        text: String,
        /// What is wrong.
        reason: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A load or prescribed motion that becomes NaN or infinite.
    #[error("the {what} on `{set}` has no finite value at t = {}, within the run", quantity(*t, "s"))]
    LostValue {
        /// `load` or `prescribed motion`.
        what: &'static str,
        /// Its set.
        set: String,
        /// The first such time, s.
        t: f64,
    },
    /// A stop condition that can never be met.
    #[error("the stop condition on `{set}` can never be met: {reason}")]
    NeverStops {
        /// The set.
        set: String,
        /// The reason.
        reason: &'static str,
    },
    /// An invalid surface file.
    #[error("{file} is not a valid surface: {reason}")]
    BadSurfaceFile {
        /// The file.
        file: String,
        /// What is wrong, and where in the file.
        reason: String,
    },
    /// An invalid condition.
    #[error("the condition `{}` cannot be used: {reason}", shortened(text))]
    BadCondition {
        /// The condition.
        text: String,
        /// What is wrong.
        reason: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// An invalid file of points.
    #[error("{reason}")]
    BadPoints {
        /// What is wrong, with the file and the line in it.
        reason: String,
    },
    /// An invalid mesh, surface or outline.
    #[error("{reason}")]
    BadMesh {
        /// What is wrong, with the file and the place in it.
        reason: String,
    },
    /// A mesh whose dimension differs from that of the body.
    #[error("the elements of the mesh have dimension {found}, but the body has dimension {given}")]
    OtherDimension {
        /// The dimension in the deck.
        given: usize,
        /// The dimension of the elements.
        found: usize,
    },
    /// A spacing that differs from the element size of a mesh.
    #[error(
        "the mean element size is {}, but `spacing` is {}",
        quantity(*found, "m"), quantity(*given, "m")
    )]
    OtherElementSize {
        /// The spacing in the deck, m.
        given: f64,
        /// The mean size of the elements, m.
        found: f64,
    },
    /// A pressure on a set without faces, or with faces inside the body.
    #[error("{}", words::no_faces(set, *inner))]
    NoFaces {
        /// The set.
        set: String,
        /// Number of its faces that lie between two elements.
        inner: usize,
    },
    /// An invalid pre-crack file.
    #[error("{reason}")]
    BadCrackFile {
        /// What is wrong, with the file and the place in it.
        reason: String,
    },
    /// A file that does not fit in memory.
    #[error("{reason}")]
    LargeFile {
        /// The file and the memory that it needs.
        reason: String,
    },
    /// An invalid file of initial values.
    #[error("{reason}")]
    BadInitialFile {
        /// What is wrong, with the file and the line in it.
        reason: String,
        /// The number of points of the body.
        points: usize,
    },
    /// An invalid file of temperatures.
    #[error("{reason}")]
    BadTemperatureFile {
        /// What is wrong, with the file and the line in it.
        reason: String,
        /// The number of points of the body.
        points: usize,
    },
    /// Listed points whose volumes do not match the spacing.
    #[error(
        "the volumes of the listed points correspond to a spacing of {}, but `spacing` is {}",
        quantity(*found, "m"), quantity(*given, "m")
    )]
    OtherSpacing {
        /// The spacing of the deck, m.
        given: f64,
        /// The spacing that corresponds to the mean volume, m.
        found: f64,
        /// The key of `[body]` by which volumes are divided in 1D and 2D.
        section: Option<&'static str>,
    },
    /// A time function for an expression that already depends on time.
    #[error(
        "`{}` already depends on time and takes no time function",
        shortened(text)
    )]
    TwoCourses {
        /// The expression.
        text: String,
    },
    /// An unknown unit.
    #[error("unknown unit `{}` in `{value}`", shortened(unit))]
    UnknownUnit {
        /// The value as written.
        value: String,
        /// The unit.
        unit: String,
        /// The most similar unit.
        nearest: Option<String>,
        /// The expected quantity.
        expected: String,
    },
    /// A unit of the wrong dimension.
    #[error("`{value}` is not {expected}")]
    WrongUnit {
        /// The value as written.
        value: String,
        /// The expected quantity.
        expected: String,
        /// The expected quantity with an example.
        allowed: String,
    },
    /// A value out of range.
    #[error("`{value}` is out of range")]
    OutOfRange {
        /// The value as written.
        value: String,
        /// The allowed range.
        allowed: String,
    },
    /// An unknown word.
    #[error("unknown {what} `{value}`")]
    UnknownWord {
        /// The kind of thing that the word names.
        what: &'static str,
        /// The value as written.
        value: String,
        /// The most similar allowed word.
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
        /// The required length.
        allowed: String,
    },
    /// An invalid name.
    #[error("the name `{}` cannot be used: {reason}", shortened(name))]
    BadName {
        /// The name.
        name: String,
        /// The reason.
        reason: &'static str,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A constraint without a prescribed component.
    #[error("all components are free: this table prescribes nothing")]
    NothingPrescribed,
    /// An invalid override.
    #[error("the override `{}` cannot be applied: {reason}", shortened(text))]
    BadOverride {
        /// The override.
        text: String,
        /// The reason.
        reason: String,
        /// What is allowed.
        allowed: String,
    },
    /// A point with two constraints along one axis that differ.
    #[error(
        "the motion of point {point} along {axis} is already prescribed by [[constraint]] number {earlier}, with other values"
    )]
    PrescribedTwice {
        /// The number of the point.
        point: usize,
        /// The axis.
        axis: char,
        /// The number of the earlier constraint in the deck, from 1.
        earlier: usize,
    },
    /// Inconsistent points, grids and sets.
    #[error("the discretisation is inconsistent: {reason}")]
    BadDiscretisation {
        /// What is inconsistent.
        reason: String,
    },
    /// A model that a single process computes.
    #[error("this model cannot be divided among several processes: {reason}")]
    Undivided {
        /// The reason.
        reason: &'static str,
    },
    /// More processes than parts of the body.
    #[error("{points} points cannot be divided among {processes} processes")]
    TooManyProcesses {
        /// Number of processes.
        processes: usize,
        /// Number of points.
        points: usize,
    },
    /// A set without points.
    #[error("the set `{}` selects no point", shortened(set))]
    EmptySet {
        /// What to do.
        advice: String,
        /// The set.
        set: String,
    },
    /// Pieces of a body that overlap.
    #[error("the pieces `{}` and `{}` overlap: near {} two of their points are {} apart, less than half of a cell",
        shortened(&pieces[0]), shortened(&pieces[1]), spot(place), quantity(*distance, "m"))]
    OverlappingPieces {
        /// Their names.
        pieces: [String; 2],
        /// Position of a point of the first piece, m.
        place: Vec<f64>,
        /// Distance of the points, m.
        distance: f64,
    },
    /// A material that is assigned to no point.
    #[error("no point has the material `{}`", shortened(material))]
    EmptyMaterial {
        /// Its name.
        material: String,
    },
    /// Points without a material.
    #[error(
        "{points} of {of} points have no material, such as the one at {} m",
        spot(place)
    )]
    NoMaterial {
        /// The number of points without a material.
        points: usize,
        /// The number of all points.
        of: usize,
        /// The position of one of them, m.
        place: Vec<f64>,
    },
    /// A property that differs between materials but must be shared by all bonds.
    #[error("`{key}` in {table} differs from the value of the other materials")]
    NotShared {
        /// The key.
        key: &'static str,
        /// The table.
        table: String,
    },
    /// A set with the fine time step that is thinner than a bond.
    #[error(
        "the fine set `{set}` is {} thick along {axis}; it must be at least as thick as its longest bond, {}, so that no bond between coarse points crosses it",
        quantity(*extent, "m"), quantity(*reach, "m")
    )]
    ThinFineSet {
        /// The set.
        set: String,
        /// Its extent, m.
        extent: f64,
        /// The axis.
        axis: char,
        /// The length of its longest bond, m.
        reach: f64,
    },
    /// Two sets with the fine time step that share points.
    #[error("the fine sets `{first}` and `{second}` share points, such as point {point}")]
    FineSetsOverlap {
        /// One set.
        first: String,
        /// The other.
        second: String,
        /// A shared point, in the numbering of the field files.
        point: usize,
    },
    /// A traction whose area cannot be determined.
    #[error("the area on which the traction acts is unknown: {reason}")]
    UnknownArea {
        /// The reason.
        reason: &'static str,
    },
    /// Fields that are not available.
    #[error("{fields} not available here: {reason}")]
    NoFields {
        /// The fields, with the verb: `the field Stress is`.
        fields: String,
        /// The reason.
        reason: &'static str,
    },
    /// An exact solution that does not apply to the deck.
    #[error("this exact solution does not apply to this deck: {reason}")]
    NoExactSolution {
        /// The reason.
        reason: &'static str,
    },
    /// A window of comparison without points.
    #[error(
        "the window of {} around x = {} contains no point: the nearest one is {} away",
        quantity(*window, "m"), quantity(*centre, "m"), quantity(*nearest, "m")
    )]
    EmptyWindow {
        /// Its half-width, m.
        window: f64,
        /// Its centre, m.
        centre: f64,
        /// The distance of the nearest point, m.
        nearest: f64,
    },
    /// An exact solution that is too expensive.
    #[error(
        "the exact solution needs a sum of {terms:.1e} terms per point at the end of the run; at most {most:.0e} are allowed"
    )]
    LongSum {
        /// The number of terms.
        terms: f64,
        /// The largest allowed number of terms.
        most: f64,
    },
    /// A body that exceeds the memory limit.
    #[error(
        "the body has {} points and needs about {} of memory; the limit is {}",
        count(*points), bytes(*needed), bytes(*memory as f64)
    )]
    TooLarge {
        /// The number of points, or an upper bound.
        points: f64,
        /// The estimated memory, bytes.
        needed: f64,
        /// The memory limit, bytes.
        memory: u64,
    },
    /// A history of an absorbing boundary that exceeds the memory limit.
    #[error(
        "the history of {} steps needs about {} of memory; the limit is {}",
        count(*steps), bytes(*needed), bytes(*memory as f64)
    )]
    LongHistory {
        /// Steps of the run.
        steps: f64,
        /// The estimated memory, bytes.
        needed: f64,
        /// The memory limit, bytes.
        memory: u64,
    },
    /// Tuned coefficients that make the lattice unstable.
    #[error(
        "the tuned coefficients make the lattice unstable: the smallest ω²/k² of its waves is {smallest:.3} E/ρ, but must be positive"
    )]
    UnstableTable {
        /// The smallest ω²/k² in units of E/ρ.
        smallest: f64,
    },
    /// An error of the library.
    #[error(transparent)]
    Model(#[from] PericlesError),
}

impl Fault {
    /// Returns whether the model is rejected because it exceeds the memory limit.
    pub fn is_too_large(&self) -> bool {
        matches!(
            self,
            Self::TooLarge { .. } | Self::LongHistory { .. } | Self::LargeFile { .. }
        )
    }
}
