//! Heated bodies on a lattice: the stencil kernel against the neighbour list, and free expansion.

use std::sync::Arc;

use crate::bodies::{noise, wave};
use crate::setup::{Model, expansion, models, operator_of};
use pericles::domain::Field;
use pericles::operator::{BondForm, Force, InstructionSet, PointSubset};
use pericles::round_trip::check_resume;
use pericles::space::{Grid, PointCloud};
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, Path, PointScalar, Simulation, StepEnd, System};

/// The models that the stencil kernel supports.
fn on_grid() -> impl Iterator<Item = Model> {
    let all = models().into_iter();
    all.filter(|model| match model {
        Model::Bonds(_) => true,
        Model::Solid(_, inelastic) => inelastic.is_elastic(),
    })
}

fn clouds() -> Vec<Arc<PointCloud>> {
    let plate = Grid::plate([21.0, 9.0], 1.0, 1.0).points().unwrap();
    let around = Grid::plate([19.0, 11.0], 1.0, 1.0).points().unwrap();
    let block = Grid::block([9.0, 6.0, 5.0], 1.0).points().unwrap();
    [plate, around.with_periodic_faces().unwrap(), block]
        .map(Arc::new)
        .into()
}

fn pair(cloud: &Arc<PointCloud>, model: &Model, limit: f64) -> [Box<dyn Force>; 2] {
    [BondForm::List, BondForm::Grid].map(|form| {
        let mut force = operator_of(cloud, model, limit, form);
        force.expand(expansion(cloud, [1.0, 2.0, 0.5])).unwrap();
        force
    })
}

