//! Cost of contact: CPU time of one thread per point and step, forms in alternation, medians.
//!
//! `cargo bench -p pericles-contact --bench contact [CELLS]` measures a block of glass with CELLS³ points (default 46): intact, with and
//! without contact between its points, and as debris without bonds.
//! `impact NX NZ STEPS` prints one line of JSON for the plate of `benches/lammps/in.impact`, struck by a rigid ball.

use std::sync::Arc;

use pericles::boundary::{MotionKind, TimeFunction};
use pericles::operator::BondForm;
use pericles::space::PointCloud;
use pericles::time::{Integrator, State, VelocityVerlet};
use pericles::{Interrupt, Result, System};
use pericles_bench::{Case, cpu_seconds};
use pericles_contact::{
    ContactBodies, ContactLaw, Impactor, ImpactorMotion, PointContact, Pose, Shape,
};

const ROUNDS: usize = 9;
/// Steps per round.
const STEPS: u64 = 20;
const YOUNG: f64 = 65e9;
/// Time step, s.
const DT: f64 = 1e-7;

fn bodies(cloud: &PointCloud, case: &Case) -> ContactBodies {
    let material = case.material();
    ContactBodies::uniform(cloud.len(), YOUNG, material.horizon, material.density)
}

/// A body and its time integration.
struct Body {
    system: System,
    state: State,
}

impl Body {
    fn new(case: &Case, state: Option<State>, contact: bool) -> Result<Self> {
        let (mut system, moving) = case.system()?;
        if contact {
            let cloud = Arc::clone(system.cloud());
            let bodies = bodies(&cloud, case);
            let contact = PointContact::new(cloud, ContactLaw::default(), bodies)?;
            system.add_interaction(Box::new(contact))?;
        }
        let mut state = state.unwrap_or(moving);
        VelocityVerlet.start(&mut system, &mut state);
        Ok(Self { system, state })
    }

    fn step(&mut self) -> Result<()> {
        let t = self.state.t + DT;
        VelocityVerlet.step(&mut self.system, &mut self.state, t, Interrupt::never())
    }

    /// CPU time per point and step, ns.
    fn time(&mut self) -> Result<f64> {
        let start = cpu_seconds();
        (0..STEPS).try_for_each(|_| self.step())?;
        let count = STEPS as f64 * self.system.points() as f64;
        Ok(1e9 * (cpu_seconds() - start) / count)
    }

    fn searches(&self) -> u64 {
        let mut all = self.system.interactions();
        let contact = all.find_map(|one| one.downcast_ref::<PointContact>());
        contact.map_or(0, |contact| contact.report().searches)
    }

