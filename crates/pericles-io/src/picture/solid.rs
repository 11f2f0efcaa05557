//! Solids in parallel projection: cells as boxes with hidden faces removed, axis directions and a scale bar.

use super::bitmap::{INK, Pen, Rgb};
use super::colour::shaded;
use super::drawing::Drawing;
use super::frame::{Area, ColourBar, Sizes};
use super::raster::{Face, Raster};
use super::scene::{Facet, Scene};
use super::text::{Align, Style};
use super::ticks::{Ticks, round_below};
use pericles::sum::max_norm;
use pericles::units::quantity;

const MARGIN: f64 = 0.03;
const FLATTEST: f64 = 0.2;
const TALLEST: f64 = 0.9;

/// Maximum number of cells with antialiased edges, to limit the time.
const MANY: usize = 300_000;

/// Light on faces turned away from the source, as a fraction of full light.
const SHADE: f64 = 0.75;

/// Colours of the axes x, y, z, as usual in computer graphics but dark enough for white paper.
const AXES: [(&str, Rgb); 3] = [
    ("x", [200, 30, 30]),
    ("y", [20, 130, 40]),
    ("z", [30, 60, 200]),
];

/// Colour of rigid bodies.
const RIGID: Rgb = [168, 172, 178];

/// Unit vectors of the screen: to the right, upwards, and towards the viewer.
#[derive(Debug, Clone, Copy)]
struct View {
    right: [f64; 3],
    up: [f64; 3],
    eye: [f64; 3],
}

impl View {
    fn new(direction: [f64; 3]) -> Self {
        let eye = normalised(direction);
        // z points up, or y when looking along z.
        let upright = if eye[2].abs() > 0.999 {
            [0.0, 1.0, 0.0]
        } else {
            [0.0, 0.0, 1.0]
        };
        let right = normalised(cross(upright, eye));
        Self {
            right,
            up: cross(eye, right),
            eye,
        }
    }

    /// Projects a point: to the right, upwards, towards the viewer.
    fn project(&self, p: [f64; 3]) -> [f64; 3] {
        [dot(p, self.right), dot(p, self.up), dot(p, self.eye)]
    }

    /// Returns the light on a surface with this normal, from above left of the viewer; normals are taken
    /// towards the viewer.
    fn light_on(&self, normal: [f64; 3]) -> f64 {
        /// Light on surfaces that the source does not reach.
        const AMBIENT: f64 = 0.6;
        let lamp = |k: usize| self.eye[k] + 0.7 * self.up[k] - 0.5 * self.right[k];
        let lamp = [lamp(0), lamp(1), lamp(2)];
        let size = (dot(normal, normal) * dot(lamp, lamp)).sqrt();
        if size == 0.0 {
            return 1.0;
        }
        let towards = dot(normal, lamp) * dot(normal, self.eye).signum() / size;
        AMBIENT + (1.0 - AMBIENT) * towards.max(0.0)
    }

    /// Returns the light on the visible faces across the three axes; the brightest has full light.
    fn light(&self) -> [f64; 3] {
        let lamp: [f64; 3] =
            std::array::from_fn(|k| self.eye[k] + 0.7 * self.up[k] - 0.4 * self.right[k]);
        let straight: [f64; 3] = std::array::from_fn(|c| (self.eye[c].signum() * lamp[c]).max(0.0));
        let most = straight.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        straight.map(|part| SHADE + (1.0 - SHADE) * part / most)
    }
}

pub(super) fn draw(scene: &Scene) -> Drawing {
    let sizes = Sizes::of(&scene.style);
    let width = f64::from(scene.style.width);
    let view = View::new(scene.view);

    let (low, high) = extent(scene, &view);
    let largest = (high[0] - low[0])
        .max(high[1] - low[1])
        .max(f64::MIN_POSITIVE);
    let margin = MARGIN * largest;
    let (ew, eh) = (
        high[0] - low[0] + 2.0 * margin,
        high[1] - low[1] + 2.0 * margin,
    );

    let left = sizes.gap.round();
    let mut right = 130.0 * width / 1200.0;
    let mut height = 0.0;
    let mut bar_ticks = Ticks::default();
    for _ in 0..sizes.rounds() {
        let plot = width - left - right;
        height = (plot * eh / ew)
            .clamp(FLATTEST * width, TALLEST * width)
            .round();
        bar_ticks = scene.bar.ticks(height, &sizes);
        right = ColourBar::room(&bar_ticks, &sizes).round();
    }
    let top = scene.header.height(&sizes).round();
    let area = Area {
        left,
        top,
        right: width - right,
        bottom: top + height,
    };
    let per_metre = (area.width() / ew).min(height / eh);

    let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
    let fine = if scene.cells.len() > MANY { 1 } else { 2 };
    let mut raster = Raster::new(area.width() as usize, height as usize, fine);
    let placing = Placing {
        view,
        middle,
        per_metre,
        half: [0.5 * area.width(), 0.5 * height],
    };
    draw_cells(&mut raster, scene, &placing);
    draw_facets(&mut raster, scene, &placing);
    draw_rigid(&mut raster, scene, &placing);

    let arm = 3.0 * sizes.tick_text;
    let below = 2.0 * arm + sizes.tick_text + 2.0 * sizes.gap;
    let mut drawing = Drawing::new(&scene.style, (area.bottom + below).ceil() as usize);
    drawing.cells(raster, left as usize, top as usize);
    draw_directions(&mut drawing, &view, area, arm, &sizes);
    draw_length(&mut drawing, area, (per_metre, scene.length_unit), &sizes);
    scene.bar.draw(&mut drawing, area, &bar_ticks, &sizes);
    scene
        .header
        .draw(&mut drawing, 2.0 * left, width - sizes.gap, &sizes);
    drawing
}

