//! Writing of pages.

use std::io::{self, Write};

use crate::xml::escaped;

use super::block::Block;

const STYLE: [&str; 2] = [
    include_str!("assets/uplot.css"),
    include_str!("assets/viewer.css"),
];
const CONTENT: &str = include_str!("assets/viewer.html");
const SCRIPTS: [&str; 7] = [
    include_str!("assets/uplot.js"),
    include_str!("assets/blocks.js"),
    include_str!("assets/shape.js"),
    include_str!("assets/camera.js"),
    include_str!("assets/scene.js"),
    include_str!("assets/charts.js"),
    include_str!("assets/main.js"),
];

/// Writes a page: [`begin`](PageWriter::begin), blocks in any number, [`finish`](PageWriter::finish).
pub struct PageWriter<'w> {
    out: &'w mut dyn Write,
    blocks: u32,
    bytes: u64,
}

impl<'w> PageWriter<'w> {
    /// Begins a page with a title.
    ///
    /// # Errors
    /// The page cannot be written.
    pub fn begin(out: &'w mut dyn Write, title: &str) -> io::Result<Self> {
        let mut page = Self {
            out,
            blocks: 0,
            bytes: 0,
        };
        let title = escaped(title);
        page.text(&format!(
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n<style>\n"
        ))?;
        for style in STYLE {
            page.text(style)?;
        }
        page.text("</style>\n")?;
        page.text(CONTENT)?;
        Ok(page)
    }

    /// Adds a block and returns its number.
    ///
    /// # Errors
    /// The page cannot be written.
    pub fn block(&mut self, block: &Block) -> io::Result<u32> {
        let number = self.blocks;
        self.text(&format!("<script type=\"text/plain\" id=\"b{number}\">"))?;
        self.text(block.text())?;
        self.text("</script>\n")?;
        self.blocks += 1;
        Ok(number)
    }

    /// Completes the page with its header in JSON and returns its size in bytes.
    ///
    /// # Errors
    /// The page cannot be written.
    pub fn finish(mut self, header: &str) -> io::Result<u64> {
        self.text("<script type=\"application/json\" id=\"header\">")?;
        // In JSON, `<` occurs within strings only; a string must not end the element.
        self.text(&header.replace('<', "\\u003c"))?;
        self.text("</script>\n<script>\n")?;
        for script in SCRIPTS {
            self.text(script)?;
            self.text("\n")?;
        }
        self.text("</script>\n</html>\n")?;
        Ok(self.bytes)
    }

    fn text(&mut self, text: &str) -> io::Result<()> {
        self.bytes += text.len() as u64;
        self.out.write_all(text.as_bytes())
    }
}
