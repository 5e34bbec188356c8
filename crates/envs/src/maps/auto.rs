//! `auto`: where a user's copies lie.

use crate::error::EnvError;
use crate::maps::files::shown;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Where Debian's package puts Freedoom.
const FREEDOOM: [&str; 2] =
    ["/usr/share/games/doom/freedoom2.wad", "/usr/share/games/doom/freedoom1.wad"];

/// The interpreter that is asked, where it is not the `python3` on the path.
static INTERPRETER: OnceLock<PathBuf> = OnceLock::new();

/// Asks where packages lie without running them: a line each, empty for those that are not
/// installed.
const QUESTION: &str = "import importlib.util, sys
sys.path[:] = [place for place in sys.path if place]
for name in sys.argv[1:]:
    spec = importlib.util.find_spec(name)
    places = spec.submodule_search_locations if spec else None
    print(list(places)[0] if places else '')";

/// From now on this interpreter is asked where packages lie: the one that this code runs in, whose
/// packages need not be those of the `python3` on the path. The first caller decides.
pub fn ask(interpreter: &Path) {
    let _ = INTERPRETER.set(interpreter.to_owned());
}

/// Who is asked, for a message.
fn asked() -> String {
    INTERPRETER.get().map_or_else(|| "the python3 on the path".to_string(), |path| shown(path))
}

/// The maps of the published package `hasard`, where the `python3` on the path has it.
///
/// # Errors
/// One line that says how to install it.
pub fn find_maps() -> Result<PathBuf, EnvError> {
    package("hasard").map(|package| package.join("envs")).filter(|folder| folder.is_dir()).ok_or_else(|| EnvError::Map {
        why: format!(
            "maps auto: {} has no package hasard; `pip install hasard==0.2.0 vizdoom==1.3.2`, or name the folder of the maps",
            asked()
        ),
    })
}

/// Freedoom: from Debian's package, or from the Python package `vizdoom`. `beside_maps`: the latter
/// first, because the published worlds are drawn with it.
///
/// # Errors
/// One line that says how to install it.
pub fn find_iwad(beside_maps: bool) -> Result<PathBuf, EnvError> {
    let debian = || FREEDOOM.iter().map(Path::new).find(|path| path.exists()).map(Path::to_owned);
    let vizdoom = || {
        package("vizdoom")
            .map(|package| package.join("freedoom2.wad"))
            .filter(|path| path.is_file())
    };
    let found = if beside_maps { vizdoom().or_else(debian) } else { debian().or_else(vizdoom) };
    found.ok_or_else(|| EnvError::Map {
        why: format!(
            "iwad auto: nothing at {}, and {} has no package vizdoom; install Debian's package freedoom, or name a file",
            FREEDOOM[0],
            asked()
        ),
    })
}

/// The folder of a Python package.
fn package(name: &str) -> Option<PathBuf> {
    let asked = Command::new(INTERPRETER.get().map_or(Path::new("python3"), |path| path))
        .args(["-c", QUESTION, name])
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    let answer = String::from_utf8(asked.stdout).ok()?;
    answer.lines().next().filter(|line| !line.is_empty()).map(PathBuf::from)
}
