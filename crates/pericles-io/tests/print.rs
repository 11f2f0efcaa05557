//! Pictures with a size on paper: text in points, resolution, transparent backgrounds, regions.

use std::fs;
use std::io::BufReader;
use std::path::Path;

use pericles_io::{
    Axis, CellSize, ColourMap, Curve, FieldPicture, IoError, LineChart, PictureStyle, Print,
};

/// A column of a journal: 88 mm, text of 8 points, 600 pixels per inch.
fn column() -> PictureStyle {
    let print = Print {
        font_size: 8.0,
        dpi: 600.0,
    };
    PictureStyle::printed(88e-3, print)
}

/// A chart of two curves, of which the first one fills the plot.
fn chart(is_full: bool) -> LineChart {
    let x: Vec<f64> = (0..200).map(f64::from).collect();
    let wave: Vec<f64> = x
        .iter()
        .map(|x| if is_full { (0.9 * x).sin() } else { 0.0 })
        .collect();
    let ramp: Vec<f64> = x.iter().map(|x| 0.005 * x).collect();
    LineChart::new(Axis::new("time", "s"), Axis::new("force", "N"))
        .title("A title that is longer than the width of a column of a journal allows")
        .curve(Curve::line("kinetic energy", &x, &wave))
        .curve(Curve::line("external work", &x, &ramp))
}

/// A plate of 40 × 20 cells of 1 mm with a line along its middle.
fn plate<'a>(positions: &'a [f64], values: &'a [f64]) -> FieldPicture<'a> {
    FieldPicture::new(2, positions, values, CellSize::Uniform(1e-3))
        .label("Strain_Energy_Density", "J/m³")
        .title("A plate")
        .time(1e-6)
        .lines(vec![vec![[0.0, 0.01, 0.0], [0.04, 0.01, 0.0]]])
}

fn positions() -> (Vec<f64>, Vec<f64>) {
    let place = |k: usize| (k as f64 + 0.5) * 1e-3;
    let x = (0..800).map(|i| place(i % 40));
    let positions = x.chain((0..800).map(|i| place(i / 40))).collect();
    (positions, (0..800).map(f64::from).collect())
}

fn svg(write: impl Fn(&Path) -> Result<(), IoError>) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.svg");
    write(&path).unwrap();
    fs::read_to_string(path).unwrap()
}

/// Returns the numbers of an attribute.
fn numbers(svg: &str, attribute: &str) -> Vec<f64> {
    let start = format!(" {attribute}=\"");
    let found = svg.split(&start).skip(1);
    found
        .filter_map(|rest| rest.split('"').next()?.parse().ok())
        .collect()
}

#[test]
fn all_text_has_the_given_size_and_lines_are_in_proportion() {
    let (places, values) = positions();
    let pictures = [
        svg(|path| chart(true).style(column()).write(path)),
        svg(|path| plate(&places, &values).style(column()).write(path)),
    ];
    for svg in &pictures {
        assert!(svg.contains("width=\"88.01mm\""), "{}", &svg[..200]);
        let sizes = numbers(svg, "font-size");
        // 8 points are 66.67 pixels.
        assert!(
            sizes.len() > 8 && sizes.iter().all(|size| *size == 66.67),
            "{sizes:?}"
        );
    }
    // Curves of one point.
    let widths = numbers(&pictures[0], "stroke-width");
    assert!(widths.iter().all(|width| *width == 8.33), "{widths:?}");
    assert!(
        pictures[0].contains(">A title that is longer"),
        "{}",
        pictures[0]
    );
    assert!(!pictures[0].contains("journal allows"));
    let untitled = PictureStyle {
        titled: false,
        ..column()
    };
    for svg in [
        svg(|path| chart(true).style(untitled).write(path)),
        svg(|path| plate(&places, &values).style(untitled).write(path)),
    ] {
        assert!(!svg.contains(">A ") && !svg.contains(">t = "));
    }
}

