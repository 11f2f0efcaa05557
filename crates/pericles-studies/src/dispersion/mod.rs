//! Dispersion: tuned coefficients, spectra measured in the time domain, and the corresponding influence functions
//! and critical stretches.
//!
//! Alebrahim, Packo, Zaccariotto, Galvanetto, Improved wave dispersion properties in 1D and 2D bond-based
//! peridynamic media, Computational Particle Mechanics (2022). The paper's tables of coefficients are not
//! published; the expected values were computed by separate codes and are in `validation/dispersion-and-fracture/`.
//! Units of the spacing and of √(E/ρ) unless a row says otherwise; full node volumes.

mod critical_stretch;
mod figures;
mod influence;
mod lattices;
mod models;
mod one_dimensional;
mod published;
mod pulse;
mod spectrum;
mod two_dimensional;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("dispersion/one-dimensional"),
        data!("dispersion/two-dimensional"),
        data!("dispersion/three-dimensional"),
        data!("dispersion/spectrum-1d"),
        data!("dispersion/spectrum-2d"),
        data!("dispersion/influence"),
        data!("dispersion/critical-stretch"),
        data!("dispersion/pulse"),
    ],
    measures: &[
        ("original", lattices::original),
        ("tuned", lattices::of_choice),
        ("write-coefficients", lattices::write_coefficients),
        ("published-bars", one_dimensional::published_bars),
        ("published-plates", two_dimensional::published_plates),
        ("plane-states", two_dimensional::plane_states),
        ("polar", two_dimensional::polar),
        ("other-ratio", two_dimensional::other_ratio),
        ("spectrum", spectrum::spectrum),
        ("printed-function", influence::printed_function),
        ("printed-function-at", influence::at_class),
        ("fitted-cosines", influence::fitted_cosines),
        ("critical-stretch", critical_stretch::critical_stretch),
        ("crack-energy", critical_stretch::crack_energy),
        ("pulse", pulse::pulse),
    ],
};
