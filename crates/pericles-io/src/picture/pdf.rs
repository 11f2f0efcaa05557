//! PDF output: shapes are vectors, text is text in the embedded font, the cells of a body become an image.

use std::collections::BTreeMap;
use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{
    CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap,
};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str};

use super::bitmap::Rgb;
use super::drawing::{Drawing, Shape, Spot};
use super::raster::Raster;
use super::text::{self, Direction, Style};

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
const FONT: Ref = Ref::new(5);
const CID_FONT: Ref = Ref::new(6);
const DESCRIPTOR: Ref = Ref::new(7);
const FONT_FILE: Ref = Ref::new(8);
const CHARACTERS: Ref = Ref::new(9);
/// Number of the first further object.
const FURTHER: i32 = 10;

const FONT_NAME: Name<'static> = Name(b"DejaVuSans");
const SYSTEM: SystemInfo<'static> = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};

/// Ratio of the handles of a cubic curve to the radius of the quarter circle that it approximates.
const QUARTER: f32 = 0.552_284_8;

/// Returns the complete PDF file.
///
/// # Errors
/// An image or the font cannot be compressed.
pub(super) fn document(drawing: &Drawing) -> io::Result<Vec<u8>> {
    let pixel = drawing.pixel();
    let size = [drawing.width(), drawing.height()].map(|pixels| (pixels as f64 * pixel) as f32);
    let mut page = Page {
        content: Content::new(),
        images: Vec::new(),
        covers: Vec::new(),
        glyphs: BTreeMap::new(),
    };
    // Coordinates are pixels from the upper left corner, as in drawings.
    let pixel = pixel as f32;
    page.content
        .transform([pixel, 0.0, 0.0, -pixel, 0.0, size[1]]);
    if !drawing.is_transparent() {
        page.fill([255; 3]);
        let (width, height) = (drawing.width() as f32, drawing.height() as f32);
        page.content.rect(0.0, 0.0, width, height).fill_nonzero();
    }
    for shape in drawing.shapes() {
        page.shape(shape, drawing.is_transparent());
    }
    page.written(size)
}

/// The content of the page written so far.
struct Page {
    content: Content,
    /// Images with their sizes in pixels.
    images: Vec<Image>,
    /// Opacities in percent.
    covers: Vec<u8>,
    /// Characters by the number of their glyph.
    glyphs: BTreeMap<u16, char>,
}

struct Image {
    size: (usize, usize),
    rgb: Vec<u8>,
    /// Opacity of the pixels; none if all are opaque.
    alpha: Option<Vec<u8>>,
}

impl Page {
    fn fill(&mut self, colour: Rgb) {
        let [r, g, b] = colour.map(|part| f32::from(part) / 255.0);
        self.content.set_fill_rgb(r, g, b);
    }

    fn shape(&mut self, shape: &Shape, is_transparent: bool) {
        match shape {
            Shape::Rectangle {
                from,
                to,
                colour,
                cover,
            } => self.rectangle(*from, *to, *colour, *cover),
            Shape::Strokes { lines, pen } => {
                let [r, g, b] = pen.colour.map(|part| f32::from(part) / 255.0);
                self.content.save_state();
                self.content.set_stroke_rgb(r, g, b);
                self.content.set_line_width(pen.width as f32);
                self.content.set_line_cap(LineCapStyle::RoundCap);
                self.content.set_line_join(LineJoinStyle::RoundJoin);
                if let Some(dash) = pen.dash {
                    let dash = dash.map(|length| length as f32);
                    self.content.set_dash_pattern(dash, 0.0);
                }
                for line in lines {
                    self.path(line);
                    if let [(x, y)] = line[..] {
                        // A dot.
                        self.content.line_to(x as f32, y as f32);
                    }
                }
                self.content.stroke();
                self.content.restore_state();
            }
            Shape::Disc {
                middle,
                radius,
                colour,
            } => self.disc(*middle, *radius as f32, *colour),
            Shape::Polygon { corners, colour } => {
                self.fill(*colour);
                self.path(corners);
                self.content.close_path().fill_nonzero();
            }
            Shape::Text { text, place, style } => self.text(text, *place, style),
            Shape::Cells { cells, left, top } => self.image(cells, [*left, *top], is_transparent),
        }
    }

