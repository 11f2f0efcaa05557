#![no_main]
//! Surfaces, meshes and fields from `.vtu` files.

pericles_fuzz::target!(|content: &[u8]| {
    pericles_fuzz::surface("a.vtu", content);
    pericles_fuzz::mesh("a.vtu", content);
    let _ = pericles_io::parse_fields("a.vtu", content, pericles_fuzz::MEMORY);
});
