//! Errors of absorbing boundaries.

use pericles::units::{precise, quantity, significant};

impl From<AbsorbingError> for pericles::PericlesError {
    fn from(error: AbsorbingError) -> Self {
        Self::Extension(Box::new(NoEnd(error)))
    }
}

/// Wraps an absorbing-boundary error as an error of the engine.
#[derive(Debug, thiserror::Error)]
#[error("absorbing boundary: {0}")]
struct NoEnd(#[source] AbsorbingError);

/// Reason why an absorbing boundary is not possible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AbsorbingError {
    /// The stencil has no weights.
    #[error("the stencil has no weights: at least the bond to the next neighbour is required")]
    EmptyStencil,
    /// A weight is NaN or infinite.
    #[error("weight a_{reach} of the stencil is {weight}: weights must be finite numbers")]
    WeightNotFinite {
        /// Distance of the bond in spacings.
        reach: usize,
        /// Weight, 1/s².
        weight: f64,
    },
    /// The outermost weight of the stencil is zero.
    #[error(
        "the outermost weight a_{reach} of the stencil is zero: the last bonds of the lattice have no stiffness; \
        omit the weight (for a conical influence function with an integer horizon ratio use a slightly smaller \
        ratio)"
    )]
    OutermostWeightZero {
        /// Distance of the bond in spacings.
        reach: usize,
    },
    /// The stencil has unstable waves.
    #[error(
        "the exterior is unstable: waves with wavenumber {theta:.4} per spacing have ω² = {} 1/s², which must be \
        positive; signed (tuned) tables need ω² > 0 for every wave",
        significant(*square, 4)
    )]
    UnstableStencil {
        /// Wavenumber θ per spacing.
        theta: f64,
        /// Square frequency ω², 1/s².
        square: f64,
    },
    /// The time step is unstable for the exterior.
    #[error(
        "the time step {} is unstable for the exterior, whose highest frequency is {} 1/s; dt must be below {}",
        quantity(*dt, "s"), significant(*omega, 4), precise(*limit, "s")
    )]
    UnstableStep {
        /// Time step, s.
        dt: f64,
        /// Highest angular frequency, 1/s.
        omega: f64,
        /// 2/ω, s.
        limit: f64,
    },
    /// The body is not a bar.
    #[error(
        "an exact absorbing boundary needs a bar (1D), but this body has dimension {dimension}; kind = \
        \"damping-layer\" absorbs waves approximately in any dimension"
    )]
    NotABar {
        /// Dimension of the body.
        dimension: usize,
    },
    /// The body is not a strip whose exterior can be represented by Fourier modes.
    #[error(
        "an absorbing boundary of a strip needs a homogeneous plate that is periodic along y: {reason}"
    )]
    NotAStrip {
        /// The violated condition.
        reason: &'static str,
    },
    /// The bar is periodic.
    #[error("a periodic bar has no ends; remove `periodic` or the absorbing boundary")]
    Periodic,
    /// The points are not equally spaced.
    #[error(
        "an exact absorbing boundary needs a regular grid without holes: point {point} is not one spacing from the next"
    )]
    NotRegular {
        /// The first point followed by a gap, in the user's numbering.
        point: usize,
    },
    /// The body is shorter than two horizons at the boundary.
    #[error(
        "the outer layer at {side} is one horizon deep ({needed} points) and must be followed by as many points: the body \
        has {points} points, but needs at least {}",
        2 * needed
    )]
    LayerTooThin {
        /// Side of the bar.
        side: &'static str,
        /// Number of points of the body.
        points: usize,
        /// Number of points of the layer.
        needed: usize,
    },
    /// A bond of the outer layer differs from those of the exterior.
    #[error(
        "the outer layer at {side} is not homogeneous: the bond from point {from} to point {to} has the weight {} 1/s² \
        of the layer's other bonds of that length; move the end outwards, so that the {needed} outermost points are of \
        one linear, undamaged material",
        instead_of(*found, *expected)
    )]
    LayerBond {
        /// Side of the bar.
        side: &'static str,
        /// One end of the bond, in the user's numbering.
        from: usize,
        /// The other end.
        to: usize,
        /// Weight k/ρ of the bond, 1/s².
        found: f64,
        /// Weight of the other bonds of that length, 1/s².
        expected: f64,
        /// Number of points of the layer.
        needed: usize,
    },
    /// The density varies within the outer layer.
    #[error(
        "the outer layer at {side} is not homogeneous: point {point} has the mass {} kg of the \
        outermost point; use one density in the outer layer",
        instead_of(*found, *expected)
    )]
    LayerMass {
        /// Side of the bar.
        side: &'static str,
        /// The point, in the user's numbering.
        point: usize,
        /// Its mass, kg.
        found: f64,
        /// Mass of the outermost point, kg.
        expected: f64,
    },
    /// The pair law is not linear.
    #[error(
        "the forces in the outer layer at {side} are not linear in the displacement, at point {point}: an exact \
        absorbing boundary needs a linear exterior; use model = \"linear\" there"
    )]
    NotLinear {
        /// Side of the bar.
        side: &'static str,
        /// The point, in the user's numbering.
        point: usize,
    },
    /// Two absorbing boundaries on one side.
    #[error("there are two absorbing boundaries at {side}; remove one of them")]
    Twice {
        /// Side of the bar.
        side: &'static str,
    },
    /// Bonds of the outer layer can break.
    #[error(
        "bonds in the outer layer at {side} can break: its {needed} outermost points must be in `no_fail`, or the \
        material must be unbreakable"
    )]
    LayerBreakable {
        /// Side of the bar.
        side: &'static str,
        /// Number of points of the layer.
        needed: usize,
    },
    /// A load or prescribed motion acts on the outer layer.
    #[error(
        "{what} acts on point {point}, which is in the outer layer at {side}: the {needed} outermost points must be \
        free of loads and constraints"
    )]
    LayerActedOn {
        /// Side of the bar.
        side: &'static str,
        /// "a load" or "a prescribed motion".
        what: &'static str,
        /// The point, in the user's numbering.
        point: usize,
        /// Number of points of the layer.
        needed: usize,
    },
    /// The initial field is not zero at the boundary.
    #[error(
        "the initial field reaches the absorbing boundary at {side}: its value at point {point} is {} and its largest value \
        {}; allowed: 1e-6 of the largest value, because the exterior starts from rest. Give `exterior_extent`, the depth to \
        which the field continues beyond the boundary, or move the end outwards",
        significant(*found, 3), significant(*largest, 3)
    )]
    NotAtRest {
        /// Side of the bar.
        side: &'static str,
        /// The point, in the user's numbering.
        point: usize,
        /// |u| or |v| at the point.
        found: f64,
        /// Largest |u| or |v| in the body.
        largest: f64,
    },
    /// The initial field does not decay within the given exterior sites.
    #[error(
        "the initial field does not decay within the {sites} exterior points of `exterior_extent`: its value at the last ones \
        is {} and the largest value of body and exterior {}; allowed: 1e-6 of the largest value. Give a larger \
        `exterior_extent`, or move the end to where the field is zero",
        significant(*found, 3), significant(*largest, 3)
    )]
    ExteriorData {
        /// Number of exterior sites with data.
        sites: usize,
        /// Largest |u| or |v| on the outermost sites.
        found: f64,
        /// Largest |u| or |v| in body and exterior.
        largest: f64,
    },
    /// A feature that needs an explicit scheme.
    #[error("{what} needs scheme = \"velocity-verlet\": it uses kernels of an explicit scheme")]
    VerletOnly {
        /// The requested feature.
        what: &'static str,
    },
    /// The time step is not positive.
    #[error(
        "the time step is {}; it must be positive", quantity(*dt, "s")
    )]
    BadStep {
        /// Time step, s.
        dt: f64,
    },
    /// No fit of exponentials is within the tolerance.
    #[error(
        "no sum of exponentials meets the tolerance {tolerance:e}: the best of {fits} fits has the error {residual:.1e}; use a \
        larger tolerance, or history = \"blocked\", which is exact"
    )]
    Fit {
        /// Requested tolerance.
        tolerance: f64,
        /// Smallest residual of the fits.
        residual: f64,
        /// Number of fits.
        fits: usize,
    },
    /// The run has too many steps for a fit of exponentials.
    #[error(
        "a fit of exponentials supports at most {most:e} steps, but the run has {steps:e}: beyond that the terms cannot be \
        distinguished in double precision; use a larger time step or a shorter run"
    )]
    FitTooLong {
        /// Steps of the run.
        steps: f64,
        /// Largest allowed number of steps.
        most: f64,
    },
    /// The tolerance is out of range.
    #[error("the tolerance is {value}; allowed: above 1e-14 and below 1")]
    Tolerance {
        /// Tolerance given.
        value: f64,
    },
}

/// Formats two different numbers with as many digits as distinguish them, but at least four.
fn instead_of(found: f64, expected: f64) -> String {
    let differ = |digits: &usize| significant(found, *digits) != significant(expected, *digits);
    let digits = (4..17).find(differ).unwrap_or(17);
    let [found, expected] = [found, expected].map(|value| significant(value, digits));
    format!("{found} instead of {expected}")
}
