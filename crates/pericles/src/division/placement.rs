//! Places of the entries of divided arrays in the arrays of the whole body.

use std::ops::Range;

use super::message::{into_words, of_words};
use crate::archive::{Layout, Values};
use crate::domain::{Comm, Domain, exchange_all};

/// Blocks of a process in one round: with blocks of 512 KiB, messages of at most 8 MiB.
const BLOCKS: usize = 16;

/// Cuts an array into ranges that processes handle together, one round after another. A range consists of whole blocks of
/// `block` entries, except at the end of the array. The first `active` of `size` processes have about equal shares of every
/// round; the ranges of the others are empty. The shares are bounded, so that the memory of a round does not depend on the
/// length of the array.
pub fn rounds(
    len: usize,
    block: usize,
    active: usize,
    size: usize,
) -> impl Iterator<Item = Vec<Range<usize>>> {
    let blocks = len.div_ceil(block);
    let most = BLOCKS * active;
    (0..blocks).step_by(most).map(move |first| {
        let count = most.min(blocks - first);
        let start = |k: usize| (block * (first + k.min(active) * count / active)).min(len);
        (0..size).map(|k| start(k)..start(k + 1)).collect()
    })
}

/// Entries that follow each other in two arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Span {
    /// First entry in the array of the whole body, or in a range of it.
    whole: usize,
    /// First entry in the array of the process.
    own: usize,
    length: usize,
}

/// The places of the entries of a process in an array of the whole body.
#[derive(Debug)]
pub(super) struct Placement {
    /// Places in the first component, in ascending order in both arrays.
    spans: Vec<Span>,
    components: usize,
    /// Entries of a component of this process, and of the whole body.
    own: usize,
    whole: usize,
}

impl Placement {
    /// Returns the places of an array on points. All processes must call it together.
    pub(super) fn of(values: &Values, layout: &Layout, domain: &Domain) -> Self {
        let points = domain.owned_points();
        let (numbers, lengths): (Vec<usize>, &[u32]) = match layout {
            Layout::Set(set) => {
                let number = |&k: &u32| domain.number(k as usize);
                (set.iter().map(number).collect(), &[])
            }
            Layout::Rows(lengths) => ((0..points).map(|k| domain.number(k)).collect(), lengths),
            _ => ((0..points).map(|k| domain.number(k)).collect(), &[]),
        };
        let length = |k: usize| lengths.get(k).map_or(1, |&length| length as usize);
        let own = (0..numbers.len()).map(length).sum();
        let components = match layout {
            Layout::Rows(_) => 1,
            _ => domain.max((values.len() / numbers.len().max(1)) as f64) as usize,
        };
        let (starts, whole) = match layout {
            Layout::Set(_) | Layout::Rows(_) => starts(&numbers, &length, domain),
            _ => (numbers, domain.whole_points()),
        };
        let mut spans: Vec<Span> = Vec::new();
        let mut next = 0;
        for (k, &start) in starts.iter().enumerate() {
            let length = length(k);
            match spans.last_mut() {
                Some(last) if last.whole + last.length == start => last.length += length,
                _ if length == 0 => {}
                _ => spans.push(Span {
                    whole: start,
                    own: next,
                    length,
                }),
            }
            next += length;
        }
        Self {
            spans,
            components,
            own,
            whole,
        }
    }

    /// Returns the entries of this process in a range of the whole array, relative to the range, in ascending order.
    fn spans(&self, range: Range<usize>) -> impl Iterator<Item = Span> + '_ {
        let first = range.start.checked_div(self.whole).unwrap_or(0);
        let last = match self.whole {
            0 => 0,
            size => range.end.div_ceil(size).min(self.components),
        };
        (first..last).flat_map(move |c| {
            // The part of the range in this component.
            let start = range.start.saturating_sub(c * self.whole);
            let end = (range.end - c * self.whole).min(self.whole);
            let before = move |span: &Span| span.whole + span.length <= start;
            let first = self.spans.partition_point(before);
            let inside = self.spans[first..]
                .iter()
                .take_while(move |s| s.whole < end);
            let offset = c * self.whole;
            let range = range.clone();
            inside.map(move |span| {
                let skipped = start.saturating_sub(span.whole);
                let whole = span.whole + skipped;
                Span {
                    whole: offset + whole - range.start,
                    own: c * self.own + span.own + skipped,
                    length: (span.whole + span.length).min(end) - whole,
                }
            })
        })
    }

    /// Returns the range `ranges[k]` of the whole array on process k, from the arrays of all processes. All processes must call
    /// it together.
    pub(super) fn collected(
        &self,
        own: &Values,
        ranges: &[Range<usize>],
        comm: &dyn Comm,
    ) -> Values {
        let message = |range: &Range<usize>| {
            let spans: Vec<Span> = self.spans(range.clone()).collect();
            let words = into_words(&picked(own, &spans, |span| span.own));
            packed(&spans).chain(words).collect()
        };
        let received = exchange_all(comm, ranges.iter().map(message).collect());
        let mut part = own.zeros(ranges[comm.rank()].len());
        for message in received {
            let (spans, words) = unpacked(&message);
            let values = of_words(own, size(&spans), words);
            copy(&mut part, &values, &spans, |span| (span.whole, span.own));
        }
        part
    }

    /// Copies the entries of this process from the whole array, of which process k has the range `ranges[k]` in `part`. All
    /// processes must call it together.
    pub(super) fn deliver(
        &self,
        part: &Values,
        ranges: &[Range<usize>],
        own: &mut Values,
        comm: &dyn Comm,
    ) {
        let wanted = ranges
            .iter()
            .map(|range| self.spans(range.clone()).collect());
        let wanted: Vec<Vec<Span>> = wanted.collect();
        let requests = wanted.iter().map(|spans| packed(spans).collect());
        let requests = exchange_all(comm, requests.collect());
        let reply = |request: &Vec<f64>| {
            let (spans, _) = unpacked(request);
            into_words(&picked(part, &spans, |span| span.whole))
        };
        let received = exchange_all(comm, requests.iter().map(reply).collect());
        for (mut spans, words) in wanted.into_iter().zip(&received) {
            let values = of_words(own, size(&spans), words);
            let mut next = 0;
            for span in &mut spans {
                span.whole = next;
                next += span.length;
            }
            copy(own, &values, &spans, |span| (span.own, span.whole));
        }
    }
}

