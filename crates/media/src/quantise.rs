//! Pictures of at most 255 colours, which is what GIF can hold beside its transparent one.

use crate::Picture;

/// Most colours of a palette; one index stays free for "as before".
pub(crate) const MAX_COLOURS: usize = 255;

/// A picture as indices into a palette.
pub(crate) struct Quantised {
    /// The colours, at most [`MAX_COLOURS`].
    pub palette: Vec<[u8; 3]>,
    /// An index a pixel.
    pub indices: Vec<u8>,
}

/// A colour and how many pixels have it.
#[derive(Clone, Copy)]
struct Counted {
    packed: u32,
    count: u32,
}

impl Counted {
    fn channel(self, channel: u32) -> u8 {
        (self.packed >> (16 - 8 * channel)) as u8
    }
}

/// Reduces a picture to a palette: exact where the picture has few colours, else by median cut
/// (Heckbert, *Color image quantization for frame buffer display*, SIGGRAPH 1982) of its exact
/// histogram.
pub(crate) fn quantise(picture: &Picture) -> Quantised {
    let packed: Vec<u32> =
        picture.rgb().chunks_exact(3).map(|p| u32::from_be_bytes([0, p[0], p[1], p[2]])).collect();
    let mut sorted = packed.clone();
    sorted.sort_unstable();
    let mut colours: Vec<Counted> = Vec::new();
    for &colour in &sorted {
        match colours.last_mut() {
            Some(last) if last.packed == colour => last.count += 1,
            _ => colours.push(Counted { packed: colour, count: 1 }),
        }
    }
    let (palette, index_of) = if colours.len() <= MAX_COLOURS {
        (
            colours.iter().map(|c| [c.channel(0), c.channel(1), c.channel(2)]).collect(),
            (0..colours.len() as u8).collect(),
        )
    } else {
        median_cut(&colours)
    };
    let mut indices = Vec::with_capacity(packed.len());
    // Neighbours are often alike: the last answer saves most searches.
    let mut last = (u32::MAX, 0);
    for &colour in &packed {
        if colour != last.0 {
            let at = colours
                .binary_search_by_key(&colour, |c| c.packed)
                .expect("every colour was counted");
            last = (colour, index_of[at]);
        }
        indices.push(last.1);
    }
    Quantised { palette, indices }
}

/// Cuts the colours into boxes of about equal weight. Gives the mean colour of each box and the box
/// of each colour.
fn median_cut(colours: &[Counted]) -> (Vec<[u8; 3]>, Vec<u8>) {
    let mut order: Vec<u32> = (0..colours.len() as u32).collect();
    // A box is a range of `order`; the one of the largest spread times weight is cut next.
    let mut boxes: Vec<(usize, usize)> = vec![(0, order.len())];
    let mut costs: Vec<(u64, u32)> = vec![spread(colours, &order)];
    while boxes.len() < MAX_COLOURS {
        let Some((at, &(cost, channel))) =
            costs.iter().enumerate().max_by_key(|(i, c)| (c.0, usize::MAX - i))
        else {
            break;
        };
        if cost == 0 {
            break;
        }
        let (from, to) = boxes[at];
        let part = &mut order[from..to];
        part.sort_unstable_by_key(|&i| (colours[i as usize].channel(channel), i));
        let total: u64 = part.iter().map(|&i| u64::from(colours[i as usize].count)).sum();
        let mut seen = 0;
        let mut cut = 1;
        for (k, &i) in part.iter().enumerate() {
            seen += u64::from(colours[i as usize].count);
            if seen * 2 >= total {
                cut = (k + 1).clamp(1, part.len() - 1);
                break;
            }
        }
        boxes[at] = (from, from + cut);
        boxes.push((from + cut, to));
        costs[at] = spread(colours, &order[from..from + cut]);
        costs.push(spread(colours, &order[from + cut..to]));
    }
    let mut index_of = vec![0; colours.len()];
    let mut palette = Vec::with_capacity(boxes.len());
    for (index, &(from, to)) in boxes.iter().enumerate() {
        let mut sums = [0u64; 3];
        let mut weight = 0;
        for &i in &order[from..to] {
            let colour = colours[i as usize];
            index_of[i as usize] = index as u8;
            weight += u64::from(colour.count);
            for (channel, sum) in sums.iter_mut().enumerate() {
                *sum += u64::from(colour.channel(channel as u32)) * u64::from(colour.count);
            }
        }
        palette.push(sums.map(|sum| ((sum + weight / 2) / weight) as u8));
    }
    (palette, index_of)
}

/// How much a box wants to be cut, and along which channel: the square of its widest side times the
/// root of its weight, so that large plain areas do not take all colours from small bright things.
fn spread(colours: &[Counted], part: &[u32]) -> (u64, u32) {
    let mut widest = (0u64, 0);
    for channel in 0..3 {
        let values = part.iter().map(|&i| colours[i as usize].channel(channel));
        let side = u64::from(values.clone().max().unwrap_or(0) - values.min().unwrap_or(0));
        if side > widest.0 {
            widest = (side, channel);
        }
    }
    let weight: u64 = part.iter().map(|&i| u64::from(colours[i as usize].count)).sum();
    (widest.0 * widest.0 * weight.isqrt().max(1), widest.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worst_error(picture: &Picture) -> u32 {
        let quantised = quantise(picture);
        assert!(quantised.palette.len() <= MAX_COLOURS);
        let pixels = picture.rgb().chunks_exact(3).zip(&quantised.indices);
        pixels
            .map(|(p, &i)| {
                let q = quantised.palette[usize::from(i)];
                (0..3).map(|c| u32::from(p[c].abs_diff(q[c]))).max().unwrap()
            })
            .max()
            .unwrap()
    }

    #[test]
    fn few_colours_are_exact_and_many_are_close() {
        let few = Picture::from_rgb(17, 15, (0..255u8).flat_map(|i| [i, 255 - i, i / 2]).collect())
            .unwrap();
        assert_eq!(worst_error(&few), 0);
        let many = (0..64 * 64u32)
            .flat_map(|i| [(i % 64 * 4) as u8, (i / 64 * 4) as u8, (i % 7 * 36) as u8])
            .collect();
        let worst = worst_error(&Picture::from_rgb(64, 64, many).unwrap());
        assert!(worst > 0 && worst < 40, "worst error {worst}");
    }
}
