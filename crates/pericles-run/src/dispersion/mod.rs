//! Files of the dispersion analysis: curves, polar plots, bond classes, measured spectra.

mod curves;
mod spectrum;

pub use curves::{Curves, STEPS, write_bonds, write_classes, write_polar};
pub use spectrum::write_spectrum;
