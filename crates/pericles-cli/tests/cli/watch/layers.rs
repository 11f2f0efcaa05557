//! Layers that bonds do not cross.

use super::{reactions, warnings};

#[test]
fn bonds_do_not_cross_a_layer_on_request() {
    // A soft layer of two cells in a stiff bar: springs in series.
    let (length, soft) = (0.1, 1e-6);
    let deck = format!(
        r#"
body = {{ shape = "bar", length = {length}, spacing = 1e-3, area = 1e-4 }}
material = {{ name = "glass", density = 1, youngs_modulus = 1e9, horizon_ratio = 3, modulus = "lattice" }}
materials.glue = {{ density = 1, youngs_modulus = {} }}
assign = [{{ set = "layer", material = "glue" }}]
crack = [{{ layer = "layer" }}]
sets.layer = {{ where = "0.049 < x && x < 0.051" }}
sets.left = {{ layer = {{ side = "-x", cells = 3 }} }}
sets.right = {{ layer = {{ side = "+x", cells = 3 }} }}
constraint = [{{ set = "left", displacement = [0] }}, {{ set = "right", displacement = [1e-4] }}]
time = {{ scheme = "static" }}
output = {{ fields = "never" }}
"#,
        1e9 * soft
    );
    let place = tempfile::tempdir().unwrap();
    let series = 1e9 * soft * 1e-4 * 1e-4 / 2e-3;
    assert_eq!(warnings(place.path(), &deck, ""), [""; 0]);
    let force = reactions(place.path())[1];
    // The nonlocal layer is as compliant as its bonds to the neighbours make it: within a cell of its thickness.
    assert!(
        force > series / 1.5 && force < series / 0.7,
        "{force} {series}"
    );
    warnings(place.path(), &deck, "--set crack=[]");
    let bridged = reactions(place.path())[1];
    assert!(bridged > 1e3 * series, "{bridged}");
}
