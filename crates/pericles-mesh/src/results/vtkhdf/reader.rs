//! Reader of VTKHDF files that this crate has written.

use std::fs::File;
use std::path::Path;

use super::{Plan, VtkHdfLayout, VtkHdfWriter};
use crate::results::{Numbers, WriteError};

/// Reader of a file that [`VtkHdfWriter`] has written.
pub struct VtkHdfReader(VtkHdfWriter);

impl VtkHdfReader {
    /// Opens a file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or has another layout.
    pub fn open(path: impl AsRef<Path>, layout: &VtkHdfLayout<'_>) -> Result<Self, WriteError> {
        layout.check()?;
        let plan = Plan::new(layout)?;
        let mut file = File::open(path)?;
        let outputs = plan.outputs_in(&mut file, layout.outputs)?;
        let mut own = VtkHdfWriter::of(file, plan, layout);
        own.outputs = outputs;
        Ok(Self(own))
    }

    /// Returns the number of outputs.
    pub fn outputs(&self) -> usize {
        self.0.outputs
    }

    /// Reads the time of an output, s, and a component-major array for each field.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or does not have such an output.
    pub fn read(&mut self, output: usize) -> Result<(f64, Vec<Vec<f64>>), WriteError> {
        let Self(own) = self;
        let doubles = Numbers {
            is_single: false,
            is_little: true,
        };
        let place = own.plan.values_place() + 8 * output as u64;
        let time = doubles.read_at(&mut own.file, place, 1)?[0];
        let points = own.points;
        let mut all = Vec::new();
        for (field, place) in own.fields.iter().zip(&own.plan.fields) {
            let columns = field.columns();
            let row = columns as u64 * own.numbers.bytes();
            let place = place + (output * points) as u64 * row;
            let rows = own
                .numbers
                .read_at(&mut own.file, place, columns * points)?;
            let component = |c: usize| rows.iter().skip(c).step_by(columns).copied();
            all.push((0..field.components).flat_map(component).collect());
        }
        Ok((time, all))
    }
}
