//! A picture as a list of shapes, from which pixels, SVG or PDF are produced.
//!
//! Charts and frames are shapes; the cells of a body are always pixels. Cells are rendered by our code, with a depth
//! buffer in which the smallest key wins, so that the result does not depend on the order; lines are clipped in
//! doubles, because curves may leave their chart by any factor.

use super::bitmap::{Bitmap, INK, Pen, Rgb, WHITE};
use super::raster::Raster;
use super::style::PictureStyle;
use super::text::{self, Style};

/// A position in pixels from the left and from the top.
pub(super) type Spot = (f64, f64);

/// A shape; later shapes cover earlier ones.
#[derive(Debug)]
pub(super) enum Shape {
    /// A rectangle with sides at whole pixels.
    Rectangle {
        from: Spot,
        to: Spot,
        colour: Rgb,
        /// Opacity; 1 hides what lies below.
        cover: f64,
    },
    /// Lines with round caps and joins.
    Strokes {
        lines: Vec<Vec<Spot>>,
        pen: Pen,
    },
    Disc {
        middle: Spot,
        radius: f64,
        colour: Rgb,
    },
    Polygon {
        corners: Vec<Spot>,
        colour: Rgb,
    },
    Text {
        text: String,
        place: Spot,
        style: Style,
    },
    /// Cells of a body, which stay pixels in every format.
    Cells {
        cells: Raster,
        left: usize,
        top: usize,
    },
}

/// A page with shapes.
#[derive(Debug)]
pub(super) struct Drawing {
    width: usize,
    height: usize,
    shapes: Vec<Shape>,
    style: PictureStyle,
}

impl Drawing {
    /// Creates a page of a style and a height in pixels.
    pub(super) fn new(style: &PictureStyle, height: usize) -> Self {
        Self {
            width: style.width as usize,
            height,
            shapes: Vec::new(),
            style: *style,
        }
    }

    pub(super) fn is_transparent(&self) -> bool {
        self.style.transparent
    }

    /// Returns the pixels per inch, if the picture has a size on paper.
    pub(super) fn dpi(&self) -> Option<f64> {
        self.style.print.map(|print| print.dpi)
    }

    /// Returns the length of a pixel in points.
    pub(super) fn pixel(&self) -> f64 {
        self.style.pixel()
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn height(&self) -> usize {
        self.height
    }

    pub(super) fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    pub(super) fn fill_rectangle(&mut self, from: Spot, to: Spot, colour: Rgb, cover: f64) {
        self.shapes.push(Shape::Rectangle {
            from,
            to,
            colour,
            cover,
        });
    }

    /// Draws a horizontal or vertical line of at least one pixel.
    pub(super) fn rule(&mut self, from: Spot, to: Spot, width: f64, colour: Rgb) {
        let half = (width.round().max(1.0) / 2.0).max(0.5);
        let low = (from.0.min(to.0) - half, from.1.min(to.1) - half);
        let high = (from.0.max(to.0) + half, from.1.max(to.1) + half);
        self.fill_rectangle(low, high, colour, 1.0);
    }

    /// Draws the outline of a rectangle.
    pub(super) fn outline(&mut self, from: Spot, to: Spot, width: f64, colour: Rgb) {
        let corners = [from, (to.0, from.1), to, (from.0, to.1)];
        for (k, &corner) in corners.iter().enumerate() {
            self.rule(corner, corners[(k + 1) % 4], width, colour);
        }
    }

    pub(super) fn stroke(&mut self, lines: Vec<Vec<Spot>>, pen: Pen) {
        self.shapes.push(Shape::Strokes { lines, pen });
    }

    /// Draws dark lines with a light rim, visible on all colours.
    pub(super) fn stroke_on_colours(&mut self, lines: Vec<Vec<Spot>>, width: f64) {
        if lines.is_empty() {
            return;
        }
        for (width, colour) in [(3.0 * width, WHITE), (width, INK)] {
            let pen = Pen {
                width,
                colour,
                dash: None,
            };
            self.stroke(lines.clone(), pen);
        }
    }

    pub(super) fn fill_disc(&mut self, middle: Spot, radius: f64, colour: Rgb) {
        self.shapes.push(Shape::Disc {
            middle,
            radius,
            colour,
        });
    }

    pub(super) fn fill_polygon(&mut self, corners: Vec<Spot>, colour: Rgb) {
        self.shapes.push(Shape::Polygon { corners, colour });
    }

    /// Adds a text; along its direction, `place` is at half the height of its capitals.
    pub(super) fn text(&mut self, text: &str, place: Spot, style: Style) {
        if !text.is_empty() {
            let text = text.to_owned();
            self.shapes.push(Shape::Text { text, place, style });
        }
    }

    pub(super) fn cells(&mut self, cells: Raster, left: usize, top: usize) {
        self.shapes.push(Shape::Cells { cells, left, top });
    }

    /// Renders the shapes.
    pub(super) fn to_bitmap(&self) -> Bitmap {
        let bitmap = match self.is_transparent() {
            true => Bitmap::without_background(self.on(WHITE), &self.on([0; 3])),
            false => self.on(WHITE),
        };
        bitmap.with_dpi(self.dpi())
    }

    fn on(&self, background: Rgb) -> Bitmap {
        let mut bitmap = Bitmap::filled(self.width, self.height, background);
        for shape in &self.shapes {
            match shape {
                Shape::Rectangle {
                    from,
                    to,
                    colour,
                    cover,
                } => bitmap.fill_rectangle(*from, *to, *colour, *cover),
                Shape::Strokes { lines, pen } => bitmap.stroke(lines, *pen),
                Shape::Disc {
                    middle,
                    radius,
                    colour,
                } => bitmap.fill_disc(*middle, *radius, *colour),
                Shape::Polygon { corners, colour } => bitmap.fill_polygon(corners, *colour),
                Shape::Text { text, place, style } => {
                    text::draw(&mut bitmap, text, *place, *style);
                }
                Shape::Cells { cells, left, top } => cells.lay_on(&mut bitmap, *left, *top),
            }
        }
        bitmap
    }
}
