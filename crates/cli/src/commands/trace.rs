//! `hasard trace`: recorded inputs, tic by tic.

use crate::args::{Size, TraceArgs};
use crate::failure::{Failure, Outcome};
use crate::settings;
use hasard_engine::math::{Angle, Fixed};
use hasard_engine::world::Command;
use hasard_envs::{Env, FRAME_SKIP, parse_command};
use serde_json::json;
use std::io::{BufWriter, Write};
use std::path::Path;

/// The columns after `tic` and `action`.
const COLUMNS: [&str; 12] = [
    "POSITION_X",
    "POSITION_Y",
    "POSITION_Z",
    "ANGLE",
    "PITCH",
    "VELOCITY_X",
    "VELOCITY_Y",
    "VELOCITY_Z",
    "VIEW_HEIGHT",
    "HEALTH",
    "ON_GROUND",
    "CAMERA_POSITION_Z",
];

/// Runs the command.
pub fn run(args: &TraceArgs) -> Outcome {
    if args.env_args.frame_skip != FRAME_SKIP {
        return Err(Failure::bad(format!(
            "--frame-skip {}: trace plays tic by tic; leave it out",
            args.env_args.frame_skip
        )));
    }
    if let Some(size) = &args.env_args.size {
        return Err(Failure::bad(format!("--size {size}: trace draws nothing; leave it out")));
    }
    let mut options = settings::env_options(&args.env_args, Size::LEARNER)?;
    options.frame_skip = 1;
    let actions = read_actions(&args.actions)?;
    let start = args.start.as_deref().map(parse_start).transpose()?;
    let mut env = Env::new(&args.env, &options).map_err(Failure::bad)?;
    env.reset(args.seed);
    while env.world().tic < args.after {
        if env.step_buttons(Command::default()).ended() {
            return Err(Failure::bad(format!(
                "--after {}: the episode ends at tic {}; give fewer tics",
                args.after,
                env.world().tic
            )));
        }
    }
    if let Some(Start { position: [x, y, z], angle, pitch }) = start {
        check_place(&env, args.start.as_deref().unwrap_or_default(), [x, y, z])?;
        env.world_mut().place_player(0, x, y, z, angle, pitch);
    }
    let mut out = BufWriter::new(std::io::stdout().lock());
    if !args.json {
        writeln!(out, "tic,action,{}", COLUMNS.join(","))?;
    }
    row(&mut out, args.json, 0, "start", &env)?;
    for (i, (name, command)) in actions.iter().enumerate() {
        let ended = env.step_buttons(*command).ended();
        row(&mut out, args.json, i + 1, name, &env)?;
        if ended {
            if args.json {
                writeln!(out, "{}", json!({ "tic": i + 2, "action": "FINISHED" }))?;
            } else {
                writeln!(out, "{},FINISHED{}", i + 2, ",".repeat(COLUMNS.len()))?;
            }
            break;
        }
    }
    out.flush()?;
    Ok(())
}

/// A place to start from.
struct Start {
    position: [Fixed; 3],
    angle: Angle,
    pitch: i32,
}

fn parse_start(text: &str) -> Result<Start, Failure> {
    let wrong = || {
        Failure::bad(format!(
            "--start '{text}': write X,Y,Z,ANGLE[,PITCH] in map units (below 32768) and degrees"
        ))
    };
    let numbers: Vec<f64> = text
        .split(',')
        .map(|part| part.trim().parse::<f64>())
        .collect::<Result<_, _>>()
        .map_err(|_| wrong())?;
    let (position, angle, pitch) = match numbers[..] {
        [x, y, z, angle] => ([x, y, z], angle, 0.0),
        [x, y, z, angle, pitch] => ([x, y, z], angle, pitch),
        _ => return Err(wrong()),
    };
    if position.iter().any(|value| !(-32768.0..32768.0).contains(value))
        || !(-360.0..=360.0).contains(&angle)
        || !(-90.0..=90.0).contains(&pitch)
    {
        return Err(wrong());
    }
    Ok(Start {
        position: position.map(Fixed::from_f64),
        angle: Angle::from_degrees(angle),
        pitch: (pitch / 360.0 * 4_294_967_296.0) as i32,
    })
}

/// Refuses a start in rock, where the map has nothing to stand on: a tic there means nothing. That
/// a wall or a thing is near is left to the player, as recordings begin in such places too.
fn check_place(env: &Env, text: &str, [x, y, z]: [Fixed; 3]) -> Outcome {
    let world = env.world();
    let [west, south, east, north] = env.extent();
    let within = (west..=east).contains(&(x.0 >> 16)) && (south..=north).contains(&(y.0 >> 16));
    let refuse = |why: String| Err(Failure::bad(format!("--start '{text}': {why}")));
    if !within || !world.map.is_inside(x, y) {
        return refuse(format!(
            "X,Y is in rock or off the map, which has X from {west} to {east} and Y from {south} to {north}; give a place on its \
             floor, such as the episode's own that a trace without --start begins with"
        ));
    }
    let here = world.sector(world.map.sector_at(x, y));
    // Recordings round heights.
    if z < here.floor - Fixed::from_int(1) || z > here.ceiling {
        let (floor, ceiling) = (here.floor.to_f64(), here.ceiling.to_f64());
        return refuse(format!(
            "Z is in rock; give one from the floor, {floor}, to the ceiling, {ceiling}"
        ));
    }
    Ok(())
}

