//! Runs a deck and records the crack at regular intervals.

use std::mem;
use std::sync::{Arc, Mutex, PoisonError};

use pericles::observe::{
    CrackTracker, Energies, Field, ObserveError, Observer, Schedule, Snapshot,
};
use pericles::space::{PointCloud, PointSet};
use pericles::{Control, Simulation};
use pericles_io::observers::PictureOf;
use pericles_run::{Event, MaterialConstants, Resources, RunError, build};

use crate::data::{Case, Found};
use crate::decks::deck;

/// Time between two records of the crack, s.
const LOOK: f64 = 0.5e-6;

/// Damage above which a point belongs to the crack.
const THRESHOLD: f64 = 0.35;

/// Symmetry of a body: the partner of each point, and the signs of the displacement components there.
pub(super) struct Symmetry {
    partner: Vec<u32>,
    sign: [f64; 2],
}

impl Symmetry {
    /// Reflection of a full rectangular grid about its horizontal midline.
    pub(super) fn up_down(cloud: &PointCloud, columns: usize) -> Self {
        let n = cloud.len();
        let partner = |i: usize| (n - columns * (i / columns + 1) + i % columns) as u32;
        Self {
            partner: (0..n).map(partner).collect(),
            sign: [1.0, -1.0],
        }
    }

    /// Rotation of a full rectangular grid by 180° about its centre.
    pub(super) fn half_turn(cloud: &PointCloud) -> Self {
        let n = cloud.len();
        Self {
            partner: (0..n).map(|i| (n - 1 - i) as u32).collect(),
            sign: [-1.0, -1.0],
        }
    }

    /// Largest difference of damage between partners, and that of displacement relative to the largest
    /// displacement.
    fn defect(&self, damage: &[f64], u: &[f64]) -> (f64, f64) {
        let n = damage.len();
        let (mut of_damage, mut of_u, mut largest) = (0f64, 0f64, 0f64);
        for (i, &j) in self.partner.iter().enumerate() {
            let j = j as usize;
            of_damage = of_damage.max((damage[i] - damage[j]).abs());
            for c in 0..2 {
                of_u = of_u.max((u[c * n + i] - self.sign[c] * u[c * n + j]).abs());
                largest = largest.max(u[c * n + i].abs());
            }
        }
        (of_damage, if largest > 0.0 { of_u / largest } else { 0.0 })
    }
}

/// Record of the crack at one time.
pub(super) struct Look {
    pub(super) t: f64,
    /// Points of the crack.
    pub(super) crack: PointSet,
    /// Distance of the farthest point of the crack from the pre-crack, m.
    pub(super) advance: f64,
    pub(super) energies: Energies,
    pub(super) broken_bonds: u64,
    /// See [`Symmetry::defect`].
    pub(super) damage_defect: f64,
    pub(super) displacement_defect: f64,
}

/// Finished run.
pub(super) struct Recorded {
    pub(super) looks: Vec<Look>,
    pub(super) simulation: Simulation,
    pub(super) constants: Option<MaterialConstants>,
}

impl Recorded {
    /// Position of a point, m.
    pub(super) fn place(&self, point: u32) -> [f64; 2] {
        let [x, y, _] = self.simulation.system().cloud().point(point as usize);
        [x, y]
    }

    /// Spacing of the points, m.
    pub(super) fn spacing(&self) -> f64 {
        self.simulation.system().cloud().spacing()
    }

