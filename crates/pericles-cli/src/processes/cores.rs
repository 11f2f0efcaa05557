//! Processor cores on which a process may run, and how many of them are left to it by other processes of the same machine.

use std::fs;
use std::thread;

use pericles::domain::Comm;

/// The cores of a process.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cores {
    /// Numbers of the cores on which the process may run, ascending.
    pub(super) allowed: Vec<usize>,
    /// Its share of them: a core that n processes may use counts as 1/n.
    pub(super) share: f64,
}

impl Cores {
    /// Returns the cores of this process, which shares them with the processes of `machine`. All of these must call it
    /// together.
    pub(super) fn of_process(machine: &dyn Comm) -> Self {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let list = status
            .lines()
            .find_map(|line| line.strip_prefix("Cpus_allowed_list:"));
        let allowed = list.and_then(numbers).unwrap_or_else(|| {
            // Where the system does not report the numbers, the numbers of an unbound process.
            (0..thread::available_parallelism().map_or(1, |count| count.get())).collect()
        });
        Self::shared(allowed, machine)
    }

    fn shared(allowed: Vec<usize>, machine: &dyn Comm) -> Self {
        let mut end = [allowed.last().map_or(0.0, |&last| last as f64 + 1.0)];
        machine.max(&mut end);
        let mut users = vec![0; end[0] as usize];
        allowed.iter().for_each(|&core| users[core] = 1);
        machine.sum(&mut users);
        let share = allowed.iter().map(|&core| 1.0 / users[core] as f64).sum();
        Self { allowed, share }
    }

    /// Returns the number of threads that the share has room for.
    pub(super) fn threads(&self) -> usize {
        /// Rounding errors of sums of fractions are smaller.
        const ROUNDING: f64 = 1e-6;
        ((self.share + ROUNDING) as usize).max(1)
    }

    /// Returns the numbers as ranges, such as 0-3,8.
    pub(super) fn list(&self) -> String {
        let mut ranges: Vec<[usize; 2]> = Vec::new();
        for &core in &self.allowed {
            match ranges.last_mut() {
                Some([_, last]) if *last + 1 == core => *last = core,
                _ => ranges.push([core; 2]),
            }
        }
        let text = |[first, last]: [usize; 2]| match first == last {
            true => first.to_string(),
            false => format!("{first}-{last}"),
        };
        ranges.into_iter().map(text).collect::<Vec<_>>().join(",")
    }
}

/// Returns the numbers of a list such as 0-3,8.
fn numbers(list: &str) -> Option<Vec<usize>> {
    let mut all = Vec::new();
    for range in list.trim().split(',') {
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        all.extend(first.parse::<usize>().ok()?..=last.parse().ok()?);
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::domain::Threads;

    #[test]
    fn lists_of_cores_are_read_and_written() {
        let found = numbers(" 0-3,8,10-11\n").unwrap();
        assert_eq!(found, [0, 1, 2, 3, 8, 10, 11]);
        let cores = Cores {
            allowed: found,
            share: 7.0,
        };
        assert_eq!(cores.list(), "0-3,8,10-11");
        assert_eq!(numbers("0-x"), None);
    }

    #[test]
    fn processes_share_the_cores_that_several_of_them_may_use() {
        // The allowed cores of each process, and its number of threads.
        type Case<'a> = (&'a [&'a str], &'a [usize]);
        let cases: [Case<'_>; 5] = [
            (&["0-7"], &[8]),
            (&["0-7", "0-7"], &[4, 4]),
            (&["0-3", "4-7"], &[4, 4]),
            // Three processes on two cores, and processes bound to the same core.
            (&["0-1", "0-1", "0-1"], &[1, 1, 1]),
            (&["0", "0", "1-3"], &[1, 1, 3]),
        ];
        for (allowed, expected) in cases {
            let found = Threads::run(allowed.len(), |comm| {
                Cores::shared(numbers(allowed[comm.rank()]).unwrap(), &*comm).threads()
            });
            assert_eq!(found, expected, "{allowed:?}");
        }
    }
}
