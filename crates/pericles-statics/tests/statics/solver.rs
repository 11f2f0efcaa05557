//! Number of products with the tangent, which does not grow with the body.

use pericles::prelude::*;
use pericles_statics::{Effort, Equilibrium, StaticOptions, Target};

use crate::bodies::{constrained_plate, pulled_plate, sheared_bar};

/// Effort of the static state of a linear body at a tolerance of 1e-6.
fn effort(system: &System) -> Effort {
    let entries = system.dimension() * system.points();
    let mut free = vec![1.0; entries];
    system.hold_at(0.0, &mut free);
    let mut load = vec![0.0; entries];
    system.load_density_into(0.0, &mut load);
    let mut solver = Equilibrium::new(StaticOptions::default(), system, free);
    let (mut u, mut supports) = (vec![0.0; entries], vec![0.0; entries]);
    system.place_on(0.0, &PointSubset::All, &mut supports);
    let target = Target {
        place: 0.0,
        t: 0.0,
        load: &load,
        supports: &supports,
        largest: 0.0,
        tolerance: StaticOptions::default().tolerance,
    };
    let found = solver.find(system, &target, &mut u, Interrupt::never());
    let effort = found.unwrap();
    println!(
        "{} points: {effort:?}, levels {:?}",
        system.points(),
        solver.multigrid().sizes()
    );
    effort
}

#[test]
fn plate_with_a_hole_needs_at_most_twenty_products_at_every_size() {
    for cells in [40, 80] {
        assert!(effort(&pulled_plate(cells, 1.0 / 3.0, vec![])).products <= 20);
    }
}

#[test]
fn poisson_ratio_of_0_4_needs_at_most_thirty_products_at_every_size() {
    for cells in [40, 80] {
        assert!(effort(&pulled_plate(cells, 0.4, vec![])).products <= 30);
    }
}

#[test]
fn half_cracked_plate_needs_at_most_twenty_products() {
    let crack = || Crack::Segment {
        from: [-0.5, 0.2],
        to: [0.0, 0.2],
    };
    for cells in [40, 80] {
        assert!(effort(&pulled_plate(cells, 1.0 / 3.0, vec![crack()])).products <= 20);
    }
}

#[test]
fn bar_in_space_needs_at_most_twenty_products_at_every_size() {
    for n in [8, 12] {
        assert!(effort(&sheared_bar(n, 0.25, vec![])).products <= 20);
    }
}

#[test]
fn bar_with_a_half_through_crack_needs_at_most_twenty_products() {
    let crack = Crack::Polygon {
        corners: vec![
            [1.0, -1.0, 0.5],
            [1.0, 2.0, 0.5],
            [1.0, 2.0, 2.0],
            [1.0, -1.0, 2.0],
        ],
    };
    assert!(effort(&sheared_bar(8, 0.25, vec![crack])).products <= 20);
}

#[test]
fn plate_with_prescribed_displacements_needs_at_most_thirty_products() {
    // At most ten to a residual of 0.1 after the motion of the constraints, the rest to 1e-6.
    for cells in [20, 40, 80] {
        assert!(effort(&constrained_plate(cells)).products <= 30);
    }
}

/// Prints the number of products for large bodies.
#[test]
#[ignore = "takes minutes"]
fn products_of_large_bodies() {
    let crack = || Crack::Segment {
        from: [-0.5, 0.2],
        to: [0.0, 0.2],
    };
    for cells in [120, 240] {
        for nu in [0.25, 1.0 / 3.0, 0.4, 0.45, 0.49] {
            let [whole, cracked] = [vec![], vec![crack()]]
                .map(|cracks| effort(&pulled_plate(cells, nu, cracks)).products);
            println!("plate {cells}, {nu}: {whole}, cracked {cracked}");
        }
    }
    for n in [16, 20] {
        for nu in [0.25, 0.4, 0.45, 0.49] {
            let products = effort(&sheared_bar(n, nu, vec![])).products;
            println!("bar {n}, {nu}: {products}");
        }
    }
}
