//! Content of pictures, read back from their files.

mod polygons;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use pericles_io::{Axis, CellSize, ColourMap, Curve, FieldPicture, IoError, LineChart};

struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

impl Picture {
    fn read(path: &Path) -> Self {
        let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        Self {
            width: info.width as usize,
            height: info.height as usize,
            rgb,
        }
    }

    fn at(&self, i: usize, j: usize) -> [u8; 3] {
        let at = 3 * (j * self.width + i);
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }

    /// Width and height of the bounding box of a colour, left of column `right`.
    fn extent(&self, colour: [u8; 3], right: usize) -> (usize, usize) {
        let (mut low, mut high) = ((usize::MAX, usize::MAX), (0, 0));
        for j in 0..self.height {
            for i in (0..right).filter(|&i| self.at(i, j) == colour) {
                low = (low.0.min(i), low.1.min(j));
                high = (high.0.max(i + 1), high.1.max(j + 1));
            }
        }
        assert!(high.0 > 0, "{colour:?} is not in the picture");
        (high.0 - low.0, high.1 - low.1)
    }

    /// Whether the border is white, so that nothing is clipped.
    fn border_is_white(&self) -> bool {
        let row = |j| (0..self.width).all(|i| self.at(i, j) == [255; 3]);
        let column = |i| (0..self.height).all(|j| self.at(i, j) == [255; 3]);
        (0..2)
            .all(|k| row(k) && row(self.height - 1 - k) && column(k) && column(self.width - 1 - k))
    }
}

/// Cell centres of a grid, component-major.
fn grid<const D: usize>(counts: [usize; D], edge: f64) -> Vec<f64> {
    let n: usize = counts.iter().product();
    (0..D)
        .flat_map(|c| {
            let stride: usize = counts[..c].iter().product();
            (0..n).map(move |i| (((i / stride) % counts[c]) as f64 + 0.5) * edge)
        })
        .collect()
}

fn draw(picture: &FieldPicture) -> Picture {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    picture.write(&path).unwrap();
    Picture::read(&path)
}

fn draw_chart(chart: &LineChart) -> Picture {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    chart.write(&path).unwrap();
    Picture::read(&path)
}

const BAR: usize = 1095; // pixels to the right may belong to the colour bar

#[test]
fn a_plate_is_drawn_without_gaps_to_scale_and_coloured_by_its_values() {
    let x = grid([40, 20], 1e-3);
    let values: Vec<f64> = (0..800)
        .map(|i| if i % 40 < 20 { 0.25 } else { 0.75 })
        .collect();
    let picture = draw(
        &FieldPicture::new(2, &x, &values, CellSize::Uniform(1e-3))
            .label("Damage", "")
            .range(0.0, 1.0),
    );
    let (left, right) = (
        ColourMap::Viridis.colour(0.25),
        ColourMap::Viridis.colour(0.75),
    );
    let (w1, h1) = picture.extent(left, BAR);
    let (w2, h2) = picture.extent(right, BAR);
    // each half is a square without gaps
    assert!(
        w1.abs_diff(h1) <= 3 && w2.abs_diff(h2) <= 3,
        "{w1} {h1} {w2} {h2}"
    );
    assert!(w1.abs_diff(w2) <= 2 && h1 == h2);
    let mut count = BTreeMap::new();
    for j in 0..picture.height {
        for i in 0..BAR {
            *count.entry(picture.at(i, j)).or_insert(0_usize) += 1;
        }
    }
    let full = w1 * h1;
    assert!(
        count[&left] > full - 2 * (w1 + h1),
        "{} of {full}",
        count[&left]
    );
    assert!(w1 > 350, "the body fills the picture");
}

#[test]
fn the_second_component_points_up() {
    let x = grid([10, 10], 1.0);
    let height: Vec<f64> = x[100..].to_vec();
    let picture = draw(&FieldPicture::new(2, &x, &height, CellSize::Uniform(1.0)).range(0.0, 10.0));
    let middle = picture.width / 3;
    let row = |colour| {
        (0..picture.height)
            .find(|&j| picture.at(middle, j) == colour)
            .unwrap()
    };
    let top = ColourMap::Viridis.colour(0.95);
    let bottom = ColourMap::Viridis.colour(0.05);
    assert!(row(top) < row(bottom));
}

