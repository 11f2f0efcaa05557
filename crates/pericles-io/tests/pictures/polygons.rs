//! Cells of meshes and faces of solids.

use std::collections::BTreeMap;

use pericles_io::{CellSize, ColourMap, FieldPicture, IoError, PictureStyle, Polygon, Polygons};

use super::{BAR, Picture, draw};

/// Triangles of a sheared square with sides 1, one value for each.
fn sheared_square(parts: usize) -> (Vec<f64>, Polygons) {
    let h = 1.0 / parts as f64;
    let place = |i: usize, j: usize| [h * i as f64 + 0.4 * h * j as f64, h * j as f64, 0.0];
    let mut all = Vec::new();
    for j in 0..parts {
        for i in 0..parts {
            let [a, b] = [place(i, j), place(i + 1, j)];
            let [c, d] = [place(i + 1, j + 1), place(i, j + 1)];
            for corners in [[a, b, c, c], [a, c, d, d]] {
                all.push(Polygon {
                    corners,
                    point: all.len() as u32,
                });
            }
        }
    }
    let centre = |polygon: &Polygon, c: usize| {
        let [a, b, d, _] = polygon.corners;
        (a[c] + b[c] + d[c]) / 3.0
    };
    let x = (0..2).flat_map(|c| all.iter().map(move |polygon| centre(polygon, c)));
    let x: Vec<f64> = x.collect();
    let has_cell = vec![true; all.len()];
    (x, Polygons { all, has_cell })
}

#[test]
fn cells_of_a_mesh_fill_their_outline_and_nothing_else() {
    let (x, polygons) = sheared_square(12);
    let values = vec![0.5; x.len() / 2];
    let picture = FieldPicture::new(2, &x, &values, CellSize::Uniform(0.05)).range(0.0, 1.0);
    let picture = draw(&picture.polygons(polygons));
    let colour = ColourMap::Viridis.colour(0.5);
    let (width, height) = picture.extent(colour, BAR);
    assert!(
        (width as f64 / height as f64 - 1.4).abs() < 0.01,
        "{width} {height}"
    );
    let row = |j| (0..BAR).filter(|&i| picture.at(i, j) == colour).collect();
    let rows: Vec<Vec<usize>> = (0..picture.height).map(row).collect();
    let rows: Vec<&Vec<usize>> = rows.iter().filter(|row| row.len() > 5).collect();
    assert!(rows.len().abs_diff(height) <= 2);
    for row in &rows {
        // Without gaps, as wide as the square, and leaning to the right.
        assert_eq!(row[row.len() - 1] - row[0] + 1, row.len());
        assert!((row.len() as f64 / height as f64 - 1.0).abs() < 0.01);
    }
    let lean = rows[0][0] - rows[rows.len() - 1][0];
    assert!((lean as f64 / height as f64 - 0.4).abs() < 0.01, "{lean}");
}

#[test]
fn edges_are_drawn_on_request() {
    let (x, polygons) = sheared_square(4);
    let values = vec![0.5; x.len() / 2];
    let picture = FieldPicture::new(2, &x, &values, CellSize::Uniform(0.05))
        .range(0.0, 1.0)
        .polygons(polygons);
    let style = PictureStyle {
        edges: true,
        ..Default::default()
    };
    let [plain, lined] = [draw(&picture), draw(&picture.clone().style(style))];
    let colour = ColourMap::Viridis.colour(0.5);
    let row = plain.height / 2;
    let inside: Vec<usize> = (0..BAR).filter(|&i| plain.at(i, row) == colour).collect();
    let inside = inside[4]..inside[inside.len() - 4];
    let dark = |i: usize| lined.at(i, row)[1] < colour[1] - 40;
    let starts = inside.filter(|&i| dark(i) && !dark(i - 1)).count();
    // Five sides along the shear less the outer two, four diagonals.
    assert!((6..=8).contains(&starts), "{starts}");
}

/// A cube with sides 1 whose faces across the axes have the values 0 to 5.
fn cube() -> (Vec<f64>, Polygons) {
    let mut all = Vec::new();
    for axis in 0..3 {
        for end in [0.0, 1.0] {
            let corner = |s: f64, t: f64| {
                let mut x = [end; 3];
                x[(axis + 1) % 3] = s;
                x[(axis + 2) % 3] = t;
                x
            };
            all.push(Polygon {
                corners: [
                    corner(0.0, 0.0),
                    corner(1.0, 0.0),
                    corner(1.0, 1.0),
                    corner(0.0, 1.0),
                ],
                point: all.len() as u32,
            });
        }
    }
    let has_cell = vec![true; 6];
    (vec![0.5; 18], Polygons { all, has_cell })
}

