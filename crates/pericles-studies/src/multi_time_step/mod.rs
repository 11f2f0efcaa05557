//! Two time steps in one body: orders, stability, failure, conservation and cost.
//!
//! Liu, Sun, Tian, Don, Ju, A high-order multi-time-step scheme for bond-based peridynamics, arXiv 2401.04966 (2024). The paper's formulas of the interface and most of its
//! parameters are not in print; the bodies are as the text describes them, and the expected numbers were computed by an independent code
//! (`validation/multi-time-step/`). `structured` and `hermite` are the predictor and the interpolant of [`pericles::time`] unless a row says otherwise.

mod convergence;
mod cost;
mod crack;
mod energy;
mod inclusion;
mod problem;
mod stability;
mod turns;
mod two_grid;

use crate::study::Study;

/// The studies of this topic.
pub(super) const STUDIES: [Study; 9] = [
    convergence::PLATE,
    convergence::PLATE_NONLINEAR,
    convergence::BLOCK,
    crack::STUDY,
    stability::STUDY,
    energy::STUDY,
    cost::STUDY,
    inclusion::STUDY,
    two_grid::STUDY,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Row;
    use crate::study::Context;

    /// Every study whose rows do not depend on the clock: all judged rows hold, and there are some.
    #[test]
    fn studies_hold() {
        let context = Context::without_figures();
        let studies: [&Study; 7] = [
            &convergence::PLATE,
            &convergence::PLATE_NONLINEAR,
            &convergence::BLOCK,
            &crack::STUDY,
            &stability::STUDY,
            &energy::STUDY,
            &two_grid::STUDY,
        ];
        for study in studies {
            let rows = (study.run)(&context).unwrap();
            let wrong: Vec<&Row> = rows.iter().filter(|r| r.pass() == Some(false)).collect();
            assert!(wrong.is_empty(), "{}: {wrong:#?}", study.id);
            assert!(
                rows.iter().any(|row| row.pass() == Some(true)),
                "{}",
                study.id
            );
        }
    }
}
