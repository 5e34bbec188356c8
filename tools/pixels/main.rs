//! The same moments as ViZDoom draws them and as this one does: how many pixels are
//! equal.
//!
//! ```sh
//! python tools/dump_published_scenes.py SCENES --levels 1,2,3 --moments 40
//! cargo run --release -p hasard-envs --example pixels -- SCENES/* [--out DIR] [--list]
//! ```
//!
//! A folder of scenes holds `scenes.json` and the pictures of one level. Map and art are those that
//! the published packages use, named in that file. `--out` writes a picture of every moment,
//! theirs, ours and the difference beside one another; `--list` prints a line for every moment.
//! Pixels are compared by what the published label says of them: 0 and 1 are the world, 255 the
//! weapon, others things. What ViZDoom does not report of a moment is found by trying.
//!
//! Squares that rockets shed lie where ViZDoom's chance has them, if the scenes say
//! what that began with.

mod chance;
mod dump;
mod hidden_state;
mod pose;
mod sheet;
mod tally;

use dump::Level;
use hasard_engine::render::{Buffers, class};
use pose::{Stage, leave_trails};
use std::path::{Path, PathBuf};
use tally::{Kind, Tallies};

/// Anything that can go wrong here ends the program with a line.
type Any<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Any<()> {
    let (mut folders, mut out, mut list) = (Vec::new(), None, false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--out" => out = Some(PathBuf::from(arguments.next().ok_or("--out takes a folder")?)),
            "--list" => list = true,
            _ => folders.push(PathBuf::from(argument)),
        }
    }
    if folders.is_empty() {
        return Err("name the folders that dump_published_scenes.py wrote".into());
    }
    if let Some(out) = &out {
        std::fs::create_dir_all(out)?;
    }
    println!(
        "| level | pixels of | number | equal % | within 8 % | mean difference |\n|---|---|--:|--:|--:|--:|"
    );
    let mut whole = Tallies::default();
    for folder in &folders {
        let tallies = level(folder, out.as_deref(), list)?;
        tallies.print(&name(folder));
        whole.join(&tallies);
    }
    if folders.len() > 1 {
        whole.print("all");
    }
    Ok(())
}

fn name(folder: &Path) -> String {
    folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn level(folder: &Path, out: Option<&Path>, list: bool) -> Any<Tallies> {
    let level = Level::read(folder)?;
    let mut stage = Stage::new(&level)?;
    let mut tallies = Tallies::default();
    for moment in &level.scenes {
        let theirs = dump::Pictures::read(folder, moment.number)?;
        let mut posed = stage.pose(&level, moment);
        let guess = hidden_state::find(&mut stage, &mut posed, &theirs, &level.scenario, moment);
        leave_trails(&mut posed.world, moment);
        stage.renderer.render(
            &mut stage.scratch,
            &posed.world,
            0,
            Buffers { depth: true, labels: true },
        );
        stage.renderer.write_rgb_hwc(&mut stage.rgb);
        let own = compare(&stage, &posed, &theirs, moment, &level.scenario);
        if list {
            println!(
                "{} {:2} tic {:5}: {guess}; {}",
                name(folder),
                moment.number,
                moment.tic,
                own.summary()
            );
        }
        if let Some(out) = out {
            let path = out.join(format!("{}_{:02}.png", name(folder), moment.number));
            sheet::write(&path, stage.size, [&theirs.rgb, &stage.rgb])?;
        }
        tallies.join(&own);
    }
    Ok(tallies)
}

/// Counts the pixels of a moment.
fn compare(
    stage: &Stage,
    posed: &pose::Posed,
    theirs: &dump::Pictures,
    moment: &dump::Moment,
    scenario: &str,
) -> Tallies {
    let mut own = Tallies::default();
    let (classes, depth) = (stage.renderer.classes(), stage.renderer.depth());
    let view = stage.renderer.view().view_rows() * stage.size[0];
    if stage.size == [160, 120] {
        for at in (0..72)
            .flat_map(|row| (0..128).map(move |column| row * 120 / 72 * 160 + column * 160 / 128))
        {
            own.add(Kind::Learner, &theirs.rgb[3 * at..][..3], &stage.rgb[3 * at..][..3]);
        }
    }
    for (at, (a, b)) in theirs.rgb.chunks_exact(3).zip(stage.rgb.chunks_exact(3)).enumerate() {
        let label = theirs.labels[at];
        if at >= view {
            own.add(Kind::StatusBar, a, b);
        } else if label == 255 {
            // Only who stands still holds the weapon still.
            if scenario == "collateral_damage" {
                own.add(Kind::Weapon, a, b);
            }
        } else if label > 1 {
            if posed.actors.iter().any(|&(value, _)| value == label) {
                let name = moment
                    .labels
                    .iter()
                    .find(|thing| thing.value == label)
                    .map_or("", |thing| &thing.name);
                own.add_thing(name, a, b);
            }
        } else if classes[at] < class::FIRST_ACTOR && classes[at] != class::WEAPON {
            let kind = match classes[at] {
                class::FLOOR | class::OTHER_FLOOR => Kind::Floor,
                class::CEILING | class::OTHER_CEILING => Kind::Ceiling,
                class::SKY => Kind::Sky,
                _ => Kind::Wall,
            };
            own.add(kind, a, b);
            own.add(Kind::World, a, b);
            let plane = matches!(classes[at], class::FLOOR | class::CEILING);
            own.add(Kind::Labels, &[label], &[u8::from(plane)]);
            own.add(Kind::Depth, &[theirs.depth[at]], &[depth[at]]);
        }
    }
    own
}
