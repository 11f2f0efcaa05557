//! State-based materials: the force state of a point is a function of the deformation of all its bonds.
//!
//! A material is a type that implements [`Solid`]. It states what is computed per point, what is stored, the force of a
//! bond and the energy; everything else is the same for all materials and lies in [`SolidForce`]: the loops for every
//! instruction set, failure of bonds and the energy that they dissipate, several materials in one body, thermal
//! expansion, division among processes, checkpoints and output.
//!
//! | module | contents |
//! |---|---|
//! | `bonds`, `family` | bonds of a body, and of a point in batches of eight |
//! | `body` | input of the force |
//! | `force`, `loops`, `evaluation`, `operator` | the force operator and its loops |
//! | `shape` | shape tensors |
//! | `history`, `opposite` | variables stored per bond and per point; reverse entries |
//! | `breaking`, `criterion`, `work` | failure of bonds by stretch, by stress and strain, and by energy |
//! | `heat`, `view` | thermal stretches; access for output |
//!
//! The example `maxwell` of this crate defines a viscoelastic material in one file.

mod body;
mod bonds;
mod breaking;
mod criterion;
mod evaluation;
mod family;
mod force;
mod heat;
mod history;
mod loops;
mod operator;
mod opposite;
mod shape;
mod view;
mod work;

use pericles::lanes::{F64x8, Lanes, Real};
use pericles::operator::Kinematics;

pub use body::SolidBody;
pub use family::{Bond, Family, Point};
pub use force::SolidForce;
pub use heat::YieldScale;
pub use history::{HistorySize, NextHistory};
pub use shape::LARGEST_CONDITION;
pub(crate) use shape::{ShapeTensor, inverse_of};

use crate::tensor::Matrix;

/// Largest number of values of a point that its bonds read.
pub const MOST_VALUES: usize = 16;

