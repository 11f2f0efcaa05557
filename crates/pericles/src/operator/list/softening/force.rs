//! Force kernel of softening bonds.

use super::advance::{Advance, Part, advance_rows};
use super::curves::Curves;
use super::kernels::Softened;
use crate::archive::Laid;
use crate::error::{PericlesError, Result};
use crate::lanes::LANES;
use crate::material::{MaterialPairs, Softening};
use crate::operator::PointSubset;
use crate::operator::fast_law::VectorLaw;
use crate::operator::list::BondForce;
use crate::operator::rows::Rows;
use crate::parallel::{BLOCK, components_mut, for_each_block};
use crate::step_end::StepEnd;

/// Force density f(x_i) = Σ_j (1 − d_ij) c α κ V_j s n over the bonds of a neighbour list, N/m³. The damage d
/// of a bond is a function of its largest stretch so far ([`Softening`]).
///
/// The largest stretches are stored at the ends of accepted steps. In between, the force at displacement u is
/// the force of bonds stretched to u since the last accepted step: stages and static solvers include the softening
/// of the current step, and the tangent is the derivative of this force. The elastic energy is computed with the
/// remaining stiffness. Energy dissipated by softening is added to that of breaking bonds. A bond breaks at
/// the end of its curve.
///
/// Memory in addition to [`BondForce`]: 8 bytes per directed bond.
pub struct SofteningForce<L: VectorLaw, const D: usize> {
    pub(super) list: BondForce<L, D>,
    pub(super) curves: Curves,
    /// Largest stretch of each entry, 0 for bonds that have not softened.
    pub(super) largest: Vec<f64>,
}

crate::saved! {
    impl<L: VectorLaw, const D: usize> Checkpointed for SofteningForce<L, D> {
        list: part,
        largest: by(Laid::rows("softening/largest", list.bonds.form().start(), largest.len())),
        curves: fixed,
    }
}

/// Returns the error of pair laws whose force is not proportional to the stretch.
pub(in crate::operator) fn no_softening() -> PericlesError {
    PericlesError::FormNotUsable {
        form: "list",
        reason: "softening needs a force proportional to the stretch of a bond; use model = \"bond-stretch\" or \"linear\"",
    }
}

impl<L: VectorLaw, const D: usize> SofteningForce<L, D> {
    /// Creates the force from a list, whose critical stretches determine the area under the curves. `classes`
    /// are the materials of the list, if there are several.
    ///
    /// # Errors
    /// A pair law whose force is not proportional to the stretch
    /// ([`PairForce::OF_STRETCH`](crate::material::PairForce::OF_STRETCH)); errors of [`Softening::curve`].
    pub fn new(
        list: BondForce<L, D>,
        classes: Option<&MaterialPairs>,
        softening: &Softening,
    ) -> Result<Self> {
        if !L::OF_STRETCH {
            return Err(no_softening());
        }
        let classes = classes.map(|classes| classes.on_sites(list.bonds.form().sites()));
        let curves = Curves::new(softening, list.critical_stretch, classes)?;
        let entries = list.bonds.form().present().len() * LANES;
        Ok(Self {
            list,
            curves,
            largest: vec![0.0; entries],
        })
    }

    /// Returns the largest stretch of the bond of an entry beyond its elastic limit; 0 if it has not
    /// softened.
    pub fn largest_stretch(&self, entry: usize) -> f64 {
        self.largest[entry]
    }

    /// Returns the data read by the loops.
    pub(super) fn kept(&self) -> Softened<'_> {
        Softened {
            curves: &self.curves,
            largest: &self.largest,
            first: 0,
            breakable: self.list.bonds.form().breakable(),
            is_frozen: false,
        }
    }

    /// Returns 1 − d of an entry of a point for the largest stretch at the end of the last step.
    pub(super) fn retained(&self, i: usize, entry: usize, site: usize) -> f64 {
        let largest = self.largest[entry];
        match largest > 0.0 {
            true => self
                .curves
                .retained(self.list.bonds.form().site(i), site, largest),
            false => 1.0,
        }
    }

    /// Updates the largest stretches at the end of a step and adds the force.
    pub(super) fn advance(&mut self, step: &StepEnd<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let n = self.list.cloud.len();
        let mut blocks = self.list.bonds.take_blocks();
        let mut largest = std::mem::take(&mut self.largest);
        let Self { list, curves, .. } = &*self;
        let heat = list.heat_at(step.t);
        let bonds = list.view().heated(heat.as_deref().map(Vec::as_slice));
        let moved = step.ghost_velocities(list.cloud.domain());
        let rule = Advance {
            kept: Softened {
                curves,
                largest: &[],
                first: 0,
                breakable: list.bonds.form().breakable(),
                is_frozen: false,
            },
            volumes: list.cloud.volumes(),
            step,
            velocity: step.velocities(&moved),
        };
        let mut parts = Vec::with_capacity(blocks.len());
        let mut rest = &mut largest[..];
        for damage in &mut blocks {
            let (own, behind) = rest.split_at_mut(damage.intact.len() * LANES);
            rest = behind;
            parts.push(Part {
                damage,
                largest: own,
            });
        }
        list.with_packed(step.u, on, |u| {
            for_each_block(
                components_mut::<D>(out, n),
                &mut parts,
                list.bonds.form().cost(on),
                &|first, mut out, part| {
                    let len = n.min(first + BLOCK) - first;
                    if let Some(wanted) = Rows::of_block(on, first, len) {
                        let set = list.instruction_set;
                        advance_rows::<L, D>(set, &bonds, &rule, u, part, &wanted, &mut out);
                    }
                },
            );
        });
        drop(heat);
        self.list.bonds.put_blocks(blocks);
        self.largest = largest;
    }
}
