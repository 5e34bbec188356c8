//! A picture by its own colours: it has few of them, which vectors look up where 256 would take too
//! long.

use std::sync::Arc;

/// How many colours lists have room for: the smallest that does is taken.
const ROOMS: [usize; 3] = [16, 64, 256];

/// A picture whose texels are numbers of its own colours.
#[derive(Clone, Debug)]
pub(crate) struct LocalPalette {
    /// For each texel the number of its colour.
    pub texels: Arc<[u8]>,
    /// How many colours there is room for: 16, 64 or 256.
    pub room: usize,
    /// The colours in the light of each table, one list after another.
    lit: Box<[u8]>,
}

impl LocalPalette {
    /// Of palette indices, in the light of some tables.
    pub fn new(pixels: &[u8], tables: &[[u8; 256]]) -> LocalPalette {
        let mut is_there = [false; 256];
        pixels.iter().for_each(|&pixel| is_there[usize::from(pixel)] = true);
        let colours: Vec<usize> = (0..256).filter(|&colour| is_there[colour]).collect();
        let room = ROOMS
            .into_iter()
            .find(|&room| colours.len() <= room)
            .expect("there are 256 palette indices");
        let (mut numbers, mut lit) = ([0; 256], vec![0; room * tables.len()]);
        for (number, &colour) in colours.iter().enumerate() {
            numbers[colour] = number as u8;
            lit.chunks_exact_mut(room)
                .zip(tables)
                .for_each(|(lit, table)| lit[number] = table[colour]);
        }
        LocalPalette {
            texels: pixels.iter().map(|&pixel| numbers[usize::from(pixel)]).collect(),
            room,
            lit: lit.into(),
        }
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
        let tables: [[u8; 256]; 3] =
            std::array::from_fn(|_| std::array::from_fn(|_| rng.byte() as u8));
        for (colours, room) in [(1, 16), (16, 16), (17, 64), (64, 64), (65, 256), (256, 256)] {
            let pixels: Vec<u8> = (0..4096).map(|i| ((i % colours) * 37) as u8).collect();
            let own = LocalPalette::new(&pixels, &tables);
            assert_eq!(own.room, room, "{colours} colours");
            for (&pixel, &texel) in pixels.iter().zip(own.texels.iter()) {
                for (number, table) in tables.iter().enumerate() {
                    assert_eq!(own.lit(number)[usize::from(texel)], table[usize::from(pixel)]);
                }
            }
        }
    }
}
