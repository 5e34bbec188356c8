//! `hasard check`: all that is wrong with a scenario's file, and its map from above.

use crate::args::CheckArgs;
use crate::commands::record::is_png;
use crate::failure::{Failure, Lines, Outcome};
use hasard_engine::world::ActorKind;
use hasard_envs::{Env, EnvOptions, own};
use serde_json::json;

/// Longer side of the map's picture, pixels.
const SIDE: usize = 800;

/// Runs the command.
pub fn run(args: &CheckArgs) -> Outcome {
    args.out.as_deref().map_or(Ok(()), is_png)?;
    let name = args.file.to_string_lossy();
    if let Some((whole, level)) = name.rsplit_once('#').filter(|_| !args.file.exists()) {
        return Err(Failure::bad(format!(
            "{name}: all levels are checked; give {whole}, and --level {level} to draw that one"
        )));
    }
    let spelt = args.file.to_str().ok_or_else(|| {
        Failure::bad(format!("{name}: a task's name is UTF-8 text; rename the file"))
    })?;
    if args.file.exists() && !own::is_file(spelt) {
        return Err(Failure::bad(format!(
            "{name}: a task's file ends in .toml, by which other commands know it; rename it"
        )));
    }
    let (text, unread) = own::read_to_check(&args.file).map_err(Failure::bad)?;
    let checked = own::check(&text);
    let file = args.file.display().to_string();
    let mut lines = Lines::new();
    for mistake in &checked.mistakes {
        if args.json {
            let (line, column, warning) = (mistake.line, mistake.column, mistake.warning);
            lines.say(
                json!({ "file": file, "line": line, "column": column, "warning": warning, "problem": mistake.text })
            );
        } else {
            lines.say(format!("{file}:{mistake}"));
        }
    }
    // A file that cannot be read is bad input, and not only a task to mend.
    if let Some(error) = unread {
        lines.end(Ok(()))?;
        return Err(Failure::bad(error));
    }
    let wrong = checked.mistakes.iter().filter(|mistake| !mistake.warning).count();
    if !checked.can_be_played() {
        return Err(Failure::Negative(format!("{file}: {wrong} to mend before it can be played")));
    }
    lines.end(Ok(()))?;
    let scenario = own::register(&file, &text).map_err(Failure::bad)?;
    let Some(id) = scenario.environments().nth(usize::from(args.level.max(1)) - 1) else {
        return Err(Failure::bad(format!(
            "--level {}: its levels are 1 to {}",
            args.level,
            scenario.levels.max(1)
        )));
    };
    let options = EnvOptions { scenario: Some(scenario), ..EnvOptions::default() };
    let mut env = Env::new(&id.to_string(), &options).map_err(Failure::bad)?;
    env.reset(args.seed);
    if let Some(out) = &args.out {
        let (map, width, height) = env.top_down_of_extent(SIDE);
        let mut pixels = vec![0; width * height * 3];
        map.draw(env.world(), &mut pixels);
        let picture =
            hasard_media::Picture::from_rgb(width, height, pixels).map_err(Failure::bad)?;
        hasard_media::png::write(&picture, out).map_err(Failure::bad)?;
    }
    // What the map shows: not the agent, nor the places that monsters walk to.
    let shown = |kind: ActorKind| !matches!(kind, ActorKind::Player | ActorKind::PatrolPoint);
    let things = env.world().living().filter(|(_, actor)| shown(actor.kind)).count();
    let ids: Vec<String> = scenario.environments().map(|id| id.to_string()).collect();
    let drawn = args.out.as_ref().map(|out| out.display().to_string());
    if args.json {
        let terms: Vec<&str> = scenario.cost_terms.iter().map(|term| term.name).collect();
        say!(
            "{}",
            json!({ "file": file, "scenario": scenario.name, "ids": ids, "things": things, "cost_terms": terms, "map": drawn })
        );
    } else {
        let drawn = drawn.map_or(String::new(), |out| format!("; its map is drawn in {out}"));
        say!(
            "{file}: can be played as {}; {things} {} at the start of seed {}{drawn}",
            ids.join(", "),
            if things == 1 { "thing" } else { "things" },
            args.seed
        );
    }
    Ok(())
}
