//! The six scenarios, a folder each.

pub mod armament_burden;
pub mod collateral_damage;
pub mod detonators_dilemma;
pub mod precipice_plunge;
pub mod remedy_rush;
pub mod volcanic_venture;

#[cfg(test)]
mod map_tests;
