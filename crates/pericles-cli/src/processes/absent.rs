//! The place of MPI in programs built without it: a job that cannot be started.

use pericles::domain::Comm;

/// A job that does not exist.
pub(super) enum Mpi {}

impl Mpi {
    pub(super) fn start() -> Option<Self> {
        None
    }

    pub(super) fn of_machine(&self) -> Self {
        match *self {}
    }

    pub(super) fn agree_at_end(&self, _own: f64, _waiting: &mut dyn FnMut()) -> f64 {
        match *self {}
    }
}

impl Comm for Mpi {
    fn rank(&self) -> usize {
        match *self {}
    }

    fn size(&self) -> usize {
        match *self {}
    }

    fn exchange(&self, _peers: &[usize], _sent: &[Vec<f64>], _received: &mut [Vec<f64>]) {
        match *self {}
    }

    fn sum(&self, _numbers: &mut [i128]) {
        match *self {}
    }

    fn max(&self, _numbers: &mut [f64]) {
        match *self {}
    }
}

/// Ends the only process.
pub(super) fn abort(status: i32) -> ! {
    std::process::exit(status)
}

/// There is no MPI library.
pub(super) fn library() -> String {
    "none".into()
}
