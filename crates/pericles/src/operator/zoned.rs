//! Capabilities of forces required by multirate schemes.

use super::PointSubset;
use crate::step_end::StepEnd;

/// A force of finite range: the force on a point depends on the displacements of nearby points.
pub trait LocalForce {
    /// Calls `visit` once for each point other than own point i that has a bond with it; ghosts are counted after
    /// the own points. The relation is symmetric. Bonds broken during the run may be included: zones are then
    /// wider than necessary, never too narrow.
    fn bonded(&self, i: usize, visit: &mut dyn FnMut(usize));

    /// Returns the largest number of bonds between a point and the points on whose displacements its force
    /// depends: one for a sum over bonds, two if the force of a bond depends on the other bonds of its ends.
    fn range_in_bonds(&self) -> u32 {
        1
    }

    /// Calls `visit` once for each point other than i on whose displacement the force on point i depends: the
    /// points within [`LocalForce::range_in_bonds`] bonds. For bodies that are not divided among processes, because the
    /// bonds of ghosts belong to their owners.
    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        if self.range_in_bonds() == 1 {
            return self.bonded(i, visit);
        }
        let mut reached = vec![i];
        let mut front = 0..1;
        for _ in 0..self.range_in_bonds() {
            for k in front.clone() {
                self.bonded(reached[k], &mut |j| reached.push(j));
            }
            front = front.end..reached.len();
        }
        reached.sort_unstable();
        reached.dedup();
        reached.into_iter().filter(|&k| k != i).for_each(visit);
    }
}

/// A force that is a sum over bonds, in which the contribution of some neighbours can be computed alone.
///
/// Both ends of a bond are treated equally, so that zones do not change the force between the parts of a body.
pub trait SplitForce {
    /// Adds [`Force::add_force`](super::Force::add_force) of the bonds whose other end is marked in
    /// `partners` (one mark per point).
    fn add_force_from(
        &self,
        t: f64,
        u: &[f64],
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    );

    /// Applies [`Force::end_step`](super::Force::end_step) to the bonds whose other end is marked in
    /// `partners`; the failure criterion is not applied to other bonds, and their forces are not added.
    fn end_step_from(
        &mut self,
        step: &StepEnd<'_>,
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    );
}
