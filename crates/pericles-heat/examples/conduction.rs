//! Time of one evaluation of heat conduction and of the forces of the same body, and the number of products of a steady state.
//!
//! ```sh
//! cargo run --release -p pericles-heat --example conduction -- 100
//! ```

use std::sync::Arc;
use std::time::Instant;

use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;
use pericles::material::StressState;
use pericles::prelude::*;
use pericles::{PointScalar, Temperature};
use pericles_heat::{
    Condition, DiffusingField, DiffusionBody, FieldOptions, Interface, Kind, Problem, Scheme,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cells: usize = std::env::args()
        .nth(1)
        .map_or(Ok(60), |text| text.parse())?;
    println!(
        "{:>4} {:>9} {:>10} {:>18} {:>18} {:>9}",
        "dim", "points", "bonds", "heat, ns per bond", "force, ns per bond", "products"
    );
    for dimension in [2, 3] {
        let dx = 1e-3;
        let cells = if dimension == 2 {
            cells * cells / 2
        } else {
            cells
        };
        let side = cells as f64 * dx;
        let grid = match dimension {
            2 => Grid::plate([side, side], dx, dx),
            _ => Grid::block([side; 3], dx),
        };
        let cloud = Arc::new(grid.points()?);
        let body = DiffusionBody {
            cloud: cloud.clone(),
            influence: Influence::default(),
            horizon: 3.0 * dx,
            horizons: None,
            correction: VolumeCorrection::Extended,
            conductivity: PointScalar::Uniform(45.0),
            interface: Interface::Harmonic,
            surface_correction: true,
            prescribed: Vec::new(),
            broken_share: 0.0,
        };
        let diffusion = body.build()?;
        let bonds = diffusion.directed_bonds() as f64;
        let values: Vec<f64> = (0..cloud.len()).map(|i| 300.0 + (i as f64).sin()).collect();
        let mut out = vec![0.0; cloud.len()];
        let heat = per_bond(bonds, &mut || diffusion.add_flow(&values, &mut out));

        let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3.0 * dx);
        let mut system = Body::new(cloud.clone(), steel);
        if dimension == 2 {
            system = system.stress_state(StressState::PlaneStress);
        }
        let system = system.build()?;
        let u: Vec<f64> = (0..dimension * cloud.len())
            .map(|k| 1e-9 * (k as f64).sin())
            .collect();
        let mut force = vec![0.0; u.len()];
        let bonds_of_force = system.operator().directed_bonds() as f64;
        let mechanics = per_bond(bonds_of_force, &mut || {
            system
                .operator()
                .add_force(0.0, &u, pericles::operator::PointSubset::All, &mut force);
        });

        let ends = |low: f64, high: f64, value: f64| Condition {
            name: "end".into(),
            points: (0..cloud.len() as u32)
                .filter(|&i| (low..high).contains(&cloud.axis(0)[i as usize]))
                .collect(),
            kind: Kind::Prescribed(Arc::new(move |_, _| value)),
        };
        let conditions = vec![
            ends(0.0, 3.0 * dx, 400.0),
            ends(side - 3.0 * dx, side, 300.0),
        ];
        let capacity = cloud
            .volumes()
            .iter()
            .map(|volume| 3.6e6 * volume)
            .collect();
        let problem = Problem::new(diffusion, capacity, conditions)?;
        let options = FieldOptions {
            scheme: Scheme::Steady,
            step: None,
            dissipation: 0.0,
        };
        let field = DiffusingField::new(problem, options, 0.0, vec![300.0; cloud.len()])?.shared();
        field.temperatures_into(1.0, &mut out);
        println!(
            "{dimension:>4} {:>9} {bonds:>10} {heat:>18.3} {mechanics:>18.3} {:>9}",
            cloud.len(),
            field.effort().most
        );
    }
    Ok(())
}

/// Returns the shortest of several times of an evaluation in ns per bond.
fn per_bond(bonds: f64, evaluate: &mut dyn FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..20 {
        let start = Instant::now();
        evaluate();
        best = best.min(start.elapsed().as_secs_f64());
    }
    1e9 * best / bonds
}
