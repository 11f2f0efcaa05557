//! Solids in parallel projection: faces of cells with hidden ones removed, lines, axis directions and a scale bar.

use super::bitmap::{INK, Pen, Rgb};
use super::clip::clipped;
use super::colour::shaded;
use super::drawing::{Drawing, Spot};
use super::frame::{Area, ColourBar, Sizes};
use super::palette::Palette;
use super::polygon;
use super::projection::{Placing, View};
use super::raster::{Rank, Raster};
use super::scene::{Facet, Scene};
use super::text::{Align, Style};
use super::ticks::{Ticks, round_below};
use pericles::units::quantity;
use pericles::vector::{cross, dot, plus};

const MARGIN: f64 = 0.03;
const FLATTEST: f64 = 0.2;
const TALLEST: f64 = 0.9;

/// Maximum number of cells with antialiased edges, to limit the time.
const MANY: usize = 300_000;

/// Place of surfaces and rigid bodies behind cells of equal depth.
const LAST: Rank = Rank {
    number: u32::MAX,
    seam: Some(0.0),
};

/// Colours of the axes x, y, z, as usual in computer graphics but dark enough for white paper.
const AXES: [(&str, Rgb); 3] = [
    ("x", [200, 30, 30]),
    ("y", [20, 130, 40]),
    ("z", [30, 60, 200]),
];

/// Colour of rigid bodies.
const RIGID: Rgb = [168, 172, 178];

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
    let fine = match scene.cells.len() + scene.polygons.len() > MANY {
        true => 1,
        false => 2,
    };
    let mut raster = Raster::new(area.width() as usize, height as usize, fine);
    let placing = Placing {
        view,
        middle,
        per_metre,
        half: [0.5 * area.width(), 0.5 * height],
    };
    draw_cells(&mut raster, scene, &placing);
    let place = |p| placing.place(p);
    let edges = scene.style.edges.then_some(sizes.line);
    polygon::draw(&mut raster, &scene.polygons, place, Some(&view), edges);
    draw_facets(&mut raster, scene, &placing);
    draw_rigid(&mut raster, scene, &placing);

    let arm = 3.0 * sizes.tick_text;
    let below = 2.0 * arm + sizes.tick_text + 2.0 * sizes.gap;
    let mut drawing = Drawing::new(&scene.style, (area.bottom + below).ceil() as usize);
    let lines = seen_lines(&raster, scene, &placing);
    drawing.cells(raster, left as usize, top as usize);
    draw_lines(&mut drawing, lines, area, &sizes);
    draw_directions(&mut drawing, &view, area, arm, &sizes);
    draw_length(&mut drawing, area, (per_metre, scene.length_unit), &sizes);
    scene.bar.draw(&mut drawing, area, &bar_ticks, &sizes);
    scene
        .header
        .draw(&mut drawing, 2.0 * left, width - sizes.gap, &sizes);
    drawing
}

/// Returns the extent of the picture on the screen: minimum and maximum coordinates to the right and upwards, m.
fn extent(scene: &Scene, view: &View) -> ([f64; 2], [f64; 2]) {
    let corners: Vec<[f64; 3]> = match scene.window {
        false => scene.corners().collect(),
        true => (0..8)
            .map(|corner| {
                std::array::from_fn(|c| match corner >> c & 1 {
                    0 => scene.low[c],
                    _ => scene.high[c],
                })
            })
            .collect(),
    };
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in corners {
        for (c, value) in view.project(corner).into_iter().take(2).enumerate() {
            low[c] = low[c].min(value);
            high[c] = high[c].max(value);
        }
    }
    (low, high)
}

/// Draws cells as boxes with three visible faces.
fn draw_cells(raster: &mut Raster, scene: &Scene, placing: &Placing) {
    let view = &placing.view;
    // Front to back, so that hidden faces can be skipped.
    let mut order: Vec<(usize, f64)> = (scene.cells.iter())
        .map(|cell| -dot(cell.middle, view.eye))
        .enumerate()
        .collect();
    order.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    for (k, _) in order {
        let cell = &scene.cells[k];
        let seam = 2.0 * cell.half[0].max(cell.half[1]).max(cell.half[2]);
        for c in 0..3 {
            let mut normal = [0.0; 3];
            normal[c] = view.eye[c].signum();
            let colour = shaded(cell.colour, view.light_on_face(normal));
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(s, t)| {
                let mut side = normal;
                side[(c + 1) % 3] = s;
                side[(c + 2) % 3] = t;
                let corner = std::array::from_fn(|k| cell.middle[k] + side[k] * cell.half[k]);
                placing.place(corner)
            });
            let rank = Rank {
                number: (3 * k + c) as u32,
                seam: Some(seam),
            };
            let [p, q, r, s] = corners;
            raster.triangle([p, q, r], rank, |_| colour);
            raster.triangle([p, r, s], rank, |_| colour);
        }
    }
}

