//! The six scenarios, a folder each.

pub mod armament_burden;
pub mod collateral_damage;
pub mod precipice_plunge;
pub mod volcanic_venture;

#[cfg(test)]
mod map_tests;
