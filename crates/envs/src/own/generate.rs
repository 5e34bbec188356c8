//! Maps that are made anew at each reset: a grid of tiles, each its own sector, some of which are
//! closed from floor to ceiling. The map itself stays what it is, so a new level costs no more than
//! setting its floors.

use super::model::{Generate, GenerateKind};
use hasard_engine::map::SectorId;
use hasard_engine::math::{Fixed, Rng};
use hasard_engine::world::World;

/// The grid that is set.
#[derive(Debug)]
pub(super) struct Layout {
    generate: Generate,
    columns: usize,
    rows: usize,
    floor: i32,
    ceiling: i32,
    sectors: Vec<SectorId>,
}

impl Layout {
    pub fn new(
        generate: Generate,
        columns: usize,
        rows: usize,
        [floor, ceiling]: [i32; 2],
        sectors: Vec<SectorId>,
    ) -> Layout {
        Layout { generate, columns, rows, floor, ceiling, sectors }
    }

    /// Sets the floors of a new level. Whatever stands there is put on its feet by the caller.
    pub fn apply(&self, world: &mut World, test: bool) {
        let heights = self.heights(&mut Rng::new(self.level(world.rng.next_u64(), test)));
        for (sector, height) in self.sectors.iter().zip(heights) {
            world.sector_mut(*sector).floor = Fixed::from_int(height);
        }
    }

    /// The number of a level: of those trained on, or of those that no training has seen.
    fn level(&self, drawn: u64, test: bool) -> u64 {
        match (u64::from(self.generate.train_seeds), test) {
            (0, _) => drawn,
            (seen, false) => drawn % seen,
            (seen, true) => seen + drawn % (1 << 40),
        }
    }

    /// The floors of a level, row by row from the south-west: the ceiling's height where a tile is
    /// closed. All open tiles hang together.
    pub fn heights(&self, rng: &mut Rng) -> Vec<i32> {
        let open = match self.generate.kind {
            GenerateKind::Maze => self.maze(rng),
            GenerateKind::Rooms => self.rooms(rng),
            GenerateKind::Columns | GenerateKind::Platforms => self.columns(rng),
        };
        let [low, high] = self.generate.heights;
        let platforms = self.generate.kind == GenerateKind::Platforms;
        open.into_iter()
            .map(|open| match (platforms, open) {
                // What is no platform is the ground between them.
                (true, true) => rng.between(low, high),
                (true, false) => self.floor,
                (false, true) => self.floor,
                (false, false) => self.ceiling,
            })
            .collect()
    }

    fn at(&self, column: usize, row: usize) -> usize {
        row * self.columns + column
    }

    /// Corridors between cells at odd places: a tree over all of them, then some more openings.
    fn maze(&self, rng: &mut Rng) -> Vec<bool> {
        let mut open = vec![false; self.columns * self.rows];
        let (wide, high) = (self.columns / 2, self.rows / 2);
        let cell = |column: usize, row: usize| self.at(2 * column + 1, 2 * row + 1);
        let mut seen = vec![false; wide * high];
        let mut way = vec![(rng.below(wide as u32) as usize, rng.below(high as u32) as usize)];
        seen[way[0].1 * wide + way[0].0] = true;
        open[cell(way[0].0, way[0].1)] = true;
        while let Some(&(column, row)) = way.last() {
            let mut next = [(0, 0); 4];
            let mut count = 0;
            for (to, of) in [
                (column.wrapping_sub(1), row),
                (column + 1, row),
                (column, row.wrapping_sub(1)),
                (column, row + 1),
            ] {
                if to < wide && of < high && !seen[of * wide + to] {
                    next[count] = (to, of);
                    count += 1;
                }
            }
            if count == 0 {
                way.pop();
                continue;
            }
            let (to, of) = next[rng.below(count as u32) as usize];
            seen[of * wide + to] = true;
            open[cell(to, of)] = true;
            open[self.at(column + to + 1, row + of + 1)] = true;
            way.push((to, of));
        }
        if self.generate.loops > 0 {
            for row in 1..self.rows - 1 {
                for column in 1..self.columns - 1 {
                    if (column + row) % 2 == 1
                        && !open[self.at(column, row)]
                        && rng.below(1000) < self.generate.loops
                    {
                        open[self.at(column, row)] = true;
                    }
                }
            }
        }
        open
    }

    /// Walls that part the ground again and again, each with doors. Where a wall that comes later
    /// closes one, [`Layout::join`] opens another.
    fn rooms(&self, rng: &mut Rng) -> Vec<bool> {
        let mut open = vec![true; self.columns * self.rows];
        let mut parts = vec![[0, 0, self.columns, self.rows]];
        let least = self.generate.room as usize;
        while let Some([west, south, east, north]) = parts.pop() {
            let (wide, high) = (east - west, north - south);
            let across = wide >= high;
            let length = if across { wide } else { high };
            if length < 2 * least + 1 {
                continue;
            }
            let wall = least + rng.below((length - 2 * least) as u32) as usize;
            let side = if across { high } else { wide };
            // One to three doors: with one alone small maps would repeat after some ten thousand.
            let mut doors = [usize::MAX; 3];
            let count = 1 + rng.below(3) as usize;
            doors[..count].fill_with(|| rng.below(side as u32) as usize);
            for step in (0..side).filter(|step| !doors.contains(step)) {
                let (column, row) =
                    if across { (west + wall, south + step) } else { (west + step, south + wall) };
                open[self.at(column, row)] = false;
            }
            if across {
                parts.extend([
                    [west, south, west + wall, north],
                    [west + wall + 1, south, east, north],
                ]);
            } else {
                parts.extend([
                    [west, south, east, south + wall],
                    [west, south + wall + 1, east, north],
                ]);
            }
        }
        self.join(&mut open);
        open
    }

