//! `[[boundary]]`: absorbing boundaries.

use pericles::space::Face;
use pericles_waves::absorbing::history::HistoryForm;
use pericles_waves::absorbing::{AbsorbingBoundaryPlan, KernelMethod, Side};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::Depth;
use crate::words::Worded;

/// An absorbing boundary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum BoundaryCondition {
    /// An exact non-reflecting boundary at an end of a bar.
    Absorbing {
        /// The end of the bar.
        #[serde(with = "crate::form")]
        side: Side,
        /// Kernels and form of the history.
        #[serde(with = "crate::form")]
        plan: AbsorbingBoundaryPlan,
        /// Distance over which the initial fields continue beyond the end, m; none if they are zero there.
        #[serde(default)]
        exterior_extent: Option<f64>,
    },
    /// A damping layer at a side of any body.
    DampingLayer {
        /// The side of the body.
        #[serde(rename = "side", with = "crate::form")]
        face: Face,
        /// Thickness, m.
        thickness: f64,
        /// Reflection coefficient (amplitude) of a long wave at normal incidence.
        reflection: f64,
        /// Exponent of the damping profile.
        power: f64,
    },
    /// Discrete perfectly matched layers at sides of a plate.
    Open {
        /// The sides of the plate.
        #[serde(with = "crate::form")]
        sides: Vec<Face>,
        /// Thickness of the layers.
        thickness: Depth,
    },
}

impl BoundaryCondition {
    /// Number of cells of an open boundary without a given thickness.
    pub const CELLS: u32 = 12;
}

#[derive(Clone, Copy)]
enum Kind {
    Absorbing,
    DampingLayer,
    Open,
}

pub(crate) fn read(table: Table<'_>) -> Option<BoundaryCondition> {
    let kinds = [
        ("absorbing", Kind::Absorbing),
        ("damping-layer", Kind::DampingLayer),
        ("open", Kind::Open),
    ];
    let kind = table
        .required("kind")
        .and_then(|item| item.choice("kind of boundary", &kinds));
    match kind {
        Some(Kind::DampingLayer) => damping_layer(table),
        Some(Kind::Open) => open(table),
        // The keys of an unknown kind are read as for the first kind.
        _ => absorbing(table).filter(|_| kind.is_some()),
    }
}

fn absorbing(table: Table<'_>) -> Option<BoundaryCondition> {
    let side = table
        .required("side")
        .and_then(|item| item.choice("side", &Side::words()));
    let method = table.worded("method", "method");
    let form = table.choice_or_first(
        "history",
        "history",
        &[
            ("auto", None),
            ("blocked", Some(HistoryForm::Blocked)),
            ("direct", Some(HistoryForm::Direct)),
            ("exponentials", Some(HistoryForm::Exponentials)),
        ],
    );
    let exact = |form| matches!(form, Some(HistoryForm::Blocked | HistoryForm::Direct));
    let discrete = method == Some(KernelMethod::Discrete);
    let (mut tolerance, mut verify) = (Some(None), Some(false));
    if form.is_some_and(exact) || !discrete {
        let why = "it requires exponentials (history = \"auto\" or \"exponentials\", method = \"discrete\"); all other histories are exact";
        table.forbid("tolerance", why);
        table.forbid("verify", why);
        if form == Some(Some(HistoryForm::Exponentials)) && method.is_some() {
            table.forbid(
                "history",
                "use \"auto\", \"blocked\" or \"direct\"; exponentials require method = \"discrete\"",
            );
        }
    } else {
        tolerance = table.maybe("tolerance", |item| {
            item.within(
                Quantity::Number,
                "a number above 1e-14 and below 1",
                |tolerance| tolerance > 1e-14 && tolerance < 1.0,
            )
        });
        let fitted =
            form == Some(Some(HistoryForm::Exponentials)) || !matches!(tolerance, Some(None));
        verify = table.or("verify", false, |item| {
            let verify = item.boolean()?;
            if verify && !fitted {
                item.out_of_range("false, or true with a `tolerance`; without it the history is exact and has no exponentials to compare");
                return None;
            }
            Some(verify)
        });
    }
    let exterior_extent = match method {
        Some(KernelMethod::SemiDiscrete | KernelMethod::Historical) => {
            table.forbid("exterior_extent", "it requires method = \"discrete\"");
            Some(None)
        }
        _ => table.maybe("exterior_extent", |item| item.positive(Quantity::Length)),
    };
    table.finish();
    Some(BoundaryCondition::Absorbing {
        side: side?,
        plan: AbsorbingBoundaryPlan {
            method: method?,
            form: form?,
            tolerance: tolerance?,
            verify: verify?,
        },
        exterior_extent: exterior_extent?,
    })
}

fn damping_layer(table: Table<'_>) -> Option<BoundaryCondition> {
    let sides = ["-x", "+x", "-y", "+y", "-z", "+z"];
    let face = table
        .required("side")
        .and_then(|item| item.choice("side", &sides.map(|side| (side, Face::named(side)))))
        .flatten();
    let thickness = table
        .required("thickness")
        .and_then(|item| item.positive(Quantity::Length));
    let reflection = table.or("reflection", 1e-3, |item| {
        item.within(
            Quantity::Number,
            "a number above 1e-12 and below 1",
            |share| share > 1e-12 && share < 1.0,
        )
    });
    let power = table.or("power", 2.0, |item| {
        item.within(Quantity::Number, "a number from 0 to 10", |power| {
            (0.0..=10.0).contains(&power)
        })
    });
    table.finish();
    Some(BoundaryCondition::DampingLayer {
        face: face?,
        thickness: thickness?,
        reflection: reflection?,
        power: power?,
    })
}

fn open(table: Table<'_>) -> Option<BoundaryCondition> {
    let sides = table.required("side").and_then(|item| open_sides(&item));
    let thickness = table.at_most_one(&["cells", "thickness"]);
    let thickness = thickness.and_then(|found| match found {
        None => {
            table.record("cells", BoundaryCondition::CELLS);
            Some(Depth::Cells(f64::from(BoundaryCondition::CELLS)))
        }
        Some(("thickness", item)) => item.positive(Quantity::Length).map(Depth::Length),
        Some((_, item)) => item.count().map(|cells| Depth::Cells(cells as f64)),
    });
    table.finish();
    Some(BoundaryCondition::Open {
        sides: sides?,
        thickness: thickness?,
    })
}

/// Reads a side, a list of sides, or all sides of a plate.
fn open_sides(item: &Item<'_>) -> Option<Vec<Face>> {
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
