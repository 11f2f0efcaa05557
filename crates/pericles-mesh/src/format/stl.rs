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
    // Some binary files also begin with "solid", but soon contain bytes that do not occur in text.
    let begin = &content[..content.len().min(GLANCE)];
    let is_text = begin.iter().all(|byte| byte.is_ascii() && *byte != 0);
    if content.starts_with(b"solid") && is_text {
        text(content)
    } else {
        binary(content)
    }
}

fn text(content: &[u8]) -> Result<RawMesh, Fault> {
    let mut words = Words::new(content, None);
    let mut mesh = RawMesh::default();
    let mut corners = Vec::new();
    words.next();
    // The name of the solid, which may contain any words.
    words.skip_line();
    let mut ended = false;
    while let Some(word) = words.next() {
        match word {
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
