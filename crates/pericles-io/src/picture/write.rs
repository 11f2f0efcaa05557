//! Writing of drawings to files.

use std::io::Write;
use std::path::Path;

use super::drawing::Drawing;
use super::svg;
use crate::{IoError, write_atomically};

/// Writes a drawing atomically: as SVG if the file name ends in `.svg`, otherwise as PNG.
pub(super) fn write(drawing: &Drawing, path: &Path) -> Result<(), IoError> {
    if path.extension().is_some_and(|ending| ending == "svg") {
        let text = svg::document(drawing).map_err(|error| IoError::writing(path, error))?;
        return write_atomically(path, |out| out.write_all(text.as_bytes()));
    }
    drawing.to_bitmap().write_png(path)
}