#[test]
fn faces_turned_away_are_hidden_and_the_others_differ_in_shade() {
    let (x, polygons) = cube();
    // Each face in turn has another value than the others.
    let mut shades = Vec::new();
    for face in 0..6 {
        let values: Vec<f64> = (0..6)
            .map(|k| if k == face { 0.3 } else { f64::NAN })
            .collect();
        let picture = FieldPicture::new(3, &x, &values, CellSize::Uniform(1.0))
            .range(0.0, 1.0)
            .polygons(polygons.clone())
            .view([2.0, -3.0, 1.0]);
        let picture = draw(&picture);
        let blue = |[r, _, b]: [u8; 3]| b > r.saturating_add(30);
        let pixels = (0..picture.height).flat_map(|j| (0..BAR).map(move |i| (i, j)));
        let seen: Vec<[u8; 3]> = pixels
            .map(|(i, j)| picture.at(i, j))
            .filter(|c| blue(*c))
            .collect();
        // Upper faces of x, z; the lower one of y.
        let faces_the_viewer = [1, 2, 5].contains(&face);
        // The axis directions have a blue line.
        assert_eq!(
            seen.len() > 5000,
            faces_the_viewer,
            "face {face}: {}",
            seen.len()
        );
        if faces_the_viewer {
            let mut counts = BTreeMap::new();
            seen.into_iter()
                .for_each(|c| *counts.entry(c).or_insert(0) += 1);
            let (colour, _) = counts.into_iter().max_by_key(|(_, count)| *count).unwrap();
            shades.push(colour);
        }
    }
    let difference = |a: [u8; 3], b: [u8; 3]| (0..3).map(|k| a[k].abs_diff(b[k])).max();
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        assert!(difference(shades[a], shades[b]) > Some(8), "{shades:?}");
    }
}

#[test]
fn the_silhouette_of_a_stretched_cube_has_its_area() {
    let (x, mut polygons) = cube();
    for corner in polygons
        .all
        .iter_mut()
        .flat_map(|polygon| &mut polygon.corners)
    {
        corner[0] *= 3.0;
    }
    let values = vec![0.3; 6];
    let picture = FieldPicture::new(3, &x, &values, CellSize::Uniform(1.0)).range(0.0, 1.0);
    let drawn = |view| draw(&picture.clone().polygons(polygons.clone()).view(view));
    let count = |picture: &Picture| {
        let blue = |[r, _, b]: [u8; 3]| b > r.saturating_add(30);
        let above = picture.height - 150;
        let pixels = (0..above).flat_map(|j| (0..BAR).map(move |i| (i, j)));
        pixels.filter(|&(i, j)| blue(picture.at(i, j))).count() as f64
    };
    // Three by one from the front; obliquely the projected areas of three faces.
    let front = drawn([0.0, -1.0, 0.0]);
    let colour = ColourMap::Viridis.colour(0.3);
    let (width, height) = front.extent(colour, BAR);
    assert!((count(&front) / (width * height) as f64 - 1.0).abs() < 0.01);
    assert!(
        (width as f64 / height as f64 - 3.0).abs() < 0.02,
        "{width} {height}"
    );
    let oblique = drawn([1.0, -1.0, 0.0]);
    // (3 + 1) / √2 wide, of height 1.
    let wide = 4.0 / 2_f64.sqrt();
    let scale = (0..oblique.height)
        .map(|j| (0..BAR).filter(|&i| oblique.at(i, j) != [255; 3]).count())
        .max()
        .unwrap() as f64
        / wide;
    assert!((count(&oblique) / (wide * scale * scale) - 1.0).abs() < 0.02);
}

#[test]
fn hidden_lines_are_dashed() {
    let (x, polygons) = cube();
    let values = vec![f64::NAN; 6];
    let picture = FieldPicture::new(3, &x, &values, CellSize::Uniform(1.0)).polygons(polygons);
    let ink = |y: f64| {
        let line = vec![[0.1, y, 0.5], [0.9, y, 0.5]];
        let picture = picture.clone().lines(vec![line]).view([0.0, -1.0, 0.0]);
        let picture = draw(&picture);
        let dark = |[r, g, b]: [u8; 3]| r < 90 && g < 90 && b < 90;
        let row = |j: usize| (100..BAR - 150).filter(|&i| dark(picture.at(i, j))).count();
        let rows = picture.height / 4..picture.height / 2 + 100;
        rows.map(row).max().unwrap()
    };
    let (visible, hidden) = (ink(0.0), ink(1.0));
    assert!(
        hidden > 100 && 3 * hidden < 2 * visible,
        "{hidden} of {visible}"
    );
}

#[test]
fn polygons_of_points_that_do_not_exist_are_rejected() {
    let (x, polygons) = cube();
    let picture = FieldPicture::new(3, &x[..3], &[0.0], CellSize::Uniform(1.0)).polygons(polygons);
    let folder = tempfile::tempdir().unwrap();
    let written = picture.write(folder.path().join("a.png"));
    assert!(
        matches!(written, Err(IoError::Unsuitable { .. })),
        "{written:?}"
    );
}