/// Draws triangles of a surface, lit by the normals at their corners (Gouraud shading).
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
    let palette = Palette::of(&scene.bar);
    for (corners, facet) in placed {
        // Corners of a face at the outline may have normals that point away from the viewer.
        let [a, b, c] = facet.normals;
        let side = placing.view.side_of(plus(plus(a, 1.0, b), 1.0, c));
        let lights = facet.normals;
        let lights = lights.map(|normal| placing.view.light_on(normal, side));
        raster.triangle(corners, LAST, |shares| {
            let mix = |of: [f64; 3]| dot(shares, of);
            shaded(palette.colour(mix(facet.values)), mix(lights))
        });
    }
}

/// Draws rigid bodies in grey.
fn draw_rigid(raster: &mut Raster, scene: &Scene, placing: &Placing) {
    for &corners in &scene.rigid {
        let [a, b, c] = corners;
        let edge = |p: [f64; 3]| std::array::from_fn(|k| p[k] - a[k]);
        let normal = cross(edge(b), edge(c));
        let light = placing.view.light_on(normal, placing.view.side_of(normal));
        let colour = shaded(RIGID, light);
        raster.triangle(corners.map(|corner| placing.place(corner)), LAST, |_| {
            colour
        });
    }
}

/// Visible and hidden parts of lines, in pixels of the plot.
type SeenLines = [Vec<Vec<Spot>>; 2];

/// Returns the visible and the hidden parts of the lines on the body.
fn seen_lines(raster: &Raster, scene: &Scene, placing: &Placing) -> SeenLines {
    /// Length of the parts that are hidden or visible as a whole, and depth by which lines may lie below a face, in pixels.
    const PART: f64 = 2.0;
    const BELOW: f64 = 2.5;
    let mut seen: SeenLines = Default::default();
    for line in &scene.lines {
        let places: Vec<[f64; 3]> = line.iter().map(|place| placing.place(*place)).collect();
        let mut last = None;
        for pair in places.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            let parts = (length / PART).ceil().max(1.0);
            let at = |s: f64| -> [f64; 3] {
                std::array::from_fn(|c| from[c] + (to[c] - from[c]) * s / parts)
            };
            for k in 0..parts as usize {
                let (begin, end) = (at(k as f64), at(k as f64 + 1.0));
                let middle = at(k as f64 + 0.5);
                let hidden = !raster.is_visible(middle, BELOW / placing.per_metre);
                let kind = usize::from(hidden);
                if last != Some(kind) {
                    seen[kind].push(vec![(begin[0], begin[1])]);
                }
                last = Some(kind);
                if let Some(line) = seen[kind].last_mut() {
                    line.push((end[0], end[1]));
                }
            }
        }
    }
    seen
}

/// Draws lines on the body, the hidden ones dashed.
fn draw_lines(drawing: &mut Drawing, lines: SeenLines, area: Area, sizes: &Sizes) {
    let [visible, hidden] = lines.map(|lines| -> Vec<Vec<Spot>> {
        let moved = |(x, y): &Spot| (x + area.left, y + area.top);
        let lines = lines.iter().map(|line| line.iter().map(moved).collect());
        let lines = lines.flat_map(|line: Vec<Spot>| clipped(&line, area));
        lines.collect()
    });
    let width = sizes.line;
    let pen = Pen {
        width: 0.7 * width,
        colour: INK,
        dash: Some([3.0 * width, 3.5 * width]),
    };
    if !hidden.is_empty() {
        drawing.stroke(hidden, pen);
    }
    drawing.stroke_on_colours(visible, width);
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

#[cfg(test)]
mod tests {
    use super::*;

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
