//! The bound of the energy of a body under loads that change.

use pericles::observe::Snapshot;

/// e(t) ≤ e(0) exp(νt) + 1/(2ν) ∫₀ᵗ exp(ν(t−s)) ‖b(s)‖² ds with ‖b‖² = Σ V |b|²/ρ (W): what kinetic plus elastic energy e (J) cannot exceed, for any rate ν > 0 (1/s).
///
/// From de/dt = Σ V b·v ≤ ‖b‖²/(2ν) + ν e_kin and Gronwall's lemma. It holds for any elastic forces, breaking bonds and fixed supports; moving supports do work that it does not know. A scheme
/// that breaks it makes energy. The bound is least for ν of about one over the time that has passed. The integral is Gauss's rule with three nodes between the states that are shown, so that jumps of
/// a load should be rare between them.
///
/// Source: the energy inequality of Coclite, Fanizzi, Lopez, Maddalena & Pellegrino, Appl. Numer. Math. 155 (2020), whose left side carries a further external term.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyInequality {
    rate: f64,
    /// Time of the last state, s; none before the first.
    last: Option<f64>,
    /// ∫ exp(ν(t−s)) ‖b‖² ds so far, J.
    forced: f64,
    load: Vec<f64>,
}

impl EnergyInequality {
    /// The bound for a rate ν, 1/s.
    pub fn new(rate: f64) -> Self {
        Self {
            rate,
            last: None,
            forced: 0.0,
            load: Vec::new(),
        }
    }

    /// The bound at a state, later than the one before, J.
    pub fn bound(&mut self, snapshot: &Snapshot<'_>) -> f64 {
        let t = snapshot.state().t;
        if let Some(before) = self.last {
            let (middle, half) = (0.5 * (t + before), 0.5 * (t - before));
            let reach = 0.6f64.sqrt() * half;
            self.forced *= (self.rate * (t - before)).exp();
            for (node, weight) in [
                (middle - reach, 5.0 / 9.0),
                (middle, 8.0 / 9.0),
                (middle + reach, 5.0 / 9.0),
            ] {
                let grown = (self.rate * (t - node)).exp();
                self.forced += half * weight * grown * self.load_squared(snapshot, node);
            }
        }
        self.last = Some(t);
        snapshot.energies().initial * (self.rate * t).exp() + self.forced / (2.0 * self.rate)
    }

    /// ‖b‖², W.
    fn load_squared(&mut self, snapshot: &Snapshot<'_>, t: f64) -> f64 {
        let system = snapshot.system();
        let n = system.points();
        self.load.resize(system.dimension() * n, 0.0);
        system.external_acceleration_into(t, &mut self.load);
        let (load, volumes) = (&self.load, system.cloud().volumes());
        system.domain().sum(load.len(), |k| {
            volumes[k % n] * system.density().at(k % n) * load[k] * load[k]
        })
    }
}

pericles::saved! {
    impl Saved for EnergyInequality {
        last, forced: array("observer/energy-inequality"),
        rate: fixed,
        load: scratch,
    }
}
