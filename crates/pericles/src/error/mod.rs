//! The error type of the library.

mod check;
mod extension;
mod strength;
mod text;

pub use check::positive;
pub use extension::DeviceError;
pub use strength::UnreachableStrength;

use crate::step_kind::{StepKind, schemes_of};
use crate::units::{precise, quantity, significant};
use text::{inner_iteration, no_equilibrium, spacings_that_fit};

/// An error in building a model or advancing a run. Every message says what is wrong and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PericlesError {
    /// A quantity that must be positive and finite, such as a length, density or modulus, is not.
    #[error("{quantity} must be positive and finite, not {value}")]
    NotPositive {
        /// The quantity.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },
    /// A coordinate is NaN or infinite.
    #[error("the coordinate {value} of point {point} is not a finite number")]
    NotFinite {
        /// Number of the point.
        point: usize,
        /// The coordinate given.
        value: f64,
    },
    /// The rounding of coordinates is not small compared with the spacing.
    #[error(
        "the body reaches {} from the origin, where double precision resolves only {}: too coarse for a spacing of {}. Allowed with this spacing: coordinates up to {}. Check the unit of the lengths",
        quantity(*farthest, "m"), quantity(*resolution, "m"), quantity(*spacing, "m"), quantity(*allowed, "m")
    )]
    Unresolved {
        /// Largest absolute value of a coordinate, m.
        farthest: f64,
        /// Distance between adjacent floating-point numbers there, m.
        resolution: f64,
        /// Spacing of the points, m.
        spacing: f64,
        /// Largest allowed absolute value of a coordinate, m.
        allowed: f64,
    },
    /// A side of the body is not a whole number of cells.
    #[error(
        "a side of {} is not a whole number of cells of {}; the nearest sides that fit: {} and {}{}",
        precise(*length, "m"), precise(*spacing, "m"), precise(*below, "m"), precise(*above, "m"), spacings_that_fit(fitting)
    )]
    NotWholeCells {
        /// The side given, m.
        length: f64,
        /// Spacing of the grid, m.
        spacing: f64,
        /// The next shorter side that fits, m.
        below: f64,
        /// The next longer side that fits, m.
        above: f64,
        /// Spacings near the given one that divide all sides, m.
        fitting: Vec<f64>,
    },
    /// The shape without its holes contains no cell centre.
    #[error("the body has no points: no cell centre lies inside the shape and outside its holes")]
    EmptyBody,
    /// The grid has more points than can be numbered or than a grid may have.
    #[error("the grid would have {} cells; allowed: at most {limit}. Use a larger spacing", significant(*cells, 4))]
    TooManyPoints {
        /// Cells of the bounding box.
        cells: f64,
        /// The limit.
        limit: u64,
    },
    /// The lists of positions, blocks and volumes differ in length.
    #[error("{positions} positions, {blocks} blocks, {volumes} volumes; each point needs one each")]
    ListedLengths {
        /// Number of positions.
        positions: usize,
        /// Number of blocks.
        blocks: usize,
        /// Number of volumes.
        volumes: usize,
    },
    /// Two points coincide.
    #[error("points {first} and {second} of the list (counted from 0) are at the same place")]
    SamePlace {
        /// The first point.
        first: usize,
        /// The other point.
        second: usize,
    },
    /// The horizon is smaller than the spacing, so that no point has a neighbour.
    #[error(
        "the horizon {} reaches no neighbour; allowed: at least the spacing, {} (usual: 3 spacings)",
        precise(*horizon, "m"), precise(*spacing, "m")
    )]
    HorizonTooSmall {
        /// Horizon, m.
        horizon: f64,
        /// Spacing, m.
        spacing: f64,
    },
    /// The horizon holds too many neighbours.
    #[error(
        "the horizon {} is {:.0} spacings of {}, which gives each point up to {neighbours:.0e} neighbours; allowed: at most {most:.0e} (usual: 3 spacings). Check the unit of the horizon",
        precise(*horizon, "m"), horizon / spacing, precise(*spacing, "m")
    )]
    HorizonTooLarge {
        /// Horizon, m.
        horizon: f64,
        /// Spacing, m.
        spacing: f64,
        /// Cells of the cube around a family.
        neighbours: f64,
        /// Largest allowed number of neighbours.
        most: f64,
    },
    /// A shape, region or crack has another dimension than the body.
    #[error("{what} needs a body of dimension {needed}; this body has dimension {dimension}")]
    WrongDimension {
        /// The object that does not fit.
        what: &'static str,
        /// Allowed dimensions.
        needed: &'static str,
        /// Dimension of the body.
        dimension: usize,
    },
    /// A force was made for another body than the other forces of the system.
    #[error(
        "the force acts on {points} points in {dimension} dimensions, but the body has {needed_points} points in {needed_dimension} dimensions"
    )]
    ForceOfAnotherBody {
        /// Points of the force.
        points: usize,
        /// Dimension of the force.
        dimension: usize,
        /// Points of the body.
        needed_points: usize,
        /// Dimension of the body.
        needed_dimension: usize,
    },
    /// A crack surface has no area, or its polygon is not plane.
    #[error("the crack has no usable surface: {reason}")]
    BadCrack {
        /// The reason.
        reason: &'static str,
    },
    /// A body has no layer of ghost points at its surface.
    #[error("no ghost layer at the surface: {reason}")]
    NoGhostLayer {
        /// The reason and what to do.
        reason: String,
    },
    /// A number is outside its range.
    #[error("{quantity} is {value}; allowed: {allowed}")]
    OutOfRange {
        /// The quantity.
        quantity: &'static str,
        /// The value given.
        value: f64,
        /// The allowed range.
        allowed: &'static str,
    },
    /// A field is a sum over single bonds, which this form of the forces does not provide.
    #[error(
        "{field} is a sum over single bonds, which this form of the bonds does not provide; use bonds = \"list\" or \"grid\", or leave the field out"
    )]
    NoSuchField {
        /// The field.
        field: &'static str,
    },
    /// A field belongs to materials that the body does not have.
    #[error("{field} is a field of {of}, which this body does not have; leave the field out")]
    NoMaterialOfField {
        /// The field.
        field: &'static str,
        /// The materials that have it.
        of: &'static str,
    },
    /// The influence function is not supported here.
    #[error("influence function: {reason}")]
    BadInfluence {
        /// The reason, and what is allowed.
        reason: String,
    },
    /// The Poisson's ratio differs from the fixed one of bond-based peridynamics.
    #[error(
        "Poisson's ratio {given} is not supported: bond-based peridynamics in {state} has one elastic constant and Poisson's ratio {fixed}; leave the ratio out or set it to {fixed}"
    )]
    PoissonRatio {
        /// The ratio given.
        given: f64,
        /// The stress state.
        state: &'static str,
        /// The ratio of the model.
        fixed: f64,
    },
    /// The elastic constants contradict each other, describe no solid, or are too few.
    #[error("elastic constants: {reason}")]
    ElasticConstants {
        /// The reason, and what is allowed.
        reason: String,
    },
    /// The time step exceeds the stability limit of the scheme.
    #[error(
        "the time step {} is unstable: the highest frequency of the body is {} 1/s, so {scheme} needs dt ≤ {} s. Use a smaller dt, dt = \"auto\", \
         or allow_unstable = true",
        quantity(*dt, "s"), significant(*omega, 4), significant(*limit, 5)
    )]
    UnstableStep {
        /// The step given, s.
        dt: f64,
        /// Highest angular frequency, 1/s.
        omega: f64,
        /// The largest stable step, s.
        limit: f64,
        /// Name of the scheme.
        scheme: &'static str,
    },
    /// A damping layer has invalid parameters.
    #[error("damping layer: {reason}")]
    BadDampingLayer {
        /// The reason, and what is allowed.
        reason: String,
    },
    /// No bond resists motion, so that the body has no stable step.
    #[error("the body has no bond that resists motion, so it has no stable step; give dt")]
    NoStiffness,
    /// A checkpoint does not match the model.
    #[error("the checkpoint does not match this model: {reason}")]
    BadArchive {
        /// The missing entry, or the one of wrong length.
        reason: String,
    },
    /// The body cannot be periodic.
    #[error(
        "only a full box of cells can be periodic; allowed: a bar, plate or block without holes"
    )]
    NotPeriodic,
    /// A form of the forces is not available for the body.
    #[error("the force kernel \"{form}\" (key `bonds`) is not available for this body: {reason}")]
    FormNotUsable {
        /// The form, as in decks.
        form: &'static str,
        /// The reason, and what is available.
        reason: &'static str,
    },
    /// The ratio of time steps is below one.
    #[error("the ratio of the time steps is {ratio}; allowed: a whole number of at least 1")]
    StepRatio {
        /// The ratio given.
        ratio: u32,
    },
    /// The refinement ratio of a region is below two.
    #[error("refined region {part} divides the cells by {ratio}; allowed: 2 or more")]
    FinerRatio {
        /// Index of the region, from 0.
        part: usize,
        /// The ratio given.
        ratio: u32,
    },
    /// A refined region contains no cell.
    #[error("refined region {part} contains no cell centre, or later regions cover it")]
    FinerEmpty {
        /// Index of the region, from 0.
        part: usize,
    },
    /// There are more refined regions than can be numbered.
    #[error("{parts} refined regions; allowed: at most {most}")]
    FinerParts {
        /// Number of regions.
        parts: usize,
        /// Largest allowed number.
        most: usize,
    },
    /// A feature is not supported on a body with several cell sizes.
    #[error("{what} is not supported on a body with several cell sizes: {reason}")]
    Graded {
        /// The feature.
        what: &'static str,
        /// The reason, and what is supported.
        reason: &'static str,
    },
    /// A fine region has no points.
    #[error("fine region {region} has no points; at least one is needed")]
    FineRegionEmpty {
        /// Index of the region, from 0.
        region: usize,
    },
    /// Two fine regions share a point.
    #[error("fine regions {first} and {second} overlap at point {point}; give them as one region")]
    FineRegionsOverlap {
        /// Index of one region, from 0.
        first: usize,
        /// Index of the other region.
        second: usize,
        /// A common point, in the user's numbering.
        point: usize,
    },
    /// A fine region is thinner than its longest bond.
    #[error(
        "fine region {region} is {} thick along {axis}; allowed: at least its longest bond, {}, so that no bond between points with the coarse step crosses it",
        quantity(*extent, "m"), quantity(*reach, "m")
    )]
    FineRegionThin {
        /// Index of the region, from 0.
        region: usize,
        /// Its thickness, m.
        extent: f64,
        /// The axis, x, y or z.
        axis: char,
        /// Length of the longest bond, m.
        reach: f64,
    },
    /// The scheme is not available for the body.
    #[error("{scheme} is not available for this body: {reason}")]
    SchemeNotUsable {
        /// Name of the scheme.
        scheme: &'static str,
        /// The reason, and what to do.
        reason: &'static str,
    },
    /// A parameter of a scheme is outside its range.
    #[error("{parameter} is {value}; allowed: {allowed}")]
    SchemeParameter {
        /// The parameter.
        parameter: &'static str,
        /// The value given.
        value: f64,
        /// The allowed range.
        allowed: &'static str,
    },
    /// An adaptive scheme reached its smallest step without meeting the tolerance.
    #[error(
        "at t = {} s no step meets the tolerance; the smallest tried is {} s. Use a looser tolerance or a smoother load",
        significant(*t, 4), significant(*step, 3)
    )]
    StepTooSmall {
        /// Time, s.
        t: f64,
        /// The smallest step tried, s.
        step: f64,
    },
    /// A table of a time function has an unusable row.
    #[error(
        "row {row} of the time table (counted from 0) is not usable; needed: at least one row, finite numbers, times that increase from row to row"
    )]
    BadTimeTable {
        /// Index of the row, from 0.
        row: usize,
    },
    /// An iterative solver did not reach its tolerance.
    #[error(
        "{solver} did not converge: the residual is {} after {iterations} iterations, the tolerance {} ({cause}). Use a smaller time step",
        significant(*residual, 3), significant(*tolerance, 3)
    )]
    NotConverged {
        /// Name of the solver.
        solver: &'static str,
        /// Number of iterations.
        iterations: usize,
        /// Norm of the last residual.
        residual: f64,
        /// Allowed norm of the residual.
        tolerance: f64,
        /// The likely cause.
        cause: &'static str,
    },
    /// An error that another process has reported.
    #[error("another process has failed")]
    OnAnotherProcess,
    /// A step was interrupted on request.
    #[error("the step was interrupted")]
    Interrupted,
    /// No equilibrium was found in a load step.
    #[error("{}", no_equilibrium(*t, *iterations, *residual, *tolerance))]
    NoEquilibrium {
        /// Time of the load step, s.
        t: f64,
        /// Number of iterations.
        iterations: u32,
        /// Relative residual: unbalanced force over applied force.
        residual: f64,
        /// Allowed relative residual.
        tolerance: f64,
    },
    /// A boundary does not support the kind of step that the scheme takes.
    #[error(
        "{what} needs {}, not {scheme}{}",
        schemes_of(needed),
        kind.why_not()
    )]
    BoundaryScheme {
        /// The boundary.
        what: &'static str,
        /// The scheme of the run.
        scheme: &'static str,
        /// The kind of step of the scheme.
        kind: StepKind,
        /// The kinds of steps that the boundary supports.
        needed: &'static [StepKind],
    },
    /// The run is longer than the absorbing boundary supports.
    #[error(
        "the run has {steps} steps, but its absorbing boundary was made for {made_for}; make it for all steps of the run"
    )]
    BoundarySteps {
        /// Number of steps of the run.
        steps: u64,
        /// Number of steps of the boundary.
        made_for: u64,
    },
    /// An error of an extension crate.
    #[error(transparent)]
    Extension(Box<dyn std::error::Error + Send + Sync>),
    /// The inner iteration of an implicit step did not converge.
    #[error(
        "{}",
        inner_iteration(*t, *iterations, *change, *tolerance, *dt, *omega, *safe)
    )]
    InnerIteration {
        /// Time at the end of the step, s.
        t: f64,
        /// Largest allowed number of evaluations.
        iterations: u32,
        /// Last change of the velocity, m/s; NaN or infinite if the iteration diverged.
        change: f64,
        /// Allowed change, m/s.
        tolerance: f64,
        /// The time step, s.
        dt: f64,
        /// Estimate of the highest angular frequency at the current state, 1/s.
        omega: f64,
        /// A smaller step that would converge in as many iterations, s; `None` if the step is not the reason.
        safe: Option<f64>,
    },
    /// An array has the wrong length.
    #[error("{what}: {length} entries are given, {needed} are needed")]
    WrongLength {
        /// What the array contains.
        what: &'static str,
        /// Number of entries given.
        length: usize,
        /// Number of entries needed.
        needed: usize,
    },
    /// A set contains a point that the body does not have.
    #[error("{what}: point {point} does not exist; the points of the body are 0 to {}", points - 1)]
    NoSuchPoint {
        /// Purpose of the set.
        what: &'static str,
        /// The point given.
        point: u32,
        /// Number of points of the body.
        points: usize,
    },
    /// A set of points is not usable.
    #[error("{what}: {reason}")]
    BadSet {
        /// Purpose of the set.
        what: &'static str,
        /// The reason, and what is allowed.
        reason: &'static str,
    },
    /// No face has this name.
    #[error("`{name}` is not a face; allowed: -x, +x, -y, +y, -z and +z")]
    UnknownFace {
        /// The name given.
        name: String,
    },
    /// A required value is missing.
    #[error("{what} is not given: {allowed}")]
    NotGiven {
        /// The missing value.
        what: &'static str,
        /// What to give.
        allowed: &'static str,
    },
    /// A tensile strength that softening cannot give.
    #[error(transparent)]
    Strength(#[from] UnreachableStrength),
    /// Two constraints prescribe different values of one component of the motion of a point.
    #[error("two constraints prescribe different motions of point {point} along {axis}; omit one")]
    PrescribedTwice {
        /// Number of the point.
        point: usize,
        /// The axis, x, y or z.
        axis: char,
        /// Index of the earlier constraint.
        earlier: usize,
    },
}

/// Result with [`PericlesError`].
pub type Result<T> = std::result::Result<T, PericlesError>;