/// Returns the first entries of points with `length(k)` entries each, in the order of the numbers of all points, and the number
/// of all entries. All processes must call it together.
fn starts(
    numbers: &[usize],
    length: &dyn Fn(usize) -> usize,
    domain: &Domain,
) -> (Vec<usize>, usize) {
    let comm = &**domain.comm();
    let (rank, size) = (comm.rank(), comm.size());
    // Process k adds up the lengths of equally many consecutive points.
    let share = domain.whole_points().div_ceil(size).max(1);
    let mut messages = vec![Vec::new(); size];
    for (k, &number) in numbers.iter().enumerate() {
        let word = (number % share) << 32 | length(k);
        messages[number / share].push(f64::from_bits(word as u64));
    }
    let mut received = exchange_all(comm, messages);
    let split = |word: f64| (word.to_bits() >> 32, word.to_bits() as u32);
    let mut places = vec![0; share];
    for &word in received.iter().flatten() {
        let (number, length) = split(word);
        places[number as usize] = length as usize;
    }
    let mut own = 0;
    for place in &mut places {
        own += std::mem::replace(place, own);
    }
    let mut totals = vec![0; size];
    totals[rank] = own as i128;
    comm.sum(&mut totals);
    let before = totals[..rank].iter().sum::<i128>() as usize;
    for word in received.iter_mut().flatten() {
        let (number, _) = split(*word);
        *word = (before + places[number as usize]) as f64;
    }
    // The numbers increase, and so do the processes that add up their lengths.
    let replies = exchange_all(comm, received).into_iter().flatten();
    let starts = replies.map(|start| start as usize).collect();
    (starts, totals.iter().sum::<i128>() as usize)
}

/// Number of entries of spans.
fn size(spans: &[Span]) -> usize {
    spans.iter().map(|span| span.length).sum()
}

/// Returns the words of places in a range: their number, and one word for each.
fn packed(spans: &[Span]) -> impl Iterator<Item = f64> + '_ {
    // Rounds bound the ranges, so that both numbers fit.
    let word = |span: &Span| f64::from_bits((span.whole as u64) << 32 | span.length as u64);
    std::iter::once(spans.len() as f64).chain(spans.iter().map(word))
}

/// Reads these words; returns the places and the remaining words. The entries follow each other in the array of the sender.
fn unpacked(message: &[f64]) -> (Vec<Span>, &[f64]) {
    let Some((&count, rest)) = message.split_first() else {
        return (Vec::new(), message);
    };
    let (words, rest) = rest.split_at(count as usize);
    let mut own = 0;
    let spans = words.iter().map(|word| {
        let span = Span {
            whole: (word.to_bits() >> 32) as usize,
            own,
            length: word.to_bits() as u32 as usize,
        };
        own += span.length;
        span
    });
    (spans.collect(), rest)
}

/// Returns the entries of spans, one after another, from the array in which they begin at `start`.
fn picked(source: &Values, spans: &[Span], start: fn(&Span) -> usize) -> Values {
    fn each<T: Copy>(source: &[T], spans: &[Span], start: fn(&Span) -> usize) -> Vec<T> {
        let mut picked = Vec::with_capacity(size(spans));
        for span in spans {
            let start = start(span);
            picked.extend_from_slice(&source[start..start + span.length]);
        }
        picked
    }
    match source {
        Values::F64(source) => Values::F64(each(source, spans, start)),
        Values::U64(source) => Values::U64(each(source, spans, start)),
        Values::U8(source) => Values::U8(each(source, spans, start)),
    }
}

