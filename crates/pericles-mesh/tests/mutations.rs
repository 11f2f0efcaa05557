//! Damaged files: every prefix and many mutations of every file are read or rejected, without a panic and
//! with memory in proportion to their size.
//!
//! The default test uses few mutations;
//! `cargo test --release -p pericles-mesh --test mutations -- --ignored --nocapture` runs a million for every
//! file.

#[path = "formats/cdf.rs"]
mod cdf;
#[allow(dead_code)]
#[path = "formats/files.rs"]
mod files;

use std::alloc::{GlobalAlloc, Layout, System};
use std::fs;
use std::panic::catch_unwind;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use pericles_mesh::fill::{Outline, TriangleSurface};
use pericles_mesh::{Format, PointOptions, Summary, parse_fields};

/// Memory limit for arrays of a VTK file in these tests, bytes.
const MEMORY: u64 = 1 << 24;

/// Memory limit for reading one of these files of a few kilobytes, bytes: the arrays above, as bytes, words
/// and numbers.
const MOST: usize = 1 << 27;

/// The system allocator with a count of allocated bytes.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

/// The count is per process, so that tests run one at a time.
static ONE: Mutex<()> = Mutex::new(());

// SAFETY: every call is forwarded unchanged to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let held = HELD.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(held, Ordering::Relaxed);
        // SAFETY: guaranteed by the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: guaranteed by the caller.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A file to mutate: its name and content.
struct Original {
    name: String,
    format: Format,
    content: Vec<u8>,
}

/// The test mesh in all formats, and the seeds of the fuzz targets.
fn originals() -> Vec<Original> {
    let format = |ending: &str| Format::of(&Path::new("a").with_extension(ending)).unwrap();
    let mut all: Vec<Original> = (0..)
        .zip(files::all())
        .map(|(number, (ending, content)): (usize, _)| Original {
            name: format!("{ending} {number}"),
            format: format(ending),
            content,
        })
        .collect();
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    for (folder, ending) in [
        ("abaqus", "inp"),
        ("exodus", "exo"),
        ("gmsh", "msh"),
        ("obj", "obj"),
        ("off", "off"),
        ("ply", "ply"),
        ("stl", "stl"),
        ("vtp", "vtp"),
        ("vtu", "vtu"),
    ] {
        let mut paths: Vec<_> = fs::read_dir(seeds.join(folder))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        paths.sort();
        for path in paths {
            all.push(Original {
                name: format!("{folder} {}", path.file_name().unwrap().display()),
                format: format(ending),
                content: fs::read(&path).unwrap(),
            });
        }
    }
    #[cfg(feature = "netcdf4")]
    all.extend(
        [
            ("meshio", &include_bytes!("files/meshio.exo")[..]),
            ("compressed", include_bytes!("files/compressed.exo")),
        ]
        .map(|(name, content)| Original {
            name: format!("netCDF-4 {name}"),
            format: Format::Exodus,
            content: content.to_vec(),
        }),
    );
    all
}

/// Calls all functions that follow a reader; returns whether the content was read.
fn use_all(format: Format, content: &[u8]) -> bool {
    if format == Format::Vtk {
        let _ = parse_fields(content, MEMORY);
    }
    let alone = |name: &str| Err(format!("{name} does not exist"));
    let Ok(mesh) = format.parse(content, MEMORY, &alone) else {
        return false;
    };
    if let Ok(points) = mesh.points(&PointOptions::default()) {
        let _ = points.check_sizes(1.0);
        let _ = Summary::new(&mesh, &points, 1.0);
    }
    if let Ok(surface) = TriangleSurface::of_mesh(&mesh, 1.0) {
        let _ = (surface.bounds(), surface.unmatched_edges());
    }
    let corners = mesh.nodes.iter().map(|x| [x[0], x[1]]);
    let _ = Outline::new(vec![corners.collect()]);
    true
}

