//! Options of tuning: method, combination of branches, weights, bound.

/// Functionals F_m of the residuals R = ω² − V²|k|² (Alebrahim et al. 2022, section 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// Minimises ∮ R².
    #[default]
    LeastSquares,
    /// R at equally spaced points (point collocation).
    PointCollocation,
    /// ∫R over equal parts of the contour (sub-domain collocation).
    Subdomain,
    /// ∮ w_m R (Galerkin). In 1D with w = 1, b₁ … b_{N−2}, which reproduces the paper's printed values; otherwise
    /// with the contributions of the first classes to the trace of M.
    Galerkin,
    /// 1D only: ∫ b_m R with m = 1 … N−1, the paper's equation 46 taken literally.
    LiteralGalerkin,
    /// Minimises ∮ |R|, the error by which tables are compared.
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

    /// Name in decks.
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

/// Combination of the branch residuals in the functionals. The least-squares method supports the first only, the
/// absolute method the second only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Combination {
    /// Minimises Σ_m F_m(e_p R_p)² + F_m(e_s R_s)².
    #[default]
    Separated,
    /// Minimises Σ_m F_m(e_p |R_p| + e_s |R_s|)²: convex, but not smooth.
    Absolute,
    /// Solves F_m(e_p R_p + e_s R_s) = 0. Experimental: most of the resulting lattices are unstable.
    SignedSum,
}

impl Combination {
    /// All combinations.
    pub const ALL: [Self; 3] = [Self::Separated, Self::Absolute, Self::SignedSum];

    /// Name in decks.
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
    /// Weight e_p of pressure waves.
    pub pressure: f64,
    /// Weight e_s of shear waves.
    pub shear: f64,
    /// Wavenumber κ (rad per spacing) of an additional weight exp(−(|k|/κ)²), which reduces the influence of the
    /// zone corner, where no lattice can be exact. `None` gives equal weights, as published: on plates these fit
    /// mainly that corner and make waves of 10 to 50 spacings less accurate than α ≡ 1.
    pub decay: Option<f64>,
}

impl Weights {
    /// Default decay κ (rad per spacing) in decks. For a horizon of three spacings it keeps the phase speed within
    /// 1 % of that of long waves down to 3.0 spacings per wavelength in a bar and 5.6 in a plate; equal weights do
    /// so only down to 23 and 27.
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

/// Options of a tuning problem.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tuning {
    /// Functionals.
    pub method: Method,
    /// Combination of the branches.
    pub combination: Combination,
    /// Weights.
    pub weights: Weights,
    /// Lower bound of the coefficients. The paper uses 0.5. `None` allows coefficients of both signs, for which
    /// bonds cannot break.
    pub lower_bound: Option<f64>,
}