/// Returns the extent of the body on the screen: minimum and maximum coordinates to the right and upwards, m.
fn extent(scene: &Scene, view: &View) -> ([f64; 2], [f64; 2]) {
    // Its bounding box.
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in 0..8 {
        let p = std::array::from_fn(|c| {
            if corner >> c & 1 == 0 {
                scene.low[c]
            } else {
                scene.high[c]
            }
        });
        for (c, value) in view.project(p).into_iter().take(2).enumerate() {
            low[c] = low[c].min(value);
            high[c] = high[c].max(value);
        }
    }
    // A surface need not fill its bounding box.
    if !scene.facets.is_empty() && !scene.window {
        let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in scene.facets.iter().flat_map(|facet| facet.corners) {
            for (c, value) in view.project(corner).into_iter().take(2).enumerate() {
                least[c] = least[c].min(value);
                most[c] = most[c].max(value);
            }
        }
        for c in 0..2 {
            low[c] = low[c].max(least[c]);
            high[c] = high[c].min(most[c]).max(low[c]);
        }
    }
    (low, high)
}

/// Mapping from positions in space to pixels of the plot.
struct Placing {
    view: View,
    /// Centre of the plot on the screen, m.
    middle: [f64; 2],
    per_metre: f64,
    /// Half the size of the plot, in pixels.
    half: [f64; 2],
}

impl Placing {
    /// Maps to the right, downwards and away from the viewer, relative to a position on the screen.
    fn relative(&self, p: [f64; 3], of: [f64; 2]) -> [f64; 3] {
        let [x, y, near] = self.view.project(p);
        [
            (x - of[0]) * self.per_metre,
            (of[1] - y) * self.per_metre,
            -near,
        ]
    }

    /// Maps to pixels of the plot.
    fn place(&self, p: [f64; 3]) -> [f64; 3] {
        let [x, y, far] = self.relative(p, self.middle);
        [x + self.half[0], y + self.half[1], far]
    }
}

/// Draws cells as boxes with three visible faces.
fn draw_cells(raster: &mut Raster, scene: &Scene, placing: &Placing) {
    let view = &placing.view;
    let light = view.light();
    // Front to back, so that hidden faces can be skipped.
    let mut order: Vec<(usize, f64)> = (scene.cells.iter())
        .map(|cell| -dot(cell.middle, view.eye))
        .enumerate()
        .collect();
    order.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    for (k, _) in order {
        let cell = &scene.cells[k];
        for (c, light) in light.into_iter().enumerate() {
            let (c1, c2) = ((c + 1) % 3, (c + 2) % 3);
            let along = |c: usize, sign: f64| {
                let mut edge = [0.0; 3];
                edge[c] = sign * cell.half[c];
                edge
            };
            let outward = along(c, view.eye[c].signum());
            let face = Face {
                middle: placing.place(std::array::from_fn(|k| cell.middle[k] + outward[k])),
                a: placing.relative(along(c1, 1.0), [0.0; 2]),
                b: placing.relative(along(c2, 1.0), [0.0; 2]),
                seam: 2.0 * cell.half[0].max(cell.half[1]).max(cell.half[2]),
            };
            raster.face(&face, (3 * k + c) as u32, shaded(cell.colour, light));
        }
    }
}

/// Draws triangles of a surface, lit by their normals.
fn draw_facets(raster: &mut Raster, scene: &Scene, placing: &Placing) {
    let corners = |facet: &Facet| facet.corners.map(|corner| placing.place(corner));
    let mut placed: Vec<_> = scene
        .facets
        .iter()
        .map(|facet| (corners(facet), facet))
        .collect();
    // From front to back, so that few hidden pixels are coloured.
    let nearest =
        |corners: &[[f64; 3]; 3]| corners.iter().map(|x| x[2]).fold(f64::INFINITY, f64::min);
    placed.sort_by(|(a, _), (b, _)| nearest(a).total_cmp(&nearest(b)));
    for (corners, facet) in placed {
        raster.triangle(corners, |shares| {
            let [s, t, r] = shares;
            let mix = |[x, y, z]: [f64; 3]| s * x + t * y + r * z;
            let [a, b, c] = facet.normals;
            let along = |k: usize| mix([a[k], b[k], c[k]]);
            let normal = [along(0), along(1), along(2)];
            shaded(
                scene.bar.colour(mix(facet.values)),
                placing.view.light_on(normal),
            )
        });
    }
}

