//! Parallel projection of solids: screen axes, pixels and light.

use pericles::sum::max_norm;
use pericles::vector::{cross, dot};

/// Unit vectors of the screen: to the right, upwards, and towards the viewer.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    pub(super) right: [f64; 3],
    pub(super) up: [f64; 3],
    pub(super) eye: [f64; 3],
}

impl View {
    pub(super) fn new(direction: [f64; 3]) -> Self {
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
    pub(super) fn project(&self, p: [f64; 3]) -> [f64; 3] {
        [dot(p, self.right), dot(p, self.up), dot(p, self.eye)]
    }

    /// Returns 1 for a face whose normal points towards the viewer, otherwise −1.
    pub(super) fn side_of(&self, normal: [f64; 3]) -> f64 {
        dot(normal, self.eye).signum()
    }

    /// Returns the light on a surface with this normal, from above left of the viewer, on the side that is seen.
    pub(super) fn light_on(&self, normal: [f64; 3], side: f64) -> f64 {
        /// Light on surfaces that the source does not reach.
        const AMBIENT: f64 = 0.6;
        let lamp = |k: usize| self.eye[k] + 0.7 * self.up[k] - 0.5 * self.right[k];
        let lamp = [lamp(0), lamp(1), lamp(2)];
        let size = (dot(normal, normal) * dot(lamp, lamp)).sqrt();
        if size == 0.0 {
            return 1.0;
        }
        let towards = dot(normal, lamp) * side / size;
        AMBIENT + (1.0 - AMBIENT) * towards.max(0.0)
    }

    /// Returns the light on a flat face with this normal, which is taken towards the viewer. The brightest of the
    /// visible faces across the axes has full light.
    pub(super) fn light_on_face(&self, normal: [f64; 3]) -> f64 {
        /// Light on faces turned away from the source, as a fraction of full light.
        const SHADE: f64 = 0.65;
        /// Cosine between the normal of a face and the view direction.
        const EDGE_ON: f64 = 0.05;
        let size = dot(normal, normal).sqrt();
        if size == 0.0 {
            return 1.0;
        }
        let lamp: [f64; 3] =
            std::array::from_fn(|k| self.eye[k] + 1.1 * self.up[k] - 0.4 * self.right[k]);
        // A face seen edge-on has no light to compare with.
        let seen = (0..3).filter(|&c| self.eye[c].abs() > EDGE_ON);
        let most = seen.map(|c| self.eye[c].signum() * lamp[c]);
        let most = most.fold(f64::MIN_POSITIVE, f64::max);
        let towards = dot(normal, lamp) * self.side_of(normal) / size;
        SHADE + (1.0 - SHADE) * (towards / most).clamp(0.0, 1.0)
    }
}

/// Mapping from positions in space to pixels of the plot.
pub(super) struct Placing {
    pub(super) view: View,
    /// Centre of the plot on the screen, m.
    pub(super) middle: [f64; 2],
    pub(super) per_metre: f64,
    /// Half the size of the plot, in pixels.
    pub(super) half: [f64; 2],
}

impl Placing {
    /// Maps to pixels of the plot and the distance from the viewer.
    pub(super) fn place(&self, p: [f64; 3]) -> [f64; 3] {
        let [x, y, near] = self.view.project(p);
        [
            (x - self.middle[0]) * self.per_metre + self.half[0],
            (self.middle[1] - y) * self.per_metre + self.half[1],
            -near,
        ]
    }
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
    fn the_faces_of_a_box_differ_in_light() {
        for direction in [
            [0.5, -1.0, 0.6],
            [2.0, -3.0, 1.0],
            [1.0, 1.5, 1.0],
            [1.0, 1.0, 1.0],
            [-1.0, -2.0, 0.8],
            [1.0, -2.0, -1.0],
        ] {
            let view = View::new(direction);
            let normals = [[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 1.0]];
            let light = normals.map(|normal| view.light_on_face(normal));
            assert_eq!(light.into_iter().fold(0.0, f64::max), 1.0);
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                assert!(
                    (light[a] - light[b]).abs() > 0.06,
                    "{direction:?} {light:?}"
                );
            }
        }
        // A normal points to either side.
        let view = View::new([0.5, -1.0, 0.6]);
        let [up, down] = [1.0, -1.0].map(|z| view.light_on_face([0.3, 0.0, z]));
        assert_ne!(up, down);
        assert_eq!(up, view.light_on_face([-0.3, 0.0, -1.0]));
    }
}
