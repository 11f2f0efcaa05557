//! Energy bound of a body under time-dependent loads.

use pericles::observe::Snapshot;

/// Upper bound of kinetic plus elastic energy, for any rate ν > 0 (1/s):
/// e(t) ≤ e(0) exp(νt) + 1/(2ν) ∫₀ᵗ exp(ν(t−s)) ‖b(s)‖² ds, where e is the energy (J) and ‖b‖² = Σ V |b|²/ρ
/// (W).
///
/// Derivation: de/dt = Σ V b·v ≤ ‖b‖²/(2ν) + ν e_kin, then Gronwall's lemma. The bound holds for any elastic
/// force, breaking bonds and fixed supports; the work of moving supports is not included. A scheme that
/// violates it gains spurious energy. The bound is tightest for ν of about 1/t. The integral is evaluated by
/// three-point Gauss quadrature between the observed states, so jumps of the load between them should be rare.
///
/// Source: the energy inequality of Coclite, Fanizzi, Lopez, Maddalena & Pellegrino, Appl. Numer. Math. 155
/// (2020), whose left side has an additional external term.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyInequality {
    rate: f64,
    /// Time of the last state, s; `None` before the first.
    last: Option<f64>,
    /// Accumulated ∫ exp(ν(t−s)) ‖b‖² ds, J.
    forced: f64,
    load: Vec<f64>,
}

impl EnergyInequality {
    /// Creates the bound for a rate ν, 1/s.
    pub fn new(rate: f64) -> Self {
        Self {
            rate,
            last: None,
            forced: 0.0,
            load: Vec::new(),
        }
    }

    /// Returns the bound at a state, J. States must be passed in order of time.
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
    impl Checkpointed for EnergyInequality {
        last, forced: array("observer/energy-inequality"),
        rate: fixed,
        load: scratch,
    }
}
