//! Archives of bodies divided among processes: the archive of the whole body, and the parts of the processes.
//!
//! The arrays of the whole body are in the order of the point numbers in the body, so that they do not depend on the
//! division. Only the first process has whole arrays, and of the other processes' parts one at a time.

use std::borrow::Cow;

use super::message::{bytes_of, into_words, of_words, text_of};
use crate::archive::{Archive, Layout, Values, check_length, missing};
use crate::domain::Domain;
use crate::error::{PericlesError, Result};
use crate::sum::BinnedSum;

impl Archive {
    /// Returns the archive of the whole body on the first process, from those of all processes; `None` on the others.
    /// All processes must call it together. The archive of a body that is not divided is returned unchanged.
    ///
    /// # Errors
    /// An array that does not match its layout, on any process; all processes then return an error.
    pub fn gathered(mut self, domain: &Domain) -> Result<Option<Self>> {
        if !domain.is_divided() {
            return Ok(Some(self));
        }
        agreed(domain, self.check_layouts(domain))?;
        let owners = Owners::of(domain);
        for (name, layout) in std::mem::take(&mut self.layouts) {
            let Some(own) = self.arrays.remove(&name) else {
                continue;
            };
            if let Some(whole) = gather(own, &layout, domain, owners.as_ref()) {
                self.arrays.insert(name, whole);
            }
        }
        Ok(domain.is_first().then_some(self))
    }

    /// Returns the part of the archive `whole` of the whole body that this process restores. The first process passes
    /// `whole`. Names and layouts are those of `template`, which each process has saved from its part of the body. All
    /// processes must call it together. The archive of a body that is not divided is returned unchanged.
    ///
    /// # Errors
    /// No archive on the first process; an array that is missing, of another type or of another length than that of the
    /// body. All processes then return an error.
    pub fn scattered<'a>(
        template: &Self,
        whole: Option<&'a Self>,
        domain: &Domain,
    ) -> Result<Cow<'a, Self>> {
        let whole = match whole {
            None if domain.is_first() => Err(bad("the first process has no archive".into())),
            whole => Ok(whole),
        };
        if let (false, Ok(Some(whole))) = (domain.is_divided(), &whole) {
            return Ok(Cow::Borrowed(whole));
        }
        let whole = agreed(domain, whole)?;
        agreed(domain, template.check_layouts(domain))?;
        let owners = Owners::of(domain);
        let mut own = share(template, whole, domain);
        for (name, layout) in &template.layouts {
            let values = whole.map(|whole| whole.arrays.get(name));
            let part = match template.arrays.get(name) {
                Some(like) => scatter(name, (like, layout), values, domain, owners.as_ref())?,
                None => continue,
            };
            own.arrays.insert(name.clone(), part);
        }
        Ok(Cow::Owned(own))
    }

    /// Checks that all arrays have the numbers that their layouts state.
    fn check_layouts(&self, domain: &Domain) -> Result<()> {
        let points = domain.owned_points();
        for (name, layout) in &self.layouts {
            let Some(values) = self.arrays.get(name) else {
                continue;
            };
            let fits = match layout {
                Layout::Shared => true,
                Layout::Points => is_multiple(values.len(), points),
                Layout::Set(set) => {
                    let ascending = set.is_sorted_by(|a, b| a < b);
                    let inside = set.last().is_none_or(|&last| (last as usize) < points);
                    ascending && inside && is_multiple(values.len(), set.len())
                }
                Layout::Rows(lengths) => {
                    let numbers: usize = lengths.iter().map(|&length| length as usize).sum();
                    lengths.len() == points && numbers == values.len()
                }
                Layout::Count => matches!(values, Values::U64(_)),
                Layout::Sum => sum_of(values).is_some(),
            };
            if !fits {
                return Err(bad(format!(
                    "the array \"{name}\" does not match its layout on the points of a process"
                )));
            }
        }
        Ok(())
    }
}

