//! Panic handling: a panic in any thread prints one message and ends the program with exit status 1.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::console;
use crate::exit::Exit;

/// Ends the program at the first panic of any thread. Files are written under a temporary name and renamed, so that
/// incomplete files do not replace complete ones.
pub(crate) fn end_at_panics() {
    end(String::new(), std::process::exit);
}

/// Ends all processes that share a run at the first panic of any of them: the others would wait for it.
pub(crate) fn end_job_at_panics(rank: usize, size: usize, abort: fn(i32) -> !) {
    end(format!("process {rank} of {size}: "), abort);
}

fn end(process: String, exit: fn(i32) -> !) {
    static SPOKEN: AtomicBool = AtomicBool::new(false);
    std::panic::set_hook(Box::new(move |panic| {
        // Threads that do the same work fail together; one message is enough.
        while SPOKEN.swap(true, Ordering::Relaxed) {
            std::thread::park();
        }
        console::note(format_args!(
            "pericles: {process}{panic}\nThis is a bug in Pericles {}. Please report it with the deck and the command line.",
            env!("CARGO_PKG_VERSION")
        ));
        exit(i32::from(Exit::Internal.status()));
    }));
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::path::PathBuf;
    use std::process::Command;

    use super::*;

    const FOLDER: &str = "PERICLES_TEST_FOLDER";

    /// The child process of the test below. It panics by itself because no deck is known that makes the program panic.
    #[test]
    #[ignore = "ends its process; started by the test below"]
    fn child() {
        end_at_panics();
        let Some(folder) = std::env::var_os(FOLDER) else {
            return;
        };
        let path = PathBuf::from(folder).join("results.csv");
        let _ = pericles_io::write_atomically(&path, |file| {
            file.write_all(b"step,time\n")?;
            // On all threads at once, like a bug in a parallel loop.
            rayon::broadcast(|_| assert!(std::hint::black_box(false), "deliberate panic"));
            Ok(())
        });
        unreachable!("the hook ends the process");
    }

    #[test]
    fn a_panic_prints_one_message_exits_with_1_and_leaves_files_unchanged() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("results.csv"), "old").unwrap();
        let output = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "bug::tests::child", "--ignored", "--nocapture"])
            .env(FOLDER, folder.path())
            .env("RAYON_NUM_THREADS", "4")
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{told}");
        assert_eq!(told.matches("deliberate panic").count(), 1, "{told}");
        assert_eq!(
            told.matches("This is a bug in Pericles").count(),
            1,
            "{told}"
        );
        assert!(told.contains("src/bug.rs:"), "{told}");
        assert!(!told.contains("RUST_BACKTRACE"), "{told}");
        // The file is unchanged; the temporary file beside it is removed by the next run.
        let path = folder.path().join("results.csv");
        assert_eq!(std::fs::read_to_string(path).unwrap(), "old");
    }
}
