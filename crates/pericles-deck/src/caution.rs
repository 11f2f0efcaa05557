//! What is odd about a deck though a run may be meant.

use miette::Severity;
use pericles::space::surface::SurfaceCaution;

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
    /// Waves that no solid carries.
    #[error("waves run at {speed:.3e} m/s, faster than in any solid")]
    FastWaves {
        /// Of the pressure wave, m/s.
        speed: f64,
    },
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
        "the period of {period:e} m is short for this run: at its end the waves of the next period are about {estimate:.1e} of the pulse within {window:e} m of its middle"
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
        "{:.0} % of the energy of this {what} is in waves shorter than {length:.3e} m or faster than a period of {period:.3e} s, which the grid delays by more than {:.0} %",
        100.0 * share, 100.0 * tolerance
    )]
    ShortWaves {
        /// What sends them out.
        what: &'static str,
        /// Their share of the energy.
        share: f64,
        /// The deviation of their speed, relative.
        tolerance: f64,
        /// The shortest period that the grid carries, s.
        period: f64,
        /// The shortest wave that it carries, m.
        length: f64,
    },
    /// Kernels whose errors grow.
    #[error(
        "the historical kernels are off by {growth:.1e} of the largest at the end of the run: their errors grow with time"
    )]
    HistoricalKernels {
        /// The error of the Green functions.
        growth: f64,
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
            Self::FastWaves { .. } => "is the density in kg/m³ and the modulus in Pa?",
            Self::IdleClasses { .. } => "if this is meant, a shorter horizon says the same",
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
            Self::Surface(_) => "usual: 3 to 6 median edges",
            Self::ShortPeriod { .. } => {
                "a longer body, a shorter run or a smaller exact.window brings it down"
            }
            Self::ShortWaves { .. } => {
                "a finer grid, a smoother course or a tuned influence function carries more; `pericles dispersion` shows what the grid does to waves"
            }
            Self::HistoricalKernels { .. } => {
                "method = \"discrete\" is exact, \"semi-discrete\" the same boundary with exact Green functions"
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
            Self::FastWaves { .. } => "very light",
            Self::IdleClasses { .. } => "no stiffness",
            Self::LoadOnHeld { .. } => "held",
            Self::NoSupport { .. } => "loose parts",
            Self::Surface(_) => "unusual horizon",
            Self::ProbeOutside { .. } => "outside the body",
            Self::UnstableStep { .. } | Self::UncertainStep { .. } => "large step",
            Self::ShortPeriod { .. } => "short period",
            Self::ShortWaves { .. } => "short waves",
            Self::HistoricalKernels { .. } => "historical",
            Self::EqualSteps => "no effect",
            Self::GrowingPredictor { .. } => "growing waves",
        }
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
