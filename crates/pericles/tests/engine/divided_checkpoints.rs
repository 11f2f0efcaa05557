//! Checkpoints of divided bodies: the archive of the whole body is bitwise identical to that of a single process, and a
//! run resumes on any number of processes.

use std::sync::Arc;

use crate::common::{listed, points};
use crate::divided_bonds::{
    Make, REACH, STATE, composite, glass, grid, list, notch, part, plate, solid,
};

use pericles::archive::Layout;
use pericles::boundary::{
    DampedSteps, DampingLayer, DampingProfile, PrescribedMotion, RayleighDamping, RayleighRates,
    TimeFunction,
};
use pericles::division::part_of;
use pericles::domain::{Comm, Threads};
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, BondStretch, FractureCalibration, GivenConstants, LinearBond, LinearSolid,
    PairLaw, Softening, SofteningLaw, StateInfluence,
};
use pericles::operator::{BondBody, BondForm, CompositeBody, Force, LinearSolidBody};
use pericles::space::{Face, PointCloud};
use pericles::time::{
    AdaptiveRungeKutta, Implicit, ImplicitRule, Integrator, Newmark, NewmarkOptions, RungeKutta,
    State, Tableau, VelocityVerlet,
};
use pericles::{
    Archive, Checkpointed, Control, PericlesError, PointScalar, Simulation, StepKind, System,
    Values,
};

const PAUSE: u64 = 20;
pub(super) const STEPS: u64 = 40;
const DT: f64 = 0.2;

pub(super) type MakeScheme = fn(&System) -> Box<dyn Integrator>;
pub(super) type Furnish = fn(&mut System);
pub(super) type Part = fn(&PointCloud, Arc<dyn Comm>) -> PointCloud;

/// A run of a plate, whole or divided.
#[derive(Clone, Copy)]
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) periodic: bool,
    /// Whether bonds break before and after the checkpoint.
    pub(super) breaks: bool,
    pub(super) force: Make,
    pub(super) furnish: Furnish,
    pub(super) scheme: MakeScheme,
}

const NOTHING: Furnish = |_| {};
const VERLET: MakeScheme = |_| Box::new(VelocityVerlet);

impl Case {
    pub(super) const fn breaking(name: &'static str, force: Make) -> Self {
        Self {
            name,
            periodic: false,
            breaks: true,
            force,
            furnish: NOTHING,
            scheme: VERLET,
        }
    }

    const fn unbroken(name: &'static str, scheme: MakeScheme) -> Self {
        Self {
            breaks: false,
            scheme,
            ..Self::breaking(name, |cloud| {
                let mut linear = glass(PairLaw::Linear);
                linear.fracture = pericles::material::Fracture::Unbreakable;
                let bonds = listed::<LinearBond, 2>(cloud, &linear, STATE, Some(notch()), &[]);
                Box::new(bonds)
            })
        }
    }

    pub(super) fn simulation(&self, cloud: PointCloud) -> Simulation {
        let cloud = Arc::new(cloud);
        let n = cloud.len();
        let force = (self.force)(&cloud);
        let mut system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
        (self.furnish)(&mut system);
        let mut state = State::at_rest(2 * n);
        for i in 0..n {
            let number = cloud.domain().number(i) as f64;
            state.v[i] = 0.02 * (number * number).sin();
            state.v[n + i] =
                0.06 * (cloud.point(i)[1] - 6.0).signum() + 0.01 * (3.0 * number).cos();
        }
        let scheme = (self.scheme)(&system);
        Simulation::new(system, scheme, state, DT, STEPS).unwrap()
    }
}

/// Two supports that overlap in no point, one of which all but one of the processes have no points of.
const SUPPORTS: Furnish = |system| {
    let cloud = system.cloud().clone();
    let top = points(&cloud, |_, y, _| y > 12.0);
    let corner = points(&cloud, |x, y, _| x < 2.0 && y < 2.0);
    let lifted = [None, Some(0.3), None];
    let lifted = PrescribedMotion::velocity(top, lifted, TimeFunction::Constant);
    system.add_motion(lifted).unwrap();
    system
        .add_motion(PrescribedMotion::fixed(corner, 2))
        .unwrap();
};

const DAMPING: Furnish = |system| {
    let profile = DampingProfile {
        thickness: 3.0,
        strength: 0.2,
        power: 2.0,
    };
    let steps = DampedSteps {
        kind: StepKind::EndOfStep,
        dt: DT,
        frequency: None,
    };
    for upper in [false, true] {
        let face = Face { axis: 0, upper };
        let layer = DampingLayer::new(system.cloud(), system.density(), face, profile, steps);
        system.add_boundary(Box::new(layer.unwrap()));
    }
    let rates = RayleighRates {
        mass: 0.01,
        stiffness: 0.02,
    };
    let masses = system.masses();
    let damping = RayleighDamping::new(rates, StepKind::EndOfStep, masses, system.domain());
    system.add_boundary(Box::new(damping.unwrap()));
};

