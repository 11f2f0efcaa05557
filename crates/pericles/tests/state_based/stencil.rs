//! Solids on a lattice: the stencil compared with the neighbour list.

use std::sync::Arc;

use crate::bodies::{jittered, noise, solid};
use crate::common::points;
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondLimits, LinearSolid, LinearSolidConstants, Materials, SolidSurface, StateConstants,
    StateInfluence, Strains, StressState,
};
use pericles::operator::{BondForm, Feature, Force, InstructionSet, LinearSolidBody, PointSubset};
use pericles::space::{Grid, PointCloud, Region, Shape};
use pericles::time::{State, VelocityVerlet, highest_frequency};
use pericles::{Control, PointScalar, Simulation, StepEnd, System};

/// A body of two materials.
struct Body {
    name: &'static str,
    cloud: Arc<PointCloud>,
    materials: [LinearSolidConstants; 2],
    correction: VolumeCorrection,
    cracks: Vec<(Crack, EndRule)>,
    no_fail: Vec<u32>,
}

fn boxed(size: &[f64], holes: Vec<Region>) -> PointCloud {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: size.to_vec(),
        },
        spacing: 1.0,
        section: 1.0,
        holes,
    };
    grid.points().unwrap()
}

/// A bar, a plate with a hole and a notch, a periodic plate with a crack through a face, a block, and a thin
/// periodic block with bonds that span several periods.
fn bodies(limits: BondLimits) -> Vec<Body> {
    let hole = Region::Ball {
        centre: [13.0, 4.0, 0.0],
        radius: 1.7,
    };
    let slit = |from: [f64; 2], to: [f64; 2]| (Crack::Segment { from, to }, EndRule::Closed);
    let gauss = InfluenceFunction::Gaussian {
        length: 1.4,
        cutoff: None,
    };
    let (none, linear) = (VolumeCorrection::None, VolumeCorrection::Linear);
    let plate = boxed(&[21.0, 13.0], vec![hole]);
    let around = boxed(&[19.0, 11.0], vec![]).with_periodic_faces().unwrap();
    let thin = boxed(&[9.0, 5.0, 2.0], vec![])
        .with_periodic_faces()
        .unwrap();
    let of = |name, cloud: PointCloud, state, function: Option<&InfluenceFunction>, correction| {
        let influence = match function {
            Some(function) => StateInfluence::Function(function.clone()),
            None => StateInfluence::Isotropic,
        };
        let materials = [0.1, 0.4].map(|nu| {
            let material = LinearSolid {
                influence: influence.clone(),
                volume_correction: correction,
                ..solid(nu, 3.0 * (1.0 + 1e-6), InfluenceFunction::Constant)
            };
            let mut constants = material.constants(&cloud, state).unwrap();
            constants.limits = limits;
            constants
        });
        let no_fail = points(&cloud, |x, _, _| x < 3.0);
        Body {
            name,
            cloud: Arc::new(cloud),
            materials,
            correction,
            cracks: vec![],
            no_fail,
        }
    };
    let constant = Some(&InfluenceFunction::Constant);
    vec![
        of(
            "bar",
            boxed(&[37.0], vec![]),
            StressState::Uniaxial,
            Some(&gauss),
            linear,
        ),
        Body {
            cracks: vec![slit([0.0, 6.0], [6.0, 6.0])],
            ..of("plate", plate, StressState::PlaneStress, None, none)
        },
        Body {
            cracks: vec![slit([15.0, 5.0], [19.0, 5.0])],
            ..of(
                "periodic plate",
                around,
                StressState::PlaneStrain,
                Some(&gauss),
                linear,
            )
        },
        of(
            "block",
            boxed(&[9.0, 7.0, 6.0], vec![]),
            StressState::Spatial,
            constant,
            linear,
        ),
        of(
            "thin periodic block",
            thin,
            StressState::Spatial,
            Some(&gauss),
            none,
        ),
    ]
}

