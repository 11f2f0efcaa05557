//! Loads, constraints and damping layers in the arrays of a device.
//!
//! A component of a point may have several loads and layers, which one invocation adds, so that the order of a sum does not depend
//! on the device. Time functions are evaluated by the host for all steps of a batch.

use pericles::System;
use pericles::boundary::{Exchange, Load, PrescribedMotion};

use crate::body::Body;

/// Terms of components: the entries of the arrays of the device in ascending order, and the terms of each.
#[derive(Debug, Default)]
pub(crate) struct Terms {
    entries: Vec<u32>,
    /// First term of each entry, and the number of terms.
    first: Vec<u32>,
    /// Number of the load or layer of each term.
    pub of: Vec<u32>,
    /// Number of each term within its load or layer.
    pub place: Vec<u32>,
    pub amplitude: Vec<f64>,
    /// Entry of the state's arrays of each term.
    pub of_state: Vec<u32>,
}

impl Terms {
    /// Sorts terms (entry of the state's arrays, load or layer, place within it, amplitude).
    fn new(body: &Body, mut terms: Vec<(usize, u32, u32, f64)>) -> Self {
        terms.sort_by_key(|&(of_state, of, ..)| (body.entry(of_state), of));
        let mut sorted = Self::default();
        for (of_state, of, place, amplitude) in terms {
            let entry = body.entry(of_state) as u32;
            if sorted.entries.last() != Some(&entry) {
                sorted.entries.push(entry);
                sorted.first.push(sorted.of.len() as u32);
            }
            sorted.of.push(of);
            sorted.place.push(place);
            sorted.amplitude.push(amplitude);
            sorted.of_state.push(of_state as u32);
        }
        sorted.first.push(sorted.of.len() as u32);
        sorted
    }
}

/// The constrained components.
#[derive(Debug, Default)]
struct Guided {
    entries: Vec<u32>,
    motion: Vec<u32>,
    slot: Vec<u32>,
    of_state: Vec<u32>,
    amplitude: Vec<f64>,
    start: Vec<f64>,
    /// Density of the point, kg/m³.
    density: Vec<f64>,
}

/// All lists of a system.
#[derive(Debug)]
pub(crate) struct Entries {
    loads: Terms,
    layers: Terms,
    guided: Guided,
    load_count: usize,
    motion_count: usize,
    /// Boundaries of the system that are layers.
    layer_numbers: Vec<usize>,
    counts: Vec<(&'static str, u64)>,
}

/// Parts of the books: first entry of each list.
#[derive(Debug, Clone, Copy)]
struct Parts {
    loads: usize,
    guided: usize,
    layers: usize,
}

impl Parts {
    fn total(self) -> usize {
        self.loads + 3 * self.guided + 3 * self.layers
    }
}

impl Entries {
    /// Collects the loads, constraints and layers of a system, which must be products of functions of points and of time.
    pub(crate) fn new(system: &System, body: &Body) -> Self {
        let loads = Terms::new(body, loads(system, body));
        let guided = guided(system, body);
        let mut damped = Vec::new();
        let mut layer_numbers = Vec::new();
        let n = system.points();
        for (number, boundary) in system.boundaries().enumerate() {
            let Some(layer) = boundary.as_layer() else {
                continue;
            };
            let of = layer_numbers.len() as u32;
            for c in 0..system.dimension() {
                for (k, (i, damping)) in layer.damped().enumerate() {
                    let place = c * layer.points() + k;
                    damped.push((c * n + i, of, place as u32, damping * body.units.time));
                }
            }
            layer_numbers.push(number);
        }
        let mut entries = Self {
            loads,
            layers: Terms::new(body, damped),
            guided,
            load_count: system.loads().len(),
            motion_count: system.motions().len(),
            layer_numbers,
            counts: Vec::new(),
        };
        entries.counts = entries.counted(body);
        entries
    }

    fn parts(&self) -> Parts {
        Parts {
            loads: self.loads.of.len(),
            guided: self.guided.entries.len(),
            layers: self.layers.of.len(),
        }
    }

    /// Number of loaded components.
    pub(crate) fn loaded(&self) -> usize {
        self.loads.entries.len()
    }

    /// Number of constrained components.
    pub(crate) fn constrained(&self) -> usize {
        self.guided.entries.len()
    }

    /// Number of damped components.
    pub(crate) fn damped(&self) -> usize {
        self.layers.entries.len()
    }

    /// The lists of the shaders with the constants that are their places.
    pub(crate) fn lists(&self, body: &Body) -> Vec<(&'static str, Vec<u32>)> {
        let mut lists = body.lists(&self.guided.entries);
        lists.extend([
            ("LOAD_ENTRY", self.loads.entries.clone()),
            ("LOAD_FIRST", self.loads.first.clone()),
            ("LOAD_NUMBER", self.loads.of.clone()),
            ("MOTION_ENTRY", self.guided.entries.clone()),
            ("MOTION_NUMBER", self.guided.motion.clone()),
            ("LAYER_ENTRY", self.layers.entries.clone()),
            ("LAYER_FIRST", self.layers.first.clone()),
        ]);
        lists
    }

