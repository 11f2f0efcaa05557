#![no_main]
//! Listed points: the first byte is the dimension, the rest the file.

pericles_fuzz::target!(|content: &[u8]| {
    let Some((first, content)) = content.split_first() else {
        return;
    };
    let dimension = usize::from(first % 3) + 1;
    if let Ok(points) = pericles_io::parse_points("a.txt", content, dimension) {
        let _ = points.cloud(dimension, 1.0);
    }
});
