//! Timing of whole steps on fixed bodies, and how close they come to what the machine can do.
//!
//! A case is a small problem with bonds that could break but do not. Its time is the median of several rounds of velocity Verlet, per directed bond
//! (an entry of a family: each bond counts twice) and thread. It is set against
//!
//! * the arithmetic roofline: 28 operations per eight bonds at the measured rate of independent multiply–adds of the vector width, with
//!   the lanes that row ends and missing bonds leave idle;
//! * the memory traffic that a step cannot do without, as GB/s.
//!
//! ```
//! use pericles::bench::{Case, run};
//! let case = Case::named("plate-512").unwrap();
//! # let case = Case { cells: vec![16, 16], ..case };
//! let result = run(&case, 3).unwrap();
//! println!("{}: {:.2} ns per directed bond", result.case, result.ns_per_bond);
//! # assert!(result.ns_per_bond > 0.0 && result.directed_bonds > 0);
//! ```

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use crate::error::Result;
use crate::family::{LANES, VolumeCorrection};
use crate::kernel::Influence;
use crate::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw, StressState,
};
use crate::operator::lanes::for_each_instruction_set;
use crate::operator::prefetch::prefetch;
use crate::operator::{BondBody, BondForm, DamageMeasure, InstructionSet};
use crate::space::{Grid, PointCloud, Shape};
use crate::system::{PointScalar, System};
use crate::time::{Integrator, State, VelocityVerlet};

/// A problem to be timed.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Name, as in the results.
    pub name: &'static str,
    /// Cells of the box along each axis; one to three.
    pub cells: Vec<usize>,
    /// Form of the operator.
    pub form: BondForm,
    /// What the loops are compiled for, if the machine has it.
    pub instruction_set: InstructionSet,
    /// Critical stretch; no case that is timed by name reaches it.
    pub critical_stretch: f64,
    /// Every point is moved off its lattice node, so that no two bonds are alike.
    pub moved: bool,
}

/// Spacing of all cases, m.
const SPACING: f64 = 1e-3;

/// Density of all cases, kg/m³.
const DENSITY: f64 = 2235.0;

impl Case {
    /// All cases that have names.
    pub fn all() -> Vec<Self> {
        let case = |name, cells: &[usize], form| Self::new(name, cells.to_vec(), form);
        let narrow = |case| Self {
            instruction_set: InstructionSet::Avx2,
            ..case
        };
        let moved = Self {
            moved: true,
            ..case("block-46-moved", &[46; 3], BondForm::List)
        };
        vec![
            case("block-46", &[46; 3], BondForm::Grid),
            narrow(case("block-46-avx2", &[46; 3], BondForm::Grid)),
            case("block-46-list", &[46; 3], BondForm::List),
            narrow(case("block-46-list-avx2", &[46; 3], BondForm::List)),
            moved,
            case("block-100", &[100; 3], BondForm::Grid),
            case("plate-512", &[512; 2], BondForm::Grid),
            case("plate-512-list", &[512; 2], BondForm::List),
            case("bar-1e6", &[1_000_000], BondForm::Grid),
        ]
    }

    /// A box of cells on its lattice, with the best instructions of the machine.
    pub fn new(name: &'static str, cells: Vec<usize>, form: BondForm) -> Self {
        Self {
            name,
            cells,
            form,
            instruction_set: InstructionSet::detect(),
            critical_stretch: 0.015,
            moved: false,
        }
    }

    /// The case of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|case| case.name == name)
    }

    /// The points.
    ///
    /// # Errors
    /// A box without or with too many cells.
    pub fn cloud(&self) -> Result<Arc<PointCloud>> {
        let size = self.cells.iter().map(|&count| count as f64 * SPACING);
        let grid = Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: size.collect(),
            },
            spacing: SPACING,
            section: if self.cells.len() == 3 { 1.0 } else { SPACING },
            holes: vec![],
        };
        let points = grid.points()?;
        if !self.moved {
            return Ok(Arc::new(points));
        }
        let moved = |(k, x): (usize, &f64)| x + 0.3 * SPACING * (1e3 * (k as f64).sin()).sin();
        Ok(Arc::new(PointCloud::new(
            points.dimension(),
            points.positions().iter().enumerate().map(moved).collect(),
            points.volumes().to_vec(),
            points.section(),
        )?))
    }

    /// Glass with a horizon of 3.015 spacings, linear partial volumes and the case's critical stretch.
    pub fn material(&self) -> BondMaterial {
        BondMaterial {
            law: PairLaw::BondStretch,
            density: DENSITY,
            modulus: Modulus {
                value: ElasticModulus::Young(65e9),
                calibration: Calibration::Continuum,
            },
            horizon: 3.015 * SPACING,
            influence: Influence::default(),
            volume_correction: VolumeCorrection::Linear,
            fracture: Fracture::CriticalStretch(self.critical_stretch),
        }
    }

    /// The body with its operator, moving smoothly.
    ///
    /// # Errors
    /// See [`Case::cloud`].
    pub fn system(&self) -> Result<(System, State)> {
        let cloud = self.cloud()?;
        let material = self.material();
        let state = match cloud.dimension() {
            1 => StressState::Uniaxial,
            2 => StressState::PlaneStrain,
            _ => StressState::Spatial,
        };
        let body = BondBody {
            cloud: &cloud,
            material: &material,
            constants: &material.constants(&cloud, state)?,
            cracks: &[],
            no_fail: &[],
            stiffness: &[],
            damage: DamageMeasure::default(),
        };
        let mut operator = body.operator(self.form)?.operator;
        operator.use_instruction_set(self.instruction_set);
        let n = cloud.len();
        let mut start = State::at_rest(n * cloud.dimension());
        for i in 0..n {
            for c in 0..cloud.dimension() {
                let wave = 300.0 * cloud.point(i)[(c + 1) % cloud.dimension()];
                start.v[c * n + i] = 0.3 * wave.sin();
            }
        }
        let system = System::new(cloud, operator, PointScalar::Uniform(DENSITY))?;
        Ok((system, start))
    }
}

