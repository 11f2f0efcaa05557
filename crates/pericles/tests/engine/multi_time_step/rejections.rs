//! Invalid options are errors.

use pericles::PericlesError;
use pericles::time::{Fine, Follow, MultiTimeStep, MultiTimeStepOptions, Respa, Tableau};

use super::bodies::plate;
use super::schemes::options;
use crate::common::points;

#[test]
fn invalid_options_are_errors() {
    let (system, _, fine, _) = plate();
    let rejected = |ratio, fine| {
        let options = MultiTimeStepOptions {
            fine,
            ..options(ratio, &vec![])
        };
        match MultiTimeStep::new(&Tableau::rk4(), options, &system) {
            Ok(_) => panic!("invalid options were accepted"),
            Err(error) => error,
        }
    };
    assert!(matches!(
        rejected(0, Fine::Fixed(vec![fine.clone()])),
        PericlesError::StepRatio { ratio: 0 }
    ));
    assert!(matches!(
        rejected(2, Fine::Fixed(vec![fine.clone(), vec![]])),
        PericlesError::FineRegionEmpty { region: 1 }
    ));
    assert!(matches!(
        rejected(2, Fine::Fixed(vec![fine.clone(), fine[7..9].to_vec()])),
        PericlesError::FineRegionsOverlap {
            first: 0,
            second: 1,
            ..
        }
    ));
    let strip = points(system.cloud(), |x, _, _| (x - 0.5).abs() < 0.021);
    assert!(matches!(
        rejected(2, Fine::Fixed(vec![strip])),
        PericlesError::FineRegionThin { axis: 'x', .. }
    ));
    for follow in [
        Follow {
            threshold: 1.0,
            ..Follow::default()
        },
        Follow {
            every: 0,
            ..Follow::default()
        },
        Follow {
            layers: 0,
            ..Follow::default()
        },
    ] {
        assert!(matches!(
            rejected(2, Fine::Adaptive(follow)),
            PericlesError::SchemeParameter { .. }
        ));
    }
    let pair = MultiTimeStep::new(&Tableau::dormand_prince(), options(2, &fine), &system);
    assert!(matches!(pair, Err(PericlesError::SchemeNotUsable { .. })));
    // A layer at the boundary of the body may be thin, and several regions are allowed.
    let [left, right] = [
        points(system.cloud(), |x, _, _| x < 0.03),
        points(system.cloud(), |x, _, _| (x - 0.7).abs() < 0.1),
    ];
    assert!(Respa::new(2, Fine::Fixed(vec![left, right]), &system).is_ok());
}