    /// Results of both studies: the critical stretch, the first time at which the crack has grown by more than two
    /// spacings, the largest energy imbalance, broken bonds, and the curves of the front and its speed.
    pub(super) fn found(&self, front: &[(f64, f64)], speeds: &[(f64, f64)]) -> Found {
        let constants = self.constants.as_ref();
        let stretch = constants.map(MaterialConstants::critical_stretch);
        let stretch = stretch.filter(|stretch| stretch.is_finite());
        let grown = 2.0 * self.spacing();
        let start = self.looks.iter().find(|look| look.advance > grown);
        let worst = |over: fn(&Look) -> f64| {
            self.looks
                .iter()
                // Records before 1 µs, and those without reference energy, are not meaningful.
                .filter(|look| look.t > 1e-6 && over(look) > 0.0)
                .map(|look| look.energies.balance().abs() / over(look))
                .reduce(f64::max)
        };
        let last = self.looks.last();
        let curve = |found: Found, (name, points): (_, &[(f64, f64)])| {
            let (t, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
            found.curve(name, &t, &y)
        };
        let curves = [("tip", front), ("speed", speeds)];
        curves
            .into_iter()
            .fold(Found::default(), curve)
            .value("critical stretch", stretch)
            .value("start", start.map(|look| look.t))
            .value("balance over work", worst(|look| look.energies.work))
            .value(
                "balance over dissipated",
                worst(|look| look.energies.dissipated),
            )
            .value("dissipated", last.map(|look| look.energies.dissipated))
            .value("bonds_broken", last.map(|look| look.broken_bonds as f64))
    }
}

/// Runs the deck of the case, which has one pre-crack, and draws the damage at the end with the title `picture`, if
/// given.
pub(super) fn record(
    case: &Case<'_>,
    symmetry: impl FnOnce(&PointCloud) -> Symmetry,
) -> Result<Recorded, RunError> {
    let (deck, context) = (deck(case, &[])?, case.context);
    let assembly = build(&deck, &Resources::default())?;
    let constants = assembly.constants.clone();
    let recorder = Recorder {
        tracker: CrackTracker::new(&assembly.cloud, assembly.cracks.clone(), THRESHOLD)?,
        symmetry: symmetry(&assembly.cloud),
        looks: Arc::default(),
    };
    let looks = Arc::clone(&recorder.looks);
    let mut simulation = assembly.simulation()?;
    simulation.observe(Schedule::Interval(LOOK), Box::new(recorder));
    (context.tell)(Event::LoopBegins {
        first: 0,
        steps: simulation.steps(),
    });
    simulation
        .run(|run| {
            (context.tell)(Event::Step {
                step: run.state().step,
                t: run.state().t,
            });
            Control::Continue
        })
        .map_err(|error| RunError::of_run(error, || "the study was stopped".into()))?;
    (context.tell)(Event::LoopEnds);
    if let (true, Some(path)) = (case.has("picture"), context.figure("damage.png")) {
        let picture = PictureOf {
            title: case.text("picture")?,
            ..PictureOf::new(Field::Damage)
        };
        picture.draw(&simulation.snapshot(), path)?;
    }
    let looks = mem::take(&mut *looks.lock().unwrap_or_else(PoisonError::into_inner));
    Ok(Recorded {
        looks,
        simulation,
        constants,
    })
}

struct Recorder {
    tracker: CrackTracker,
    symmetry: Symmetry,
    looks: Arc<Mutex<Vec<Look>>>,
}

impl Observer for Recorder {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ObserveError> {
        let (state, system) = (snapshot.state(), snapshot.system());
        let damage = snapshot.field(Field::Damage);
        let tips = self.tracker.tips(system.cloud(), damage);
        let advance = tips.iter().flatten().map(|tip| tip.advance);
        let (damage_defect, displacement_defect) = self.symmetry.defect(damage, &state.u);
        let look = Look {
            t: state.t,
            crack: self.tracker.connected(0, damage),
            advance: advance.fold(0.0, f64::max),
            energies: snapshot.energies(),
            broken_bonds: system.operator().broken_bonds(),
            damage_defect,
            displacement_defect,
        };
        let mut looks = self.looks.lock().unwrap_or_else(PoisonError::into_inner);
        looks.push(look);
        Ok(())
    }
}

// Studies are not resumed.
pericles::saved! {
    impl Checkpointed for Recorder {
        tracker, symmetry: fixed,
        looks: scratch,
    }
}