impl Body {
    fn classes(&self) -> Materials<StateConstants> {
        let number = |i: usize| u8::from(self.cloud.point(i)[0] > 8.0);
        let numbers = (0..self.cloud.len()).map(number).collect();
        LinearSolidConstants::several(numbers, &self.materials).unwrap()
    }

    fn operator(&self, strains: Strains, form: BondForm) -> Box<dyn Force> {
        let body = LinearSolidBody {
            classes: Some(&self.classes()),
            strains,
            cracks: &self.cracks,
            no_fail: &self.no_fail,
            ..LinearSolidBody::new(&self.cloud, &self.materials[0], self.correction)
        };
        body.operator(form).unwrap().operator
    }

    fn both(&self, strains: Strains) -> [Box<dyn Force>; 2] {
        [BondForm::List, BondForm::Grid].map(|form| self.operator(strains, form))
    }

    /// Irregular displacements; larger ones for a bar, most of whose bonds are long.
    fn shaken(&self, size: f64) -> Vec<f64> {
        let entries = self.cloud.dimension() * self.cloud.len();
        let size = if self.cloud.dimension() == 1 {
            3.0 * size
        } else {
            size
        };
        let of = |u: f64| size * u;
        noise(entries, 0.3).into_iter().map(of).collect()
    }
}

const STRAINS: [Strains; 2] = [Strains::Finite, Strains::Small];

fn largest(vector: &[f64]) -> f64 {
    vector.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// Largest difference divided by the largest entry.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) / largest(b).max(1e-300)
}

fn force_of(operator: &dyn Force, u: &[f64], on: PointSubset<'_>) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    operator.add_force(0.0, u, on, &mut force);
    force
}

/// Everything that a form computes at a displacement.
fn computed(operator: &dyn Force, u: &[f64]) -> Vec<(&'static str, Vec<f64>)> {
    let n = operator.points();
    let direction = noise(u.len(), 2.7);
    let [mut density, mut dilatation] = [vec![0.0; n], vec![0.0; n]];
    operator.add_energy_density(0.0, u, &mut density);
    let view = operator.capabilities().dilatation.unwrap();
    view.dilatation_into(0.0, u, &mut dilatation);
    let mut tangent = vec![f64::NAN; u.len()];
    operator.tangent_into(0.0, u, &direction, &mut tangent);
    let mut of_bonds = vec![0.0; u.len()];
    for i in 0..n {
        let field = pericles::domain::Field::new(u, &[]);
        let bonds = operator.as_bonds().unwrap();
        bonds.for_each_bond(&bonds.values_at(field), i, &mut |bond| {
            for c in 0..operator.dimension() {
                of_bonds[c * n + i] += bond.force[c];
            }
        });
    }
    let mut damage = vec![0.0; n];
    operator.damage_into(&mut damage);
    vec![
        ("force", force_of(operator, u, PointSubset::All)),
        ("forces of single bonds", of_bonds),
        ("energy density", density),
        ("energy", vec![operator.energy(0.0, u)]),
        ("dilatation", dilatation),
        ("tangent", tangent),
        ("damage", damage),
        ("frequency bound", vec![operator.frequency_bound(&|_| 1.3)]),
        ("bonds", vec![operator.directed_bonds() as f64]),
        ("broken", vec![operator.broken_bonds() as f64]),
        ("dissipated", vec![operator.dissipated()]),
    ]
}

fn check_alike([list, grid]: [&dyn Force; 2], u: &[f64], case: &str) {
    for ((what, of_list), (_, of_grid)) in computed(list, u).into_iter().zip(computed(grid, u)) {
        let error = difference(&of_grid, &of_list);
        assert!(error < 1e-12, "{case}, {what}: {error:e}");
    }
}

/// Strains of 0.01 use the polynomials, strains of 0.2 the exact forms.
#[test]
fn stencil_and_list_agree() {
    for body in bodies(BondLimits::NONE) {
        for strains in STRAINS {
            let [list, mut grid] = body.both(strains);
            for set in InstructionSet::available() {
                grid.use_instruction_set(set);
                assert_eq!(grid.instruction_set(), set);
                for size in [0.001, 0.1] {
                    let case = format!("{}, {strains:?}, {}, {size}", body.name, set.name());
                    check_alike([&*list, &*grid], &body.shaken(size), &case);
                }
            }
        }
    }
}

