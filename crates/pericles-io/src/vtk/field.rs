//! Arrays of `.vtu` files.

use std::io::{self, Seek, Write};
use std::path::Path;

use super::blocks::write_array;
use crate::IoError;

/// A named field on the points or cells.
#[derive(Debug, Clone, Copy)]
pub struct VtkField<'a> {
    pub(super) name: &'a str,
    values: Values<'a>,
    unit: &'a str,
}

#[derive(Debug, Clone, Copy)]
enum Values<'a> {
    Real {
        data: &'a [f64],
        layout: Layout,
        single: bool,
    },
    Int(&'a [i32]),
    Byte(&'a [u8]),
}

/// How the components of a point are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Layout {
    Scalar,
    /// Three components, missing ones zero.
    Vector,
    /// Six components XX, YY, ZZ, XY, YZ, XZ; those that exist in the dimensions of the body are given.
    Tensor(usize),
}

impl Layout {
    /// Names of the components in files, which ParaView lists.
    const TENSOR: [&'static str; 6] = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];

    /// For each component of the file the one of the data that it takes; none for zero.
    fn sources(self, given: usize) -> &'static [Option<usize>] {
        match (self, given) {
            (Self::Scalar, _) => &[Some(0)],
            (Self::Vector, 1) => &[Some(0), None, None],
            (Self::Vector, 2) => &[Some(0), Some(1), None],
            (Self::Vector, _) => &[Some(0), Some(1), Some(2)],
            (Self::Tensor(1), _) => &[Some(0), None, None, None, None, None],
            (Self::Tensor(2), _) => &[Some(0), Some(1), None, Some(2), None, None],
            (Self::Tensor(_), _) => &[Some(0), Some(1), Some(2), Some(3), Some(4), Some(5)],
        }
    }

    /// Whether data of so many components can be written.
    fn takes(self, components: usize) -> bool {
        match self {
            Self::Scalar => components == 1,
            Self::Vector => (1..=3).contains(&components),
            Self::Tensor(dimension) => components == dimension * (dimension + 1) / 2,
        }
    }
}

impl<'a> VtkField<'a> {
    /// One real number per point.
    pub fn scalar(name: &'a str, data: &'a [f64]) -> Self {
        Self::real(name, data, Layout::Scalar)
    }

    /// A vector per point: one, two or three slices of n values, one after the other; missing components are written as zero.
    pub fn vector(name: &'a str, data: &'a [f64]) -> Self {
        Self::real(name, data, Layout::Vector)
    }

    /// A symmetric tensor per point, as slices of n values: xx in one dimension, xx, yy, xy in two, xx, yy, zz, xy, yz, xz in three. The file has six components with
    /// their names; missing ones are zero.
    pub fn symmetric_tensor(name: &'a str, dimension: usize, data: &'a [f64]) -> Self {
        Self::real(name, data, Layout::Tensor(dimension))
    }

    fn real(name: &'a str, data: &'a [f64], layout: Layout) -> Self {
        let values = Values::Real {
            data,
            layout,
            single: false,
        };
        Self::new(name, values)
    }

    fn new(name: &'a str, values: Values<'a>) -> Self {
        let unit = "";
        Self { name, values, unit }
    }

    /// One whole number per point.
    pub fn integers(name: &'a str, data: &'a [i32]) -> Self {
        Self::new(name, Values::Int(data))
    }

    /// One small number per point, for masks and kinds.
    pub fn bytes(name: &'a str, data: &'a [u8]) -> Self {
        Self::new(name, Values::Byte(data))
    }

    /// Sets the unit, written as the information key `UNITS_LABEL` of the array; empty for pure numbers.
    pub fn unit(mut self, unit: &'a str) -> Self {
        self.unit = unit;
        self
    }

    /// Rounds real numbers to single precision in the file, which halves their size.
    pub fn in_single_precision(mut self) -> Self {
        if let Values::Real { single, .. } = &mut self.values {
            *single = true;
        }
        self
    }

    fn data_type(&self) -> &'static str {
        match self.values {
            Values::Real { single: false, .. } => "Float64",
            Values::Real { single: true, .. } => "Float32",
            Values::Int(_) => "Int32",
            Values::Byte(_) => "UInt8",
        }
    }

    /// The announcement of the array.
    pub(super) fn header(&self) -> Header<'a> {
        let names: &[&str] = match self.values {
            Values::Real {
                layout: Layout::Tensor(_),
                ..
            } => &Layout::TENSOR,
            _ => &[],
        };
        let components = match self.values {
            Values::Real { data, layout, .. } => layout.sources(data.len()).len(),
            _ => 1,
        };
        Header {
            data_type: self.data_type(),
            name: self.name,
            components,
            component_names: names,
            unit: self.unit,
        }
    }

    pub(super) fn check(&self, path: &Path, points: usize) -> Result<(), IoError> {
        let (given, fits) = match self.values {
            Values::Real { data, layout, .. } => {
                let fits = (1..=6).any(|components| {
                    layout.takes(components) && data.len() == components * points
                });
                (data.len(), fits)
            }
            Values::Int(data) => (data.len(), data.len() == points),
            Values::Byte(data) => (data.len(), data.len() == points),
        };
        if !fits {
            return Err(IoError::Shape {
                path: path.to_path_buf(),
                what: format!("field {:?}", self.name),
                expected: points,
                given,
            });
        }
        Ok(())
    }

    pub(super) fn write(&self, out: &mut (impl Write + Seek), points: usize) -> io::Result<()> {
        match self.values {
            Values::Int(data) => write_array(out, points, |i| data[i].to_le_bytes()),
            Values::Byte(data) => write_array(out, points, |i| [data[i]]),
            Values::Real {
                data,
                layout,
                single,
            } => {
                let sources = layout.sources(data.len() / points.max(1));
                let count = sources.len() * points;
                let value = |k: usize| match sources[k % sources.len()] {
                    Some(component) => data[component * points + k / sources.len()],
                    None => 0.0,
                };
                if single {
                    write_array(out, count, |k| (value(k) as f32).to_le_bytes())
                } else {
                    write_array(out, count, |k| value(k).to_le_bytes())
                }
            }
        }
    }
}

/// What announces an array in the file.
pub(super) struct Header<'a> {
    pub(super) data_type: &'static str,
    pub(super) name: &'a str,
    pub(super) components: usize,
    pub(super) component_names: &'a [&'static str],
    pub(super) unit: &'a str,
}
