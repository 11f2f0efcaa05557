//! A notched plate that is torn apart, divided among the processes of an MPI job or among threads:
//!
//! ```sh
//! mpirun -n 4 target/release/examples/plate
//! target/release/examples/plate --threads 4
//! ```
//!
//! The printed numbers do not depend on the number of processes, bit for bit.

use std::error::Error;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use pericles::division::{Cuts, part_by_bisection};
use pericles::domain::{Comm, Threads};
use pericles::family::{Crack, EndRule};
use pericles::material::{BondMaterial, ElasticModulus, StressState};
use pericles::operator::{BondBody, BondForm};
use pericles::space::{Grid, PointCloud};
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, PointScalar, Simulation, System};
use pericles_mpi::Mpi;

type Result<T> = std::result::Result<T, Box<dyn Error + Send + Sync>>;

const CELLS: [usize; 2] = [120, 80];
const HORIZON: f64 = 3.015;
const DENSITY: f64 = 1.0;

fn plate() -> Grid {
    Grid::plate(CELLS.map(|count| count as f64), 1.0, 1.0)
}

fn system(part: PointCloud, form: BondForm) -> Result<System> {
    let part = Arc::new(part);
    let material =
        BondMaterial::new(ElasticModulus::Young(1.0), DENSITY, HORIZON).with_critical_stretch(0.02);
    let constants = material.constants(&part, StressState::PlaneStress)?;
    let notch = Crack::Segment {
        from: [0.0, 40.0],
        to: [40.0, 40.0],
    };
    let cracks = [(notch, EndRule::Closed)];
    let body = BondBody {
        cracks: &cracks,
        ..BondBody::new(&part, &material, &constants)
    };
    let force = body.operator(form)?.operator;
    let density = PointScalar::Uniform(DENSITY);
    Ok(System::new(Arc::clone(&part), force, density)?)
}

/// Computes the part of a process; returns a report, which is the same on all processes.
fn run(comm: Arc<dyn Comm>, form: BondForm, cuts: Cuts) -> Result<String> {
    let plate = plate();
    let part = part_by_bisection(&plate.body()?, HORIZON + 0.5, cuts, Arc::clone(&comm))?;
    let system = system(part, form)?;
    let cloud = Arc::clone(system.cloud());
    let n = cloud.len();
    let mut state = State::at_rest(2 * n);
    for i in 0..n {
        state.v[n + i] = 2e-3 * (cloud.point(i)[1] - 40.0);
    }
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, 0.3, 200)?;
    run.run(|_| Control::Continue)?;
    let (system, state) = (run.system(), run.state());
    let mut damage = vec![0.0; n];
    system.operator().damage_into(&mut damage);
    let mut fingerprint = [0i128];
    for i in 0..n {
        let values = [
            state.u[i],
            state.u[n + i],
            state.v[i],
            state.v[n + i],
            damage[i],
        ];
        let mut hasher = DefaultHasher::new();
        (cloud.domain().number(i), values.map(f64::to_bits)).hash(&mut hasher);
        fingerprint[0] += i128::from(hasher.finish());
    }
    comm.sum(&mut fingerprint);
    Ok(format!(
        "broken bonds {}, kinetic energy {:e}, elastic energy {:e}, state {:032x}",
        system.operator().broken_bonds(),
        system.kinetic_energy(&state.v),
        system.operator().energy(state.t, &state.u),
        fingerprint[0]
    ))
}

/// Computes the plate by a list and by a stencil.
fn reports(comm: Arc<dyn Comm>) -> Result<Vec<String>> {
    let cases = [
        (BondForm::List, Cuts::Anywhere),
        (BondForm::Grid, Cuts::Planes),
    ];
    let reports = cases.map(|(form, cuts)| run(Arc::clone(&comm), form, cuts));
    reports.into_iter().collect()
}

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let threads = match arguments.next().as_deref() {
        Some("--threads") => arguments.next().and_then(|text| text.parse().ok()),
        _ => None,
    };
    let (rank, reports) = match threads {
        Some(count) => (0, Threads::run(count, reports).swap_remove(0)?),
        None => {
            let Some(mpi) = Mpi::start() else {
                eprintln!("MPI does not start");
                std::process::exit(1);
            };
            mpi.end_at_panics();
            let rank = mpi.rank();
            (rank, reports(Arc::new(mpi))?)
        }
    };
    if rank == 0 {
        reports.iter().for_each(|report| println!("{report}"));
    }
    Ok(())
}
