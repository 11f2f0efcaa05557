//! Reference values of an independent implementation in Python: a cloud of 3³ displaced cells, δ = 2.3, E = 10, ν =
//! 0.3.

use crate::bodies::{jittered, solid, wave};
use crate::setup::{Operator, difference, force_at, operator, plastic, scaled, step, viscous};
use pericles::kernel::InfluenceFunction;
use pericles::material::StressState;
use pericles::operator::{Force, InstructionSet};
use pericles_solids::inelastic::Inelasticity;

/// The middle point of the cloud.
const POINT: usize = 13;

/// The force density after steps of the given lengths to multiples of a wave. The force within a step is that at
/// its end.
fn after(
    law: &Inelasticity,
    function: InfluenceFunction,
    steps: &[[f64; 2]],
    set: InstructionSet,
) -> (Operator<3>, Vec<f64>) {
    let cloud = jittered(&[3, 3, 3]);
    let u = wave(&cloud, 0.02);
    let constants = solid(0.3, 2.3, function)
        .constants(&cloud, StressState::Spatial)
        .unwrap();
    let mut operator = operator::<3>(&cloud, &constants, law);
    operator.use_instruction_set(set);
    let rest = scaled(&u, 0.0);
    step(&mut operator, [0.0, 0.0], &rest, &rest);
    let (mut t, mut before, mut force) = (0.0, rest, Vec::new());
    for &[dt, size] in steps {
        t += dt;
        let now = scaled(&u, size);
        let within = force_at(&operator, t, &now);
        force = step(&mut operator, [t, dt], &before, &now);
        assert!(difference(&within, &force) < 1e-12);
        before = now;
    }
    (operator, force)
}

fn close(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
}

#[test]
fn a_viscous_cloud_equals_the_reference() {
    let law = viscous(&[[0.5, 1.0]]);
    let expected = [0.07701228774449795, 0.1269351162965556, 0.0280197783249457];
    for set in InstructionSet::available() {
        let steps = [[0.1, 1.0], [0.9, 1.0], [0.5, 0.0]];
        let (_, force) = after(&law, InfluenceFunction::Constant, &steps, set);
        for (c, value) in expected.iter().enumerate() {
            close(force[27 * c + POINT], *value);
        }
    }
}

#[test]
fn plastic_clouds_equal_the_reference() {
    let law = plastic(0.2, 0.0);
    let constant = [
        -0.03772934434609326,
        -0.07319166634852241,
        -0.01217509743997263,
    ];
    let inverse = [
        -0.02110180599088214,
        -0.04154903882595068,
        0.0008067709173736242,
    ];
    for (function, expected, psi0, multiplier) in [
        (
            InfluenceFunction::Constant,
            constant,
            0.001819774241005776,
            1.024034583012235,
        ),
        (
            InfluenceFunction::Inverse,
            inverse,
            0.001894126166274558,
            0.8589956013384958,
        ),
    ] {
        for set in InstructionSet::available() {
            let steps = [[1.0, 0.5], [1.0, 1.0], [1.0, 0.5]];
            let (operator, force) = after(&law, function.clone(), &steps, set);
            let solid = &operator;
            close(0.5 * solid.shape(POINT).unwrap().strength.powi(2), psi0);
            close(solid.history_of(POINT)[1], multiplier);
            assert!((0..27).all(|i| solid.history_of(i)[1] > 0.0));
            for (c, value) in expected.iter().enumerate() {
                close(force[27 * c + POINT], *value);
            }
        }
    }
}
