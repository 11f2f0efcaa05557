//! What an absorbing end refuses.

impl From<AbsorbingError> for pericles::PericlesError {
    fn from(error: AbsorbingError) -> Self {
        Self::Extension(Box::new(NoEnd(error)))
    }
}

/// The refusal of an end among those of the engine.
#[derive(Debug, thiserror::Error)]
#[error("absorbing end: {0}")]
struct NoEnd(#[source] AbsorbingError);

/// Why there can be no absorbing end.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AbsorbingError {
    /// A stencil without weights.
    #[error("the stencil has no weights: at least the bond to the next neighbour is needed")]
    EmptyStencil,
    /// A weight that is no number.
    #[error("weight a_{reach} of the stencil is {weight}: it must be finite")]
    WeightNotFinite {
        /// Which, in spacings.
        reach: usize,
        /// Its value, 1/s².
        weight: f64,
    },
    /// A stencil whose outermost weight vanishes.
    #[error(
        "the outermost weight a_{reach} of the stencil is zero: the lattice reaches less far than it says; leave the weight out (for a conical influence function \
         with a whole horizon ratio: a ratio a little smaller)"
    )]
    OutermostWeightZero {
        /// Which, in spacings.
        reach: usize,
    },
    /// A stencil with which some waves grow.
    #[error(
        "the exterior is not stable: waves of wave number {theta:.4} per spacing have ω² = {square:e} 1/s², it must be positive; signed (tuned) tables need \
         ω² > 0 for every wave"
    )]
    UnstableStencil {
        /// θ.
        theta: f64,
        /// ω².
        square: f64,
    },
    /// A step too large for the exterior.
    #[error(
        "the time step {dt:e} s is unstable for the exterior: its highest frequency is {omega:.6e} 1/s, so dt must be below {limit:.6e} s"
    )]
    UnstableStep {
        /// The step, s.
        dt: f64,
        /// Highest angular frequency, 1/s.
        omega: f64,
        /// 2/ω, s.
        limit: f64,
    },
    /// A body that is not a bar.
    #[error(
        "an exact absorbing end needs a bar (1D), this body has dimension {dimension}; kind = \"damping-layer\" absorbs in any dimension, though not exactly"
    )]
    NotABar {
        /// Its dimension.
        dimension: usize,
    },
    /// A body that is no strip whose exterior could be found by Fourier modes.
    #[error(
        "an absorbing end of a strip needs a homogeneous plate that is periodic along y: {reason}"
    )]
    NotAStrip {
        /// What it is or has.
        reason: &'static str,
    },
    /// A bar whose faces are joined.
    #[error(
        "a periodic bar has no end that could absorb waves; leave out `periodic` or the absorbing boundary"
    )]
    Periodic,
    /// Points that do not follow each other at equal distances.
    #[error(
        "an exact absorbing end needs a regular grid without holes: point {point} is not one spacing from the next"
    )]
    NotRegular {
        /// The first point with a gap behind it, in the user's numbering.
        point: usize,
    },
    /// A layer that the horizon reaches across.
    #[error(
        "the outer layer at {side} is one horizon deep ({needed} points) and must be followed by as many points: the body needs at least {} points and has {points}",
        2 * needed
    )]
    LayerTooThin {
        /// The side.
        side: &'static str,
        /// Points of the body.
        points: usize,
        /// Points of the layer.
        needed: usize,
    },
    /// A bond of the outer layer that the exterior does not continue.
    #[error(
        "the outer layer at {side} is not homogeneous: the bond from point {from} to point {to} has the weight {found:e} 1/s², the layer's bonds of that \
         length have {expected:e}; move the end outwards, so that the {needed} outermost points are of one linear, undamaged material"
    )]
    LayerBond {
        /// The side.
        side: &'static str,
        /// One end, in the user's numbering.
        from: usize,
        /// The other.
        to: usize,
        /// k/ρ of the bond, 1/s².
        found: f64,
        /// That of the others.
        expected: f64,
        /// Points of the layer.
        needed: usize,
    },
    /// A density that differs within the outer layer.
    #[error(
        "the outer layer at {side} is not homogeneous: point {point} has mass {found:e} kg, the outermost {expected:e} kg"
    )]
    LayerMass {
        /// The side.
        side: &'static str,
        /// The point, in the user's numbering.
        point: usize,
        /// Its mass, kg.
        found: f64,
        /// The outermost's.
        expected: f64,
    },
    /// A law that is not linear.
    #[error(
        "the forces in the outer layer at {side} are not linear in the displacement, at point {point}: an exact absorbing end needs a linear exterior"
    )]
    NotLinear {
        /// The side.
        side: &'static str,
        /// The point, in the user's numbering.
        point: usize,
    },
    /// Two ends at one side.
    #[error("there are two absorbing ends at {side}; one is enough")]
    Twice {
        /// The side.
        side: &'static str,
    },
    /// Bonds that may break in the outer layer.
    #[error(
        "the outer layer at {side} may break: its {needed} outermost points must be in `no_fail`, or the material unbreakable"
    )]
    LayerBreakable {
        /// The side.
        side: &'static str,
        /// Points of the layer.
        needed: usize,
    },
    /// A load or prescribed motion on the outer layer.
    #[error(
        "{what} acts on point {point}, which is in the outer layer at {side}: the {needed} outermost points must be free"
    )]
    LayerActedOn {
        /// The side.
        side: &'static str,
        /// A load, or a prescribed motion.
        what: &'static str,
        /// The point, in the user's numbering.
        point: usize,
        /// Points of the layer.
        needed: usize,
    },
    /// An initial field that reaches the end.
    #[error(
        "the initial field reaches the absorbing end {side}: point {point} has {found:.3e}, the largest value is {largest:.3e}; allowed: 1e-6 of it, because the exterior starts \
         from rest. Give `exterior_data`, the depth to which the field continues beyond the end, or move the end outwards"
    )]
    NotAtRest {
        /// The side.
        side: &'static str,
        /// The point, in the user's numbering.
        point: usize,
        /// |u| or |v| there.
        found: f64,
        /// Its largest in the body.
        largest: f64,
    },
    /// Initial data that do not decay within the exterior points given.
    #[error(
        "the initial field does not decay within the {sites} exterior points of `exterior_data`: the last ones have {found:.3e}, the largest value of body and exterior is \
         {largest:.3e}; allowed: 1e-6 of it. Give a larger `exterior_data`, or move the end to where the field is zero"
    )]
    ExteriorData {
        /// Sites with data.
        sites: usize,
        /// Largest |u| or |v| on the outermost sites.
        found: f64,
        /// Largest on all.
        largest: f64,
    },
    /// What needs an explicit scheme.
    #[error(
        "{what} needs scheme = \"velocity-verlet\": its kernels are those of an explicit scheme"
    )]
    VerletOnly {
        /// What was asked for.
        what: &'static str,
    },
    /// A step that is no step.
    #[error("the time step is {dt:e} s: it must be positive")]
    BadStep {
        /// The step, s.
        dt: f64,
    },
    /// Sums of exponentials that miss the tolerance.
    #[error(
        "no sum of exponentials meets the tolerance {tolerance:e}: the best of {fits} fits has the error {residual:.1e}; use a larger tolerance, or history = \"blocked\", \
         which is exact"
    )]
    Fit {
        /// The tolerance asked for.
        tolerance: f64,
        /// The smallest residual.
        residual: f64,
        /// Fits tried.
        fits: usize,
    },
    /// More steps than a fit can tell apart.
    #[error(
        "a fit of exponentials is good for at most {most:e} steps, not {steps:e}: what it would have to tell apart is below rounding; a larger step or a shorter run"
    )]
    FitTooLong {
        /// Steps of the run.
        steps: f64,
        /// Steps that are allowed.
        most: f64,
    },
    /// A tolerance out of range.
    #[error("the tolerance is {value}; allowed: above 1e-14 and below 1")]
    Tolerance {
        /// The value.
        value: f64,
    },
}
