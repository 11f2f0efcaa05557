//! What two time steps cost and save.

/// What a scheme with two time steps did so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefinementReport {
    /// Fine steps in a coarse one, M.
    pub ratio: u32,
    /// Evaluations of a point in each of its steps: the stages of a Runge–Kutta method, one for r-RESPA.
    pub stages: u32,
    /// Points of the body.
    pub points: u64,
    /// Fine points now.
    pub fine_points: u64,
    /// Coarse points next to them now.
    pub border_points: u64,
    /// Coarse steps taken, without those at the start that are fine everywhere.
    pub steps: u64,
    /// Steps at the start that were fine everywhere, because the predictor needs earlier levels.
    pub starting_steps: u64,
    /// Mean over the steps of the fraction φ of fine points; the present fraction before the first step.
    pub mean_fraction: f64,
    /// The largest fraction of a step.
    pub largest_fraction: f64,
    /// Mean over the steps of the fraction of coarse points that are evaluated in every fine step, too: those next to fine ones for r-RESPA, none for
    /// Runge–Kutta.
    pub mean_shared: f64,
}

impl RefinementReport {
    /// Evaluations per point in a coarse step: s (1 + (M − 1) φ), and M for every point that both sides evaluate.
    pub fn evaluations(&self) -> f64 {
        let (m, s) = (f64::from(self.ratio), f64::from(self.stages));
        s * (1.0 + (m - 1.0) * self.mean_fraction + m * self.mean_shared)
    }

    /// Evaluations of the same scheme with the fine step everywhere over those of this one: M/(1 + (M − 1) φ) for Runge–Kutta.
    pub fn speed_up(&self) -> f64 {
        f64::from(self.stages * self.ratio) / self.evaluations()
    }

    /// Evaluations of velocity Verlet with the fine step everywhere over those of this scheme.
    pub fn speed_up_over_verlet(&self) -> f64 {
        f64::from(self.ratio) / self.evaluations()
    }
}
