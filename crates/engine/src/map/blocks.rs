//! What a line stops although its opening is large enough.

/// Flags of a line beside `blocking`: each names a kind of traveller that may not cross it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Blocks(u8);

impl Blocks {
    /// Everybody, missiles, bullets and sight.
    pub const EVERYTHING: Blocks = Blocks(1);
    /// Players.
    pub const PLAYERS: Blocks = Blocks(1 << 1);
    /// All that walks or rolls and is no player.
    pub const MONSTERS: Blocks = Blocks(1 << 2);
    /// Monsters that float.
    pub const FLOATERS: Blocks = Blocks(1 << 3);
    /// Missiles.
    pub const PROJECTILES: Blocks = Blocks(1 << 4);
    /// Bullets.
    pub const HITSCAN: Blocks = Blocks(1 << 5);
    /// Sight.
    pub const SIGHT: Blocks = Blocks(1 << 6);

    /// The fields of UDMF that set them.
    pub(super) const FIELDS: [(&str, Blocks); 7] = [
        ("blockeverything", Blocks::EVERYTHING),
        ("blockplayers", Blocks::PLAYERS),
        ("blockmonsters", Blocks::MONSTERS),
        ("blockfloaters", Blocks::FLOATERS),
        ("blockprojectiles", Blocks::PROJECTILES),
        ("blockhitscan", Blocks::HITSCAN),
        ("blocksight", Blocks::SIGHT),
    ];

    /// Both.
    #[must_use]
    pub const fn with(self, other: Blocks) -> Blocks {
        Blocks(self.0 | other.0)
    }

    /// Sets or clears flags.
    pub fn set(&mut self, which: Blocks, on: bool) {
        self.0 = if on { self.0 | which.0 } else { self.0 & !which.0 };
    }

    /// Whether it stops any of these.
    #[must_use]
    pub const fn any(self, which: Blocks) -> bool {
        self.0 & which.0 != 0
    }

    /// Whether it stops nothing.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }
}
