//! `[[boundary]]`: absorbing boundaries.

use pericles::space::Face;
use pericles_deck_derive::{DeckKeys, DeckTable};
use pericles_waves::absorbing::history::HistoryForm;
use pericles_waves::absorbing::{AbsorbingBoundaryPlan, KernelMethod, Side};
use serde::{Deserialize, Serialize};

use crate::declaration::Check;
use crate::form::described;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::Depth;

/// Absorbing boundaries. `absorbing` needs scheme = "velocity-verlet", "implicit-midpoint", "trapezoidal" or
/// "discrete-gradient"; `damping-layer` works with all schemes but "adaptive-dynamic-relaxation", "fire" and "static";
/// `open` needs scheme = "velocity-verlet".
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[deck(
    tag = "kind",
    what = "kind of boundary",
    tag_about = "`absorbing`: exact non-reflecting boundary at an end of a bar, equivalent to a semi-infinite bar. \
                 `damping-layer`: layer with increasing viscous damping at a side of any body; reflects a small part of a \
                 wave. `open` (experimental): discrete perfectly matched layer at sides of a bond-based plate on a square \
                 lattice; reflects about 1e-4 of waves longer than eight spacings."
)]
pub enum BoundaryCondition {
    /// An exact non-reflecting boundary at an end of a bar.
    Absorbing {
        /// absorbing: end of the bar, -x or +x.
        #[serde(with = "crate::form")]
        side: Side,
        /// Kernels and form of the history.
        #[serde(with = "crate::form")]
        #[deck(flatten)]
        plan: AbsorbingBoundaryPlan,
        /// absorbing: distance beyond the end over which the `[[initial]]` fields of set "all" continue; they propagate
        /// from there into the body. Default: zero fields outside the body.
        ///
        /// In m.
        #[serde(default)]
        #[deck(
            quantity = Length,
            range = POSITIVE,
            forbid_if(has_continuous_kernels(plan), "it requires method = \"discrete\"")
        )]
        exterior_extent: Option<f64>,
    },
    /// A damping layer at a side of any body.
    DampingLayer {
        /// damping-layer: side of the body.
        #[serde(rename = "side", with = "crate::form")]
        #[deck(key = "side")]
        face: Face,
        /// Thickness of the layer, which consists of the body's own material. damping-layer: a few wavelengths are best.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        thickness: f64,
        /// damping-layer: design reflection coefficient, the amplitude ratio of a long wave at normal incidence.
        #[deck(range = between(1e-12, 1.0), default = 1e-3)]
        reflection: f64,
        /// damping-layer: exponent of the damping profile over the depth of the layer.
        #[deck(range = from_to(0.0, 10.0), default = 2.0)]
        power: f64,
    },
    /// Discrete perfectly matched layers at sides of a plate.
    Open {
        /// open: a side, a list of sides, or "all"; of the two sides across an open side at least one must be open too,
        /// unless the body is periodic.
        #[serde(with = "crate::form")]
        #[deck(key = "side", required, with = open_sides)]
        sides: Vec<Face>,
        /// Thickness of the layers.
        #[deck(
            flatten,
            keys("cells", "thickness"),
            with = open_thickness,
            check = check_thickness
        )]
        thickness: Depth,
    },
}

/// Plan of an exact non-reflecting boundary.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "AbsorbingBoundaryPlan", deny_unknown_fields)]
#[deck(remote = AbsorbingBoundaryPlan)]
struct AbsorbingBoundaryForm {
    /// absorbing: kernels of the boundary. `discrete`: exact for the time integration scheme; `semi-discrete`: exact in
    /// continuous time; `historical`: the same from a closed recursion, whose errors grow with time.
    #[serde(with = "crate::form")]
    #[deck(default = KernelMethod::Discrete)]
    method: KernelMethod,
    /// absorbing: evaluation of the convolution in time. `direct` and `blocked`: exact; `exponentials`: sum of
    /// exponentials with error `tolerance`; `auto`: the least expensive of the exact forms, and of exponentials if
    /// `tolerance` is given.
    #[serde(default, rename = "history", with = "crate::form")]
    #[deck(
        key = "history",
        default = None,
        allow_if(
            has_kernels(method, form),
            "\"auto\", \"blocked\" or \"direct\"; exponentials require method = \"discrete\""
        )
    )]
    form: Option<HistoryForm>,
    /// absorbing: largest error of exterior displacements relative to interior ones. Allows exponentials, which need
    /// little memory.
    #[serde(default)]
    #[deck(range = between(1e-14, 1.0), forbid_if(is_exact(method, form), EXACT))]
    tolerance: Option<f64>,
    /// absorbing: compare the exponentials with the exact kernels; `check` and run.json report the difference.
    #[deck(
        default = false,
        forbid_if(is_exact(method, form), EXACT),
        allow_if(
            has_exponentials(form, tolerance, verify),
            "false, or true with a `tolerance`; without it the history is exact and has no exponentials to compare"
        )
    )]
    verify: bool,
}

