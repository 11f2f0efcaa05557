//! Dispersion: coefficients tuned against it, spectra measured in the time domain, influence functions and critical stretches that go with them.
//!
//! Alebrahim, Packo, Zaccariotto, Galvanetto, Improved wave dispersion properties in 1D and 2D bond-based peridynamic media, Computational Particle
//! Mechanics (2022). The paper's tables of coefficients are not in print; the expected numbers were computed by separate codes and are kept in
//! `validation/dispersion-and-fracture/`. Units of the spacing and of √(E/ρ) unless a row says otherwise; full node volumes.

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

/// The studies of this topic.
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
