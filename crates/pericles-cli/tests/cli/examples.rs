//! Every example runs and reproduces its stored values.
//!
//! `expected.toml` beside the decks lists them: for each deck the file, column, row, value and relative tolerance, and
//! under `set` overrides for decks that would take long.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{pericles, report, succeed, text};
use pericles_io::{CsvData, read_csv};

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples")
}

/// Runs an example with overrides and returns the output folder.
fn run(place: &Path, deck: &str, changes: &[&str]) -> PathBuf {
    let deck = examples().join(deck).canonicalize().unwrap();
    let mut command = pericles(place);
    command
        .arg("run")
        .arg(deck)
        .args(["--quiet", "--out", "out"]);
    for change in changes {
        command.args(["--set", change]);
    }
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    let out = place.join("out");
    assert_eq!(report(&out)["status"], "finished");
    out
}

fn check(topic: &str, name: &str) -> (tempfile::TempDir, PathBuf) {
    let place = tempfile::tempdir().unwrap();
    let expected = fs::read_to_string(examples().join(topic).join("expected.toml")).unwrap();
    let expected: toml::Table = expected.parse().unwrap();
    let changes = expected.get("set").and_then(|set| set.get(name));
    let changes: Vec<&str> = changes
        .and_then(|changes| changes.as_array())
        .into_iter()
        .flatten()
        .map(|change| change.as_str().unwrap())
        .collect();
    let out = run(place.path(), &format!("{topic}/{name}.toml"), &changes);
    let scalars = expected[name].as_array().unwrap();
    assert!(scalars.len() >= 4);
    let mut wrong = Vec::new();
    for scalar in scalars {
        let word = |key: &str| scalar[key].as_str().unwrap();
        let number = |key: &str| scalar[key].as_float().unwrap();
        let table = read_csv(out.join(word("file"))).unwrap();
        let column = table.column(word("column")).unwrap();
        let computed = match word("take") {
            "last" => column[column.len() - 1],
            "largest" => column.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            "smallest" => column.iter().copied().fold(f64::INFINITY, f64::min),
            other => panic!("take = {other:?}"),
        };
        let (value, tolerance) = (number("value"), number("tolerance"));
        let error = (computed - value).abs() / value.abs();
        if error.is_nan() || error > tolerance {
            wrong.push(format!("{scalar}: computed {computed:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    (place, out)
}

#[test]
fn branching() {
    let (_place, out) = check("fracture", "branching");
    let report = report(&out);
    let audit = |key: &str| report["audit"][key].as_f64().unwrap();
    assert!(audit("balance_over_work").abs() < 2e-3);
    assert!(audit("balance_over_dissipated").abs() < 0.03);
    for k in 0..=4 {
        assert!(out.join(format!("pictures/Damage-{k:06}.png")).is_file());
    }
}

/// After the release the end moves with the velocity σ/(ρ c) until the wave from the support arrives.
#[test]
fn released_bar() {
    let (_place, out) = check("statics", "released-bar");
    let steps = &report(&out)["steps"];
    assert_eq!(steps[0]["name"], "1-stretch");
    assert_eq!(steps[1]["start"], 1.0);
    let probes = table(&out, "probes.csv");
    let [time, velocity] = ["time", "end_v_x"].map(|name| probes.column(name).unwrap());
    let speed = 200e6 / (7850.0 * f64::sqrt(200e9 / 7850.0));
    let within = (0..time.len()).filter(|&k| (1.00006..1.00036).contains(&time[k]));
    let deviation = within.map(|k| (velocity[k] / -speed - 1.0).abs());
    assert!(deviation.fold(0.0, f64::max) < 0.01);
}

#[test]
fn standard_tests() {
    let names = [
        "three-point-bending",
        "brazilian-disc",
        "semicircular-bend",
        "laminate",
        "quench",
    ];
    for name in names {
        check("standard-tests", name);
    }
    check("geometry", "tensile-test");
}

#[test]
fn cooling_bar() {
    let (_place, out) = check("heat", "cooling-bar");
    let heat = &report(&out)["audit"]["heat"];
    assert!(heat["balance_relative"].as_f64().unwrap().abs() < 1e-12);
}

#[test]
fn printed_wall() {
    let (_place, out) = check("heat", "printed-wall");
    let heat = &report(&out)["audit"]["heat"];
    assert!(heat["balance_relative"].as_f64().unwrap().abs() < 1e-12);
}

/// Returns time, x, y and advance of the tip of the first crack, for the rows in which it has grown.
fn tip(out: &Path) -> Vec<[f64; 4]> {
    let cracks = table(out, "cracks.csv");
    let column = |name: &str| cracks.column(name).unwrap();
    let (number, columns) = (
        column("crack"),
        ["time", "tip_x", "tip_y", "advance"].map(column),
    );
    (0..number.len())
        .filter(|&k| number[k] == 1.0 && columns[3][k] > 0.0)
        .map(|k| columns.map(|column| column[k]))
        .collect()
}

/// Returns the largest slope of a least-squares line over a time window, m/s.
fn highest_speed(tip: &[[f64; 4]], within: f64) -> f64 {
    let mut highest: f64 = 0.0;
    for first in tip {
        let window: Vec<_> = tip
            .iter()
            .filter(|row| (0.0..=within).contains(&(row[0] - first[0])))
            .collect();
        let mean = |c: usize| window.iter().map(|row| row[c]).sum::<f64>() / window.len() as f64;
        let (t, s) = (mean(0), mean(3));
        let square: f64 = window.iter().map(|row| (row[0] - t).powi(2)).sum();
        let product: f64 = window.iter().map(|row| (row[0] - t) * (row[3] - s)).sum();
        if window.len() > 5 {
            highest = highest.max(product / square);
        }
    }
    highest
}

#[test]
fn a_crack_in_mode_one_runs_straight_and_slower_than_the_rayleigh_wave() {
    let (_place, out) = check("fracture", "mode-one");
    let tip = tip(&out);
    assert!(tip.iter().all(|row| (row[2] - 0.05).abs() < 1e-3));
    let rayleigh = 2080.0;
    let ratio = highest_speed(&tip, 10e-6) / rayleigh;
    assert!((0.4..1.0).contains(&ratio), "{ratio}");
    let report = report(&out);
    assert!(report["audit"]["balance_over_work"].as_f64().unwrap().abs() < 1e-3);
}

#[test]
fn published_plates_branch_symmetrically() {
    for (name, axis) in [("branching-bobaru", 0.0), ("branching-borden", 0.02)] {
        let (_place, out) = check("fracture", name);
        let report = report(&out);
        assert!(
            report["audit"]["balance_over_dissipated"]
                .as_f64()
                .unwrap()
                .abs()
                < 1e-3
        );
        let tip = tip(&out);
        // The crack starts along the notch and ends far from it; the forces along it are balanced.
        assert!((tip[0][2] - axis).abs() < 1e-3, "{name}: {:?}", tip[0]);
        let end = tip[tip.len() - 1][2];
        assert!((end - axis).abs() > 8e-3, "{name}: {end}");
        let momentum = table(&out, "history.csv");
        let largest = |column: &str| {
            let column = momentum.column(column).unwrap();
            column.iter().fold(0.0f64, |most, p| most.max(p.abs()))
        };
        assert!(largest("momentum_y") < 1e-9, "{name}");
    }
}

#[test]
fn sheared_notches_lead_to_inclined_cracks() {
    let (_place, out) = check("impact", "kalthoff-winkler");
    // Principal axis of the tip positions between 5 and 50 mm from the notch.
    let tip = tip(&out);
    let places: Vec<_> = tip
        .iter()
        .filter(|row| (0.005..0.05).contains(&row[3]))
        .collect();
    let mean = |c: usize| places.iter().map(|row| row[c]).sum::<f64>() / places.len() as f64;
    let moment = |a: usize, b: usize| -> f64 {
        let (x, y) = (mean(a), mean(b));
        places.iter().map(|row| (row[a] - x) * (row[b] - y)).sum()
    };
    let angle = 0.5 * (2.0 * moment(1, 2)).atan2(moment(1, 1) - moment(2, 2));
    let angle = angle.to_degrees();
    assert!((58.0..74.0).contains(&angle), "{angle}");
}

#[test]
fn a_tube_fragments() {
    let (_place, out) = check("fragmentation", "cylinder");
    let report = report(&out);
    // All energy is initial kinetic energy.
    assert!(report["audit"]["energy_drift"].as_f64().unwrap().abs() < 5e-3);
    // Fragmentation is expected, so no warning about many broken bonds. With the coarse grid of the test the horizon is
    // 1.7 spacings and the bonds are 10 % too stiff.
    let warnings = report["model"]["warnings"].as_array().unwrap();
    let of_stiffness = |warning: &serde_json::Value| {
        let line = warning.as_str().unwrap();
        line.contains("the bulk stiffness of the discretised body")
    };
    assert!(warnings.iter().all(of_stiffness), "{warnings:?}");
}

#[test]
fn a_ring_of_listed_points_oscillates_radially() {
    let (_place, out) = check("points", "ring");
    let probes = table(&out, "probes.csv");
    let (t, u) = (
        probes.column("time").unwrap(),
        probes.column("east_u_x").unwrap(),
    );
    let zeros: Vec<f64> = (1..t.len() - 1)
        .filter(|&k| u[k] * u[k + 1] < 0.0)
        .map(|k| t[k] + (t[k + 1] - t[k]) * u[k] / (u[k] - u[k + 1]))
        .collect();
    let half = (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64;
    let thin = std::f64::consts::PI * 0.05 * (7850.0f64 / 210e9).sqrt();
    assert!((half / thin - 1.0).abs() < 0.05, "{half} {thin}");
}

#[test]
fn a_state_based_plate_has_the_given_poissons_ratio() {
    check("state-based", "plate-with-hole");
}

#[test]
fn a_ply_with_a_hole_has_the_displacements_of_an_orthotropic_plate() {
    check("state-based", "ply-with-hole");
}

/// The force relaxes monotonically, and the energy balance of the static states closes.
#[test]
fn a_viscous_bar_relaxes_to_its_slow_modulus() {
    let (_place, out) = check("state-based", "viscous-bar");
    let reactions = table(&out, "reactions.csv");
    let force = reactions.column("right_x").unwrap();
    assert!(force[1..].windows(2).all(|pair| pair[1] < pair[0]));
    let balance = report(&out)["audit"]["balance_over_work"].as_f64().unwrap();
    assert!(balance.abs() < 1e-5, "{balance}");
}

/// The force at every static state against the closed form of uniaxial tension at the strain between the gauge points.
#[test]
fn a_tensile_bar_yields_by_the_closed_form() {
    const YOUNG: f64 = 70e9;
    const HARDENING: f64 = 5e9;
    const YIELD: f64 = 200e6;
    let (_place, out) = check("state-based", "yielding-bar");
    let (reactions, probes) = (table(&out, "reactions.csv"), table(&out, "probes.csv"));
    let force = reactions.column("right_x").unwrap();
    let [left, right] =
        ["gauge_left_u_x", "gauge_right_u_x"].map(|name| probes.column(name).unwrap());
    for k in 1..force.len() {
        let strain = ((right[k] - left[k]) / 21e-3).ln_1p();
        let tangent = YOUNG * HARDENING / (YOUNG + HARDENING);
        let tau = match strain * YOUNG > YIELD {
            true => YIELD + tangent * (strain - YIELD / YOUNG),
            false => YOUNG * strain,
        };
        let stress = force[k] / 8e-6;
        let error = stress / (tau * (-strain).exp()) - 1.0;
        assert!(error.abs() < 5e-4, "{k}: {stress:e} {error:e}");
    }
}

#[test]
fn a_state_based_plate_fractures_with_an_exact_energy_balance() {
    let (_place, out) = check("state-based", "notched-plate");
    let report = report(&out);
    let audit = |key: &str| report["audit"][key].as_f64().unwrap();
    // At the kink of the prescribed velocity (end of the ramp) the work has the error of one step; afterwards the
    // balance is constant.
    assert!(audit("balance_over_dissipated").abs() < 1e-3);
    let history = table(&out, "history.csv");
    let column = |name: &str| history.column(name).unwrap().to_vec();
    let (time, balance) = (column("time"), column("balance"));
    let after: Vec<f64> = (0..time.len())
        .filter(|&k| time[k] > 2.1e-6)
        .map(|k| balance[k])
        .collect();
    let dissipated = *column("dissipated_energy").last().unwrap();
    assert!(
        after
            .iter()
            .all(|b| (b - after[0]).abs() < 1e-9 * dissipated)
    );
    assert!(report["model"]["critical_bond_energy"].is_f64());
    let tip = tip(&out);
    // The crack is straight before it branches.
    let straight = tip.iter().filter(|row| row[0] < 9e-6);
    assert!(straight.clone().count() > 10);
    assert!(
        straight
            .into_iter()
            .all(|row| (row[2] - 0.012).abs() < 2e-3)
    );
    assert!(tip[tip.len() - 1][3] > 5e-3);
}

#[test]
fn block() {
    let (_place, out) = check("impact", "block");
    // Newton's second law: the impulse of the load is the momentum of the block.
    let (reactions, history) = (table(&out, "reactions.csv"), table(&out, "history.csv"));
    let (t, force) = (
        reactions.column("time").unwrap(),
        reactions.column("struck_x").unwrap(),
    );
    let impulse: f64 = (1..t.len())
        .map(|k| 0.5 * (force[k] + force[k - 1]) * (t[k] - t[k - 1]))
        .sum();
    let momentum = *history.column("momentum_x").unwrap().last().unwrap();
    assert!(
        (impulse / momentum - 1.0).abs() < 0.01,
        "{impulse} {momentum}"
    );
}

#[test]
fn the_pulse_in_the_bar_travels_at_the_wave_speed() {
    let (_place, out) = check("wave", "bar");
    let probes = table(&out, "probes.csv");
    let time = |name: &str| peak(probes.column("time").unwrap(), probes.column(name).unwrap());
    let speed = 0.2 / (time("far_u_x") - time("near_u_x"));
    let exact = (210e9f64 / 7850.0).sqrt();
    assert!((exact - 5172.2).abs() < 0.1);
    assert!(
        (speed / exact - 1.0).abs() < 0.01,
        "{speed} m/s, not {exact} m/s"
    );
}

#[test]
fn a_bar_in_tension_follows_hookes_law() {
    let (_place, out) = check("statics", "bar");
    let last =
        |file: &str, column: &str| *table(&out, file).column(column).unwrap().last().unwrap();
    let end = last("probes.csv", "end_u_x");
    assert!((end / 1e-3 - 1.0).abs() < 0.01, "{end}");
    let between = last("probes.csv", "three_quarters_u_x") - last("probes.csv", "quarter_u_x");
    assert!((between / 0.5e-3 - 1.0).abs() < 1e-5, "{between}");
    let reaction = last("reactions.csv", "support_x");
    assert!((reaction / -2e6 - 1.0).abs() < 1e-6, "{reaction}");
}

#[test]
fn reflection_at_an_interface_follows_from_the_impedances() {
    let (_place, out) = check("wave", "two-materials");
    let probes = table(&out, "probes.csv");
    let t = probes.column("time").unwrap();
    let highest = |name: &str, from: f64| {
        let column = probes.column(name).unwrap();
        let late = column.iter().zip(t).filter(|(_, t)| **t > from);
        late.map(|(u, _)| *u).fold(f64::NEG_INFINITY, f64::max)
    };
    let impedance = |young: f64, density: f64| (young * density).sqrt();
    let (first, second) = (impedance(210e9, 7850.0), impedance(70e9, 2700.0));
    let sent = highest("before_u_x", 0.0);
    let transmitted = highest("behind_u_x", 0.0) / sent;
    // At this time the pulse has passed the first probe.
    let reflected = highest("before_u_x", 45e-6) / sent;
    let exact = 2.0 * first / (first + second);
    assert!(
        (transmitted / exact - 1.0).abs() < 0.02,
        "{transmitted} {exact}"
    );
    let exact = (first - second) / (first + second);
    assert!(
        (reflected / exact - 1.0).abs() < 0.02,
        "{reflected} {exact}"
    );
}

/// Returns a value of the multirate results in `run.json`.
fn refinement(out: &Path, key: &str) -> f64 {
    report(out)["audit"]["refinement"][key].as_f64().unwrap()
}

#[test]
fn multirate_plate_has_small_steps_near_the_crack() {
    let (_place, out) = check("multi-time-step", "notched-plate");
    // The fine region grows with the crack and stays a neighbourhood of it.
    assert!(refinement(&out, "largest_fine_fraction") < 0.2);
    assert!(refinement(&out, "achieved_speed_up") > 3.0);
    let report = report(&out);
    assert!(report["audit"]["energy_drift"].as_f64().unwrap().abs() < 0.01);
}

#[test]
fn multirate_inclusion_has_small_steps_in_and_around_it() {
    let (_place, out) = check("multi-time-step", "inclusion");
    assert!(refinement(&out, "achieved_speed_up_over_verlet") > 5.0);
    assert_eq!(refinement(&out, "ratio"), 8.0);
}

#[test]
fn a_grid_refined_at_a_notch_tip_conserves_energy_and_momentum() {
    let (_place, out) = check("multi-time-step", "refined-notch");
    let report = report(&out);
    assert!(report["audit"]["energy_drift"].as_f64().unwrap().abs() < 2e-3);
    assert!(report["audit"]["momentum_error_relative"].as_f64().unwrap() < 1e-6);
    assert_eq!(report["model"]["operator"], "list");
}

#[test]
fn check_reports_the_net_speed_up_of_multirate_schemes() {
    let place = tempfile::tempdir().unwrap();
    let verdict = |deck: &str| {
        let deck = examples().join("multi-time-step").join(deck);
        let deck = deck.canonicalize().unwrap();
        let output = succeed(place.path(), &format!("check {}", deck.display()));
        let out = crate::common::text(&output.stdout);
        let line = out.lines().find(|line| line.contains("net speed-up"));
        line.unwrap_or_else(|| panic!("{out}")).to_owned()
    };
    assert!(verdict("inclusion.toml").contains("the fine points need the smaller step"));
    let line = verdict("notched-plate.toml");
    assert!(line.contains("the same stable step"), "{line}");
}

#[test]
fn surfaces() {
    let (_place, out) = check("surface", "sphere");
    // The energy inequality holds in every row, and the energy balance closes.
    let margin = table(&out, "surface.csv");
    let margin = margin.column("bound_margin").unwrap();
    assert!(margin.iter().all(|margin| *margin >= -1e-9));
    let history = table(&out, "history.csv");
    let column = |name: &str| history.column(name).unwrap();
    let scale = column("external_work").iter().copied().fold(0.0, f64::max);
    assert!(column("balance").iter().all(|b| b.abs() < 1e-6 * scale));
    let (_place, out) = check("surface", "torus");
    for k in 0..=4 {
        let name = format!("pictures/Strain_Energy_Density-{k:06}.png");
        assert!(out.join(name).is_file());
    }
}

fn table(out: &Path, name: &str) -> CsvData {
    read_csv(out.join(name)).unwrap()
}

/// Returns the time of the maximum of a curve: the vertex of the parabola through the highest sample and its
/// neighbours.
fn peak(t: &[f64], y: &[f64]) -> f64 {
    let k = (1..y.len() - 1).fold(1, |best, k| if y[k] > y[best] { k } else { best });
    let (before, after) = (y[k - 1] - y[k], y[k + 1] - y[k]);
    // The samples are equidistant.
    t[k] + 0.5 * (t[k + 1] - t[k]) * (before - after) / (before + after)
}

#[test]
fn the_spectral_pulse_is_exact() {
    let (_place, out) = check("wave", "spectral");
    let errors = table(&out, "history.csv");
    assert!(*errors.column("error_so_far").unwrap().last().unwrap() < 1e-13);
}

#[test]
fn the_midpoint_rule_conserves_energy_on_gauss_nodes() {
    let (_place, out) = check("wave", "gauss-midpoint");
    let history = table(&out, "history.csv");
    let balance = history.column("balance").unwrap();
    let energy = history.column("elastic_energy").unwrap()[0];
    assert!(balance.iter().all(|b| b.abs() < 1e-12 * energy));
}

#[test]
fn waves_leave_a_bar_with_absorbing_boundaries() {
    let (_place, out) = check("absorbing", "infinite-bar");
    let history = table(&out, "history.csv");
    let last = |name: &str| *history.column(name).unwrap().last().unwrap();
    assert!(last("kinetic_energy") + last("elastic_energy") < 1e-20 * -last("external_work"));
}

#[test]
fn a_free_end_doubles_the_velocity_of_a_pulse() {
    let (_place, out) = check("absorbing", "free-end");
    let probes = table(&out, "probes.csv");
    let fastest = |name: &str| {
        let column = probes.column(name).unwrap();
        column.iter().fold(0.0, |a: f64, v| a.max(*v))
    };
    let ratio = fastest("free_end_v_x") / fastest("absorbing_end_v_x");
    assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
}

#[test]
fn waves_in_the_periodic_plate() {
    let (_place, out) = check("wave", "plate");
    // The energy bound holds.
    let history = table(&out, "history.csv");
    let column = |name: &str| history.column(name).unwrap();
    let (bound, margin) = (column("energy_bound"), column("energy_margin"));
    assert!(margin.iter().all(|margin| *margin >= 0.0));
    let (kinetic, elastic) = (column("kinetic_energy"), column("elastic_energy"));
    let (last, end) = (bound.len() - 1, bound[bound.len() - 1]);
    let rest = end - margin[last] - kinetic[last] - elastic[last];
    assert!(end > 0.0 && rest.abs() < 1e-12 * end, "{rest:e}");
    // The work of loads is integrated along the cubic through both ends of a step.
    let report = report(&out);
    assert!(report["audit"]["balance_over_work"].as_f64().unwrap().abs() < 1e-3);
}

#[test]
fn waves_leave_a_bar_with_tuned_bonds() {
    let (_place, out) = check("composition", "tuned-bar");
    let history = table(&out, "history.csv");
    let column = |name: &str| history.column(name).unwrap();
    let left = column("kinetic_energy").last().unwrap() + column("elastic_energy").last().unwrap();
    assert!(left < 1e-20 * column("elastic_energy")[0], "{left:e}");
}

#[test]
fn results_of_exact_steps_on_a_torus_do_not_depend_on_the_step_size() {
    let (place, out) = check("composition", "torus-trigonometric");
    let deck = examples().join("composition/torus-trigonometric.toml");
    let deck = deck.canonicalize().unwrap();
    let line = format!(
        "run {} --quiet --out long --set time.dt=2.5",
        deck.display()
    );
    succeed(place.path(), &line);
    let kinetic = |out: &Path| {
        *table(out, "history.csv")
            .column("kinetic_energy")
            .unwrap()
            .last()
            .unwrap()
    };
    let (short, long) = (kinetic(&out), kinetic(&place.path().join("long")));
    assert!((short / long - 1.0).abs() < 1e-9, "{short} {long}");
}

#[test]
fn nonlinear_surfaces_and_bars_conserve_energy_and_momentum() {
    for (name, energy) in [("sphere-rk4", 1e-7), ("gauss-nonlinear", 1e-3)] {
        let (_place, out) = check("composition", name);
        let audit = &report(&out)["audit"];
        let number = |key: &str| audit[key].as_f64().unwrap();
        assert!(number("energy_drift").abs() < energy, "{name}");
        assert!(number("momentum_error_relative") < 1e-12, "{name}");
        assert!(audit["warnings"].as_array().unwrap().is_empty(), "{audit}");
    }
}

#[test]
fn fourier_and_stencil_force_kernels_agree_on_a_plate() {
    let (place, out) = check("composition", "periodic-plate");
    let deck = examples().join("composition/periodic-plate.toml");
    let deck = deck.canonicalize().unwrap();
    let line = format!(
        "run {} --quiet --out stencil --set body.periodic=false --set material.bonds=grid",
        deck.display()
    );
    succeed(place.path(), &line);
    let stencil = place.path().join("stencil");
    assert_eq!(report(&stencil)["model"]["operator"], "grid");
    for column in ["ahead_u_x", "ahead_v_y", "aside_u_x", "aside_v_x"] {
        let [a, b] =
            [&out, &stencil].map(|out| table(out, "probes.csv").column(column).unwrap().to_vec());
        let size = a.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let apart = a
            .iter()
            .zip(&b)
            .fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(apart < 1e-9 * size, "{column}: {apart:e} of {size:e}");
    }
}

#[test]
fn bodies_from_meshes_and_surfaces_break_at_their_thinnest_section() {
    let (_place, out) = check("geometry", "dogbone");
    for file in ["fields.exo", "cells.pvd"] {
        assert!(out.join(file).exists(), "{file}");
    }
    for name in ["bracket", "fibres"] {
        let (_place, out) = check("geometry", name);
        // The work of the constraints is stored in the body or dissipated.
        let history = read_csv(out.join("history.csv")).unwrap();
        let last = |name: &str| history.column(name).unwrap().last().copied().unwrap();
        assert!(
            last("balance").abs() < 0.02 * last("external_work"),
            "{name}"
        );
    }
}