/// A state-based material in D dimensions.
///
/// The force density of a point i is f_i = Σ_j ω_ij (T_i⟨ξ⟩ − T_j⟨−ξ⟩), where ω = w b V_j is the weight of a bond
/// (influence function, partial volume, volume of the other end) and T_i the force state of the material of i per unit of
/// ω. The force is the gradient of Σ_i V_i W_i with the energy density W_i of a point.
///
/// A force is evaluated in two loops. The first calls [`Solid::state`] for each point: it reads all bonds of the point and
/// sets [`Solid::VALUES`] numbers of the point and, with [`Solid::BOND_VALUES`], one number per bond. The second calls
/// [`Solid::pull`] for both ends of each bond with these numbers. A material whose force state follows from a few numbers
/// of the point sets values of points; any other ordinary material sets the magnitude of its force state per bond.
///
/// Functions of a type `T` compute eight bonds at a time and are compiled for several instruction sets; they should be
/// `#[inline(always)]` and use loops instead of closures. Missing and broken bonds have zero weight.
pub trait Solid<const D: usize>: Send + Sync + 'static {
    /// How extensions and directions of bonds follow from displacements.
    type Kinematics: Kinematics;
    /// Numbers that follow from the undeformed bonds of a point, such as its weighted volume.
    type Shape: Copy + Send + Sync;
    /// Number of values per point that the bonds of both ends read, at most [`MOST_VALUES`].
    const VALUES: usize = 0;
    /// Whether every directed bond has a value that both ends read.
    const BOND_VALUES: bool = false;
    /// Whether the volume of a point must remain positive; a run stops otherwise.
    const NEEDS_POSITIVE_VOLUME: bool = false;
    /// Whether [`Solid::stress`] is computed from a deformation gradient and is written as the stress of the point.
    const HAS_STRESS: bool = false;

    /// Returns the numbers of a point for its intact bonds; `None` if these bonds do not determine a force state, which
    /// then loses all of them. `before` are the numbers of the undamaged point, except at the start of a run.
    fn shape(&self, family: &Family<'_, D>, before: Option<&Self::Shape>) -> Option<Self::Shape>;

    /// Sets the values of a point and of its bonds, and returns its dilatation.
    fn state<T: Lanes>(&self, at: &Point<'_, Self::Shape, D>, out: &mut State<'_>) -> f64;

    /// Sets the derivatives of the values for displacements that change by `direction`, the same bonds with the direction
    /// as displacement.
    fn state_change<T: Lanes>(
        &self,
        at: &Point<'_, Self::Shape, D>,
        direction: &Family<'_, D>,
        out: &mut State<'_>,
    );

    /// Returns T_i⟨ξ⟩ from the values of i, N/m³ per unit of ω. An end whose values are all zero has no force. By default
    /// the value of the bond is the magnitude t of an ordinary force state, t |ξ| y/|y| ([`Bond::along`]).
    #[inline(always)]
    fn pull<T: Lanes>(end: &End<T>, bond: &Bond<T, D>) -> [T; D] {
        bond.along::<Self::Kinematics>(end.of_bond)
    }

    /// Returns the derivative of [`Solid::pull`] for values that change by `change` and η that changes by `moved`.
    #[inline(always)]
    fn pull_change<T: Lanes>(
        end: &End<T>,
        change: &End<T>,
        bond: &Bond<T, D>,
        moved: [T; D],
    ) -> [T; D] {
        bond.along_change::<Self::Kinematics>(end.of_bond, change.of_bond, moved)
    }

    /// Returns the elastic energy density W of a point, J/m³.
    fn energy<T: Lanes>(&self, at: &Point<'_, Self::Shape, D>) -> f64;

    /// Returns the energy density that a point loses when its bonds break, J/m³, as a function of its displacements: W, or
    /// W plus the energy dissipated within the step.
    fn potential(&self, at: &Point<'_, Self::Shape, D>) -> f64 {
        self.energy::<F64x8>(at)
    }

    /// Sets the values whose forces are the gradient of [`Solid::potential`]. They differ from those of [`Solid::state`]
    /// if the stored numbers change within the step, but the potential is that at their last values.
    fn potential_state(&self, at: &Point<'_, Self::Shape, D>, out: &mut State<'_>) {
        self.state::<F64x8>(at, out);
    }

    /// Returns k with W ≤ ½ k Σ ω |η|² at small displacements, for a bound of the highest frequency.
    fn stiffness(&self, shape: &Self::Shape) -> f64;

    /// Returns the factor by which the highest frequency of a point may grow when bonds break.
    fn stiffening(&self) -> f64 {
        1.0
    }

    /// Returns whether the material reads [`Family::influence`], which takes 8 bytes per directed bond.
    fn reads_influence(&self) -> bool {
        false
    }

    /// Returns how many numbers are stored per point and per directed bond.
    fn history(&self) -> HistorySize {
        HistorySize::default()
    }

    /// Sets the stored numbers of a point at the start of a run, which are zero otherwise.
    fn start_history(&self, history: &mut [f64]) {
        let _ = history;
    }

    /// Sets the stored numbers of a point and of its bonds at the end of a step, and returns the energy that the point
    /// has dissipated in the step per volume, J/m³.
    fn advance<T: Lanes>(&self, at: &Point<'_, Self::Shape, D>, next: &mut NextHistory<'_>) -> f64 {
        let _ = (at, next);
        0.0
    }

    /// Returns the equivalent plastic strain from the stored numbers of a point; `None` if the material does not yield.
    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        let _ = history;
        None
    }

    /// Returns the Cauchy stress of a point, Pa, for failure criteria and output: by default Σ ω T ⊗ y.
    fn stress(&self, at: &Point<'_, Self::Shape, D>) -> Matrix<D> {
        criterion::stress_of_force_state(self, at)
    }
}

/// Output of [`Solid::state`]: values of a point and of its bonds.
pub struct State<'a> {
    /// [`Solid::VALUES`] values of the point.
    pub values: &'a mut [f64],
    of_bonds: &'a mut [f64],
}

impl State<'_> {
    /// Sets the values of the bonds of a batch.
    #[inline(always)]
    pub fn set_bonds<T: Lanes>(&mut self, batch: usize, values: T) {
        family::store(self.of_bonds, batch, values);
    }
}

/// Values that a bond reads at one of its ends.
#[derive(Clone, Copy)]
pub struct End<T> {
    /// The values of the point, followed by zeros.
    pub values: [T; MOST_VALUES],
    /// The value of the bond as seen from this end; zero without [`Solid::BOND_VALUES`].
    pub of_bond: T,
}

impl<T: Real> End<T> {
    /// An end without a force.
    pub(crate) fn none() -> Self {
        Self {
            values: [T::splat(0.0); MOST_VALUES],
            of_bond: T::splat(0.0),
        }
    }
}
