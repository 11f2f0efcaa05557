//! OFF: the word OFF, the numbers of vertices, faces and edges, the coordinates, and for each face its number
//! of corners and the corners, from 0.

use crate::fault::Fault;
use crate::raw::RawMesh;
use crate::scan::Words;

pub(crate) fn parse(content: &[u8]) -> Result<RawMesh, Fault> {
    let mut words = Words::new(content, Some(b'#'));
    let head = words.word("the word OFF")?;
    // Colours, normals and textures follow the coordinates of a vertex on the same line.
    if !matches!(head, "OFF" | "COFF" | "NOFF" | "CNOFF" | "STOFF") {
        return Err(words.fault(format!("the file begins with {head:?}, not with OFF")));
    }
    let vertices = words.count("vertices", 3)?;
    let faces = words.count("faces", 4)?;
    let _edges: u64 = words.number("a number of edges")?;
    let mut mesh = RawMesh::default();
    mesh.nodes.reserve(vertices);
    for _ in 0..vertices {
        mesh.nodes.push(words.point()?);
        words.skip_line();
    }
    for _ in 0..faces {
        let corners = words.count("corners", 1)?;
        if corners < 3 {
            return Err(words.fault(format!(
                "the face has {corners} corner(s); at least 3 are required"
            )));
        }
        let corners = (0..corners)
            .map(|_| words.number("a vertex number"))
            .collect::<Result<Vec<u32>, Fault>>()?;
        mesh.polygon(&corners);
        words.skip_line();
    }
    Ok(mesh)
}
