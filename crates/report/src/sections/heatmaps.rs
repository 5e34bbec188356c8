//! Where agents have been, laid over the automap.

use super::setting;
use crate::document::{Block, Image, Section, count, frames, slug};
use crate::group::{Group, scenario_name};
use crate::heat::{densest, overlay, shown_size, with_colour_bar};
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

/// Moments at which several experiments are shown side by side, in frames; the paper's are at 100
/// million.
const FIXED: [f64; 8] = [1e6, 2e6, 5e6, 1e7, 3e7, 1e8, 3e8, 5e8];

/// For the first seed of each experiment that kept heatmaps: chosen moments side by side, and all
/// of them as animation.
pub(super) fn section(groups: &[Group], warnings: &mut Vec<Warning>) -> Section {
    let mut blocks = side_by_side(groups, warnings);
    for group in groups {
        let Some(run) = group.runs.iter().find(|run| !run.heatmaps.is_empty()) else { continue };
        let config = group.config();
        let name =
            format!("{} level {} {}", scenario_name(&config.scenario), config.level, config.algo);
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
            "Several experiments on one environment first, at equal frames; then each over its training. Steps that the agent spent at each place during the last episodes before a moment of training, over the map seen from above. \
             All pictures of a sheet have one scale, which the bar below it gives; brightness grows with the root of the share of steps."
                .into(),
        ],
        blocks,
    }
}

/// Experiments on one environment at equal moments of training: a row a moment, a column an
/// experiment.
fn side_by_side(groups: &[Group], warnings: &mut Vec<Warning>) -> Vec<Block> {
    let mut environments: BTreeMap<&str, Vec<(&Group, &Run)>> = BTreeMap::new();
    for group in groups {
        if let Some(run) = group.runs.iter().find(|run| !run.heatmaps.is_empty()) {
            environments.entry(&group.config().env).or_default().push((group, run));
        }
    }
    let mut blocks = Vec::new();
    for (env, members) in environments.iter().filter(|(_, members)| members.len() > 1) {
        let chosen =
            common_moments(&members.iter().map(|(_, run)| frames_of(run)).collect::<Vec<_>>());
        if chosen.is_empty() {
            continue;
        }
        let shown = &members[..members.len().min(6)];
        let automaps: Vec<Automaps> =
            shown.iter().map(|(_, run)| Automaps::read(run, warnings)).collect();
        let shown_at = |run: &Run, at: f64| nearest(&frames_of(run), at);
        let most = |at: f64| {
            shown
                .iter()
                .map(|(_, run)| densest(&run.heatmaps[shown_at(run, at)]))
                .fold(0.0, f64::max)
        };
        let most = chosen.iter().map(|at| most(*at)).fold(0.0, f64::max);
        let mut views: Vec<(Picture, String)> = Vec::new();
        for at in &chosen {
            for ((group, run), automaps) in shown.iter().zip(&automaps) {
                let nearest = shown_at(run, *at);
                let label = format!(
                    "{}, {} frames",
                    group.config().algo,
                    frames(run.heatmaps[nearest].frames)
                );
                views.push((automaps.overlay(run, nearest, 300, most), label));
            }
        }
        let panels: Vec<Panel> =
            views.iter().map(|(view, label)| Panel::new(view, label)).collect();
        let sheet = with_colour_bar(&grid(&panels, shown.len(), 1), most);
        blocks.push(Block::Image(Image {
            file: format!("{}.png", slug(&format!("heatmaps side by side {env}"))),
            caption: format!("{env}: experiments at equal frames, one seed each"),
            bytes: png::encode(&sheet),
            size: (sheet.width(), sheet.height()),
        }));
    }
    blocks
}

fn frames_of(run: &Run) -> Vec<f64> {
    run.heatmaps.iter().map(|map| map.frames).collect()
}

/// At most three of the fixed moments that every run has a heatmap within a tenth of; without any,
/// the last that all reached, if all have one near it.
fn common_moments(runs: &[Vec<f64>]) -> Vec<f64> {
    let near = |moment: f64| {
        runs.iter().all(|own| (own[nearest(own, moment)] - moment).abs() <= moment * 0.1)
    };
    let mut moments: Vec<f64> = FIXED.into_iter().filter(|moment| near(*moment)).collect();
    if moments.is_empty() {
        let last = runs.iter().filter_map(|own| own.last().copied()).fold(f64::INFINITY, f64::min);
        moments.extend(Some(last).filter(|last| last.is_finite() && near(*last)));
    }
    let skip = moments.len().saturating_sub(3);
    moments.split_off(skip)
}

