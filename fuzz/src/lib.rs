//! Shared parts of the fuzz targets: an allocator with a limit, a clock that counts work, surfaces by the extension of their file, and changes to arrays.

pub mod decks;

use std::alloc::{GlobalAlloc, Layout, System};
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use pericles::cache::{Cache, Key};
use pericles::{Archive, Control, Simulation, Values};

/// Bytes that an input may make the program hold.
const MOST: usize = 1 << 30;

/// Counts what is held and ends the process where that is too much. libFuzzer's own limit looks at pages that were touched; a vector of zeros is none.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);

impl Counting {
    fn take(bytes: usize) {
        let held = HELD.fetch_add(bytes, Ordering::Relaxed).saturating_add(bytes);
        if held > MOST {
            // Nothing may be allocated here, so no message can be made but this one.
            eprintln!("too much memory");
            std::process::abort();
        }
    }

    fn give(bytes: usize) {
        HELD.fetch_sub(bytes, Ordering::Relaxed);
    }
}

// SAFETY: every call is handed on to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::take(layout.size());
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        Self::take(layout.size());
        // SAFETY: the caller's promise.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        Self::give(layout.size());
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A target: what it does with an input, on one thread and within [`LONGEST`].
#[macro_export]
macro_rules! target {
    (|$input:ident: &$kind:tt| $body:expr) => {
        libfuzzer_sys::fuzz_target!(
            init: { $crate::one_thread(); },
            |$input: &$kind| $crate::timed(|| $body)
        );
    };
}

/// Time that an input may take of the processor. libFuzzer has a limit of its own, by the clock on the wall: a busy machine lets that one pass with nothing done.
const LONGEST: Duration = Duration::from_secs(1);

/// Runs an input.
///
/// # Panics
/// If it takes longer than it may.
pub fn timed(run: impl FnOnce()) {
    let (began, used) = (Instant::now(), processor_time());
    run();
    // Asking for the processor's time is a call of the system; most inputs need none.
    if began.elapsed() > LONGEST {
        let used = processor_time().saturating_sub(used);
        assert!(used <= LONGEST, "it took {used:?} of the processor");
    }
}

/// Time that this thread has had.
fn processor_time() -> Duration {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is to a place of the right type that lives on this frame.
    let status = unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &raw mut time) };
    assert_eq!(status, 0);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Runs some steps of a simulation; errors of the run are accepted.
pub fn advance(simulation: &mut Simulation, steps: u32) {
    let mut left = steps;
    let _ = simulation.run(|_| {
        left -= 1;
        if left == 0 { Control::Stop } else { Control::Continue }
    });
}

/// A cache in memory, as the program has one on the disk: kernels that earlier inputs needed are not computed again.
#[derive(Default)]
pub struct Memory(Mutex<HashMap<String, Archive>>);

impl Cache for Memory {
    fn load(&self, key: &Key) -> Option<Archive> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.get(&key.digest()).cloned()
    }

    fn store(&self, key: &Key, arrays: &Archive) {
        /// Entries of a few kilobytes each.
        const MOST: usize = 1000;
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() >= MOST {
            kept.clear();
        }
        kept.insert(key.digest(), arrays.clone());
    }
}

/// Bytes that the content of a file may take.
pub const MEMORY: u64 = 1 << 28;

/// Reads a surface; one that can be read is checked and numbered anew, as bodies are.
pub fn surface(name: &str, content: &[u8]) {
    let Ok(surface) = pericles_io::parse_surface(name, content, MEMORY) else {
        return;
    };
    if let Ok((surface, _)) = surface.checked(Default::default()) {
        surface.renumbered();
    }
}

/// Reads a mesh; one that can be read becomes points with sets.
pub fn mesh(name: &str, content: &[u8]) {
    if let Ok(mesh) = pericles_io::parse_mesh(name, content, MEMORY) {
        let _ = mesh.points(&Default::default());
    }
}

/// Bytes taken from the front of an input; zeros once it is used up.
pub struct Choices<'a>(pub &'a [u8]);

impl Choices<'_> {
    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        match self.0.split_first() {
            Some((&first, rest)) => {
                self.0 = rest;
                first
            }
            None => 0,
        }
    }

    /// The next eight bytes as a number.
    pub fn word(&mut self) -> u64 {
        u64::from_le_bytes(std::array::from_fn(|_| self.byte()))
    }

    /// Whether there are any left.
    pub fn are_left(&self) -> bool {
        !self.0.is_empty()
    }

    /// Changes arrays as the input says: some are left out, renamed by a neighbour's name, cut, lengthened, and have numbers replaced by any others.
    pub fn spoil(&mut self, archive: Archive) -> Archive {
        let mut arrays: Vec<(String, Values)> = archive.into_arrays().into_iter().collect();
        while self.are_left() && !arrays.is_empty() {
            let place = usize::from(self.byte()) % arrays.len();
            match self.byte() % 8 {
                0 => {
                    arrays.remove(place);
                }
                1 => {
                    let other = usize::from(self.byte()) % arrays.len();
                    let name = arrays[other].0.clone();
                    arrays[place].0 = name;
                }
                2 => {
                    let length = usize::from(self.byte());
                    match &mut arrays[place].1 {
                        Values::F64(values) => values.resize(length, 0.0),
                        Values::U64(values) => values.resize(length, 0),
                        Values::U8(values) => values.resize(length, 0),
                    }
                }
                3 => arrays[place].1 = Values::U64(vec![self.word()]),
                _ => {
                    let (at, value) = (usize::from(self.byte()), self.word());
                    match &mut arrays[place].1 {
                        Values::F64(values) if !values.is_empty() => {
                            let at = at % values.len();
                            values[at] = f64::from_bits(value);
                        }
                        Values::U64(values) if !values.is_empty() => {
                            let at = at % values.len();
                            values[at] = value;
                        }
                        Values::U8(values) if !values.is_empty() => {
                            let at = at % values.len();
                            values[at] = value as u8;
                        }
                        _ => {}
                    }
                }
            }
        }
        let mut spoilt = Archive::default();
        for (name, values) in arrays {
            spoilt.put(name, values);
        }
        spoilt
    }
}

/// A text as a basic string of TOML.
pub fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted += &format!("\\u{:04X}", u32::from(c)),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

/// Keeps everything on one thread, so that an input takes the same branches every time.
pub fn one_thread() {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global()
        .unwrap_or_else(|error| panic!("{error}"));
}
