//! Force kernel of softening bonds.

use super::advance::{Advance, Part, advance_rows, open_rows};
use super::curves::Curves;
use super::gate::{Gate, Marks, PointStrengths};
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
use crate::space::check_length;
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
/// With a [`Strength`](crate::material::Strength) a bond is elastic at any stretch until the stress of one of its ends
/// reaches the strength of its material. Stresses are computed at the ends of accepted steps, and bonds that open then
/// soften from their stretch at that time, or break if it is beyond the critical one.
///
/// Memory in addition to [`BondForce`]: 8 bytes per directed bond, 16 with strengths.
pub struct SofteningForce<L: VectorLaw, const D: usize> {
    pub(super) list: BondForce<L, D>,
    pub(super) curves: Curves,
    /// Largest stretch of each entry, 0 for bonds that have not softened.
    pub(super) largest: Vec<f64>,
    /// State of bonds that are elastic until the stress reaches the strength, if softening begins in this way.
    pub(super) gate: Option<Gate>,
}

crate::saved! {
    impl<L: VectorLaw, const D: usize> Checkpointed for SofteningForce<L, D> {
        list: part,
        largest: by(Laid::rows("softening/largest", list.bonds.form().start(), largest.len())),
        gate: part,
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
            gate: None,
        })
    }

    /// Keeps bonds elastic until the stress of one of their ends reaches the strength of its material. Its onset replaces
    /// that of the softening law.
    ///
    /// # Errors
    /// A number of strengths that is not that of the materials.
    pub(in crate::operator) fn with_strengths(
        self,
        strengths: &PointStrengths<'_>,
    ) -> Result<Self> {
        let count = self.curves.materials();
        check_length(
            "the strengths of the materials",
            strengths.materials.len(),
            count,
        )?;
        let gate = Gate::new(&self.list, strengths);
        Ok(Self {
            gate: Some(gate),
            ..self
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
            onsets: (self.gate.as_ref()).map(|gate| &gate.onsets[..]),
            first: 0,
            breakable: self.list.bonds.form().breakable(),
            is_frozen: false,
        }
    }

    /// Finds the points whose stress has reached the strength and those that have lost stiffness; `None` if there are
    /// none. All processes must call it together.
    fn marks(&mut self, t: f64, u: &[f64]) -> Option<Marks> {
        let gate = self.gate.as_ref()?;
        let states = gate.states(&self.list, &self.kept(), (t, u));
        self.gate.as_mut()?.note(&states);
        Marks::of(self.list.cloud.domain(), &states)
    }

    /// Returns 1 − d of an entry of a point for the largest stretch at the end of the last step.
    pub(super) fn retained(&self, i: usize, entry: usize, site: usize) -> f64 {
        let largest = self.largest[entry];
        match largest > 0.0 {
            true => {
                let ends = [self.list.bonds.form().site(i), site];
                self.kept().retained(entry, ends, largest)
            }
            false => 1.0,
        }
    }

    /// Updates the largest stretches at the end of a step and adds the force.
    pub(super) fn advance(&mut self, step: &StepEnd<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let n = self.list.cloud.len();
        let marks = self.marks(step.t, step.u);
        let mut blocks = self.list.bonds.take_blocks();
        let mut largest = std::mem::take(&mut self.largest);
        let mut onsets = (self.gate.as_mut()).map(|gate| std::mem::take(&mut gate.onsets));
        let Self { list, curves, .. } = &*self;
        let heat = list.heat_at(step.t);
        let bonds = list.view().heated(heat.as_deref().map(Vec::as_slice));
        let moved = step.ghost_velocities(list.cloud.domain());
        let rule = Advance {
            kept: Softened {
                curves,
                largest: &[],
                onsets: None,
                first: 0,
                breakable: list.bonds.form().breakable(),
                is_frozen: false,
            },
            volumes: list.cloud.volumes(),
            step,
            velocity: step.velocities(&moved),
        };
        let opening = marks.as_ref().zip(self.gate.as_ref());
        let mut parts = Vec::with_capacity(blocks.len());
        let mut rest = &mut largest[..];
        let mut rest_of_onsets = onsets.as_deref_mut();
        for damage in &mut blocks {
            let entries = damage.intact.len() * LANES;
            let (own, behind) = rest.split_at_mut(entries);
            rest = behind;
            let own_onsets = rest_of_onsets.take().map(|rest| {
                let (own, behind) = rest.split_at_mut(entries);
                rest_of_onsets = Some(behind);
                own
            });
            parts.push(Part {
                damage,
                largest: own,
                onsets: own_onsets,
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
                        if let Some(opening) = opening {
                            open_rows::<L, D>(&bonds, &rule, opening, u, part, &wanted);
                        }
                        advance_rows::<L, D>(set, &bonds, &rule, u, part, &wanted, &mut out);
                    }
                },
            );
        });
        drop(heat);
        self.list.bonds.put_blocks(blocks);
        self.largest = largest;
        if let (Some(gate), Some(onsets)) = (&mut self.gate, onsets) {
            gate.onsets = onsets;
        }
    }
}
