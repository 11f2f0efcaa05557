//! The layers of a plate, in which the y extension acts on all fields that the x extension makes.

use pericles::space::Face;

use super::force::LayerForce;
use super::layer::Layer;
use super::plate::{Line, Step};
use super::sides::{OpenOptions, OpenSides};
use super::weights::LatticeWeights;

/// A layer with its place.
pub(super) struct PlacedLayer {
    pub(super) axis: usize,
    pub(super) end: usize,
    pub(super) layer: Layer,
    pub(super) force: LayerForce,
    /// Number of its first stretched shift among the fields along x.
    pub(super) first_field: usize,
}

/// Value of a stretched shift of the layers normal to x, by the number of its field.
pub(super) fn stretched(layers: &[PlacedLayer], field: usize, component: usize, row: usize) -> f64 {
    let mut layers = layers.iter().rev();
    let placed = layers.find(|placed| placed.first_field <= field);
    placed.map_or(
        0.0,
        |PlacedLayer {
             layer, first_field, ..
         }| {
            match field - first_field {
                number if number < layer.extended() => layer.stretched(number, component, row),
                _ => 0.0,
            }
        },
    )
}

/// Makes the layers of the open sides at rest.
pub(super) fn layers_of(
    sides: &OpenSides,
    lines: &[Line; 2],
    weights: &LatticeWeights,
    (options, speed): (OpenOptions, f64),
) -> Vec<PlacedLayer> {
    let reach = weights.reach();
    let rates = |cells: usize| -> Vec<f64> {
        options
            .profile(cells)
            .iter()
            .map(|sigma| sigma * speed)
            .collect()
    };
    let mut layers: Vec<PlacedLayer> = Vec::new();
    let mut fields = 0;
    for (Face { axis, upper }, cells) in sides.open_sides() {
        let end = usize::from(upper);
        let lanes = if axis == 0 {
            lines[1].nodes
        } else {
            lines[0].nodes + fields
        };
        let layer = Layer::new(reach, &rates(cells), options.decay * speed, (2, lanes));
        let force = if axis == 0 {
            let far = |y: &usize| !lines[1].is_near(*y, reach - 1);
            let rows: Vec<usize> = (0..lines[1].nodes).filter(far).collect();
            let targets = match (rows.first(), rows.last()) {
                (Some(first), Some(last)) => *first..last + 1,
                _ => 0..0,
            };
            let lane = |y: usize, shift: isize| match lines[1].step(y, shift) {
                Step::Node(y) => Some(y),
                Step::Beyond | Step::Nothing => None,
            };
            LayerForce::new(&layer, (axis, end), weights, targets, lane)
        } else {
            let lane = |x: usize, shift: isize| field_of(&layers, &lines[0], reach, x, shift);
            LayerForce::new(&layer, (axis, end), weights, 0..lines[0].nodes, lane)
        };
        let first_field = fields;
        if axis == 0 {
            fields += layer.extended();
        }
        layers.push(PlacedLayer {
            axis,
            end,
            layer,
            force,
            first_field,
        });
    }
    layers
}

/// The field that node x sees at a shift along x: a column of nodes, or a stretched shift of a layer normal to x.
fn field_of(
    layers: &[PlacedLayer],
    line: &Line,
    reach: usize,
    x: usize,
    shift: isize,
) -> Option<usize> {
    for PlacedLayer {
        axis,
        end,
        layer,
        first_field,
        ..
    } in layers
    {
        let depth = line
            .depth(*end, x)
            .filter(|depth| *axis == 0 && *depth > -(reach as isize));
        let outwards = if *end == 0 { -shift } else { shift };
        if let Some(number) = depth.and_then(|depth| layer.number(depth, outwards)) {
            return Some(line.nodes + first_field + number);
        }
    }
    match line.step(x, shift) {
        Step::Node(x) => Some(x),
        Step::Beyond | Step::Nothing => None,
    }
}

pericles::saved! {
    impl SavedUnder(name) for PlacedLayer {
        layer: under("{name}"),
        axis, end, force, first_field: fixed,
    }
}