/// Why an exact history has no tolerance.
const EXACT: &str = "it requires exponentials (history = \"auto\" or \"exponentials\", method = \"discrete\"); all other histories are exact";

type Form = Option<HistoryForm>;

fn has_kernels(method: Option<&KernelMethod>, form: Option<&Form>) -> bool {
    let is_discrete = matches!(method, None | Some(KernelMethod::Discrete));
    is_discrete || form != Some(&Some(HistoryForm::Exponentials))
}

fn is_exact(method: Option<&KernelMethod>, form: Option<&Form>) -> bool {
    let exact = matches!(form, Some(Some(HistoryForm::Blocked | HistoryForm::Direct)));
    exact || method != Some(&KernelMethod::Discrete)
}

fn has_exponentials(
    form: Option<&Form>,
    tolerance: Option<&Option<f64>>,
    verify: Option<&bool>,
) -> bool {
    let fitted = form == Some(&Some(HistoryForm::Exponentials)) || tolerance != Some(&None);
    fitted || verify != Some(&true)
}

described!(AbsorbingBoundaryPlan: AbsorbingBoundaryForm);

impl BoundaryCondition {
    /// Number of cells of an open boundary without a given thickness.
    pub const CELLS: u32 = 12;
}

/// Returns whether the kernels of a boundary are exact in continuous time.
fn has_continuous_kernels(plan: Option<&AbsorbingBoundaryPlan>) -> bool {
    plan.is_some_and(|plan| plan.method != KernelMethod::Discrete)
}

/// Reads the thickness of the layers of an open boundary.
fn open_thickness<S>(table: &Table<'_>, _: S) -> Option<Depth> {
    table.describe(
        "cells",
        "open: thickness of the layers as a number of cells, from 8 to 64.",
    );
    table.describe(
        "thickness",
        "open: in place of `cells`, rounded up to full cells; bonds in the layer and one horizon before it do not break.",
    );
    match table.at_most_one(&["cells", "thickness"])? {
        None => {
            table.record("cells", BoundaryCondition::CELLS);
            Some(Depth::Cells(f64::from(BoundaryCondition::CELLS)))
        }
        Some(("thickness", item)) => item.positive(Quantity::Length).map(Depth::Length),
        Some((_, item)) => item.count().map(|cells| Depth::Cells(cells as f64)),
    }
}

fn check_thickness<S>(thickness: &Depth, path: &KeyPath, _: S, check: &mut Check) {
    match thickness {
        Depth::Length(length) => check.positive(path.key("thickness"), *length),
        Depth::Cells(cells) => check.positive(path.key("cells"), *cells),
    }
}

/// Reads a side, a list of sides, or all sides of a plate.
fn open_sides<S>(item: &Item<'_>, _: S) -> Option<Vec<Face>> {
    const SIDES: [&str; 4] = ["-x", "+x", "-y", "+y"];
    let named = SIDES
        .iter()
        .filter_map(|side| Some((*side, Face::named(side)?)));
    let words: Vec<(&'static str, Face)> = named.collect();
    let face = |item: &Item<'_>| item.choice("side", &words);
    if item.is_list() {
        let items = item.list("a list of sides")?;
        let faces = items.iter().map(face).collect::<Option<Vec<Face>>>()?;
        let is_twice = |(k, face): (usize, &Face)| faces[..k].contains(face);
        if faces.is_empty() || faces.iter().enumerate().any(is_twice) {
            item.out_of_range("one or more of \"-x\", \"+x\", \"-y\" and \"+y\", each once");
            return None;
        }
        return Some(faces);
    }
    let one = words.iter().map(|&(word, face)| (word, Some(face)));
    let words_and_all: Vec<_> = one.chain([("all", None)]).collect();
    let all = || words.iter().map(|(_, face)| *face).collect();
    let found = item.choice("side", &words_and_all)?;
    Some(found.map_or_else(all, |face| vec![face]))
}
