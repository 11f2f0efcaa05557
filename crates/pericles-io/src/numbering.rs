//! Numbering of points in files.

use std::borrow::Cow;

use pericles::space::PointCloud;

/// Returns the point of each user's number.
pub(crate) fn points_by_number(cloud: &PointCloud) -> Vec<u32> {
    let mut points = vec![0; cloud.len()];
    for i in 0..cloud.len() {
        points[cloud.user_number(i)] = i as u32;
    }
    points
}

/// Mapping from the point order of the cloud to the user's order; `None` if they are equal.
#[derive(Debug, Clone)]
pub(crate) struct Numbering(Option<Vec<usize>>);

impl Numbering {
    /// Returns the numbering of a cloud. The part of a divided body, whose numbers belong to the whole body, keeps its order.
    pub(crate) fn of(cloud: &PointCloud) -> Self {
        if cloud.domain().is_divided() {
            return Self(None);
        }
        let numbers: Vec<usize> = (0..cloud.len()).map(|i| cloud.user_number(i)).collect();
        let same = numbers.iter().enumerate().all(|(i, &number)| i == number);
        Self((!same).then_some(numbers))
    }

    /// Returns the user's number of a point.
    pub(crate) fn number(&self, point: u32) -> u32 {
        match &self.0 {
            None => point,
            Some(numbers) => numbers[point as usize] as u32,
        }
    }

    /// Reorders a component-major array into the user's order.
    pub(crate) fn apply<'a>(&self, array: &'a [f64]) -> Cow<'a, [f64]> {
        let Some(numbers) = &self.0 else {
            return Cow::Borrowed(array);
        };
        let n = numbers.len();
        let mut ordered = vec![0.0; array.len()];
        for (from, to) in array.chunks(n).zip(ordered.chunks_mut(n)) {
            for (&value, &number) in from.iter().zip(numbers) {
                to[number] = value;
            }
        }
        Cow::Owned(ordered)
    }
}

/// Returns a component-major array of a cloud in the user's order of points.
pub fn in_user_order<'a>(cloud: &PointCloud, array: &'a [f64]) -> Cow<'a, [f64]> {
    Numbering::of(cloud).apply(array)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_written_in_the_user_s_order() {
        let numbering = Numbering(Some(vec![2, 0, 1]));
        let ordered = numbering.apply(&[10.0, 20.0, 30.0, 1.0, 2.0, 3.0]);
        assert_eq!(*ordered, [20.0, 30.0, 10.0, 2.0, 3.0, 1.0]);
    }
}
