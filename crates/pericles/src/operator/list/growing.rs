//! [`Growing`] for neighbour lists.

use super::force::BondForce;
use crate::domain::Field;
use crate::operator::Growing;
use crate::operator::fast_law::VectorLaw;

impl<L: VectorLaw, const D: usize> Growing for BondForce<L, D> {
    fn grow(&mut self) {
        self.bonds.grow::<D>();
    }

    fn start_with(&mut self, active: &[bool]) {
        self.bonds.remove_inactive(active);
    }

    fn note_active(&mut self, active: &[bool]) {
        self.bonds.note_active(active);
    }

    fn activate(&mut self, t: f64, u: &[f64], active: &[bool]) {
        let ghosts = self.cloud.domain().ghosts(u);
        let u = Field::new(u, &ghosts);
        let heat = self.heat.as_ref();
        let stretches = heat.map(|heat| heat.expansion.stretches(t));
        self.bonds.add_active::<D>(active, |list, i, site| {
            let j = list.sites().point(site);
            let (eta, xi) = (u.difference::<D>([i, j]), list.vector(list.site(i), site));
            let stretch = (stretches.as_ref()).map_or(0.0, |of| 0.5 * (of[i] + of[j]));
            let scale = if L::LINEAR { 1.0 } else { 1.0 + stretch };
            std::array::from_fn(|c| (eta[c] - stretch * xi[c]) / scale)
        });
    }

    fn for_each_neighbour(&self, i: usize, visit: &mut dyn FnMut(usize, [f64; 3])) {
        let list = self.bonds.form();
        for (_, site) in list.family(i).filter(|&(entry, _)| list.is_present(entry)) {
            visit(list.sites().point(site), list.vector(list.site(i), site));
        }
    }
}