#[test]
fn an_open_crack_is_white() {
    let (nx, ny) = (30, 20);
    let x = grid([nx, ny], 1e-3);
    let n = nx * ny;
    // the upper half moves up by a tenth of a cell: magnified by twenty, by two cells
    let u: Vec<f64> = (0..2 * n)
        .map(|k| if k >= n + n / 2 { 1e-4 } else { 0.0 })
        .collect();
    let values = vec![0.5; n];
    let plain = FieldPicture::new(2, &x, &values, CellSize::Uniform(1e-3)).range(0.0, 1.0);
    let colour = ColourMap::Viridis.colour(0.5);
    let gap = |picture: &Picture| {
        let column: Vec<_> = (0..picture.height).map(|j| picture.at(500, j)).collect();
        let first = column.iter().position(|&c| c == colour).unwrap();
        let last = column.iter().rposition(|&c| c == colour).unwrap();
        let white = column[first..last]
            .iter()
            .filter(|&&c| c == [255; 3])
            .count();
        white as f64 * 22.0 / (last - first) as f64 // in cells: 20 plus the opening
    };
    assert_eq!(gap(&draw(&plain)), 0.0);
    let open = gap(&draw(&plain.clone().displacement(&u, 20.0)));
    assert!((open - 2.0).abs() < 0.3, "{open}");
}

#[test]
fn points_without_a_value_are_grey_and_points_at_infinity_are_omitted() {
    let mut x = grid([10, 10], 1.0);
    let mut values = vec![0.5; 100];
    values[..50].fill(f64::NAN);
    x[99] = f64::INFINITY;
    let picture = draw(&FieldPicture::new(2, &x, &values, CellSize::Uniform(1.0)).range(0.0, 1.0));
    let (grey, green) = ([170; 3], ColourMap::Viridis.colour(0.5));
    let count = |colour| {
        let pixels = (0..picture.height).flat_map(|j| (0..BAR).map(move |i| (i, j)));
        pixels.filter(|&(i, j)| picture.at(i, j) == colour).count() as f64
    };
    // one of the 50 upper points is not drawn
    assert!((count(green) / count(grey) - 0.98).abs() < 0.01);

    let nowhere = vec![f64::NAN; 200];
    let lost = FieldPicture::new(2, &nowhere, &values, CellSize::Uniform(1.0));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    assert!(matches!(lost.write(&path), Err(IoError::Unsuitable { .. })));
    assert!(!path.exists());
}

#[test]
fn a_solid_shows_its_front_side_to_scale() {
    // 20 × 6 × 10 cells; the layer in front (small y) has a different value
    let x = grid([20, 6, 10], 1.0);
    let n = 1200;
    let values: Vec<f64> = x[n..2 * n]
        .iter()
        .map(|&y| if y < 1.0 { 0.2 } else { 0.8 })
        .collect();
    let picture = |view| {
        draw(
            &FieldPicture::new(3, &x, &values, CellSize::Uniform(1.0))
                .range(0.0, 1.0)
                .view(view),
        )
    };
    let (front, back) = (
        ColourMap::Viridis.colour(0.2),
        ColourMap::Viridis.colour(0.8),
    );
    let from_front = picture([0.0, -1.0, 0.0]);
    let (w, h) = from_front.extent(front, BAR);
    assert!((w as f64 / h as f64 - 2.0).abs() < 0.02, "{w} {h}");
    assert!((0..from_front.height).all(|j| from_front.at(from_front.width / 3, j) != back));
    let from_behind = picture([0.0, 1.0, 0.0]);
    let (w, h) = from_behind.extent(back, BAR);
    assert!((w as f64 / h as f64 - 2.0).abs() < 0.02, "{w} {h}");
}

