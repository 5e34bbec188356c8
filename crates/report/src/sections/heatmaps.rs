//! Where agents have been, laid over the automap.

use super::setting;
use crate::document::{Block, Image, Section, frames, slug};
use crate::group::{Group, scenario_name};
use crate::heat::{overlay, shown_size};
use crate::run::{HeatmapData, Run, Warning};
use hasard_media::compose::{Panel, grid};
use hasard_media::gif::GifWriter;
use hasard_media::{Picture, png};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Moments of training that are shown side by side.
const MOMENTS: usize = 4;
/// Most pictures of an animation, and its length in seconds.
const MOST_PICTURES: usize = 60;
const ANIMATION_SECONDS: f64 = 7.0;

/// For the first seed of each experiment that kept heatmaps: chosen moments side by side, and all of them as animation.
pub(super) fn section(groups: &[Group], warnings: &mut Vec<Warning>) -> Section {
    let mut blocks = Vec::new();
    for group in groups {
        let Some(run) = group.runs.iter().find(|run| !run.heatmaps.is_empty()) else { continue };
        let config = group.config();
        let name = format!("{} level {} {}", scenario_name(&config.scenario), config.level, config.algo);
        let file = slug(&format!("heatmap {name} {}", setting(group)));
        let caption = format!("{name}, seed {}; {}", run.config.seed, setting(group));
        let automaps = Automaps::read(run, warnings);
        let sheet = moments(run, &automaps);
        blocks.push(Block::Image(Image {
            file: format!("{file}.png"),
            caption: format!("{caption}. {}", last_counted(run)),
            bytes: png::encode(&sheet),
            size: (sheet.width(), sheet.height()),
        }));
        if run.heatmaps.len() > 1 {
            match animation(run, &automaps) {
                Ok((bytes, size)) => {
                    blocks.push(Block::Image(Image {
                        file: format!("{file}.gif"),
                        caption: format!("{caption}: over training"),
                        bytes,
                        size,
                    }));
                }
                Err(problem) => warnings.push(Warning { path: run.path.clone(), line: 0, problem }),
            }
        }
    }
    Section {
        slug: "heatmaps".into(),
        title: "Where agents go".into(),
        text: vec![
            "Steps that the agent spent at each place during the last episodes before a moment of training, over the map seen from above. \
             The brightest place of each picture is its most visited; brightness grows with the root of the share of steps."
                .into(),
        ],
        blocks,
    }
}

/// The pictures that a run's heatmaps lie on: one, or one a level of a curriculum.
struct Automaps(BTreeMap<PathBuf, Picture>);

impl Automaps {
    fn read(run: &Run, warnings: &mut Vec<Warning>) -> Automaps {
        let paths: BTreeSet<PathBuf> = run.heatmaps.iter().filter_map(|map| run.automap(map)).collect();
        let mut pictures = BTreeMap::new();
        for path in paths {
            match png::read(&path) {
                Ok(picture) => drop(pictures.insert(path, picture)),
                Err(error) => {
                    let problem = error.to_string().replacen(&format!("{}: ", path.display()), "", 1);
                    warnings.push(Warning { path, line: 0, problem });
                }
            }
        }
        Automaps(pictures)
    }

    /// A heatmap of the run over its picture.
    fn overlay(&self, run: &Run, at: usize, side: usize) -> Picture {
        let map = &run.heatmaps[at];
        overlay(map, run.automap(map).and_then(|path| self.0.get(&path)), side)
    }
}

fn last_counted(run: &Run) -> String {
    run.heatmaps.last().map_or_else(String::new, |map| format!("The last picture counts {} episodes.", map.episodes))
}

/// About equally spaced moments from the first to the last, side by side.
fn moments(run: &Run, automaps: &Automaps) -> Picture {
    let views: Vec<(Picture, &HeatmapData)> =
        spread(run.heatmaps.len(), MOMENTS).map(|at| (automaps.overlay(run, at, 360), &run.heatmaps[at])).collect();
    let panels: Vec<Panel> = views.iter().map(|(view, map)| Panel::new(view, format!("{} frames", frames(map.frames)))).collect();
    let columns = if views[0].0.width() > 2 * views[0].0.height() { 1 } else { panels.len().min(2) };
    grid(&panels, columns, 1)
}

/// `count` of `0..length`, first and last among them.
fn spread(length: usize, count: usize) -> impl Iterator<Item = usize> {
    let count = count.min(length);
    (0..count).map(move |k| if count == 1 { length - 1 } else { k * (length - 1) / (count - 1) })
}

fn animation(run: &Run, automaps: &Automaps) -> Result<(Vec<u8>, (usize, usize)), String> {
    // The writer makes files; a folder of our own keeps two reports at once apart.
    let folder =
        std::env::temp_dir().join(format!("hasard-report-{}-{:x}", std::process::id(), std::ptr::from_ref(run) as usize));
    let path = folder.join("animation.gif");
    let result = (|| {
        let chosen: Vec<usize> = spread(run.heatmaps.len(), MOST_PICTURES).collect();
        let (width, height) = shown_size(&run.heatmaps[0], 480);
        let mut writer = GifWriter::create(&path, width, height)?;
        for (k, &at) in chosen.iter().enumerate() {
            let mut view = automaps.overlay(run, at, 480).resized(width, height);
            hasard_media::text::draw_shadowed(&mut view, 6, 4, &format!("{} frames", frames(run.heatmaps[at].frames)), [255; 3]);
            let last = k + 1 == chosen.len();
            writer.push(&view, ANIMATION_SECONDS / chosen.len() as f64 + if last { 1.0 } else { 0.0 })?;
        }
        writer.finish()?;
        let bytes = hasard_media::files::read_limited(&path, 256 << 20)?;
        Ok((bytes, (width, height)))
    })();
    let _ = std::fs::remove_dir_all(&folder);
    result.map_err(|error: hasard_media::MediaError| format!("no animation of heatmaps: {error}"))
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn moments_include_the_first_and_the_last() {
        assert_eq!(spread(10, 4).collect::<Vec<_>>(), [0, 3, 6, 9]);
        assert_eq!(spread(3, 4).collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!(spread(1, 4).collect::<Vec<_>>(), [0]);
        assert_eq!(spread(2, 1).collect::<Vec<_>>(), [1]);
    }
}
