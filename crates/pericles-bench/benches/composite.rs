//! CPU time per directed bond of one thread for bodies with bond-dependent factors and state-based materials,
//! stencil against list: the forms alternate, medians are reported.
//!
//! `cargo bench -p pericles-bench --bench composite [CELLS]`; the default is 32 cells per side.

use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, InterfaceRule, MaterialPairs, Modulus,
    PairLaw, StressState, SurfaceCorrection,
};
use pericles::observe::Field;
use pericles::operator::{BondBody, BondForm, CompositeBody, Force, PointSubset};
use pericles::space::{Grid, PointCloud, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{PointScalar, Simulation, System};

use pericles_bench::cpu_seconds;

const ROUNDS: usize = 15;

fn material(law: PairLaw, young: f64) -> BondMaterial {
    BondMaterial {
        law,
        density: 1.0,
        modulus: Modulus {
            value: ElasticModulus::Young(young),
            calibration: Calibration::Continuum,
        },
        horizon: 3.015,
        influence: Influence::default(),
        volume_correction: VolumeCorrection::Linear,
        fracture: Fracture::Unbreakable,
    }
}

/// Composition of the body.
#[derive(Clone, Copy)]
enum Parts {
    One,
    Halves,
    Grains,
    CorrectedSurface,
    GreenStrain,
}

impl Parts {
    const ALL: [Self; 5] = [
        Self::One,
        Self::Halves,
        Self::Grains,
        Self::CorrectedSurface,
        Self::GreenStrain,
    ];

    fn words(self) -> &'static str {
        match self {
            Self::One => "one material",
            Self::Halves => "two halves",
            Self::Grains => "grains of 6 cells",
            Self::CorrectedSurface => "corrected surface",
            Self::GreenStrain => "Green-strain law",
        }
    }

    fn material_of(self, [x, y, z]: [f64; 3], cells: f64) -> u8 {
        match self {
            Self::Halves => u8::from(x > 0.5 * cells),
            Self::Grains => ((x / 6.0) as u8 + (y / 6.0) as u8 + (z / 6.0) as u8) % 2,
            _ => 0,
        }
    }
}

fn operator(cloud: &Arc<PointCloud>, parts: Parts, cells: f64, form: BondForm) -> Box<dyn Force> {
    let law = match parts {
        Parts::GreenStrain => PairLaw::GreenStrain,
        _ => PairLaw::BondStretch,
    };
    let all = [1.0, 3.0].map(|young| material(law, young));
    let constants = all
        .each_ref()
        .map(|one| one.constants(cloud, StressState::Spatial).unwrap());
    let numbers = (0..cloud.len()).map(|i| parts.material_of(cloud.point(i), cells));
    let classes =
        MaterialPairs::new(numbers.collect(), &constants, InterfaceRule::Harmonic).unwrap();
    let several = matches!(parts, Parts::Halves | Parts::Grains);
    let body = CompositeBody {
        classes: several.then_some(&classes),
        correction: match parts {
            Parts::CorrectedSurface => SurfaceCorrection::Energy,
            _ => SurfaceCorrection::None,
        },
        ..CompositeBody::from(BondBody::new(cloud, &all[0], &constants[0]))
    };
    body.operator(form).unwrap().operator
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn ns_per_bond(bonds: u64, work: impl FnOnce()) -> f64 {
    let start = cpu_seconds();
    work();
    1e9 * (cpu_seconds() - start) / bonds as f64
}

fn main() {
    let given = std::env::args().skip(1).find_map(|text| text.parse().ok());
    let cells: f64 = given.unwrap_or(32.0);
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![cells; 3],
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    let cloud = Arc::new(grid.points().unwrap());
    let n = cloud.len();
    let wave = |k: usize| {
        let [x, y, z] = cloud.point(k % n);
        0.01 * (0.3 * x + 0.2 * y - 0.1 * z + (k / n) as f64).sin()
    };
    let u: Vec<f64> = (0..3 * n).map(wave).collect();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let forms = [BondForm::Grid, BondForm::List];
    pool.install(|| {
        println!(
            "{:24} {:>10} {:>10} {:>12}",
            "force", "stencil", "list", "list/stencil"
        );
        for parts in Parts::ALL {
            let forces = forms.map(|form| operator(&cloud, parts, cells, form));
            let mut out = vec![0.0; u.len()];
            let mut times = [Vec::new(), Vec::new()];
            for _ in 0..ROUNDS {
                for (force, times) in forces.iter().zip(&mut times) {
                    let work = || force.add_force(0.0, &u, PointSubset::All, &mut out);
                    times.push(ns_per_bond(force.directed_bonds(), work));
                }
            }
            let [stencil, list] = times.map(median);
            let words = parts.words();
            println!(
                "{words:24} {stencil:10.2} {list:10.2} {:12.2}",
                list / stencil
            );
        }
        let runs = forms.map(|form| {
            let force = operator(&cloud, Parts::One, cells, form);
            let bonds = force.directed_bonds();
            let system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
            let mut state = State::at_rest(3 * n);
            state.u.copy_from_slice(&u);
            let scheme = Box::new(VelocityVerlet);
            (
                bonds,
                Simulation::new(system, scheme, state, 0.1, 1).unwrap(),
            )
        });
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..ROUNDS {
            for ((bonds, run), times) in runs.iter().zip(&mut times) {
                let work = || {
                    run.snapshot().field(Field::Stress);
                };
                times.push(ns_per_bond(*bonds, work));
            }
        }
        let [stencil, list] = times.map(median);
        println!(
            "{:24} {stencil:10.2} {list:10.2} {:12.2}",
            "stress",
            list / stencil
        );
    });
}