/// A state-based solid that breaks by bond energy, which each bond accumulates.
pub(super) fn solid_of_energy(cloud: &Arc<PointCloud>) -> Box<dyn Force> {
    let material = LinearSolid {
        density: 1.0,
        elastic: GivenConstants {
            young: Some(1.0),
            poisson_ratio: Some(0.2),
            ..GivenConstants::default()
        },
        horizon: 3.0,
        influence: StateInfluence::Function(InfluenceFunction::Conical),
        volume_correction: VolumeCorrection::Extended,
        failure: BondFailure::BondEnergy {
            fracture_energy: 0.0015,
            calibration: FractureCalibration::Continuum,
        },
    };
    let constants = material.constants(cloud, STATE).unwrap();
    let body = LinearSolidBody::new(cloud, &constants, VolumeCorrection::Extended);
    body.operator(BondForm::List).unwrap().operator
}

fn softening(cloud: &Arc<PointCloud>) -> Box<dyn Force> {
    let glass = glass(PairLaw::BondStretch);
    let constants = glass.constants(cloud, STATE).unwrap();
    let softening = Softening {
        law: SofteningLaw::Linear,
        onset: 0.008,
    };
    let body = CompositeBody {
        softening: Some(softening),
        ..CompositeBody::from(BondBody::new(cloud, &glass, &constants))
    };
    body.operator(BondForm::List).unwrap().operator
}

fn cases() -> Vec<Case> {
    let list: Make = |cloud| list::<BondStretch>(PairLaw::BondStretch, cloud);
    let grid: Make = |cloud| grid::<BondStretch>(PairLaw::BondStretch, cloud);
    let furnished = |name, force, furnish| Case {
        furnish,
        ..Case::breaking(name, force)
    };
    let periodic = |name, force| Case {
        periodic: true,
        ..Case::breaking(name, force)
    };
    vec![
        Case::breaking("list", list),
        Case::breaking("stencil", grid),
        periodic("periodic list", list),
        periodic("periodic stencil", grid),
        Case::breaking("state-based list", |cloud| solid(cloud, BondForm::List)),
        Case::breaking("state-based stencil", |cloud| solid(cloud, BondForm::Grid)),
        Case::breaking("bond energies", solid_of_energy),
        Case::breaking("softening", softening),
        Case::breaking("several materials, list", |cloud| {
            composite(cloud, BondForm::List)
        }),
        Case::breaking("several materials, stencil", |cloud| {
            composite(cloud, BondForm::Grid)
        }),
        furnished("prescribed motion", list, SUPPORTS),
        furnished("damping", grid, DAMPING),
        Case {
            scheme: |system| Box::new(RungeKutta::new(&Tableau::rk4(), system)),
            ..Case::breaking("Runge–Kutta", list)
        },
        Case::unbroken("Dormand–Prince", |system| {
            Box::new(AdaptiveRungeKutta::new(1e-7, system).unwrap())
        }),
        Case::unbroken("implicit midpoint", |system| {
            Box::new(Implicit::new(ImplicitRule::Midpoint, system).unwrap())
        }),
        Case::unbroken("Newmark", |system| {
            Box::new(Newmark::new(NewmarkOptions::default(), system).unwrap())
        }),
    ]
}

fn saved(run: &Simulation) -> Archive {
    run.settle().unwrap();
    let mut archive = Archive::default();
    run.save(&mut archive);
    archive
}

/// Runs to the end of a step.
pub(super) fn proceed(run: &mut Simulation, end: u64) {
    run.run(|run| match run.state().step {
        step if step == end => Control::Stop,
        _ => Control::Continue,
    })
    .unwrap();
}

/// The checkpoints of a single process at the pause and at the end.
fn alone(case: &Case, whole: &PointCloud) -> [Archive; 2] {
    let mut run = case.simulation(whole.clone());
    [PAUSE, STEPS].map(|step| {
        proceed(&mut run, step);
        saved(&run)
    })
}

/// Each process owns a stripe; the last one of four has no points.
pub(super) fn stripes(cloud: &PointCloud, comm: Arc<dyn Comm>) -> PointCloud {
    let owner = |k: usize| {
        let [x, y, _] = cloud.point(k);
        (((x + 0.4 * y) / 9.0) as u32)
            .min(comm.size() as u32 - 1)
            .min(2)
    };
    let owners: Vec<u32> = (0..cloud.len()).map(owner).collect();
    part_of(cloud, &owners, REACH, comm).unwrap()
}

