//! Studies as data: computations, their arguments, and the values they are compared with.
//!
//! A study is a file in the folder `data` (format: [`StudyData`]); its computations are functions that it names
//! ([`Measure`]).

mod case;
mod expansion;
mod format;
mod template;

pub(crate) use case::{Case, Found, Measure, named};
pub(crate) use expansion::rows;
pub(crate) use format::StudyData;