fn difference(pair: &[Vec<f64>; 2]) -> f64 {
    let size = pair[0].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let entries = pair[0].iter().zip(&pair[1]);
    entries.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

/// A step of 0.4 s to a displacement, in which bonds break.
fn end(force: &mut dyn Force, u: &[f64], on: PointSubset<'_>) -> Vec<f64> {
    let mean: Vec<f64> = u.iter().map(|u| u / 0.4).collect();
    let end = StepEnd {
        t: 0.4,
        dt: 0.4,
        u,
        path: Path::MeanVelocity(&mean),
    };
    let mut out = vec![0.0; u.len()];
    force.end_step(&end, on, &mut out);
    out
}

#[test]
fn the_stencil_has_the_forces_energies_and_failure_of_the_list() {
    for cloud in clouds() {
        for model in on_grid() {
            for limit in [f64::INFINITY, 0.005] {
                let u = wave(&cloud, 0.05);
                let d = noise(u.len(), 3.0);
                let what = format!("{model:?}, {}D, {limit}", cloud.dimension());
                let found = pair(&cloud, &model, limit).map(|mut force| {
                    force.use_instruction_set(InstructionSet::detect());
                    let ended = end(&mut *force, &u, PointSubset::All);
                    let mut tangent = vec![0.0; u.len()];
                    force.tangent_into(0.7, &u, &d, &mut tangent);
                    let mut again = vec![0.0; u.len()];
                    force.add_force(0.7, &d, PointSubset::All, &mut again);
                    let mut density = vec![0.0; cloud.len()];
                    force.add_energy_density(0.7, &u, &mut density);
                    let mut bond = Vec::new();
                    let field = Field::new(&u, &[]);
                    let bonds = force.as_bonds().unwrap();
                    bonds.for_each_bond(&bonds.values_at(field), 40, &mut |at| {
                        bond.push((at.neighbour, at.force));
                    });
                    bond.sort_by_key(|(j, _)| *j);
                    let bond: Vec<f64> = bond.iter().flat_map(|(_, force)| *force).collect();
                    let mut marks = vec![false; cloud.len()];
                    if let Some(breaking) = force.capabilities().breaking {
                        breaking.mark_endangered(&u, 0.8, &mut marks);
                    }
                    let energy = force.energy(0.4, &u);
                    let broken = force.broken_bonds();
                    (
                        [ended, tangent, again, density, bond],
                        (marks, broken),
                        [energy, force.dissipated()],
                    )
                });
                let [(a, left, energy), (b, right, other)] = found;
                for (a, b) in a.into_iter().zip(b) {
                    let error = difference(&[a, b]);
                    assert!(error < 1e-12, "{what}: {error:e}");
                }
                assert!(left == right, "{what}: {} {}", left.1, right.1);
                assert_eq!(left.1 > 10, limit.is_finite(), "{what}: {}", left.1);
                for (a, b) in energy.into_iter().zip(other) {
                    assert!((a - b).abs() <= 1e-11 * energy[0].abs(), "{what}: {a} {b}");
                }
            }
        }
    }
}

/// Ending a step for two parts of a body breaks the same bonds as ending it for the whole body.
#[test]
fn failure_does_not_depend_on_the_subset() {
    let cloud = clouds().remove(0);
    let n = cloud.len() as u32;
    for model in on_grid() {
        let u = wave(&cloud, 0.05);
        let [_, mut whole] = pair(&cloud, &model, 0.005);
        let forces = end(&mut *whole, &u, PointSubset::All);
        let [_, mut parts] = pair(&cloud, &model, 0.005);
        let set: Vec<u32> = (0..n).filter(|i| i % 3 == 0).collect();
        let rest: Vec<u32> = (0..n).filter(|i| i % 3 != 0).collect();
        end(&mut *parts, &u, PointSubset::Set(&set));
        end(&mut *parts, &u, PointSubset::Set(&rest));
        assert!(whole.broken_bonds() > 10);
        assert_eq!(whole.broken_bonds(), parts.broken_bonds(), "{model:?}");
        let mut again = vec![0.0; u.len()];
        parts.add_force(0.4, &u, PointSubset::All, &mut again);
        assert_eq!(forces, again, "{model:?}");
    }
}

/// Temperatures linear in position leave a plane lattice of the bond-stretch law under stress, uniform ones do not.
#[test]
fn free_expansion_causes_no_force_or_energy() {
    for cloud in clouds().into_iter().filter(|cloud| !cloud.is_periodic()) {
        for model in on_grid() {
            let mut force = operator_of(&cloud, &model, f64::INFINITY, BondForm::Grid);
            force.expand(expansion(&cloud, [1.0, 0.0, 0.0])).unwrap();
            let n = cloud.len();
            let place = |k: usize| 0.01 * cloud.point(k % n)[k / n];
            let u: Vec<f64> = (0..cloud.dimension() * n).map(place).collect();
            let mut out = vec![0.0; u.len()];
            force.add_force(0.0, &u, PointSubset::All, &mut out);
            let largest = out.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(largest < 1e-12 * 0.1, "{model:?}: {largest:e}");
            assert!(force.energy(0.0, &u).abs() < 1e-12, "{model:?}");
        }
    }
}

/// A plate on a stencil, heated over time while bonds break.
fn heated(model: &Model) -> Simulation {
    let cloud = clouds().remove(0);
    let mut force = operator_of(&cloud, model, 0.012, BondForm::Grid);
    force.expand(expansion(&cloud, [0.5, 1.0, 0.8])).unwrap();
    let system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
    let mut start = State::at_rest(2 * cloud.len());
    start.v = wave(&cloud, 0.02);
    Simulation::new(system, Box::new(VelocityVerlet), start, 0.05, 60).unwrap()
}

/// For laws that are linear in the displacement the work of the temperature closes the balance to round-off.
#[test]
fn heated_runs_on_a_stencil_balance_their_energy_and_resume() {
    for model in on_grid() {
        check_resume(|| heated(&model), [5, 30]).unwrap();
        let mut run = heated(&model);
        run.run(|_| Control::Continue).unwrap();
        let broken = run.system().operator().broken_bonds();
        assert!(broken > 10, "{model:?}: {broken}");
        let energies = run.snapshot().energies();
        let error = energies.balance().abs() / energies.work;
        let small = matches!(
            &model,
            Model::Bonds(pericles::material::PairLaw::Linear)
                | Model::Solid(pericles::material::Strains::Small, _)
        );
        let bound = if small { 1e-11 } else { 1e-2 };
        assert!(error < bound, "{model:?}: {error:e}");
    }
}
