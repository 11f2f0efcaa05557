//! Results of a run in one file that grows with each output: Exodus II and VTKHDF.
//!
//! | format | readers | after a killed run | resume |
//! |---|---|---|---|
//! | Exodus II ([`ExodusWriter`]) | ParaView, VisIt, VTK, Ensight, scripts | a valid file with the previous outputs | after any number of outputs, with the same bytes |
//! | VTKHDF ([`VtkHdfWriter`]) | VTK 9.3 and ParaView 5.12 or newer; h5py | a valid file with the previous outputs | as Exodus II |
//!
//! Arrays are component-major: component c of point i is entry c · n + i. Vectors with two components are
//! written with a third component of zero.

mod cdf;
mod exodus;
mod hdf5;
mod names;
mod vtkhdf;

pub use exodus::{ExodusLayout, ExodusReader, ExodusWriter, PointList};
pub use names::name_in_exodus;
pub use vtkhdf::{MOST_OUTPUTS, VtkHdfLayout, VtkHdfReader, VtkHdfWriter};

#[cfg(test)]
mod tests;

use std::io::{self, Read, Seek, SeekFrom, Write};

/// A field on the points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldSpec {
    /// Name.
    pub name: String,
    /// 1 for scalars, 2 or 3 for vectors, 6 for symmetric tensors (xx, yy, zz, xy, yz, xz), or any other number.
    pub components: usize,
}

impl FieldSpec {
    /// Creates a field.
    pub fn new(name: impl Into<String>, components: usize) -> Self {
        Self {
            name: name.into(),
            components,
        }
    }

    /// Returns the number of values written per point.
    fn columns(&self) -> usize {
        match self.components {
            2 => 3,
            components => components,
        }
    }
}

/// Errors of writing results.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The error of the operating system.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// Inconsistent data or data that cannot be stored.
    #[error("{0}")]
    Unsuitable(String),
    /// A file to be continued that does not belong to this run.
    #[error("the file cannot be continued: {0}")]
    NotContinued(String),
}

fn unsuitable<T>(reason: impl Into<String>) -> Result<T, WriteError> {
    Err(WriteError::Unsuitable(reason.into()))
}

/// Checks that every field has components.
fn check_fields<'a>(fields: impl IntoIterator<Item = &'a FieldSpec>) -> Result<(), WriteError> {
    for field in fields {
        if field.components == 0 {
            return unsuitable(format!("the field {:?} has no components", field.name));
        }
    }
    Ok(())
}

/// Checks that there is an array for each field, with one value per component and point.
fn check_values(fields: &[FieldSpec], values: &[&[f64]], points: usize) -> Result<(), WriteError> {
    if fields.len() != values.len() {
        return unsuitable(format!(
            "{} arrays are given for {} fields",
            values.len(),
            fields.len()
        ));
    }
    for (field, values) in fields.iter().zip(values) {
        if values.len() != field.components * points {
            return unsuitable(format!(
                "the field {:?} has {} values; {points} points of {} components need {}",
                field.name,
                values.len(),
                field.components,
                field.components * points
            ));
        }
    }
    Ok(())
}

/// Size and byte order of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Numbers {
    is_single: bool,
    is_little: bool,
}

impl Numbers {
    fn bytes(self) -> u64 {
        if self.is_single { 4 } else { 8 }
    }

    /// Reads numbers at an offset of a file.
    fn read_at(
        self,
        file: &mut (impl Read + Seek),
        place: u64,
        count: usize,
    ) -> io::Result<Vec<f64>> {
        file.seek(SeekFrom::Start(place))?;
        let width = self.bytes() as usize;
        let mut bytes = vec![0; count * width];
        file.read_exact(&mut bytes)?;
        let number = |bytes: &[u8]| {
            let mut wide = [0; 8];
            wide[..width].copy_from_slice(bytes);
            if !self.is_little {
                wide[..width].reverse();
            }
            match self.is_single {
                true => f64::from(f32::from_le_bytes([wide[0], wide[1], wide[2], wide[3]])),
                false => f64::from_le_bytes(wide),
            }
        };
        Ok(bytes.chunks_exact(width).map(number).collect())
    }

    /// Writes numbers at an offset of a file.
    fn write_at(
        self,
        file: &mut (impl Write + Seek),
        place: u64,
        count: usize,
        number: impl Fn(usize) -> f64,
    ) -> io::Result<()> {
        const BLOCK: usize = 8192;
        file.seek(SeekFrom::Start(place))?;
        let mut bytes = Vec::with_capacity(8 * BLOCK);
        for begin in (0..count).step_by(BLOCK) {
            bytes.clear();
            for k in begin..count.min(begin + BLOCK) {
                let x = number(k);
                match (self.is_single, self.is_little) {
                    (true, true) => bytes.extend_from_slice(&(x as f32).to_le_bytes()),
                    (true, false) => bytes.extend_from_slice(&(x as f32).to_be_bytes()),
                    (false, true) => bytes.extend_from_slice(&x.to_le_bytes()),
                    (false, false) => bytes.extend_from_slice(&x.to_be_bytes()),
                }
            }
            file.write_all(&bytes)?;
        }
        Ok(())
    }
}