    fn path(&mut self, line: &[Spot]) {
        for (k, &(x, y)) in line.iter().enumerate() {
            match k {
                0 => self.content.move_to(x as f32, y as f32),
                _ => self.content.line_to(x as f32, y as f32),
            };
        }
    }

    fn rectangle(&mut self, from: Spot, to: Spot, colour: Rgb, cover: f64) {
        let (left, top) = (from.0.round(), from.1.round());
        let (width, height) = (to.0.round() - left, to.1.round() - top);
        if width <= 0.0 || height <= 0.0 {
            return;
        }
        self.content.save_state();
        if cover < 1.0 {
            let percent = (100.0 * cover).round() as u8;
            if !self.covers.contains(&percent) {
                self.covers.push(percent);
            }
            self.content
                .set_parameters(Name(format!("G{percent}").as_bytes()));
        }
        self.fill(colour);
        self.content
            .rect(left as f32, top as f32, width as f32, height as f32)
            .fill_nonzero();
        self.content.restore_state();
    }

    fn disc(&mut self, (x, y): Spot, r: f32, colour: Rgb) {
        let (x, y, h) = (x as f32, y as f32, QUARTER * r);
        self.fill(colour);
        self.content
            .move_to(x + r, y)
            .cubic_to(x + r, y + h, x + h, y + r, x, y + r)
            .cubic_to(x - h, y + r, x - r, y + h, x - r, y)
            .cubic_to(x - r, y - h, x - h, y - r, x, y - r)
            .cubic_to(x + h, y - r, x + r, y - h, x + r, y)
            .fill_nonzero();
    }

    fn text(&mut self, text: &str, (x, y): Spot, style: &Style) {
        let (glyphs, length) = text::glyphs(text, style.size);
        let back = style.align.share() * length;
        let below = text::HALF_CAPITAL * style.size;
        // The page is upside down: text is turned back.
        let matrix = match style.direction {
            Direction::Right => [1.0, 0.0, 0.0, -1.0, x - back, y + below],
            Direction::Up => [0.0, -1.0, -1.0, 0.0, x + below, y + back],
        };
        self.fill(style.colour);
        self.content.begin_text();
        self.content.set_font(FONT_NAME, style.size as f32);
        self.content.set_text_matrix(matrix.map(|part| part as f32));
        let mut shown = self.content.show_positioned();
        let mut items = shown.items();
        let mut at = 0.0;
        for ((glyph, place), character) in glyphs.into_iter().zip(text.chars()) {
            // Kerning, in thousandths of the size.
            let shift = 1e3 * (place - at) / style.size;
            if shift.abs() > 0.5 {
                items.adjust(-shift.round() as f32);
            }
            items.show(Str(&glyph.to_be_bytes()));
            at = place + text::advance(glyph) * style.size;
            self.glyphs.entry(glyph).or_insert(character);
        }
        items.finish();
        shown.finish();
        self.content.end_text();
    }

    fn image(&mut self, cells: &Raster, [left, top]: [usize; 2], is_transparent: bool) {
        let (width, height) = cells.size();
        let bitmap = cells.bitmap(is_transparent);
        let name = format!("I{}", self.images.len());
        self.images.push(Image {
            size: (width, height),
            rgb: bitmap.rgb(),
            alpha: is_transparent.then(|| bitmap.alpha()),
        });
        let (width, height) = (width as f32, height as f32);
        self.content.save_state();
        self.content
            .transform([width, 0.0, 0.0, -height, left as f32, top as f32 + height]);
        self.content.x_object(Name(name.as_bytes()));
        self.content.restore_state();
    }

