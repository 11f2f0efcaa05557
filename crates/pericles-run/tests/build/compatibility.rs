//! The compatibility tables agree with the behaviour of systems and with the book.

use super::composition::{ONE_STEP, Operator, PART, TWO_STEPS};
use crate::common::Build;
use crate::parse;
use pericles::operator::Feature;
use pericles_deck::Deck;
use pericles_run::composition::{Condition, FORMS, Form, SCHEMES, Scheme, tables};

/// Returns the row of the scheme in a text such as `scheme = "rk4", dt = 0.1`.
fn row(time: &str) -> &'static Scheme {
    let name = time.split('"').nth(1).unwrap();
    let newton = time.contains("newton-krylov");
    let is_it = |scheme: &&Scheme| {
        let solver = name != "newmark" || scheme.words.contains("Newton–Krylov") == newton;
        scheme.names.contains(&name) && solver
    };
    SCHEMES.iter().find(is_it).unwrap()
}

fn form(operator: Operator) -> &'static Form {
    let is_it = |form: &&Form| form.name == operator.word();
    FORMS.iter().find(is_it).unwrap()
}

#[test]
fn force_kernels_satisfy_the_needs_in_the_table() {
    for operator in Operator::ALL {
        let form = form(operator);
        let assembly = parse(&operator.deck("dt = 0.01")).build().unwrap();
        for scheme in &SCHEMES {
            let mut needs = scheme.requirements.iter();
            let met = needs.all(|one| one.need.is_met_by(&assembly.system));
            let rejected = scheme.rejection_of_form(form).is_some();
            assert_ne!(met, rejected, "{} with {}", form.words, scheme.words);
        }
    }
}

#[test]
fn decks_are_rejected_according_to_the_table() {
    for operator in Operator::ALL {
        for scheme in ONE_STEP.iter().chain(&TWO_STEPS) {
            // Tolerances below the rounding error of single-precision forces are rejected as values.
            let time = match operator {
                Operator::FloatGrid => scheme.time.replace("tolerance = 1e-8", "tolerance = 1e-5"),
                _ => scheme.time.into(),
            };
            let deck = parse(&(operator.deck(&time) + PART));
            let rejected = row(scheme.time).rejection_of_form(form(operator)).is_some();
            assert_eq!(
                deck.build().is_err(),
                rejected,
                "{} with {}",
                operator.word(),
                scheme.time
            );
        }
    }
}

