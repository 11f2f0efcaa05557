//! Wavefront OBJ: lines `v x y z` and `f a b c …`, where a corner is `vertex`, `vertex/texture` or
//! `vertex/texture/normal`. Everything else is ignored.

use crate::fault::Fault;
use crate::raw::RawMesh;
use crate::scan::Words;
use crate::scan::vertex_number;

pub(crate) fn parse(content: &[u8]) -> Result<RawMesh, Fault> {
    let mut mesh = RawMesh::default();
    let mut words = Words::new(content, Some(b'#'));
    while let Some(key) = words.next() {
        match key {
            "v" => mesh.nodes.push(words.point()?),
            "f" => {
                let line = words.line();
                let corners = words
                    .rest_of_line()
                    .take_while(|word| !word.starts_with('#'))
                    .map(|word| corner(word, mesh.nodes.len(), line))
                    .collect::<Result<Vec<u32>, Fault>>()?;
                if corners.len() < 3 {
                    let reason = format!(
                        "the face has {} corner(s); at least 3 are required",
                        corners.len()
                    );
                    return Err(Fault::at_line(line, reason));
                }
                mesh.polygon(&corners);
                continue;
            }
            _ => {}
        }
        words.skip_line();
    }
    Ok(mesh)
}

/// Parses a corner: vertices are numbered from 1; negative numbers count back from the last vertex defined so
/// far.
fn corner(word: &str, vertices: usize, line: usize) -> Result<u32, Fault> {
    let number: Option<i64> = word
        .split('/')
        .next()
        .and_then(|vertex| vertex.parse().ok());
    number
        .and_then(|number| match number {
            0 => None,
            1.. => vertex_number(number - 1),
            _ => vertex_number(number.checked_add(vertices as i64)?),
        })
        .ok_or_else(|| {
            Fault::at_line(
                line,
                format!("{word:?} is not a valid corner; allowed: vertex numbers from 1, or relative ones from -1 to -{vertices}"),
            )
        })
}