/// Draws rigid bodies in grey.
fn draw_rigid(raster: &mut Raster, scene: &Scene, placing: &Placing) {
    for &corners in &scene.rigid {
        let [a, b, c] = corners;
        let edge = |p: [f64; 3]| std::array::from_fn(|k| p[k] - a[k]);
        let light = placing.view.light_on(cross(edge(b), edge(c)));
        let colour = shaded(RIGID, light);
        raster.triangle(corners.map(|corner| placing.place(corner)), |_| colour);
    }
}

/// Draws the axis directions in the lower left corner.
fn draw_directions(drawing: &mut Drawing, view: &View, area: Area, arm: f64, sizes: &Sizes) {
    let reach = arm + 0.8 * sizes.tick_text;
    let from = (
        area.left + sizes.gap + reach,
        area.bottom + sizes.gap + reach,
    );
    let mut axes: Vec<_> = (0..3)
        .map(|c| (c, [view.right[c], view.up[c], view.eye[c]]))
        .collect();
    // the axis nearest to the viewing direction is drawn last, over the others
    axes.sort_by(|(_, a), (_, b)| a[2].total_cmp(&b[2]));
    for (c, [x, y, _]) in axes {
        let (name, colour) = AXES[c];
        let to = (from.0 + arm * x, from.1 - arm * y);
        let pen = Pen {
            width: 2.0 * sizes.line,
            colour,
            dash: None,
        };
        drawing.stroke(vec![vec![from, to]], pen);
        let length = x.hypot(y);
        if length > 0.1 {
            let far = arm + 0.6 * sizes.tick_text / length;
            let place = (from.0 + far * x, from.1 - far * y);
            let style = Style::new(sizes.tick_text, Align::Middle).colour(colour);
            drawing.text(name, place, style);
        }
    }
}

/// Draws a scale bar of a round length below the plot; in parallel projection it holds for every line across
/// the viewing direction.
fn draw_length(drawing: &mut Drawing, area: Area, (per_metre, unit): (f64, &str), sizes: &Sizes) {
    let length = round_below(0.25 * area.width() / per_metre);
    let half = 0.5 * length * per_metre;
    let x = 0.5 * (area.left + area.right);
    let y = area.bottom + 3.0 * sizes.gap;
    drawing.rule((x - half, y), (x + half, y), 2.0 * sizes.line, INK);
    for end in [x - half, x + half] {
        let tick = 0.7 * sizes.tick;
        drawing.rule((end, y - tick), (end, y + tick), 2.0 * sizes.line, INK);
    }
    let style = Style::new(sizes.tick_text, Align::Middle);
    let place = (x, y + sizes.tick + 0.8 * sizes.tick_text);
    drawing.text(&round_quantity(length, unit), place, style);
}

/// Formats a round number with its unit and without trailing zeros: `20 mm`.
fn round_quantity(length: f64, unit: &str) -> String {
    let text = quantity(length, unit);
    match text.split_once(' ') {
        Some((number, unit)) if number.contains('.') => {
            let number = number.trim_end_matches('0').trim_end_matches('.');
            format!("{number} {unit}")
        }
        _ => text,
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn normalised(v: [f64; 3]) -> [f64; 3] {
    // Squares of the largest and smallest numbers overflow and underflow.
    let largest = max_norm(&v);
    let v = v.map(|c| c / largest);
    let length = dot(v, v).sqrt();
    v.map(|c| c / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn screen_axes_are_right_handed_from_every_direction() {
        for direction in [
            [0.5, -1.0, 0.6],
            [0.0, 0.0, 3.0],
            [0.0, 0.0, -1.0],
            [-2.0, 0.1, 0.0],
            [1e300, -1e300, 1e300],
            [0.0, 1e-300, 0.0],
        ] {
            let view = View::new(direction);
            let axes = [view.right, view.up, view.eye];
            for (k, axis) in axes.iter().enumerate() {
                for (l, other) in axes.iter().enumerate() {
                    let expected = if k == l { 1.0 } else { 0.0 };
                    assert!((dot(*axis, *other) - expected).abs() < 1e-12);
                }
            }
            let turned = cross(view.right, view.up);
            assert!(dot(turned, view.eye) > 0.999 && dot(view.eye, direction) > 0.0);
            assert!(view.up[2] >= 0.0);
        }
        let front = View::new([0.0, -1.0, 0.0]);
        assert_eq!(front.project([1.0, 2.0, 3.0]), [1.0, 3.0, -2.0]);
    }

    #[test]
    fn lengths_are_written_without_trailing_zeros() {
        for (length, text) in [
            (0.02, "20 mm"),
            (5e-7, "500 nm"),
            (2.0, "2 m"),
            (1e-4, "100 µm"),
        ] {
            assert_eq!(round_quantity(length, "m"), text);
        }
    }
}
