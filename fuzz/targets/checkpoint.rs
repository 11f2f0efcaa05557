#![no_main]
//! Checkpoints: the bytes as they are; and, as random bytes hardly ever have the right checksums, the same as a header and the arrays behind it, with checksums put in, for both versions of the format.

use pericles_io::Container;

/// Magic, version, length and CRC-32 of the header.
const PREFIX: usize = 24;

pericles_fuzz::target!(|content: &[u8]| {
    for content in [content.to_vec(), sealed(content), in_blocks(content)] {
        if let Ok(container) = Container::parse("a.chk", &content, pericles_fuzz::MEMORY) {
            let _ = container.into_archive();
        }
    }
});

/// The first line is the header, the rest the stored arrays; the checksums written in the header as `"crc32":0` belong to the arrays in their order.
fn sealed(content: &[u8]) -> Vec<u8> {
    let mut parts = content.splitn(2, |&byte| byte == b'\n');
    let header = parts.next().unwrap_or_default();
    let mut rest = parts.next().unwrap_or_default();
    let body = rest;
    let mut text = String::from_utf8_lossy(header).into_owned();
    let lengths: Vec<usize> = text
        .split("\"stored\":")
        .skip(1)
        .map(|part| {
            let digits = part.split(|c: char| !c.is_ascii_digit()).next();
            digits.and_then(|digits| digits.parse().ok()).unwrap_or(0)
        })
        .collect();
    for length in lengths {
        let (array, more) = rest.split_at(length.min(rest.len()));
        rest = more;
        let crc = crc32fast::hash(array);
        text = text.replacen("\"crc32\":0", &format!("\"crc32\":{crc}"), 1);
    }
    let mut file = opening(1, text.as_bytes());
    file.extend(body);
    file
}

/// Version 2: the first line is the header, the second one the lengths of the blocks, the rest the blocks.
fn in_blocks(content: &[u8]) -> Vec<u8> {
    let mut parts = content.splitn(3, |&byte| byte == b'\n');
    let mut file = opening(2, parts.next().unwrap_or_default());
    let lengths = String::from_utf8_lossy(parts.next().unwrap_or_default()).into_owned();
    let blocks = parts.next().unwrap_or_default();
    let mut rest = blocks;
    let mut table = Vec::new();
    for length in lengths
        .split(' ')
        .filter_map(|length| length.parse::<u32>().ok())
    {
        let (block, more) = rest.split_at((length as usize).min(rest.len()));
        rest = more;
        table.extend(length.to_le_bytes());
        table.extend(crc32fast::hash(block).to_le_bytes());
    }
    let crc = crc32fast::hash(&table);
    file.extend(table);
    file.extend(crc.to_le_bytes());
    file.extend(blocks);
    file
}

/// Magic, version, length, CRC-32 and header.
fn opening(version: u32, header: &[u8]) -> Vec<u8> {
    let mut file = b"PERICLES".to_vec();
    file.extend(version.to_le_bytes());
    file.extend((header.len() as u64).to_le_bytes());
    let crc = crc32fast::hash(&[&file[8..], header].concat());
    file.extend(crc.to_le_bytes());
    assert_eq!(file.len(), PREFIX);
    file.extend(header);
    file
}