    /// The amplitudes of the shaders.
    pub(crate) fn amplitudes(&self) -> Vec<(&'static str, &[f64])> {
        vec![
            ("LOAD_AMPLITUDE", &self.loads.amplitude[..]),
            ("MOTION_AMPLITUDE", &self.guided.amplitude),
            ("MOTION_START", &self.guided.start),
            ("LAYER_RATE", &self.layers.amplitude),
        ]
    }

    /// Constants of the shaders.
    pub(crate) fn constants(&self) -> impl Iterator<Item = (&'static str, u64)> {
        self.counts.iter().copied()
    }

    fn counted(&self, body: &Body) -> Vec<(&'static str, u64)> {
        let mut counts = Vec::new();
        let mut place = |parts: &mut dyn Iterator<Item = (&'static str, usize)>| {
            let mut first = 0;
            for (name, length) in parts {
                counts.push((name, first as u64));
                first += length;
            }
        };
        let lists = self.lists(body);
        place(&mut lists.iter().map(|(name, list)| (*name, list.len())));
        place(
            &mut body
                .numbers()
                .into_iter()
                .map(|(name, list)| (name, list.len())),
        );
        place(
            &mut self
                .amplitudes()
                .into_iter()
                .map(|(name, list)| (name, list.len())),
        );
        let parts = self.parts();
        place(
            &mut [
                ("LOAD_WORK", parts.loads),
                ("MOTION_REACTION", parts.guided),
                ("MOTION_WORK", parts.guided),
                ("MOTION_IMPULSE", parts.guided),
                ("LAYER_PULL", parts.layers),
                ("LAYER_WORK", parts.layers),
                ("LAYER_IMPULSE", parts.layers),
            ]
            .into_iter(),
        );
        place(
            &mut [
                ("LENGTH_COURSE", 1),
                ("LOAD_COURSE", 2 * self.load_count),
                ("MOTION_COURSE", 6 * self.motion_count),
            ]
            .into_iter(),
        );
        counts.extend(
            body.counts()
                .into_iter()
                .map(|(name, count)| (name, count as u64)),
        );
        counts.extend([
            ("COURSE", self.columns() as u64),
            ("LOADED", self.loaded() as u64),
            ("MOTIONS", self.constrained() as u64),
            ("DAMPED", self.damped() as u64),
        ]);
        counts
    }

    /// Number of columns of the course.
    pub(crate) fn columns(&self) -> usize {
        1 + 2 * self.load_count + 6 * self.motion_count
    }

    /// Number of entries of the books.
    pub(crate) fn books(&self) -> usize {
        self.parts().total()
    }

    /// Returns a row of the course for the step from t to t + dt.
    pub(crate) fn course(&self, system: &System, body: &Body, t: f64, t_next: f64) -> Vec<f64> {
        let unit = body.units.time;
        let dt = t_next - t;
        let mut row = vec![dt / unit];
        for load in system.loads() {
            row.extend([load.factor(t_next - dt), load.factor(t_next)]);
        }
        for motion in system.motions() {
            let velocity = |t: f64| motion.unit(1, t) * unit;
            row.extend([
                f64::from(u8::from(motion.holds(t_next))),
                motion.unit(0, t),
                motion.unit(0, t_next),
                velocity(t),
                velocity(t_next),
                motion.unit(2, t_next) * (unit * unit),
            ]);
        }
        row
    }

    /// Returns the books at the start of a batch: reactions and pulls of the last state.
    pub(crate) fn opened(&self, system: &mut System, body: &Body) -> Vec<f64> {
        let parts = self.parts();
        let mut books = vec![0.0; parts.total()];
        let acceleration = body.units.acceleration();
        let system = system.parts_mut();
        let reactions = &mut books[parts.loads..][..parts.guided];
        for (e, reaction) in reactions.iter_mut().enumerate() {
            let of = &mut system.motions[self.guided.motion[e] as usize];
            let force = of.reactions_mut()[self.guided.slot[e] as usize];
            *reaction = force / self.guided.density[e] / acceleration;
        }
        let pulls = &mut books[parts.loads + 3 * parts.guided..][..parts.layers];
        for (e, pull) in pulls.iter_mut().enumerate() {
            let number = self.layer_numbers[self.layers.of[e] as usize];
            if let Some(layer) = system.boundaries[number].as_layer() {
                *pull = layer.pull()[self.layers.place[e] as usize] / acceleration;
            }
        }
        books
    }

