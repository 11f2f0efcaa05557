//! Picture of the body at rest with its sets.

use std::collections::HashMap;
use std::path::Path;

use pericles::space::PointCloud;
use pericles_deck::{ALL, Model};
use pericles_io::{CellSize, FieldPicture, IoError};

use crate::build::{Assembly, Sets};
use crate::observers::{body_shape, cracks};

/// Height of a bar relative to its length: the picture has no second axis.
const STRIP: f64 = 0.08;

/// Draws the body at rest into a PNG or SVG file: points coloured by the sets that contain them, with a legend;
/// also pre-cracks and, on plane bodies, interfaces of materials and borders of refined parts.
///
/// # Errors
/// The file cannot be written.
pub fn draw_sets(
    model: &Model,
    assembly: &Assembly,
    path: impl AsRef<Path>,
) -> Result<(), IoError> {
    let cloud = &*assembly.cloud;
    let (classes, names) = classes(cloud.len(), &assembly.sets);
    let sizes: Vec<f64>;
    let cell = match (cloud.dimension(), cloud.lattice()) {
        (1, _) => CellSize::Block([cloud.spacing(), STRIP * length(cloud), 0.0]),
        (_, Some(_)) => CellSize::Uniform(cloud.spacing()),
        (_, None) => {
            sizes = (0..cloud.len()).map(|i| cloud.cell_size(i)).collect();
            CellSize::PerPoint(&sizes)
        }
    };
    let mut picture = FieldPicture::new(cloud.dimension(), cloud.positions(), &classes, cell)
        .label("Sets", "")
        .title(model.title.clone().unwrap_or_default())
        .categories(names);
    if let Some(surface) = &assembly.surface {
        picture = picture.triangles(surface.triangles());
    }
    let (sets, meshes) = (&assembly.sets, &assembly.meshes);
    if let Some(shape) = body_shape(model, cloud, sets, meshes, &cracks(assembly)) {
        let at_rest = vec![0.0; cloud.positions().len()];
        let drawn = shape.drawn(cloud, &at_rest, None, 1.0);
        picture = picture.polygons(drawn.polygons).lines(drawn.lines);
    }
    picture.write(path)
}

/// Returns a number per point for the sets that contain it, and the names of the numbers.
fn classes(points: usize, sets: &Sets) -> (Vec<f64>, Vec<String>) {
    let mut of_point = vec![Vec::new(); points];
    let named = sets.iter().filter(|(name, _)| name != ALL);
    for (name, members) in named {
        for &point in members {
            of_point[point as usize].push(name.as_str());
        }
    }
    let mut names = vec!["no set".to_owned()];
    let mut numbers = HashMap::from([(Vec::new(), 0)]);
    let classes = of_point.into_iter().map(|sets| {
        let label = sets.join(", ");
        let number = *numbers.entry(sets).or_insert_with(|| {
            names.push(label);
            names.len() - 1
        });
        number as f64
    });
    (classes.collect(), names)
}

fn length(cloud: &PointCloud) -> f64 {
    let x = cloud.axis(0).iter().copied();
    x.clone().fold(f64::NEG_INFINITY, f64::max) - x.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_several_sets_have_a_class_of_their_own() {
        let sets = vec![
            (ALL.to_owned(), vec![0, 1, 2, 3]),
            ("left".to_owned(), vec![0, 1]),
            ("top".to_owned(), vec![1, 2]),
        ];
        let (classes, names) = classes(4, &sets);
        let of_point: Vec<&str> = classes
            .iter()
            .map(|&k| names[k as usize].as_str())
            .collect();
        assert_eq!(of_point, ["left", "left, top", "top", "no set"]);
    }
}
