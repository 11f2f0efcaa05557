//! Picture of a scalar field on the points of a body.

use std::path::Path;

use super::colour::ColourMap;
use super::curve::{Axis, Curve};
use super::drawing::Drawing;
use super::extent::{Extent, is_signed};
use super::frame::{ColourBar, Header, finite_range, widened};
use super::line_chart::LineChart;
use super::polygon::{Coloured, Polygons};
use super::scene::{Drawn, Facet, Scene};
use super::style::PictureStyle;
use super::surface::facets;
use super::write::write;
use super::{plane, solid};
use crate::IoError;
use pericles::units::{Shown, number_of, quantity};

/// Edge lengths of the cells of the points, m.
#[derive(Debug, Clone, Copy)]
pub enum CellSize<'a> {
    /// Equal squares or cubes.
    Uniform(f64),
    /// Equal rectangles or blocks.
    Block([f64; 3]),
    /// A square or cube per point.
    PerPoint(&'a [f64]),
}

impl CellSize<'_> {
    fn of(&self, point: usize) -> [f64; 3] {
        match *self {
            Self::Uniform(edge) => [edge; 3],
            Self::Block(edges) => edges,
            Self::PerPoint(edges) => [edges[point]; 3],
        }
    }
}

/// A picture of a scalar on the points of a bar, a plane body or a solid.
#[derive(Debug, Clone)]
#[must_use = "nothing is drawn before `write`"]
pub struct FieldPicture<'a> {
    dimension: usize,
    positions: &'a [f64],
    values: &'a [f64],
    triangles: &'a [[u32; 3]],
    polygons: Polygons,
    cell: CellSize<'a>,
    displacement: Option<(&'a [f64], f64)>,
    name: String,
    unit: String,
    length_unit: &'static str,
    title: String,
    time: Option<f64>,
    progress: Option<(&'static str, f64)>,
    lines: Vec<Vec<[f64; 3]>>,
    rigid: Vec<[[f64; 3]; 3]>,
    outlines: Vec<Vec<[f64; 2]>>,
    colours: Option<ColourMap>,
    categories: Option<Vec<String>>,
    range: Option<(f64, f64)>,
    window: Option<([f64; 3], [f64; 3])>,
    view: [f64; 3],
    style: PictureStyle,
}

impl<'a> FieldPicture<'a> {
    /// Creates a picture of `values` on points in 1, 2 or 3 dimensions; positions are component-major.
    pub fn new(
        dimension: usize,
        positions: &'a [f64],
        values: &'a [f64],
        cell: CellSize<'a>,
    ) -> Self {
        Self {
            dimension,
            positions,
            values,
            triangles: &[],
            polygons: Polygons::default(),
            cell,
            displacement: None,
            name: String::new(),
            unit: String::new(),
            length_unit: "m",
            title: String::new(),
            time: None,
            progress: None,
            lines: Vec::new(),
            rigid: Vec::new(),
            outlines: Vec::new(),
            colours: None,
            categories: None,
            range: None,
            window: None,
            // From the front right, slightly above: x points to the right, z upwards.
            view: [0.5, -1.0, 0.6],
            style: PictureStyle::default(),
        }
    }

    /// Draws a shaded surface of triangles between the points in place of their cells, in three dimensions.
    pub fn triangles(mut self, triangles: &'a [[u32; 3]]) -> Self {
        self.triangles = triangles;
        self
    }

    /// Draws polygons, such as the cells of a mesh, in place of the squares or cubes of the points that have a cell.
    pub fn polygons(mut self, polygons: Polygons) -> Self {
        self.polygons = polygons;
        self
    }

    /// Sets the quantity and its SI unit; empty for a dimensionless quantity.
    pub fn label(mut self, name: impl Into<String>, unit: impl Into<String>) -> Self {
        self.name = name.into();
        self.unit = unit.into();
        self
    }

    /// Treats lengths as dimensionless, for problems without units; the default is metres.
    pub fn without_units(mut self) -> Self {
        self.length_unit = "";
        self
    }

    /// Draws the points at displaced positions, with the displacement (component-major) magnified by `scale`.
    /// The field of a bar is always drawn as a curve over the reference coordinate.
    pub fn displacement(mut self, displacement: &'a [f64], scale: f64) -> Self {
        self.displacement = Some((displacement, scale));
        self
    }

    /// Sets the title above the picture.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Sets a number with its name, such as the load factor, shown in the upper right corner instead of the time.
    pub fn progress(mut self, name: &'static str, value: f64) -> Self {
        self.progress = Some((name, value));
        self
    }

    /// Sets the time in seconds, shown in the upper right corner.
    pub fn time(mut self, time: f64) -> Self {
        self.time = Some(time);
        self
    }

    /// Adds lines on a body, such as pre-cracks and interfaces, as polylines of positions in m. Parts that a solid hides
    /// are dashed.
    pub fn lines(mut self, lines: Vec<Vec<[f64; 3]>>) -> Self {
        self.lines = lines;
        self
    }

    /// Adds rigid bodies, which count in the extent: in space grey triangles, by the positions of their corners, in the plane outlines,
    /// m.
    pub fn rigid(mut self, triangles: Vec<[[f64; 3]; 3]>, outlines: Vec<Vec<[f64; 2]>>) -> Self {
        self.rigid = triangles;
        self.outlines = outlines;
        self
    }

    /// Sets the colour map; the default is [`ColourMap::Diverging`] for values of both signs, otherwise
    /// [`ColourMap::Viridis`].
    pub fn colours(mut self, colours: ColourMap) -> Self {
        self.colours = Some(colours);
        self
    }

    /// Treats the values as identification numbers: the most frequent ones have a colour each, with their share
    /// of the points in the legend; all others are grey. The legend shows the name of a number, if `names` has
    /// one. A bar is then drawn as a strip of its cells, not as a curve.
    pub fn categories(mut self, names: Vec<String>) -> Self {
        self.categories = Some(names);
        self
    }

    /// Sets the values at the ends of the colour bar; the default is the [`Extent`] of the values. Arrows at the ends of the bar
    /// show that values lie beyond.
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }

    /// Sets the region shown, by opposite corners, so that the pictures of a series have the same axes. The
    /// default is the extent of the displaced body.
    pub fn window(mut self, low: [f64; 3], high: [f64; 3]) -> Self {
        self.window = Some((low, high));
        self
    }

    /// Sets the viewing direction, from a solid to the viewer.
    pub fn view(mut self, view: [f64; 3]) -> Self {
        self.view = view;
        self
    }

    /// Sets the width in pixels, 200 to 16 000; the default is 1200. The height follows from the shape of the
    /// body.
    pub fn width(mut self, width: u32) -> Self {
        self.style.width = width;
        self
    }

    /// Sets size and style.
    pub fn style(mut self, style: PictureStyle) -> Self {
        self.style = style;
        self
    }

    /// Draws the picture and writes it atomically: as SVG or PDF, with the cells as an embedded image, if the file
    /// name ends in `.svg` or `.pdf`; otherwise as PNG.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        write(&self.draw(path)?, path)
    }

    fn draw(&self, path: &Path) -> Result<Drawing, IoError> {
        self.check(path)?;
        if self.dimension == 1 && self.categories.is_none() {
            return self.along_the_bar().draw(path);
        }
        let scene = self.scene();
        if scene.is_empty() {
            return Err(IoError::Unsuitable {
                path: path.to_path_buf(),
                reason: "no point has a finite position".into(),
            });
        }
        Ok(match self.dimension {
            3 => solid::draw(&scene),
            _ => plane::draw(&scene),
        })
    }

    fn check(&self, path: &Path) -> Result<(), IoError> {
        let unsuitable = |reason: String| IoError::Unsuitable {
            path: path.to_path_buf(),
            reason,
        };
        if !(1..=3).contains(&self.dimension) {
            let given = self.dimension;
            return Err(unsuitable(format!(
                "the body has dimension {given}; allowed: 1, 2 and 3"
            )));
        }
        if let Some(problem) = self.style.problem() {
            return Err(unsuitable(problem));
        }
        if self.view.iter().any(|c| !c.is_finite()) || self.view == [0.0; 3] {
            return Err(unsuitable(
                "the view direction must be finite and not zero".into(),
            ));
        }
        let n = self.values.len();
        let mut arrays = vec![("positions", self.positions.len(), self.dimension * n)];
        if let Some((u, _)) = self.displacement {
            arrays.push(("displacement", u.len(), self.dimension * n));
        }
        if let CellSize::PerPoint(edges) = self.cell {
            arrays.push(("cell sizes", edges.len(), n));
        }
        for (what, given, expected) in arrays {
            if given != expected {
                return Err(IoError::Shape {
                    path: path.to_path_buf(),
                    what: what.into(),
                    expected,
                    given,
                });
            }
        }
        if self.triangles.iter().flatten().any(|&k| k as usize >= n) {
            return Err(unsuitable(format!(
                "triangles refer to points beyond the {n} points of the body"
            )));
        }
        if self.polygons.all.iter().any(|one| one.point as usize >= n) {
            return Err(unsuitable(format!(
                "polygons refer to points beyond the {n} points of the body"
            )));
        }
        if let Some((low, high)) = self.window {
            let fits =
                (0..self.dimension).all(|c| low[c] < high[c] && (high[c] - low[c]).is_finite());
            if !fits {
                return Err(unsuitable(
                    "the lower corner of the window must lie below the upper corner in every coordinate".into(),
                ));
            }
        }
        Ok(())
    }

    /// Returns the displaced position of a point; zero in dimensions that the body does not have.
    fn place(&self, point: usize) -> [f64; 3] {
        let n = self.values.len();
        std::array::from_fn(|c| {
            if c >= self.dimension {
                return 0.0;
            }
            let at = c * n + point;
            let moved = self.displacement.map_or(0.0, |(u, scale)| scale * u[at]);
            self.positions[at] + moved
        })
    }

    /// Returns the colour map, if it is set.
    fn colour_map(&self) -> Option<ColourMap> {
        self.colours.or(self.style.colours)
    }

    fn colour_bar(&self) -> ColourBar {
        if let Some(names) = &self.categories {
            return ColourBar::of_numbers(self.values, names);
        }
        let [low, high] = match self.range {
            Some((low, high)) => [low, high],
            None => {
                let [low, high] = Extent::of(self.values, 0.0).ends();
                match self.colour_map() {
                    Some(ColourMap::Diverging) => {
                        let size = low.abs().max(high.abs());
                        [-size, size]
                    }
                    _ => [low, high],
                }
            }
        };
        let (low, high) = widened(low, high);
        let colours = self.colour_map().unwrap_or(match is_signed(low, high) {
            true => ColourMap::Diverging,
            false => ColourMap::Viridis,
        });
        let (least, most) = finite_range(self.values.iter().copied());
        let slack = 1e-6 * (high - low);
        ColourBar {
            map: colours,
            low,
            high,
            shown: Shown::for_size(low.abs().max(high.abs()), &self.unit),
            clipped: [least < low - slack, most > high + slack],
            categories: Vec::new(),
        }
    }

    fn scene(&self) -> Scene {
        let bar = self.colour_bar();
        let has_cell = |point: usize| self.polygons.has_cell.get(point) == Some(&true);
        let without_cell = (self.values.iter().enumerate()).filter(|(point, _)| !has_cell(*point));
        let mut cells = Vec::new();
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (point, &value) in without_cell {
            let middle = self.place(point);
            let half = self.cell.of(point).map(|edge| match edge.is_finite() {
                true => 0.5 * edge.abs(),
                false => 0.0,
            });
            // If the solution has diverged, some positions are not finite; the others are still drawn.
            if middle.iter().any(|c| !c.is_finite()) {
                continue;
            }
            for c in 0..3 {
                low[c] = low[c].min(middle[c] - half[c]);
                high[c] = high[c].max(middle[c] + half[c]);
            }
            let colour = bar.colour(value);
            if self.triangles.is_empty() {
                cells.push(Drawn {
                    middle,
                    half,
                    colour,
                });
            }
        }
        let polygons = self.polygons.all.iter();
        let polygons = polygons.filter(|one| one.corners.iter().flatten().all(|x| x.is_finite()));
        let polygons: Vec<Coloured> = polygons
            .map(|one| Coloured {
                corners: one.corners,
                colour: bar.colour(self.values[one.point as usize]),
            })
            .collect();
        let outlines = self.outlines.iter();
        let outlines = outlines.map(|line| line.iter().map(|&[x, y]| [x, y, 0.0]).collect());
        let outlines: Vec<Vec<[f64; 3]>> = outlines.collect();
        let corners = polygons.iter().flat_map(|one| &one.corners);
        let around = corners.chain(self.rigid.iter().flatten());
        let around = around.chain(outlines.iter().flatten());
        for corner in around {
            for c in 0..self.dimension {
                low[c] = low[c].min(corner[c]);
                high[c] = high[c].max(corner[c]);
            }
        }
        let (low, high) = self.window.unwrap_or((low, high));
        let header = Header {
            title: self.shown_title().into(),
            stamp: self.stamp(),
            note: self.note(),
            bar_label: bar.shown.label(&self.name),
        };
        Scene {
            style: self.style,
            is_strip: self.dimension == 1,
            cells,
            polygons,
            facets: self.facets(),
            low,
            high,
            window: self.window.is_some(),
            bar,
            header,
            length_unit: self.length_unit,
            view: self.view,
            lines: self.lines.iter().cloned().chain(outlines).collect(),
            rigid: self.rigid.clone(),
        }
    }

    fn facets(&self) -> Vec<Facet> {
        if self.triangles.is_empty() {
            return Vec::new();
        }
        let places = (0..self.values.len()).map(|point| self.place(point));
        let places: Vec<[f64; 3]> = places.collect();
        facets(
            self.triangles,
            &places,
            self.values,
            self.categories.is_some(),
        )
    }

    fn shown_title(&self) -> &str {
        match self.style.titled {
            true => &self.title,
            false => "",
        }
    }

    fn stamp(&self) -> String {
        if !self.style.titled {
            return String::new();
        }
        match (self.progress, self.time) {
            (Some((name, value)), _) => format!("{name} {}", number_of(value)),
            (None, Some(time)) => format!("t = {}", quantity(time, "s")),
            (None, None) => String::new(),
        }
    }

    /// Returns a note on magnified displacements: the axes do not apply to magnified positions.
    fn note(&self) -> String {
        let enlarged = self.displacement.filter(|(_, scale)| *scale != 1.0);
        enlarged
            .map(|(_, scale)| format!("displacement × {scale}"))
            .unwrap_or_default()
    }

    /// Draws the field of a bar as a curve over the reference coordinate. Over displaced positions, large
    /// displacements would shear the curve, and a symmetric field would not look symmetric.
    fn along_the_bar(&self) -> LineChart {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_by(|&a, &b| self.positions[a].total_cmp(&self.positions[b]));
        let x: Vec<f64> = order.iter().map(|&point| self.positions[point]).collect();
        let y: Vec<f64> = order.iter().map(|&point| self.values[point]).collect();
        let mut along = Axis::new("x", self.length_unit);
        if let Some((low, high)) = self.window {
            along = along.range(low[0], high[0]);
        }
        let mut across = Axis::new(&self.name, &self.unit);
        if let Some((low, high)) = self.range {
            across = across.range(low, high);
        }
        LineChart::new(along, across)
            .title(self.shown_title())
            .stamp(self.stamp())
            .style(self.style)
            .curve(Curve::line("", &x, &y))
    }
}
