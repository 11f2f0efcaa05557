//! Description and memory of the machine.

use std::path::Path;

/// Returns a description of processor, cores, operating system and architecture.
pub fn words() -> String {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get);
    let system = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
    match processor() {
        Some(name) => format!("{name}, {cores} cores, {system}"),
        None => format!("{cores} cores, {system}"),
    }
}

fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

/// Returns the peak memory of the process in bytes, if the system reports it.
pub fn peak_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(1024 * kilobytes)
}

/// Returns the memory available to the process in bytes, if the system reports it: free or reclaimable memory, or
/// less in a container with a limit.
fn free_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find(|line| line.starts_with("MemAvailable:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(left_in_groups().map_or(1024 * kilobytes, |left| left.min(1024 * kilobytes)))
}

/// Returns the default memory limit in bytes: the available memory, or no limit if the system does not report it.
pub fn memory() -> u64 {
    free_memory().unwrap_or(u64::MAX)
}

/// Returns the memory left by the control groups (version 2) of the process: the minimum over its own group and all
/// parents.
fn left_in_groups() -> Option<u64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let own = groups.lines().find_map(|line| line.strip_prefix("0::/"))?;
    let root = Path::new("/sys/fs/cgroup");
    let folders = root.join(own);
    let folders = folders
        .ancestors()
        .take_while(|path| path.starts_with(root));
    folders.filter_map(left_in).min()
}

fn left_in(group: &Path) -> Option<u64> {
    let number = |file: &str| -> Option<u64> {
        let text = std::fs::read_to_string(group.join(file)).ok()?;
        text.trim().parse().ok()
    };
    // "max", or a missing file, means no limit.
    let most = number("memory.max")?;
    let taken = number("memory.current")?;
    // The file cache is reclaimed when memory is short.
    let stat = std::fs::read_to_string(group.join("memory.stat")).unwrap_or_default();
    let copies = stat
        .lines()
        .find_map(|line| line.strip_prefix("inactive_file "));
    let copies = copies
        .and_then(|bytes| bytes.trim().parse().ok())
        .unwrap_or(0);
    Some(most.saturating_sub(taken.saturating_sub(copies)))
}

/// Parses a size such as 8GB, 512 MiB, or a number of bytes.
pub fn size(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, f64); 8] = [
        ("KiB", 1024.0),
        ("MiB", 1048576.0),
        ("GiB", 1073741824.0),
        ("TiB", 1099511627776.0),
        ("kB", 1e3),
        ("MB", 1e6),
        ("GB", 1e9),
        ("TB", 1e12),
    ];
    let unit = UNITS
        .iter()
        .find_map(|(unit, bytes)| Some((text.strip_suffix(unit)?, *bytes)));
    let (number, bytes) = unit.unwrap_or((text, 1.0));
    let size = number.trim().parse().map(|number: f64| number * bytes);
    size.ok()
        .filter(|size| (1.0..1e18).contains(size))
        .map(|size| size as u64)
        .ok_or_else(|| {
            "expected a positive size such as 8GB, \"512 MiB\" or a number of bytes".to_owned()
        })
}

#[cfg(test)]
mod tests {
    #[test]
    fn sizes_are_parsed_with_units() {
        use super::size;
        assert_eq!(size("8GB"), Ok(8_000_000_000));
        assert_eq!(size("1.5 MiB"), Ok(3 << 19));
        assert_eq!(size("4096"), Ok(4096));
        for wrong in ["", "0", "-1GB", "8Gb", "GB", "nan", "1e99TB"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn free_memory_is_reported() {
        let free = super::free_memory().unwrap();
        assert!(free > 1 << 20, "{free}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn peak_memory_is_reported() {
        let before = super::peak_memory().unwrap();
        let block = std::hint::black_box(vec![1u8; 64 << 20]);
        assert!(super::peak_memory().unwrap() >= before.max(block.len() as u64));
    }
}
