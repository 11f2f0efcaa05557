//! Damaged files: every prefix and many mutations of every file are read or refused, without a panic and within memory in proportion to their size.
//!
//! The mutations of the usual test are few; `cargo test --release -p pericles-mesh --test mutations -- --ignored --nocapture` makes a million of every file.

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

/// Bytes that arrays of a VTK file may take in these tests.
const MEMORY: u64 = 1 << 24;

/// Bytes that reading one of these files, of a few kilobytes, may hold at once: the arrays above, as bytes, words and numbers.
const MOST: usize = 1 << 27;

/// The system's allocator, counting what is held.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

/// The count is of the whole process: one test at a time.
static ONE: Mutex<()> = Mutex::new(());

// SAFETY: every call is handed on to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let held = HELD.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(held, Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A file that is damaged: its name and its content.
struct Original {
    name: String,
    format: Format,
    content: Vec<u8>,
}

/// The mesh of the tests in all formats, and the seeds of the fuzz targets.
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

/// Everything that follows a reader; whether the content was read.
fn use_all(format: Format, content: &[u8]) -> bool {
    if format == Format::Vtk {
        let _ = parse_fields(content, MEMORY);
    }
    let alone = |name: &str| Err(format!("{name} is not there"));
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

/// Uses a content and fails, naming it, if that panics or holds too much memory; whether it was read.
fn try_out(original: &Original, content: &[u8], what: &dyn Fn() -> String) -> bool {
    let before = HELD.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    let result = catch_unwind(|| use_all(original.format, content));
    let taken = PEAK.load(Ordering::Relaxed).saturating_sub(before);
    if result.is_err() || taken > MOST {
        let path = std::env::temp_dir().join("pericles-mutation");
        let _ = fs::write(&path, content);
        panic!(
            "{}, {}: {} MiB held; the content is in {}",
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

/// Numbers and words that readers may stumble over.
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

/// Changes a content in one to four places: bytes replaced, bits turned, words written over it or put in, ranges left out, repeated or cut off.
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

/// Runs mutations of every file, with numbers of what was read and the largest memory.
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
                "{:<28} {:>5} bytes: {mutations} mutations, {read} read, at most {:.2} MiB held, {:.1} s",
                original.name,
                original.content.len(),
                peak as f64 / f64::from(1 << 20),
                began.elapsed().as_secs_f64()
            );
        }
    }
}

#[test]
fn originals_are_read() {
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
fn every_prefix_is_read_or_refused() {
    let _one = ONE.lock();
    for original in originals() {
        for length in 0..original.content.len() {
            let what = || format!("the first {length} bytes");
            try_out(&original, &original.content[..length], &what);
        }
    }
}

#[test]
fn mutations_are_read_or_refused() {
    run(300, false);
}

#[test]
#[ignore = "a million mutations of every file: minutes, in release"]
fn a_million_mutations_of_every_file_are_read_or_refused() {
    run(1_000_000, true);
}
