//! Natural modes compared with closed forms and dense eigenvalues.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use pericles::PointScalar;
use pericles::material::{Strains, StressState};
use pericles::prelude::*;
use pericles_manifold::force::SurfaceBody;
use pericles_manifold::geodesic::{GeodesicMethod, geodesic_pairs};
use pericles_manifold::surface::{AreaRule, Surface};
use pericles_manifold::{PowerMaterial, SurfaceBond};
use pericles_statics::{ModeOptions, NaturalModes, symmetric_eigen};

use crate::bodies::Solid;

fn modes(system: &System, count: usize) -> NaturalModes {
    let options = ModeOptions {
        count,
        tolerance: 1e-7,
        ..ModeOptions::default()
    };
    let u = vec![0.0; system.dimension() * system.points()];
    let found = NaturalModes::find(options, system, (0.0, &u), Interrupt::never()).unwrap();
    println!(
        "{} iterations, {} products",
        found.iterations, found.products
    );
    found
}

/// A bar of length 1 with a horizon of `m` cells.
fn bar(cells: usize, m: f64, periodic: bool) -> System {
    let dx = 1.0 / cells as f64;
    let mut points = Grid::bar(1.0, dx, 1.0).points().unwrap();
    if periodic {
        points = points.with_periodic_faces().unwrap();
    }
    let mut material = BondMaterial::new(ElasticModulus::Young(2.0), 3.0, m * dx);
    material.volume_correction = VolumeCorrection::None;
    material.law = PairLaw::Linear;
    Body::new(points, material).build().unwrap()
}

/// Row of the stiffness over the density: −∂f_i/∂u_j/ρ for the force at point i.
fn row(system: &System, i: usize) -> Vec<f64> {
    let n = system.points();
    let (u, mut direction, mut column) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    direction[i] = 1.0;
    system
        .operator()
        .tangent_into(0.0, &u, &direction, &mut column);
    column.iter().map(|f| -f / 3.0).collect()
}

#[test]
fn frequencies_of_a_free_bar_of_nearest_neighbours_match_the_spring_chain() {
    let cells = 60;
    let system = bar(cells, 1.0, false);
    // ω_k = 2 √(c/m) sin(kπ/2N) with the stiffness c of a spring and the mass m of a point.
    let spring = -row(&system, 20)[21];
    let found = modes(&system, 6);
    assert_eq!(found.rigid_modes, 1);
    for (k, mode) in found.modes.iter().enumerate() {
        let angle = (k + 1) as f64 * PI / (2.0 * cells as f64);
        let exact = 2.0 * spring.sqrt() * angle.sin() / TAU;
        assert!(
            (mode.frequency_hz / exact - 1.0).abs() < 1e-10,
            "{k}: {mode:?}"
        );
    }
}

#[test]
fn frequencies_of_a_periodic_bar_are_double_and_match_plane_waves() {
    let cells = 48;
    for m in [1.0, 3.0] {
        let system = bar(cells, m, true);
        let row = row(&system, 0);
        let found = modes(&system, 6);
        assert_eq!(found.rigid_modes, 1);
        let groups = found.groups();
        assert_eq!(groups.len(), 3);
        for (q, group) in groups.iter().enumerate() {
            // ω(k)² of the plane wave of wavenumber k.
            let k = TAU * (q + 1) as f64 / cells as f64;
            let square: f64 = (0..cells).map(|j| row[j] * (k * j as f64).cos()).sum();
            let exact = square.sqrt() / TAU;
            assert_eq!(group.multiplicity, 2);
            assert!(
                (group.frequency_hz / exact - 1.0).abs() < 1e-10,
                "{group:?}"
            );
        }
    }
}

#[test]
fn frequencies_of_a_free_plate_match_the_dense_matrix() {
    let cloud = Arc::new(Grid::plate([1.0, 1.0], 1.0 / 7.0, 1.0).points().unwrap());
    let solid = Solid {
        cloud,
        poisson_ratio: 0.3,
        state: StressState::PlaneStress,
        strains: Strains::Small,
        cracks: vec![],
    };
    check_against_dense(&solid.system(), 3, 8);
}

/// Compares the frequencies of a free body with those of its dense stiffness matrix; volumes and density are uniform.
fn check_against_dense(system: &System, rigid: usize, count: usize) {
    let n = system.dimension() * system.points();
    let scale = 1.0 / system.density().at(0);
    let (u, mut direction, mut column) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let mut dense = Vec::new();
    for k in 0..n {
        direction.fill(0.0);
        direction[k] = 1.0;
        system
            .operator()
            .tangent_into(0.0, &u, &direction, &mut column);
        dense.extend(column.iter().map(|f| -f * scale));
    }
    let symmetric = (0..n * n).map(|e| 0.5 * (dense[e] + dense[(e % n) * n + e / n]));
    let (values, _) = symmetric_eigen(n, symmetric.collect());
    let found = modes(system, count);
    assert_eq!(found.rigid_modes, rigid);
    for (k, mode) in found.modes.iter().enumerate() {
        let exact = values[rigid + k].sqrt() / TAU;
        let error = (mode.frequency_hz / exact - 1.0).abs();
        assert!(
            error < 1e-10,
            "{k}: {mode:?} {exact}",
            mode = mode.frequency_hz
        );
    }
}

