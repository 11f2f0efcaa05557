//! Stress of a solid in the dimension of a body, with the transverse stretch in the plane and in a bar.

use pericles::material::StressState;

use super::law::{ElasticLaw, Moduli, stress, stress_change};
use super::plasticity::{History, Plasticity, returned};
use crate::tensor::{
    Matrix, combination, determinant, diagonal, in_body, in_space, symmetric, trace, unit,
};

/// A solid under a state of stress: F₃₃ = 1 in plane strain; P₃₃ = 0 in plane stress; P₂₂ = P₃₃ = 0 with
/// F₂₂ = F₃₃ in a bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassicalSolid {
    /// The state of stress.
    pub state: StressState,
    /// Elastic law; [`ElasticLaw::Hencky`] for solids with plasticity, [`ElasticLaw::StVenantKirchhoff`] for anisotropic ones.
    pub law: ElasticLaw,
    /// Elastic moduli.
    pub moduli: Moduli,
    /// Plasticity; `None` for elastic solids.
    pub plasticity: Option<Plasticity>,
}

/// State of a point of a solid at a deformation gradient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointState<const D: usize> {
    /// Elastic energy density ψ, J/m³.
    pub energy: f64,
    /// First Piola–Kirchhoff stress P in the dimension of the body, Pa.
    pub stress: Matrix<D>,
    /// Transverse stretch of a plane or a bar; 1 in space.
    pub across: f64,
    /// Plastic strain α accumulated since the history.
    pub flow: f64,
}

/// Largest number of Newton iterations for the transverse stretch; a few suffice.
const ITERATIONS: usize = 60;

/// A solid whose stress-free state is stretched by a factor λ in all directions: F = λ F_e, ψ = ψ(F_e) and
/// P = P(F_e)/λ. In plane strain F₃₃ = 1 and F_e,₃₃ = 1/λ.
#[derive(Debug, Clone, Copy)]
pub struct Expanded<'a> {
    solid: &'a ClassicalSolid,
    factor: f64,
}

impl Expanded<'_> {
    /// Returns energy density and stress; see [`ClassicalSolid::stress`].
    pub fn stress<const D: usize>(&self, f: &Matrix<D>, history: &History) -> PointState<D> {
        let full = self.elastic_part(f, history);
        let (energy, stress, flow) = self.solid.stress_in_space(&full, history);
        PointState {
            energy,
            stress: self.over_factor(&in_body(&stress)),
            across: self.factor * full[2][2],
            flow,
        }
    }

    /// Returns the derivative of P; see [`ClassicalSolid::stress_change`].
    pub fn stress_change<const D: usize>(
        &self,
        f: &Matrix<D>,
        df: &Matrix<D>,
        history: &History,
    ) -> Matrix<D> {
        let full = self.elastic_part(f, history);
        let change = self.over_factor(df);
        let change = self.solid.change_at(&full, &change, history);
        self.over_factor(&change)
    }

    /// Returns the history after a step and the plastic work; see [`ClassicalSolid::advanced`].
    pub fn advanced<const D: usize>(&self, f: &Matrix<D>, history: &History) -> (History, f64) {
        let full = self.elastic_part(f, history);
        self.solid.advanced_at(&full, history)
    }

    /// Returns F_e in space.
    fn elastic_part<const D: usize>(&self, f: &Matrix<D>, history: &History) -> Matrix<3> {
        let across = 1.0 / self.factor;
        self.solid.embedded(&self.over_factor(f), across, history)
    }

    fn over_factor<const D: usize>(&self, tensor: &Matrix<D>) -> Matrix<D> {
        tensor.map(|row| row.map(|entry| entry / self.factor))
    }
}

impl ClassicalSolid {
    /// Returns the ratio of the secant shear modulus to the elastic one at the accumulated plastic strain α,
    /// (σ_y + H α)/(σ_y + H α + 3 G α); one for an elastic material.
    pub fn secant_ratio(&self, accumulated: f64) -> f64 {
        let Some(plasticity) = &self.plasticity else {
            return 1.0;
        };
        let limit = plasticity.yield_stress + plasticity.hardening * accumulated;
        limit / (limit + 3.0 * self.moduli.shear * accumulated)
    }

