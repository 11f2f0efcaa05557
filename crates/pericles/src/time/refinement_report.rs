//! Cost and speed-up of multirate schemes.

/// Statistics of a multirate scheme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefinementReport {
    /// Number M of fine steps per coarse step.
    pub ratio: u32,
    /// Evaluations per point and step: the stages of a Runge–Kutta method, one for r-RESPA.
    pub stages: u32,
    /// Points of the body.
    pub points: u64,
    /// Present number of fine points.
    pub fine_points: u64,
    /// Present number of coarse points next to fine ones.
    pub border_points: u64,
    /// Number of coarse steps, without initial steps that are fine everywhere.
    pub steps: u64,
    /// Number of initial steps that are fine everywhere, because the predictor needs earlier levels.
    pub starting_steps: u64,
    /// Mean fraction φ of fine points over the steps; the present fraction before the first step.
    pub mean_fraction: f64,
    /// Largest fraction of fine points in a step.
    pub largest_fraction: f64,
    /// Mean fraction of coarse points that are also evaluated in every fine step: those next to fine ones for
    /// r-RESPA, zero for Runge–Kutta.
    pub mean_shared: f64,
}

impl RefinementReport {
    /// Evaluations per point in a coarse step: s (1 + (M − 1) φ), and M for points that both sides evaluate.
    pub fn evaluations(&self) -> f64 {
        let (m, s) = (f64::from(self.ratio), f64::from(self.stages));
        s * (1.0 + (m - 1.0) * self.mean_fraction + m * self.mean_shared)
    }

    /// Speed-up in evaluations over the same scheme with the fine step everywhere: M/(1 + (M − 1) φ) for
    /// Runge–Kutta.
    pub fn speed_up(&self) -> f64 {
        f64::from(self.stages * self.ratio) / self.evaluations()
    }

    /// Speed-up in evaluations over velocity Verlet with the fine step everywhere.
    pub fn speed_up_over_verlet(&self) -> f64 {
        f64::from(self.ratio) / self.evaluations()
    }
}