/// Index of the moment nearest to `at`.
fn nearest(moments: &[f64], at: f64) -> usize {
    let distance = |index: &usize| (moments[*index] - at).abs();
    (0..moments.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

/// The pictures that a run's heatmaps lie on: one, or one a level of a curriculum.
struct Automaps(BTreeMap<PathBuf, Picture>);

impl Automaps {
    fn read(run: &Run, warnings: &mut Vec<Warning>) -> Automaps {
        let paths: BTreeSet<PathBuf> =
            run.heatmaps.iter().filter_map(|map| run.automap(map)).collect();
        let mut pictures = BTreeMap::new();
        for path in paths {
            match png::read(&path) {
                Ok(picture) => drop(pictures.insert(path, picture)),
                Err(error) => {
                    let problem =
                        error.to_string().replacen(&format!("{}: ", path.display()), "", 1);
                    warnings.push(Warning { path, line: 0, problem });
                }
            }
        }
        Automaps(pictures)
    }

    /// A heatmap of the run over its picture.
    fn overlay(&self, run: &Run, at: usize, side: usize, most: f64) -> Picture {
        let map = &run.heatmaps[at];
        overlay(map, run.automap(map).and_then(|path| self.0.get(&path)), side, most)
    }
}

fn last_counted(run: &Run) -> String {
    run.heatmaps.last().map_or_else(String::new, |map| {
        format!("The last picture counts {}.", count(map.episodes as usize, "episode"))
    })
}

/// About equally spaced moments from the first to the last, side by side.
fn moments(run: &Run, automaps: &Automaps) -> Picture {
    let most = spread(run.heatmaps.len(), MOMENTS)
        .map(|at| densest(&run.heatmaps[at]))
        .fold(0.0, f64::max);
    let views: Vec<(Picture, &HeatmapData)> = spread(run.heatmaps.len(), MOMENTS)
        .map(|at| (automaps.overlay(run, at, 360, most), &run.heatmaps[at]))
        .collect();
    let panels: Vec<Panel> = views
        .iter()
        .map(|(view, map)| Panel::new(view, format!("{} frames", frames(map.frames))))
        .collect();
    let columns =
        if views[0].0.width() > 2 * views[0].0.height() { 1 } else { panels.len().min(2) };
    with_colour_bar(&grid(&panels, columns, 1), most)
}

/// `count` of `0..length`, first and last among them.
fn spread(length: usize, count: usize) -> impl Iterator<Item = usize> {
    let count = count.min(length);
    (0..count).map(move |k| if count == 1 { length - 1 } else { k * (length - 1) / (count - 1) })
}

fn animation(run: &Run, automaps: &Automaps) -> Result<(Vec<u8>, (usize, usize)), String> {
    // The writer makes files; a folder of our own keeps two reports at once apart.
    let folder = std::env::temp_dir().join(format!(
        "hasard-report-{}-{:x}",
        std::process::id(),
        std::ptr::from_ref(run) as usize
    ));
    let path = folder.join("animation.gif");
    let result = (|| {
        let chosen: Vec<usize> = spread(run.heatmaps.len(), MOST_PICTURES).collect();
        let (width, height) = shown_size(&run.heatmaps[0], 480);
        let most = chosen.iter().map(|at| densest(&run.heatmaps[*at])).fold(0.0, f64::max);
        let mut writer = GifWriter::create(&path, width, height)?;
        for (k, &at) in chosen.iter().enumerate() {
            let mut view = automaps.overlay(run, at, 480, most).resized(width, height);
            hasard_media::text::draw_shadowed(
                &mut view,
                6,
                4,
                &format!("{} frames", frames(run.heatmaps[at].frames)),
                [255; 3],
            );
            let last = k + 1 == chosen.len();
            writer.push(
                &view,
                ANIMATION_SECONDS / chosen.len() as f64 + if last { 1.0 } else { 0.0 },
            )?;
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
    use super::{common_moments, spread};

    #[test]
    fn experiments_are_compared_at_moments_that_all_have() {
        let every =
            |step: f64, to: u32| (1..=to).map(|k| f64::from(k) * step).collect::<Vec<f64>>();
        // One reaches 12 million, the other 6: of the fixed moments 1, 2 and 5 million lie in both.
        assert_eq!(common_moments(&[every(1e6, 12), every(1e6, 6)]), [1e6, 2e6, 5e6]);
        assert_eq!(common_moments(&[every(1e6, 100), every(5e6, 20)]), [1e7, 3e7, 1e8]);
        // Short runs: the last moment of the shorter one.
        assert_eq!(common_moments(&[every(1e5, 6), every(1e5, 4)]), [4e5]);
        assert!(common_moments(&[vec![4e5], vec![7e5]]).is_empty());
    }

    #[test]
    fn moments_include_the_first_and_the_last() {
        assert_eq!(spread(10, 4).collect::<Vec<_>>(), [0, 3, 6, 9]);
        assert_eq!(spread(3, 4).collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!(spread(1, 4).collect::<Vec<_>>(), [0]);
        assert_eq!(spread(2, 1).collect::<Vec<_>>(), [1]);
    }
}