    /// Returns the solid with a stress-free state stretched by a positive factor, for thermal expansion.
    pub fn expanded(&self, factor: f64) -> Expanded<'_> {
        Expanded {
            solid: self,
            factor,
        }
    }

    /// Returns energy density and stress; NaN for det F ≤ 0.
    pub fn stress<const D: usize>(&self, f: &Matrix<D>, history: &History) -> PointState<D> {
        self.expanded(1.0).stress(f, history)
    }

    /// Returns the derivative of P at F in a direction dF, including the change of the transverse stretch.
    pub fn stress_change<const D: usize>(
        &self,
        f: &Matrix<D>,
        df: &Matrix<D>,
        history: &History,
    ) -> Matrix<D> {
        self.expanded(1.0).stress_change(f, df, history)
    }

    fn change_at<const D: usize>(
        &self,
        full: &Matrix<3>,
        df: &Matrix<D>,
        history: &History,
    ) -> Matrix<D> {
        let direct = self.change_in_space(full, &in_space(df, 0.0), history);
        let Some(across) = self.across() else {
            return in_body(&direct);
        };
        let slope = self.change_in_space(full, &across, history);
        let stretch = -direct[2][2] / slope[2][2];
        in_body(&combination(1.0, &direct, stretch, &slope))
    }

    /// Returns the history after a step that ends at F and the plastic work per volume of the step, J/m³. The
    /// history of elastic solids does not change.
    pub fn advanced<const D: usize>(&self, f: &Matrix<D>, history: &History) -> (History, f64) {
        self.expanded(1.0).advanced(f, history)
    }

    fn advanced_at(&self, full: &Matrix<3>, history: &History) -> (History, f64) {
        let Some(plasticity) = &self.plasticity else {
            return (*history, 0.0);
        };
        let state = returned(&self.moduli, Some(plasticity), full, history);
        state.advanced(plasticity, full, history)
    }

    /// Returns the stress of linear elasticity in the dimension of the body, λ̂ tr(ε) I + 2 G ε or C : ε, Pa.
    pub fn linear_stress<const D: usize>(&self, strain: &Matrix<D>) -> Matrix<D> {
        if let Some(stiffness) = &self.moduli.stiffness {
            return stiffness.body_stress(self.state, strain);
        }
        let pressure = self.plane_lame() * trace(strain);
        combination(pressure, &unit(), 2.0 * self.moduli.shear, strain)
    }

    /// Returns λ̂ of an isotropic solid, Pa: λ, in plane stress 2 λ G/(λ + 2 G), in a bar E − 2 G.
    pub fn plane_lame(&self) -> f64 {
        let Moduli { lame, shear, .. } = self.moduli;
        match self.state {
            StressState::Spatial | StressState::PlaneStrain => lame,
            StressState::PlaneStress => 2.0 * lame * shear / (lame + 2.0 * shear),
            StressState::Uniaxial => shear * lame / (lame + shear),
        }
    }

    /// Returns the dilatation modulus κ = λ̂ + 2 G/D, tr(C : I)/D² of an anisotropic solid, Pa.
    pub fn dilatation_modulus(&self) -> f64 {
        if let Some(stiffness) = &self.moduli.stiffness {
            return match self.state.dimension() {
                2 => trace(&stiffness.body_stress::<2>(self.state, &unit())) / 4.0,
                _ => trace(&stiffness.body_stress::<3>(self.state, &unit())) / 9.0,
            };
        }
        self.plane_lame() + 2.0 * self.moduli.shear / self.state.dimension() as f64
    }

    /// Returns the derivative of F with respect to the transverse stretch; `None` if the stretch is constant.
    fn across(&self) -> Option<Matrix<3>> {
        match self.state {
            StressState::PlaneStress => Some(diagonal([0.0, 0.0, 1.0])),
            StressState::Uniaxial => Some(diagonal([0.0, 1.0, 1.0])),
            StressState::PlaneStrain | StressState::Spatial => None,
        }
    }

    /// Returns F in space; `kept` is the transverse stretch in plane strain.
    fn embedded<const D: usize>(&self, f: &Matrix<D>, kept: f64, history: &History) -> Matrix<3> {
        let Some(direction) = self.across() else {
            return in_space(f, kept);
        };
        // The transverse stretch of an inverted plane is undefined.
        if determinant(&in_space(f, 1.0)) <= 0.0 {
            return in_space(f, f64::NAN);
        }
        let mut across = self.first_guess(f, history);
        for _ in 0..ITERATIONS {
            let full = in_space(f, across);
            let (_, stress, _) = self.stress_in_space(&full, history);
            let slope = self.change_in_space(&full, &direction, history);
            let step = -stress[2][2] / slope[2][2];
            // Steps are limited so that the stretch remains positive and concave laws do not overshoot.
            let step = step.clamp(-0.5 * across, across);
            across += step;
            if step.abs() <= 4.0 * f64::EPSILON * across || !step.is_finite() {
                break;
            }
        }
        in_space(f, across)
    }

    /// Returns the transverse stretch of linear elasticity; with plasticity, the stretch of the last step.
    fn first_guess<const D: usize>(&self, f: &Matrix<D>, history: &History) -> f64 {
        if self.plasticity.is_some() {
            return history.across;
        }
        if let Some(stiffness) = &self.moduli.stiffness {
            let strain = combination(1.0, f, -1.0, &unit());
            return (1.0 + stiffness.strain_across(&symmetric(&strain))).clamp(0.2, 5.0);
        }
        let Moduli { lame, shear, .. } = self.moduli;
        let strain = trace(f) - D as f64;
        let contraction = match self.state {
            StressState::Uniaxial => 0.5 * lame / (lame + shear),
            _ => lame / (lame + 2.0 * shear),
        };
        (1.0 - contraction * strain).clamp(0.2, 5.0)
    }

    /// Returns energy density, stress P and the increment of α.
    fn stress_in_space(&self, f: &Matrix<3>, history: &History) -> (f64, Matrix<3>, f64) {
        if self.law != ElasticLaw::Hencky {
            let (energy, stress) = stress(self.law, &self.moduli, f);
            return (energy, stress, 0.0);
        }
        let j = determinant(f);
        if j.is_nan() || j <= 0.0 {
            return (f64::NAN, [[f64::NAN; 3]; 3], f64::NAN);
        }
        let state = returned(&self.moduli, self.plasticity.as_ref(), f, history);
        let energy = state.energy(&self.moduli);
        (energy, state.first_stress(f), state.increment)
    }

    fn change_in_space(&self, f: &Matrix<3>, df: &Matrix<3>, history: &History) -> Matrix<3> {
        if self.law != ElasticLaw::Hencky {
            return stress_change(self.law, &self.moduli, f, df);
        }
        returned(&self.moduli, self.plasticity.as_ref(), f, history).stress_change(f, df)
    }
}
