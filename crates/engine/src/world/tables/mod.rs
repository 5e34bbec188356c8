//! What things are: constants by kind of actor and weapon.

pub mod info;
pub mod left_out;
pub mod states;
pub mod weapons;
