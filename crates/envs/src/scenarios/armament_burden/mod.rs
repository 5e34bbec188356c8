//! Armament Burden: carry weapons to the delivery zone without carrying too much.

pub mod map;
mod tiles;
