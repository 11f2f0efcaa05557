//! Archives of bodies divided among processes: the archive of the whole body, and the parts of the processes.
//!
//! The arrays of the whole body are in the order of the point numbers in the body, so that they do not depend on the
//! division. [`DividedArchive`] and [`Archive::part_of`] transfer them in ranges of bounded size, so that no process needs the
//! memory of a whole array.
//!
//! An array is transferred in rounds of a bounded number of blocks per process: in each round a process receives the
//! entries of its blocks from their owners and compresses them, and only the compressed sizes are exchanged to find
//! the places of the blocks in the file. Blocks of any size therefore need no padding, and the memory of a round does
//! not depend on the size of the body.

use std::borrow::Cow;
use std::ops::Range;

use super::message::{bytes_of, into_words, of_words, text_of};
use super::placement::{Placement, rounds};
use crate::archive::{Archive, Layout, Values, check_length, missing};
use crate::domain::Domain;
use crate::error::{PericlesError, Result};
use crate::sum::BinnedSum;

/// Entries of the blocks in which whole archives are transferred.
const BLOCK: usize = 1 << 16;

/// Name, type and length of an array of the whole body.
#[derive(Debug, Clone, PartialEq)]
pub struct ArrayOutline {
    /// Its name.
    pub name: String,
    /// An array of its type without entries.
    pub empty: Values,
    /// Number of its entries.
    pub len: usize,
}

impl ArrayOutline {
    /// Returns the outline of an array.
    pub fn of(name: &str, values: &Values) -> Self {
        Self {
            name: name.into(),
            empty: values.zeros(0),
            len: values.len(),
        }
    }

    fn words(&self) -> impl Iterator<Item = f64> {
        let head = [self.name.len(), usize::from(self.empty.kind()), self.len];
        let head = head.into_iter().map(|number| number as f64);
        head.chain(into_words(&bytes_of(&self.name)))
    }

    /// Reads the outline from the start of a message and returns the rest.
    fn of_words(words: &[f64]) -> Option<(Self, &[f64])> {
        let [name, kind, len, words @ ..] = words else {
            return None;
        };
        let (text, rest) = words.split_at((*name as usize).div_ceil(8));
        let outline = Self {
            name: text_of(*name as usize, text),
            empty: Values::of_kind(*kind as u8),
            len: *len as usize,
        };
        Some((outline, rest))
    }
}

/// The archive of a divided body. Each process has the arrays of its part; [`DividedArray::part`] returns ranges of the arrays
/// of the whole body.
pub struct DividedArchive<'a> {
    archive: Archive,
    domain: &'a Domain,
    outline: Vec<ArrayOutline>,
}

/// An array of a divided body.
pub struct DividedArray<'a> {
    values: Values,
    /// `None` if the first process has the whole array.
    placement: Option<Placement>,
    domain: &'a Domain,
}

impl<'a> DividedArchive<'a> {
    /// Combines the archives of all processes. All processes must call it together.
    ///
    /// # Errors
    /// An array that does not match its layout, on any process; all processes then return an error.
    pub fn new(mut archive: Archive, domain: &'a Domain) -> Result<Self> {
        domain.agreed(archive.check_layouts(domain))?;
        archive.add_up(domain)?;
        let lengths = lengths(&archive, domain);
        // The arrays that are not divided come from the first process.
        let outline = |(name, values): (&String, &Values)| {
            let own = ArrayOutline::of(name, values);
            let len = lengths.iter().find(|(divided, _)| divided == &name);
            ArrayOutline {
                len: len.map_or(own.len, |(_, len)| *len),
                ..own
            }
        };
        let outline = archive.arrays.iter().map(outline).collect();
        let outline = shared_outline(domain.is_first().then_some(outline), domain);
        Ok(Self {
            archive,
            domain,
            outline,
        })
    }

    /// Returns the arrays of the whole body, which are the same on all processes.
    pub fn outline(&self) -> &[ArrayOutline] {
        &self.outline
    }

