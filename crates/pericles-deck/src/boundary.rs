//! `[[boundary]]`: ends and sides through which waves leave.

use pericles::space::Face;
use pericles_waves::absorbing::history::HistoryForm;
use pericles_waves::absorbing::{EndPlan, KernelMethod, Side};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;
use crate::words::Worded;

/// A boundary with memory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum BoundaryCondition {
    /// An exact absorbing end of a bar.
    Absorbing {
        /// The end.
        #[serde(with = "crate::form")]
        side: Side,
        /// Its kernels, and how its history is kept.
        #[serde(with = "crate::form")]
        plan: EndPlan,
        /// How far the initial fields go on beyond the end, m; none where nothing moves there.
        #[serde(default)]
        exterior_data: Option<f64>,
    },
    /// A layer in which motion dies away, of any body.
    DampingLayer {
        /// The side.
        #[serde(rename = "side", with = "crate::form")]
        face: Face,
        /// Its depth, m.
        thickness: f64,
        /// Share of the amplitude of a long wave, head on, that comes back.
        reflection: f64,
        /// The power with which the damping grows.
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
        // Of a kind that nobody knows, the rest is read as of the first.
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
        let why = "it belongs to exponentials (history = \"auto\" or \"exponentials\", method = \"discrete\"); the other histories are exact";
        table.forbid("tolerance", why);
        table.forbid("verify", why);
        if form == Some(Some(HistoryForm::Exponentials)) && method.is_some() {
            table.forbid(
                "history",
                "\"auto\", \"blocked\" or \"direct\": exponentials are fitted to method = \"discrete\" only",
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
                item.out_of_range("false, or a `tolerance` beside it: without one the history is exact, and there are no exponentials to compare");
                return None;
            }
            Some(verify)
        });
    }
    let exterior_data = match method {
        Some(KernelMethod::SemiDiscrete | KernelMethod::Historical) => {
            table.forbid("exterior_data", "it belongs to method = \"discrete\"");
            Some(None)
        }
        _ => table.maybe("exterior_data", |item| item.positive(Quantity::Length)),
    };
    table.finish();
    Some(BoundaryCondition::Absorbing {
        side: side?,
        plan: EndPlan {
            method: method?,
            form: form?,
            tolerance: tolerance?,
            verify: verify?,
        },
        exterior_data: exterior_data?,
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