/// The actions of a CSV file's `action` column, without its `start` and `FINISHED` rows.
fn read_actions(path: &Path) -> Result<Vec<(String, Command)>, Failure> {
    let name = path.display();
    let bytes = hasard_media::files::read_limited(path, 1 << 26).map_err(Failure::bad)?;
    let text = String::from_utf8(bytes).map_err(|_| {
        Failure::bad(format!("{name}: not text; give a CSV file with an 'action' column"))
    })?;
    // As spreadsheets write it: a mark of UTF-8 in front, and quotes about fields.
    let mut lines = text.trim_start_matches('\u{feff}').lines();
    let fields = |line: &'_ str| -> Vec<String> {
        line.split(',').map(|field| field.trim().trim_matches('"').trim().to_string()).collect()
    };
    let header = lines.next().unwrap_or_default();
    let column = fields(header).iter().position(|field| field == "action");
    let column = column.ok_or_else(|| {
        Failure::bad(format!(
            "{name}: its first line names no 'action' column; add a header line such as tic,action"
        ))
    })?;
    let mut actions = Vec::new();
    for (number, line) in lines.enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let action = fields(line).into_iter().nth(column);
        let action = action.ok_or_else(|| {
            Failure::bad(format!(
                "{name} line {}: no 'action' field; every line needs one",
                number + 2
            ))
        })?;
        match action.as_str() {
            "start" => {}
            "FINISHED" => break,
            _ => {
                let command = parse_command(&action).map_err(|error| {
                    Failure::bad(format!("{name} line {}: {error}", number + 2))
                })?;
                actions.push((action, command));
            }
        }
    }
    Ok(actions)
}

fn row(out: &mut impl Write, as_json: bool, tic: usize, action: &str, env: &Env) -> Outcome {
    let world = env.world();
    let player = &world.players[0];
    let body = world
        .get(player.actor)
        .ok_or_else(|| Failure::bad("the player's body is gone; please report this"))?;
    let degrees = |units: i32| f64::from(units) * 360.0 / 4_294_967_296.0;
    let values = [
        body.x.to_f64(),
        body.y.to_f64(),
        body.z.to_f64(),
        body.angle.to_degrees(),
        degrees(player.pitch),
        body.vx.to_f64(),
        body.vy.to_f64(),
        body.vz.to_f64(),
        (player.view_z - body.z).to_f64(),
        f64::from(body.health),
        f64::from(u8::from(player.on_ground)),
        player.view_z.to_f64(),
    ];
    if as_json {
        let mut object = serde_json::Map::new();
        object.insert("tic".into(), json!(tic));
        object.insert("action".into(), json!(action));
        object.extend(
            COLUMNS.iter().zip(values).map(|(column, value)| ((*column).to_string(), json!(value))),
        );
        writeln!(out, "{}", serde_json::Value::Object(object))?;
    } else {
        let fields: Vec<String> = values.iter().map(|value| six_places(*value)).collect();
        writeln!(out, "{tic},{action},{}", fields.join(","))?;
    }
    Ok(())
}

/// At most six decimal places and at least one, as in the recorded files.
fn six_places(value: f64) -> String {
    let text = format!("{value:.6}");
    let trimmed = text.trim_end_matches('0');
    let text = if trimmed.ends_with('.') { format!("{trimmed}0") } else { trimmed.to_string() };
    if text == "-0.0" { "0.0".into() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn actions_are_read_as_spreadsheets_write_them() {
        let file = std::env::temp_dir().join(format!("hasard-trace-{}.csv", std::process::id()));
        let read = |text: &str| {
            std::fs::write(&file, text).unwrap();
            let actions = read_actions(&file).ok().unwrap();
            actions.into_iter().map(|(name, _)| name).collect::<Vec<_>>()
        };
        let plain = read("tic,action\n0,start\n1,MOVE_FORWARD\n2,ATTACK\n3,FINISHED\n");
        assert_eq!(plain, ["MOVE_FORWARD", "ATTACK"]);
        let spreadsheet =
            "\u{feff}\"tic\",\"action\"\r\n\"1\",\"MOVE_FORWARD\"\r\n2,\"ATTACK\"\r\n";
        assert_eq!(read(spreadsheet), plain);
        std::fs::remove_file(file).unwrap();
    }
}