    /// Returns the points of the process and its communication.
    pub fn domain(&self) -> &'a Domain {
        self.domain
    }

    /// Removes the array of an outline. All processes must call it together.
    pub fn take(&mut self, outline: &ArrayOutline) -> DividedArray<'a> {
        let domain = self.domain;
        let layout = self.archive.layouts.remove(&outline.name);
        let values = self.archive.arrays.remove(&outline.name);
        let values = values.filter(|_| layout.is_some() || domain.is_first());
        let values = values.unwrap_or_else(|| outline.empty.clone());
        let placement = layout.map(|layout| Placement::of(&values, &layout, domain));
        DividedArray {
            values,
            placement,
            domain,
        }
    }
}

impl DividedArray<'_> {
    /// Returns whether the first process has the whole array, because its entries do not belong to points.
    pub fn is_on_first(&self) -> bool {
        self.placement.is_none()
    }

    /// Returns the range `ranges[k]` of the array of the whole body on process k; see [`rounds`]. The ranges of all but the
    /// first process must be empty if [`Self::is_on_first`]. All processes must call it together.
    pub fn part(&self, ranges: &[Range<usize>]) -> Values {
        let comm = &**self.domain.comm();
        match &self.placement {
            Some(placement) => placement.collected(&self.values, ranges, comm),
            None if self.domain.is_first() => self.values.slice(ranges[0].clone()),
            None => self.values.zeros(0),
        }
    }

    /// Returns the whole array on the first process, and an empty one on the others.
    fn whole(self, len: usize) -> Values {
        if self.is_on_first() {
            return self.values;
        }
        let size = self.domain.comm().size();
        let mut whole = self.values.zeros(0);
        for ranges in rounds(len, BLOCK, 1, size) {
            whole.append(self.part(&ranges));
        }
        whole
    }
}

/// The archive of a whole body, from which processes read arrays.
pub trait ArraySource {
    /// Returns all arrays. Only those of the first process are used.
    fn outline(&self) -> Vec<ArrayOutline>;

    /// Returns whether all processes can read; otherwise only the first one can. It is the same on all processes.
    fn is_shared(&self) -> bool;

    /// Number of entries of the type of `like` that are read together.
    fn block(&self, like: &Values) -> usize;

    /// Returns a range of an array, which begins at a multiple of [`block`](Self::block). It is inside the array of the
    /// outline.
    ///
    /// # Errors
    /// The array cannot be read.
    fn entries(&mut self, name: &str, range: Range<usize>) -> Result<Values>;
}

/// An archive of the first process.
struct OnFirst<'a>(Option<&'a Archive>);

impl ArraySource for OnFirst<'_> {
    fn outline(&self) -> Vec<ArrayOutline> {
        let arrays = self.0.iter().flat_map(|archive| &archive.arrays);
        arrays
            .map(|(name, values)| ArrayOutline::of(name, values))
            .collect()
    }

    fn is_shared(&self) -> bool {
        false
    }

    fn block(&self, _like: &Values) -> usize {
        BLOCK
    }

    fn entries(&mut self, name: &str, range: Range<usize>) -> Result<Values> {
        let values = self.0.and_then(|archive| archive.arrays.get(name));
        Ok(values.ok_or_else(|| missing(name))?.slice(range))
    }
}

impl Archive {
    /// Returns the archive of the whole body on the first process, from the archives of all processes; `None` on the others.
    /// All processes must call it together. The archive of a body that is not divided is returned unchanged.
    ///
    /// # Errors
    /// An array that does not match its layout, on any process; all processes then return an error.
    pub fn gathered(self, domain: &Domain) -> Result<Option<Self>> {
        if !domain.is_divided() {
            return Ok(Some(self));
        }
        let mut divided = DividedArchive::new(self, domain)?;
        let mut whole = Self::default();
        for outline in std::mem::take(&mut divided.outline) {
            let values = divided.take(&outline).whole(outline.len);
            whole.put(outline.name, values);
        }
        Ok(domain.is_first().then_some(whole))
    }

