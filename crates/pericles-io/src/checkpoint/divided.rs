//! Checkpoints of bodies divided among processes, written and read by all of them.
//!
//! Every process encodes and writes blocks of the arrays of the whole body in the same file. Where the processes do not share
//! the file system of the file, the first one writes and reads all blocks. No process has more than its part of the body and
//! blocks of bounded size.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use pericles::division::{ArrayOutline, ArraySource, DividedArchive, rounds};
use pericles::domain::{self, Comm, all, collect, distribute, text_message, text_of};
use pericles::{PericlesError, Values};
use serde_json::Value;

use super::block::{Block, Coder, entries};
use super::container::read_section;
use super::head::{Draft, Entry, Head, Opening, Placed};
use super::kind::Kind;
use super::section::{Codec, Section};
use crate::IoError;
use crate::atomic::{create_beside, finish};

/// Opens the unfinished file that the first process has created.
type Open<'a> = &'a (dyn Fn(&Path) -> io::Result<File> + Sync);

/// Writes the checkpoint of a divided body atomically, with the bytes that
/// [`Container::write`](super::Container::write) writes for the whole body. The metadata come from the first process. All processes must call it together.
///
/// # Errors
/// The file cannot be written by one of the processes: the others return [`IoError::OnAnotherProcess`]. An existing file is then
/// unchanged.
pub fn write_divided(
    path: &Path,
    metadata: &Value,
    archive: DividedArchive<'_>,
) -> Result<(), IoError> {
    let open = |path: &Path| OpenOptions::new().write(true).open(path);
    write_opened(path, metadata, archive, &open)
}

fn write_opened(
    path: &Path,
    metadata: &Value,
    archive: DividedArchive<'_>,
    open: Open<'_>,
) -> Result<(), IoError> {
    let comm = &**archive.domain().comm();
    let is_first = comm.rank() == 0;
    let failed = |source| IoError::writing(path, source);
    let created = is_first.then(|| {
        let entries = archive.outline().iter().map(entry).collect();
        let draft = Draft::new(metadata, entries).map_err(|error| failed(error.into()))?;
        Ok((create_beside(path).map_err(failed)?, draft))
    });
    let created = agreed(comm, path, created.transpose())?;
    let text = created.as_ref().map(|((temporary, _), draft)| {
        // The other processes need the name only: the folder may have another path there.
        let name = temporary.file_name().unwrap_or_default().to_string_lossy();
        let end = std::iter::once(draft.end() as f64);
        end.chain(text_message(&name)).collect()
    });
    let words = distribute(comm, text.map(|text: Vec<f64>| vec![text; comm.size()]));
    let temporary = path.with_file_name(text_of(words.get(1..).unwrap_or_default()));
    let (file, draft) = match created {
        Some(((_, file), draft)) => (Some(file), Some(draft)),
        None => (open(&temporary).ok(), None),
    };
    let written = Writer {
        path,
        comm,
        file,
        draft,
        end: words.first().map_or(0, |&end| end as u64),
        table: Vec::new(),
        coder: Coder::default(),
    }
    .write(archive);
    // The file has been closed by all processes.
    let finished = match written {
        Ok(()) if is_first => finish(&temporary, path).map_err(failed),
        written => written,
    };
    let finished = agreed(comm, path, finished);
    if is_first && finished.is_err() {
        // Report the first error.
        let _ = fs::remove_file(&temporary);
    }
    finished
}

fn entry(outline: &ArrayOutline) -> Entry {
    Entry {
        name: outline.name.clone(),
        kind: Kind::of(&outline.empty),
        len: outline.len as u64,
        codec: Codec::ShuffleLz4,
    }
}

/// A process that writes blocks.
struct Writer<'a> {
    path: &'a Path,
    comm: &'a dyn Comm,
    /// `None` if the process cannot open the file.
    file: Option<File>,
    /// On the first process.
    draft: Option<Draft>,
    /// Place of the next block in the file.
    end: u64,
    /// Numbers of the blocks of this process, and what the table contains for them.
    table: Vec<(usize, Block)>,
    coder: Coder,
}

