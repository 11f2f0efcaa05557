//! Checkpoints that processes write and read together; the processes are threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use pericles::archive::{Layout, SavedUnder};
use pericles::domain::{Domain, Threads};
use pericles::sum::BinnedSum;
use pericles::{Archive, Values};
use serde_json::json;

use super::*;
use crate::{CheckpointFolder, Container};

/// The process of point k of a number of points.
type Owner = fn(k: usize, points: usize, size: usize) -> usize;

/// Short runs of points that alternate; the last process has no points.
const ALTERNATING: Owner = |k, _, size| k / 7 % (size - 1).max(1);
/// Consecutive points; the first process has no points.
const CONSECUTIVE: Owner = |k, points, size| (k * size / points).max(1.min(size - 1));

fn domain(points: usize, owner: Owner, comm: Arc<dyn Comm>) -> Domain {
    let own = |&k: &u32| owner(k as usize, points, comm.size()) == comm.rank();
    let numbers: Vec<u32> = (0..points as u32).filter(own).collect();
    let own = numbers.len();
    Domain::new(numbers, own, Vec::new(), comm)
}

/// Arrays of all layouts; entries depend on the numbers of points in the whole body.
fn archive(points: usize, domain: &Domain) -> Archive {
    let own: Vec<usize> = (0..domain.owned_points())
        .map(|k| domain.number(k))
        .collect();
    let value = |c: usize, k: usize| (c as f64 + 1.0) * ((k * k + c) as f64).sqrt();
    let mut archive = Archive::default();
    let vector = (0..4).flat_map(|c| own.iter().map(move |&k| value(c, k)));
    archive.put_as("u", Values::F64(vector.collect()), Layout::Points);
    let set = (0..own.len() as u32).filter(|&k| own[k as usize].is_multiple_of(5));
    let set: Vec<u32> = set.collect();
    let on_set = set.iter().map(|&k| (own[k as usize] as u64) << 40);
    archive.put_as("set", Values::U64(on_set.collect()), Layout::Set(set));
    let length = |&k: &usize| (k % 4 + points % 3) as u32;
    let bits = own.iter().flat_map(|k| vec![*k as u8; length(k) as usize]);
    let lengths = own.iter().map(length).collect();
    archive.put_as("bits", Values::U8(bits.collect()), Layout::Rows(lengths));
    archive.put_as("none", Values::F64(Vec::new()), Layout::Set(Vec::new()));
    let broken = own.iter().filter(|k| k.is_multiple_of(3)).count() as u64;
    archive.put_as("broken", Values::U64(vec![broken, 0]), Layout::Count);
    let work = BinnedSum::of(own.len(), |k| value(0, own[k]));
    work.save_under("work", &mut archive);
    archive.put("t", Values::F64(vec![0.1 + 0.2]));
    // The first process writes tables, and their lengths belong to it.
    if domain.is_first() {
        archive.put("table", Values::U64(vec![17]));
    }
    archive
}

fn metadata() -> Value {
    json!({ "step": 40, "deck": "plate.toml" })
}

/// The container of the whole body.
fn whole(points: usize) -> Container {
    let archive = archive(points, &Domain::alone(points));
    Container::from_archive(metadata(), archive)
}

fn write(path: &Path, points: usize, owner: Owner, comm: Arc<dyn Comm>) -> Result<(), IoError> {
    let domain = domain(points, owner, comm);
    let archive = DividedArchive::new(archive(points, &domain), &domain).unwrap();
    write_divided(path, &metadata(), archive)
}

