//! Timing of complete time steps on fixed bodies, relative to the limits of the machine.
//!
//! A case is a small problem whose bonds may break but do not. Its time is the median over several rounds of
//! velocity Verlet, per directed bond (an entry of a family: each bond counts twice) and thread. It is
//! compared with
//!
//! * the arithmetic roofline: 28 operations per eight bonds (sixteen in single precision) and pass (two
//!   passes for state-based materials) at the measured rate of independent multiply–adds of the vector width,
//!   including lanes left idle by row ends and missing bonds;
//! * the minimum memory traffic of a step, in GB/s.
//!
//! ```
//! use pericles_bench::{Case, run};
//! let case = Case::named("plate-512").unwrap();
//! # let case = Case { cells: vec![16, 16], ..case };
//! let result = run(&case, 3).unwrap();
//! println!("{}: {:.2} ns per directed bond", result.case, result.ns_per_bond);
//! # assert!(result.ns_per_bond > 0.0 && result.directed_bonds > 0);
//! ```

mod case;
mod clock;
mod machine;
mod scalar;
mod small;

use std::time::Instant;

use pericles::lanes::LANES;
use pericles::operator::{BondForm, InstructionSet};
use pericles::time::{Integrator, VelocityVerlet};
use pericles::{Interrupt, Result};

pub use case::Case;
pub use clock::cpu_seconds;
pub use machine::{fma_seconds, read};
pub use scalar::StoredList;
pub use small::{SmallBody, SmallTiming, small_bodies};

/// Timing of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Timing {
    /// Name of the case.
    pub case: String,
    /// Form of the operator, or the name of the reference loop.
    pub form: &'static str,
    /// Instruction set of the loops.
    pub instruction_set: InstructionSet,
    /// Number of points.
    pub points: usize,
    /// Number of directed bonds: entries of all families.
    pub directed_bonds: u64,
    /// Number of threads.
    pub threads: usize,
    /// Nanoseconds per directed bond of a full step, median over the rounds.
    pub ns_per_bond: f64,
    /// Nanoseconds per directed bond in the fastest round.
    pub best_ns_per_bond: f64,
    /// Nanoseconds per directed bond and thread at the roofline.
    pub roofline_ns: f64,
    /// Roofline time divided by measured time.
    pub roofline_fraction: f64,
    /// Minimum memory traffic of a step divided by its time, GB/s: u, v, a read and written once, and one bit
    /// per bond.
    pub gigabytes_per_second: f64,
    /// Memory of operator, points, displacement, velocity and acceleration per point, bytes.
    pub bytes_per_point: f64,
    /// Time to build the operator, s.
    pub build_seconds: f64,
}

impl Timing {
    /// Returns the number of directed bonds per second.
    pub fn bonds_per_second(&self) -> f64 {
        1e9 / self.ns_per_bond
    }
}

/// Returns the number of steps in a round, which takes a tenth of a second at about 1 ns per bond.
fn steps_per_round(directed_bonds: u64) -> usize {
    (100_000_000 / directed_bonds.max(1)).clamp(1, 1000) as usize
}

/// A case with its assembled body.
struct Prepared {
    step: Box<dyn FnMut() -> Result<()>>,
    form: &'static str,
    instruction_set: InstructionSet,
    points: usize,
    directed_bonds: u64,
    /// Memory of the bonds, bytes.
    bytes: usize,
}

/// A case during timing.
struct Running<'a> {
    case: &'a Case,
    prepared: Prepared,
    build_seconds: f64,
    /// Nanoseconds per directed bond of each round.
    times: Vec<f64>,
    /// Shortest measured time of a multiply–add, s.
    fma: f64,
}

/// Time step, s: far below the stable one.
const DT: f64 = 1e-7;

impl Prepared {
    fn new(case: &Case) -> Result<Self> {
        if case.scalar {
            let (mut list, mut state) = case.stored_list()?;
            return Ok(Self {
                form: "scalar",
                instruction_set: InstructionSet::Baseline,
                points: state.u.len() / case.cells.len(),
                directed_bonds: list.directed_bonds(),
                bytes: list.bytes(),
                step: Box::new(move || {
                    list.step(&mut state, DT);
                    Ok(())
                }),
            });
        }
        let (mut system, mut state) = case.system()?;
        let mut verlet = VelocityVerlet;
        verlet.start(&mut system, &mut state);
        let operator = system.operator();
        Ok(Self {
            form: case.form.name(),
            instruction_set: operator.instruction_set(),
            points: system.points(),
            directed_bonds: operator.directed_bonds(),
            bytes: operator.bytes(),
            step: Box::new(move || {
                let next = state.t + DT;
                verlet.step(&mut system, &mut state, next, Interrupt::never())
            }),
        })
    }
}

