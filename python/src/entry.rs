//! Entry to computations: threads, forked processes, panics, and waiting with an eye on Ctrl-C.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use pericles_run::{Cancel, Means};
use pyo3::prelude::*;

use crate::errors;

/// How often a computation looks for signals such as Ctrl-C.
pub const POLL: Duration = Duration::from_millis(50);

/// Whether this process has computed in parallel.
static USED: AtomicBool = AtomicBool::new(false);
/// Whether this process was forked from one that had computed in parallel: its threads were not copied.
static FORKED: AtomicBool = AtomicBool::new(false);

/// Rejects computations in a process that was forked after a parallel computation: its threads were not copied.
pub fn enter() -> PyResult<()> {
    if FORKED.load(Ordering::Relaxed) {
        return Err(errors::plain(
            "this process was forked after a parallel computation, whose threads were not copied; \
             use multiprocessing.get_context(\"spawn\"), or threads: runs release the interpreter's lock",
        ));
    }
    USED.store(true, Ordering::Relaxed);
    Ok(())
}

/// Notes that this process was forked.
#[pyfunction]
pub fn after_fork() {
    if USED.load(Ordering::Relaxed) {
        FORKED.store(true, Ordering::Relaxed);
    }
}

/// Returns cache, memory and devices for building and running a model.
pub fn means() -> Means {
    Means {
        #[cfg(feature = "command-line")]
        devices: pericles_cli::graphics_processors(),
        ..Means::default()
    }
}

/// Starts the global pool with a number of threads.
#[pyfunction]
pub fn set_threads(count: usize) -> PyResult<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count);
    pool.build_global().map_err(|_| {
        errors::plain(
            "the threads have already started; call set_threads before the first computation",
        )
    })
}

/// The number of threads that computations use.
#[pyfunction]
pub fn threads() -> usize {
    rayon::current_num_threads()
}

/// Calls `work` and turns a panic, which is a bug, into an exception.
pub fn guarded<T>(work: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let words = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let words = words.or_else(|| panic.downcast_ref::<String>().cloned());
        Err(errors::plain(&format!(
            "this is a bug in Pericles {}: {}; please report it with the deck and the script",
            env!("CARGO_PKG_VERSION"),
            words.unwrap_or_default()
        )))
    })
}

/// Runs `work` in a thread of its own and waits for it; Ctrl-C, or another exception of a signal handler, cancels it. It then
/// ends in order, and the exception is raised.
pub fn cancellable<T: Send + 'static>(
    py: Python<'_>,
    cancel: &Cancel,
    work: impl FnOnce() -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    attended(py, Some(cancel), work)
}

/// Runs `work`, which cannot be interrupted, in a thread of its own and waits for it; Ctrl-C ends the wait at once.
pub fn waiting<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    attended(py, None, work)
}

fn attended<T: Send + 'static>(
    py: Python<'_>,
    cancel: Option<&Cancel>,
    work: impl FnOnce() -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    enter()?;
    py.detach(|| {
        let (sender, receiver) = channel();
        std::thread::spawn(move || {
            // The receiver is gone if Ctrl-C has ended the wait.
            let _ = sender.send(guarded(work));
        });
        let mut raised = None;
        loop {
            match receiver.recv_timeout(POLL) {
                Ok(made) => return raised.map_or(made, Err),
                Err(RecvTimeoutError::Timeout) => {
                    let signals = Python::attach(|py| py.check_signals());
                    match (signals, cancel) {
                        (Ok(()), _) => {}
                        (Err(error), Some(cancel)) => {
                            cancel.cancel();
                            raised = Some(error);
                        }
                        (Err(error), None) => return Err(error),
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(errors::plain(
                        "the thread of a computation ended without a result",
                    ));
                }
            }
        }
    })
}
