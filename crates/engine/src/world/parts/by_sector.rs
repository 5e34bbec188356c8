//! Which entry of a list belongs to a sector.

use crate::map::SectorId;
use crate::simd::prefetch;

/// For each sector the index of its entry in some list, if it has one. Worlds without entries pay
/// nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct BySector(Vec<u32>);

/// A sector without an entry.
const NONE: u32 = u32::MAX;

impl BySector {
    /// The entry of a sector.
    #[inline]
    pub(crate) fn get(&self, sector: SectorId) -> Option<usize> {
        self.0.get(sector.0 as usize).filter(|&&index| index != NONE).map(|&index| index as usize)
    }

    /// Asks the processor for all of it.
    pub(crate) fn prefetch(&self) {
        prefetch(&self.0[..]);
    }

    /// Gives a sector an entry, or another one.
    pub(crate) fn set(&mut self, sector: SectorId, index: usize) {
        let at = sector.0 as usize;
        if at >= self.0.len() {
            self.0.resize(at + 1, NONE);
        }
        self.0[at] = index as u32;
    }

    /// Leaves a sector without an entry.
    pub(crate) fn clear(&mut self, sector: SectorId) {
        if let Some(entry) = self.0.get_mut(sector.0 as usize) {
            *entry = NONE;
        }
    }
}
