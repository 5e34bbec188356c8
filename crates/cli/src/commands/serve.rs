//! `hasard serve`: the page in the browser.

use crate::args::ServeArgs;
use crate::failure::{Failure, Outcome};
#[cfg(feature = "serve")]
use std::path::PathBuf;

/// Runs the command.
#[cfg(feature = "serve")]
pub fn run(args: &ServeArgs) -> Outcome {
    // Without folders `runs` is waited for: the first training makes it. A folder that was named
    // must exist.
    let (tasks, runs): (Vec<PathBuf>, Vec<PathBuf>) = args
        .runs
        .iter()
        .cloned()
        .partition(|path| hasard_envs::own::is_file(&path.to_string_lossy()));
    for task in &tasks {
        hasard_envs::own::open(&task.to_string_lossy()).map_err(Failure::bad)?;
    }
    if let Some(folder) = runs.iter().find(|folder| !folder.is_dir()) {
        let remedy = "name a folder that holds runs, or none to wait for those below runs";
        return Err(Failure::bad(format!(
            "{}: there is no such folder; {remedy}",
            folder.display()
        )));
    }
    let folders = if runs.is_empty() { vec!["runs".into()] } else { runs };
    let beyond = !args.listen.ip().is_loopback();
    let token = match &args.token {
        Some(token)
            if token.len() < 8 || !token.bytes().all(|byte| byte.is_ascii_alphanumeric()) =>
        {
            return Err(Failure::bad("--token: give at least 8 letters and digits"));
        }
        Some(token) => Some(token.clone()),
        None if beyond => Some(drawn_token()?),
        None => None,
    };
    let settings = hasard_serve::Settings {
        address: args.listen,
        token: token.clone(),
        folders,
        episodes: args.out.clone(),
        edit: args.edit,
        agents: std::sync::Arc::new(trained::Trained {
            maps: args.maps.clone(),
            iwad: args.iwad.clone(),
        }),
    };
    let taken = |error: std::io::Error| {
        Failure::bad(format!("--listen {}: {error}; choose another port", args.listen))
    };
    let server = hasard_serve::Server::bind(settings).map_err(taken)?;
    let query = token.map_or_else(String::new, |token| format!("?token={token}"));
    let address = format!("http://{}/{query}", server.address());
    say!("{address}");
    if args.open {
        open(&address);
    }
    server.run().map_err(Failure::bad)
}

/// Sixteen bytes of the system's randomness.
#[cfg(feature = "serve")]
fn drawn_token() -> Result<String, Failure> {
    let mut bytes = [0; 16];
    let failed =
        |error| Failure::bad(format!("no token could be drawn: {error}; give one with --token"));
    getrandom::fill(&mut bytes).map_err(failed)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Asks the desktop to show an address; without a desktop the printed one is there.
#[cfg(feature = "serve")]
fn open(address: &str) {
    let program = if cfg!(target_os = "macos") {
        "open"
    } else if cfg!(windows) {
        "explorer"
    } else {
        "xdg-open"
    };
    if std::process::Command::new(program).arg(address).spawn().is_err() {
        note!("hasard: no {program} on this machine; open the address yourself");
    }
}

/// Trained agents as the other commands load them.
#[cfg(feature = "serve")]
mod trained {
    use crate::failure::Failure;
    use crate::settings::{Elsewhere, trained_options};
    use hasard_envs::{Env, EnvOptions};
    use hasard_learn::networks::distribution::ActionShape;
    use hasard_learn::runs::evaluate::{Agent, Choice, Which, run_config};
    use hasard_learn::runs::zoo_results::{ZooResult, results};
    use std::path::{Path, PathBuf};

    /// And where maps and pictures of theirs are that are no longer where they were.
    pub struct Trained {
        pub maps: Option<PathBuf>,
        pub iwad: Option<PathBuf>,
    }

    impl hasard_serve::Agents for Trained {
        fn options(&self, run: &Path) -> Result<(String, EnvOptions), String> {
            let config = run_config(run).map_err(|error| error.to_string())?;
            let elsewhere = Elsewhere { maps: self.maps.as_deref(), iwad: self.iwad.as_deref() };
            let options = trained_options(&config.env, elsewhere.where_missing(&config.env))
                .map_err(Failure::line)?;
            Ok((crate::settings::first_task(&config.env), options))
        }

        fn load(&self, run: &Path, best: bool, choice: Choice, env: &Env) -> Result<Agent, String> {
            let action = ActionShape::from(env.action_space());
            let which = if best { Which::Selected } else { Which::Latest };
            let mut warn = |text: String| note!("hasard: {text}");
            Agent::load(run, which, choice, 1, env.observation_shape(), action, &mut warn)
                .map_err(|error| error.to_string())
        }

        fn zoo(&self) -> Vec<String> {
            crate::zoo::agents().into_iter().map(|(name, _)| name).collect()
        }

        fn zoo_run(&self, name: &str) -> Result<PathBuf, String> {
            crate::zoo::find(format!("zoo:{name}").as_ref()).map_err(Failure::line)
        }

        fn zoo_results(&self) -> Vec<ZooResult> {
            results().to_vec()
        }
    }
}

/// Runs the command.
#[cfg(not(feature = "serve"))]
pub fn run(args: &ServeArgs) -> Outcome {
    let problem = "this hasard was built without its page; build it with: cargo build --release -p hasard --features serve";
    Err(Failure::bad(format!("serve {}: {problem}", args.listen)))
}
