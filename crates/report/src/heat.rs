//! A heatmap as a picture.

use crate::run::HeatmapData;
use hasard_media::{Picture, text};

/// Colours of rising heat: dark violet, magenta, orange, pale yellow.
const HEAT: [[f64; 3]; 5] = [
    [48.0, 18.0, 110.0],
    [140.0, 30.0, 130.0],
    [225.0, 70.0, 85.0],
    [252.0, 160.0, 60.0],
    [254.0, 246.0, 180.0],
];

/// Size at which a heatmap is shown: the map's proportions with the longer side of about `side`
/// pixels, even.
#[must_use]
pub fn shown_size(map: &HeatmapData, side: usize) -> (usize, usize) {
    let (width, height) = (map.extent[2] - map.extent[0], map.extent[3] - map.extent[1]);
    let scale = side as f64 / width.max(height);
    let even = |length: f64| ((length * scale / 2.0).round() as usize * 2).clamp(24, side + 2);
    (even(width), even(height))
}

/// The share of steps in the most visited cell.
#[must_use]
pub fn densest(map: &HeatmapData) -> f64 {
    let most = map.steps.iter().copied().fold(0.0, f64::max);
    if most > 0.0 { most / map.steps.iter().sum::<f64>() } else { 0.0 }
}

/// The share of steps in each cell as colour over the automap (or a plain ground), north up, on a
/// scale that ends at the share `most`. Places never visited show the map alone.
#[must_use]
pub fn overlay(map: &HeatmapData, automap: Option<&Picture>, side: usize, most: f64) -> Picture {
    let (width, height) = shown_size(map, side);
    let mut picture = automap.map_or_else(
        || Picture::filled(width, height, [28, 30, 36]),
        |automap| automap.resized(width, height),
    );
    let most = most * map.steps.iter().sum::<f64>();
    if most <= 0.0 {
        return picture;
    }
    for y in 0..height {
        let row = map.rows - 1 - y * map.rows / height;
        for x in 0..width {
            let column = x * map.columns / width;
            let steps = map.steps[row * map.columns + column];
            if steps > 0.0 {
                let heat = (steps / most).min(1.0).sqrt();
                picture.blend(
                    x as isize,
                    y as isize,
                    heat_colour(heat),
                    (110.0 + 110.0 * heat) as u8,
                );
            }
        }
    }
    picture
}

/// A sheet of heatmaps with what its colours mean below: from nothing to the share `most`, over the
/// root of the share.
#[must_use]
pub fn with_colour_bar(sheet: &Picture, most: f64) -> Picture {
    const BAR: usize = 12;
    let height = sheet.height() + BAR + text::LINE_HEIGHT + 10;
    let mut picture = Picture::filled(sheet.width(), height + height % 2, [24, 24, 28]);
    picture.paste(sheet, 0, 0);
    let (left, width) = (4, sheet.width().saturating_sub(8).clamp(1, 480));
    for x in 0..width {
        picture.fill(
            left + x,
            sheet.height() + 2,
            1,
            BAR,
            heat_colour(x as f64 / (width - 1).max(1) as f64),
        );
    }
    let percent = |share: f64| format!("{} %", crate::document::number(100.0 * share));
    let mut write = |x: usize, words: &str| {
        text::draw(
            &mut picture,
            x as isize,
            (sheet.height() + BAR + 4) as isize,
            words,
            [232, 232, 236],
        )
    };
    let end = percent(most);
    write(left, "0 %");
    write(left + width / 2 - text::width(&percent(most / 4.0)) / 2, &percent(most / 4.0));
    write(left + width - text::width(&end), &end);
    let words = "of all steps, in each place";
    if sheet.width() > left + width + text::width(words) + 12 {
        write(left + width + 8, words);
    }
    picture
}

/// The colour of a share of the most visited place, 0 to 1.
#[must_use]
pub fn heat_colour(heat: f64) -> [u8; 3] {
    let at = heat.clamp(0.0, 1.0) * (HEAT.len() - 1) as f64;
    let (low, share) =
        ((at as usize).min(HEAT.len() - 2), at - (at as usize).min(HEAT.len() - 2) as f64);
    [0, 1, 2].map(|c| (HEAT[low][c] + (HEAT[low + 1][c] - HEAT[low][c]) * share).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn north_is_up_and_unvisited_places_show_the_map() {
        let steps = vec![0.0, 9.0, 0.0, 0.0, 0.0, 0.0];
        let map = HeatmapData {
            frames: 1.0,
            episodes: 1,
            extent: [0.0, 0.0, 300.0, 200.0],
            columns: 3,
            rows: 2,
            automap: None,
            steps,
        };
        let picture =
            overlay(&map, Some(&Picture::filled(30, 20, [10, 20, 30])), 300, densest(&map));
        assert_eq!((picture.width(), picture.height()), (300, 200));
        // The visited cell is the middle one of the southern row.
        assert_ne!(picture.get(150, 150), [10, 20, 30]);
        assert_eq!(picture.get(150, 50), [10, 20, 30]);
        assert_eq!(picture.get(50, 150), [10, 20, 30]);
        // All steps were there: the top of a scale that ends at them, less on one that goes
        // further.
        assert_eq!(densest(&map), 1.0);
        assert_ne!(
            overlay(&map, None, 300, 4.0).get(150, 150),
            overlay(&map, None, 300, 1.0).get(150, 150)
        );
        let sheet = with_colour_bar(&picture, 0.02);
        assert_eq!(
            (sheet.get(4, 202), sheet.get(4 + 291, 202)),
            (heat_colour(0.0), heat_colour(1.0))
        );
    }
}
