//! A custom time integrator: Nyström's method of order four for u″ = a(t, u).
//!
//! With k₁ = a(t, u), k₂ = a(t + h/2, u + h/2 v + h²/8 k₁) and k₃ = a(t + h, u + h v + h²/2 k₂) the step is
//! u ← u + h v + h²/6 (k₁ + 2 k₂), v ← v + h/6 (k₁ + 4 k₂ + k₃)
//! (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.14).
//! The integrator gets accelerations from the system and contains no physics.

use std::error::Error;

use pericles::prelude::*;

/// Work arrays of Nyström's method.
struct Nystrom {
    stage: Vec<f64>,
    k2: Vec<f64>,
    k3: Vec<f64>,
    next: [Vec<f64>; 2],
}

impl Nystrom {
    fn new(system: &System) -> Self {
        let array = || vec![0.0; system.dimension() * system.points()];
        Self {
            stage: array(),
            k2: array(),
            k3: array(),
            next: [array(), array()],
        }
    }
}

impl Integrator for Nystrom {
    fn name(&self) -> &'static str {
        "nystrom-4"
    }

    fn order(&self) -> u32 {
        4
    }

    /// The method is stable for ω h ≤ 2.58; with the highest frequency ω of the body this gives the stable step.
    fn stability_limit(&self) -> Option<f64> {
        Some(2.58)
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        _interrupt: Interrupt<'_>,
    ) -> Result<(), PericlesError> {
        let h = t_next - state.t;
        let (u, v, k1) = (&state.u, &state.v, &state.a);
        for i in 0..u.len() {
            self.stage[i] = u[i] + 0.5 * h * v[i] + h * h / 8.0 * k1[i];
        }
        system.acceleration(
            state.t + 0.5 * h,
            &self.stage,
            v,
            PointSubset::All,
            &mut self.k2,
        );
        for i in 0..u.len() {
            self.stage[i] = u[i] + h * v[i] + 0.5 * h * h * self.k2[i];
        }
        system.acceleration(t_next, &self.stage, v, PointSubset::All, &mut self.k3);
        let [u_next, v_next] = &mut self.next;
        for i in 0..u.len() {
            u_next[i] = u[i] + h * v[i] + h * h / 6.0 * (k1[i] + 2.0 * self.k2[i]);
            v_next[i] = v[i] + h / 6.0 * (k1[i] + 4.0 * self.k2[i] + self.k3[i]);
        }
        // Apply constraints; then end the step, which breaks bonds, updates the energy balance, and evaluates the
        // acceleration with which the next step starts.
        system.constrain(t_next, u_next, v_next);
        system.constrain_velocity(t_next, v_next);
        state.complete(system, &mut self.next, t_next, h);
        state.step += 1;
        Ok(())
    }
}

// The scheme has no state from step to step, so that checkpoints contain nothing of it.
saved! {
    impl Checkpointed for Nystrom {
        stage, k2, k3, next: scratch,
    }
}

/// The displacement of a vibrating bar after 20 µs, computed in `steps` steps.
fn displacement(steps: u64) -> Result<Vec<f64>, Box<dyn Error>> {
    let bar = Grid::bar(0.1, 1e-3, 1e-4).points()?;
    let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3e-3);
    let mut run = Simulation::builder(Body::new(bar, steel).build()?)
        .scheme_for(|system| Ok(Nystrom::new(system)))?
        .velocity(|[x, ..]| [(20.0 * std::f64::consts::PI * x).cos(), 0.0, 0.0])
        .dt(20e-6 / steps as f64)
        .end(20e-6)
        .build()?;
    run.run_to_end()?;
    Ok(run.state().u.clone())
}

fn main() -> Result<(), Box<dyn Error>> {
    let reference = displacement(3200)?;
    let largest = |u: &[f64]| u.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    println!("steps   error          order");
    let mut before = None;
    for steps in [100, 200, 400] {
        let u = displacement(steps)?;
        let difference: Vec<f64> = u.iter().zip(&reference).map(|(a, b)| a - b).collect();
        let error = largest(&difference) / largest(&reference);
        let order = before.map(|before: f64| (before / error).log2());
        match order {
            Some(order) => println!("{steps:5}   {error:.3e}   {order:8.2}"),
            None => println!("{steps:5}   {error:.3e}"),
        }
        if order.is_some_and(|order| (order - 4.0).abs() > 0.2) {
            return Err("the observed order is not four".into());
        }
        before = Some(error);
    }
    Ok(())
}
