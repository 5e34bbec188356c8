//! A picture by its own colours: it has few of them, which vectors look up where 256 would take too long.

use std::collections::BTreeMap;
use std::sync::Arc;

/// How many colours lists have room for: the smallest that does is taken.
const ROOMS: [usize; 3] = [16, 64, 256];

/// A picture whose texels are numbers of its own colours.
#[derive(Clone, Debug)]
pub(super) struct OwnColours {
    /// For each texel the number of its colour.
    pub texels: Arc<[u8]>,
    /// How many colours there is room for: 16, 64 or 256.
    pub room: usize,
    /// The colours in the light of each table, one list after another.
    lit: Box<[u8]>,
}

impl OwnColours {
    /// Of palette indices, in the light of some tables.
    pub fn new(pixels: &[u8], tables: &[[u8; 256]]) -> OwnColours {
        let mut numbers: BTreeMap<u8, u8> = pixels.iter().map(|&pixel| (pixel, 0u8)).collect();
        let room = ROOMS.into_iter().find(|&room| numbers.len() <= room).expect("there are 256 palette indices");
        numbers.values_mut().zip(0..=u8::MAX).for_each(|(number, own)| *number = own);
        let mut lit = vec![0; room * tables.len()];
        for (lit, table) in lit.chunks_exact_mut(room).zip(tables) {
            numbers.iter().for_each(|(&pixel, &number)| lit[usize::from(number)] = table[usize::from(pixel)]);
        }
        OwnColours { texels: pixels.iter().map(|pixel| numbers[pixel]).collect(), room, lit: lit.into() }
    }

    /// The colours in the light of a table.
    #[inline]
    pub fn lit(&self, table: usize) -> &[u8] {
        &self.lit[table * self.room..][..self.room]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn lit_colours_are_the_tables_entries() {
        let mut rng = Rng::new(3);
        let tables: [[u8; 256]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| rng.byte() as u8));
        for (colours, room) in [(1, 16), (16, 16), (17, 64), (64, 64), (65, 256), (256, 256)] {
            let pixels: Vec<u8> = (0..4096).map(|i| ((i % colours) * 37) as u8).collect();
            let own = OwnColours::new(&pixels, &tables);
            assert_eq!(own.room, room, "{colours} colours");
            for (&pixel, &texel) in pixels.iter().zip(own.texels.iter()) {
                for (number, table) in tables.iter().enumerate() {
                    assert_eq!(own.lit(number)[usize::from(texel)], table[usize::from(pixel)]);
                }
            }
        }
    }
}
