//! Studies are found by name, their data contain valid names only, and the judged rows of the inexpensive ones are
//! within tolerance.

use super::*;

fn hold(ids: &[&str]) {
    let context = Context {
        full: false,
        figures: None,
        tell: &|_| {},
    };
    for id in ids {
        let rows = find(id).unwrap().run(&context).unwrap();
        let failed: Vec<&Row> = rows.iter().filter(|r| r.pass() == Some(false)).collect();
        assert!(failed.is_empty(), "{id}: {failed:#?}");
        assert!(rows.iter().any(|row| row.pass() == Some(true)), "{id}");
        for row in rows {
            let shown = row.case.contains("wall time") || row.agreement().is_some();
            assert_ne!(row.pass().is_some(), shown, "{id}: {row:#?}");
        }
    }
}

/// Runs every study of a topic.
fn hold_all_of(topic: &Topic) {
    let ids: Vec<&str> = topic.studies.iter().map(|(id, _)| *id).collect();
    hold(&ids);
}

#[test]
fn dispersion_studies_are_within_tolerance() {
    hold(&[
        "dispersion/one-dimensional",
        "dispersion/two-dimensional",
        "dispersion/three-dimensional",
        "dispersion/influence",
        "dispersion/critical-stretch",
    ]);
}

#[test]
fn manifold_studies_are_within_tolerance() {
    hold(&[
        "manifolds/geodesics",
        "manifolds/figure-2",
        "manifolds/convergence",
    ]);
}

#[test]
fn absorbing_boundary_studies_are_within_tolerance() {
    hold(&[
        "absorbing-boundaries/table-1",
        "absorbing-boundaries/damping-layer",
        "absorbing-boundaries/midpoint",
        "absorbing-boundaries/strip",
    ]);
}

/// Runs every study but `cost`, whose wall times take a minute.
#[test]
fn multirate_studies_are_within_tolerance() {
    hold(&[
        "multi-time-step/plate",
        "multi-time-step/plate-nonlinear",
        "multi-time-step/block",
        "multi-time-step/crack",
        "multi-time-step/stability",
        "multi-time-step/energy",
        "multi-time-step/inclusion",
        "multi-time-step/two-grid",
    ]);
}

#[test]
fn nonlocal_wave_studies_are_within_tolerance() {
    hold_all_of(&nonlocal_wave::TOPIC);
}

#[test]
fn numerics_studies_are_within_tolerance() {
    hold_all_of(&numerics::TOPIC);
}

#[test]
fn state_based_studies_are_within_tolerance() {
    hold_all_of(&state_based::TOPIC);
}

#[test]
fn contact_studies_are_within_tolerance() {
    hold_all_of(&contact::TOPIC);
}

/// Runs every study but `thermal-shock`, which takes a minute.
#[test]
fn heat_studies_are_within_tolerance() {
    hold(&[
        "heat/slabs",
        "heat/plane-waves",
        "heat/balance",
        "heat/expansion",
        "heat/bimaterial-strip",
    ]);
}

/// The notched plate takes a minute.
#[test]
fn statics_studies_are_within_tolerance() {
    hold(&["statics/solver", "statics/kirsch"]);
}

#[test]
fn comparisons_with_experiments_keep_their_balances() {
    hold(&["validation/glass-crack-speed"]);
}

#[test]
#[ignore = "takes minutes"]
fn all_comparisons_with_experiments_keep_their_balances() {
    hold_all_of(&validation::TOPIC);
}

#[test]
fn studies_are_found_by_name_only() {
    for study in studies() {
        assert_eq!(find(study.id).ok().map(|s| s.id), Some(study.id));
    }
    let Err(RunError::Unknown { hint, .. }) = find("fracture/branch") else {
        panic!("found");
    };
    assert!(hint.contains("fracture/branching"), "{hint}");
    let Err(RunError::Unknown { hint, .. }) = find("zzz") else {
        panic!("found");
    };
    assert!(!hint.contains("did you mean"), "{hint}");
}

#[test]
fn one_failing_row_fails_a_study() {
    let information = Row::new("a", "", Some(f64::NAN));
    let holds = Row::new("b", "", Some(1.0)).within(1.0, 0.0);
    let fails = Row::new("c", "", None).within(1.0, 1.0);
    assert!(all_hold(&[]));
    assert!(all_hold(&[information.clone(), holds.clone()]));
    assert!(!all_hold(&[information, fails, holds]));
}

#[test]
fn names_are_unique() {
    for (k, study) in studies().enumerate() {
        assert!(studies().take(k).all(|other| other.id != study.id));
    }
}

#[test]
fn study_data_name_existing_functions_and_judge_every_row_but_wall_times() {
    for study in studies() {
        assert_eq!(study.faults(), [""; 0], "{}", study.id);
    }
}