/// Whether `numbers` are the components of a vector on `points` points.
fn is_multiple(numbers: usize, points: usize) -> bool {
    match points {
        0 => numbers == 0,
        points => numbers.is_multiple_of(points),
    }
}

fn bad(reason: String) -> PericlesError {
    PericlesError::BadArchive { reason }
}

/// Returns the result of this process, or an error if another process has failed.
fn agreed<T>(domain: &Domain, result: Result<T>) -> Result<T> {
    match (domain.all(result.is_ok()), result) {
        (false, Ok(_)) => Err(PericlesError::OnAnotherProcess),
        (_, result) => result,
    }
}

/// The points of all processes, known to the first one.
struct Owners {
    /// Numbers in the whole body of the points of each process.
    numbers: Vec<Vec<u32>>,
    /// Number of points of the body.
    points: usize,
}

impl Owners {
    /// Returns the points of all processes on the first one; `None` on the others.
    fn of(domain: &Domain) -> Option<Self> {
        let own = (0..domain.owned_points()).map(|k| domain.number(k) as f64);
        let messages = domain.collect(own.collect())?;
        let numbers = |message: &Vec<f64>| message.iter().map(|&number| number as u32).collect();
        Some(Self {
            numbers: messages.iter().map(numbers).collect(),
            points: messages.iter().map(Vec::len).sum(),
        })
    }

    /// The process that continues counts and sums of the whole body: the first one with points.
    fn accountant(&self) -> usize {
        let with_points = self.numbers.iter().position(|numbers| !numbers.is_empty());
        with_points.unwrap_or(0)
    }
}

/// The items of an array on one process: points with one or more numbers.
struct Items<'a> {
    numbers: Cow<'a, [u32]>,
    /// Numbers per item; `None` for one.
    lengths: Option<Vec<u32>>,
}

