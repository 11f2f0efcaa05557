//! Fragments of cut bodies.

use std::sync::Arc;

use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::Influence;
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw, StressState,
};
use pericles::observe::{FragmentCount, Fragments};
use pericles::operator::{BondBody, BondForm};
use pericles::space::{Grid, Shape};

/// A plate of 12 × 8 cells cut to the right of its fourth and tenth columns, and around the cell in its lower left
/// corner.
fn pieces(form: BondForm) -> Fragments {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![12.0, 8.0],
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    let cloud = Arc::new(grid.points().unwrap());
    let material = BondMaterial {
        law: PairLaw::BondStretch,
        density: 1.0,
        modulus: Modulus {
            value: ElasticModulus::Young(1.0),
            calibration: Calibration::Continuum,
        },
        horizon: 3.0,
        influence: Influence::default(),
        volume_correction: VolumeCorrection::Extended,
        fracture: Fracture::CriticalStretch(0.1),
    };
    let cut = |from, to| (Crack::Segment { from, to }, EndRule::Closed);
    let constants = material.constants(&cloud, StressState::PlaneStress);
    let constants = constants.unwrap();
    let body = BondBody {
        cracks: &[
            cut([4.0, -1.0], [4.0, 9.0]),
            cut([10.0, -1.0], [10.0, 9.0]),
            cut([1.0, -1.0], [1.0, 1.0]),
            cut([-1.0, 1.0], [1.0, 1.0]),
        ],
        ..BondBody::new(&cloud, &material, &constants)
    };
    let operator = body.operator(form).unwrap().operator;
    Fragments::of(&*operator, cloud.domain())
}

#[test]
fn cuts_give_the_same_fragments_on_stencil_and_neighbour_list() {
    let grid = pieces(BondForm::Grid);
    // Stencil and list may number points differently; the counts do not depend on it.
    let (grid, list) = (
        grid.count(&[0.5; 96], 0.2),
        pieces(BondForm::List).count(&[0.5; 96], 0.2),
    );
    assert_eq!(grid, list);
    let expected = FragmentCount {
        fragments: 2,
        largest: 24.0,
        small: 1,
        small_mass: 8.0,
        single: 1,
        single_mass: 0.5,
    };
    assert_eq!(grid, expected);
}
