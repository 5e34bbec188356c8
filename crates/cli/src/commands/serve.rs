//! `hasard serve`: the page in the browser.

use crate::args::ServeArgs;
use crate::failure::{Failure, Outcome};
#[cfg(feature = "serve")]
use hasard_media::files::what_lies_at;
#[cfg(feature = "serve")]
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};
#[cfg(feature = "serve")]
use std::path::{Path, PathBuf};

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
    for folder in &runs {
        if !what_lies_at(folder).map_err(Failure::bad)?.is_some_and(|kind| kind.is_dir()) {
            let remedy = "name a folder that holds runs, or none to wait for those below runs";
            return Err(Failure::bad(format!(
                "{}: there is no such folder; {remedy}",
                folder.display()
            )));
        }
    }
    places_are_there(args)?;
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
    name_to_others(server.address(), &query);
    if args.open {
        open(&address);
    }
    server.run().map_err(Failure::bad)
}

/// Whether there is what will be needed once somebody plays, or watches an agent.
#[cfg(feature = "serve")]
fn places_are_there(args: &ServeArgs) -> Outcome {
    let lost = |path: &&PathBuf| path.as_path() != Path::new("auto") && !path.exists();
    for (flag, path) in [("--maps", &args.maps), ("--iwad", &args.iwad)] {
        if let Some(path) = path.as_ref().filter(lost) {
            let remedy = format!("name where it is now with {flag}, or leave it out");
            return Err(Failure::bad(format!("{}: this is not there; {remedy}", path.display())));
        }
    }
    can_be_written(&args.out).map_err(|error| {
        let remedy = "played episodes are kept there; name a folder of yours with --out";
        Failure::bad(format!("{}: {error}; {remedy}", args.out.display()))
    })
}

/// Whether a folder can be written to, or made. It is not made before there is something for it.
#[cfg(feature = "serve")]
fn can_be_written(folder: &Path) -> std::io::Result<()> {
    let whole = std::path::absolute(folder)?;
    let there = whole.ancestors().find(|path| path.exists()).unwrap_or(&whole);
    if !there.is_dir() {
        return Err(std::io::ErrorKind::NotADirectory.into());
    }
    let probe = there.join(format!(".hasard-{}", std::process::id()));
    std::fs::File::create_new(&probe)?;
    std::fs::remove_file(probe)
}

/// Says how visitors reach a server that listens at every address of this machine: 0.0.0.0 leads
/// nobody here.
#[cfg(feature = "serve")]
fn name_to_others(server: SocketAddr, query: &str) {
    if !server.ip().is_unspecified() {
        return;
    }
    match own_address(server.is_ipv6()) {
        Some(ip) => {
            let own = SocketAddr::new(ip, server.port());
            note!("hasard: from other machines: http://{own}/{query}");
        }
        None => note!(
            "hasard: from other machines: put an address of this one in the place of {}",
            server.ip()
        ),
    }
}

/// The address from which this machine speaks to others.
#[cfg(feature = "serve")]
fn own_address(six: bool) -> Option<IpAddr> {
    // Addresses for documentation, of nobody. Nothing is sent: the system only says what it would
    // be sent from.
    let four = (IpAddr::from(Ipv4Addr::UNSPECIFIED), IpAddr::from(Ipv4Addr::new(192, 0, 2, 1)));
    let to_six = IpAddr::from(Ipv6Addr::new(0x2001, 0xdb8, 0, 0, 0, 0, 0, 1));
    let six = six.then_some((IpAddr::from(Ipv6Addr::UNSPECIFIED), to_six));
    six.into_iter().chain([four]).find_map(|(from, to)| {
        let socket = UdpSocket::bind((from, 0)).ok()?;
        socket.connect((to, 9)).ok()?;
        let own = socket.local_addr().ok()?.ip();
        (!own.is_unspecified() && !own.is_loopback()).then_some(own)
    })
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
    use crate::failure::{Failure, warn};
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
