//! Anisotropic stiffness: 21 elastic constants in Voigt notation, and engineering constants of orthotropic materials.

use pericles::material::StressState;
use pericles::{PericlesError, Result};

use crate::tensor::{Matrix, in_body, in_space, matrix, product, transpose};

/// Stiffness C of an anisotropic solid, Pa: σ_I = Σ C_IJ ε_J with the stresses (σ₁₁, σ₂₂, σ₃₃, σ₂₃, σ₁₃, σ₁₂) and the strains
/// (ε₁₁, ε₂₂, ε₃₃, 2ε₂₃, 2ε₁₃, 2ε₁₂).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness([[f64; 6]; 6]);

/// Engineering constants of an orthotropic solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orthotropy {
    /// Young's moduli E₁, E₂, E₃, Pa.
    pub young: [f64; 3],
    /// Poisson's ratios ν₁₂, ν₁₃, ν₂₃: ν₁₂ is minus the strain along axis 2 over that along axis 1 in tension along axis 1.
    pub poisson: [f64; 3],
    /// Shear moduli G₁₂, G₁₃, G₂₃, Pa.
    pub shear: [f64; 3],
}

/// Axes of the components in Voigt notation.
const AXES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]];

/// Component of each pair of axes.
const COMPONENT: [[usize; 3]; 3] = [[0, 5, 4], [5, 1, 3], [4, 3, 2]];

/// Relative difference of C_IJ and C_JI that rounding explains.
const ROUNDING: f64 = 1e-6;

fn rejected(reason: String) -> PericlesError {
    PericlesError::ElasticConstants { reason }
}

impl Stiffness {
    /// Returns the stiffness with these rows, of which the symmetric part is used.
    ///
    /// # Errors
    /// Rows that are not symmetric to 1e-6 of the largest entry, or not positive definite.
    pub fn new(rows: [[f64; 6]; 6]) -> Result<Self> {
        let largest = rows.iter().flatten().fold(0.0f64, |a, b| a.max(b.abs()));
        for (i, j) in (0..6).flat_map(|i| (0..i).map(move |j| (i, j))) {
            let [a, b] = [rows[j][i], rows[i][j]];
            if (a - b).abs() > ROUNDING * largest {
                let [row, column] = [j + 1, i + 1];
                return Err(rejected(format!(
                    "the stiffness must be symmetric, but C{row}{column} = {a:.6e} Pa and C{column}{row} = {b:.6e} Pa"
                )));
            }
        }
        let stiffness = Self(square(|i, j| 0.5 * (rows[i][j] + rows[j][i])));
        match inverse_of(&stiffness.0) {
            Some(_) => Ok(stiffness),
            None => Err(rejected(
                "the stiffness must be positive definite: every strain must have a positive energy"
                    .into(),
            )),
        }
    }

    /// Returns the stiffness of an orthotropic solid, the inverse of its compliance.
    ///
    /// # Errors
    /// Constants for which some strain has no positive energy.
    pub fn orthotropic(constants: &Orthotropy) -> Result<Self> {
        let Orthotropy {
            young,
            poisson,
            shear,
        } = constants;
        let [n12, n13, n23] = *poisson;
        let mut compliance = [[0.0; 6]; 6];
        for (i, j, ratio) in [(0, 1, n12), (0, 2, n13), (1, 2, n23)] {
            compliance[i][j] = -ratio / young[i];
            compliance[j][i] = compliance[i][j];
        }
        for k in 0..3 {
            compliance[k][k] = 1.0 / young[k];
            // G₁₂ belongs to the last component, G₂₃ to the first of the shear components.
            compliance[5 - k][5 - k] = 1.0 / shear[k];
        }
        let stiffness = inverse_of(&compliance).ok_or_else(|| {
            rejected(format!(
                "the orthotropic constants must give every strain a positive energy; ν₁₂ = {n12} requires |ν₁₂| < √(E₁/E₂) = {:.3}, ν₁₃ and ν₂₃ alike, and 1 − ν₁₂ν₂₁ − ν₂₃ν₃₂ − ν₁₃ν₃₁ − 2 ν₂₁ν₃₂ν₁₃ > 0",
                (young[0] / young[1]).sqrt()
            ))
        })?;
        Self::new(stiffness)
    }

    /// Returns the stiffness in other axes, of which the columns of `turn` are the material axes: C_ijkl = Q_ia Q_jb Q_kc Q_ld
    /// C_abcd.
    #[must_use]
    pub fn turned(&self, turn: &Matrix<3>) -> Self {
        // The stress of each unit strain in the new axes.
        let back = transpose(turn);
        let column = |j: usize| {
            let [a, b] = AXES[j];
            let mut strain = [[0.0; 3]; 3];
            let entry = if a == b { 1.0 } else { 0.5 };
            strain[a][b] = entry;
            strain[b][a] = entry;
            rotated(&self.stress(&rotated(&strain, &back)), turn)
        };
        let columns: [Matrix<3>; 6] = std::array::from_fn(column);
        let entry = |i: usize, j: usize| columns[j][AXES[i][0]][AXES[i][1]];
        Self(square(|i, j| 0.5 * (entry(i, j) + entry(j, i))))
    }