    fn pairs(&self) -> u64 {
        let mut all = self.system.interactions();
        let contact = all.find_map(|one| one.downcast_ref::<PointContact>());
        contact.map_or(0, |contact| contact.report().pairs)
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Displaces the points of a lattice at random, so that about half of the six nearest pairs overlap, by up to `overlap`
/// spacings in each direction, with random velocities of 3 m/s.
fn debris(cloud: &PointCloud, overlap: f64) -> State {
    let mut state = State::at_rest(cloud.positions().len());
    let spacing = cloud.spacing();
    for k in 0..state.u.len() {
        state.u[k] = 0.5 * overlap * spacing * (1e3 * (k as f64).sin()).sin();
        state.v[k] = 3.0 * (1e3 * (k as f64).cos()).sin();
    }
    state
}

/// A body without bonds, with or without contact.
fn loose(case: &Case, overlap: f64, contact: bool) -> Result<Body> {
    let cloud = case.cloud()?;
    // Every bond breaks in the first step.
    let broken = Case {
        critical_stretch: 1e-9,
        ..case.clone()
    };
    let mut pulled = State::at_rest(cloud.positions().len());
    for (u, x) in pulled.u.iter_mut().zip(cloud.positions()) {
        *u = 0.01 * x;
    }
    let mut body = Body::new(&broken, Some(pulled), false)?;
    body.step()?;
    if contact {
        let bodies = bodies(&cloud, &broken);
        let contact = PointContact::new(cloud.clone(), ContactLaw::default(), bodies)?;
        body.system.add_interaction(Box::new(contact))?;
    }
    body.state = debris(&cloud, overlap);
    VelocityVerlet.start(&mut body.system, &mut body.state);
    Ok(body)
}

/// Prints the cost of contact in an intact block, and in debris whose points overlap by a few thousandths of the spacing,
/// a few times the stretch at which glass breaks, or by a few hundredths, which drives them apart at more than 100 m/s.
fn block(cells: usize) -> Result<()> {
    let case = Case::new("intact", vec![cells; 3], BondForm::Grid);
    let (slow, fast) = (0.006, 0.06);
    let mut all = [
        ("intact, no contact", Body::new(&case, None, false)?),
        ("intact, contact", Body::new(&case, None, true)?),
        ("debris, no contact", loose(&case, slow, false)?),
        ("debris, contact", loose(&case, slow, true)?),
        ("fast debris, contact", loose(&case, fast, true)?),
    ];
    let mut times = [const { Vec::new() }; 5];
    // Touches all memory once.
    for (_, body) in &mut all {
        body.time()?;
    }
    for _ in 0..ROUNDS {
        for ((_, body), times) in all.iter_mut().zip(&mut times) {
            times.push(body.time()?);
        }
    }
    for ((name, body), times) in all.iter().zip(&times) {
        println!(
            "{name:20} {:8.2} ns per point and step, {} pairs in contact, {} searches",
            median(times.clone()),
            body.pairs(),
            body.searches()
        );
    }
    // Medians of the differences within a round, in which the load of the machine changes least.
    let of_step = |with: usize, without: usize| {
        let each = (0..ROUNDS).map(|k| (times[with][k] - times[without][k]) / times[0][k]);
        100.0 * median(each.collect())
    };
    println!(
        "contact in per cent of a step of the intact block: {:.1} intact, {:.0} in debris, {:.0} in fast debris",
        of_step(1, 0),
        of_step(3, 2),
        of_step(4, 2)
    );
    Ok(())
}

/// A plate of glass struck by a rigid ball of radius 8 spacings and 100 m/s.
fn impact(nx: usize, nz: usize, steps: usize) -> Result<()> {
    const RADIUS: f64 = 8e-3;
    const SPEED: f64 = 100.0;
    let case = Case {
        // √(5 G/(9 K δ)) with G = 200 J/m² and K = E/1.5.
        critical_stretch: (5.0 * 200.0 / (9.0 * YOUNG / 1.5 * 3.015e-3)).sqrt(),
        ..Case::new("impact", vec![nx, nx, nz], BondForm::Grid)
    };
    let cloud = case.cloud()?;
    let state = State::at_rest(cloud.positions().len());
    let mut body = Body::new(&case, Some(state), true)?;
    let bonds = body.system.operator().directed_bonds();
    let centre = |cells: usize| 0.5 * cells as f64 * cloud.spacing();
    let top = nz as f64 * cloud.spacing();
    let motion = ImpactorMotion::Prescribed {
        kind: MotionKind::Velocity,
        amplitude: [0.0, 0.0, -SPEED],
        function: TimeFunction::Constant,
    };
    let ball = Impactor::new(
        "ball",
        Shape::Ball { radius: RADIUS },
        Pose::at([centre(nx), centre(nx), top + RADIUS]),
        motion,
        Arc::clone(&cloud),
        ContactLaw::default(),
        bodies(&cloud, &case),
    )?;
    body.system.add_interaction(Box::new(ball))?;
    VelocityVerlet.start(&mut body.system, &mut body.state);
    let start = cpu_seconds();
    (0..steps).try_for_each(|_| body.step())?;
    let time = (cpu_seconds() - start) / steps as f64;
    let mut damage = vec![0.0; cloud.len()];
    body.system.operator().damage_into(&mut damage);
    println!(
        "{{\"directed_bonds\":{bonds},\"cpu_ns\":{},\"damage\":{},\"pairs\":{},\"searches\":{}}}",
        1e9 * time / bonds as f64,
        damage.iter().sum::<f64>() / cloud.len() as f64,
        body.pairs(),
        body.searches()
    );
    Ok(())
}

fn main() -> Result<()> {
    // Cargo adds --bench.
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    let number = |k: usize, default: usize| {
        let word = words.get(k).and_then(|word| word.parse().ok());
        word.unwrap_or(default)
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let work = || match words.first().map(String::as_str) {
        Some("impact") => impact(number(1, 40), number(2, 16), number(3, 400)),
        _ => block(number(0, 46)),
    };
    pool.map_or_else(|_| work(), |pool| pool.install(work))
}
