//! Bonds that are elastic until the stress reaches the strength: uniform strains, areas of opened bonds, energy balance.

use std::sync::Arc;

use pericles::family::{Crack, VolumeCorrection};
use pericles::material::{
    BondCriterion, BondState, Criterion, Softening, SofteningLaw, Strength, StrengthSurface,
};
use pericles::operator::PointSubset;
use pericles::prelude::*;
use pericles::{StepEnd, round_trip};

const STRENGTH: f64 = 1e-3;
/// f_t/E.
const ELASTIC: f64 = 1e-3;

/// How a body is made.
#[derive(Clone)]
struct Made {
    cloud: Arc<PointCloud>,
    /// E s₀/f_t.
    ratio: f64,
    law: PairLaw,
    surface: StrengthSurface,
    state: Option<StressState>,
    crack: Option<Crack>,
}

impl Made {
    fn of(cloud: PointCloud, ratio: f64) -> Self {
        let state = (cloud.dimension() == 2).then_some(StressState::PlaneStress);
        Self {
            cloud: Arc::new(cloud),
            ratio,
            law: PairLaw::Linear,
            surface: StrengthSurface::rankine(STRENGTH).unwrap(),
            state,
            crack: None,
        }
    }

    fn body(&self) -> Body {
        let mut material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0 * (1.0 + 1e-6));
        material.law = self.law;
        material.volume_correction = VolumeCorrection::None;
        material = material.with_critical_stretch(self.ratio * ELASTIC);
        let least_onset = 0.2 * ELASTIC.min(self.ratio * ELASTIC);
        let mut body = Body::new(self.cloud.clone(), material)
            .softening(Softening {
                law: SofteningLaw::Linear,
                onset: least_onset,
            })
            .strengths(vec![Strength {
                surface: self.surface.clone(),
                least_onset,
            }]);
        if let Some(state) = self.state {
            body = body.stress_state(state);
        }
        if let Some(crack) = &self.crack {
            body = body.crack(crack.clone());
        }
        body
    }

    fn system(&self) -> System {
        self.body().build().unwrap()
    }

    /// Displacements of a uniform strain.
    fn stretched(&self, strain: [f64; 3]) -> Vec<f64> {
        let (n, d) = (self.cloud.len(), self.cloud.dimension());
        let entry = |k: usize| strain[k / n] * self.cloud.point(k % n)[k / n];
        (0..d * n).map(entry).collect()
    }
}

/// Ends a step at `u`; returns the force.
fn reach(system: &mut System, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    let end = StepEnd::sub_step(0.0, 0.0, u);
    system.end_step_on(&end, &PointSubset::All, &mut out);
    system.force_density_into(0.0, u, &mut out);
    out
}

/// Returns the stress along x of a point in the interior for a strain.
fn interior_stress(made: &Made, strain: [f64; 3]) -> f64 {
    let system = made.system();
    let state = State {
        u: made.stretched(strain),
        ..State::of(&system)
    };
    let start = pericles::observe::StartEnergy::default();
    let snapshot = pericles::observe::Snapshot::new(&system, &state, start, 0.0);
    let centre = made.cloud.bounds();
    let middle = std::array::from_fn(|c| 0.5 * (centre[0][c] + centre[1][c]));
    let (nearest, _) = made.cloud.nearest_of_all(middle);
    snapshot.field(pericles::observe::Field::Stress)[nearest.unwrap() as usize]
}

