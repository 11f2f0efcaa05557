//! A material of one's own: an ordinary state-based solid whose shear is a Maxwell element, a spring and one dashpot in
//! series. The shear stress relaxes to zero; the dilatation stays elastic.
//!
//! With the stretch ψ = e/|ξ| of a bond, the weighted volume m = Σ ω |ξ|², the dilatation θ = (3/m) Σ ω |ξ|² ψ and the
//! deviatoric stretch ψ_d = ψ − θ/3, the force state and the energy density are
//!
//! t = [3 K θ + 15 G (y − ȳ)]/m per unit of ω |ξ|,  W = ½ K θ² + (15 G/2 m) Σ ω |ξ|² y²,  y = ψ_d − x,
//!
//! with the viscous stretch x of the bond, dx/dt = (ψ_d − x)/τ, and ȳ = Σ ω |ξ|² y/m, which vanishes until bonds break.
//! ψ_d is taken to change linearly within a step, for which the update of x is exact.
//!
//! The results are compared with closed forms: the relaxation of a suddenly applied shear strain γ, whose stress is
//! G γ exp(−t/τ), a shear strain that grows at a constant rate, whose stress is G γ̇ τ (1 − exp(−t/τ)), and the energy
//! balance of a block that vibrates.

use std::error::Error;
use std::f64::consts::PI;
use std::marker::PhantomData;
use std::sync::Arc;

use pericles::kernel::Influence;
use pericles::lanes::{F64x8, Lanes};
use pericles::material::{BondStrength, Materials};
use pericles::observe::Energies;
use pericles::operator::{FiniteStrain, Force, Kinematics, PointSubset, SmallStrain};
use pericles::space::{Grid, PointCloud};
use pericles::time::{State as Motion, VelocityVerlet};
use pericles::{Control, PointScalar, Simulation, StepEnd, System};
use pericles_solids::solid::{Family, HistorySize, NextHistory, Point, Solid, SolidBody, State};

/// Bulk modulus K and instantaneous shear modulus G, Pa, and relaxation time τ, s.
#[derive(Debug, Clone, Copy)]
struct Maxwell<K> {
    bulk: f64,
    shear: f64,
    time: f64,
    kinematics: PhantomData<K>,
}

/// Numbers stored per bond: the viscous stretch x and the deviatoric stretch at the end of the last step.
const VISCOUS: usize = 0;
const LAST: usize = 1;

/// Sums over the bonds of a point.
struct Sums {
    /// θ
    dilatation: f64,
    /// ȳ at the current time.
    mean: f64,
}

impl<K: Kinematics> Maxwell<K> {
    /// Returns x at the current time for the deviatoric stretches ψ_d of a batch.
    #[inline(always)]
    fn viscous<T: Lanes>(&self, at: &Point<'_, f64, 3>, batch: usize, deviator: T) -> T {
        let ratio = at.dt / self.time;
        let gain = -(-ratio).exp_m1();
        let slope = if ratio > 0.0 { 1.0 - gain / ratio } else { 0.0 };
        let (x, last) = (
            at.bond_history::<T>(batch, VISCOUS),
            at.bond_history::<T>(batch, LAST),
        );
        x + T::splat(gain) * (last - x) + T::splat(slope) * (deviator - last)
    }

    #[inline(always)]
    fn sums<T: Lanes>(&self, at: &Point<'_, f64, 3>) -> Sums {
        let (mut extension, mut rest) = (T::splat(0.0), T::splat(0.0));
        for batch in 0..at.family.batches() {
            let bond = at.family.bond::<T>(batch);
            extension = (bond.weight * bond.square).mul_add(bond.stretch::<K>(), extension);
        }
        let dilatation = 3.0 / at.shape * F64x8(extension.to_array()).sum();
        for batch in 0..at.family.batches() {
            let bond = at.family.bond::<T>(batch);
            let deviator = bond.stretch::<K>() - T::splat(dilatation / 3.0);
            let y = deviator - self.viscous(at, batch, deviator);
            rest = (bond.weight * bond.square).mul_add(y, rest);
        }
        Sums {
            dilatation,
            mean: F64x8(rest.to_array()).sum() / at.shape,
        }
    }
}