#[test]
fn a_legend_that_would_cover_curves_is_above_the_plot() {
    let height = |svg: &str| -> f64 {
        let text = svg.split("viewBox=\"0 0 2079 ").nth(1).unwrap();
        text.split('"').next().unwrap().parse().unwrap()
    };
    let full = svg(|path| chart(true).style(column()).write(path));
    assert!(
        height(&full) > 1299.0 && !full.contains("fill-opacity"),
        "{full}"
    );
    for name in ["kinetic energy", "external work"] {
        assert!(full.contains(&format!(">{name}<")), "{name}");
    }
    let free = svg(|path| chart(false).style(column()).write(path));
    assert!(
        height(&free) == 1299.0 && free.contains("fill-opacity"),
        "{free}"
    );
}

#[test]
fn files_have_their_resolution_and_transparent_ones_no_background() {
    let folder = tempfile::tempdir().unwrap();
    let (places, values) = positions();
    let read = |style: PictureStyle| {
        let path = folder.path().join("a.png");
        plate(&places, &values).style(style).write(&path).unwrap();
        let decoder = png::Decoder::new(BufReader::new(fs::File::open(path).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let dimensions = reader.info().pixel_dims;
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        (bytes, info.color_type, dimensions.map(|pixels| pixels.xppu))
    };
    let (white, kind, resolution) = read(column());
    assert_eq!((kind, resolution), (png::ColorType::Rgb, Some(23_622)));
    let transparent = PictureStyle {
        transparent: true,
        ..column()
    };
    let (clear, kind, _) = read(transparent);
    assert_eq!(kind, png::ColorType::Rgba);
    assert_eq!(clear[..4], [0; 4]);
    // On white, it is the picture with a white background.
    let mut opaque = 0;
    for (pixel, expected) in clear.chunks_exact(4).zip(white.chunks_exact(3)) {
        let opacity = f64::from(pixel[3]) / 255.0;
        for c in 0..3 {
            let mixed = f64::from(pixel[c]) * opacity + 255.0 * (1.0 - opacity);
            assert!(
                (mixed - f64::from(expected[c])).abs() < 2.0,
                "{pixel:?} {expected:?}"
            );
        }
        opaque += usize::from(pixel[3] == 255);
    }
    assert!(opaque > clear.len() / 16, "{opaque}");
    let svg = svg(|path| plate(&places, &values).style(transparent).write(path));
    assert!(!svg.contains("fill=\"#ffffff\""));
}

#[test]
fn a_region_of_the_body_is_shown_without_lines_beyond_it() {
    let (places, values) = positions();
    let cropped = plate(&places, &values)
        .window([0.01, 0.005, 0.0], [0.02, 0.015, 0.0])
        .style(column());
    let svg = svg(|path| cropped.write(path));
    let path = svg.split("<path d=\"M").nth(1).unwrap();
    let path = path.split('"').next().unwrap();
    let x: Vec<f64> = path
        .split('L')
        .map(|place| place.split(',').next().unwrap().parse().unwrap())
        .collect();
    let frame = svg.split("<image x=\"").nth(1).unwrap();
    let number = |text: &str| -> f64 { text.split('"').next().unwrap().parse().unwrap() };
    let (left, width) = (
        number(frame),
        number(frame.split("width=\"").nth(1).unwrap()),
    );
    assert!(
        x.iter().all(|x| (left..=left + width).contains(x)),
        "{x:?} {left} {width}"
    );
    assert!(x.last().unwrap() - x[0] > 0.99 * width, "{x:?} {width}");
}

#[test]
fn colour_maps_and_widths_are_checked() {
    let (places, values) = positions();
    let grey = PictureStyle {
        colours: Some(ColourMap::Grey),
        ..column()
    };
    let svg = svg(|path| plate(&places, &values).style(grey).write(path));
    let fills: Vec<&str> = svg
        .split("fill=\"#")
        .skip(1)
        .map(|rest| &rest[..6])
        .collect();
    assert!(fills.len() > 100);
    assert!(
        fills
            .iter()
            .all(|fill| fill[..2] == fill[2..4] && fill[..2] == fill[4..])
    );
    let folder = tempfile::tempdir().unwrap();
    let narrow = PictureStyle::printed(5e-3, Print::default());
    let error = chart(true).style(narrow).write(folder.path().join("a.pdf"));
    let error = error.unwrap_err().to_string();
    assert!(error.contains("the width is 5.0 mm"), "{error}");
}
