//! SVG output: shapes and text stay vectors, the cells of a body become an image.

use std::fmt::Write as _;
use std::io;

use base64::prelude::{BASE64_STANDARD, Engine as _};

use super::bitmap::Rgb;
use super::drawing::{Drawing, Shape, Spot};
use super::raster::Raster;
use super::text::{self, Align, Direction, Style};
use crate::xml::escaped;

/// Fonts with the characters of pictures; the first one is used in PNG files.
const FONTS: &str = "DejaVu Sans, Verdana, sans-serif";

/// Returns the complete SVG file.
///
/// # Errors
/// Returns an error if an image cannot be encoded.
pub(super) fn document(drawing: &Drawing) -> io::Result<String> {
    let (width, height) = (drawing.width(), drawing.height());
    let size = |pixels: usize| match drawing.dpi() {
        Some(dpi) => format!("{:.2}mm", pixels as f64 / dpi * 25.4),
        None => pixels.to_string(),
    };
    let mut page = Page(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\">\n",
        size(width),
        size(height)
    ));
    if !drawing.is_transparent() {
        page.line(format_args!(
            "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>"
        ));
    }
    for shape in drawing.shapes() {
        page.shape(shape, drawing.is_transparent())?;
    }
    page.0 += "</svg>\n";
    Ok(page.0)
}

/// The text written so far.
struct Page(String);

impl Page {
    fn line(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing into a String cannot fail.
        let _ = writeln!(self.0, "{line}");
    }

    fn shape(&mut self, shape: &Shape, is_transparent: bool) -> io::Result<()> {
        match shape {
            Shape::Rectangle {
                from,
                to,
                colour,
                cover,
            } => self.rectangle(*from, *to, *colour, *cover),
            Shape::Strokes { lines, pen } => {
                let dash = pen.dash.map_or(String::new(), |[dash, gap]| {
                    format!(" stroke-dasharray=\"{},{}\"", short(dash), short(gap))
                });
                let path: String = lines.iter().map(|line| course(line)).collect();
                self.line(format_args!(
                    "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" stroke-linejoin=\"round\"{dash}/>",
                    hex(pen.colour),
                    short(pen.width)
                ));
            }
            Shape::Disc {
                middle: (x, y),
                radius,
                colour,
            } => self.line(format_args!(
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"/>",
                short(*x),
                short(*y),
                short(*radius),
                hex(*colour)
            )),
            Shape::Polygon { corners, colour } => {
                let corners: Vec<String> = corners.iter().map(|&corner| spot(corner)).collect();
                self.line(format_args!(
                    "<polygon points=\"{}\" fill=\"{}\"/>",
                    corners.join(" "),
                    hex(*colour)
                ));
            }
            Shape::Text { text, place, style } => self.text(text, *place, style),
            Shape::Cells { cells, left, top } => {
                self.image(cells, [*left, *top], is_transparent)?;
            }
        }
        Ok(())
    }

    fn rectangle(&mut self, from: Spot, to: Spot, colour: Rgb, cover: f64) {
        let (left, top) = (from.0.round(), from.1.round());
        let (width, height) = (to.0.round() - left, to.1.round() - top);
        if width <= 0.0 || height <= 0.0 {
            return;
        }
        let opacity = if cover < 1.0 {
            format!(" fill-opacity=\"{}\"", short(cover))
        } else {
            String::new()
        };
        self.line(format_args!(
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"{}\"{opacity}/>",
            hex(colour)
        ));
    }

    fn text(&mut self, text: &str, place: Spot, style: &Style) {
        let anchor = match style.align {
            Align::Start => "start",
            Align::Middle => "middle",
            Align::End => "end",
        };
        // The baseline lies below the middle of the capitals; vertical text is rotated about its position.
        let below = text::HALF_CAPITAL * style.size;
        let place = match style.direction {
            Direction::Right => {
                format!("x=\"{}\" y=\"{}\"", short(place.0), short(place.1 + below))
            }
            Direction::Up => format!(
                "transform=\"translate({} {}) rotate(-90)\" y=\"{}\"",
                short(place.0),
                short(place.1),
                short(below)
            ),
        };
        // Fixing the length of this font prevents text in another font from overlapping its neighbours.
        self.line(format_args!(
            "<text {place} font-size=\"{}\" text-anchor=\"{anchor}\" textLength=\"{}\" lengthAdjust=\"spacingAndGlyphs\" fill=\"{}\">{}</text>",
            short(style.size),
            short(text::width(text, style.size)),
            hex(style.colour),
            escaped(text)
        ));
    }

    fn image(
        &mut self,
        cells: &Raster,
        [left, top]: [usize; 2],
        is_transparent: bool,
    ) -> io::Result<()> {
        let (width, height) = cells.size();
        let mut png = Vec::new();
        cells.bitmap(is_transparent).encode(&mut png)?;
        self.line(format_args!(
            "<image x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{}\"/>",
            BASE64_STANDARD.encode(png)
        ));
        Ok(())
    }
}

/// Returns a line as a path; a single point is a dot.
fn course(line: &[Spot]) -> String {
    let mut path = String::new();
    for (k, &place) in line.iter().enumerate() {
        path += if k == 0 { "M" } else { "L" };
        path += &spot(place);
    }
    if line.len() == 1 {
        path += "h0";
    }
    path
}

fn spot((x, y): Spot) -> String {
    format!("{},{}", short(x), short(y))
}

fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Rounds to hundredths of a pixel.
fn short(number: f64) -> f64 {
    (100.0 * number).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::bitmap::Pen;
    use crate::picture::style::PictureStyle;

    #[test]
    fn every_shape_is_written_and_text_is_escaped() {
        let mut drawing = Drawing::new(&PictureStyle::of_width(300), 200);
        let black = [0, 0, 0];
        drawing.fill_rectangle((1.2, 2.0), (10.0, 20.4), [255, 0, 128], 0.5);
        drawing.stroke(
            vec![vec![(0.0, 0.0), (5.5, 7.125)], vec![(1.0, 1.0)]],
            Pen {
                width: 2.0,
                colour: black,
                dash: Some([8.0, 7.2]),
            },
        );
        drawing.fill_disc((50.0, 60.0), 4.0, black);
        drawing.fill_polygon(vec![(0.0, 0.0), (9.0, 0.0), (0.0, 9.0)], black);
        drawing.text("a < b & c", (100.0, 50.0), Style::new(20.0, Align::End));
        drawing.text("up", (100.0, 50.0), Style::new(20.0, Align::Middle).up());
        drawing.cells(Raster::new(30, 20, 2), 5, 6);
        let text = document(&drawing).unwrap();
        for part in [
            "<rect x=\"1\" y=\"2\" width=\"9\" height=\"18\" fill=\"#ff0080\" fill-opacity=\"0.5\"/>",
            "<path d=\"M0,0L5.5,7.13M1,1h0\"",
            "stroke-dasharray=\"8,7.2\"",
            "<circle cx=\"50\" cy=\"60\" r=\"4\"",
            "<polygon points=\"0,0 9,0 0,9\"",
            "text-anchor=\"end\"",
            ">a &lt; b &amp; c</text>",
            "rotate(-90)",
            "<image x=\"5\" y=\"6\" width=\"30\" height=\"20\" href=\"data:image/png;base64,iVBOR",
        ] {
            assert!(text.contains(part), "{part} is not in {text}");
        }
    }
}