#[test]
fn points_depend_on_the_same_neighbours() {
    for body in bodies(BondLimits::NONE) {
        let [list, grid] = body.both(Strains::Finite);
        for i in 0..body.cloud.len() {
            let near = |operator: &dyn Force| {
                let mut near = Vec::new();
                let local = operator.as_local().unwrap();
                local.neighbours(i, &mut |j| near.push(j));
                near.sort_unstable();
                near
            };
            assert_eq!(near(&*list), near(&*grid), "{}", body.name);
        }
    }
}

const BRITTLE: BondLimits = BondLimits {
    stretch: 0.03,
    energy: f64::INFINITY,
};

/// Two ends of steps; the second starts with the bonds that remain after the first.
#[test]
fn the_same_bonds_break_and_dissipate_the_same_energy() {
    for body in bodies(BRITTLE) {
        for strains in STRAINS {
            let mut forms = body.both(strains);
            for size in [0.04, 0.06] {
                let u = body.shaken(size);
                let step = StepEnd::sub_step(0.0, 0.0, &u);
                let [list, grid] = forms.each_mut().map(|form| {
                    let mut force = vec![0.0; u.len()];
                    form.end_step(&step, PointSubset::All, &mut force);
                    assert_eq!(force, force_of(&**form, &u, PointSubset::All));
                    force
                });
                assert!(difference(&grid, &list) < 1e-12, "{}", body.name);
                let [list, grid] = forms.each_ref().map(|form| &**form);
                assert!(list.broken_bonds() > 0, "{}, {size}", body.name);
                check_alike([list, grid], &u, &format!("{}, {strains:?}", body.name));
                let breaking = |form: &dyn Force| {
                    let mut marks = vec![false; body.cloud.len()];
                    let breaking = form.capabilities().breaking.unwrap();
                    breaking.mark_endangered(&u, 0.8, &mut marks);
                    let mut left = Vec::new();
                    breaking
                        .bonds()
                        .for_each_intact(&mut |i, j| left.push([i.min(j), i.max(j)]));
                    left.sort_unstable();
                    left.dedup();
                    (marks, left)
                };
                assert_eq!(breaking(list), breaking(grid), "{}", body.name);
            }
        }
    }
}

