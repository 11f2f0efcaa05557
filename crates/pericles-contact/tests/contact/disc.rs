//! The brittle disc of LAMMPS' peridynamic example: contact by the law of EMU between fragments, broken by a spherical
//! indenter.

use std::sync::Arc;

use pericles::operator::DamageMeasure;
use pericles::prelude::*;
use pericles::{Configuration, Interaction, PointScalar, Result, Simulation};
use pericles_contact::{ContactBodies, ContactLaw, ContactPairs, PairLaw, PointContact};

use crate::setup::ELASTIC;

/// Radius of the indenter, m.
const RADIUS: f64 = 1.5e-3;

/// Force density 1e17 (R − r)² along the direction from the centre (0, 1.55 mm − 100 m/s t, 0).
struct Indenter {
    cloud: Arc<PointCloud>,
}

impl Indenter {
    fn each(&self, at: &Configuration<'_>, mut visit: impl FnMut(usize, [f64; 3], f64)) {
        let n = self.cloud.len();
        let centre = [0.0, 1.55e-3 - 100.0 * at.t, 0.0];
        for i in 0..n {
            let q: [f64; 3] =
                std::array::from_fn(|c| self.cloud.axis(c)[i] + at.u[c * n + i] - centre[c]);
            let r = q.iter().map(|q| q * q).sum::<f64>().sqrt();
            if r < RADIUS {
                visit(i, q.map(|q| q / r), RADIUS - r);
            }
        }
    }
}

impl Interaction for Indenter {
    fn name(&self) -> &str {
        "indenter"
    }

    fn check(&self, _forces: &dyn Force) -> Result<()> {
        Ok(())
    }

    fn add_force(&self, at: &Configuration<'_>, _on: &PointSubset<'_>, out: &mut [f64]) {
        let n = self.cloud.len();
        self.each(at, |i, normal, g| {
            for c in 0..3 {
                out[c * n + i] += 1e17 * g * g * normal[c];
            }
        });
    }

    fn energy(&self, at: &Configuration<'_>) -> f64 {
        let mut sum = 0.0;
        self.each(at, |i, _, g| {
            sum += self.cloud.volumes()[i] * 1e17 * g.powi(3) / 3.0;
        });
        sum
    }

    fn add_tangent(&self, _at: &Configuration<'_>, _direction: &[f64], _out: &mut [f64]) {}

    fn contact_frequency(&self, _density: &PointScalar) -> f64 {
        0.0
    }

    fn is_conservative(&self) -> bool {
        true
    }

    fn overlap(&self) -> f64 {
        0.0
    }
}

pericles::saved! {
    impl Checkpointed for Indenter {
        cloud: fixed,
    }
}

/// Points (i, j, k) in units of 0.5 mm with i² + k² ≤ 100 and −10 ≤ j ≤ 0.
fn disc(steps: u64) -> Simulation {
    let spacing = 0.5e-3;
    let mut places: Vec<[f64; 3]> = Vec::new();
    for i in -10..=10 {
        for j in -10..=0 {
            for k in -10..=10 {
                if i * i + k * k <= 100 {
                    places.push([i, j, k].map(|x| spacing * f64::from(x)));
                }
            }
        }
    }
    let n = places.len();
    assert_eq!(n, 3487);
    let x = (0..3)
        .flat_map(|c| places.iter().map(move |place| place[c]))
        .collect();
    let cloud = Arc::new(PointCloud::new(3, x, vec![1.25e-10; n], 1.0).unwrap());
    let (horizon, density, micromodulus): (f64, f64, f64) = (1.5001e-3, 2200.0, 1.6863e22);
    // c = 12 E/(π δ⁴)
    let young = micromodulus * std::f64::consts::PI * horizon.powi(4) / 12.0;
    let mut material = BondMaterial::new(ElasticModulus::Young(young), density, horizon)
        .with_critical_stretch(5e-4);
    material.volume_correction = VolumeCorrection::Linear;
    let count = DamageMeasure {
        count: true,
        count_precut: false,
    };
    let body = Body::new(cloud.clone(), material).damage(count);
    let mut system = body.build().unwrap();
    let law = ContactLaw {
        pairs: ContactPairs::All,
        law: PairLaw::Emu,
        distance: 1.35,
        closing: 0.9,
        ..ELASTIC
    };
    let bodies = ContactBodies::uniform(n, young, horizon, density);
    let contact = PointContact::new(cloud.clone(), law, bodies).unwrap();
    system.add_interaction(Box::new(contact)).unwrap();
    system
        .add_interaction(Box::new(Indenter { cloud }))
        .unwrap();
    let state = State::of(&system);
    // The work of the moving indenter is not recorded.
    Simulation::new(system, Box::new(VelocityVerlet), state, 1e-7, steps)
        .unwrap()
        .allowing_instability()
}

#[test]
fn the_disc_of_lammps_shatters_alike_until_the_breaking_rules_differ() {
    let mut run = disc(250);
    let mut found = Vec::new();
    let look = |now: &Simulation| {
        let mut damage = vec![0.0; now.system().points()];
        now.system().operator().damage_into(&mut damage);
        let mean = damage.iter().sum::<f64>() / damage.len() as f64;
        let momentum = now.system().momentum(&now.state().v)[1];
        [mean, momentum, now.snapshot().energies().kinetic]
    };
    run.run(|now| {
        if now.state().step == 100 || now.state().step == 249 {
            found.push(look(now));
        }
        Control::Continue
    })
    .unwrap();
    found[1] = look(&run);
    // LAMMPS (release of 22 July 2025), whose bonds act once more in the step in which they break, and an independent
    // program with our rule.
    let lammps = [0.00048, -1.694693e-4, 1.557792e-5];
    let ours = [
        [0.00048179, -1.6946729e-4, 1.56423e-5],
        [0.048157, -9.926433e-4, 0.0304978],
    ];
    for k in 0..3 {
        assert!((found[0][k] / lammps[k] - 1.0).abs() < 0.01, "{found:?}");
        assert!((found[0][k] / ours[0][k] - 1.0).abs() < 1e-3, "{found:?}");
        assert!((found[1][k] / ours[1][k] - 1.0).abs() < 0.01, "{found:?}");
    }
}
