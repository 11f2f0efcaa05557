//! Arrays of VTK XML files: text, base64 or appended data, compressed or not.

use std::borrow::Cow;
use std::io::Read;
use std::str::FromStr;

use flate2::read::ZlibDecoder;

use crate::fault::Fault;
use crate::scan::Words;
use crate::scan::{Bytes, Scalar};

/// Maximum compression ratio of Deflate.
const MOST_PACKED: u64 = 1032;

/// Encoding of binary arrays in a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Encoding {
    pub(crate) little: bool,
    /// Integer type of the numbers before the data.
    pub(crate) header: Scalar,
    pub(crate) packed: bool,
}

/// Location of the numbers of an array.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Source<'a> {
    Text(&'a [u8]),
    Base64(&'a [u8]),
    Raw(&'a [u8]),
}

/// Numbers of an array.
pub(crate) enum Numbers {
    Real(Vec<f64>),
    Whole(Vec<i64>),
}

impl Numbers {
    pub(crate) fn real(self) -> Vec<f64> {
        match self {
            Self::Real(numbers) => numbers,
            Self::Whole(numbers) => numbers.into_iter().map(|number| number as f64).collect(),
        }
    }

    pub(crate) fn whole(self, what: &str) -> Result<Vec<i64>, Fault> {
        match self {
            Self::Whole(numbers) => Ok(numbers),
            Self::Real(_) => Err(Fault::of_file(format!(
                "{what} are real numbers; expected integers"
            ))),
        }
    }
}

/// Reads an array of up to `room` bytes; also returns the memory of its numbers in bytes.
pub(crate) fn read(
    source: Source<'_>,
    scalar: Scalar,
    encoding: Encoding,
    what: &str,
    room: u64,
) -> Result<(Numbers, u64), Fault> {
    let real = matches!(scalar, Scalar::F32 | Scalar::F64);
    if let Source::Text(text) = source {
        // A number has at least one character and a blank, and takes eight bytes; a growing list has capacity
        // for up to twice its length.
        let taken = 8 * text.len() as u64;
        if taken > room {
            return Err(Fault::too_large(taken));
        }
        let numbers = if real {
            Numbers::Real(words(text, what)?)
        } else {
            Numbers::Whole(words(text, what)?)
        };
        return Ok((numbers, taken));
    }
    // The bytes, and the numbers of eight bytes converted from them.
    let taken_of =
        |bytes: u64| bytes.saturating_add((bytes / scalar.bytes() as u64).saturating_mul(8));
    let fits = |bytes: u64| match taken_of(bytes) {
        taken if taken <= room => Ok(()),
        taken => Err(Fault::too_large(taken)),
    };
    let data = match encoding.packed {
        true => unpacked(source, encoding, fits),
        false => plain(source, encoding, fits),
    };
    let data = data.map_err(|fault| Fault {
        needed: fault.needed,
        ..Fault::of_file(format!("{what}: {}", fault.reason))
    })?;
    let count = data.len() / scalar.bytes();
    let mut bytes = Bytes::new(&data, 0, encoding.little);
    let numbers = if real {
        Numbers::Real(
            (0..count)
                .map(|_| bytes.real(scalar))
                .collect::<Result<_, _>>()?,
        )
    } else {
        Numbers::Whole(
            (0..count)
                .map(|_| bytes.integer(scalar))
                .collect::<Result<_, _>>()?,
        )
    };
    Ok((numbers, taken_of(data.len() as u64)))
}

/// Parses all words of a text as numbers.
fn words<T: FromStr>(text: &[u8], what: &str) -> Result<Vec<T>, Fault> {
    let mut words = Words::new(text, None);
    let mut numbers = Vec::new();
    while let Some(word) = words.next() {
        let number = word.parse();
        numbers.push(number.map_err(|_| {
            Fault::of_file(format!(
                "{what}: {word:?} is not a number of the declared type"
            ))
        })?);
    }
    Ok(numbers)
}

/// Returns the first bytes of a source, from at most `characters` characters of base64.
fn begun(source: Source<'_>, characters: usize) -> Result<Cow<'_, [u8]>, Fault> {
    match source {
        Source::Base64(text) => decoded(&text[..characters.min(text.len())]).map(Cow::Owned),
        Source::Raw(data) | Source::Text(data) => Ok(Cow::Borrowed(data)),
    }
}

/// Reads the number of bytes, then the bytes; `fits` rejects excessive sizes.
fn plain(
    source: Source<'_>,
    encoding: Encoding,
    fits: impl Fn(u64) -> Result<(), Fault>,
) -> Result<Vec<u8>, Fault> {
    let data = begun(source, usize::MAX)?;
    let mut bytes = Bytes::new(&data, 0, encoding.little);
    let length = bytes.integer(encoding.header)? as u64;
    let length = bytes.room(length, 1, "bytes")?;
    fits(length as u64)?;
    Ok(bytes.take(length)?.to_vec())
}

/// Reads the number of blocks, the size of a block, the size of the last one if it is not full, and the
/// compressed size of every block; then the blocks. `fits` rejects excessive sizes.
fn unpacked(
    source: Source<'_>,
    encoding: Encoding,
    fits: impl Fn(u64) -> Result<(), Fault>,
) -> Result<Vec<u8>, Fault> {
    let size = encoding.header.bytes();
    // In base64 the table is encoded separately: its length must be known before the rest can be decoded.
    let head = begun(source, group(size))?;
    let mut head = Bytes::new(&head, 0, encoding.little);
    let blocks = head.integer(encoding.header)? as u64;
    let length = match source {
        Source::Base64(data) | Source::Raw(data) | Source::Text(data) => data.len(),
    };
    // The table has three numbers more than there are blocks.
    if blocks > (length / size) as u64 {
        return Err(head.fault(format!(
            "{blocks} blocks are declared, but only {length} bytes follow"
        )));
    }
    let blocks = blocks as usize;
    let table_bytes = (3 + blocks) * size;
    let (table, data) = match source {
        Source::Base64(text) => {
            let (table, data) = text.split_at(group(table_bytes).min(text.len()));
            (Cow::Owned(decoded(table)?), Cow::Owned(decoded(data)?))
        }
        Source::Raw(data) | Source::Text(data) => {
            let (table, data) = data.split_at(table_bytes.min(data.len()));
            (Cow::Borrowed(table), Cow::Borrowed(data))
        }
    };
    let mut table = Bytes::new(&table, size, encoding.little);
    let full = table.integer(encoding.header)? as u64;
    let last = table.integer(encoding.header)? as u64;
    let before_last = full.saturating_mul(blocks.saturating_sub(1) as u64);
    fits(before_last.saturating_add(if last > 0 { last } else { full }))?;
    let mut packed = Bytes::new(&data, 0, encoding.little);
    let mut all = Vec::new();
    for block in 0..blocks {
        let length = table.integer(encoding.header)? as u64;
        let length = packed.room(length, 1, "compressed bytes")?;
        let expected = if block + 1 == blocks && last > 0 {
            last
        } else {
            full
        };
        if expected > MOST_PACKED * (length as u64 + 1) {
            return Err(packed.fault(format!(
                "{expected} bytes cannot be compressed into {length}"
            )));
        }
        let before = all.len();
        ZlibDecoder::new(packed.take(length)?)
            .take(expected + 1)
            .read_to_end(&mut all)
            .map_err(|error| packed.fault(format!("the compressed data are damaged ({error})")))?;
        if (all.len() - before) as u64 != expected {
            return Err(packed.fault(format!(
                "a block has {} bytes instead of {expected}",
                all.len() - before
            )));
        }
    }
    Ok(all)
}

/// Returns the number of base64 characters of some bytes.
fn group(bytes: usize) -> usize {
    bytes.div_ceil(3) * 4
}

/// Decodes base64 text (RFC 4648) up to the first incomplete group.
fn decoded(text: &[u8]) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let mut group = 0u32;
    let mut digits = 0;
    for &character in text {
        let digit = match character {
            b'A'..=b'Z' => character - b'A',
            b'a'..=b'z' => character - b'a' + 26,
            b'0'..=b'9' => character - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            // End of a group or of the data.
            b'=' | b'<' => break,
            character if character.is_ascii_whitespace() => continue,
            character => {
                return Err(Fault::of_file(format!(
                    "{:?} is not a base64 digit",
                    char::from(character)
                )));
            }
        };
        group = group << 6 | u32::from(digit);
        digits += 1;
        if digits == 4 {
            bytes.extend_from_slice(&group.to_be_bytes()[1..]);
            (group, digits) = (0, 0);
        }
    }
    if digits > 1 {
        group <<= 6 * (4 - digits);
        bytes.extend_from_slice(&group.to_be_bytes()[1..digits]);
    }
    Ok(bytes)
}