    /// Returns C : ε, Pa.
    #[inline]
    pub fn stress(&self, strain: &Matrix<3>) -> Matrix<3> {
        let strains: [f64; 6] = std::array::from_fn(|j| {
            let [a, b] = AXES[j];
            strain[a][b] * if a == b { 1.0 } else { 2.0 }
        });
        let stresses = self.0.map(|row| {
            let terms = row.iter().zip(strains).map(|(c, e)| c * e);
            terms.sum::<f64>()
        });
        matrix(|a, b| stresses[COMPONENT[a][b]])
    }

    /// Returns the in-plane or spatial stress of a small strain in the dimension of a body, Pa: with ε₃₃ = 0 in plane strain and
    /// σ₃₃ = 0 in plane stress.
    pub fn body_stress<const D: usize>(&self, state: StressState, strain: &Matrix<D>) -> Matrix<D> {
        let across = match state {
            StressState::PlaneStress => self.strain_across(strain),
            _ => 0.0,
        };
        in_body(&self.stress(&in_space(strain, across)))
    }

    /// Returns ε₃₃ in plane stress.
    pub fn strain_across<const D: usize>(&self, strain: &Matrix<D>) -> f64 {
        -self.stress(&in_space(strain, 0.0))[2][2] / self.0[2][2]
    }

    /// Returns bulk and shear modulus of Voigt's average over all orientations, Pa: 9 K = C_iijj, 30 G = 3 C_ijij − C_iijj.
    pub fn average(&self) -> [f64; 2] {
        let c = &self.0;
        let normal = c[0][0] + c[1][1] + c[2][2];
        let coupled = c[0][1] + c[0][2] + c[1][2];
        let shear = c[3][3] + c[4][4] + c[5][5];
        [
            (normal + 2.0 * coupled) / 9.0,
            (normal - coupled + 3.0 * shear) / 15.0,
        ]
    }

    /// Returns an upper bound of C : H : H/|H|², Pa: of the eigenvalues with components of unit norm.
    pub fn largest(&self) -> f64 {
        let norm = |i: usize| if i < 3 { 1.0 } else { 2f64.sqrt() };
        let row = |i: usize| (0..6).map(|j| norm(i) * norm(j) * self.0[i][j].abs()).sum();
        (0..6).map(row).fold(0.0, f64::max)
    }

    /// Rejects a stiffness that a body cannot have: in the plane, strains within the plane must cause no shear out of it.
    ///
    /// # Errors
    /// A bar; a plane that is not a plane of symmetry.
    pub fn check(&self, state: StressState) -> Result<()> {
        let planar = match state {
            StressState::Spatial => return Ok(()),
            StressState::Uniaxial => {
                return Err(rejected(
                    "a bar has no anisotropic stiffness; use `youngs_modulus`".into(),
                ));
            }
            StressState::PlaneStress | StressState::PlaneStrain => [0, 1, 2, 5],
        };
        let largest = self.largest();
        let couples = |&i: &usize| (3..5).any(|j| self.0[i][j].abs() > 1e-9 * largest);
        match planar.iter().any(couples) {
            false => Ok(()),
            true => Err(rejected(
                "the plane of a plate must be a plane of symmetry of the material (C₁₄ = C₁₅ = C₂₄ = C₂₅ = C₃₄ = C₃₅ = C₄₆ = C₅₆ = 0), otherwise in-plane strains cause shear out of the plane; rotate the material about z only, or use a 3D body".into(),
            )),
        }
    }
}

/// Returns Q A Qᵀ.
fn rotated(a: &Matrix<3>, turn: &Matrix<3>) -> Matrix<3> {
    product(&product(turn, a), &transpose(turn))
}

fn square(entry: impl Fn(usize, usize) -> f64) -> [[f64; 6]; 6] {
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

/// Returns the inverse of a symmetric matrix by its Cholesky factors; `None` if it is not positive definite.
fn inverse_of(a: &[[f64; 6]; 6]) -> Option<[[f64; 6]; 6]> {
    let mut lower = [[0.0; 6]; 6];
    for i in 0..6 {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = a[i][j] - known;
            lower[i][j] = match i == j {
                true if rest > 1e-12 * a[i][i].abs() => rest.sqrt(),
                true => return None,
                false => rest / lower[j][j],
            };
        }
    }
    let mut inverse = [[0.0; 6]; 6];
    for column in 0..6 {
        let mut x = [0.0; 6];
        for i in 0..6 {
            let known: f64 = (0..i).map(|k| lower[i][k] * x[k]).sum();
            let unit = if i == column { 1.0 } else { 0.0 };
            x[i] = (unit - known) / lower[i][i];
        }
        for i in (0..6).rev() {
            let known: f64 = (i + 1..6).map(|k| lower[k][i] * x[k]).sum();
            x[i] = (x[i] - known) / lower[i][i];
        }
        for i in 0..6 {
            inverse[i][column] = x[i];
        }
    }
    Some(inverse)
}
