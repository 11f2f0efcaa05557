//! Tensor kernel in wavenumber space, and products with it.

use rustfft::num_complex::Complex;

use super::tensor_kernel::{Axis, TensorKernel, pairs};

/// Product computed in wavenumber space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Product {
    /// v_a = Σ_b K_ab u_b on as many fields as dimensions.
    Tensor,
    /// v = K_p u on one field, for pair p.
    Pair(usize),
}

/// K̂_ab on one octant of the wavenumbers, divided by the length of the transforms.
pub(super) struct TensorSpectra<const D: usize> {
    /// Per pair: the last axis fastest, then x, then the middle axis (absent in 1D and 2D).
    spectra: Vec<Vec<f64>>,
    pairs: Vec<(usize, usize)>,
    /// Modes of x, middle and last axis in the octant.
    modes: [usize; 3],
    /// Lengths of the transforms along the middle and the last axis.
    middle: usize,
    last: usize,
}

/// Index of (a, b) among the pairs of components.
pub(super) fn pair(dimension: usize, a: usize, b: usize) -> usize {
    if a == b { a } else { dimension + a + b - 1 }
}

impl<const D: usize> TensorSpectra<D> {
    /// Computes the spectra of K_ab = `value(offset)`; `axes` are x, middle, last, which are x, z, y in 2D.
    pub fn new(axes: [Axis; 3], value: impl Fn([i64; 3], &mut [f64])) -> Self {
        let pairs = pairs(D);
        let scale = 1.0 / axes.iter().map(|axis| axis.padded as f64).product::<f64>();
        // Position of each axis among x, y, z.
        let place = if D == 2 { [0, 2, 1] } else { [0, 1, 2] };
        let kernel = TensorKernel::new(axes, pairs.len(), |offset, values| {
            value(place.map(|axis| offset[axis]), values);
        });
        let spectra = pairs
            .iter()
            .enumerate()
            .map(|(p, &(a, b))| {
                let odd = |axis: usize| a != b && (place[axis] == a || place[axis] == b);
                kernel.spectrum(p, odd, scale)
            })
            .collect();
        Self {
            spectra,
            pairs,
            modes: axes.map(|axis| axis.modes()),
            middle: axes[1].padded,
            last: axes[2].padded,
        }
    }

    pub fn bytes(&self) -> usize {
        self.spectra.iter().map(|s| size_of_val(&s[..])).sum()
    }

    /// Returns true if K_p changes its sign under reflection of an axis: 1 the middle, 2 the last.
    fn is_odd(&self, p: usize, axis: usize) -> bool {
        let (a, b) = self.pairs[p];
        let axis = if D == 2 && axis == 2 { 1 } else { axis };
        a != b && (axis == a || axis == b)
    }

    /// Multiplies the lines of all fields along the last axis, at one wavenumber of the other axes.
    pub fn multiply<const F: usize>(
        &self,
        product: Product,
        middle: usize,
        x: usize,
        fields: &mut [&mut [Complex<f64>]; F],
    ) {
        let modes = self.modes[2];
        let mirrored = middle > self.middle / 2;
        let folded = if mirrored {
            self.middle - middle
        } else {
            middle
        };
        let from = modes * (x + self.modes[0] * folded);
        let stored = |p: usize| &self.spectra[p][from..from + modes];
        let sign = |p: usize, back: bool| {
            let flips = (mirrored && self.is_odd(p, 1)) != (back && self.is_odd(p, 2));
            if flips { -1.0 } else { 1.0 }
        };
        // Wavenumbers 0 … π as stored, the others mirrored.
        for back in [false, true] {
            let range = if back { modes..self.last } else { 0..modes };
            let at = |l: usize| if back { self.last - l } else { l };
            match product {
                Product::Pair(p) => {
                    let (kernel, sign) = (stored(p), sign(p, back));
                    for l in range {
                        fields[0][l] *= sign * kernel[at(l)];
                    }
                }
                Product::Tensor => {
                    let kernels: [[&[f64]; F]; F] =
                        std::array::from_fn(|a| std::array::from_fn(|b| stored(pair(D, a, b))));
                    let signs: [[f64; F]; F] =
                        std::array::from_fn(|a| std::array::from_fn(|b| sign(pair(D, a, b), back)));
                    for l in range {
                        let u: [Complex<f64>; F] = std::array::from_fn(|b| fields[b][l]);
                        for a in 0..F {
                            let mut sum = Complex::default();
                            for b in 0..F {
                                sum += u[b] * (signs[a][b] * kernels[a][b][at(l)]);
                            }
                            fields[a][l] = sum;
                        }
                    }
                }
            }
        }
    }
}