/// Returns a deck of a body with a feature, and as few others as possible: plane waves require periodic faces.
fn deck_with(feature: Feature, form: &Form) -> String {
    use Feature::{
        Activation, BondEnergy, BondStretch, Breaking, Correspondence, FreeFaces, GaussNodes,
        GreenStrain, GreenStrainBar, Inclusions, NoLattice, OtherCubic, PeriodicFaces, Pieces,
        PreCracks, SeveralHorizons, SeveralMaterials, SeveralSpacings, Softening, StateBased,
        StressFailure, SurfaceCorrection, Tensors, ThermalExpansion,
    };
    let bar = matches!(feature, GreenStrainBar | OtherCubic | GaussNodes);
    let periodic = match feature {
        FreeFaces | NoLattice => false,
        PeriodicFaces => true,
        _ => form.name == "spectral",
    };
    let shape = match (bar, feature) {
        (true, _) => "shape = \"bar\", length = 20, spacing = 1",
        (_, NoLattice) => {
            "shape = \"plate\", size = [12, 8], plane = \"stress\", spacing = 1, positions = \"jittered\""
        }
        _ => "shape = \"plate\", size = [12, 8], plane = \"stress\", spacing = 1",
    };
    let body = match feature {
        GaussNodes => ", quadrature = \"gauss\"",
        Pieces => {
            ", piece = [{ name = \"b\", shape = \"plate\", size = [4, 8], origin = [14, 0] }]"
        }
        SeveralSpacings => ", refine = [{ box = { max = [4, 8] }, ratio = 2 }]",
        _ => "",
    };
    let model = match feature {
        BondStretch => "bond-stretch",
        GreenStrain | GreenStrainBar => "green-strain",
        OtherCubic => "cubic-softening",
        StateBased | BondEnergy | StressFailure => "state-based",
        Correspondence => "correspondence",
        _ => "linear",
    };
    let material = match feature {
        GreenStrainBar => {
            ", influence = { function = \"gaussian\", length = 1, acts_on = \"displacement\" }"
        }
        Breaking => ", critical_stretch = 0.1",
        Softening => {
            ", critical_stretch = 0.1, softening = { law = \"linear\", onset_stretch = 0.01 }"
        }
        StateBased | Correspondence => ", poisson_ratio = 0.2",
        BondEnergy => ", poisson_ratio = 0.2, failure = \"bond-energy\", fracture_energy = 1e-3",
        StressFailure => ", poisson_ratio = 0.2, failure = \"principal-stress\", strength = 1",
        SurfaceCorrection => ", surface_correction = \"volume\"",
        _ => "",
    };
    let others = match feature {
        SeveralMaterials => {
            "materials.other = { density = 1, youngs_modulus = 2 }\nassign = [{ set = \"part\", material = \"other\" }]\n"
        }
        SeveralHorizons => {
            "materials.other = { density = 1, youngs_modulus = 2, horizon_ratio = 2 }\nassign = [{ set = \"part\", material = \"other\" }]\n"
        }
        Inclusions => "assign = [{ set = \"part\", stiffness = 2 }]\n",
        PreCracks => "crack = [{ segment = [[0, 4], [6, 4]] }]\n",
        ThermalExpansion => "thermal = { expansion = 1e-5, reference = 20, temperature = 100 }\n",
        Activation => "activation = [{ set = \"part\", active_from = 0.5 }]\n",
        Tensors => "output = { fields = { names = [\"Stress\"] } }\n",
        _ => "",
    };
    let periodic = if periodic { ", periodic = true" } else { "" };
    let name = form.name;
    format!(
        "body = {{ {shape}{periodic}{body} }}\n\
         material = {{ model = \"{model}\", density = 1, youngs_modulus = 1, horizon_ratio = 3, bonds = \"{name}\"{material} }}\n\
         sets.part = {{ where = \"x < 4\" }}\n\
         initial = [{{ set = \"part\", velocity = [{}] }}]\n\
         {others}time = {{ end = 1, dt = 0.1 }}\n",
        if bar { "1e-3" } else { "1e-3, 0" }
    )
}

/// Returns a bar, or a plate, with a condition; `time` gives the scheme.
fn bar_with(condition: Condition, time: &str) -> String {
    let breaking = match condition {
        Condition::Breaking => ", critical_stretch = 0.5",
        _ => "",
    };
    let other = match condition {
        Condition::Supports => "constraint = [{ set = \"left\", displacement = 0 }]\n",
        Condition::ReleasedPoints => {
            "constraint = [{ set = \"left\", displacement = 0, until = 2 }]\n"
        }
        Condition::Breaking => "",
        Condition::AbsorbingEnds => "boundary = [{ kind = \"absorbing\", side = \"+x\" }]\n",
        Condition::DampingLayers => {
            "boundary = [{ kind = \"damping-layer\", side = \"+x\", thickness = 10 }]\n"
        }
        Condition::OpenSides => "boundary = [{ kind = \"open\", side = \"all\" }]\n",
        Condition::Contact => "contact = {}\n",
        Condition::DampedContact => "contact = { damping = 0.3 }\n",
        Condition::FreeImpactors => {
            "impactor = [{ name = \"a\", shape = \"ball\", radius = 1, centre = -3, density = 1 }]\n"
        }
        Condition::Activation => "activation = [{ set = \"left\", active_from = 1 }]\n",
    };
    let (body, displacement) = match condition {
        Condition::OpenSides => (
            "shape = \"plate\", size = [40, 40], spacing = 1, plane = \"stress\"",
            "[{ expression = \"0.01*exp(-(x-20)^2-(y-20)^2)\" }, 0]",
        ),
        _ => (
            "shape = \"bar\", length = 40, spacing = 1",
            "{ expression = \"0.01*exp(-((x-17)/2)^2)\" }",
        ),
    };
    format!(
        "body = {{ {body} }}\n\
         material = {{ model = \"linear\", density = 1, youngs_modulus = 1, horizon_ratio = 3, bonds = \"list\"{breaking} }}\n\
         sets.left = {{ layer = {{ side = \"-x\", cells = 3 }} }}\n{PART}\
         initial = [{{ displacement = {displacement} }}]\n\
         {other}time = {{ end = 4, {time} }}\n"
    )
}

