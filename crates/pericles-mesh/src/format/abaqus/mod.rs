//! Abaqus input files: nodes, elements, node and element sets, surfaces, parts and instances, up to the first step. Other keywords are not used.
//!
//! An instance is a copy of its part and what stands within the instance itself. Sets of a part become `instance.set`, or `set` where there is one instance
//! only. Names are compared without regard to case unless they are quoted.

mod assemble;
mod keyword;
mod reading;
mod resolve;
mod scope;
mod types;

use super::Include;
use crate::fault::Fault;
use crate::raw::RawMesh;
use reading::Reading;

pub(super) fn parse(content: &[u8], include: &Include<'_>) -> Result<RawMesh, Fault> {
    let mut reading = Reading::default();
    reading.read(content, include, 0)?;
    reading.model.assemble()
}
