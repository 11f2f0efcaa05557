//! Dispersion: coefficients tuned against it, spectra measured in the time domain, influence functions and critical stretches that go with them.
//!
//! Alebrahim, Packo, Zaccariotto, Galvanetto, Improved wave dispersion properties in 1D and 2D bond-based peridynamic media, Computational Particle
//! Mechanics (2022). The paper's tables of coefficients are not in print; the expected numbers were computed by separate codes and are kept in
//! `validation/dispersion-and-fracture/`. Units of the spacing and of √(E/ρ) unless a row says otherwise; full node volumes.

mod critical_stretch;
mod figures;
mod influence;
mod models;
mod one_dimensional;
mod published;
mod pulse;
mod spectrum;
mod three_dimensional;
mod two_dimensional;

use crate::study::Study;

/// The studies of this topic.
pub(super) const STUDIES: [Study; 8] = [
    one_dimensional::STUDY,
    two_dimensional::STUDY,
    three_dimensional::STUDY,
    spectrum::BARS,
    spectrum::PLATES,
    influence::STUDY,
    critical_stretch::STUDY,
    pulse::STUDY,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Row;
    use crate::study::Context;

    /// Every study but the slow ones: all judged rows hold, and there are some.
    #[test]
    fn studies_hold() {
        let context = Context::without_figures();
        let studies: [&Study; 5] = [
            &one_dimensional::STUDY,
            &two_dimensional::STUDY,
            &three_dimensional::STUDY,
            &influence::STUDY,
            &critical_stretch::STUDY,
        ];
        for study in studies {
            let rows = (study.run)(&context).unwrap();
            let wrong: Vec<&Row> = rows.iter().filter(|r| r.pass() == Some(false)).collect();
            assert!(wrong.is_empty(), "{}: {wrong:?}", study.id);
            assert!(
                rows.iter().any(|row| row.pass() == Some(true)),
                "{}",
                study.id
            );
        }
    }
}