#[test]
fn frequencies_of_a_free_bar_of_three_neighbours_match_the_dense_matrix() {
    check_against_dense(&bar(60, 3.0, false), 1, 6);
}

#[test]
fn frequencies_of_a_free_cube_match_the_dense_matrix() {
    let cloud = Arc::new(Grid::block([1.0; 3], 0.25).points().unwrap());
    let solid = Solid {
        cloud,
        poisson_ratio: 0.25,
        state: StressState::Spatial,
        strains: Strains::Small,
        cracks: vec![],
    };
    check_against_dense(&solid.system(), 6, 6);
}

#[test]
fn modes_of_a_sphere_are_spherical_harmonics_of_each_component() {
    // With p = 2 the displacement components vibrate independently: three times 2 l + 1 spherical harmonics
    // of degree l.
    let surface = Surface::icosphere(2, 1.0).unwrap();
    let areas = surface.vertex_areas(AreaRule::Barycentric);
    let cloud = Arc::new(surface.points(areas).unwrap());
    let pairs = geodesic_pairs(&surface, 0.8, GeodesicMethod::Exact).unwrap();
    let material = PowerMaterial {
        density: 1.0,
        kappa: 1.0,
        alpha: 0.25,
        p: 2.0,
        horizon: 0.8,
        bond: SurfaceBond::Displacement,
        self_interaction: false,
        critical_stretch: f64::INFINITY,
    };
    let body = SurfaceBody {
        surface: &surface,
        cloud: &cloud,
        pairs: &pairs,
        material: &material,
        stiffness: &[],
        no_fail: &[],
    };
    let force = body.operator().unwrap();
    let system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
    let found = modes(&system, 24);
    // These bonds resist all relative displacements, including rotations.
    assert_eq!(found.rigid_modes, 3);
    let groups = found.groups();
    let multiplicities: Vec<usize> = groups.iter().map(|group| group.multiplicity).collect();
    assert_eq!(multiplicities, [9, 15]);
    // Dense eigenvalues of one component, symmetrised by the square roots of the areas.
    let (n, areas) = (cloud.len(), cloud.volumes());
    let (mut direction, mut column) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
    let mut dense = vec![0.0; n * n];
    let linear = system.operator().as_linear().unwrap();
    for j in 0..n {
        direction[j] = 1.0;
        linear.apply_into(&direction, &mut column);
        direction[j] = 0.0;
        for i in 0..n {
            dense[i * n + j] = -column[i] * (areas[i] / areas[j]).sqrt();
        }
    }
    let symmetric = (0..n * n).map(|e| 0.5 * (dense[e] + dense[(e % n) * n + e / n]));
    let (values, _) = symmetric_eigen(n, symmetric.collect());
    for (group, place) in groups.iter().zip([1, 4]) {
        let exact = values[place].sqrt() / TAU;
        assert!(
            (group.frequency_hz / exact - 1.0).abs() < 1e-10,
            "{group:?} {exact}"
        );
    }
}

/// A free linear block of 10 × 5 × 4 lengths, with this number of cells in four lengths.
fn block(cells: u32) -> System {
    let dx = 0.04 / f64::from(cells);
    let mut material = BondMaterial::new(ElasticModulus::Young(65e9), 2500.0, 3.0 * dx);
    material.law = PairLaw::Linear;
    let cloud = Arc::new(Grid::block([0.1, 0.05, 0.04], dx).points().unwrap());
    Body::new(cloud, material).build().unwrap()
}

fn modes_to(tolerance: f64, system: &System) -> NaturalModes {
    let options = ModeOptions {
        tolerance,
        ..ModeOptions::default()
    };
    let u = vec![0.0; system.dimension() * system.points()];
    let found = NaturalModes::find(options, system, (0.0, &u), Interrupt::never()).unwrap();
    println!(
        "{} points: {} iterations, {} products",
        system.points(),
        found.iterations,
        found.products
    );
    found
}

#[test]
fn iterations_for_twelve_modes_of_a_free_block_do_not_grow_with_its_points() {
    // Unless rigid-body motions are removed from all iterates, they grow from round-off in the larger block after about ten
    // iterations.
    for cells in [4, 16] {
        assert!(modes_to(1e-6, &block(cells)).iterations <= 26);
    }
}

/// Prints the effort of twelve modes of a large body.
#[test]
#[ignore = "takes a minute"]
fn effort_of_the_modes_of_a_large_block() {
    let start = std::time::Instant::now();
    modes_to(1e-6, &block(32));
    println!("{:?}", start.elapsed());
}
