//! Text of the compute shaders of a body, in WGSL.
//!
//! The bonds of the stencil are written out: vectors, stiffnesses and thresholds are constants of the text, and a neighbour is a
//! constant number of places away. One invocation computes one node, with the bonds in the order of the loops of the processor.
//! The other parts of a step (`steps.wgsl`) read lists whose places are constants of the text as well.

mod force;

use std::fmt::Write as _;

use crate::body::Body;
use crate::entries::Entries;
use crate::flags::{GUIDED, HELD, MATERIAL, OWN};
use crate::precision::Precision;

const DOUBLE: &str = include_str!("double.wgsl");
const MIXED: &str = include_str!("mixed.wgsl");
const STEPS: &str = include_str!("steps.wgsl");

/// Size of the workgroups of loops over lists.
const LIST_GROUP: u32 = 64;
/// Largest number of workgroups along an axis.
const MOST_GROUPS: u32 = 65_535;

/// Returns the workgroups of a loop over a list.
pub(crate) fn list_groups(items: usize) -> [u32; 3] {
    let groups = (items as u32).div_ceil(LIST_GROUP);
    [groups.min(MOST_GROUPS), groups.div_ceil(MOST_GROUPS), 1]
}

/// Returns the size of the workgroups of loops over places.
pub(crate) fn group(dimension: usize) -> [u32; 3] {
    match dimension {
        1 => [256, 1, 1],
        2 => [32, 8, 1],
        _ => [32, 4, 2],
    }
}

/// Returns the shaders of a body.
pub(crate) fn text(body: &Body, entries: &Entries, precision: Precision) -> String {
    let mut text = String::from(match precision {
        Precision::Double => DOUBLE,
        Precision::Mixed => MIXED,
    });
    for (name, value) in constants(body, entries) {
        let _ = writeln!(text, "const {name} = {value}u;");
    }
    for (name, value) in [("ZERO", 0.0), ("HALF", 0.5), ("ONE", 1.0)] {
        let _ = writeln!(text, "const {name} = {};", precision.literal(value));
    }
    text.push_str(STEPS);
    force::write(&mut text, body, precision);
    text
}

fn constants(body: &Body, entries: &Entries) -> Vec<(&'static str, u64)> {
    let [x, y, z] = group(body.dimension);
    let [nx, ny, nz] = body.shape;
    let mut constants = vec![
        ("GROUP_X", x.into()),
        ("GROUP_Y", y.into()),
        ("GROUP_Z", z.into()),
        ("LIST_GROUP", LIST_GROUP.into()),
        ("LINE", (LIST_GROUP * MOST_GROUPS).into()),
        ("SHAPE_X", nx as u64),
        ("SHAPE_Y", ny as u64),
        ("SHAPE_Z", nz as u64),
        ("DIMENSION", body.dimension as u64),
        ("PLACES", body.places as u64),
        ("PITCH", body.pitch() as u64),
        ("MARGIN", body.margin as u64),
        ("OWN", OWN.into()),
        ("HELD", HELD.into()),
        ("GUIDED", GUIDED.into()),
        ("MATERIAL", MATERIAL.into()),
    ];
    constants.extend(entries.constants());
    constants
}
