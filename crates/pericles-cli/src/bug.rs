//! What a bug looks like from outside: a panic anywhere in the program is one message and exit status 1, at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::console;
use crate::exit::Exit;

/// Ends the program at the first panic of any thread. Files are written beside their places and renamed, so that those begun are as if they had never been.
pub(crate) fn end_at_panics() {
    static SPOKEN: AtomicBool = AtomicBool::new(false);
    std::panic::set_hook(Box::new(|panic| {
        // Threads that do the same work fail together; one message is enough.
        while SPOKEN.swap(true, Ordering::Relaxed) {
            std::thread::park();
        }
        console::note(format_args!(
            "pericles: {panic}\nThis is a bug in Pericles {}. Please report it with the deck and the command line.",
            env!("CARGO_PKG_VERSION")
        ));
        std::process::exit(i32::from(Exit::Internal.status()));
    }));
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::path::PathBuf;
    use std::process::Command;

    use super::*;

    const FOLDER: &str = "PERICLES_TEST_FOLDER";

    /// What the test below runs in a process of its own: no deck is known that makes the program panic.
    #[test]
    #[ignore = "ends its process; run by the test below"]
    fn child() {
        end_at_panics();
        let Some(folder) = std::env::var_os(FOLDER) else {
            return;
        };
        let path = PathBuf::from(folder).join("results.csv");
        let _ = pericles_io::write_atomically(&path, |file| {
            file.write_all(b"step,time\n")?;
            // On all threads at once, as a bug of a loop would.
            rayon::broadcast(|_| assert!(std::hint::black_box(false), "the sky has fallen"));
            Ok(())
        });
        unreachable!("the hook ends the process");
    }

    #[test]
    fn a_panic_is_one_message_and_status_1_and_no_file() {
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
        assert_eq!(told.matches("the sky has fallen").count(), 1, "{told}");
        assert_eq!(
            told.matches("This is a bug in Pericles").count(),
            1,
            "{told}"
        );
        assert!(told.contains("src/bug.rs:"), "{told}");
        assert!(!told.contains("RUST_BACKTRACE"), "{told}");
        // The file is as it was; what was begun beside it is swept up by the next run.
        let path = folder.path().join("results.csv");
        assert_eq!(std::fs::read_to_string(path).unwrap(), "old");
    }
}