#[test]
fn processes_write_the_bytes_of_a_single_one_and_read_their_parts() {
    let folder = tempfile::tempdir().unwrap();
    let [alone, path] = ["alone.chk", "a.chk"].map(|name| folder.path().join(name));
    for (points, sizes) in [
        (1, &[1, 2, 3][..]),
        (100, &[1, 2, 3, 4, 5, 8]),
        (200_000, &[2, 3, 8]),
    ] {
        whole(points).write(&alone).unwrap();
        let expected = fs::read(&alone).unwrap();
        for (&size, owner) in sizes
            .iter()
            .flat_map(|size| [(size, ALTERNATING), (size, CONSECUTIVE)])
        {
            for written in Threads::run(size, |comm| write(&path, points, owner, comm)) {
                written.unwrap();
            }
            assert!(
                fs::read(&path).unwrap() == expected,
                "{points} points, {size} processes"
            );
            Threads::run(size, |comm| {
                let mut opened = DividedCheckpoint::open(&path, u64::MAX, &*comm).unwrap();
                assert_eq!(opened.metadata(), &metadata());
                let domain = domain(points, owner, comm);
                let own = archive(points, &domain);
                let read = Archive::part_of(&own, &mut opened, &domain).unwrap();
                // The process that continues counts and sums has the values of the body.
                for name in ["u", "set", "bits", "none", "t"] {
                    assert_eq!(read.arrays()[name], own.arrays()[name], "{name}");
                }
                assert_eq!(read.arrays()["table"], Values::U64(vec![17]));
                let again = DividedArchive::new(read, &domain).unwrap();
                assert_eq!(
                    again.outline().len(),
                    own.arrays().len() + usize::from(!domain.is_first())
                );
            });
        }
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

/// Measures the largest messages of a process in one exchange.
struct Metered {
    inner: Arc<dyn Comm>,
    most: Arc<AtomicUsize>,
}

impl Comm for Metered {
    fn rank(&self) -> usize {
        self.inner.rank()
    }

    fn size(&self) -> usize {
        self.inner.size()
    }

    fn exchange(&self, peers: &[usize], sent: &[Vec<f64>], received: &mut [Vec<f64>]) {
        self.inner.exchange(peers, sent, received);
        for messages in [sent, received] {
            let words = messages.iter().map(Vec::len).sum();
            self.most.fetch_max(words, Ordering::Relaxed);
        }
    }

    fn sum(&self, numbers: &mut [i128]) {
        self.inner.sum(numbers);
    }

    fn max(&self, numbers: &mut [f64]) {
        self.inner.max(numbers);
    }
}

#[test]
fn messages_do_not_grow_with_the_body() {
    /// 16 blocks of numbers, and a sixth for the places of runs of seven entries.
    const MOST: usize = 16 * (1 << 16) * 7 / 6;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.chk");
    let points = 700_000;
    let most = Arc::new(AtomicUsize::new(0));
    Threads::run(2, |inner| {
        let most = Arc::clone(&most);
        let comm: Arc<dyn Comm> = Arc::new(Metered { inner, most });
        let owner: Owner = |k, _, size| k / 7 % size;
        write(&path, points, owner, Arc::clone(&comm)).unwrap();
        let mut opened = DividedCheckpoint::open(&path, u64::MAX, &*comm).unwrap();
        let domain = domain(points, owner, comm);
        let own = archive(points, &domain);
        let read = Archive::part_of(&own, &mut opened, &domain).unwrap();
        assert_eq!(read.arrays()["u"], own.arrays()["u"]);
    });
    let most = most.load(Ordering::Relaxed);
    assert!(most > MOST / 4 && most <= MOST, "{most} words");
    let entries = 4 * points;
    assert!(entries > 2 * MOST, "the array has several rounds");
}

/// Writes on three processes, the last but one of which opens the unfinished file in another way.
fn write_opening(path: &Path, open: fn(&Path) -> io::Result<File>) -> Vec<Result<(), IoError>> {
    Threads::run(3, |comm| {
        let rank = comm.rank();
        let domain = domain(60_000, CONSECUTIVE, comm);
        let archive = DividedArchive::new(archive(60_000, &domain), &domain).unwrap();
        let open = |path: &Path| match rank {
            1 => open(path),
            _ => OpenOptions::new().write(true).open(path),
        };
        write_opened(path, &metadata(), archive, &open)
    })
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_of_one_process_leaves_the_previous_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.chk");
    fs::write(&path, "old").unwrap();
    let full = |_: &Path| OpenOptions::new().write(true).open("/dev/full");
    let errors = write_opening(&path, full)
        .into_iter()
        .map(Result::unwrap_err);
    for (rank, error) in errors.enumerate() {
        match rank {
            1 => assert!(matches!(error, IoError::DiskFull { .. }), "{error}"),
            _ => assert!(matches!(error, IoError::OnAnotherProcess { .. }), "{error}"),
        }
        assert_eq!(error.path(), path);
    }
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn the_first_process_writes_alone_if_another_does_not_see_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let [alone, path] = ["alone.chk", "a.chk"].map(|name| folder.path().join(name));
    whole(60_000).write(&alone).unwrap();
    let unseen = |_: &Path| Err(io::Error::from(io::ErrorKind::NotFound));
    for written in write_opening(&path, unseen) {
        written.unwrap();
    }
    assert!(fs::read(&path).unwrap() == fs::read(&alone).unwrap());
}

#[test]
fn a_file_that_cannot_be_replaced_is_an_error_of_all_processes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.chk");
    fs::create_dir(&path).unwrap();
    let gone = folder.path().join("gone/a.chk");
    for path in [&path, &gone] {
        let errors = Threads::run(3, |comm| write(path, 50, ALTERNATING, comm).unwrap_err());
        assert!(errors[0].is_output_problem(), "{}", errors[0]);
        for error in &errors[1..] {
            assert!(matches!(error, IoError::OnAnotherProcess { .. }), "{error}");
        }
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn damaged_files_are_rejected_by_all_processes_and_the_first_reports_why() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.chk");
    whole(60_000).write(&path).unwrap();
    let good = fs::read(&path).unwrap();
    let errors = |memory: u64| {
        Threads::run(4, |comm| {
            let opened = DividedCheckpoint::open(&path, memory, &*comm);
            opened.map(|_| ()).unwrap_err()
        })
    };
    let check = |errors: Vec<IoError>, reason: &str| {
        assert!(errors[0].to_string().contains(reason), "{}", errors[0]);
        for error in &errors[1..] {
            assert!(matches!(error, IoError::OnAnotherProcess { .. }), "{error}");
        }
    };
    // In the header, the table, and blocks of all processes.
    let ends = (0..24).map(|k| good.len() - 1 - k * good.len() / 25);
    for at in [13, 40].into_iter().chain(ends) {
        let mut bytes = good.clone();
        bytes[at] ^= 4;
        fs::write(&path, bytes).unwrap();
        let reason = if at == 13 { "header" } else { "CRC-32" };
        check(errors(u64::MAX), reason);
        fs::write(&path, &good[..at]).unwrap();
        check(errors(u64::MAX), "a.chk is damaged");
    }
    fs::write(&path, [&good[..], b"x"].concat()).unwrap();
    check(errors(u64::MAX), "do not fill");
    fs::write(&path, &good).unwrap();
    check(errors(100_000), "of memory");
    fs::remove_file(&path).unwrap();
    check(errors(u64::MAX), "does not exist");
}

#[test]
fn the_previous_checkpoint_replaces_a_damaged_one_on_all_processes() {
    let place = tempfile::tempdir().unwrap();
    let folder = CheckpointFolder::new(place.path().join("checkpoints"));
    let written = Threads::run(3, |comm| {
        let domain = domain(3000, ALTERNATING, comm);
        let write = |step: u64| {
            let archive = DividedArchive::new(archive(3000, &domain), &domain).unwrap();
            folder.write_divided(step, &json!({ "step": step }), archive)
        };
        [10, 20, 30].map(|step| write(step).unwrap())
    });
    assert_eq!(written[0][2], folder.file(30));
    assert_eq!(folder.steps().unwrap(), [20, 30]);
    let damage = |step: u64| {
        let mut bytes = fs::read(folder.file(step)).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(folder.file(step), bytes).unwrap();
    };
    let latest = |memory: u64| {
        Threads::run(3, |comm| {
            let latest = folder.latest_divided(memory, &*comm);
            latest.map(|(opened, rejected)| (opened.metadata()["step"].clone(), rejected.len()))
        })
    };
    assert!(matches!(latest(1)[0], Err(IoError::TooLarge { .. })));
    damage(30);
    for found in latest(u64::MAX) {
        assert_eq!(found.unwrap(), (json!(20), 1));
    }
    damage(20);
    let found = latest(u64::MAX);
    let none = |found: &Result<_, IoError>| matches!(found, Err(IoError::NoValidCheckpoint { rejected, .. }) if rejected.len() == 2);
    assert!(none(&found[0]));
    for found in &found[1..] {
        assert!(matches!(found, Err(IoError::OnAnotherProcess { .. })));
    }
}
