//! Declaration of absorbing boundaries.

use pericles_deck_derive::DeckTable;
use pericles_waves::absorbing::history::HistoryForm;
use pericles_waves::absorbing::{AbsorbingBoundaryPlan, KernelMethod};
use serde::{Deserialize, Serialize};

use super::described;

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
