//! Picture of a plane body with axes.

use super::clip::clipped;
use super::drawing::{Drawing, Spot};
use super::frame::{Area, AxisText, ColourBar, Frame, Scale, Sizes};
use super::polygon;
use super::raster::Raster;
use super::scene::Scene;
use super::ticks::Ticks;
use pericles::units::Shown;

/// White space around the body, as a fraction of its larger side.
const MARGIN: f64 = 0.03;

/// Bounds of the ratio of plot height to picture width; a slender body is surrounded by white space.
const FLATTEST: f64 = 0.16;
const TALLEST: f64 = 1.1;

/// Subpixels per pixel and direction, see [`Raster`].
const FINE: usize = 2;

pub(super) fn draw(scene: &Scene) -> Drawing {
    let sizes = Sizes::of(&scene.style);
    let width = f64::from(scene.style.width);
    let (bw, bh) = (scene.high[0] - scene.low[0], scene.high[1] - scene.low[1]);
    let largest = bw.max(bh).max(f64::MIN_POSITIVE);
    let shown = Shown::for_size(largest, scene.length_unit);
    let margin = MARGIN * largest;
    let (ew, eh) = (bw + 2.0 * margin, bh + 2.0 * margin);

    // A first guess of the space for the labels.
    let (mut left, mut right) = (100.0 * width / 1200.0, 130.0 * width / 1200.0);
    let mut height = 0.0;
    let mut y_ticks = Ticks::default();
    let mut bar_ticks = Ticks::default();
    let middle = |c: usize| 0.5 * (scene.low[c] + scene.high[c]);
    let scale = |c: usize, pixels: f64, per_metre: f64| Scale {
        low: (middle(c) - 0.5 * pixels / per_metre) / shown.factor,
        high: (middle(c) + 0.5 * pixels / per_metre) / shown.factor,
        logarithmic: false,
    };
    for _ in 0..sizes.rounds() {
        let plot = width - left - right;
        height = (plot * eh / ew)
            .clamp(FLATTEST * width, TALLEST * width)
            .round();
        let per_metre = (plot / ew).min(height / eh);
        let wanted = (height / sizes.tick_room(4.0, 2.2)).clamp(2.0, 8.0) as usize;
        if !scene.is_strip {
            y_ticks = scale(1, height, per_metre).ticks(wanted);
        }
        bar_ticks = scene.bar.ticks(height, &sizes);
        left = sizes.beside(&y_ticks).round();
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
    let frame = Frame {
        area,
        x: scale(0, area.width(), per_metre),
        y: scale(1, height, per_metre),
    };

    let mut raster = Raster::new(area.width() as usize, height as usize, FINE);
    for cell in &scene.cells {
        let (x, y) = frame.place(cell.middle[0] / shown.factor, cell.middle[1] / shown.factor);
        let half = (cell.half[0] * per_metre, cell.half[1] * per_metre);
        raster.cell((x - left, y - top), half, cell.colour);
    }
    let place = |p: [f64; 3]| {
        let (x, y) = frame.place(p[0] / shown.factor, p[1] / shown.factor);
        [x - left, y - top, 0.0]
    };
    let edges = scene.style.edges.then_some(sizes.line);
    polygon::draw(&mut raster, &scene.polygons, place, None, edges);
    let mut drawing = Drawing::new(&scene.style, (area.bottom + sizes.below()).ceil() as usize);
    drawing.cells(raster, left as usize, top as usize);
    let lines = scene.lines.iter().map(|line| {
        let place = |p: &[f64; 3]| frame.place(p[0] / shown.factor, p[1] / shown.factor);
        line.iter().map(place).collect::<Vec<Spot>>()
    });
    let lines: Vec<Vec<Spot>> = lines.flat_map(|line| clipped(&line, area)).collect();
    drawing.stroke_on_colours(lines, sizes.line);

    let x = AxisText {
        ticks: frame
            .x
            .ticks((area.width() / sizes.tick_room(6.0, 4.0)).max(2.0) as usize),
        label: shown.label("x"),
    };
    let y = AxisText {
        ticks: y_ticks,
        label: match scene.is_strip {
            true => String::new(),
            false => shown.label("y"),
        },
    };
    frame.draw_axes(&mut drawing, &x, &y, &sizes);
    scene.bar.draw(&mut drawing, area, &bar_ticks, &sizes);
    scene
        .header
        .draw(&mut drawing, left, width - sizes.gap, &sizes);
    drawing
}