#[test]
fn conditions_are_rejected_according_to_the_table() {
    let static_ones = [
        "scheme = \"adaptive-dynamic-relaxation\", tolerance = 1e-6",
        "scheme = \"static\", tolerance = 1e-6, rigid_modes = \"fix\"",
    ];
    let schemes = ONE_STEP.iter().chain(&TWO_STEPS).map(|scheme| scheme.time);
    for time in schemes.chain(static_ones) {
        for condition in Condition::ALL {
            let built = parse(&bar_with(condition, time)).build();
            let rejected = row(time).rejection_of_condition(condition).is_some();
            let condition = condition.words();
            match built {
                Ok(_) => assert!(!rejected, "{time}: {condition}: not rejected"),
                Err(error) => assert!(rejected, "{time}: {condition}: {error}"),
            }
        }
    }
}

#[test]
fn features_are_rejected_according_to_the_table() {
    let forms = FORMS.iter().filter(|form| form.choice.is_some());
    for form in forms {
        for feature in Feature::ALL {
            let text = deck_with(feature, form);
            let built = Deck::parse(&text, "deck.toml", &[]).and_then(|deck| deck.build());
            let rejected = form.rejection_of_feature(feature).is_some();
            let (form, feature) = (form.words, feature.words());
            match built {
                Ok(_) => assert!(!rejected, "{form}: {feature} is not rejected"),
                Err(error) => assert!(rejected, "{form}: {feature}: {error}"),
            }
        }
    }
}

#[test]
fn the_tables_of_the_book_are_up_to_date() {
    let folder = env!("CARGO_MANIFEST_DIR");
    let page = std::fs::read_to_string(format!("{folder}/../../book/src/composition.md")).unwrap();
    let begin = "<!-- tables: made by pericles_run::composition::tables -->\n";
    let (_, rest) = page.split_once(begin).unwrap();
    let (shown, _) = rest.split_once("<!-- end of tables -->").unwrap();
    let expected = tables();
    assert!(
        shown == expected,
        "update the page between its marks:\n{expected}"
    );
}

#[test]
fn the_number_of_incompatible_cells_does_not_grow() {
    let rejected = |scheme: &Scheme| {
        let forms = FORMS
            .iter()
            .filter(|form| scheme.rejection_of_form(form).is_some());
        let conditions = Condition::ALL.into_iter();
        forms.count()
            + conditions
                .filter(|one| scheme.rejection_of_condition(*one).is_some())
                .count()
    };
    let cells: usize = SCHEMES.iter().map(rejected).sum();
    let features = |form: &Form| {
        let features = Feature::ALL.into_iter();
        features
            .filter(|feature| form.rejection_of_feature(*feature).is_some())
            .count()
    };
    let bodies: usize = FORMS.iter().map(features).sum();
    // The current numbers: 25 cells of forms and of conditions other than contact, 29 of the three kinds of contact, and 5 of the
    // scheme for heat conduction only, whose points do not move. Open boundaries came later: 13 schemes, all but velocity Verlet. Points that become active came
    // later, too: both multirate schemes, and all forms but the list.
    assert!(cells <= 59 + 13 + 2, "{cells}");
    assert!(bodies <= 57 + 4, "{bodies}");
}
