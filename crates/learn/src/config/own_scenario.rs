//! The file of an own scenario, as a run keeps it: all of it, so that the run needs nothing else.

use hasard_envs::{Scenario, own};
use serde::{Deserialize, Serialize};

/// A scenario that was read from a file. It is known to the registry as soon as its settings are
/// read.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(try_from = "Kept", into = "Kept")]
pub struct OwnScenario(Scenario);

/// The file in words.
#[derive(Serialize, Deserialize)]
struct Kept {
    path: String,
    hash: String,
    text: String,
}

impl TryFrom<Kept> for OwnScenario {
    type Error = String;

    fn try_from(kept: Kept) -> Result<OwnScenario, String> {
        let hash = own::fingerprint(&kept.text);
        if hash != kept.hash {
            return Err(format!(
                "the scenario's text was changed: its hash is {hash}, not {}",
                kept.hash
            ));
        }
        own::recall(&kept.path, &kept.text).map(OwnScenario).map_err(|error| error.to_string())
    }
}

impl From<OwnScenario> for Kept {
    fn from(own: OwnScenario) -> Kept {
        let file = own.0.file.as_ref();
        let word = |of: fn(&hasard_envs::scenarios::ScenarioFile) -> &'static str| {
            file.map_or("", of).to_string()
        };
        Kept {
            path: word(|file| file.path),
            hash: word(|file| file.hash),
            text: word(|file| file.text),
        }
    }
}

impl OwnScenario {
    /// That of a scenario, if it was read from a file.
    #[must_use]
    pub fn of(scenario: Scenario) -> Option<OwnScenario> {
        scenario.file.map(|_| OwnScenario(scenario))
    }

    /// The scenario.
    #[must_use]
    pub const fn scenario(self) -> Scenario {
        self.0
    }

    /// What to say if the file at its place is another by now; `None` if it is the same or gone.
    #[must_use]
    pub fn changed(self) -> Option<String> {
        own::changed(self.0, "the run began", "run")
    }
}
