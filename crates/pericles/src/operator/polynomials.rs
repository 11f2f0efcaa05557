//! Polynomials of the strains of bonds, which need no roots and divisions.

/// Largest |t| of the polynomials.
pub(super) const REACH: f64 = 0.02;

/// Coefficients of φ(t)/t = 1/((1+t) + √(1+t)), ascending: the polynomial through its values at the seven
/// Chebyshev nodes of
/// |t| ≤ 0.02, computed with 50 digits; relative error below 8e-15 there.
pub(super) const PHI: [f64; 7] = [
    0.5,
    -0.3750000000013755,
    0.3125000000012991,
    -0.27343747249067285,
    0.2460937240188067,
    -0.22572346562446355,
    0.20960254454644783,
];

/// Coefficients of ψ(t)/t = 1/(1 + √(1+t)), ascending: the polynomial through its values at the seven
/// Chebyshev nodes of |t| ≤ 0.02, computed with 50 digits; relative error below 6e-16 there.
pub(super) const PSI: [f64; 7] = [
    0.5,
    -0.12500000000009168,
    0.06250000000007641,
    -0.039062498166270054,
    0.027343748471866127,
    -0.020516980175525664,
    0.0161209210780157,
];
