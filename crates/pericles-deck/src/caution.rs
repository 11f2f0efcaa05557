//! What is odd about a deck though a run may be meant.

use miette::Severity;
use pericles::units::{quantity, significant};
use pericles_manifold::surface::SurfaceCaution;

use crate::build::AreaDoubt;
use crate::finding::Subject;

/// Kinds of odd.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Caution {
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

impl Subject for Caution {
    const SEVERITY: Severity = Severity::Warning;

    fn advice(&self) -> Option<String> {
        let advice = match self {
            Self::CrackCutsNothing => {
                "it must pass between points of the body that lie within a horizon of each other"
            }
            Self::LargeStretch { .. } => {
                "brittle materials break below 20 %; is the fracture energy in J/m², the modulus in Pa, the horizon in m?"
            }
            Self::CrackOutside { .. } => {
                "places are in m unless they carry a unit; `origin` moves a body"
            }
            Self::SoftSolid { .. } => "is the modulus in Pa? \"70 GPa\" carries its unit",
            Self::HeavySolid { .. } => "is it in kg/m³? \"7.85 g/cm3\" carries its unit",
            Self::TinySpacing { .. } => "is it in m? \"1 mm\" carries its unit",
            Self::ClosePoints { .. } => {
                "remove one of them if it is a duplicate: the bond between them limits the time step"
            }
            Self::UnusedCoordinate { .. } => {
                "set the coordinate to 0, or give `dimension` so that all coordinates are used"
            }
            Self::IdleHole => {
                "check its place and its size, which must exceed the spacing; lengths without a unit are in m"
            }
            Self::NothingBreaks { .. } => {
                "give `fracture_energy` or `critical_stretch`, or leave the key out"
            }
            Self::NothingActs => "add [[load]], [[prescribe]] or [[initial]]",
            Self::StiffnessError { .. } => {
                "modulus = \"lattice\" makes the bulk stiffness exact on a grid (\"continuum\" for spectral forces and Gauss nodes); a longer horizon brings it nearer"
            }
            Self::ShearStiffness { .. } => {
                "a horizon of one spacing joins a point to few neighbours off the axes; take three spacings"
            }
            Self::FastWaves { .. } => "is the density in kg/m³ and the modulus in Pa?",
            Self::IdleClasses { .. } => "if this is meant, a shorter horizon says the same",
            Self::LoadedArea(_) => {
                "give `area`, or use a layer of one face, such as layer = { side = \"+x\", cells = 3 }, and one [[load]] for each face"
            }
            Self::LoadOnHeld { .. } => "take other points, or leave the load out",
            Self::Pieces { points: 1, .. } => {
                "a crack that passes through points takes all their bonds: shift it by half a cell; else look at holes and the horizon, unless loose points are meant"
            }
            Self::Pieces { .. } => {
                "look at cracks, holes and the horizon, unless loose pieces are meant"
            }
            Self::NoSupport { .. } => {
                "they only come to rest if the loads on them are in balance; [[prescribe]] holds points"
            }
            Self::ProbeOutside { .. } => "the nearest point is read instead",
            Self::UnstableStep { .. } => "it is used because of allow_unstable = true",
            Self::UncertainStep { .. } => "dt = \"auto\" stays below it",
            Self::ShortenedStep { .. } => {
                "give a dt that divides end, or an end that is a multiple of dt, to choose both"
            }
            Self::Surface(_) => "usual: 3 to 6 median edges",
            Self::ShortPeriod { .. } => {
                "a longer body, a shorter run or a smaller exact.window brings it down"
            }
            Self::ShortWaves { .. } => {
                "use a finer grid, a smoother time function or field, or a tuned influence function; `pericles dispersion` shows the speeds of all waves"
            }
            Self::GrowingWaves { .. } => {
                "a run of such a body gains energy without limit; use positive coefficients"
            }
            Self::PoorTuning { .. } => {
                "decay = 1 (the default) and method = \"least-squares\" do best; lower_bound limits what tuning can do"
            }
            Self::FastMotion { .. } => "check the value and its unit (m/s); use a lower speed",
            Self::TornAtOnce { .. } => {
                "check speeds, displacements and the critical stretch; use a ramp or a lower speed, or no_fail for the points near supports"
            }
            Self::EmptyClasses { .. } => {
                "use a positive lower_bound such as 0.5, or a shorter horizon"
            }
            Self::HistoricalKernels { .. } => {
                "method = \"discrete\" is exact, \"semi-discrete\" the same boundary with exact Green functions"
            }
            Self::ExactHistory { .. } => {
                "it costs memory that grows with the number of steps; history = \"blocked\" avoids the attempt, a larger tolerance may be met"
            }
            Self::FieldAtEnd { .. } => {
                "`exterior_data` continues the field beyond the end; or move the end outwards"
            }
            Self::EqualSteps => "a plain scheme does the same with less",
            Self::GrowingPredictor { .. } => {
                "predictor = \"structured\" is stable; or make dt smaller, or the run short"
            }
        };
        Some(advice.into())
    }