#[test]
fn nothing_is_clipped_for_any_size_and_shape_of_body() {
    let long = "A very long title of a picture, longer than any title that is expected in practice, to test that it fits";
    for counts in [[1, 1], [200, 2], [2, 200], [30, 30]] {
        for edge in [3e-9, 0.7e-3, 123.0] {
            let x = grid(counts, edge);
            let values: Vec<f64> = x[x.len() / 2..].iter().map(|y| 1e9 * (y - edge)).collect();
            let picture = draw(
                &FieldPicture::new(2, &x, &values, CellSize::Uniform(edge))
                    .label("Strain energy density of the deformed body", "J/m³")
                    .colours(ColourMap::Diverging)
                    .title(long)
                    .time(46e-6)
                    .width(400),
            );
            assert!(picture.border_is_white(), "{counts:?} {edge}");
            assert!((80..800).contains(&picture.height), "{}", picture.height);
        }
    }
    for view in [[0.5, -1.0, 0.6], [0.0, 0.0, 1.0], [-1.0, 0.0, -0.3]] {
        for counts in [[3, 3, 3], [60, 2, 2], [2, 2, 60]] {
            let x = grid(counts, 2e-3);
            let values = vec![1e-7; x.len() / 3];
            let sizes = vec![2e-3; values.len()];
            let picture = draw(
                &FieldPicture::new(3, &x, &values, CellSize::PerPoint(&sizes))
                    .label("Displacement", "m")
                    .title(long)
                    .time(1.5)
                    .view(view)
                    .width(400),
            );
            assert!(picture.border_is_white(), "{counts:?} {view:?}");
        }
    }
    for (scale, width) in [(1e-7, 500), (1.0, 1200), (4e8, 300)] {
        let x: Vec<f64> = (0..50).map(|k| f64::from(k) * scale).collect();
        let y: Vec<f64> = x.iter().map(|x| x * x - 100.0 * scale).collect();
        let linear = LineChart::new(Axis::new("time", "s"), Axis::new("a quantity", "kg m²"));
        let logarithmic = LineChart::new(
            Axis::new("dx", "m").logarithmic(),
            Axis::new("error", "").logarithmic(),
        );
        for chart in [linear, logarithmic] {
            let chart = chart
                .title(long)
                .time(3.0)
                .curve(
                    Curve::line("a curve with a long name that fills the key", &x, &y)
                        .with_markers(),
                )
                .curve(Curve::points("b", &y, &x))
                .width(width);
            assert!(draw_chart(&chart).border_is_white(), "{scale}");
        }
    }
}

#[test]
fn the_curve_of_a_bar_does_not_depend_on_the_order_of_points() {
    let x: Vec<f64> = (0..100).map(|i| f64::from((i * 37) % 100) * 1e-3).collect();
    let u: Vec<f64> = x.iter().map(|x| 1e-6 * (60.0 * x).sin()).collect();
    let mixed = FieldPicture::new(1, &x, &u, CellSize::Uniform(1e-3)).label("Displacement", "m");
    let sorted: Vec<f64> = (0..100).map(|i| f64::from(i) * 1e-3).collect();
    let v: Vec<f64> = sorted.iter().map(|x| 1e-6 * (60.0 * x).sin()).collect();
    let ordered =
        FieldPicture::new(1, &sorted, &v, CellSize::Uniform(1e-3)).label("Displacement", "m");
    let (a, b) = (draw(&mixed), draw(&ordered));
    assert!(a.rgb == b.rgb);
    assert!(a.extent([0, 114, 178], a.width).0 > 800);
}

#[test]
fn a_symmetric_displacement_of_a_bar_is_drawn_symmetrically() {
    // The displacement is as large as the pulse is wide: over displaced positions the curve would lean over.
    let x: Vec<f64> = (0..101).map(|i| f64::from(i) * 0.1 - 5.0).collect();
    let u: Vec<f64> = x.iter().map(|x| (-x * x).exp()).collect();
    let picture = FieldPicture::new(1, &x, &u, CellSize::Uniform(0.1)).label("Displacement", "m");
    let (at_rest, displaced) = (draw(&picture), draw(&picture.clone().displacement(&u, 3.0)));
    assert!(at_rest.rgb == displaced.rgb);
}

#[test]
fn equal_data_give_equal_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let x = grid([20, 20], 1.0);
    let bytes = |name: &str| {
        let path = folder.path().join(name);
        let picture = FieldPicture::new(2, &x, &x[..400], CellSize::Block([1.0, 1.0, 1.0]));
        picture.title("same").write(&path).unwrap();
        std::fs::read(path).unwrap()
    };
    assert_eq!(bytes("a.png"), bytes("other.png"));
}

#[test]
fn a_window_fixes_the_axes_of_a_series() {
    let x = grid([10, 10], 1.0);
    let far: Vec<f64> = vec![30.0; 200];
    let values = vec![0.5; 100];
    let series = FieldPicture::new(2, &x, &values, CellSize::Uniform(1.0))
        .range(0.0, 1.0)
        .window([0.0; 3], [20.0; 3]);
    let (first, later) = (draw(&series), draw(&series.clone().displacement(&far, 1.0)));
    assert_eq!((first.width, first.height), (later.width, later.height));
    let colour = ColourMap::Viridis.colour(0.5);
    assert!(first.extent(colour, 900).0 > 100);
    // outside the window: nothing is drawn, neither in the plot nor beside it
    assert!((0..later.height).all(|j| (0..900).all(|i| later.at(i, j) != colour)));
    assert!(later.border_is_white());
}

