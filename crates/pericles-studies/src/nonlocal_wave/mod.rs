//! The nonlocal wave equation on the line: quadrature in space, trigonometric, Störmer–Verlet and implicit schemes in time, and the spectral method.
//!
//! Coclite, Fanizzi, Lopez, Maddalena, Pellegrino, Numerical methods for the nonlocal wave equation of the peridynamics, Applied Numerical Mathematics 155
//! (2020) 119–139. Where the paper's numbers are misprinted, depend on its regularisation or cannot be identified, the numbers that are judged were
//! recomputed by an independent dense code; rows say so.
//!
//! Units: E = ρ = 1 and lengths in those of the start unless a row says otherwise. Errors are the largest over all nodes and steps.

mod bar;
mod convergence;
mod cost;
mod energy;
mod figures;
mod limit;
mod line;
mod long_waves;
mod nonlinear;
mod paper;
mod spectral;

use crate::study::Study;

/// The studies of this topic.
pub(super) const STUDIES: [Study; 9] = [
    convergence::STUDY,
    long_waves::STUDY,
    limit::STUDY,
    spectral::STUDY,
    bar::STUDY,
    energy::STUDY,
    figures::STUDY,
    nonlinear::STUDY,
    cost::STUDY,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Row;
    use crate::study::Context;

    /// All judged rows hold, and there are some.
    #[test]
    fn studies_hold() {
        let context = Context::without_figures();
        let mut wrong: Vec<(&str, Row)> = Vec::new();
        for study in &STUDIES {
            let rows = (study.run)(&context).unwrap();
            assert!(
                rows.iter().any(|row| row.pass() == Some(true)),
                "{}",
                study.id
            );
            let failed = rows.into_iter().filter(|row| row.pass() == Some(false));
            wrong.extend(failed.map(|row| (study.id, row)));
        }
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}
