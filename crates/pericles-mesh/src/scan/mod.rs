//! Reading of words of text files and numbers of binary files, with their locations; counts are checked
//! against the remaining length.

mod bytes;
mod numbering;
mod words;

pub(crate) use bytes::{Bytes, Scalar, no_vertex, vertex_number};
pub(crate) use numbering::Numbering;
pub(crate) use words::Words;
