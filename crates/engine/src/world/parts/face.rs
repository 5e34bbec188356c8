//! What the face on the status bar shows and remembers.

/// What the face shows, within the band of the player's health.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Face {
    /// Looks right (0), ahead (1) or left (2): pictures `STFST` + band + this.
    Glance(u8),
    /// Cries out: `STFOUCH` + band.
    Ouch,
    /// Grins at a new weapon: `STFEVL` + band.
    Grin,
    /// Clenches its teeth in pain or rage: `STFKILL` + band.
    Rage,
    /// Dead: `STFDEAD0`.
    Dead,
}

/// What the face remembers from tic to tic.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct FaceState {
    /// What is shown.
    pub shown: Face,
    /// Tics left of it.
    pub(in crate::world) tics: u32,
    /// Health at the last tic.
    pub(in crate::world) health: i32,
    /// Tics of firing without a break.
    pub(in crate::world) firing_tics: u32,
    /// A weapon was taken that the player did not have.
    pub(in crate::world) grin: bool,
}

impl Default for FaceState {
    fn default() -> FaceState {
        FaceState { shown: Face::Glance(1), tics: 0, health: 0, firing_tics: 0, grin: false }
    }
}
