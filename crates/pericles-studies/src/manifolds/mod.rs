//! Nonlinear peridynamics on closed surfaces.
//!
//! Coclite, Coclite, Maddalena, Politi, A numerical framework for nonlinear peridynamics on two-dimensional manifolds based on implicit P-(EC)^k schemes (2022).
//! Unit sphere of 642 vertices, ρ = κ = 1, u₀ = 0 and random velocities unless a row says otherwise.
//!
//! Two presets. **Standard**: the model as it is written (horizon 0.5, areas of the vertices, distances along edges); the expected numbers were recomputed by
//! an independent code. **Calibrated**: area 3 for every vertex and horizon 0.4, two choices fitted to the three printed periods of figure 2. No consistent reading
//! gives the printed times: the paper's operator is 80 to 130 times stiffer than the standard one.

mod convergence;
mod course;
mod figure_2;
mod figure_3;
mod figure_4;
mod figure_5;
mod figure_6;
mod geodesics;
mod modes;
mod presets;

use crate::study::Study;

/// The studies of this topic.
pub(super) const STUDIES: [Study; 7] = [
    geodesics::STUDY,
    figure_2::STUDY,
    figure_3::STUDY,
    figure_4::STUDY,
    figure_5::STUDY,
    figure_6::STUDY,
    convergence::STUDY,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Row;
    use crate::study::Context;

    /// The cheap studies: all judged rows hold, and there are some.
    #[test]
    fn studies_hold() {
        let context = Context::without_figures();
        for study in [&figure_2::STUDY, &convergence::STUDY] {
            let rows = (study.run)(&context).unwrap();
            let wrong: Vec<&Row> = rows.iter().filter(|r| r.pass() == Some(false)).collect();
            assert!(wrong.is_empty(), "{}: {wrong:?}", study.id);
            assert!(rows.iter().any(|row| row.pass() == Some(true)));
        }
    }
}