    /// Returns the part of the archive `whole` of the whole body that this process restores. The first process passes
    /// `whole`. Names and layouts are taken from `template`, which each process has saved from its part of the body. All
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
        let whole = domain.agreed(whole)?;
        Self::part_of(template, &mut OnFirst(whole), domain).map(Cow::Owned)
    }

    /// Returns the part of the archive of the whole body that this process restores, as [`Archive::scattered`], from the
    /// arrays that `source` reads. All processes must call it together.
    ///
    /// # Errors
    /// Those of the source; an array that is missing, of another type or of another length than that of the body. All processes
    /// then return an error.
    pub fn part_of(template: &Self, source: &mut dyn ArraySource, domain: &Domain) -> Result<Self> {
        domain.agreed(template.check_layouts(domain))?;
        let outline = domain.is_first().then(|| source.outline());
        let lengths = lengths(template, domain);
        let fits = match &outline {
            Some(outline) => template.check_outline(outline, &lengths),
            None => Ok(()),
        };
        domain.agreed(fits)?;
        let mut own = Self::default();
        for outline in shared_outline(outline, domain) {
            let name = outline.name.clone();
            let layout = template.layouts.get(&name);
            let like = template.arrays.get(&name).zip(layout);
            let values = match like {
                Some((like, Layout::Count)) => {
                    accounted(like.zeros(like.len()), outline, source, domain)?
                }
                Some((_, Layout::Sum)) => {
                    let none = Values::U64(BinnedSum::default().stored());
                    accounted(none, outline, source, domain)?
                }
                Some((like, layout)) => delivered((like, layout), &outline, source, domain)?,
                None => from_first(&outline, source, domain)?,
            };
            own.arrays.insert(name, values);
        }
        Ok(own)
    }

    /// Returns the part of the archive of the whole body as [`Archive::part_of`], with those arrays of the template only
    /// that `source` has. All processes must call it together.
    ///
    /// # Errors
    /// As for [`Archive::part_of`], except for missing arrays.
    pub fn available_part_of(
        mut template: Self,
        source: &mut dyn ArraySource,
        domain: &Domain,
    ) -> Result<Self> {
        let available = shared_outline(domain.is_first().then(|| source.outline()), domain);
        let is_available = |name: &String| available.iter().any(|found| &found.name == name);
        template.arrays.retain(|name, _| is_available(name));
        template.layouts.retain(|name, _| is_available(name));
        Self::part_of(&template, source, domain)
    }

    /// Checks that the arrays of the whole body, of which divided ones have these lengths, are among the arrays of an outline.
    fn check_outline(&self, outline: &[ArrayOutline], lengths: &[(&String, usize)]) -> Result<()> {
        for (name, like) in &self.arrays {
            let Some(layout) = self.layouts.get(name) else {
                continue;
            };
            let found = outline.iter().find(|found| &found.name == name);
            let found = found.filter(|found| found.empty.is_like(like));
            let found = found.ok_or_else(|| missing(name))?;
            let len = match layout {
                Layout::Count | Layout::Sum => Some(like.len()),
                _ => lengths
                    .iter()
                    .find(|(divided, _)| *divided == name)
                    .map(|&(_, len)| len),
            };
            check_length(name, found.len, len.unwrap_or(like.len()))?;
        }
        Ok(())
    }

    /// Replaces counts and sums by the values of the whole body, which are equal on all processes.
    fn add_up(&mut self, domain: &Domain) -> Result<()> {
        let mut counts = Vec::new();
        for name in self.named(&Layout::Count) {
            if let Some(Values::U64(numbers)) = self.arrays.get(&name) {
                counts.extend(numbers.iter().map(|&number| i128::from(number)));
            }
        }
        let most = domain.max(counts.len() as f64);
        let same = match counts.len() as f64 == most {
            true => Ok(()),
            false => Err(bad("the processes have different numbers of counts".into())),
        };
        domain.agreed(same)?;
        domain.comm().sum(&mut counts);
        // Counters saturate.
        let count = |count: i128| u64::try_from(count).unwrap_or(u64::MAX);
        let mut counts = counts.into_iter().map(count);
        for name in self.named(&Layout::Count) {
            self.layouts.remove(&name);
            if let Some(Values::U64(numbers)) = self.arrays.get_mut(&name) {
                numbers.fill_with(|| counts.next().unwrap_or(0));
            }
        }
        for name in self.named(&Layout::Sum) {
            self.layouts.remove(&name);
            let own = self.arrays.get(&name).and_then(sum_of);
            let [total] = domain.merged([own.unwrap_or_default()]);
            self.arrays.insert(name, Values::U64(total.stored()));
        }
        Ok(())
    }

    /// Returns the names of the arrays with a layout.
    fn named(&self, layout: &Layout) -> Vec<String> {
        let named = self.layouts.iter().filter(|(_, found)| *found == layout);
        named.map(|(name, _)| name.clone()).collect()
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

/// Returns the sum that an array stores.
fn sum_of(values: &Values) -> Option<BinnedSum> {
    match values {
        Values::U64(numbers) => BinnedSum::of_stored(numbers),
        _ => None,
    }
}

/// Returns the lengths of the arrays of the whole body whose entries belong to points. All processes must call it together.
fn lengths<'a>(archive: &'a Archive, domain: &Domain) -> Vec<(&'a String, usize)> {
    let divided = archive.layouts.iter();
    let divided = divided.filter(|(_, layout)| !matches!(layout, Layout::Count | Layout::Sum));
    let names: Vec<&String> = divided.map(|(name, _)| name).collect();
    let length = |name: &&String| archive.arrays.get(*name).map_or(0, Values::len) as i128;
    let mut lengths: Vec<i128> = names.iter().map(length).collect();
    domain.comm().sum(&mut lengths);
    let lengths = lengths.into_iter().map(|length| length as usize);
    names.into_iter().zip(lengths).collect()
}

