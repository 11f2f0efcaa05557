//! Reactions of constraints, and the work and impulse that they contribute to the energy balance.

use super::PrescribedMotion;
use crate::domain::Domain;
use crate::parallel::PointSubset;
use crate::space::PointCloud;

impl PrescribedMotion {
    /// Stores the reaction ρ a − f of an accepted state, from the accelerations f/ρ before they are replaced, and
    /// returns work (J) and impulse (N s) of the constraint since the last accepted state. Its points have moved as
    /// prescribed, or along the `chord` between two static states.
    pub(crate) fn account(
        &mut self,
        t: f64,
        dt: f64,
        cloud_len: usize,
        acceleration: &[f64],
        chord: Option<[&[f64]; 2]>,
        (density, cloud): (&dyn Fn(usize) -> f64, &PointCloud),
    ) -> (f64, [f64; 3]) {
        let (volumes, domain) = (cloud.volumes(), cloud.domain());
        let held = self.holds(t);
        let nothing = |reaction: &f64| *reaction == 0.0;
        if !held && domain.all(self.reaction.iter().all(nothing)) {
            return (0.0, [0.0; 3]);
        }
        // In the step after the release the constraint acts for the first half only; its points then continue with
        // about the last velocity.
        let mut advance = vec![0.0; self.reaction.len()];
        if let Some([before, after]) = chord {
            self.for_each(0, t, &PointSubset::All, cloud_len, |entry, slot, _| {
                advance[slot] = after[entry] - before[entry];
            });
        } else if held {
            self.for_each(0, t, &PointSubset::All, cloud_len, |_, slot, after| {
                advance[slot] = after
            });
            self.for_each(
                0,
                t - dt,
                &PointSubset::All,
                cloud_len,
                |_, slot, before| {
                    advance[slot] -= before;
                },
            );
        } else {
            self.for_each(
                1,
                t - dt,
                &PointSubset::All,
                cloud_len,
                |_, slot, velocity| {
                    advance[slot] = velocity * dt;
                },
            );
        }
        let mut reaction = std::mem::take(&mut self.reaction);
        let mut push = vec![0.0; reaction.len()];
        self.for_each(2, t, &PointSubset::All, cloud_len, |entry, slot, rate| {
            let i = entry % cloud_len;
            let now = if held {
                density(i) * (rate - acceleration[entry])
            } else {
                0.0
            };
            let mean = 0.5 * (reaction[slot] + now) * volumes[i];
            advance[slot] *= mean;
            push[slot] = mean * dt;
            reaction[slot] = now;
        });
        self.reaction = reaction;
        let work = domain.sum(advance.len(), |slot| advance[slot]);
        (work, self.sums(domain, &push))
    }

    /// Sums slots over the points, by axis.
    fn sums(&self, domain: &Domain, slots: &[f64]) -> [f64; 3] {
        let (n, mut sums) = (self.points.len(), [0.0; 3]);
        for (axis, c) in self.axes().enumerate() {
            sums[c] = domain.sum(n, |k| slots[axis * n + k]);
        }
        sums
    }

    /// Reaction force: the force of the constraint on the body at the last accepted state, N.
    pub fn reaction(&self, cloud: &PointCloud) -> [f64; 3] {
        let volumes = cloud.volumes();
        let points = self.points.iter().cycle();
        let force = |(force, &i): (&f64, &u32)| force * volumes[i as usize];
        let slots: Vec<f64> = self.reaction.iter().zip(points).map(force).collect();
        self.sums(cloud.domain(), &slots)
    }

    /// Adds the reaction force density at the last accepted state (N/m³) to the entries of the constrained points.
    pub fn add_reaction(&self, cloud_len: usize, out: &mut [f64]) {
        let slots = self.reaction.chunks(self.points.len().max(1));
        for (c, reactions) in self.axes().zip(slots) {
            for (force, &i) in reactions.iter().zip(&self.points) {
                out[c * cloud_len + i as usize] += force;
            }
        }
    }
}
