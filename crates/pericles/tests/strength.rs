//! Strength that varies randomly from point to point.

use std::sync::Arc;

use pericles::StepEnd;
use pericles::family::{BondList, VolumeCorrection};
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, BondLimits, BondMaterial, ElasticModulus, GivenConstants, InterfaceRule,
    LinearSolid, MaterialPairs, PairLaw, Scattered, StateInfluence, StrengthScatter, StressState,
};
use pericles::operator::{BondBody, BondForm, CompositeBody, Force, LinearSolidBody, PointSubset};
use pericles::space::{Grid, PointCloud};

const LIMIT: f64 = 0.05;
const HORIZON: f64 = 2.5;

fn plate() -> Arc<PointCloud> {
    Arc::new(Grid::plate([17.0, 9.0], 1.0, 1.0).points().unwrap())
}

/// Stretches of about the critical stretch that depend on the direction.
fn displacement(cloud: &PointCloud) -> Vec<f64> {
    let n = cloud.len();
    let of = |entry: usize| {
        let [x, y, _] = cloud.point(entry % n);
        match entry / n {
            0 => 0.05 * x + 0.01 * y + 0.02 * (0.7 * y).sin(),
            _ => 0.045 * y + 0.02 * (0.5 * x).cos(),
        }
    };
    (0..2 * n).map(of).collect()
}

fn factors(cloud: &PointCloud, of: Scattered) -> Vec<f64> {
    let scatter = StrengthScatter {
        of,
        shape: 6.0,
        seed: 11,
    };
    scatter.factors(cloud).unwrap()
}

/// Number of bonds whose stretch exceeds the critical stretch times the mean factor of their ends.
fn expected(cloud: &Arc<PointCloud>, u: &[f64], factors: &[f64]) -> u64 {
    let bonds = BondList::new(cloud, HORIZON, VolumeCorrection::None).unwrap();
    let n = cloud.len();
    let mut count = 0;
    for i in 0..n {
        for (_, j) in bonds.family(i).filter(|&(_, j)| j > i) {
            let [a, b] = [i, j].map(|k| cloud.point(k));
            let (mut before, mut after) = (0.0, 0.0);
            for c in 0..2 {
                let xi = b[c] - a[c];
                before += xi * xi;
                after += (xi + u[c * n + j] - u[c * n + i]).powi(2);
            }
            let stretch = (after / before).sqrt() - 1.0;
            count += u64::from(stretch > 0.5 * LIMIT * (factors[i] + factors[j]));
        }
    }
    count
}

fn broken(force: &mut dyn Force, u: &[f64]) -> u64 {
    let rest = vec![0.0; u.len()];
    let end = StepEnd::start(0.0, u, &rest);
    force.end_step(&end, PointSubset::All, &mut vec![0.0; u.len()]);
    force.broken_bonds()
}

#[test]
fn bonds_break_at_the_mean_strength_of_their_end_points() {
    let cloud = plate();
    let (n, u) = (cloud.len(), displacement(&cloud));
    for of in [Scattered::CriticalStretch, Scattered::FractureEnergy] {
        let factors = factors(&cloud, of);
        let wanted = expected(&cloud, &u, &factors);
        let even = expected(&cloud, &u, &vec![1.0; n]);
        assert!(wanted > 100 && wanted != even, "{wanted} {even}");

        let mut material = BondMaterial::new(ElasticModulus::Young(10.0), 1.0, HORIZON);
        material.law = PairLaw::BondStretch;
        material.volume_correction = VolumeCorrection::None;
        let mut constants = material
            .constants(&cloud, StressState::PlaneStress)
            .unwrap();
        constants.critical_stretch = LIMIT;
        let all = [constants.clone()];
        let classes = MaterialPairs::new(vec![0; n], &all, InterfaceRule::default()).unwrap();
        let classes = classes.with_strengths(factors.clone()).unwrap();
        let body = CompositeBody {
            classes: Some(&classes),
            ..CompositeBody::from(BondBody::new(&cloud, &material, &constants))
        };
        for form in [BondForm::List, BondForm::Grid] {
            let mut force = body.operator(form).unwrap().operator;
            assert_eq!(broken(&mut *force, &u), wanted, "{form:?}");
        }

        let solid = LinearSolid {
            density: 1.0,
            elastic: GivenConstants {
                young: Some(10.0),
                poisson_ratio: Some(0.3),
                ..GivenConstants::default()
            },
            horizon: HORIZON,
            influence: StateInfluence::Function(InfluenceFunction::Constant),
            volume_correction: VolumeCorrection::None,
            failure: BondFailure::Unbreakable,
        };
        let mut constants = solid.constants(&cloud, StressState::PlaneStress).unwrap();
        constants.limits = BondLimits {
            stretch: LIMIT,
            ..BondLimits::NONE
        };
        let classes = constants.uniform().with_strengths(factors);
        let body = LinearSolidBody {
            classes: Some(&classes),
            ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
        };
        for form in [BondForm::List, BondForm::Grid] {
            let mut force = body.operator(form).unwrap().operator;
            assert_eq!(broken(&mut *force, &u), wanted, "state-based, {form:?}");
        }
    }
}

/// Factors depend on the number of a point in output files.
#[test]
fn strength_factors_follow_the_numbers_of_points_in_output_files() {
    let cloud = plate();
    let scatter = StrengthScatter {
        of: Scattered::CriticalStretch,
        shape: 6.0,
        seed: 11,
    };
    let factors = factors(&cloud, Scattered::CriticalStretch);
    for (i, factor) in factors.iter().enumerate() {
        assert_eq!(*factor, scatter.factor(cloud.user_number(i) as u64));
    }
    let other = StrengthScatter {
        seed: 12,
        ..scatter
    };
    assert_ne!(other.factor(0), scatter.factor(0));
    let wrong = StrengthScatter {
        shape: 0.1,
        ..scatter
    };
    let error = wrong.factors(&cloud).unwrap_err().to_string();
    assert!(
        error.contains("0.1") && error.contains("0.5 to 1000"),
        "{error}"
    );
}
