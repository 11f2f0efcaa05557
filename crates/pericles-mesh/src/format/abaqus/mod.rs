//! Abaqus input files: nodes, elements, node and element sets, surfaces, parts and instances, up to the first
//! step. Other keywords are ignored.
//!
//! An instance is a copy of its part plus its own content. Sets of a part are named `instance.set`, or `set`
//! if there is only one instance. Names are compared case-insensitively unless they are quoted.

mod assemble;
mod keyword;
mod members;
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
