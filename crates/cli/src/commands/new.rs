//! `hasard new`: a scenario's file to begin with.

use crate::args::NewArgs;
use crate::failure::{Failure, Outcome};
use std::path::{Path, PathBuf};

/// Runs the command.
pub fn run(args: &NewArgs) -> Outcome {
    let name = scenario_name(&args.name).ok_or_else(|| {
        Failure::bad(format!(
            "'{}': a task's name has letters, digits and _, a letter first: my_task",
            args.name
        ))
    })?;
    let path = args
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from(format!("{}.toml", file_name(&args.name))));
    taken_by_commands(&path)?;
    if path.exists() {
        return Err(Failure::bad(format!(
            "{}: is there already; choose another name, or another place with --out",
            path.display()
        )));
    }
    let text = hasard_envs::own::template(&name);
    let checked = hasard_envs::own::check(&text);
    if let Some(mistake) = checked.mistakes.iter().find(|mistake| !mistake.warning) {
        return Err(Failure::bad(format!("{}: {}", args.name, mistake.text)));
    }
    hasard_media::files::write_whole(&path, text.as_bytes()).map_err(Failure::bad)?;
    let (file, shown) = (path.display().to_string(), hasard_media::shell::quote(&path));
    if args.json {
        say!(
            "{}",
            serde_json::json!({ "file": file, "scenario": name, "id": format!("{name}-v0") })
        );
    } else {
        say!(
            "{file}: the task {name}. Play it: hasard play {shown}; train on it: hasard train {shown}; check it: hasard check {shown}"
        );
    }
    Ok(())
}

/// Whether every command takes a file of this name for a task: by its ending, and not as a flag, a
/// level of another or several tasks.
fn taken_by_commands(path: &Path) -> Outcome {
    let name = path.to_string_lossy();
    let refused = |why: &str| Err(Failure::bad(format!("--out {name}: {why}")));
    if path.to_str().is_none() {
        return refused("a path that is no UTF-8 text names no task; choose another name");
    }
    if name.starts_with('-') {
        return refused("a name that begins with - reads as a flag; put ./ before it");
    }
    if let Some(mark) = name.chars().find(|letter| matches!(letter, '#' | ',')) {
        return refused(&format!(
            "{mark} in a path parts tasks or names a level; choose another name"
        ));
    }
    if !hasard_envs::own::is_file(&name) {
        return refused("a task's file ends in .toml, such as my_task.toml");
    }
    Ok(())
}

/// `my_task` as `MyTask`, as names of scenarios are written.
fn scenario_name(word: &str) -> Option<String> {
    let word = word.strip_suffix(".toml").unwrap_or(word);
    let fits = word.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'));
    if !fits {
        return None;
    }
    // Every letter is a byte here.
    let parts = word.split(['_', '-']).filter(|part| !part.is_empty());
    let name: String = parts.map(|part| part[..1].to_uppercase() + &part[1..]).collect();
    (name.bytes().next().is_some_and(|first| first.is_ascii_alphabetic()) && name.len() <= 40)
        .then_some(name)
}

fn file_name(word: &str) -> &str {
    word.strip_suffix(".toml").unwrap_or(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_other_commands_refuse_is_not_written() {
        for (path, words) in [
            ("ok.txt", ".toml"),
            ("ok", ".toml"),
            (".toml", ".toml"),
            ("a#2.toml", "#"),
            ("a,b/x.toml", ","),
            ("-x.toml", "./"),
        ] {
            let line = taken_by_commands(Path::new(path)).unwrap_err().line();
            assert!(line.contains(path) && line.contains(words), "{line}");
            assert!(!line.contains('\n'), "{line}");
        }
        #[cfg(unix)]
        {
            let path: &std::ffi::OsStr = std::os::unix::ffi::OsStrExt::from_bytes(b"a\xff.toml");
            let line = taken_by_commands(Path::new(path)).unwrap_err().line();
            assert!(line.contains("UTF-8"), "{line}");
        }
        for path in ["ok.toml", "./-x.toml", "deep/a-b.TOML"] {
            assert!(taken_by_commands(Path::new(path)).is_ok(), "{path}");
        }
    }

    #[test]
    fn names_are_written_as_scenarios_are() {
        for (word, name) in [
            ("my_task", "MyTask"),
            ("lava", "Lava"),
            ("LavaGarden", "LavaGarden"),
            ("a-b.toml", "AB"),
        ] {
            assert_eq!(scenario_name(word).as_deref(), Some(name));
        }
        for word in ["", "1st", "two words", "../up", "\u{e4}"] {
            assert_eq!(scenario_name(word), None, "{word}");
        }
    }
}
