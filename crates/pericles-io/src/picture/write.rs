//! Writing of drawings to files.

use std::io::Write;
use std::path::Path;

use super::drawing::Drawing;
use super::{pdf, svg};
use crate::{IoError, write_atomically};

/// Writes a drawing atomically: as SVG or PDF if the file name ends in `.svg` or `.pdf`, otherwise as PNG.
pub(super) fn write(drawing: &Drawing, path: &Path) -> Result<(), IoError> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    let document = match ending {
        Some("svg") => svg::document(drawing).map(String::into_bytes),
        Some("pdf") => pdf::document(drawing),
        _ => return drawing.to_bitmap().write_png(path),
    };
    let bytes = document.map_err(|error| IoError::writing(path, error))?;
    write_atomically(path, |out| out.write_all(&bytes))
}
