//! STL: triangles with the coordinates of their corners, as text (`solid … facet … vertex x y z`) or binary
//! (80 bytes, a count, 50 bytes each).

use crate::fault::Fault;
use crate::raw::RawMesh;
use crate::scan::Words;
use crate::scan::{Bytes, Scalar};

/// Bytes before the count, and bytes of a triangle: normal, three corners, two bytes.
const HEADER: usize = 80;
const TRIANGLE: usize = 50;

/// Number of bytes examined to recognise text.
const GLANCE: usize = 1024;

pub(crate) fn parse(content: &[u8]) -> Result<RawMesh, Fault> {
    match is_text(content) {
        true => text(content),
        false => binary(content),
    }
}

/// Returns whether a file is text: it begins with the word solid in any case, after blanks or a byte order mark. Some
/// binary files do so as well, but have the size that their count demands, or bytes that do not occur in text.
fn is_text(content: &[u8]) -> bool {
    let start = content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content);
    let start = start.trim_ascii_start();
    let word = start.get(..5).unwrap_or_default();
    if !word.eq_ignore_ascii_case(b"solid") {
        return false;
    }
    let counted = content.get(HEADER..HEADER + 4).map(|count| {
        let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]);
        HEADER as u64 + 4 + TRIANGLE as u64 * u64::from(count)
    });
    let begin = &content[..content.len().min(GLANCE)];
    counted != Some(content.len() as u64) && !begin.contains(&0)
}

fn text(content: &[u8]) -> Result<RawMesh, Fault> {
    let content = content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content);
    let mut words = Words::new(content, None);
    let mut mesh = RawMesh::default();
    let mut corners = Vec::new();
    words.next();
    // The name of the solid, which may contain any words.
    words.skip_line();
    let mut ended = false;
    while let Some(word) = words.next() {
        match word.to_ascii_lowercase().as_str() {
            "vertex" => {
                corners.push(mesh.nodes.len() as u32);
                mesh.nodes.push(words.point()?);
            }
            "endfacet" => {
                if corners.len() != 3 {
                    return Err(words.fault(format!(
                        "the facet has {} vertices; it must have 3",
                        corners.len()
                    )));
                }
                mesh.polygon(&corners);
                corners.clear();
            }
            "solid" => {
                words.skip_line();
                ended = false;
            }
            "endsolid" => {
                words.skip_line();
                ended = true;
            }
            _ => {}
        }
    }
    if !ended || !corners.is_empty() {
        return Err(words.fault("unexpected end of file; expected endsolid"));
    }
    Ok(mesh)
}

fn binary(content: &[u8]) -> Result<RawMesh, Fault> {
    let mut bytes = Bytes::new(content, 0, true);
    bytes.take(HEADER)?;
    let count = bytes.integer(Scalar::U32)? as u64;
    let count = bytes.room(count, TRIANGLE, "triangles")?;
    let mut mesh = RawMesh::default();
    for triangle in 0..count as u32 {
        bytes.take(12)?;
        for _ in 0..3 {
            let mut corner = [0.0; 3];
            for x in &mut corner {
                *x = bytes.real(Scalar::F32)?;
            }
            mesh.nodes.push(corner);
        }
        bytes.take(2)?;
        let first = triangle
            .checked_mul(3)
            .ok_or_else(|| bytes.fault("too many triangles; allowed: at most 1431655765"))?;
        mesh.polygon(&[first, first + 1, first + 2]);
    }
    Ok(mesh)
}