    /// Returns the file with this page of a size in points.
    fn written(self, [width, height]: [f32; 2]) -> io::Result<Vec<u8>> {
        let mut pdf = Pdf::new();
        pdf.catalog(CATALOG).pages(PAGES);
        pdf.pages(PAGES).kids([PAGE]).count(1);
        let mut next = FURTHER;
        let mut number = || {
            next += 1;
            Ref::new(next - 1)
        };
        let images: Vec<(Ref, Option<Ref>)> = (self.images.iter())
            .map(|image| (number(), image.alpha.is_some().then(&mut number)))
            .collect();
        let covers: Vec<Ref> = self.covers.iter().map(|_| number()).collect();
        let mut page = pdf.page(PAGE);
        page.media_box(Rect::new(0.0, 0.0, width, height));
        page.parent(PAGES).contents(CONTENT);
        let mut resources = page.resources();
        resources.fonts().pair(FONT_NAME, FONT);
        let mut objects = resources.x_objects();
        for (k, (image, _)) in images.iter().enumerate() {
            objects.pair(Name(format!("I{k}").as_bytes()), *image);
        }
        objects.finish();
        let mut states = resources.ext_g_states();
        for (percent, state) in self.covers.iter().zip(&covers) {
            states.pair(Name(format!("G{percent}").as_bytes()), *state);
        }
        states.finish();
        resources.finish();
        page.finish();
        for (percent, state) in self.covers.iter().zip(&covers) {
            let cover = f32::from(*percent) / 100.0;
            pdf.ext_graphics(*state).non_stroking_alpha(cover);
        }
        for (image, (object, mask)) in self.images.iter().zip(images) {
            write_image(&mut pdf, image, object, mask)?;
        }
        write_font(&mut pdf, &self.glyphs)?;
        let content = compressed(&self.content.finish())?;
        pdf.stream(CONTENT, &content).filter(Filter::FlateDecode);
        Ok(pdf.finish())
    }
}

fn compressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes)?;
    encoder.finish()
}

fn write_image(pdf: &mut Pdf, image: &Image, object: Ref, mask: Option<Ref>) -> io::Result<()> {
    let (width, height) = (image.size.0 as i32, image.size.1 as i32);
    let rgb = compressed(&image.rgb)?;
    let mut written = pdf.image_xobject(object, &rgb);
    written.filter(Filter::FlateDecode);
    written.width(width).height(height).bits_per_component(8);
    written.color_space().device_rgb();
    if let Some(mask) = mask {
        written.s_mask(mask);
    }
    written.finish();
    if let (Some(mask), Some(alpha)) = (mask, &image.alpha) {
        let alpha = compressed(alpha)?;
        let mut written = pdf.image_xobject(mask, &alpha);
        written.filter(Filter::FlateDecode);
        written.width(width).height(height).bits_per_component(8);
        written.color_space().device_gray();
    }
    Ok(())
}

