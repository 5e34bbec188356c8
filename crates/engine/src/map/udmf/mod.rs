//! UDMF, the community's text form of maps (Universal Doom Map Format 1.1): reading and writing.
//!
//! Reading takes any text that follows the grammar. Blocks and fields that this engine has no use
//! for are skipped, as the specification asks, and counted where ViZDoom has one; a
//! known field with a value of the wrong kind is an error.

mod error;
mod lexer;
mod read;
#[cfg(test)]
mod tests;
mod unplayed;
mod write;

pub use error::{UdmfError, UdmfFault};
pub use read::read;
pub use write::write;