/// A velocity Verlet run, in which breaking bonds dissipate their energy less half a step's work.
#[test]
fn runs_with_breaking_bonds_agree() {
    for body in bodies(BRITTLE) {
        let mut state = State::at_rest(body.shaken(1.0).len());
        state.v = body.shaken(0.4);
        let systems = body.both(Strains::Finite).map(|operator| {
            System::new(body.cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap()
        });
        let frequency = highest_frequency(&systems[0], &state.u).unwrap();
        let dt = frequency.stable_step(2.0, 0.4);
        let [list, grid] = systems.map(|system| {
            let verlet = Box::new(VelocityVerlet);
            let mut run = Simulation::new(system, verlet, state.clone(), dt, 25).unwrap();
            run.run(|_| Control::Continue).unwrap();
            run
        });
        let [list_force, grid_force] = [&list, &grid].map(|run| run.system().operator());
        let broken = list_force.broken_bonds();
        assert!(broken > 5, "{}: {broken}", body.name);
        assert_eq!(list_force.broken_bonds(), grid_force.broken_bonds());
        let error = difference(&grid.state().u, &list.state().u);
        assert!(error < 1e-12, "{}: {error:e}", body.name);
        let error = (grid_force.dissipated() / list_force.dissipated() - 1.0).abs();
        assert!(error < 1e-11, "{}: {error:e}", body.name);
    }
}

#[test]
fn evaluations_on_subsets_have_the_bits_of_the_whole() {
    for body in bodies(BondLimits::NONE) {
        let grid = body.operator(Strains::Finite, BondForm::Grid);
        let n = body.cloud.len();
        for size in [0.001, 0.1] {
            let u = body.shaken(size);
            let whole = force_of(&*grid, &u, PointSubset::All);
            // Values left in the rows by another evaluation.
            force_of(&*grid, &body.shaken(0.5), PointSubset::All);
            let odd: Vec<u32> = (0..n as u32).filter(|i| i % 3 == 1).collect();
            let part = force_of(&*grid, &u, PointSubset::Set(&odd));
            let range = force_of(&*grid, &u, PointSubset::Range(n / 3..n / 2));
            for k in 0..u.len() {
                let i = k % n;
                let of = |wanted: bool| if wanted { whole[k] } else { 0.0 };
                assert_eq!(part[k], of(i % 3 == 1), "{}", body.name);
                assert_eq!(range[k], of((n / 3..n / 2).contains(&i)), "{}", body.name);
            }
        }
    }
}

#[test]
fn ending_a_step_on_subsets_breaks_the_same_bonds() {
    for body in bodies(BRITTLE) {
        let [mut whole, mut parts] = [0, 1].map(|_| body.operator(Strains::Finite, BondForm::Grid));
        let u = body.shaken(0.05);
        let step = StepEnd::sub_step(0.0, 0.0, &u);
        let mut force = vec![0.0; u.len()];
        whole.end_step(&step, PointSubset::All, &mut force);
        let odd: Vec<u32> = (0..body.cloud.len() as u32)
            .filter(|i| i % 4 == 1)
            .collect();
        let mut part = vec![0.0; u.len()];
        parts.end_step(&step, PointSubset::Set(&odd), &mut part);
        let [some, all] = [&parts, &whole].map(|form| form.broken_bonds());
        assert!(some > 0 && some < all, "{}: {some} of {all}", body.name);
        assert_eq!(
            part,
            force_of(&*parts, &u, PointSubset::Set(&odd)),
            "{}",
            body.name
        );
        parts.end_step(&step, PointSubset::All, &mut part);
        assert_eq!(parts.broken_bonds(), whole.broken_bonds(), "{}", body.name);
        let error = (parts.dissipated() / whole.dissipated() - 1.0).abs();
        assert!(error < 1e-12, "{}: {error:e}", body.name);
        assert_eq!(force_of(&*parts, &u, PointSubset::All), force);
    }
}

#[test]
fn the_stencil_is_the_fastest_form_where_it_is_available() {
    let form = |body: &LinearSolidBody<'_>| body.operator(BondForm::Fastest).unwrap().form;
    for case in bodies(BRITTLE) {
        let body = LinearSolidBody::new(&case.cloud, &case.materials[0], case.correction);
        assert_eq!(form(&body), BondForm::Grid, "{}", case.name);
        let corrected = LinearSolidBody {
            surface: SolidSurface::Energy,
            ..body.clone()
        };
        assert_eq!(form(&corrected), BondForm::List);
        let by_energy = LinearSolidConstants {
            limits: BondLimits {
                energy: 1.0,
                ..BondLimits::NONE
            },
            ..case.materials[0].clone()
        };
        let by_energy = LinearSolidBody::new(&case.cloud, &by_energy, case.correction);
        assert_eq!(form(&by_energy), BondForm::List);
        for (rejected, feature) in [
            (&corrected, Feature::SurfaceCorrection),
            (&by_energy, Feature::BondEnergy),
        ] {
            assert!(rejected.features().has(feature));
            assert!(rejected.operator(BondForm::Grid).is_err());
        }
        assert!(body.operator(BondForm::FloatGrid).is_err());
    }
    let cloud = jittered(&[9, 9]);
    let constants = solid(0.2, 2.5, InfluenceFunction::Conical)
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    let body = LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None);
    assert_eq!(form(&body), BondForm::List);
    assert!(body.operator(BondForm::Grid).is_err());
}
