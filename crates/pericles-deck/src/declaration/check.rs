//! Collector of range errors of models made by programs.

use std::fmt::Debug;

use pericles::PericlesError;

use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::range::{COUNT, POSITIVE, Range};
use crate::remark::{ModelProblem, Remark};

/// Problems found so far.
#[derive(Default)]
pub(crate) struct Check {
    pub(crate) problems: Vec<ModelProblem>,
}

impl Check {
    /// Requires a value to be in its range.
    pub(crate) fn within(
        &mut self,
        right: bool,
        key: KeyPath,
        value: impl ToString,
        allowed: &str,
    ) {
        if !right {
            let (value, allowed) = (value.to_string(), allowed.to_owned());
            let fault = Fault::OutOfRange { value, allowed };
            self.problems.push(Remark::new(key, fault));
        }
    }

    /// Requires a number to be in a range.
    pub(crate) fn number(&mut self, key: KeyPath, value: f64, range: Range) {
        let allowed = || format!("allowed: {}", range.words());
        if !range.contains(value) {
            self.within(false, key, value, &allowed());
        }
    }

    /// Requires a value to be allowed.
    pub(crate) fn allowed(
        &mut self,
        is_allowed: bool,
        key: KeyPath,
        value: impl Debug,
        words: &str,
    ) {
        if !is_allowed {
            self.within(
                false,
                key,
                format!("{value:?}"),
                &format!("allowed: {words}"),
            );
        }
    }

    pub(crate) fn positive(&mut self, key: KeyPath, value: f64) {
        self.number(key, value, POSITIVE);
    }

    pub(crate) fn count(&mut self, key: KeyPath, value: impl Into<u64>) {
        self.number(key, value.into() as f64, COUNT);
    }

    pub(crate) fn axis(&mut self, key: KeyPath, axis: usize) {
        self.within(axis < 3, key, axis, "allowed: 0, 1 or 2");
    }

    pub(crate) fn engine<T>(&mut self, key: KeyPath, result: Result<T, PericlesError>) {
        if let Err(error) = result {
            self.problems.push(Remark::new(key, error.into()));
        }
    }
}