#[test]
fn curves_are_drawn_at_their_values() {
    let colour = [200, 0, 0];
    let axes = || {
        LineChart::new(
            Axis::new("x", "").range(0.0, 1.0),
            Axis::new("y", "").range(0.0, 4.0),
        )
    };
    let rows = |chart: LineChart| {
        let picture = draw_chart(&chart);
        let rows: Vec<usize> = (0..picture.height)
            .filter(|&j| (0..picture.width).any(|i| picture.at(i, j) == colour))
            .collect();
        (rows[0] + rows[rows.len() - 1]) as f64 / 2.0
    };
    let level = |y: f64| rows(axes().curve(Curve::line("", &[0.0, 1.0], &[y, y]).colour(colour)));
    let (one, two, three) = (level(1.0), level(2.0), level(3.0));
    assert!(one > two && two > three);
    assert!(
        ((one - two) - (two - three)).abs() <= 1.0,
        "{one} {two} {three}"
    );

    // on a logarithmic axis equal ratios have equal distances
    let level = |y: f64| {
        let axes = LineChart::new(
            Axis::new("x", ""),
            Axis::new("y", "").logarithmic().range(1e-3, 1e3),
        );
        rows(axes.curve(Curve::line("", &[0.0, 1.0], &[y, y]).colour(colour)))
    };
    let (a, b, c) = (level(1e-2), level(1.0), level(1e2));
    assert!(((a - b) - (b - c)).abs() <= 1.0, "{a} {b} {c}");
}

#[test]
fn curves_stay_inside_their_axes_and_are_interrupted_at_missing_values() {
    let colour = [200, 0, 0];
    let x: Vec<f64> = (0..=100).map(f64::from).collect();
    let mut y: Vec<f64> = x.iter().map(|x| 50.0 * (x / 5.0).sin()).collect();
    let chart = |y: &[f64]| {
        draw_chart(
            &LineChart::new(Axis::new("x", ""), Axis::new("y", "").range(-10.0, 10.0))
                .curve(Curve::line("wild", &x, y).colour(colour)),
        )
    };
    let wild = chart(&y);
    let (_, height) = wild.extent(colour, wild.width);
    let frame = wild.extent([38; 3], wild.width);
    assert!(height <= frame.1);
    assert!(wild.border_is_white());

    y.fill(0.0);
    y[40..60].fill(f64::NAN);
    let gap = chart(&y);
    let row = (0..gap.height)
        .max_by_key(|&j| (0..gap.width).filter(|&i| gap.at(i, j) == colour).count())
        .unwrap();
    let inked: Vec<usize> = (0..gap.width)
        .filter(|&i| gap.at(i, row) == colour)
        .collect();
    let widest = inked
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .max()
        .unwrap();
    let whole = inked[inked.len() - 1] - inked[0];
    // 21 of 100 values are missing
    assert!(
        (widest as f64 / whole as f64 - 0.21).abs() < 0.01,
        "{widest} {whole}"
    );
}

#[test]
fn an_empty_chart_has_its_axes() {
    let none = draw_chart(&LineChart::new(
        Axis::new("time", "s"),
        Axis::new("energy", "J"),
    ));
    assert!(none.extent([38; 3], none.width).0 > 1000);
    let axes = (
        Axis::new("h", "m").logarithmic(),
        Axis::new("error", "").logarithmic(),
    );
    let negative = Curve::points("", &[-1.0, 0.0], &[1.0, f64::NAN]);
    draw_chart(&LineChart::new(axes.0, axes.1).curve(negative));
}

#[test]
fn inconsistent_data_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let x = grid([4, 4], 1.0);
    let values = vec![0.0; 16];
    let cell = CellSize::Uniform(1.0);
    let good = || FieldPicture::new(2, &x, &values, cell);
    for bad in [
        FieldPicture::new(0, &x, &values, cell),
        FieldPicture::new(2, &x, &values[..7], cell),
        FieldPicture::new(2, &x, &values, CellSize::PerPoint(&values[..3])),
        FieldPicture::new(2, &[], &[], cell),
        good().displacement(&values, 1.0),
        good().width(20),
        good().width(100_000),
        good().view([0.0; 3]),
        good().window([1.0; 3], [0.0; 3]),
    ] {
        let error = bad.write(&path).unwrap_err();
        assert!(!error.is_output_problem(), "{error}");
    }
    let chart = || LineChart::new(Axis::new("x", ""), Axis::new("y", ""));
    let uneven = chart().curve(Curve::line("", &[1.0, 2.0], &[1.0]));
    assert!(matches!(uneven.write(&path), Err(IoError::Shape { .. })));
    assert!(chart().size(1, 1).write(&path).is_err());
    let nowhere = folder.path().join("none").join("a.png");
    assert!(good().write(nowhere).unwrap_err().is_output_problem());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
