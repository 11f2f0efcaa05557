//! Assignment of kernels to the histories of sites.

/// Kernels of one absorbing boundary: ghost −n, n = 0 … K − 1, is u_{−n} = Σ (kernel * site).
#[derive(Debug, Clone, PartialEq)]
pub struct GhostKernels {
    form: KernelForm,
    reach: usize,
    series: Vec<Vec<f64>>,
}

/// Relation between ghosts and histories.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum KernelForm {
    /// u_{−n} = Σ_m h_m * u_{m−n}: K kernels, applied to ghosts as well.
    Shift,
    /// u_{−n} = Σ_m F_n^m * u_m: K² kernels.
    Full,
}

impl GhostKernels {
    /// Creates kernels from h_1 … h_K; entry j is the coefficient of w^j.
    pub fn shift(series: Vec<Vec<f64>>) -> Self {
        Self {
            form: KernelForm::Shift,
            reach: series.len(),
            series,
        }
    }

    /// Creates kernels from F_n^m, n = 0 … K − 1, m = 1 … K, m running faster.
    pub fn full(reach: usize, series: Vec<Vec<f64>>) -> Self {
        debug_assert_eq!(series.len(), reach * reach);
        Self {
            form: KernelForm::Full,
            reach,
            series,
        }
    }

    /// Reach K of the lattice.
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// The kernels.
    pub fn series(&self) -> &[Vec<f64>] {
        &self.series
    }

    /// Number of steps (lags) of the kernels.
    pub fn steps(&self) -> usize {
        self.series.first().map_or(0, |series| series.len() - 1)
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        self.series
            .iter()
            .map(|series| size_of_val(&series[..]))
            .sum()
    }

    /// Number of sites whose history is recorded.
    pub fn inputs(&self) -> usize {
        match self.form {
            KernelForm::Shift => 2 * self.reach - 1,
            KernelForm::Full => self.reach,
        }
    }

    /// Pairs (index of the site among the inputs, kernel) that contribute to ghost −n.
    pub fn terms(&self, n: usize) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (form, reach) = (self.form, self.reach);
        (0..reach).map(move |m| match form {
            // Site m + 1 − n; the first recorded one is 2 − K.
            KernelForm::Shift => (m + reach - 1 - n, m),
            KernelForm::Full => (m, n * reach + m),
        })
    }

    /// Displacements of the recorded sites at one time from the displacements of the body's outer points 1 … K and of the
    /// ghosts 0 … −(K − 1).
    pub fn gather(&self, own: &[f64], ghosts: &[f64], inputs: &mut [f64]) {
        match self.form {
            KernelForm::Full => inputs.copy_from_slice(own),
            KernelForm::Shift => {
                let (beyond, body) = inputs.split_at_mut(self.reach - 1);
                body.copy_from_slice(own);
                for (n, input) in beyond.iter_mut().rev().enumerate() {
                    *input = ghosts[n];
                }
            }
        }
    }

    /// Adds to the ghosts their dependence on displacements of the same step, at the body's outer points and
    /// of previous ghosts.
    pub fn settle(&self, own: &[f64], ghosts: &mut [f64]) {
        let site = |place: usize, ghosts: &[f64]| match self.form {
            KernelForm::Full => own[place],
            // Site with index place + 2 − K.
            KernelForm::Shift if place + 1 >= self.reach => own[place + 1 - self.reach],
            KernelForm::Shift => ghosts[self.reach - 2 - place],
        };
        for n in 0..self.reach {
            let terms = self.terms(n);
            let share: f64 = terms
                .map(|(place, kernel)| self.series[kernel][0] * site(place, ghosts))
                .sum();
            ghosts[n] += share;
        }
    }

    /// Returns the K² kernels F_n^m by F_{n+1}^m = F_n^1 * h_m + F_n^{m+1} (n counted away from the body), with
    /// products of `steps` coefficients. Slow; for tests and reports.
    pub fn expanded(&self) -> Self {
        if self.form == KernelForm::Full {
            return self.clone();
        }
        let (reach, h) = (self.reach, &self.series);
        let mut full: Vec<Vec<f64>> = h.clone();
        for n in 1..reach {
            for m in 0..reach {
                let last = (n - 1) * reach;
                let mut series = match m + 1 < reach {
                    true => full[last + m + 1].clone(),
                    false => vec![0.0; h[0].len()],
                };
                let first = full[last].clone();
                for (j, x) in first.iter().enumerate() {
                    for (sum, y) in series[j..].iter_mut().zip(&h[m]) {
                        *sum += x * y;
                    }
                }
                full.push(series);
            }
        }
        Self::full(reach, full)
    }
}
