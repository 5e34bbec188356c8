//! `hasard contact-sheet`: the scenarios in pictures, to be looked at.

use crate::args::ContactSheetArgs;
use crate::contact_sheet::layout::{Row, sheet};
use crate::failure::{Failure, Outcome};
use hasard_engine::render::FrameSize;
use hasard_envs::scenarios::Moment;
use hasard_envs::{Env, EnvId, EnvOptions, Policy, PolicyRun, Scenario};
use hasard_media::{Picture, files, png};
use hasard_play::{ViewKind, Views};
use std::path::Path;

/// The size for people.
const LARGE: FrameSize = FrameSize { width: 640, height: 480 };

/// Runs the command.
pub fn run(args: &ContactSheetArgs) -> Outcome {
    let scenarios = match args.scenarios.as_slice() {
        [] => Scenario::ALL.to_vec(),
        names => names.iter().map(|name| scenario(name)).collect::<Result<_, _>>()?,
    };
    let looks = crate::sources::looks(args.maps.as_deref(), args.iwad.as_deref())?;
    std::fs::create_dir_all(&args.out).map_err(|error| {
        Failure::bad(format!("{}: {error}; name a folder that can be written", args.out.display()))
    })?;
    for scenario in scenarios {
        let (moments, cover) = scenario.moments;
        let own = own_moments(scenario);
        let moments = if moments.is_empty() { &own[..] } else { moments };
        let rows = moments.iter().map(|moment| row(scenario, moment, args.seed, &looks));
        let rows: Vec<Row> = rows.collect::<Result<_, _>>()?;
        let name = scenario.file_name();
        write(
            &sheet(&rows).in_few_colours(),
            &args.out.join(format!("{name}_sheet.png")),
            args.json,
        )?;
        write(&rows[cover].large[0], &args.out.join(format!("{name}.png")), args.json)?;
    }
    Ok(())
}

fn scenario(name: &str) -> Result<Scenario, Failure> {
    if hasard_envs::own::is_file(name) {
        return hasard_envs::own::open(name).map(|id| id.scenario).map_err(Failure::bad);
    }
    let names = Scenario::ALL.map(Scenario::name);
    let found =
        Scenario::ALL.into_iter().find(|scenario| scenario.name().eq_ignore_ascii_case(name));
    found.ok_or_else(|| {
        Failure::bad(format!("{name} is no scenario; the scenarios are {}", names.join(", ")))
    })
}

/// Moments of a scenario for which nobody has chosen any: early and late in each of its first three
/// levels.
fn own_moments(scenario: Scenario) -> Vec<Moment> {
    const EARLY: &[(u32, &str)] = &[(10, "sticky:10")];
    const LATE: &[(u32, &str)] = &[(60, "sticky:10")];
    let levels = scenario.environments().take(3).map(|id| id.level);
    levels
        .flat_map(|level| {
            [Moment { level, seed: 1, way: EARLY }, Moment { level, seed: 2, way: LATE }]
        })
        .collect()
}

/// Plays to a moment and draws it in every view.
fn row(scenario: Scenario, moment: &Moment, seed: u64, looks: &EnvOptions) -> Result<Row, Failure> {
    let id = EnvId { scenario, level: moment.level };
    let options = EnvOptions { size: FrameSize::LEARNER, ..looks.clone() };
    let mut env = Env::new(&id.to_string(), &options).map_err(Failure::bad)?;
    let seed = moment.seed + seed;
    env.reset(seed);
    for &(steps, policy) in moment.way {
        let policy: Policy = policy.parse().map_err(Failure::bad)?;
        let mut policy = PolicyRun::new(policy, &env, seed).map_err(Failure::bad)?;
        for _ in 0..steps {
            env.make_move(policy.next_move(&env)).map_err(Failure::bad)?;
        }
    }
    let episode = env.episode();
    let seconds = f64::from(env.world().tic) / 35.0;
    let caption = format!(
        "{} level {}, {seconds:.1} s, seed {seed}: reward {:.1}, cost {:.1}   view, depth, classes and map at 640x480 (reduced) and at 128x72",
        scenario.name(),
        moment.level,
        episode.episode_return,
        episode.cost
    );
    Ok(Row { caption, large: views(&env, LARGE)?, small: views(&env, FrameSize::LEARNER)? })
}

/// The present moment: colour, depth, segmentation and the map from above.
fn views(env: &Env, size: FrameSize) -> Result<[Picture; 4], Failure> {
    let kinds = [ViewKind::Colour, ViewKind::Depth, ViewKind::Segmented, ViewKind::Automap];
    let pictures = Views::of(env, size, &kinds).map_err(Failure::bad)?.pictures(env.world());
    Ok(pictures.try_into().expect("a picture for each kind"))
}

fn write(picture: &Picture, path: &Path, json: bool) -> Outcome {
    let bytes = png::encode(picture);
    files::write_whole(path, &bytes).map_err(Failure::bad)?;
    let (file, width, height) = (path.display().to_string(), picture.width(), picture.height());
    if json {
        say!(
            "{}",
            serde_json::json!({ "file": file, "width": width, "height": height, "bytes": bytes.len() })
        );
    } else {
        say!("{file}: {width}x{height}, {} kB", bytes.len().div_ceil(1000));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_moment_can_be_reached_and_every_scenario_is_found_by_name() {
        for scenario in Scenario::ALL {
            assert_eq!(super::scenario(scenario.name()).unwrap(), scenario);
            let (moments, cover) = scenario.moments;
            assert!(cover < moments.len());
            for moment in moments {
                let row = row(scenario, moment, 0, &EnvOptions::default()).unwrap();
                assert_eq!((row.large[0].width(), row.small[0].height()), (640, 72));
                assert!(moment.way.iter().all(|(_, policy)| policy.parse::<Policy>().is_ok()));
            }
        }
        assert_eq!(Scenario::RemedyRush.file_name(), "remedy_rush");
        assert!(super::scenario("Doom").is_err());
    }
}
