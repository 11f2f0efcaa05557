//! Words of texts and numbers of binary files, with their places, and with counts that are compared with what is left of a file.

mod bytes;
mod numbering;
mod words;

pub(crate) use bytes::{Bytes, Scalar, no_vertex, vertex_number};
pub(crate) use numbering::Numbering;
pub(crate) use words::Words;