/// The whole archive at the end of a run that several processes resume.
fn resumed(case: &Case, whole: &PointCloud, paused: &Archive, size: usize, part: Part) -> Archive {
    let ends = Threads::run(size, |comm| {
        let first = comm.rank() == 0;
        let mut run = case.simulation(part(whole, comm));
        let domain = run.system().domain().clone();
        let own = Archive::scattered(&saved(&run), first.then_some(paused), &domain).unwrap();
        run.restore(&own).unwrap();
        let again = saved(&run).gathered(&domain).unwrap();
        if let Some(again) = again {
            assert_eq!(again.differences(paused), [""; 0], "{}", case.name);
        }
        proceed(&mut run, STEPS);
        saved(&run).gathered(&domain).unwrap()
    });
    assert!(ends[1..].iter().all(Option::is_none));
    ends.into_iter().flatten().next().unwrap()
}

fn broken(archive: &Archive) -> u64 {
    let counts = archive.arrays().iter();
    let counts = counts.filter(|(name, _)| name.ends_with("/broken"));
    counts
        .map(|(_, values)| match values {
            Values::U64(counts) => counts.iter().sum(),
            _ => 0,
        })
        .sum()
}

#[test]
fn checkpoints_do_not_depend_on_the_division() {
    check(&cases());
}

/// Checks runs on a single process, on several, and those that another number of processes resumes.
pub(super) fn check(cases: &[Case]) {
    for case in cases {
        let whole = plate(case.periodic);
        let [paused, end] = alone(case, &whole);
        if case.breaks {
            let [paused, end] = [&paused, &end].map(broken);
            let name = case.name;
            assert!(paused > 20 && end > paused + 20, "{name}: {paused}, {end}");
        }
        let archives = Threads::run(3, |comm| {
            let mut run = case.simulation(part(&whole, comm));
            proceed(&mut run, PAUSE);
            let own = saved(&run);
            let gathered = own.clone().gathered(run.system().domain()).unwrap();
            (own, gathered)
        });
        for (own, _) in &archives {
            for (name, values) in archives[0].0.arrays() {
                let shared = own.layout(name) == &Layout::Shared;
                let equal = own.arrays().get(name) == Some(values);
                assert!(!shared || equal, "{}: {name}", case.name);
            }
        }
        assert!(archives[1..].iter().all(|(_, gathered)| gathered.is_none()));
        let gathered = archives[0].1.as_ref().unwrap();
        assert_eq!(gathered.differences(&paused), [""; 0], "{}", case.name);
        let mut single = case.simulation(whole.clone());
        single.restore(gathered).unwrap();
        proceed(&mut single, STEPS);
        assert_eq!(saved(&single).differences(&end), [""; 0], "{}", case.name);
        for (size, part) in [(1, part as Part), (2, part), (4, part), (4, stripes)] {
            let found = resumed(case, &whole, gathered, size, part);
            let differences = found.differences(&end);
            assert_eq!(differences, [""; 0], "{}, {size} processes", case.name);
        }
    }
}

/// No process waits for another one.
#[test]
fn archives_of_other_bodies_are_errors_on_all_processes() {
    let case = &cases()[10];
    let whole = plate(false);
    let [paused, _] = alone(case, &whole);
    type Spoil = (&'static str, fn(&mut Archive));
    let spoilt: [Spoil; 5] = [
        ("\"state/u\" has 1 entries", |archive| {
            archive.put("state/u", Values::F64(vec![0.0]));
        }),
        ("\"operator/intact\" is missing", |archive| {
            archive.put("operator/intact", Values::F64(vec![0.0]));
        }),
        ("\"operator/broken\" has 3 entries", |archive| {
            archive.put("operator/broken", Values::U64(vec![0; 3]));
        }),
        ("\"motion/0/reaction\" has 0 entries", |archive| {
            archive.put("motion/0/reaction", Values::F64(Vec::new()));
        }),
        ("is missing", |archive| *archive = Archive::default()),
    ];
    for (reason, spoil) in spoilt {
        let mut spoilt = paused.clone();
        spoil(&mut spoilt);
        let errors = Threads::run(3, |comm| {
            let first = comm.rank() == 0;
            let run = case.simulation(part(&whole, comm));
            let domain = run.system().domain();
            let own = Archive::scattered(&saved(&run), first.then_some(&spoilt), domain);
            own.map(|_| ()).unwrap_err()
        });
        assert!(errors[0].to_string().contains(reason), "{}", errors[0]);
        for error in &errors[1..] {
            assert!(matches!(error, PericlesError::OnAnotherProcess), "{error}");
        }
    }
    let errors = Threads::run(2, |comm| {
        let run = case.simulation(part(&whole, comm));
        let own = Archive::scattered(&saved(&run), None, run.system().domain());
        own.map(|_| ()).unwrap_err()
    });
    assert!(
        errors[0].to_string().contains("no archive"),
        "{}",
        errors[0]
    );
}
