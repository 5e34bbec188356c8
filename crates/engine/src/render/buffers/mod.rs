//! What a frame is drawn into, and what it notes of itself on the way.

pub mod clip;
pub mod drawsegs;
pub mod frame;
pub mod labels;
pub mod request;
pub mod sectors;
pub mod transpose;
pub mod visplane;
pub mod written;