    fn label(&self) -> &'static str {
        match self {
            Self::CrackCutsNothing => "no effect",
            Self::CrackOutside { .. } => "outside the body",
            Self::Pieces { .. } => "in pieces",
            Self::LargeStretch { .. } => "very strong",
            Self::SoftSolid { .. } => "very soft",
            Self::HeavySolid { .. } => "very heavy",
            Self::TinySpacing { .. } => "very small",
            Self::ClosePoints { .. } => "very close points",
            Self::UnusedCoordinate { .. } => "not used",
            Self::IdleHole | Self::NothingBreaks { .. } => "no effect",
            Self::NothingActs => "at rest",
            Self::StiffnessError { .. } => "another stiffness",
            Self::ShearStiffness { .. } => "little shear stiffness",
            Self::FastWaves { .. } => "very light",
            Self::IdleClasses { .. } => "no stiffness",
            Self::LoadedArea(_) => "which area?",
            Self::LoadOnHeld { .. } => "held",
            Self::NoSupport { .. } => "loose parts",
            Self::Surface(_) => "unusual horizon",
            Self::ProbeOutside { .. } => "outside the body",
            Self::UnstableStep { .. } | Self::UncertainStep { .. } => "large step",
            Self::ShortenedStep { .. } => "shortened",
            Self::ShortPeriod { .. } => "short period",
            Self::ShortWaves { .. } => "short waves",
            Self::GrowingWaves { .. } => "unstable",
            Self::PoorTuning { .. } => "poorly tuned",
            Self::EmptyClasses { .. } => "no stiffness",
            Self::FastMotion { .. } | Self::TornAtOnce { .. } => "breaks at once",
            Self::HistoricalKernels { .. } => "historical",
            Self::ExactHistory { .. } => "exact history",
            Self::FieldAtEnd { .. } => "field at the end",
            Self::EqualSteps => "no effect",
            Self::GrowingPredictor { .. } => "growing waves",
        }
    }
}

/// 12.3 %
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let rounded: f64 = format!("{percent:.2e}").parse().unwrap_or(percent);
    format!("{rounded} %")
}

/// An area with four digits.
fn square_millimetres(area: f64) -> String {
    format!("{} mm²", short(1e6 * area))
}

fn doubtful_area(doubt: &AreaDoubt) -> String {
    let name = |axis: &usize| ['x', 'y', 'z'][*axis];
    match doubt {
        AreaDoubt::Thinner {
            axis,
            area,
            other,
            face,
        } => format!(
            "this traction acts on {}, the set as seen along {}; the set is a layer normal to {}, whose face has {}",
            square_millimetres(*area),
            name(axis),
            name(other),
            square_millimetres(*face)
        ),
        AreaDoubt::Parts { axis, area } => format!(
            "the set of this traction is not one layer on one face: the force on {}, the set as seen along {}, is spread over all its points",
            square_millimetres(*area),
            name(axis)
        ),
    }
}

/// `4.21 mm`, `0.812 µs`: three digits with the prefix that keeps the number between 1 and 1000.
fn prefixed(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 7] = [
        (1.0, ""),
        (1e-3, "m"),
        (1e-6, "µ"),
        (1e-9, "n"),
        (1e-12, "p"),
        (1e3, "k"),
        (1e6, "M"),
    ];
    let fits = |(scale, _): &&(f64, &str)| (1.0..999.5).contains(&(value / scale));
    match PREFIXES.iter().find(fits) {
        Some((scale, prefix)) => {
            let number = value / scale;
            let decimals = 2 - number.log10().floor().clamp(0.0, 2.0) as usize;
            format!("{number:.decimals$} {prefix}{unit}")
        }
        None => format!("{value:.3e} {unit}"),
    }
}

/// (1e-3, 2e-3)
fn spot(place: &[f64]) -> String {
    let numbers: Vec<String> = place.iter().map(|x| short(*x)).collect();
    format!("({})", numbers.join(", "))
}

/// from (0, 0) to (0.1, 0.04) m
fn reach(low: &[f64], high: &[f64]) -> String {
    format!("from {} to {} m", spot(low), spot(high))
}

/// Four digits are enough to find a place.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    format!("{rounded}")
}

/// all 40 points of this load are, 3 of the 40 points of this load are
fn share(part: usize, whole: usize) -> String {
    if part == whole {
        format!("all {whole} points of this load are")
    } else {
        format!("{part} of the {whole} points of this load are")
    }
}