impl Writer<'_> {
    /// Writes all blocks, then the head, and closes the file. All processes return an error if one does.
    fn write(mut self, archive: DividedArchive<'_>) -> Result<(), IoError> {
        let failed = |source| IoError::writing(self.path, source);
        let (path, comm) = (self.path, self.comm);
        let written = self.write_blocks(archive).map_err(failed);
        agreed(comm, path, written)?;
        let word = |&(number, block): &(usize, Block)| {
            [
                number as f64,
                f64::from_bits(u64::from_le_bytes(block.to_bytes())),
            ]
        };
        let messages = collect(comm, self.table.iter().flat_map(word).collect());
        let ended = (|| {
            let Some(mut file) = self.file else {
                return Ok(());
            };
            if let (Some(messages), Some(draft)) = (messages, self.draft) {
                let head = draft.bytes(&table_of(&messages, draft.blocks()));
                file.seek(SeekFrom::Start(0))?;
                file.write_all(&head)?;
            }
            file.sync_all()
        })();
        agreed(
            comm,
            path,
            ended.map_err(|source| IoError::writing(path, source)),
        )
    }

    /// Writes the blocks, as long as all processes can.
    fn write_blocks(&mut self, mut archive: DividedArchive<'_>) -> io::Result<()> {
        let (rank, size) = (self.comm.rank(), self.comm.size());
        let writers = match all(self.comm, self.file.is_some()) {
            true => size,
            false => 1,
        };
        let mut buffer = Vec::new();
        let mut written = Ok(());
        let mut before = 0;
        for outline in archive.outline().to_vec() {
            let array = archive.take(&outline);
            let block = entries(Kind::of(&outline.empty));
            let writers = if array.is_on_first() { 1 } else { writers };
            for ranges in rounds(outline.len, block, writers, size) {
                buffer.clear();
                let mut number = before + ranges[rank].start / block;
                let part = Section::from(array.part(&ranges));
                part.encode(&mut self.coder, &mut |block, bytes| {
                    self.table.push((number, block));
                    number += 1;
                    buffer.extend_from_slice(bytes);
                    Ok(())
                })?;
                // The bytes of every process, and whether one has failed.
                let mut sizes = vec![0; size + 1];
                sizes[rank] = buffer.len() as i128;
                sizes[size] = i128::from(written.is_err());
                self.comm.sum(&mut sizes);
                if sizes[size] > 0 {
                    return written;
                }
                let total = |sizes: &[i128]| sizes.iter().sum::<i128>() as u64;
                let place = self.end + total(&sizes[..rank]);
                self.end += total(&sizes[..size]);
                if let (Some(file), false) = (&mut self.file, buffer.is_empty()) {
                    let sought = file.seek(SeekFrom::Start(place));
                    written = sought.and_then(|_| file.write_all(&buffer));
                }
            }
            before += outline.len.div_ceil(block);
        }
        written
    }
}

/// Returns the table of all blocks from the messages of all processes.
fn table_of(messages: &[Vec<f64>], blocks: u64) -> Vec<Block> {
    let none = Block {
        stored: 0,
        crc32: 0,
    };
    let mut table = vec![none; blocks as usize];
    for words in messages.iter().flat_map(|message| message.chunks_exact(2)) {
        table[words[0] as usize] = Block::of_bytes(&words[1].to_bits().to_le_bytes());
    }
    table
}

/// A checkpoint that the processes of a divided body read together ([`Archive::part_of`](pericles::Archive::part_of)).
pub struct DividedCheckpoint {
    path: PathBuf,
    metadata: Value,
    content: Content,
    is_shared: bool,
    coder: Coder,
}

/// What a process reads.
enum Content {
    /// Nothing: the process cannot open the file.
    None,
    /// The file.
    Blocks(File, Head),
}

impl Content {
    fn open(path: &Path, memory: u64) -> Result<Self, IoError> {
        let reading = |source| IoError::reading(path, source);
        let mut file = File::open(path).map_err(reading)?;
        let length = file.metadata().map_err(reading)?.len();
        let opening = Opening::read(path, &mut file, length, memory)?;
        let head = Head::read(path, opening, &mut file, memory)?;
        Ok(Self::Blocks(file, head))
    }

    /// Checksums that identify a file; none for one that processes cannot read together.
    fn checks(&self) -> Vec<f64> {
        match self {
            Self::Blocks(_, head) => head.checks.map(f64::from).to_vec(),
            _ => Vec::new(),
        }
    }
}

impl DividedCheckpoint {
    /// Opens a checkpoint and verifies it, each process a share. The part of a process may take at most `memory` bytes. All
    /// processes must call it together.
    ///
    /// # Errors
    /// The file cannot be read, is damaged or exceeds the memory: the error comes from the first process, also for what
    /// another one finds; the others return [`IoError::OnAnotherProcess`].
    pub fn open(path: &Path, memory: u64, comm: &dyn Comm) -> Result<Self, IoError> {
        let size = comm.size();
        let memory = memory.saturating_mul(size as u64);
        let is_first = comm.rank() == 0;
        let opened = is_first.then(|| Content::open(path, memory)).transpose();
        let opened = agreed(comm, path, opened)?;
        let checks = opened.as_ref().map(|content| vec![content.checks(); size]);
        let checks = distribute(comm, checks);
        let content = opened.or_else(|| match checks.is_empty() {
            true => None,
            false => {
                // The same file: the folder may be another one there.
                let content = Content::open(path, memory).ok();
                content.filter(|content| content.checks() == checks)
            }
        });
        let content = content.unwrap_or(Content::None);
        let is_shared = all(comm, matches!(content, Content::Blocks(..)));
        let mut checkpoint = Self {
            path: path.into(),
            metadata: Value::Null,
            content,
            is_shared,
            coder: Coder::default(),
        };
        if let Content::Blocks(_, head) = &mut checkpoint.content {
            checkpoint.metadata = std::mem::take(&mut head.metadata);
        }
        checkpoint.verify(comm)?;
        Ok(checkpoint)
    }

