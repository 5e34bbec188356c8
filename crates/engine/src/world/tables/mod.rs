//! What things are: constants by kind of actor and weapon.

pub mod heading;
pub mod info;
pub mod kinds;
pub mod left_out;
pub mod states;
pub mod weapons;