impl<'a> Items<'a> {
    /// Returns what describes the items of this process to the first one.
    fn message(layout: &Layout) -> Vec<f64> {
        match layout {
            Layout::Set(numbers) | Layout::Rows(numbers) => {
                numbers.iter().map(|&number| f64::from(number)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Reads that message of a process with the given points.
    fn of(layout: &Layout, message: &[f64], points: &'a [u32]) -> Self {
        let read = message.iter().map(|&number| number as u32);
        match layout {
            Layout::Set(_) => Self {
                numbers: read.map(|local| points[local as usize]).collect(),
                lengths: None,
            },
            Layout::Rows(_) => Self {
                numbers: Cow::Borrowed(points),
                lengths: Some(read.collect()),
            },
            _ => Self {
                numbers: Cow::Borrowed(points),
                lengths: None,
            },
        }
    }

    fn length(&self, item: usize) -> usize {
        self.lengths
            .as_ref()
            .map_or(1, |lengths| lengths[item] as usize)
    }

    /// Number of numbers of all items in one component.
    fn size(&self) -> usize {
        (0..self.numbers.len()).map(|item| self.length(item)).sum()
    }
}

/// Places of the items of all processes in an array of the whole body.
struct Places<'a> {
    items: Vec<Items<'a>>,
    components: usize,
    /// First place of each point in a component, and the size of a component at the end.
    starts: Vec<usize>,
}

/// Equally long ranges of two arrays: their starts and their length.
type Span = (usize, usize, usize);

impl<'a> Places<'a> {
    fn new(items: Vec<Items<'a>>, components: usize, points: usize) -> Self {
        let mut starts = vec![0; points + 1];
        for own in &items {
            for (item, &number) in own.numbers.iter().enumerate() {
                starts[number as usize + 1] = own.length(item);
            }
        }
        for k in 0..points {
            starts[k + 1] += starts[k];
        }
        Self {
            items,
            components,
            starts,
        }
    }

    /// Number of numbers of the whole array.
    fn size(&self) -> usize {
        self.components * self.starts.last().copied().unwrap_or(0)
    }

    /// Returns the ranges of a process: start in the whole array, start in its own array, length.
    fn spans(&self, process: usize) -> impl Iterator<Item = Span> + '_ {
        let items = &self.items[process];
        let size = self.starts.last().copied().unwrap_or(0);
        let all = (0..self.components)
            .flat_map(move |c| (0..items.numbers.len()).map(move |item| (c * size, item)));
        all.scan(0, move |own, (first, item)| {
            let length = items.length(item);
            let span = (
                first + self.starts[items.numbers[item] as usize],
                *own,
                length,
            );
            *own += length;
            Some(span)
        })
    }
}

/// Copies ranges: start in the target, start in the source, length.
fn copy(target: &mut Values, source: &Values, spans: impl Iterator<Item = Span>) {
    fn each<T: Copy>(target: &mut [T], source: &[T], spans: impl Iterator<Item = Span>) {
        for (to, from, length) in spans {
            target[to..to + length].copy_from_slice(&source[from..from + length]);
        }
    }
    match (target, source) {
        (Values::F64(target), Values::F64(source)) => each(target, source, spans),
        (Values::U64(target), Values::U64(source)) => each(target, source, spans),
        (Values::U8(target), Values::U8(source)) => each(target, source, spans),
        // Both arrays are made of the same type.
        _ => {}
    }
}

/// Returns the sum that an array stores.
fn sum_of(values: &Values) -> Option<BinnedSum> {
    match values {
        Values::U64(numbers) => BinnedSum::of_stored(numbers),
        _ => None,
    }
}

/// Returns an array of the whole body on the first process; `None` on the others.
fn gather(
    own: Values,
    layout: &Layout,
    domain: &Domain,
    owners: Option<&Owners>,
) -> Option<Values> {
    let items = Items::message(layout);
    let components = components(&own, layout, domain);
    let head = [own.len() as f64, items.len() as f64];
    let message = head
        .into_iter()
        .chain(items)
        .chain(into_words(&own))
        .collect();
    let kind = own.zeros(0);
    drop(own);
    let messages = domain.collect(message)?;
    let owners = owners?;
    let parts: Vec<(&[f64], Values)> = messages
        .iter()
        .map(|message| {
            let (items, words) = message[2..].split_at(message[1] as usize);
            (items, of_words(&kind, message[0] as usize, words))
        })
        .collect();
    let all = || parts.iter().map(|(_, values)| values);
    match layout {
        Layout::Shared => all().next().cloned(),
        Layout::Count => all().cloned().reduce(added),
        Layout::Sum => {
            let sum = all().filter_map(sum_of);
            let sum = sum.fold(BinnedSum::default(), BinnedSum::merged);
            Some(Values::U64(sum.stored()))
        }
        Layout::Points | Layout::Set(_) | Layout::Rows(_) => {
            let items = parts.iter().zip(&owners.numbers);
            let items = items.map(|((items, _), points)| Items::of(layout, items, points));
            let places = Places::new(items.collect(), components, owners.points);
            let mut whole = kind.zeros(places.size());
            for (process, values) in all().enumerate() {
                copy(&mut whole, values, places.spans(process));
            }
            Some(whole)
        }
    }
}

/// Adds counts.
fn added(a: Values, b: Values) -> Values {
    match (a, b) {
        (Values::U64(a), Values::U64(b)) => {
            let both = a.iter().zip(&b);
            Values::U64(both.map(|(a, b)| a.saturating_add(*b)).collect())
        }
        (a, _) => a,
    }
}

/// Number of components of a vector on points, equal on all processes. All processes must call it together.
fn components(own: &Values, layout: &Layout, domain: &Domain) -> usize {
    let items = match layout {
        Layout::Points => domain.owned_points(),
        Layout::Set(set) => set.len(),
        _ => return 1,
    };
    domain.max((own.len() / items.max(1)) as f64) as usize
}

/// Returns the part of this process of an array of the whole body, which the first process passes; there, the inner
/// `None` is a missing array.
fn scatter(
    name: &str,
    (like, layout): (&Values, &Layout),
    whole: Option<Option<&Values>>,
    domain: &Domain,
    owners: Option<&Owners>,
) -> Result<Values> {
    let components = components(like, layout, domain);
    let items = domain.collect(Items::message(layout));
    let messages = match (items, owners) {
        (Some(items), Some(owners)) => {
            let whole = whole.flatten().filter(|whole| whole.is_like(like));
            Some(match whole {
                Some(whole) => parts((name, layout), whole, like, (&items, components), owners),
                None => Err(missing(name)),
            })
        }
        _ => None,
    };
    let messages = match messages.transpose() {
        Ok(messages) => agreed(domain, Ok(messages)),
        Err(error) => agreed(domain, Err(error)),
    }?;
    let message = domain.distribute(messages);
    let (length, words) = message
        .split_first()
        .map_or((0, &[][..]), |(length, words)| (*length as usize, words));
    Ok(of_words(like, length, words))
}

/// Returns the messages to all processes with their parts of an array: the number of entries and the entries.
fn parts(
    (name, layout): (&str, &Layout),
    whole: &Values,
    like: &Values,
    (items, components): (&[Vec<f64>], usize),
    owners: &Owners,
) -> Result<Vec<Vec<f64>>> {
    let message = |values: &Values| {
        let length = std::iter::once(values.len() as f64);
        length.chain(into_words(values)).collect()
    };
    let processes = 0..owners.numbers.len();
    let accounts = |others: Values| -> Result<Vec<Vec<f64>>> {
        check_length(name, whole.len(), like.len())?;
        let of = |process| match process == owners.accountant() {
            true => message(whole),
            false => message(&others),
        };
        Ok(processes.clone().map(of).collect())
    };
    match layout {
        Layout::Shared => accounts(whole.clone()),
        Layout::Count => accounts(like.zeros(like.len())),
        Layout::Sum => accounts(Values::U64(BinnedSum::default().stored())),
        Layout::Points | Layout::Set(_) | Layout::Rows(_) => {
            let items = items.iter().zip(&owners.numbers);
            let items = items.map(|(items, points)| Items::of(layout, items, points));
            let places = Places::new(items.collect(), components, owners.points);
            check_length(name, whole.len(), places.size())?;
            let of = |process: usize| {
                let mut own = like.zeros(components * places.items[process].size());
                let spans = places.spans(process);
                copy(
                    &mut own,
                    whole,
                    spans.map(|(to, from, length)| (from, to, length)),
                );
                message(&own)
            };
            Ok(processes.map(of).collect())
        }
    }
}

/// Returns the arrays of the whole archive that are equal on all processes.
fn share(template: &Archive, whole: Option<&Archive>, domain: &Domain) -> Archive {
    let mut shared = Archive::default();
    let message = whole.map(|whole| {
        let shared = whole.arrays.iter();
        let shared = shared.filter(|(name, _)| !template.layouts.contains_key(*name));
        let array = |(name, values): (&String, &Values)| {
            let head = [name.len(), usize::from(values.kind()), values.len()];
            let head = head.into_iter().map(|number| number as f64);
            let name = into_words(&bytes_of(name));
            head.chain(name).chain(into_words(values)).collect()
        };
        shared.map(array).collect::<Vec<Vec<f64>>>().concat()
    });
    let messages = message.map(|message| vec![message; domain.comm().size()]);
    let message = domain.distribute(messages);
    let mut rest = &message[..];
    while let [name, kind, length, words @ ..] = rest {
        let [name, length] = [name, length].map(|&number| number as usize);
        let kind = Values::of_kind(*kind as u8);
        let (name_words, words) = words.split_at(name.div_ceil(8));
        let name = text_of(name, name_words);
        let (words, behind) = words.split_at(kind.words(length));
        shared.arrays.insert(name, of_words(&kind, length, words));
        rest = behind;
    }
    shared
}