/// Embeds the font; texts refer to its glyphs by number.
fn write_font(pdf: &mut Pdf, glyphs: &BTreeMap<u16, char>) -> io::Result<()> {
    let mut font = pdf.type0_font(FONT);
    font.base_font(FONT_NAME)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(CID_FONT)
        .to_unicode(CHARACTERS);
    font.finish();
    let mut descendant = pdf.cid_font(CID_FONT);
    descendant
        .subtype(CidFontType::Type2)
        .base_font(FONT_NAME)
        .system_info(SYSTEM)
        .font_descriptor(DESCRIPTOR)
        .default_width(0.0)
        .cid_to_gid_map_predefined(Name(b"Identity"));
    let mut widths = descendant.widths();
    for &glyph in glyphs.keys() {
        widths.consecutive(glyph, [(1e3 * text::advance(glyph)) as f32]);
    }
    widths.finish();
    descendant.finish();
    let [ascent, descent] = text::metrics();
    pdf.font_descriptor(DESCRIPTOR)
        .name(FONT_NAME)
        .flags(FontFlags::SYMBOLIC)
        .bbox(Rect::new(-1021.0, -463.0, 1793.0, 1232.0))
        .italic_angle(0.0)
        .ascent(1e3 * ascent)
        .descent(1e3 * descent)
        .cap_height((2e3 * text::HALF_CAPITAL) as f32)
        .stem_v(80.0)
        .font_file2(FONT_FILE);
    let file = text::FONT_FILE;
    let shrunk = compressed(file)?;
    let mut stream = pdf.stream(FONT_FILE, &shrunk);
    stream.filter(Filter::FlateDecode);
    stream.pair(Name(b"Length1"), file.len() as i32);
    stream.finish();
    let mut characters = UnicodeCmap::new(Name(b"Characters"), SYSTEM);
    for (&glyph, &character) in glyphs {
        characters.pair(glyph, character);
    }
    let characters = characters.finish();
    pdf.cmap(CHARACTERS, &characters);
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;
    use crate::picture::bitmap::Pen;
    use crate::picture::style::{PictureStyle, Print};
    use crate::picture::text::Align;

    /// Returns the decompressed streams of a file.
    fn streams(file: &[u8]) -> Vec<Vec<u8>> {
        let find = |from: usize, word: &[u8]| {
            let mut windows = file[from..].windows(word.len());
            windows
                .position(|window| window == word)
                .map(|at| from + at)
        };
        let (mut found, mut at) = (Vec::new(), 0);
        while let Some(start) = find(at, b"stream\n") {
            let start = start + b"stream\n".len();
            let end = find(start, b"\nendstream").unwrap();
            let mut stream = Vec::new();
            let mut decoder = flate2::read::ZlibDecoder::new(&file[start..end]);
            if decoder.read_to_end(&mut stream).is_ok() {
                found.push(stream);
            }
            at = end + b"\nendstream".len();
        }
        found
    }

    #[test]
    fn shapes_are_vectors_and_text_has_its_size_in_points() {
        let print = Print {
            font_size: 8.0,
            dpi: 600.0,
        };
        let mut drawing = Drawing::new(&PictureStyle::printed(88e-3, print), 1000);
        drawing.fill_rectangle((1.0, 2.0), (10.0, 20.0), [255, 0, 0], 0.85);
        drawing.stroke(
            vec![vec![(0.0, 0.0), (50.0, 60.0)]],
            Pen {
                width: 4.0,
                colour: [0, 0, 0],
                dash: Some([16.0, 14.0]),
            },
        );
        let size = print.pixels(8.0);
        drawing.text("µ (mm)", (100.0, 50.0), Style::new(size, Align::Middle));
        drawing.text("up", (100.0, 50.0), Style::new(size, Align::Start).up());
        drawing.cells(Raster::new(30, 20, 2), 5, 6);
        let file = document(&drawing).unwrap();
        assert!(file.starts_with(b"%PDF-1.7"));
        let plain = String::from_utf8_lossy(&file);
        // 2079 pixels at 600 pixels per inch, and 1000 pixels.
        assert!(plain.contains("/MediaBox [0 0 249.48 120]"), "{plain}");
        assert!(plain.contains("/BaseFont /DejaVuSans"));
        let content = streams(&file);
        let content = content.iter().map(|stream| String::from_utf8_lossy(stream));
        let content: Vec<_> = content.filter(|stream| stream.contains(" Tf")).collect();
        let [content] = &content[..] else {
            panic!("{content:?}")
        };
        for part in [
            "0.12 0 0 -0.12 0 120 cm",
            "/G85 gs",
            "[16 14] 0 d",
            "/I0 Do",
            "/DejaVuSans 66.6",
        ] {
            assert!(content.contains(part), "{part}: {content}");
        }
        // The same drawing gives the same bytes.
        assert_eq!(document(&drawing).unwrap(), file);
    }
}