/// Runs [`use_all`] and fails with the name of the content if that panics or allocates too much memory;
/// returns whether it was read.
fn try_out(original: &Original, content: &[u8], what: &dyn Fn() -> String) -> bool {
    let before = HELD.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    let result = catch_unwind(|| use_all(original.format, content));
    let taken = PEAK.load(Ordering::Relaxed).saturating_sub(before);
    if result.is_err() || taken > MOST {
        let path = std::env::temp_dir().join("pericles-mutation");
        let _ = fs::write(&path, content);
        panic!(
            "{}, {}: {} MiB allocated; the content is in {}",
            original.name,
            what(),
            taken >> 20,
            path.display()
        );
    }
    result.unwrap_or(false)
}

/// Random numbers (splitmix64).
struct Random(u64);

impl Random {
    fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.word() % n.max(1) as u64) as usize
    }
}

/// Numbers and words that may trigger errors in readers.
const WORDS: [&[u8]; 14] = [
    b"-1",
    b"0",
    b"4294967295",
    b"18446744073709551615",
    b"1e308",
    b"1e-320",
    b"nan",
    b"-inf",
    b"\n",
    b" ",
    b"\xff\xff\xff\xff",
    b"\x7f\xff\xff\xff\xff\xff\xff\xff",
    b"\0\0\0\0\0\0\0\0",
    b"\x80",
];

/// Mutates a content in one to four places: replaces bytes, flips bits, overwrites or inserts words, removes,
/// repeats or truncates ranges.
fn mutate(content: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(content.len());
        let length = (1 + random.below(16)).min(content.len().saturating_sub(at));
        match random.below(9) {
            _ if content.is_empty() => content.push(random.word() as u8),
            0 | 1 => content[at] = random.word() as u8,
            2 | 3 => content[at] ^= 1 << random.below(8),
            4 => {
                let word = WORDS[random.below(WORDS.len())];
                let end = (at + word.len()).min(content.len());
                content.splice(at..end, word.iter().copied());
            }
            5 => {
                let word = WORDS[random.below(WORDS.len())];
                content.splice(at..at, word.iter().copied());
            }
            6 => {
                content.drain(at..at + length);
            }
            7 => {
                let part = content[at..at + length].to_vec();
                let place = random.below(content.len());
                content.splice(place..place, part);
            }
            _ => content.truncate(at),
        }
    }
}

/// Runs mutations of every file and prints the number of files read and the peak memory.
fn run(mutations: u64, show: bool) {
    let _one = ONE.lock();
    for (number, original) in (0u64..).zip(&originals()) {
        let began = Instant::now();
        let (mut read, mut peak) = (0u64, 0);
        for mutation in 0..mutations {
            let mut random = Random(number << 40 | mutation);
            let mut content = original.content.clone();
            mutate(&mut content, &mut random);
            let what = || format!("mutation {mutation}");
            let before = HELD.load(Ordering::Relaxed);
            read += u64::from(try_out(original, &content, &what));
            peak = peak.max(PEAK.load(Ordering::Relaxed).saturating_sub(before));
        }
        if show {
            println!(
                "{:<28} {:>5} bytes: {mutations} mutations, {read} read, peak memory {:.2} MiB, {:.1} s",
                original.name,
                original.content.len(),
                peak as f64 / f64::from(1 << 20),
                began.elapsed().as_secs_f64()
            );
        }
    }
}

#[test]
fn unmodified_files_are_read() {
    let _one = ONE.lock();
    for original in originals() {
        assert!(
            try_out(&original, &original.content, &|| "unchanged".into()),
            "{}",
            original.name
        );
    }
}

#[test]
fn every_truncated_file_is_read_or_rejected() {
    let _one = ONE.lock();
    for original in originals() {
        for length in 0..original.content.len() {
            let what = || format!("the first {length} bytes");
            try_out(&original, &original.content[..length], &what);
        }
    }
}

#[test]
fn mutated_files_are_read_or_rejected() {
    run(300, false);
}

#[test]
#[ignore = "a million mutations of every file take minutes in release builds"]
fn a_million_mutations_of_every_file_are_read_or_rejected() {
    run(1_000_000, true);
}