/// Copies the entries of spans; `places` returns their first entries in target and source.
fn copy(target: &mut Values, source: &Values, spans: &[Span], places: fn(&Span) -> (usize, usize)) {
    fn each<T: Copy>(
        target: &mut [T],
        source: &[T],
        spans: &[Span],
        places: fn(&Span) -> (usize, usize),
    ) {
        for span in spans {
            let (to, from) = places(span);
            target[to..to + span.length].copy_from_slice(&source[from..from + span.length]);
        }
    }
    match (target, source) {
        (Values::F64(target), Values::F64(source)) => each(target, source, spans, places),
        (Values::U64(target), Values::U64(source)) => each(target, source, spans, places),
        (Values::U8(target), Values::U8(source)) => each(target, source, spans, places),
        // Both arrays are made of the same type.
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Threads;

    #[test]
    fn rounds_cover_an_array_once_with_shares_of_bounded_size() {
        for (len, block, active, size) in [
            (0, 8, 2, 3),
            (1, 8, 1, 1),
            (8 * 16 * 3 + 5, 8, 3, 3),
            (1000, 3, 2, 5),
            (1000, 7, 1, 4),
        ] {
            let mut next = 0;
            for ranges in rounds(len, block, active, size) {
                assert_eq!(ranges.len(), size);
                for (k, range) in ranges.iter().enumerate() {
                    assert_eq!(range.start, next);
                    assert!(range.is_empty() || range.start % block == 0 && k < active);
                    assert!(range.len() <= BLOCKS * block);
                    next = range.end;
                }
            }
            assert_eq!(next, len);
        }
    }

    /// Point k belongs to process k² modulo the number of processes, the last of which has no points.
    fn domain(points: u32, comm: std::sync::Arc<dyn Comm>) -> Domain {
        let owners = (comm.size() as u32 - 1).max(1);
        let own = |&k: &u32| (k * k) % owners == comm.rank() as u32;
        let numbers: Vec<u32> = (0..points).filter(own).collect();
        let own = numbers.len();
        Domain::new(numbers, own, Vec::new(), comm)
    }

    /// Layout, own entries, and the entries of the whole array, each with its number in it.
    fn array(kind: usize, points: u32, domain: &Domain) -> (Layout, Values, usize) {
        let own: Vec<usize> = (0..domain.owned_points())
            .map(|k| domain.number(k))
            .collect();
        let n = points as usize;
        match kind {
            0 => {
                let entries = (0..2).flat_map(|c| own.iter().map(move |k| (c * n + k) as f64));
                (Layout::Points, Values::F64(entries.collect()), 2 * n)
            }
            1 => {
                // Every third point.
                let set = (0..own.len() as u32).filter(|&k| own[k as usize].is_multiple_of(3));
                let set: Vec<u32> = set.collect();
                let count = n.div_ceil(3);
                let place = |c: usize, k: u32| (c * count + own[k as usize] / 3) as u64;
                let entries = (0..3).flat_map(|c| set.iter().map(move |&k| place(c, k)));
                let entries = entries.collect();
                (Layout::Set(set), Values::U64(entries), 3 * count)
            }
            _ => {
                let length = |k: usize| k % 4;
                let lengths = own.iter().map(|&k| length(k) as u32).collect();
                let start = |k: usize| (0..k).map(length).sum::<usize>();
                let entries = own
                    .iter()
                    .flat_map(|&k| (start(k)..start(k) + length(k)).map(|entry| entry as u8));
                (
                    Layout::Rows(lengths),
                    Values::U8(entries.collect()),
                    start(n),
                )
            }
        }
    }

    #[test]
    fn entries_are_collected_in_the_order_of_the_whole_body_and_returned() {
        for size in [1, 2, 3, 5, 8] {
            for (points, kind) in [1, 2, 40, 331]
                .into_iter()
                .flat_map(|n| [(n, 0), (n, 1), (n, 2)])
            {
                let found = Threads::run(size, |comm| {
                    let domain = domain(points, comm.clone());
                    let (layout, own, len) = array(kind, points, &domain);
                    let placement = Placement::of(&own, &layout, &domain);
                    let mut back = own.zeros(own.len());
                    let mut parts = Vec::new();
                    for active in [1, size] {
                        for ranges in rounds(len, 3, active, size) {
                            let part = placement.collected(&own, &ranges, &*comm);
                            placement.deliver(&part, &ranges, &mut back, &*comm);
                            parts.push((ranges[comm.rank()].clone(), part));
                        }
                        assert_eq!(back, own);
                    }
                    parts
                });
                for (range, part) in found.into_iter().flatten() {
                    let expected = match part {
                        Values::F64(_) => Values::F64(range.map(|k| k as f64).collect()),
                        Values::U64(_) => Values::U64(range.map(|k| k as u64).collect()),
                        Values::U8(_) => Values::U8(range.map(|k| k as u8).collect()),
                    };
                    assert_eq!(part, expected, "{size} processes, kind {kind}");
                }
            }
        }
    }
}
