//! The one error type of the library.

mod check;
mod text;

pub use check::positive;

use crate::step_kind::{StepKind, schemes_of};
use crate::units::{precise, quantity};
use text::{inner_iteration, no_equilibrium, spacings_that_fit};

/// What can go wrong when a model is built or a run is stepped. Every message says what is wrong and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PericlesError {
    /// A length, density, modulus … that must be a positive finite number is not.
    #[error("{quantity} must be positive and finite, not {value}")]
    NotPositive {
        /// What the number stands for.
        quantity: &'static str,
        /// The number given.
        value: f64,
    },
    /// A coordinate that is no number.
    #[error("the coordinate {value} of point {point} is not a finite number")]
    NotFinite {
        /// The point's number.
        point: usize,
        /// The coordinate given.
        value: f64,
    },
    /// Coordinates whose rounding is not small beside the spacing.
    #[error(
        "the body reaches {} from the origin, where double precision resolves {} only: too coarse for a spacing of {}; with this spacing places up to {} \
         from the origin are possible; is a unit wrong?",
        quantity(*farthest, "m"), quantity(*resolution, "m"), quantity(*spacing, "m"), quantity(*allowed, "m")
    )]
    Unresolved {
        /// The largest coordinate in size, m.
        farthest: f64,
        /// The distance of neighbouring numbers there, m.
        resolution: f64,
        /// Distance of neighbouring points, m.
        spacing: f64,
        /// The largest coordinate allowed, m.
        allowed: f64,
    },
    /// A body's side is no whole number of cells.
    #[error(
        "a side of {} is not a whole number of cells of {}; the nearest sides that are: {} and {}{}",
        precise(*length, "m"), precise(*spacing, "m"), precise(*below, "m"), precise(*above, "m"), spacings_that_fit(fitting)
    )]
    NotWholeCells {
        /// The side asked for, m.
        length: f64,
        /// Spacing of the grid, m.
        spacing: f64,
        /// The next shorter side that fits, m.
        below: f64,
        /// The next longer side that fits, m.
        above: f64,
        /// Spacings near the one asked for that divide all sides, m.
        fitting: Vec<f64>,
    },
    /// The shape, less its holes, contains no cell centre.
    #[error("the body has no points: no cell centre lies inside the shape and outside its holes")]
    EmptyBody,
    /// More points than the numbering can hold or than a grid may have.
    #[error("the grid would have {cells} cells; at most {limit} are possible")]
    TooManyPoints {
        /// Cells of the bounding box.
        cells: f64,
        /// The limit.
        limit: u64,
    },
    /// Lists of points, blocks and volumes that do not go together.
    #[error(
        "{positions} positions, {blocks} blocks and {volumes} volumes are listed: each point needs one of each"
    )]
    ListedLengths {
        /// Positions.
        positions: usize,
        /// Blocks.
        blocks: usize,
        /// Volumes.
        volumes: usize,
    },
    /// Two points at one place.
    #[error("points {first} and {second} of the list (counted from 0) are at the same place")]
    SamePlace {
        /// The first of them.
        first: usize,
        /// The other.
        second: usize,
    },
    /// The horizon reaches no neighbour.
    #[error(
        "the horizon {horizon} m reaches no neighbour: it must be at least the spacing, {spacing} m (usual: 3 spacings)"
    )]
    HorizonTooSmall {
        /// Horizon, m.
        horizon: f64,
        /// Spacing, m.
        spacing: f64,
    },
    /// A horizon with far too many neighbours.
    #[error(
        "the horizon {horizon} m is {:.0} spacings of {spacing} m, so that each point would have up to {neighbours:.0e} neighbours; at most {most:.0e} are \
         possible (usual: 3 spacings); is a unit wrong?",
        horizon / spacing
    )]
    HorizonTooLarge {
        /// Horizon, m.
        horizon: f64,
        /// Spacing, m.
        spacing: f64,
        /// Cells of the cube about a family.
        neighbours: f64,
        /// The largest number.
        most: f64,
    },
    /// Shape, region or crack of another dimension than the body.
    #[error("{what} needs a body of dimension {needed}, this one has dimension {dimension}")]
    WrongDimension {
        /// What does not fit.
        what: &'static str,
        /// Dimensions it can be used in.
        needed: &'static str,
        /// The body's dimension.
        dimension: usize,
    },
    /// A force made for another body than the other forces of a system.
    #[error(
        "the force acts on {points} points in {dimension} dimensions; the body has {needed_points} points in {needed_dimension} dimensions"
    )]
    ForceOfAnotherBody {
        /// Points of the force.
        points: usize,
        /// Its dimension.
        dimension: usize,
        /// Points of the body.
        needed_points: usize,
        /// Its dimension.
        needed_dimension: usize,
    },
    /// A crack surface without extent, or a polygon that is not plane.
    #[error("the crack has no usable surface: {reason}")]
    BadCrack {
        /// Why.
        reason: &'static str,
    },
    /// A number outside its range.
    #[error("{quantity} is {value}; allowed: {allowed}")]
    OutOfRange {
        /// What the number stands for.
        quantity: &'static str,
        /// The number given.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A field that is made of single bonds, of a body that does not know them.
    #[error(
        "{field} is a sum over single bonds, which this form of the bonds does not have: use a list or a grid of bonds, or leave the field out"
    )]
    NoSuchField {
        /// The field.
        field: &'static str,
    },
    /// A field of materials that the body does not have.
    #[error("{field} is a field of {of}, which this body does not have: leave the field out")]
    NoMaterialOfField {
        /// The field.
        field: &'static str,
        /// Which materials have it.
        of: &'static str,
    },
    /// An influence function that cannot be used here.
    #[error("influence function: {reason}")]
    BadInfluence {
        /// Why, and what is allowed.
        reason: String,
    },
    /// A Poisson ratio that bond-based peridynamics cannot have.
    #[error(
        "Poisson's ratio {given} cannot be had: bond-based peridynamics in {state} has {fixed} (one constant only); leave it out or give {fixed}"
    )]
    PoissonRatio {
        /// The ratio asked for.
        given: f64,
        /// The stress state, in words.
        state: &'static str,
        /// The ratio the model has.
        fixed: f64,
    },
    /// Elastic constants that no solid has, or too few of them.
    #[error("elastic constants: {reason}")]
    ElasticConstants {
        /// Why, and what is allowed.
        reason: String,
    },
    /// The time step is larger than the scheme's limit.
    #[error(
        "the time step {dt:e} s is unstable: the highest frequency of the body is {omega:.4e} 1/s, so {scheme} needs dt ≤ {limit:.4e} s (give a smaller dt, \"auto\", or allow_unstable = true)"
    )]
    UnstableStep {
        /// The step asked for, s.
        dt: f64,
        /// Highest angular frequency, 1/s.
        omega: f64,
        /// The largest stable step, s.
        limit: f64,
        /// Name of the scheme.
        scheme: &'static str,
    },
    /// A damping layer that cannot be.
    #[error("damping layer: {reason}")]
    BadDampingLayer {
        /// Why, and what is allowed.
        reason: String,
    },
    /// Nothing in the body resists motion, so that no stable step can be found.
    #[error("the body has no bond that resists motion: the stable step cannot be found; give dt")]
    NoStiffness,
    /// A stored state does not fit this model.
    #[error("the stored state does not fit: {reason}")]
    BadArchive {
        /// What is missing or has another size.
        reason: String,
    },
    /// A body that cannot repeat.
    #[error("only a full box of cells can be periodic: a bar, plate or block without holes")]
    NotPeriodic,
    /// A form of bonds that does not fit the body.
    #[error("bonds = \"{form}\" does not fit this body: {reason}")]
    FormNotUsable {
        /// The form, as in decks.
        form: &'static str,
        /// Why, and what fits.
        reason: &'static str,
    },
    /// A ratio of time steps below one.
    #[error("the ratio of the time steps is {ratio}: it must be a whole number of at least 1")]
    StepRatio {
        /// The ratio given.
        ratio: u32,
    },
    /// Smaller cells that are not smaller.
    #[error("part {part} with smaller cells divides them by {ratio}; allowed: 2 or more")]
    FinerRatio {
        /// Which of the parts, from 0.
        part: usize,
        /// The division.
        ratio: u32,
    },
    /// A part with smaller cells in which no cell lies.
    #[error(
        "part {part} with smaller cells divides none: no cell's centre lies in it, or later parts hide it"
    )]
    FinerEmpty {
        /// Which of the parts, from 0.
        part: usize,
    },
    /// More parts with smaller cells than can be numbered.
    #[error("{parts} parts with smaller cells; allowed: at most {most}")]
    FinerParts {
        /// The number of parts.
        parts: usize,
        /// The largest number.
        most: usize,
    },
    /// What bonds between cells of different sizes cannot do.
    #[error("a body with cells of several sizes cannot have {what}: {reason}")]
    Graded {
        /// What was asked for.
        what: &'static str,
        /// Why not, and what is possible.
        reason: &'static str,
    },
    /// A fine region without points.
    #[error("fine region {region} has no points; each needs at least one")]
    FineRegionEmpty {
        /// Which of the regions, from 0.
        region: usize,
    },
    /// Two fine regions that share a point.
    #[error("fine regions {first} and {second} overlap, at point {point}: give them as one region")]
    FineRegionsOverlap {
        /// One region, from 0.
        first: usize,
        /// The other.
        second: usize,
        /// A common point, in the user's numbering.
        point: usize,
    },
    /// A fine region that bonds reach across.
    #[error(
        "fine region {region} is {} thick along {axis}; it must be at least as thick as its longest bond, {}, or bonds of points with the coarse step pass over it",
        quantity(*extent, "m"), quantity(*reach, "m")
    )]
    FineRegionThin {
        /// Which of the regions, from 0.
        region: usize,
        /// Its extent, m.
        extent: f64,
        /// The axis, x, y or z.
        axis: char,
        /// Length of the longest bond, m.
        reach: f64,
    },
    /// A scheme that this body cannot be stepped with.
    #[error("{scheme} cannot step this body: {reason}")]
    SchemeNotUsable {
        /// Name of the scheme.
        scheme: &'static str,
        /// Why, and what can be done.
        reason: &'static str,
    },
    /// A parameter of a scheme outside its range.
    #[error("{parameter} is {value}; allowed: {allowed}")]
    SchemeParameter {
        /// What the number stands for.
        parameter: &'static str,
        /// The number given.
        value: f64,
        /// The range.
        allowed: &'static str,
    },
    /// An adaptive scheme that finds no step small enough.
    #[error(
        "at t = {t:e} s no step meets the tolerance: {step:e} s is the smallest that was tried; a looser tolerance or a smoother load helps"
    )]
    StepTooSmall {
        /// Time, s.
        t: f64,
        /// The step, s.
        step: f64,
    },
    /// A table in time whose rows cannot be used.
    #[error(
        "row {row} of the table in time cannot be used: at least one row is needed, all numbers finite, each time later than the one before"
    )]
    BadTimeTable {
        /// The row, from 0.
        row: usize,
    },
    /// An iterative solver that did not reach its tolerance.
    #[error(
        "{solver} stopped after {iterations} iterations with a residual of {residual:e}, {tolerance:e} was asked for: {cause}; a smaller time step helps"
    )]
    NotConverged {
        /// The solver.
        solver: &'static str,
        /// Its iterations.
        iterations: usize,
        /// Norm of the last residual.
        residual: f64,
        /// Norm asked for.
        tolerance: f64,
        /// What stands in the way.
        cause: &'static str,
    },
    /// A step was asked to stop.
    #[error("the step was interrupted")]
    Interrupted,
    /// A load step without an equilibrium.
    #[error("{}", no_equilibrium(*t, *iterations, *residual, *tolerance))]
    NoEquilibrium {
        /// Time of the load step, s.
        t: f64,
        /// Iterations done.
        iterations: u32,
        /// The residual force over the forces that act.
        residual: f64,
        /// The ratio asked for.
        tolerance: f64,
    },
    /// A boundary in a run by a scheme that takes the forces elsewhere within a step.
    #[error(
        "absorbing end: {what} is made for {}, not for {scheme}{}",
        schemes_of(needed),
        kind.why_not()
    )]
    BoundaryScheme {
        /// The boundary.
        what: &'static str,
        /// The scheme of the run.
        scheme: &'static str,
        /// Where the scheme takes the forces.
        kind: StepKind,
        /// The kinds of steps that the boundary is made for.
        needed: &'static [StepKind],
    },
    /// A run longer than what a boundary is made for.
    #[error(
        "absorbing end: the run has {steps} steps, its absorbing end is made for {made_for}: make it for all steps of the run"
    )]
    BoundarySteps {
        /// Steps of the run.
        steps: u64,
        /// Steps of the boundary.
        made_for: u64,
    },
    /// What a crate that extends the engine refuses.
    #[error(transparent)]
    Extension(Box<dyn std::error::Error + Send + Sync>),
    /// The inner iteration of a step that does not end.
    #[error(
        "{}",
        inner_iteration(*t, *iterations, *change, *tolerance, *dt, *omega, *safe)
    )]
    InnerIteration {
        /// Time at the end of the step, s.
        t: f64,
        /// Evaluations allowed.
        iterations: u32,
        /// Last change of the velocity, m/s; NaN or infinite where the iteration diverged.
        change: f64,
        /// Change allowed, m/s.
        tolerance: f64,
        /// The step, s.
        dt: f64,
        /// Estimate of the highest angular frequency at the state, 1/s.
        omega: f64,
        /// A step below dt that converges in as many iterations, s; none if the step is not the reason.
        safe: Option<f64>,
    },
    /// An array of another length than the body needs.
    #[error("{what}: {length} entries are given, {needed} are needed")]
    WrongLength {
        /// What the array holds.
        what: &'static str,
        /// Entries given.
        length: usize,
        /// Entries needed.
        needed: usize,
    },
    /// A set that names a point that the body does not have.
    #[error("{what}: point {point} is named, the points of the body are 0 to {}", points - 1)]
    NoSuchPoint {
        /// What the set is for.
        what: &'static str,
        /// The number given.
        point: u32,
        /// Points of the body.
        points: usize,
    },
    /// A set of points that cannot be used.
    #[error("{what}: {reason}")]
    BadSet {
        /// What the set is for.
        what: &'static str,
        /// Why, and what is allowed.
        reason: &'static str,
    },
    /// A name that no face of a body has.
    #[error("`{name}` is not a face of a body; allowed: -x, +x, -y, +y, -z and +z")]
    UnknownFace {
        /// The name given.
        name: String,
    },
    /// A value without a default that was not given.
    #[error("{what} is not given: {allowed}")]
    NotGiven {
        /// What is missing.
        what: &'static str,
        /// What to give.
        allowed: &'static str,
    },
    /// Two conditions prescribe the motion of the same point and component.
    #[error("the motion of point {point} along {axis} is prescribed twice")]
    PrescribedTwice {
        /// The point's number.
        point: usize,
        /// The axis, x, y or z.
        axis: char,
    },
}

impl PericlesError {
    /// The refusal of an extension, if it is one of this type.
    pub fn extension<E: std::error::Error + 'static>(&self) -> Option<&E> {
        match self {
            Self::Extension(error) => error.downcast_ref(),
            _ => None,
        }
    }
}

/// Result with [`PericlesError`].
pub type Result<T> = std::result::Result<T, PericlesError>;
