//! A stand-alone page that shows the fields of a run in a browser.
//!
//! A page is one HTML file without references to other files: style, scripts, a header (JSON) and blocks of numbers. A
//! block is a little-endian array of unsigned integers or floating-point numbers, compressed with zlib and encoded in
//! base64; the browser decompresses a block when it is shown. [`PageWriter`] writes pages, [`Block`] encodes arrays and
//! [`Quantised`] rounds the values of a field to 16 bits.
//!
//! The scripts are in `assets/`: `blocks.js` decodes blocks and fields, `shape.js` computes the displaced cells in the
//! same way as pictures do, `camera.js` and `scene.js` draw with WebGL 2, `charts.js` draws time histories with uPlot, `main.js`
//! connects the controls. The module `contents` of `pericles-run` describes the header.

mod block;
mod page;

pub use block::{Block, Quantised};
pub use page::PageWriter;
