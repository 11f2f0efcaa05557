//! Studies as data: what is computed with which arguments, and the numbers it is compared with.
//!
//! A study is a file in the folder `data` (format: [`StudyData`]); what it computes is done by functions that it names ([`Measure`]).

mod case;
mod expansion;
mod format;
mod template;

pub(crate) use case::{Case, Found, Measure, named};
pub(crate) use expansion::rows;
pub(crate) use format::StudyData;
