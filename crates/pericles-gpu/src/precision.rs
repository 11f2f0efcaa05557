//! Number types of the shaders.

use std::fmt;

/// The numbers in which a device computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// Double precision, for adapters that have it.
    Double,
    /// The state as the sum of two floats, which has 48 binary digits; forces in single precision, with an error of about 1e-7
    /// of the largest force.
    Mixed,
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Precision {
    /// All precisions.
    pub const ALL: [Self; 2] = [Self::Double, Self::Mixed];

    /// Returns the name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Double => "double",
            Self::Mixed => "mixed",
        }
    }

    /// Returns a literal of the type `real`.
    pub(crate) fn literal(self, value: f64) -> String {
        match self {
            Self::Double => format!("({value:e}lf)"),
            Self::Mixed => format!("({:e}f)", value as f32),
        }
    }

    /// Bytes of a number of the type `real`; those of the type `state` have eight.
    pub(crate) fn bytes_of_real(self) -> usize {
        match self {
            Self::Double => 8,
            Self::Mixed => 4,
        }
    }

    /// Returns numbers of the type `real`.
    pub(crate) fn reals(self, numbers: &[f64]) -> Vec<u8> {
        match self {
            Self::Double => bytemuck::cast_slice(numbers).to_vec(),
            Self::Mixed => {
                let floats: Vec<f32> = numbers.iter().map(|&number| number as f32).collect();
                bytemuck::cast_slice(&floats).to_vec()
            }
        }
    }

    /// Returns numbers of the type `state`.
    pub(crate) fn states(self, numbers: &[f64]) -> Vec<u8> {
        match self {
            Self::Double => bytemuck::cast_slice(numbers).to_vec(),
            Self::Mixed => {
                let parts = numbers.iter().flat_map(|&number| {
                    let high = number as f32;
                    [high, (number - f64::from(high)) as f32]
                });
                bytemuck::cast_slice(&parts.collect::<Vec<f32>>()).to_vec()
            }
        }
    }

    /// Reads numbers of the type `real`.
    pub(crate) fn read_reals(self, bytes: &[u8]) -> Vec<f64> {
        match self {
            Self::Double => bytemuck::pod_collect_to_vec(bytes),
            Self::Mixed => {
                let floats: Vec<f32> = bytemuck::pod_collect_to_vec(bytes);
                floats.into_iter().map(f64::from).collect()
            }
        }
    }

    /// Reads numbers of the type `state`.
    pub(crate) fn read_states(self, bytes: &[u8]) -> Vec<f64> {
        match self {
            Self::Double => bytemuck::pod_collect_to_vec(bytes),
            Self::Mixed => {
                let parts: Vec<[f32; 2]> = bytemuck::pod_collect_to_vec(bytes);
                let sum = |[high, low]: [f32; 2]| f64::from(high) + f64::from(low);
                parts.into_iter().map(sum).collect()
            }
        }
    }
}

/// Units of length and time of the numbers of a device.
///
/// Single precision has a small range, so that the numbers of mixed precision are near one: the units are powers of two close to
/// the spacing and the step, by which all numbers are divided exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    /// Length, m.
    pub length: f64,
    /// Time, s.
    pub time: f64,
}

impl Units {
    pub(crate) fn new(precision: Precision, spacing: f64, dt: f64) -> Self {
        match precision {
            Precision::Double => Self {
                length: 1.0,
                time: 1.0,
            },
            Precision::Mixed => Self {
                length: spacing.log2().floor().exp2(),
                time: dt.log2().floor().exp2(),
            },
        }
    }

    /// Velocity, m/s.
    pub(crate) fn velocity(&self) -> f64 {
        self.length / self.time
    }

    /// Acceleration, m/s².
    pub(crate) fn acceleration(&self) -> f64 {
        self.velocity() / self.time
    }

    /// Energy per mass, J/kg.
    pub(crate) fn energy(&self) -> f64 {
        self.velocity() * self.velocity()
    }
}
