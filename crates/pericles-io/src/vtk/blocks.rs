//! Appended array: a table of sizes, followed by zlib-compressed blocks.
//!
//! ```text
//! [number of blocks] [bytes in a block] [bytes in the last one, 0 if it is full] [compressed bytes of every block …]  data …
//! ```
//! All numbers are u64. The table precedes the blocks but is known only after them: space is reserved and
//! filled in afterwards, so that only one block is in memory.

use std::io::{self, Seek, SeekFrom, Write};

use flate2::{Compress, Compression, FlushCompress, Status};

/// VTK's own block size; it is a multiple of every element size, so that no element spans two blocks.
pub(super) const BLOCK: usize = 32768;

/// The fastest compression level: positions and displacements compress little at any level.
const LEVEL: Compression = Compression::fast();

/// Writes `count` elements of `W` bytes, `element(i)` being the i-th, at the current position of `out`.
pub(super) fn write_array<const W: usize>(
    out: &mut (impl Write + Seek),
    count: usize,
    mut element: impl FnMut(usize) -> [u8; W],
) -> io::Result<()> {
    let length = count * W;
    let blocks = length.div_ceil(BLOCK);
    let mut table = vec![0_u64; 3 + blocks];
    table[0] = blocks as u64;
    table[1] = BLOCK as u64;
    table[2] = (length % BLOCK) as u64;
    let start = out.stream_position()?;
    write_table(out, &table)?;

    let per_block = BLOCK / W;
    let mut plain = Vec::with_capacity(BLOCK);
    let mut packed = Vec::with_capacity(BLOCK + BLOCK / 8);
    let mut zlib = Compress::new(LEVEL, true);
    for (block, size) in table[3..].iter_mut().enumerate() {
        plain.clear();
        for i in block * per_block..count.min((block + 1) * per_block) {
            plain.extend_from_slice(&element(i));
        }
        compress(&mut zlib, &plain, &mut packed)?;
        out.write_all(&packed)?;
        *size = packed.len() as u64;
    }

    let end = out.stream_position()?;
    out.seek(SeekFrom::Start(start))?;
    write_table(out, &table)?;
    out.seek(SeekFrom::Start(end))?;
    Ok(())
}

fn compress(zlib: &mut Compress, plain: &[u8], packed: &mut Vec<u8>) -> io::Result<()> {
    zlib.reset();
    packed.clear();
    loop {
        let done = zlib.total_in() as usize;
        let status = zlib
            .compress_vec(&plain[done..], packed, FlushCompress::Finish)
            .map_err(io::Error::other)?;
        if status == Status::StreamEnd {
            return Ok(());
        }
        packed.reserve(BLOCK);
    }
}

fn write_table(out: &mut impl Write, table: &[u64]) -> io::Result<()> {
    for number in table {
        out.write_all(&number.to_le_bytes())?;
    }
    Ok(())
}