    /// Returns the metadata; `null` on processes that cannot open the file.
    pub fn metadata(&self) -> &Value {
        &self.metadata
    }

    /// Returns the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Verifies the checksums of all blocks.
    fn verify(&mut self, comm: &dyn Comm) -> Result<(), IoError> {
        let (rank, size) = (comm.rank(), comm.size());
        let share = match (self.is_shared, rank) {
            (true, _) => [rank, rank + 1].map(|k| (k, size)),
            (false, 0) => [0, 1].map(|k| (k, 1)),
            (false, _) => [0, 0].map(|k| (k, 1)),
        };
        let verified = match &mut self.content {
            Content::Blocks(file, head) => verify_share(&self.path, file, head, share),
            _ => Ok(()),
        };
        let reason = match &verified {
            Err(IoError::Damaged { reason, .. }) => reason.clone(),
            Err(error) => error.to_string(),
            Ok(()) => String::new(),
        };
        // The first process reports for all.
        let reasons = collect(comm, text_message(&reason));
        let reason = reasons.and_then(|reasons| reasons.into_iter().find(|one| !one.is_empty()));
        let result = match reason {
            Some(reason) if verified.is_ok() => Err(IoError::damaged(&self.path, text_of(&reason))),
            _ if rank == 0 => verified,
            _ => Ok(()),
        };
        agreed(comm, &self.path, result)
    }
}

/// Verifies the blocks in a share [start, end) of all, as fractions.
fn verify_share(
    path: &Path,
    file: &mut File,
    head: &Head,
    share: [(usize, usize); 2],
) -> Result<(), IoError> {
    let [start, end] = share.map(|(part, whole)| head.blocks.len() * part / whole);
    let mut bytes = Vec::new();
    for number in start..end {
        let (block, place) = head.blocks[number];
        let reading = |source| IoError::reading(path, source);
        file.seek(SeekFrom::Start(place)).map_err(reading)?;
        bytes.resize(block.stored as usize, 0);
        io::Read::read_exact(file, &mut bytes).map_err(reading)?;
        if crc32fast::hash(&bytes) != block.crc32 {
            let inside = |placed: &&Placed| placed.blocks.contains(&number);
            let section = head.sections.iter().find(inside).map(|placed| &placed.name);
            let name = section.map_or("", String::as_str);
            let reason = format!("section {name:?}: the CRC-32 of a block does not match");
            return Err(IoError::damaged(path, reason));
        }
    }
    Ok(())
}

impl ArraySource for DividedCheckpoint {
    fn outline(&self) -> Vec<ArrayOutline> {
        let of = |name: &String, kind: Kind, len: u64| {
            // Archives have no 32-bit integers: they are found missing.
            let empty = Values::try_from(Section::empty(kind)).ok()?;
            Some(ArrayOutline {
                name: name.clone(),
                empty,
                len: len as usize,
            })
        };
        match &self.content {
            Content::Blocks(_, head) => {
                let sections = head.sections.iter();
                sections
                    .filter_map(|one| of(&one.name, one.kind, one.len))
                    .collect()
            }
            Content::None => Vec::new(),
        }
    }

    fn is_shared(&self) -> bool {
        self.is_shared
    }

    fn block(&self, like: &Values) -> usize {
        entries(Kind::of(like))
    }

    fn entries(&mut self, name: &str, range: Range<usize>) -> Result<Values, PericlesError> {
        let bad = |reason: String| PericlesError::BadArchive { reason };
        let missing = || bad(format!("the array {name:?} cannot be read"));
        let section = match &mut self.content {
            Content::Blocks(file, head) => {
                let placed = head.sections.iter().find(|placed| placed.name == name);
                let placed = placed.ok_or_else(missing)?;
                let range = range.start as u64..range.end as u64;
                read_section(&self.path, file, head, placed, range, &mut self.coder)
                    .map_err(|error| bad(error.to_string()))?
            }
            Content::None => return Err(missing()),
        };
        Values::try_from(section).map_err(|_| missing())
    }
}

/// Returns the result of this process, or an error if another process has failed.
pub(super) fn agreed<T>(
    comm: &dyn Comm,
    path: &Path,
    result: Result<T, IoError>,
) -> Result<T, IoError> {
    domain::agreed(comm, result, || IoError::OnAnotherProcess {
        path: path.into(),
    })
}

#[cfg(test)]
mod tests;