impl<K: Kinematics> Solid<3> for Maxwell<K> {
    type Kinematics = K;
    /// The weighted volume m.
    type Shape = f64;
    const BOND_VALUES: bool = true;

    fn shape(&self, family: &Family<'_, 3>, before: Option<&f64>) -> Option<f64> {
        let mut volume = 0.0;
        for batch in 0..family.batches() {
            let bond = family.bond::<F64x8>(batch);
            volume += (bond.weight * bond.square).sum();
        }
        Some(before.copied().unwrap_or(volume))
    }

    #[inline(always)]
    fn state<T: Lanes>(&self, at: &Point<'_, f64, 3>, out: &mut State<'_>) -> f64 {
        let Sums { dilatation, mean } = self.sums::<T>(at);
        let over = 1.0 / at.shape;
        for batch in 0..at.family.batches() {
            let bond = at.family.bond::<T>(batch);
            let deviator = bond.stretch::<K>() - T::splat(dilatation / 3.0);
            let y = deviator - self.viscous(at, batch, deviator) - T::splat(mean);
            let pull = T::splat(15.0 * self.shear) * y + T::splat(3.0 * self.bulk * dilatation);
            out.set_bonds(batch, T::splat(over) * pull);
        }
        dilatation
    }

    #[inline(always)]
    fn state_change<T: Lanes>(
        &self,
        at: &Point<'_, f64, 3>,
        direction: &Family<'_, 3>,
        out: &mut State<'_>,
    ) {
        let (mut extension, over) = (T::splat(0.0), 1.0 / at.shape);
        for batch in 0..at.family.batches() {
            let bond = at.family.bond::<T>(batch);
            let change = bond.stretch_change::<K>(direction.eta(batch));
            extension = (bond.weight * bond.square).mul_add(change, extension);
        }
        let dilatation = 3.0 * over * F64x8(extension.to_array()).sum();
        // Of a change of the stretch, the fraction `slope` has relaxed at the end of the step.
        let ratio = at.dt / self.time;
        let slope = if ratio > 0.0 {
            1.0 + (-ratio).exp_m1() / ratio
        } else {
            0.0
        };
        let rest = 15.0 * self.shear * (1.0 - slope);
        for batch in 0..at.family.batches() {
            let bond = at.family.bond::<T>(batch);
            let change = bond.stretch_change::<K>(direction.eta(batch));
            let deviator = change - T::splat(dilatation / 3.0);
            let pull = T::splat(rest) * deviator + T::splat(3.0 * self.bulk * dilatation);
            out.set_bonds(batch, T::splat(over) * pull);
        }
    }

    #[inline(always)]
    fn energy<T: Lanes>(&self, at: &Point<'_, f64, 3>) -> f64 {
        let dilatation = self.sums::<T>(at).dilatation;
        let mut squares = T::splat(0.0);
        for batch in 0..at.family.batches() {
            let bond = at.family.bond::<T>(batch);
            let deviator = bond.stretch::<K>() - T::splat(dilatation / 3.0);
            let y = deviator - self.viscous(at, batch, deviator);
            squares = (bond.weight * bond.square * y).mul_add(y, squares);
        }
        let squares = F64x8(squares.to_array()).sum();
        0.5 * self.bulk * dilatation * dilatation + 7.5 * self.shear / at.shape * squares
    }

    /// θ² ≤ (9/m) Σ ω e².
    fn stiffness(&self, shape: &f64) -> f64 {
        (9.0 * self.bulk + 15.0 * self.shear) / shape
    }

    fn history(&self) -> HistorySize {
        HistorySize {
            per_point: 0,
            per_bond: 2,
        }
    }

    /// The dissipated energy is the work of the mean of y at both ends of the step on the change of x.
    #[inline(always)]
    fn advance<T: Lanes>(&self, at: &Point<'_, f64, 3>, next: &mut NextHistory<'_>) -> f64 {
        let dilatation = self.sums::<T>(at).dilatation;
        let mut work = T::splat(0.0);
        for batch in 0..at.family.batches() {
            let bond = at.family.bond::<T>(batch);
            let deviator = bond.stretch::<K>() - T::splat(dilatation / 3.0);
            let (old, last) = (
                at.bond_history::<T>(batch, VISCOUS),
                at.bond_history::<T>(batch, LAST),
            );
            let new = self.viscous(at, batch, deviator);
            let push = T::splat(0.5) * ((last - old) + (deviator - new));
            work = (bond.weight * bond.square * push).mul_add(new - old, work);
            next.set_bonds(batch, VISCOUS, new);
            next.set_bonds(batch, LAST, deviator);
        }
        15.0 * self.shear / at.shape * F64x8(work.to_array()).sum()
    }
}

