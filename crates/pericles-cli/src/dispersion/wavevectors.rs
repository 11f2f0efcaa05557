//! Frequencies at given wave vectors.

use std::path::Path;

use pericles_dispersion::{BondLattice, Mode, Vector, verlet_frequency};
use pericles_io::{Cell, Column, CsvTable, IoError};
use pericles_run::units::significant;
use serde_json::{Value as Json, json};

use crate::console;

/// The modes at one wave vector, fastest first.
pub(crate) struct AtWaveVector {
    /// Wave vector, rad/m.
    k: Vector,
    modes: Vec<Mode>,
    /// Time step for the time-discrete frequency, s.
    dt: f64,
}

impl AtWaveVector {
    /// Computes the modes of a lattice at a wave vector (rad/m).
    pub(crate) fn of(lattice: &BondLattice, k: Vector, dt: f64) -> Self {
        let mut modes = lattice.modes(k);
        modes.reverse();
        Self { k, modes, dt }
    }

    fn size(&self) -> f64 {
        self.k.iter().map(|k| k * k).sum::<f64>().sqrt()
    }

    /// Returns ω of a mode, ω with velocity Verlet, and the phase velocity; `None` for growing waves.
    fn numbers(&self, mode: &Mode) -> [Option<f64>; 3] {
        let omega = Some(mode.omega()).filter(|omega| omega.is_finite());
        [
            omega,
            omega.and_then(|omega| verlet_frequency(omega, self.dt)),
            omega.map(|omega| omega / self.size()),
        ]
    }

    fn json(&self) -> Json {
        let modes = self.modes.iter().map(|mode| {
            let [omega, verlet, speed] = self.numbers(mode);
            json!({
                "omega": omega, "omega_verlet": verlet, "phase_velocity": speed,
                "polarisation": mode.polarisation, "longitudinal": mode.longitudinal(self.k),
            })
        });
        json!({ "k": self.k, "modes": modes.collect::<Vec<_>>() })
    }

    fn print(&self) -> Result<(), IoError> {
        let modes: Vec<String> = self
            .modes
            .iter()
            .map(|mode| match self.numbers(mode) {
                [Some(omega), _, Some(speed)] => format!(
                    "{} 1/s ({} m/s)",
                    significant(omega, 5),
                    significant(speed, 4)
                ),
                _ => "unstable".into(),
            })
            .collect();
        let k = self.k.map(|k| significant(k, 4)).join(", ");
        console::print(format_args!("ω at k = ({k}) rad/m   {}", modes.join("; ")))
    }
}

/// Returns all wave vectors as JSON.
pub(crate) fn summary(all: &[AtWaveVector]) -> Json {
    all.iter().map(AtWaveVector::json).collect()
}

/// Prints all wave vectors.
pub(crate) fn print(all: &[AtWaveVector]) -> Result<(), IoError> {
    all.iter().try_for_each(AtWaveVector::print)
}

/// Writes a table with a row per mode; cells of growing waves are empty.
pub(crate) fn write(path: &Path, all: &[AtWaveVector]) -> Result<(), IoError> {
    let mut columns = ["k_x", "k_y", "k_z"]
        .map(|name| Column::real(name, "rad/m"))
        .to_vec();
    columns.push(Column::integer("mode"));
    columns.extend(["omega", "omega_verlet"].map(|name| Column::real(name, "rad/s")));
    columns.push(Column::real("phase_velocity", "m/s"));
    columns.push(Column::real("longitudinal", ""));
    let mut table = CsvTable::create(path, &columns)?;
    for place in all {
        for (number, mode) in place.modes.iter().enumerate() {
            let mut cells: Vec<Cell> = place.k.map(Cell::from).to_vec();
            cells.push((number as i64).into());
            let numbers = place.numbers(mode);
            cells.extend(numbers.map(|number| Cell::from(number.unwrap_or(f64::NAN))));
            cells.push(mode.longitudinal(place.k).into());
            table.append(&cells)?;
        }
    }
    table.flush()
}