/// Returns the outline of the first process on all processes. All processes must call it together.
fn shared_outline(outline: Option<Vec<ArrayOutline>>, domain: &Domain) -> Vec<ArrayOutline> {
    let words = |outline: Vec<ArrayOutline>| outline.iter().flat_map(ArrayOutline::words).collect();
    let message: Option<Vec<f64>> = outline.map(words);
    let messages = message.map(|message| vec![message; domain.comm().size()]);
    let message = domain.distribute(messages);
    let mut rest = &message[..];
    let next = || {
        let (outline, words) = ArrayOutline::of_words(rest)?;
        rest = words;
        Some(outline)
    };
    std::iter::from_fn(next).collect()
}

/// Returns an array that the first process reads, on all processes.
fn from_first(
    outline: &ArrayOutline,
    source: &mut dyn ArraySource,
    domain: &Domain,
) -> Result<Values> {
    let values = domain
        .is_first()
        .then(|| source.entries(&outline.name, 0..outline.len));
    let values = domain.agreed(values.transpose())?;
    let message = values.map(|values| into_words(&values));
    let messages = message.map(|message| vec![message; domain.comm().size()]);
    let words = domain.distribute(messages);
    Ok(of_words(&outline.empty, outline.len, &words))
}

/// Returns an array of counts or a sum of the whole body on one process, the first one with points, and `none` on the others.
fn accounted(
    none: Values,
    outline: ArrayOutline,
    source: &mut dyn ArraySource,
    domain: &Domain,
) -> Result<Values> {
    let values = from_first(&outline, source, domain)?;
    let rank = domain.comm().rank() as f64;
    let with_points = domain.max(match domain.owned_points() {
        0 => f64::NEG_INFINITY,
        _ => -rank,
    });
    let accounts = with_points == -rank || with_points.is_infinite() && domain.is_first();
    Ok(if accounts { values } else { none })
}

/// Returns the entries of this process of an array whose entries belong to points.
fn delivered(
    (like, layout): (&Values, &Layout),
    outline: &ArrayOutline,
    source: &mut dyn ArraySource,
    domain: &Domain,
) -> Result<Values> {
    let comm = &**domain.comm();
    let (rank, size) = (comm.rank(), comm.size());
    let placement = Placement::of(like, layout, domain);
    let mut own = like.zeros(like.len());
    let readers = if source.is_shared() { size } else { 1 };
    for ranges in rounds(outline.len, source.block(like), readers, size) {
        let range = ranges[rank].clone();
        let part = match range.is_empty() {
            true => Ok(like.zeros(0)),
            false => source.entries(&outline.name, range),
        };
        let part = domain.agreed(part)?;
        placement.deliver(&part, &ranges, &mut own, comm);
    }
    Ok(own)
}
