//! Collateral Damage.

pub mod map;
