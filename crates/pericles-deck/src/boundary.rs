//! `[[boundary]]`: absorbing boundaries.

use pericles::space::Face;
use pericles_waves::absorbing::history::HistoryForm;
use pericles_waves::absorbing::{AbsorbingBoundaryPlan, KernelMethod, Side};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;
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
}

#[derive(Clone, Copy)]
enum Kind {
    Absorbing,
    DampingLayer,
}

pub(crate) fn read(table: Table<'_>) -> Option<BoundaryCondition> {
    let kinds = [
        ("absorbing", Kind::Absorbing),
        ("damping-layer", Kind::DampingLayer),
    ];
    let kind = table
        .required("kind")
        .and_then(|item| item.choice("kind of boundary", &kinds));
    match kind {
        Some(Kind::DampingLayer) => damping_layer(table),
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