    /// Single closed tiles; what they cut off is closed too, so that the ground hangs together.
    fn columns(&self, rng: &mut Rng) -> Vec<bool> {
        let mut share = self.generate.share;
        loop {
            let mut open: Vec<bool> =
                (0..self.columns * self.rows).map(|_| rng.below(1000) >= share).collect();
            if self.generate.kind == GenerateKind::Columns {
                self.keep_largest(&mut open);
            }
            // Where they have cut off most of the ground there are fewer next time: none in the
            // end.
            if self.generate.kind == GenerateKind::Platforms
                || 3 * open.iter().filter(|open| **open).count() > open.len()
            {
                return open;
            }
            share = share * 3 / 4;
        }
    }

    /// Opens walls between parts until one part is left.
    fn join(&self, open: &mut [bool]) {
        loop {
            let parts = self.parts(open);
            let most = parts.iter().copied().max().unwrap_or(0);
            if most <= 1 {
                return;
            }
            let wall = (0..open.len()).find(|&tile| {
                let mut beside =
                    self.beside(tile).filter(|&next| open[next]).map(|next| parts[next]);
                let first = beside.next();
                !open[tile] && beside.any(|part| Some(part) != first)
            });
            // Parts two walls apart: a tile beside any part is opened, and the next turn sees
            // further.
            let wall = wall.or_else(|| {
                (0..open.len())
                    .find(|&tile| !open[tile] && self.beside(tile).any(|next| open[next]))
            });
            match wall {
                Some(tile) => open[tile] = true,
                None => return,
            }
        }
    }

    /// Closes all but the largest part.
    fn keep_largest(&self, open: &mut [bool]) {
        let parts = self.parts(open);
        let mut sizes = vec![0u32; open.len() + 1];
        parts.iter().filter(|part| **part > 0).for_each(|part| sizes[*part] += 1);
        let largest =
            (1..sizes.len()).max_by_key(|part| (sizes[*part], usize::MAX - part)).unwrap_or(0);
        if sizes.get(largest).is_none_or(|size| *size == 0) {
            open.fill(true);
            return;
        }
        open.iter_mut().zip(&parts).for_each(|(open, part)| *open = *part == largest);
    }

    /// The part that each open tile is of, from 1; 0 for closed ones.
    fn parts(&self, open: &[bool]) -> Vec<usize> {
        let mut parts = vec![0; open.len()];
        let mut count = 0;
        let mut todo = Vec::new();
        for tile in 0..open.len() {
            if !open[tile] || parts[tile] != 0 {
                continue;
            }
            count += 1;
            parts[tile] = count;
            todo.push(tile);
            while let Some(tile) = todo.pop() {
                for next in self.beside(tile) {
                    if open[next] && parts[next] == 0 {
                        parts[next] = count;
                        todo.push(next);
                    }
                }
            }
        }
        parts
    }

    /// The tiles beside one.
    fn beside(&self, tile: usize) -> impl Iterator<Item = usize> + use<> {
        let (columns, rows) = (self.columns, self.rows);
        let (column, row) = (tile % columns, tile / columns);
        let places = [
            (column.wrapping_sub(1), row),
            (column + 1, row),
            (column, row.wrapping_sub(1)),
            (column, row + 1),
        ];
        places
            .into_iter()
            .filter(move |(column, row)| *column < columns && *row < rows)
            .map(move |(column, row)| row * columns + column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn layout(kind: GenerateKind) -> Layout {
        let generate =
            Generate { kind, share: 300, room: 3, loops: 50, heights: [0, 24], train_seeds: 10 };
        Layout::new(generate, 15, 13, [0, 128], Vec::new())
    }

    /// 10,000 levels of each kind: all that is open hangs together, there is enough of it, and no
    /// two are alike.
    #[test]
    fn every_level_hangs_together_and_is_another() {
        for kind in [GenerateKind::Maze, GenerateKind::Rooms, GenerateKind::Columns] {
            let layout = layout(kind);
            let mut seen = BTreeSet::new();
            for seed in 0..10_000 {
                let heights = layout.heights(&mut Rng::new(seed));
                let open: Vec<bool> = heights.iter().map(|height| *height == 0).collect();
                assert_eq!(layout.parts(&open).into_iter().max(), Some(1), "{kind:?} {seed}");
                assert!(
                    open.iter().filter(|open| **open).count() * 4 >= open.len(),
                    "{kind:?} {seed}"
                );
                seen.insert(heights);
            }
            assert!(seen.len() >= 9_990, "{kind:?}: {} levels", seen.len());
        }
    }

    #[test]
    fn levels_of_training_are_few_and_never_those_of_tests() {
        let layout = layout(GenerateKind::Maze);
        let mut rng = Rng::new(1);
        let levels = |test, rng: &mut Rng| {
            (0..1000).map(|_| layout.level(rng.next_u64(), test)).collect::<BTreeSet<_>>()
        };
        let (train, test) = (levels(false, &mut rng), levels(true, &mut rng));
        assert!(train.len() == 10 && test.len() == 1000 && train.is_disjoint(&test));
    }

    #[test]
    fn platforms_are_between_their_heights() {
        let heights = layout(GenerateKind::Platforms).heights(&mut Rng::new(3));
        assert!(heights.iter().all(|height| (0..=24).contains(height)));
        assert!(heights.iter().filter(|height| **height > 0).count() > 60);
    }
}
