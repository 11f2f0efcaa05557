//! Choices: method, combination of branches, weights, bound.

/// Which functionals F_m of the residuals R = ω² − V²|k|² are formed (Alebrahim et al. 2022, section 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// ∮ R² is minimised.
    #[default]
    LeastSquares,
    /// R at equally spaced points (point collocation).
    PointCollocation,
    /// ∫R over equal parts of the contour (sub-domain collocation).
    Subdomain,
    /// ∮ w_m R. In 1D with w = 1, b₁ … b_{N−2}, which reproduces the paper's printed numbers; else the shares of the first classes in the trace of M.
    Galerkin,
    /// 1D only: ∫ b_m R with m = 1 … N−1, as the paper's equation 46 reads.
    LiteralGalerkin,
    /// ∮ |R| is minimised: the error by which tables are compared.
    Absolute,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 6] = [
        Self::LeastSquares,
        Self::PointCollocation,
        Self::Subdomain,
        Self::Galerkin,
        Self::LiteralGalerkin,
        Self::Absolute,
    ];

    /// Name as in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::LeastSquares => "least-squares",
            Self::PointCollocation => "point-collocation",
            Self::Subdomain => "subdomain-collocation",
            Self::Galerkin => "galerkin",
            Self::LiteralGalerkin => "galerkin-literal",
            Self::Absolute => "absolute",
        }
    }
}

/// How the residuals of the branches enter the functionals. The least-squares method has the first only, the absolute method the second only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Combination {
    /// Σ_m F_m(e_p R_p)² + F_m(e_s R_s)² is minimised.
    #[default]
    Separated,
    /// Σ_m F_m(e_p |R_p| + e_s |R_s|)² is minimised: convex, but not smooth.
    Absolute,
    /// F_m(e_p R_p + e_s R_s) = 0. An experiment: the lattices it makes are mostly unstable.
    SignedSum,
}

impl Combination {
    /// All combinations.
    pub const ALL: [Self; 3] = [Self::Separated, Self::Absolute, Self::SignedSum];

    /// Name as in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Separated => "separated",
            Self::Absolute => "absolute",
            Self::SignedSum => "signed-sum",
        }
    }
}

/// Weights of the residuals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// e_p.
    pub pressure: f64,
    /// e_s.
    pub shear: f64,
    /// A wavenumber κ (rad per spacing): residuals are also weighted with exp(−(|k|/κ)²), so that the corner of the zone, where no lattice can be
    /// exact, matters less. None for equal weights, as published: on plates these spend the freedom on that corner and leave waves of 10 to 50 spacings worse than α ≡ 1 does.
    pub decay: Option<f64>,
}

impl Weights {
    /// The decay κ (rad per spacing) that decks take by default. For a horizon of three spacings it keeps the phase speed within 1 % of that of long waves down to 3.0 spacings per
    /// wavelength in a bar and 5.6 in a plate; equal weights do so down to 23 and 27 only.
    pub const DECAY: f64 = 1.0;
}

impl Default for Weights {
    fn default() -> Self {
        Self {
            pressure: 1.0,
            shear: 1.0,
            decay: None,
        }
    }
}

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tuning {
    /// The functionals.
    pub method: Method,
    /// How branches are combined.
    pub combination: Combination,
    /// Weights.
    pub weights: Weights,
    /// No coefficient may be below it. The paper takes 0.5; with none, coefficients of both signs appear, with which bonds cannot break.
    pub lower_bound: Option<f64>,
}
