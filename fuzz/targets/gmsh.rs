#![no_main]
//! Surfaces and meshes from `.msh` files.

pericles_fuzz::target!(|content: &[u8]| {
    pericles_fuzz::surface("a.msh", content);
    pericles_fuzz::mesh("a.msh", content);
});
