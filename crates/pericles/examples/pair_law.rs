//! A custom pair law: bonds that stiffen with the square of their stretch.
//!
//! A law is a type without data that implements [`PairForce`]. It is compiled into the loops over bonds and is generic
//! over the dimension `D` and over [`Real`], a single number or a vector of eight bonds.

use std::error::Error;

use pericles::material::Calibration;
use pericles::prelude::*;

/// The coefficient β of the law.
const BETA: f64 = 4.0;

/// Energy (½ s² + ¼ β s⁴) |ξ| with the stretch s = (|ξ+η| − |ξ|)/|ξ|, hence force (s + β s³) n with the direction n of
/// the deformed bond.
#[derive(Debug, Clone, Copy, Default)]
struct Stiffening;

/// Returns s, |ξ|, |ξ+η| and n. It uses |ξ+η|² − |ξ|² = η·(2ξ + η), which avoids the cancellation in |ξ+η| − |ξ| at
/// small stretches.
#[inline(always)]
fn bond<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> (T, T, T, [T; D]) {
    let reference = dot(xi, xi).sqrt();
    let growth = dot(eta, vector(|c| xi[c] + xi[c] + eta[c]));
    let length = (reference * reference + growth).sqrt();
    let stretch = growth / ((length + reference) * reference);
    (
        stretch,
        reference,
        length,
        vector(|c| (xi[c] + eta[c]) / length),
    )
}

impl PairForce for Stiffening {
    const LINEAR: bool = false;

    #[inline(always)]
    fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D] {
        let (s, _, _, n) = bond(xi, eta);
        let size = s + T::splat(BETA) * s * s * s;
        vector(|c| size * n[c])
    }

    #[inline(always)]
    fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
        let (s, reference, ..) = bond(xi, eta);
        (T::splat(0.5) + T::splat(0.25 * BETA) * s * s) * s * s * reference
    }

    /// The derivative of the force in the direction d: the part along n changes the magnitude, the part across n the
    /// direction.
    #[inline(always)]
    fn tangent<T: Real, const D: usize>(xi: [T; D], eta: [T; D], d: [T; D]) -> [T; D] {
        let (s, reference, length, n) = bond(xi, eta);
        let along = dot(n, d);
        let slope = (T::splat(1.0) + T::splat(3.0 * BETA) * s * s) / reference;
        let turn = (s + T::splat(BETA) * s * s * s) / length;
        vector(|c| slope * along * n[c] + turn * (d[c] - along * n[c]))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    // The material has modulus, density and horizon. Calibration on the lattice makes the modulus of the grid exact.
    let young = 1e9;
    let rubber = BondMaterial::new(ElasticModulus::Young(young), 1100.0, 3e-3)
        .with_calibration(Calibration::Lattice);
    let bar = Grid::bar(0.1, 1e-3, 1e-4).points()?;
    let system = Body::new(bar, rubber).pair_law::<Stiffening>().build()?;

    // All bonds of a uniformly stretched bar have the same stretch: the energy density is E (½ s² + ¼ β s⁴).
    println!("stretch   energy density (J/m³)   closed form");
    for stretch in [0.01, 0.1, 0.3] {
        let u: Vec<f64> = system.cloud().axis(0).iter().map(|x| stretch * x).collect();
        let mut density = vec![0.0; u.len()];
        system.operator().add_energy_density(0.0, &u, &mut density);
        let square: f64 = stretch * stretch;
        let exact = young * (0.5 * square + 0.25 * BETA * square * square);
        println!("{stretch:7.2}   {:21.6e}   {exact:.6e}", density[50]);
        if (density[50] / exact - 1.0).abs() > 1e-9 {
            return Err("the energy density differs from the closed form".into());
        }
    }

    // The law works with every time integrator and every form of bonds. Here the bar vibrates with strains of several
    // per cent.
    let mut run = Simulation::builder(system)
        .velocity(|[x, ..]| [60.0 * (10.0 * std::f64::consts::PI * x).cos(), 0.0, 0.0])
        .safety(0.2)
        .end(2e-4)
        .build()?;
    run.run_to_end()?;
    let energies = run.snapshot().energies();
    let error = energies.balance() / energies.initial;
    println!(
        "error of the energy balance after {} steps: {error:+.1e} of the initial energy",
        run.steps()
    );
    if error.abs() > 1e-3 {
        return Err("the force is not the derivative of the energy".into());
    }
    Ok(())
}