/// Times a case on the current thread pool in `rounds` rounds after one warm-up round, by wall-clock time.
///
/// # Errors
/// The same as for [`Case::cloud`].
pub fn run(case: &Case, rounds: usize) -> Result<Timing> {
    let begin = Instant::now();
    run_by_clock(case, rounds, &|| begin.elapsed().as_secs_f64())
}

/// Times a case by any clock in seconds: the CPU time of the process is more reliable on a shared machine.
///
/// # Errors
/// The same as for [`Case::cloud`].
pub fn run_by_clock(case: &Case, rounds: usize, clock: &dyn Fn() -> f64) -> Result<Timing> {
    let mut timings = run_in_turn(std::slice::from_ref(case), rounds, clock)?;
    Ok(timings.remove(0))
}

/// Times several cases alternately, round by round, so that all of them are subject to the same load.
///
/// # Errors
/// The same as for [`Case::cloud`].
pub fn run_in_turn(cases: &[Case], rounds: usize, clock: &dyn Fn() -> f64) -> Result<Vec<Timing>> {
    let mut running = cases
        .iter()
        .map(|case| Running::new(case, clock))
        .collect::<Result<Vec<_>>>()?;
    for round in 0..=rounds {
        for case in &mut running {
            let time = case.round(clock)?;
            if round > 0 || rounds == 0 {
                case.times.push(time);
            }
        }
    }
    Ok(running.into_iter().map(Running::timing).collect())
}

impl<'a> Running<'a> {
    fn new(case: &'a Case, clock: &dyn Fn() -> f64) -> Result<Self> {
        let begin = clock();
        Ok(Self {
            case,
            prepared: Prepared::new(case)?,
            build_seconds: clock() - begin,
            times: Vec::new(),
            fma: f64::INFINITY,
        })
    }

    /// Runs one round; returns nanoseconds per directed bond.
    fn round(&mut self, clock: &dyn Fn() -> f64) -> Result<f64> {
        let bonds = self.prepared.directed_bonds;
        let steps = steps_per_round(bonds);
        let begin = clock();
        for _ in 0..steps {
            (self.prepared.step)()?;
        }
        let time = (clock() - begin) / steps as f64;
        self.fma = self.fma.min(fma_seconds(self.prepared.instruction_set));
        Ok(time * 1e9 / bonds as f64)
    }

    fn timing(mut self) -> Timing {
        self.times.sort_by(f64::total_cmp);
        let (case, prepared) = (self.case, self.prepared);
        // The reference loop is serial.
        let threads = if case.scalar {
            1
        } else {
            rayon::current_num_threads()
        };
        let (points, directed_bonds) = (prepared.points, prepared.directed_bonds);
        let vectors = points * case.cells.len() * size_of::<f64>();
        let ns_per_bond = self.times[self.times.len() / 2];
        let passes = if case.state_based { 2.0 } else { 1.0 };
        let operations = passes * OPERATIONS * idle_lanes(case, directed_bonds);
        let lanes = match case.form {
            BondForm::FloatGrid => 2 * LANES,
            _ => LANES,
        };
        let roofline_ns = operations * self.fma * 1e9 / lanes as f64;
        let traffic = (6 * vectors) as f64 + directed_bonds as f64 / 8.0;
        let cloud_bytes = vectors + points * (size_of::<f64>() + size_of::<u32>());
        let bytes = prepared.bytes + 3 * vectors + cloud_bytes;
        Timing {
            case: case.name.clone(),
            form: prepared.form,
            instruction_set: prepared.instruction_set,
            points,
            directed_bonds,
            threads,
            ns_per_bond,
            best_ns_per_bond: self.times[0],
            roofline_ns,
            roofline_fraction: roofline_ns / (ns_per_bond * threads as f64),
            gigabytes_per_second: traffic / (ns_per_bond * directed_bonds as f64),
            bytes_per_point: bytes as f64 / points as f64,
            build_seconds: self.build_seconds,
        }
    }
}

/// Operations per pass and eight bonds that count as the work of a step, independent of the kernel.
const OPERATIONS: f64 = 28.0;

/// Returns the computed lanes divided by the existing bonds: rows are padded to whole chunks, and families at
/// the boundary to full size.
fn idle_lanes(case: &Case, directed_bonds: u64) -> f64 {
    let rows: usize = case.cells[1..].iter().product();
    let places = case.cells[0].next_multiple_of(LANES) * rows;
    places as f64 * case.family() / directed_bonds as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_block_case_equals_the_block_of_the_comparison_with_lammps() {
        let case = Case::named("block-46").unwrap();
        let system = case.system().unwrap().0;
        assert_eq!(system.points(), 97_336);
        assert_eq!(system.operator().directed_bonds(), 11_006_544);
        // (48 · 122)/(46 · 113.08)
        assert!((idle_lanes(&case, 11_006_544) - 1.126).abs() < 1e-3);
    }
}
