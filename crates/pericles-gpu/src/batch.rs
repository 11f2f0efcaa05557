//! Batches of steps: the state of the host to the device and back.

use pericles::System;
use pericles::operator::StencilForce;
use pericles::time::State;

use crate::adapter::Context;
use crate::arrays::{Array, Arrays};
use crate::body::Body;
use crate::entries::Entries;
use crate::error::GpuError;

/// A body on a device.
pub(crate) struct Device {
    context: Context,
    body: Body,
    entries: Entries,
    arrays: Arrays,
    /// Mass of each entry of the state's arrays, kg.
    masses: Vec<f64>,
    /// The step whose state is in the arrays, if it is that of the host.
    holds: Option<u64>,
}

impl Device {
    /// Prepares a device for a system in batches of up to `steps` steps.
    pub(crate) fn new(
        context: Context,
        system: &System,
        body: Body,
        steps: usize,
    ) -> Result<Self, GpuError> {
        let entries = Entries::new(system, &body);
        Ok(Self {
            arrays: Arrays::new(&context, &body, &entries, steps)?,
            context,
            body,
            entries,
            masses: system.masses(),
            holds: None,
        })
    }

    /// Returns the memory of all arrays, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.arrays.bytes()
    }

    /// States that the host has a state of its own.
    pub(crate) fn forget(&mut self) {
        self.holds = None;
    }

    /// Advances by up to `steps` steps of length `dt` and returns their number: fewer if the next step is too long for a bond that
    /// breaks in it. Step k ends at time k `dt`.
    pub(crate) fn advance(
        &mut self,
        system: &mut System,
        state: &mut State,
        dt: f64,
        steps: u64,
    ) -> Result<u64, GpuError> {
        let mut steps = steps as usize;
        let first = state.step;
        let mut times: Vec<f64> = (1..=steps as u64)
            .map(|k| (first + k) as f64 * dt)
            .collect();
        times.insert(0, state.t);
        let pairs = times.windows(2);
        let rows = pairs.flat_map(|t| self.entries.course(system, &self.body, t[0], t[1]));
        let course: Vec<f64> = rows.collect();
        let precision = self.context.precision;
        self.arrays.write(Array::Course, &precision.states(&course));
        let books = self.entries.opened(system, &self.body);
        // A step that is too long for a bond spoils the batch, which is then repeated up to this step.
        loop {
            if self.holds != Some(state.step) {
                self.upload(system, state);
            }
            self.arrays.write(Array::Books, &precision.reals(&books));
            self.holds = None;
            match self.arrays.run(steps)? {
                None => break,
                Some(0) => return Ok(0),
                Some(complete) => steps = complete,
            }
        }
        times.truncate(steps + 1);
        self.download(system, state, &times)?;
        state.t = times[steps];
        state.step = first + steps as u64;
        self.holds = Some(state.step);
        Ok(steps as u64)
    }

    fn upload(&self, system: &mut System, state: &State) {
        let (body, units, precision) = (&self.body, self.body.units, self.context.precision);
        let arrays = &self.arrays;
        arrays.write(
            Array::U,
            &precision.states(&body.padded(&state.u, units.length)),
        );
        arrays.write(
            Array::V,
            &precision.states(&body.padded(&state.v, units.velocity())),
        );
        arrays.write(
            Array::A,
            &precision.reals(&body.padded(&state.a, units.acceleration())),
        );
        if let Some(force) = stencil(system) {
            arrays.write(
                Array::Bits,
                bytemuck::cast_slice(&body.bits(force.bonds_mut())),
            );
        }
    }

    fn download(
        &self,
        system: &mut System,
        state: &mut State,
        times: &[f64],
    ) -> Result<(), GpuError> {
        let (body, units, precision) = (&self.body, self.body.units, self.context.precision);
        let arrays = [Array::U, Array::V, Array::A, Array::Books];
        let [u, v, a, books] = self.arrays.read(arrays)?;
        body.unpad(&precision.read_states(&u), units.length, &mut state.u);
        body.unpad(&precision.read_states(&v), units.velocity(), &mut state.v);
        body.unpad(
            &precision.read_reals(&a),
            units.acceleration(),
            &mut state.a,
        );
        let books = precision.read_reals(&books);
        let masses = &self.masses[..];
        self.entries.close(&books, (system, masses), body, times);
        system.count_evaluations(times.len() as u64 - 1);
        if !body.breaks() {
            return Ok(());
        }
        let [bits, lost] = self.arrays.read([Array::Bits, Array::Lost])?;
        let lost = precision.read_reals(&lost);
        let Some(force) = stencil(system) else {
            return Ok(());
        };
        let bonds = force.bonds_mut();
        body.take_bits(&bytemuck::pod_collect_to_vec::<u8, u32>(&bits), bonds);
        let mut blocks = bonds.take_blocks();
        if let Some(block) = blocks.first_mut() {
            for (i, &place) in body.place_of.iter().enumerate() {
                let energy = lost[place as usize];
                if energy != 0.0 {
                    block
                        .tally
                        .dissipate(i, energy * units.energy() * masses[i]);
                }
            }
        }
        bonds.put_blocks(blocks);
        Ok(())
    }
}

fn stencil(system: &mut System) -> Option<&mut dyn StencilForce> {
    system.parts_mut().force.stencil_mut()
}
