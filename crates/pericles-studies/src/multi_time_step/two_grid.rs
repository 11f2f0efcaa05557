//! A body with smaller cells, and a smaller horizon, in its middle: what the interface does to a uniform strain, what is conserved, and what two time steps save.

use pericles::Control;
use pericles::operator::On;
use pericles::solve::{SolveLimits, Work, conjugate_gradient};
use pericles::time::highest_frequency;
use pericles_deck::Deck;
use pericles_run::Assembly;
use pericles_run::RunError;

use super::problem::{Method, PAPER, Problem, problem};
use super::turns::{Bench, Turns};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(crate) const STUDY: Study = Study {
    id: "multi-time-step/two-grid",
    paper: PAPER,
    title: "A body on two grids: patch test, conservation, time",
    run,
};

const RATIO: u32 = 3;
const STRAIN: f64 = 1e-4;

fn plate() -> Problem {
    problem!("two-grid.toml")
}

fn run(_: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    for cells in [1, 2] {
        rows.extend(patch_test(cells)?);
    }
    rows.extend(frequencies()?);
    rows.extend(conservation()?);
    rows.extend(speed()?);
    Ok(rows)
}

/// Whether a point lies further from the edges of its grid's part, and of the body, than a horizon of the large cells.
struct Places {
    interface: Vec<bool>,
    surface: Vec<bool>,
}

impl Places {
    fn of(assembly: &Assembly, deck: &Deck) -> Self {
        let (cloud, horizon) = (&assembly.cloud, deck.model.body.horizon());
        let [low, high] = cloud.bounds();
        // The part with smaller cells is a box in the middle: its border is found from the cells themselves.
        let small = |i: usize| cloud.cell_size(i) < 0.9 * cloud.spacing();
        let span = |c: usize| {
            (0..cloud.len()).filter(|&i| small(i)).fold(
                [f64::INFINITY, f64::NEG_INFINITY],
                |[least, most], i| {
                    let (x, half) = (cloud.point(i)[c], 0.5 * cloud.cell_size(i));
                    [least.min(x - half), most.max(x + half)]
                },
            )
        };
        let parts = [span(0), span(1)];
        let near = |x: f64, edge: f64| (x - edge).abs() < 1.2 * horizon;
        let places = |test: &dyn Fn([f64; 3]) -> bool| {
            (0..cloud.len()).map(|i| test(cloud.point(i))).collect()
        };
        Self {
            interface: places(&|x| {
                let inside = |c: usize| {
                    x[c] > parts[c][0] - 1.2 * horizon && x[c] < parts[c][1] + 1.2 * horizon
                };
                inside(0)
                    && inside(1)
                    && (0..2).any(|c| near(x[c], parts[c][0]) || near(x[c], parts[c][1]))
            }),
            surface: places(&|x| (0..2).any(|c| near(x[c], low[c]) || near(x[c], high[c]))),
        }
    }
}

/// A uniform strain: the force it leaves, and the displacement that is in balance with the border held to it.
fn patch_test(finer: u32) -> Result<Vec<Row>, RunError> {
    let spacing = 4e-3 / f64::from(finer);
    let changes = [format!("body.spacing={spacing:?}")];
    let deck = Deck::parse(plate().text, plate().file, &changes)?;
    let assembly = plate().assembly(Method::Verlet, &changes)?;
    let places = Places::of(&assembly, &deck);
    let (cloud, system) = (&assembly.cloud, &assembly.system);
    let n = cloud.len();
    let mut strained = vec![0.0; 2 * n];
    for i in 0..n {
        strained[i] = STRAIN * cloud.point(i)[0];
    }
    let mut force = vec![0.0; 2 * n];
    system
        .operator()
        .add_force(0.0, &strained, On::All, &mut force);
    // The force density over E e/δ, what a free surface would be pulled with.
    let young = assembly.constants.as_ref().map_or(f64::NAN, |c| c.young());
    let scale = young * STRAIN / deck.model.body.horizon();
    let largest = |of: &dyn Fn(usize) -> bool| {
        (0..n)
            .filter(|&i| of(i))
            .map(|i| force[i].hypot(force[n + i]) / scale)
            .fold(0.0, f64::max)
    };
    let inside = largest(&|i| !places.interface[i] && !places.surface[i]);
    let interface = largest(&|i| places.interface[i] && !places.surface[i]);
    let surface = largest(&|i| places.surface[i]);
    let error = balanced_error(&assembly, &strained, &places)?;
    let name = format!("spacing {} mm", 1e3 * spacing);
    Ok(vec![
        Row::new(
            format!("{name}: spurious force inside the grids over E e/δ"),
            "",
            Some(inside),
        )
        .within(0.0, 1e-9),
        Row::new(
            format!("{name}: spurious force at the interface over E e/δ"),
            "",
            Some(interface),
        )
        .note("a point at the interface sees large cells on one side and small ones on the other"),
        Row::new(
            format!("{name}: force at a free surface over E e/δ"),
            "",
            Some(surface),
        ),
        Row::new(
            format!("{name}: largest error of the displacement in balance over e L"),
            "",
            Some(error),
        ),
    ])
}

