#![no_main]
//! Outlines from text: one that can be read is filled with whole and with partial cells.

use pericles_mesh::fill::Outline;

pericles_fuzz::target!(|content: &[u8]| {
    let Ok(polygons) = pericles_io::parse_outline("a.txt", content) else {
        return;
    };
    if let Ok(outline) = Outline::new(polygons) {
        let [low, high] = outline.bounds();
        // Some cells in each direction, whatever the unit is.
        let spacing = [0, 1].map(|c| ((high[c] - low[c]) / 7.0).max(f64::MIN_POSITIVE));
        let _ = outline.fill(spacing);
        let _ = outline.fill_partially(spacing);
    }
});
