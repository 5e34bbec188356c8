//! What sectors do: floors and ceilings that move, lights that change, actors that ride.

pub mod floor_waggle;
pub mod lights;
pub mod map_lights;
pub mod movers;
pub mod present;
pub mod riders;