/// max |u − u_strained| over e L, where K u = 0 with the points near the border held at the uniform strain.
fn balanced_error(assembly: &Assembly, strained: &[f64], places: &Places) -> Result<f64, RunError> {
    let system = &assembly.system;
    let n = system.points();
    let volumes = system.cloud().volumes();
    let held = |entry: usize| places.surface[entry % n];
    // −V f is symmetric and positive: both ends of a bond take the volumes' product.
    let stiffness = |u: &[f64], out: &mut [f64]| {
        out.fill(0.0);
        system.operator().add_force(0.0, u, On::All, out);
        for (entry, x) in out.iter_mut().enumerate() {
            *x *= if held(entry) {
                0.0
            } else {
                -volumes[entry % n]
            };
        }
    };
    let mut right = vec![0.0; 2 * n];
    stiffness(strained, &mut right);
    right.iter_mut().for_each(|x| *x = -*x);
    let mut correction = vec![0.0; 2 * n];
    let limits = SolveLimits {
        relative: 1e-10,
        iterations: 5000,
        ..SolveLimits::default()
    };
    conjugate_gradient(
        &mut |x, out| stiffness(x, out),
        &right,
        &mut correction,
        &limits,
        &mut Work::new(2 * n),
    )?;
    let [low, high] = system.cloud().bounds();
    let most = correction
        .iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    Ok(most / (STRAIN * (high[0] - low[0])))
}

/// How much shorter the stable step of the small cells is.
fn frequencies() -> Result<Vec<Row>, RunError> {
    let assembly = plate().assembly(Method::Respa(RATIO), &[])?;
    let whole = highest_frequency(&assembly.system, &assembly.state.u)?.estimate;
    let coarse = assembly.frequency.map(|frequency| frequency.estimate);
    Ok(vec![
        Row::new(
            "highest frequency of the body over that which limits the coarse step",
            "",
            coarse.map(|coarse| whole / coarse),
        )
        .within_share(f64::from(RATIO), 0.15)
        .note("the frequency goes with one over the horizon"),
    ])
}

/// A free body: momentum to round-off, energy within bounds.
fn conservation() -> Result<Vec<Row>, RunError> {
    const STEPS: u64 = 2000;
    let mut assembly = plate().assembly(Method::Respa(RATIO), &[])?;
    for (k, v) in assembly.state.v.iter_mut().enumerate() {
        *v = 1.0 + ((k * k) as f64).sin();
    }
    assembly.steps = STEPS;
    // Half the stable step.
    assembly.dt *= 0.5;
    let momentum = assembly.system.momentum(&assembly.state.v);
    let mut run = assembly.simulation()?;
    let at_start = run.start_energy().energy;
    let mut worst = [0.0f64; 2];
    run.run(|run| {
        if run.state().step.is_multiple_of(10) {
            let energies = run.snapshot().energies();
            let change = (energies.kinetic + energies.elastic) / at_start - 1.0;
            let half = usize::from(2 * run.state().step > STEPS);
            worst[half] = worst[half].max(change.abs());
        }
        Control::Continue
    })
    .map_err(|error| RunError::of_run(error, || "the study stopped there".into()))?;
    let system = run.system();
    let after = system.momentum(&run.state().v);
    let apart = (0..3)
        .map(|c| (after[c] - momentum[c]).powi(2))
        .sum::<f64>()
        .sqrt();
    let size = momentum.iter().map(|p| p * p).sum::<f64>().sqrt();
    Ok(vec![
        Row::new("free body, r-RESPA: change of momentum over momentum", "", Some(apart / size))
            .within(0.0, 1e-12),
        Row::new(
            "free body, r-RESPA: largest change of energy in the second half over that in the first",
            "",
            Some(worst[1] / worst[0]),
        )
        .within(0.55, 0.55),
    ])
}

fn speed() -> Result<Vec<Row>, RunError> {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    one.install(|| {
        let assembly = plate().assembly(Method::Respa(RATIO), &[])?;
        let mut bench = Bench::new(&plate())?;
        bench.dt = assembly.dt;
        let Some((_, fine)) = assembly.sets.iter().find(|(name, _)| name == "fine") else {
            return Ok(Vec::new());
        };
        let turns = Turns::take(&mut bench, RATIO, fine, [5, 10])?;
        let cells = assembly.cloud.len() as f64;
        let large = assembly.cloud.spacing();
        let [low, high] = assembly.cloud.bounds();
        let everywhere =
            (high[0] - low[0]) * (high[1] - low[1]) / (large / f64::from(RATIO)).powi(2);
        Ok(vec![
            Row::new(
                "fraction of points with the fine step",
                "",
                Some(fine.len() as f64 / cells),
            ),
            Row::new(
                "r-RESPA: speed-up against velocity Verlet with the fine step, on the same points",
                "",
                Some(turns.verlet / turns.respa),
            )
            .note("by the clock, one thread, in turns"),
            Row::new(
                "points of the body with small cells everywhere over those of two grids",
                "",
                Some(everywhere / cells),
            ),
        ])
    })
}
