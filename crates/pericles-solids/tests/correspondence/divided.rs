//! Bodies divided among processes: results and checkpoints are bitwise identical to those of a single process.

use std::sync::Arc;

use pericles::division::part_of;
use pericles::domain::{Comm, Threads};
use pericles::space::PointCloud;
use pericles::{Archive, Checkpointed, Control, Simulation};

use crate::bodies::lattice;
use crate::fracture::{BY_ENERGY, BY_STRETCH};
use crate::{fracture, plastic};

/// Bonds of three cells.
const REACH: f64 = 3.5;

/// The part of a process: oblique stripes. The last of three processes has no points of the smaller body.
fn part(whole: &Arc<PointCloud>, comm: Arc<dyn Comm>) -> Arc<PointCloud> {
    let size = comm.size();
    let owner = |k: usize| {
        let [x, y, _] = whole.point(k);
        ((x + 0.4 * y) / 20.0 * size as f64).min(size as f64 - 1.0) as u32
    };
    let owners: Vec<u32> = (0..whole.len()).map(owner).collect();
    Arc::new(part_of(whole, &owners, REACH, comm).unwrap())
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
    type Make = fn(Arc<PointCloud>) -> Simulation;
    let cases: [(&[f64], Make, u64); 3] = [
        (
            &[18.0, 16.0],
            |cloud| fracture::torn_on(cloud, 1.0, BY_STRETCH),
            30,
        ),
        (
            &[18.0, 16.0],
            |cloud| fracture::torn_on(cloud, 1.0, BY_ENERGY),
            30,
        ),
        (&[10.0, 8.0], |cloud| plastic::thrown_on(cloud, 1.0), 9),
    ];
    for (sides, make, pause) in cases {
        let whole = lattice(sides);
        let mut alone = make(whole.clone());
        let [paused, end] = [pause, alone.steps()].map(|step| proceed(&mut alone, step));
        let dissipated = alone.system().operator().dissipated();
        assert!(dissipated > 0.0, "{dissipated}");
        let divided = Threads::run(3, |comm| {
            let mut run = make(part(&whole, comm));
            let paused = proceed(&mut run, pause);
            paused.gathered(run.system().domain()).unwrap()
        });
        let gathered = divided[0].as_ref().unwrap();
        assert_eq!(gathered.differences(&paused), [""; 0]);
        let ends = Threads::run(2, |comm| {
            let first = comm.rank() == 0;
            let mut run = make(part(&whole, comm));
            let domain = run.system().domain().clone();
            let own = Archive::scattered(&saved(&run), first.then_some(gathered), &domain);
            run.restore(&own.unwrap()).unwrap();
            let steps = run.steps();
            proceed(&mut run, steps).gathered(&domain).unwrap()
        });
        assert_eq!(ends[0].as_ref().unwrap().differences(&end), [""; 0]);
    }
}
