//! Warnings about decks that are valid but may not do what the user means.

mod advice;
mod area;

use pericles::units::{quantity, significant};
use pericles_manifold::surface::SurfaceCaution;

pub use area::AreaDoubt;

use area::doubtful_area;

use crate::wording::{percent, prefixed, reach, short, spot};

/// Kinds of odd.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum Caution {
    /// Tables of former releases.
    #[error("{} {} a former form", tables.join(", "), if tables.len() == 1 { "is" } else { "are" })]
    FormerTables {
        /// As they are written in a deck.
        tables: Vec<&'static str>,
        /// What takes their place.
        text: String,
    },
    /// A material that nothing is made of.
    #[error("the material `{material}` is not assigned to any set")]
    UnusedMaterial {
        /// Its name.
        material: String,
    },
    /// A pre-crack without effect.
    #[error("this crack cuts no bond")]
    CrackCutsNothing,
    /// A pre-crack away from the body.
    #[error(
        "this crack lies outside of the body, which reaches {}",
        reach(low, high)
    )]
    CrackOutside {
        /// Lowest coordinates of the body along each of its axes, m.
        low: Vec<f64>,
        /// Highest, m.
        high: Vec<f64>,
    },
    /// A horizon that does not go well with the mesh of a surface.
    #[error("{0}")]
    Surface(SurfaceCaution),
    /// A strength that no brittle material has.
    #[error("bonds break beyond a stretch of {:.0} % only", 100.0 * stretch)]
    LargeStretch {
        /// The critical stretch.
        stretch: f64,
    },
    /// A body whose bonds are far from the modulus asked for.
    #[error(
        "inside the body the bonds have {} of the bulk stiffness asked for",
        percent(1.0 + error)
    )]
    StiffnessError {
        /// Bulk stiffness over the one asked for, less one.
        error: f64,
    },
    /// A body that resists shear along its grid far less than its material.
    #[error(
        "inside the body the bonds have {} of the material's shear stiffness along the grid's axes",
        percent(1.0 + error)
    )]
    ShearStiffness {
        /// Shear stiffness over the continuum's, less one.
        error: f64,
    },
    /// A lattice on which a state-based material is far from isotropic.
    #[error(
        "inside the body the shear modulus is {} of the material's along the grid's axes and {} along its diagonals",
        percent(*axes),
        percent(*diagonals)
    )]
    ShearAnisotropy {
        /// Shear modulus along the axes over the material's.
        axes: f64,
        /// Along the diagonals.
        diagonals: f64,
    },
    /// Waves that no solid carries.
    #[error("waves run at {speed:.3e} m/s, faster than in any solid")]
    FastWaves {
        /// Of the pressure wave, m/s.
        speed: f64,
    },
    /// A modulus of no solid.
    #[error(
        "Young's modulus is {} at a density of {}: softer than any solid of this density",
        quantity(*modulus, "Pa"), quantity(*density, "kg/m³")
    )]
    SoftSolid {
        /// Young's modulus, Pa.
        modulus: f64,
        /// Density, kg/m³.
        density: f64,
    },
    /// A density of no solid.
    #[error("the density is {} kg/m³, more than that of any solid", significant(*density, 4))]
    HeavySolid {
        /// Density, kg/m³.
        density: f64,
    },
    /// A spacing below the distance of atoms.
    #[error("the spacing is {}, less than the distance of atoms", quantity(*spacing, "m"))]
    TinySpacing {
        /// Spacing, m.
        spacing: f64,
    },
    /// Two listed points much closer than the others.
    #[error(
        "points {} and {} of the list (counted from 1) are {} apart, the mean spacing is {}",
        points[0], points[1], quantity(*distance, "m"), quantity(*spacing, "m")
    )]
    ClosePoints {
        /// Their numbers in the list, from 1.
        points: [usize; 2],
        /// Their distance, m.
        distance: f64,
        /// Mean spacing of the points, m.
        spacing: f64,
    },
    /// A coordinate of listed points beyond the body's dimension.
    #[error("all points have {axis} = {}; this coordinate is not used", quantity(*value, "m"))]
    UnusedCoordinate {
        /// The axis.
        axis: char,
        /// Its value, m.
        value: f64,
    },
    /// Something unusual in a mesh.
    #[error("{problem}")]
    Mesh {
        /// What.
        problem: String,
    },
    /// Cells that fill a surface or an outline poorly.
    #[error(
        "the cells fill {} of what the boundary encloses ({:.4e} of {:.4e} m³)",
        percent(volume / enclosed), volume, enclosed
    )]
    FilledVolume {
        /// The volume of the cells, m³.
        volume: f64,
        /// The volume that the boundary encloses, m³.
        enclosed: f64,
    },
    /// A hole that takes nothing from the body.
    #[error("this hole contains no cell centre of the body: nothing is cut out")]
    IdleHole,
    /// A key that only breaking bonds give a meaning.
    #[error("`{key}` has no effect: the bonds of this body never break")]
    NothingBreaks {
        /// The key.
        key: &'static str,
    },
    /// A run in which nothing happens.
    #[error("nothing acts on the body: it starts at rest, without loads and prescribed motion")]
    NothingActs,
    /// Classes of bonds without stiffness at an absorbing end.
    #[error(
        "bonds over more than {reach} of {given} spacings have no stiffness: the exterior of the absorbing ends has none there either"
    )]
    IdleClasses {
        /// Spacings within the horizon.
        given: usize,
        /// The longest bonds with a stiffness, in spacings.
        reach: usize,
    },
    /// A traction on a set that is not one layer on one face.
    #[error("{}", doubtful_area(.0))]
    LoadedArea(AreaDoubt),
    /// A load that supports take.
    #[error("{} held along it: there it acts on the supports alone", share(*held, *points))]
    LoadOnHeld {
        /// Points of the load that are held.
        held: usize,
        /// Points of the load.
        points: usize,
    },
    /// A body that hangs together in pieces only.
    #[error(
        "from the start the body is in {pieces} pieces that no bond joins; the smallest has {}, such as that at {} m",
        if *points == 1 { "one point".to_owned() } else { format!("{points} points") },
        spot(place)
    )]
    Pieces {
        /// How many.
        pieces: usize,
        /// Points of the smallest.
        points: usize,
        /// One of them, m.
        place: Vec<f64>,
    },
    /// A static body of which a part may float away.
    #[error(
        "{points} of {of} points, such as that at {} m, are joined to no support by bonds",
        spot(place)
    )]
    NoSupport {
        /// Points without support.
        points: usize,
        /// All points.
        of: usize,
        /// One of them, m.
        place: Vec<f64>,
    },
    /// A static body of which a part is moved by loads that are not in balance.
    #[error(
        "the loads on {points} of {of} points, such as that at {} m, have {} that no support takes",
        spot(place),
        net(*force, *moment)
    )]
    Unbalanced {
        /// Points of the part.
        points: usize,
        /// All points.
        of: usize,
        /// One of them, m.
        place: Vec<f64>,
        /// The net force, N.
        force: Option<f64>,
        /// The net moment about the centre of the part, N m.
        moment: Option<f64>,
    },
    /// A probe away from the body.
    #[error("the probe `{name}` lies {distance:e} m from the nearest point")]
    ProbeOutside {
        /// The probe.
        name: String,
        /// The distance, m.
        distance: f64,
    },
    /// A step beyond the stable limit, accepted by `allow_unstable`.
    #[error("the time step {dt:.6e} s is unstable: it exceeds the stable step of {limit:.6e} s")]
    UnstableStep {
        /// The step, s.
        dt: f64,
        /// The limit, s.
        limit: f64,
    },
    /// A step that does not divide the time of the run.
    #[error(
        "the run does not end after a whole number of steps of {given:.5e} s; all steps are shortened to {used:.5e} s, {count} of which end at time.end exactly"
    )]
    ShortenedStep {
        /// The step given, s.
        given: f64,
        /// The step used, s.
        used: f64,
        /// Number of steps.
        count: u64,
    },
    /// A step that may exceed the stable limit.
    #[error(
        "the time step {dt:.6e} s may be unstable: it exceeds {limit:.6e} s, up to which the scheme is stable for certain"
    )]
    UncertainStep {
        /// The step, s.
        dt: f64,
        /// The step that is surely stable, s.
        limit: f64,
    },
    /// A period that waves cross within the run.
    #[error(
        "the period of {} is short for this run: at its end the waves of the next period are about {estimate:.1e} of the pulse within {} of its middle",
        quantity(*period, "m"), quantity(*window, "m")
    )]
    ShortPeriod {
        /// The period, m.
        period: f64,
        /// Their size over the amplitude.
        estimate: f64,
        /// Where, m.
        window: f64,
    },
    /// Waves that the grid does not carry.
    #[error(
        "{:.0} % of the energy of this {what} is in waves shorter than {} or with periods below {}: on this grid their speed differs by more than {:.0} % from {}",
        100.0 * share, prefixed(*length, "m"), prefixed(*period, "s"), 100.0 * tolerance,
        if *nonlocal { "that in the nonlocal continuum" } else { "that of long waves" }
    )]
    ShortWaves {
        /// What sends them out.
        what: &'static str,
        /// Their share of the energy.
        share: f64,
        /// The deviation of their speed, relative.
        tolerance: f64,
        /// Whether the speed in the nonlocal continuum is the reference; that of long waves otherwise.
        nonlocal: bool,
        /// The shortest period that the grid carries, s.
        period: f64,
        /// The shortest wave that it carries, m.
        length: f64,
    },
    /// Coefficients of both signs with which some waves grow.
    #[error(
        "the coefficients of this influence function make the lattice unstable: some waves grow (smallest ω²/k² = {smallest:.3e} m²/s²)"
    )]
    GrowingWaves {
        /// The smallest ω²/k², m²/s².
        smallest: f64,
    },
    /// Tuned coefficients that disperse more than a constant influence function.
    #[error(
        "the tuned influence function carries waves worse than a constant one: within 1 % of the speed of long waves from {} spacings per wavelength (constant: {}), at most {:.1} % off from {shortest} spacings on (constant: {:.1} %)",
        short(spacings[0]), short(spacings[1]), 100.0 * worst[0], 100.0 * worst[1]
    )]
    PoorTuning {
        /// Spacings per wavelength from which on the phase speed is within 1 %: tuned, constant.
        spacings: [f64; 2],
        /// The largest relative error down to `shortest`: tuned, constant.
        worst: [f64; 2],
        /// Spacings per wavelength.
        shortest: f64,
    },
    /// A speed at which bodies break in masses.
    #[error(

        "this {what} reaches {} m/s, above the {wave} of {} m/s: bonds break in masses, not along cracks",
        short(*speed), short(*limit)

    )]
    FastMotion {
        /// What moves.
        what: &'static str,
        /// Its largest speed, m/s.
        speed: f64,
        /// The speed that cracks do not exceed, m/s.
        limit: f64,
        /// What that speed is.
        wave: &'static str,
    },
    /// Bonds that break before any wave has run.
    #[error(
        "the first time step ({}) stretches bonds of {points} of {of} points beyond the critical stretch",
        prefixed(*dt, "s")
    )]
    TornAtOnce {
        /// Points with such bonds.
        points: usize,
        /// All points.
        of: usize,
        /// The step, s.
        dt: f64,
    },
    /// Bonds that break but carry nothing.
    #[error(
        "{empty} of {of} classes of bonds have the coefficient 0: these bonds carry no force, but they break and count as damage"
    )]
    EmptyClasses {
        /// Classes without stiffness.
        empty: usize,
        /// All classes.
        of: usize,
    },
    /// Kernels whose errors grow.
    #[error(
        "the historical kernels are off by {growth:.1e} of the largest at the end of the run: their errors grow with time"
    )]
    HistoricalKernels {
        /// The error of the Green functions.
        growth: f64,
    },
    /// Exponentials that miss their tolerance.
    #[error(
        "no sum of exponentials meets the tolerance {tolerance:.0e} (the best has the error {residual:.1e}): the exact blocked history is used"
    )]
    ExactHistory {
        /// What was asked for.
        tolerance: f64,
        /// What the best fit has.
        residual: f64,
    },
    /// An initial field that is not zero at an absorbing end.
    #[error(
        "the initial field at the absorbing end {side} is {share:.1e} of its largest value; it counts as zero beyond, which is an error of that size"
    )]
    FieldAtEnd {
        /// The side.
        side: &'static str,
        /// The largest value in the outer layer over that of the body.
        share: f64,
    },
    /// Two time steps that are one.
    #[error("with ratio = 1 both time steps are the same")]
    EqualSteps,
    /// A predictor with which short waves grow.
    #[error(
        "the backward-difference predictor is weakly unstable: ω dt is {omega_dt:.2}, above {quiet}"
    )]
    GrowingPredictor {
        /// The highest frequency times the step.
        omega_dt: f64,
        /// Below this the growth does not show.
        quiet: f64,
    },
}

/// all 40 points of this load are, 3 of the 40 points of this load are
fn share(part: usize, whole: usize) -> String {
    if part == whole {
        format!("all {whole} points of this load are")
    } else {
        format!("{part} of the {whole} points of this load are")
    }
}

/// A net force (N) and moment (N m).
fn net(force: Option<f64>, moment: Option<f64>) -> String {
    let force = force.map(|force| format!("a net force of {}", quantity(force, "N")));
    let moment = moment.map(|moment| format!("a net moment of {}", quantity(moment, "N m")));
    let both: Vec<String> = force.into_iter().chain(moment).collect();
    both.join(" and ")
}