/// What a case took.
#[derive(Debug, Clone, PartialEq)]
pub struct Timing {
    /// Name of the case.
    pub case: &'static str,
    /// Form of the operator.
    pub form: BondForm,
    /// What the loops are compiled for.
    pub instruction_set: InstructionSet,
    /// Points.
    pub points: usize,
    /// Entries of all families.
    pub directed_bonds: u64,
    /// Threads.
    pub threads: usize,
    /// Nanoseconds per directed bond of a full step, median over the rounds.
    pub ns_per_bond: f64,
    /// The same of the fastest round.
    pub best_ns_per_bond: f64,
    /// Nanoseconds per directed bond and thread that the roofline allows.
    pub roofline_ns: f64,
    /// Roofline time over time.
    pub roofline_fraction: f64,
    /// Traffic of a step that nothing can avoid over its time, GB/s: u, v, a read and written once, and a bit per bond.
    pub gigabytes_per_second: f64,
    /// Memory of operator, points, displacement, velocity and acceleration per point, bytes.
    pub bytes_per_point: f64,
    /// Building the operator, s.
    pub build_seconds: f64,
}

impl Timing {
    /// Directed bonds a second.
    pub fn bonds_per_second(&self) -> f64 {
        1e9 / self.ns_per_bond
    }
}

/// Steps in a round: as many as take a tenth of a second at about 1 ns per bond.
fn steps_per_round(directed_bonds: u64) -> usize {
    (100_000_000 / directed_bonds.max(1)).clamp(1, 1000) as usize
}

/// Times a case on the current thread pool in `rounds` rounds, one more for warming up, by the clock on the wall.
///
/// # Errors
/// See [`Case::cloud`].
pub fn run(case: &Case, rounds: usize) -> Result<Timing> {
    let begin = Instant::now();
    run_by_clock(case, rounds, &|| begin.elapsed().as_secs_f64())
}

/// The same by any clock that gives seconds: the process's CPU time tells more on a machine that others use too.
///
/// # Errors
/// See [`Case::cloud`].
pub fn run_by_clock(case: &Case, rounds: usize, clock: &dyn Fn() -> f64) -> Result<Timing> {
    let begin = clock();
    let (mut system, mut state) = case.system()?;
    let build_seconds = clock() - begin;
    let directed_bonds = system.operator().directed_bonds();
    let instruction_set = system.operator().instruction_set();
    let steps = steps_per_round(directed_bonds);
    let mut integrator = VelocityVerlet;
    integrator.start(&mut system, &mut state);
    let dt = 1e-7 * SPACING / 1e-3;
    let mut times = Vec::with_capacity(rounds);
    let mut fma = f64::INFINITY;
    for round in 0..=rounds {
        let begin = clock();
        for _ in 0..steps {
            let next = state.t + dt;
            integrator.step(&mut system, &mut state, next)?;
        }
        let time = (clock() - begin) / steps as f64;
        if round > 0 || rounds == 0 {
            times.push(time * 1e9 / directed_bonds as f64);
        }
        fma = fma.min(fma_seconds(instruction_set));
    }
    times.sort_by(f64::total_cmp);
    let threads = rayon::current_num_threads();
    let cloud = system.cloud();
    let (points, dimension) = (cloud.len(), cloud.dimension());
    let vectors = points * dimension * size_of::<f64>();
    let ns_per_bond = times[times.len() / 2];
    let roofline_ns = OPERATIONS * fma * 1e9 / LANES as f64 * idle_lanes(case, directed_bonds);
    let traffic = (6 * vectors) as f64 + directed_bonds as f64 / 8.0;
    let cloud_bytes = vectors + points * (size_of::<f64>() + size_of::<u32>());
    let bytes = system.operator().bytes() + 3 * vectors + cloud_bytes;
    Ok(Timing {
        case: case.name,
        form: case.form,
        instruction_set,
        points,
        directed_bonds,
        threads,
        ns_per_bond,
        best_ns_per_bond: times[0],
        roofline_ns,
        roofline_fraction: roofline_ns / (ns_per_bond * threads as f64),
        gigabytes_per_second: traffic / (ns_per_bond * directed_bonds as f64),
        bytes_per_point: bytes as f64 / points as f64,
        build_seconds,
    })
}