/// τ, s.
const TIME: f64 = 0.7;

fn block(cells: usize) -> Result<Arc<PointCloud>, Box<dyn Error>> {
    Ok(Arc::new(Grid::block([cells as f64; 3], 1.0).points()?))
}

fn force<K: Kinematics>(
    cloud: &Arc<PointCloud>,
    kinematics: PhantomData<K>,
) -> Result<Box<dyn Force>, Box<dyn Error>> {
    let material = Maxwell {
        bulk: 5.0,
        shear: 2.0,
        time: TIME,
        kinematics,
    };
    let materials = Materials::uniform(material, BondStrength::UNBREAKABLE);
    let influence = Influence::default();
    let body = SolidBody::new(cloud, materials, 3.01, &influence);
    Ok(body.operator::<3>()?.operator)
}

/// Returns time and energy density of an inner point after each step under a shear strain γ(t), relative to an elastic
/// solid with the strain of one.
fn sheared(strain: impl Fn(f64) -> f64) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let cloud = block(7)?;
    let (n, middle) = (cloud.len(), cloud.len() / 2);
    let displaced = |gamma: f64| -> Vec<f64> {
        let along = |i: usize| gamma * cloud.point(i)[1];
        let x = (0..n).map(along);
        x.chain(std::iter::repeat_n(0.0, 2 * n)).collect()
    };
    let mut force = force(&cloud, PhantomData::<SmallStrain>)?;
    let density = |force: &dyn Force, t: f64, u: &[f64]| {
        let mut density = vec![0.0; n];
        force.add_energy_density(t, u, &mut density);
        density[middle]
    };
    let unit = density(&*force, 0.0, &displaced(1.0));
    let (mut results, mut out) = (Vec::new(), vec![0.0; 3 * n]);
    let (dt, rest) = (0.1, vec![0.0; 3 * n]);
    for step in 0..=20 {
        let t = dt * f64::from(step);
        let u = displaced(strain(t));
        let end = match step {
            0 => StepEnd::start(t, &u, &rest),
            _ => StepEnd::sub_step(t, dt, &u),
        };
        force.end_step(&end, PointSubset::All, &mut out);
        results.push([t, density(&*force, t, &u) / unit]);
    }
    Ok(results)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut largest: f64 = 0.0;
    for [t, energy] in sheared(|_| 1.0)? {
        largest = largest.max((energy - (-2.0 * t / TIME).exp()).abs());
    }
    println!("relaxation: largest error of the energy {largest:.1e}");
    let mut rate: f64 = 0.0;
    for [t, energy] in sheared(|t| t)? {
        let stress = TIME * -(-t / TIME).exp_m1();
        rate = rate.max((energy - stress * stress).abs());
    }
    println!("constant rate: largest error of the energy {rate:.1e}");

    // A block that vibrates at finite displacements.
    let cloud = block(5)?;
    let n = cloud.len();
    let operator = force(&cloud, PhantomData::<FiniteStrain>)?;
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0))?;
    let mut start = Motion::at_rest(3 * n);
    for i in 0..n {
        start.v[i] = 1e-2 * (PI * cloud.point(i)[1] / 5.0).cos();
    }
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), start, 5e-3, 600)?;
    let before = run.snapshot().energies();
    run.run(|_| Control::Continue)?;
    let after = run.snapshot().energies();
    let total = |now: &Energies| now.kinetic + now.elastic + now.dissipated;
    let error = total(&after) / total(&before) - 1.0;
    let share = after.dissipated / total(&before);
    println!("vibration: {share:.3} of the energy is dissipated, error of the balance {error:.1e}");

    if largest > 1e-12 || rate > 1e-12 || error.abs() > 1e-4 || share < 0.3 {
        return Err("a result differs from its closed form".into());
    }
    Ok(())
}
