//! Checkpoints restore runs completely; incomplete checkpoints are detected.

use crate::common::{boxed, listed, material, system};
use crate::implicit::{
    Action, MakeScheme, discrete_gradient, from_rest, loaded, newmark, rule, torn,
};
use pericles::family::VolumeCorrection;
use pericles::material::{Fracture, LinearBond, StressState};
use pericles::round_trip::{Incomplete, check_resume};
use pericles::time::{
    AdaptiveRungeKutta, Damping, Implicit, ImplicitRule, InnerSolver, Integrator, LinearSolver,
    Relaxation, RelaxationOptions, RungeKutta, State, Tableau, VelocityVerlet,
};
use pericles::{
    Archive, Checkpointed, Interrupt, Result, Simulation, StepKind, StopCondition, StopWhen, System,
};

fn resumes(scheme: &MakeScheme, dt: f64, action: Action) {
    let make = || from_rest(loaded(action), scheme, dt, 12);
    let name = make().integrator().name();
    let checked = check_resume(make, [5]);
    assert!(
        checked.is_ok(),
        "{name}, {action:?}: {}",
        checked.unwrap_err()
    );
}

#[test]
fn resumed_runs_of_every_scheme_are_bitwise_identical() {
    // Schemes with their steps, s.
    let schemes: [(Box<MakeScheme>, f64); 8] = [
        (Box::new(|_| Box::new(VelocityVerlet)), 4e-8),
        (
            Box::new(|body| Box::new(RungeKutta::new(&Tableau::rk4(), body))),
            4e-8,
        ),
        (
            Box::new(|body| Box::new(AdaptiveRungeKutta::new(1e-6, body).unwrap())),
            1e-6,
        ),
        (rule(ImplicitRule::Midpoint), 4e-8),
        (rule(ImplicitRule::Trapezoidal), 4e-8),
        (newmark(InnerSolver::FixedPoint), 4e-8),
        (newmark(InnerSolver::Anderson { depth: 3 }), 4e-8),
        (newmark(InnerSolver::NewtonKrylov), 4e-8),
    ];
    for (scheme, dt) in &schemes {
        resumes(&**scheme, *dt, Action::Ramp);
        resumes(&**scheme, *dt, Action::Support);
    }
    // Its energy balance requires bodies without constraints.
    resumes(&*discrete_gradient(), 4e-8, Action::Ramp);
}

#[test]
fn direct_solver_factorises_for_the_same_step_after_a_resume() {
    let make = || {
        let cloud = boxed([0.0; 3], &[0.04], 1e-3, 1e-6);
        let steel = material(
            7850.0,
            210e9,
            3e-3,
            VolumeCorrection::Extended,
            Fracture::Unbreakable,
        );
        let force = listed::<LinearBond, 1>(&cloud, &steel, StressState::Uniaxial, None, &[]);
        let body = system(&cloud, force, 7850.0);
        let rule = ImplicitRule::Midpoint;
        let scheme = Implicit::with_solver(rule, LinearSolver::Direct, &body).unwrap();
        let mut state = State::at_rest(cloud.len());
        state.v[..10].fill(1.0);
        // Differences of rounded times vary in their last digits.
        Simulation::new(body, Box::new(scheme), state, 1e-6 * (0.1 + 1.0 / 3.0), 20).unwrap()
    };
    check_resume(make, [7]).unwrap();
}

#[test]
fn adaptive_dynamic_relaxation_with_stop_conditions_resumes() {
    relaxation_resumes(Damping::Adaptive);
}

#[test]
fn fire_with_stop_conditions_resumes() {
    relaxation_resumes(Damping::Fire);
}

fn relaxation_resumes(damping: Damping) {
    let make = || {
        let body = torn();
        let points = body.motions()[1].points.clone();
        let relaxation = move |body: &System| -> Box<dyn Integrator> {
            let options = RelaxationOptions {
                damping,
                ..RelaxationOptions::default()
            };
            Box::new(Relaxation::new(options, body).unwrap())
        };
        let mut run = from_rest(body, &relaxation, 0.125, 8);
        let reaction = StopCondition::ReactionBelow {
            share: 1e-9,
            motions: vec![1],
        };
        let damage = StopCondition::DamageAbove {
            damage: 0.99,
            points,
        };
        run.stop_when(StopWhen::new("right".into(), reaction))
            .unwrap();
        run.stop_when(StopWhen::new("right".into(), damage))
            .unwrap();
        run
    };
    let end = check_resume(make, [3]).unwrap();
    assert!(end.f64s("stop/peaks").unwrap()[0] > 0.0);
    assert!(end.u64s("operator/broken").unwrap().iter().sum::<u64>() > 0);
}

/// Treatment of the state by a scheme.
#[derive(Clone, Copy)]
enum Memory {
    Complete,
    /// It is saved but not restored.
    SavedOnly,
    Forgotten,
}

/// Velocity Verlet with a drag that grows from step to step, starting at a given step.
struct Ageing {
    memory: Memory,
    from: u64,
    drag: f64,
}

impl Integrator for Ageing {
    fn name(&self) -> &'static str {
        "ageing"
    }

    fn step_kind(&self) -> StepKind {
        VelocityVerlet.step_kind()
    }

    fn order(&self) -> u32 {
        1
    }

    fn stability_limit(&self) -> Option<f64> {
        VelocityVerlet.stability_limit()
    }

    fn start(&mut self, system: &mut System, state: &mut State) {
        VelocityVerlet.start(system, state);
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        VelocityVerlet.step(system, state, t_next, interrupt)?;
        if state.step > self.from {
            self.drag += 1e-3;
        }
        state.v.iter_mut().for_each(|v| *v *= 1.0 - self.drag);
        Ok(())
    }
}

impl Checkpointed for Ageing {
    fn save(&self, archive: &mut Archive) {
        if !matches!(self.memory, Memory::Forgotten) {
            archive.put("ageing/drag", pericles::Values::F64(vec![self.drag]));
        }
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        match self.memory {
            Memory::Complete => {
                archive.f64_into("ageing/drag", std::slice::from_mut(&mut self.drag))
            }
            Memory::SavedOnly | Memory::Forgotten => Ok(()),
        }
    }
}

#[test]
fn an_incomplete_checkpoint_is_detected() {
    let check = |memory, from| {
        let make = || {
            let scheme = move |_: &System| -> Box<dyn Integrator> {
                Box::new(Ageing {
                    memory,
                    from,
                    drag: 0.0,
                })
            };
            from_rest(loaded(Action::Ramp), &scheme, 4e-8, 20)
        };
        check_resume(make, [10])
    };
    check(Memory::Complete, 0).unwrap();
    let wrong = check(Memory::SavedOnly, 0).unwrap_err();
    assert!(
        matches!(&wrong, Incomplete::Restored { arrays } if arrays == &["ageing/drag"]),
        "{wrong}"
    );
    let wrong = check(Memory::Forgotten, 0).unwrap_err();
    let moved = |arrays: &[String]| {
        ["state/u", "state/v"]
            .iter()
            .all(|&name| arrays.iter().any(|array| array == name))
    };
    assert!(
        matches!(&wrong, Incomplete::Resumed { arrays } if moved(arrays)),
        "{wrong}"
    );
    // A new run has the right drag by chance; the run that is reset has not.
    let wrong = check(Memory::Forgotten, 15).unwrap_err();
    assert!(
        matches!(&wrong, Incomplete::TakenBack { arrays } if moved(arrays)),
        "{wrong}"
    );
}