/// Returns the number of bonds with a stretch n·ε n above a limit.
fn stretched_beyond(made: &Made, strain: [f64; 3], limit: f64) -> usize {
    let cloud = &made.cloud;
    let stretch = |i: usize, j: usize| {
        let (a, b) = (cloud.point(i), cloud.point(j));
        let xi: [f64; 3] = std::array::from_fn(|c| b[c] - a[c]);
        let square: f64 = xi.iter().map(|x| x * x).sum();
        let along: f64 = xi.iter().zip(strain).map(|(x, e)| e * x * x).sum();
        (square <= 9.0 + 1e-5).then(|| along / square)
    };
    let pairs = (0..cloud.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs
        .filter(|&(i, j)| stretch(i, j).is_some_and(|s| s >= limit))
        .count()
}

/// Under a uniform strain the corrected stress is that of the interior at faces, edges and corners: no bond opens just below
/// the strength, although brittle bonds would break, and all stretched bonds break just above it.
#[test]
fn all_points_reach_the_strength_at_the_same_uniform_strain() {
    let plate = Made::of(Grid::plate([14.0, 11.0], 1.0, 1.0).points().unwrap(), 0.4);
    let block = Made::of(Grid::block([9.0, 8.0, 8.0], 1.0).points().unwrap(), 0.4);
    let finite = Made {
        law: PairLaw::BondStretch,
        ..plate.clone()
    };
    let strain = [ELASTIC, -0.3 * ELASTIC, -0.3 * ELASTIC];
    for (made, accuracy) in [(&plate, 1e-6), (&block, 1e-6), (&finite, 3e-3)] {
        let stress = interior_stress(made, strain);
        let at = |part: f64| strain.map(|x| part * STRENGTH / stress * x);
        let broken = |part: f64| {
            let mut system = made.system();
            let u = made.stretched(at(part));
            reach(&mut system, &u);
            system.operator().broken_bonds()
        };
        assert_eq!(broken(1.0 - accuracy), 0);
        let beyond = stretched_beyond(made, at(1.0), 0.4 * ELASTIC);
        let broken = broken(1.0 + accuracy) as usize;
        assert!(beyond > 0);
        assert!(
            broken.abs_diff(beyond) * 100 <= beyond,
            "{broken} of {beyond}"
        );
    }
}

/// A bond that opens below its critical stretch dissipates the energy of a brittle bond, and one that opens beyond it the
/// energy that it has then.
#[test]
fn opened_bonds_keep_the_area_of_the_brittle_bond() {
    let pair = PointCloud::new(1, vec![0.0, 1.0], vec![1.0; 2], 1.0).unwrap();
    // The stress of a pair is half the force.
    let stiffness = {
        let mut force = vec![0.0; 2];
        let system = Made::of(pair.clone(), 1.0).system();
        system.force_density_into(0.0, &[0.0, 1e-6], &mut force);
        force[0].abs() / 1e-6
    };
    let opens = 2.0 * STRENGTH / stiffness;
    for ratio in [0.6, 1.5, 5.0] {
        let critical = ratio * opens;
        let mut system = Made::of(pair.clone(), critical / ELASTIC).system();
        let energy = system.operator().energy(0.0, &[0.0, critical]);
        let end = opens.max(critical * critical / opens);
        const COUNT: u32 = 20_000;
        for k in 1..=COUNT {
            let stretch = 1.01 * end * f64::from(k) / f64::from(COUNT);
            let force = reach(&mut system, &[0.0, stretch])[0].abs();
            if stretch < 0.999 * opens {
                assert!((force / (stiffness * stretch) - 1.0).abs() < 1e-12);
            }
        }
        assert_eq!(system.operator().broken_bonds(), 1, "{ratio}");
        let found = system.operator().dissipated() / energy;
        let (expected, accuracy) = match opens < critical {
            true => (1.0, 1e-9),
            // To the step of the stretch.
            false => ((opens / critical).powi(2), 2e-4),
        };
        assert!(
            (found / expected - 1.0).abs() < accuracy,
            "{ratio}: {found}"
        );
    }
}

/// Half of the trace of the stress, over the strength.
#[derive(Debug)]
struct MeanStress;

impl BondCriterion for MeanStress {
    fn failure_index(&self, bond: &BondState) -> f64 {
        0.5 * (bond.stress[0][0] + bond.stress[1][1]) / STRENGTH
    }

    fn words(&self) -> String {
        "at the mean stress".into()
    }
}

#[test]
fn any_function_of_the_stress_is_a_strength_surface() {
    let plate = Grid::plate([12.0, 12.0], 1.0, 1.0).points().unwrap();
    let made = Made {
        surface: StrengthSurface::Function(Criterion::new(MeanStress)),
        ..Made::of(plate, 0.5)
    };
    let equal = [ELASTIC, ELASTIC, 0.0];
    let stress = interior_stress(&made, equal);
    for (part, breaks) in [(1.0 - 1e-6, false), (1.0 + 1e-6, true)] {
        let mut system = made.system();
        let u = made.stretched(equal.map(|x| part * STRENGTH / stress * x));
        reach(&mut system, &u);
        assert_eq!(system.operator().broken_bonds() > 0, breaks);
    }
}

/// A notched plate whose upper half moves away from the lower one.
fn run(made: &Made) -> Simulation {
    let system = made.system();
    let mut state = State::of(&system);
    let n = made.cloud.len();
    for i in 0..n {
        state.v[n + i] = if made.cloud.point(i)[1] > 10.0 {
            1e-2
        } else {
            -1e-2
        };
    }
    Simulation::new(system, Box::new(VelocityVerlet), state, 0.2, 120).unwrap()
}

fn notched(ratio: f64) -> Made {
    let plate = Grid::plate([20.0, 20.0], 1.0, 1.0).points().unwrap();
    Made {
        crack: Some(Crack::Segment {
            from: [0.0, 10.0],
            to: [6.0, 10.0],
        }),
        ..Made::of(plate, ratio)
    }
}

#[test]
fn the_energy_balance_of_a_dynamic_run_closes() {
    for ratio in [0.5, 1.5] {
        let mut run = run(&notched(ratio));
        run.run_to_end().unwrap();
        let energies = run.snapshot().energies();
        assert!(run.system().operator().broken_bonds() > 20, "{ratio}");
        let error = energies.balance() / energies.initial;
        assert!(error.abs() < 1e-3, "{ratio}: {error}");
    }
}

#[test]
fn a_resumed_run_has_the_same_bits() {
    let make = || run(&notched(1.5));
    round_trip::check_resume(make, [40, 80]).unwrap();
}
