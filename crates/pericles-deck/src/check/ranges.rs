//! Collector of range errors.

use pericles::PericlesError;

use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::remark::{ModelProblem, Remark};

pub(super) const POSITIVE: &str = "allowed: a positive number";
const COUNT: &str = "allowed: a whole number of at least 1";

/// Problems found so far.
#[derive(Default)]
pub(super) struct Check {
    pub(super) problems: Vec<ModelProblem>,
}

impl Check {
    /// Requires a value to be in its range.
    pub(super) fn within(
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

    pub(super) fn positive(&mut self, key: KeyPath, value: f64) {
        self.within(value > 0.0 && value.is_finite(), key, value, POSITIVE);
    }

    /// Requires a number to be in an open interval.
    pub(super) fn between(&mut self, key: KeyPath, value: f64, [low, high]: [f64; 2]) {
        let allowed = format!("allowed: a number above {low} and below {high}");
        self.within(value > low && value < high, key, value, &allowed);
    }

    pub(super) fn count(&mut self, key: KeyPath, value: impl Into<u64>) {
        let value = value.into();
        self.within(value > 0, key, value, COUNT);
    }

    pub(super) fn axis(&mut self, key: KeyPath, axis: usize) {
        self.within(axis < 3, key, axis, "allowed: 0, 1 or 2");
    }

    pub(super) fn engine<T>(&mut self, key: KeyPath, result: Result<T, PericlesError>) {
        if let Err(error) = result {
            self.problems.push(Remark::new(key, error.into()));
        }
    }
}