    /// Adds the work and impulses of a batch to the energy balance, and takes over reactions and pulls. `times` are those of all
    /// states of the batch, `masses` those of the entries of the state's arrays.
    pub(crate) fn close(
        &self,
        books: &[f64],
        (system, masses): (&mut System, &[f64]),
        body: &Body,
        times: &[f64],
    ) {
        let parts = self.parts();
        let units = body.units;
        let (work, rest) = books.split_at(parts.loads);
        let (motions, layers) = rest.split_at(3 * parts.guided);
        let durations = system.loads().iter().map(|load| impulse_of(load, times));
        let durations: Vec<f64> = durations.map(|duration| duration / units.time).collect();
        let amplitudes = self.loads.amplitude.iter().zip(&self.loads.of);
        let pushes: Vec<f64> = amplitudes
            .map(|(amplitude, &load)| amplitude * durations[load as usize])
            .collect();
        let part = |list: &'_ [f64], number: usize, length: usize| {
            list[number * length..][..length].to_vec()
        };
        let [loads, guided, damped] = [
            (&self.loads.of, &self.loads.of_state),
            (&self.guided.motion, &self.guided.of_state),
            (&self.layers.of, &self.layers.of_state),
        ];
        let books = [
            (loads, self.load_count, [work.to_vec(), pushes]),
            (
                guided,
                self.motion_count,
                [1, 2].map(|number| part(motions, number, parts.guided)),
            ),
            (
                damped,
                self.layer_numbers.len(),
                [1, 2].map(|number| part(layers, number, parts.layers)),
            ),
        ];
        for ((of, of_state), count, [work, push]) in books {
            for number in 0..count {
                let terms = (0..of.len()).filter(|&e| of[e] as usize == number);
                let terms: Vec<Term> = terms
                    .map(|e| Term {
                        entry: of_state[e] as usize,
                        work: work[e] * units.energy(),
                        push: push[e] * units.velocity(),
                    })
                    .collect();
                book(system, masses, &terms);
            }
        }
        let system = system.parts_mut();
        for (e, reaction) in motions[..parts.guided].iter().enumerate() {
            let of = &mut system.motions[self.guided.motion[e] as usize];
            let force = reaction * units.acceleration() * self.guided.density[e];
            of.reactions_mut()[self.guided.slot[e] as usize] = force;
        }
        for (e, pull) in layers[..parts.layers].iter().enumerate() {
            let number = self.layer_numbers[self.layers.of[e] as usize];
            if let Some(layer) = system.boundaries[number].as_layer_mut() {
                layer.pull_mut()[self.layers.place[e] as usize] = pull * units.acceleration();
            }
        }
    }
}

/// Work and impulse per mass on a component of a point in a batch.
struct Term {
    /// Entry of the state's arrays.
    entry: usize,
    work: f64,
    push: f64,
}

/// Adds the work and impulse of a load, constraint or layer to the energy balance.
fn book(system: &mut System, masses: &[f64], terms: &[Term]) {
    let (n, domain) = (system.points(), system.domain());
    let impulse = std::array::from_fn(|c| {
        let own = terms.iter().filter(|term| term.entry / n == c);
        let own: Vec<&Term> = own.collect();
        domain.sum(own.len(), |k| own[k].push * masses[own[k].entry])
    });
    let work = domain.sum(terms.len(), |k| terms[k].work * masses[terms[k].entry]);
    system.book_exchange(Exchange { work, impulse });
}

/// Returns ∫ g dt of the time function of a load by the rule of the steps.
fn impulse_of(load: &Load, times: &[f64]) -> f64 {
    let steps = times.windows(2).map(|pair| {
        let dt = pair[1] - pair[0];
        0.5 * dt * (load.factor(pair[1] - dt) + load.factor(pair[1]))
    });
    steps.sum()
}

/// Returns the terms of all loads; amplitudes are accelerations.
fn loads(system: &System, body: &Body) -> Vec<(usize, u32, u32, f64)> {
    let n = system.points();
    let mut terms = Vec::new();
    for (number, load) in system.loads().iter().enumerate() {
        for c in (0..system.dimension()).filter(|&c| !load.is_free_of(c)) {
            for (k, &i) in load.points.iter().enumerate() {
                let density = system.density().at(i as usize);
                let force = load.amplitude(c, k, 0.0);
                let amplitude = force / density / body.units.acceleration();
                terms.push((c * n + i as usize, number as u32, k as u32, amplitude));
            }
        }
    }
    terms
}

fn guided(system: &System, body: &Body) -> Guided {
    let mut guided = Guided::default();
    let n = system.points();
    let components = |motion: &PrescribedMotion| motion.components(n).unwrap_or_default();
    for (number, motion) in system.motions().iter().enumerate() {
        for component in components(motion) {
            guided.entries.push(body.entry(component.entry) as u32);
            guided.motion.push(number as u32);
            guided.slot.push(component.slot as u32);
            guided.of_state.push(component.entry as u32);
            guided
                .amplitude
                .push(component.amplitude / body.units.length);
            guided.start.push(component.start / body.units.length);
            guided
                .density
                .push(system.density().at(component.entry % n));
        }
    }
    guided
}
