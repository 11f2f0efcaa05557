//! Inelastic bodies divided among processes: results and checkpoints are bitwise identical to those of a single process.

use std::sync::Arc;

use pericles::division::part_of;
use pericles::domain::{Comm, Threads};
use pericles::kernel::InfluenceFunction;
use pericles::material::Strains;
use pericles::space::PointCloud;
use pericles::{Archive, Checkpointed, Control, Simulation};

use crate::bodies::jittered;
use crate::runs::{BREAKING, laws, plate_on, verlet};

/// The part of a process: stripes across the body.
fn part(whole: &Arc<PointCloud>, comm: Arc<dyn Comm>) -> Arc<PointCloud> {
    let size = comm.size();
    let owner = |k: usize| {
        let [x, y, _] = whole.point(k);
        ((x + 0.3 * y) / 17.0 * size as f64).min(size as f64 - 1.0) as u32
    };
    let owners: Vec<u32> = (0..whole.len()).map(owner).collect();
    Arc::new(part_of(whole, &owners, 2.5, comm).unwrap())
}

fn saved(run: &Simulation) -> Archive {
    let mut archive = Archive::default();
    run.save(&mut archive);
    archive
}

fn proceed(run: &mut Simulation, end: u64) -> Archive {
    run.run(|run| match run.state().step {
        step if step == end => Control::Stop,
        _ => Control::Continue,
    })
    .unwrap();
    saved(run)
}

#[test]
fn states_and_checkpoints_do_not_depend_on_the_division() {
    for law in laws() {
        let make = |cloud: Arc<PointCloud>| {
            let function = InfluenceFunction::Conical;
            plate_on(
                cloud,
                &law,
                function,
                Strains::Finite,
                BREAKING,
                verlet,
                0.15,
                0.05,
            )
        };
        let (whole, pause) = (jittered(&[14, 10]), 20);
        let mut alone = make(whole.clone());
        let [paused, end] = [pause, alone.steps()].map(|step| proceed(&mut alone, step));
        let operator = alone.system().operator();
        assert!(
            operator.dissipated() > 0.0 && operator.broken_bonds() > 50,
            "{law:?}"
        );
        let divided = Threads::run(3, |comm| {
            let mut run = make(part(&whole, comm));
            let paused = proceed(&mut run, pause);
            paused.gathered(run.system().domain()).unwrap()
        });
        let gathered = divided[0].as_ref().unwrap();
        assert_eq!(gathered.differences(&paused), [""; 0], "{law:?}");
        let ends = Threads::run(2, |comm| {
            let first = comm.rank() == 0;
            let mut run = make(part(&whole, comm));
            let domain = run.system().domain().clone();
            let own = Archive::scattered(&saved(&run), first.then_some(gathered), &domain);
            run.restore(&own.unwrap()).unwrap();
            let steps = run.steps();
            proceed(&mut run, steps).gathered(&domain).unwrap()
        });
        assert_eq!(
            ends[0].as_ref().unwrap().differences(&end),
            [""; 0],
            "{law:?}"
        );
    }
}