/// Operations per eight bonds that count as the work of a step, whatever a kernel really does.
const OPERATIONS: f64 = 28.0;

/// Lanes computed over bonds there are: rows padded to whole chunks, and full families at the boundary.
fn idle_lanes(case: &Case, directed_bonds: u64) -> f64 {
    let full = [6.0, 28.0, 122.0][case.cells.len() - 1];
    let rows: usize = case.cells[1..].iter().product();
    let places = case.cells[0].next_multiple_of(LANES) * rows;
    places as f64 * full / directed_bonds as f64
}

/// Seconds that one multiply–add of eight numbers takes where none waits for another.
///
/// Measured on twelve independent chains, more than any machine's latency times its pipes, the fastest of some rounds.
pub fn fma_seconds(set: InstructionSet) -> f64 {
    const REPEATS: usize = 20_000;
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let mut chains = [1.0; CHAINS];
        let begin = Instant::now();
        multiply_add(set, black_box(REPEATS), black_box(0.999_999), &mut chains);
        best = best.min(begin.elapsed().as_secs_f64());
        black_box(chains);
    }
    best / (REPEATS * CHAINS) as f64
}

const CHAINS: usize = 12;

#[inline(always)]
fn multiply_add_body<T: crate::operator::lanes::Lanes>(
    repeats: usize,
    factor: f64,
    chains: &mut [f64; CHAINS],
) {
    let factor = T::splat(factor);
    let mut sums = [T::splat(0.0); CHAINS];
    for k in 0..CHAINS {
        sums[k] = T::splat(chains[k] + k as f64);
    }
    for _ in 0..repeats {
        for k in 0..CHAINS {
            sums[k] = sums[k].mul_add(factor, factor);
        }
    }
    for k in 0..CHAINS {
        chains[k] = sums[k].to_array()[0];
    }
}

for_each_instruction_set! {
    /// Runs the chains.
    fn multiply_add [] <> (
        repeats: usize,
        factor: f64,
        chains: &mut [f64; CHAINS],
    ) = multiply_add_body on lanes
}

/// The sum of numbers, read as fast as the memory gives them: eight chains of eight, and lines asked for ahead. Loops over stored bonds are set against it.
pub fn read(set: InstructionSet, numbers: &[f64]) -> f64 {
    let mut sum = 0.0;
    sum_numbers(set, numbers, &mut sum);
    sum
}

#[inline(always)]
fn sum_numbers_body<T: crate::operator::lanes::Lanes>(numbers: &[f64], sum: &mut f64) {
    const AHEAD: usize = 4 * ROW;
    let mut sums = [T::splat(0.0); ROW / LANES];
    for (row, part) in numbers.chunks_exact(ROW).enumerate() {
        for k in 0..ROW / LANES {
            prefetch(numbers, row * ROW + AHEAD + k * LANES);
            sums[k] = sums[k] + T::load(part, k * LANES);
        }
    }
    for k in 0..ROW / LANES {
        for number in sums[k].to_array() {
            *sum += number;
        }
    }
    for number in numbers.chunks_exact(ROW).remainder() {
        *sum += number;
    }
}

/// Numbers in a row of [`read`].
const ROW: usize = 64;

for_each_instruction_set! {
    /// Adds the numbers up.
    fn sum_numbers [] <> (numbers: &[f64], sum: &mut f64) = sum_numbers_body on lanes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_block_is_the_one_of_the_comparison() {
        let case = Case::named("block-46").unwrap();
        let system = case.system().unwrap().0;
        assert_eq!(system.points(), 97_336);
        assert_eq!(system.operator().directed_bonds(), 11_006_544);
        // (48 · 122)/(46 · 113.08)
        assert!((idle_lanes(&case, 11_006_544) - 1.126).abs() < 1e-3);
    }

    #[test]
    fn every_number_is_read() {
        let numbers: Vec<f64> = (1..=1000).map(f64::from).collect();
        for set in InstructionSet::available() {
            assert_eq!(read(set, &numbers), 500_500.0);
        }
    }

    #[test]
    fn the_rate_of_every_set_is_measured() {
        let times: Vec<f64> = InstructionSet::available()
            .into_iter()
            .map(fma_seconds)
            .collect();
        assert!(times.iter().all(|&t| t > 0.0 && t < 1e-6), "{times:?}");
    }
}
