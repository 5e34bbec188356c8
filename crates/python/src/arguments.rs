//! Keyword arguments of worlds, by their names in Python.

use crate::errors::{INVALID_OPTION, raise};
use hasard_envs::{Autoreset, EnvOptions, FrameSize, Layout, ObservationKind, RuleSet};
use pyo3::exceptions::{PyIndexError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::path::PathBuf;

/// Every name that is understood, for the nearest one to a wrong name.
const NAMES: [&str; 20] = [
    "rules",
    "early_creatures",
    "hard_constraint",
    "hard",
    "full_actions",
    "frame_skip",
    "resolution",
    "size",
    "observation",
    "layout",
    "frame_stack",
    "max_episode_steps",
    "events",
    "seed",
    "safety_budget",
    "iwad",
    "maps",
    "map",
    "published_depth",
    "published_colours",
];

/// What an environment is made with, and what only its attributes show.
pub struct Arguments {
    pub options: EnvOptions,
    pub safety_budget: Option<f64>,
    pub seed: Option<u64>,
}

/// Reads keyword arguments; an unknown one is a `TypeError` that names the nearest.
pub fn read(py: Python<'_>, given: Option<&Bound<'_, PyDict>>) -> PyResult<Arguments> {
    let mut arguments =
        Arguments { options: EnvOptions::default(), safety_budget: None, seed: None };
    let (mut hard, mut resolution, mut maps) =
        (Either::default(), Either::default(), Either::default());
    let mut iwad = None::<PathBuf>;
    for (name, value) in given.into_iter().flat_map(|given| given.iter()) {
        let name: String = name.extract()?;
        let options = &mut arguments.options;
        match name.as_str() {
            "rules" => {
                options.rules =
                    choice(&name, &value, &RuleSet::ALL.map(|rules| (rules.name(), rules)))?
            }
            "early_creatures" => options.early_creatures = typed(&name, &value, "True or False")?,
            "hard_constraint" | "hard" => {
                hard.give(&name, &value, typed(&name, &value, "True or False")?)?
            }
            "full_actions" => options.full_actions = typed(&name, &value, "True or False")?,
            "frame_skip" => options.frame_skip = number(&name, &value, 1, 35)? as u32,
            "resolution" | "size" => resolution.give(&name, &value, size(&name, &value)?)?,
            "observation" => {
                let kinds = [
                    ("rgb", ObservationKind::Rgb),
                    ("rgb+depth", ObservationKind::RgbDepth),
                    ("segmented", ObservationKind::Segmented),
                    ("grey", ObservationKind::Grey),
                ];
                options.observation = choice(&name, &value, &kinds)?;
            }
            "layout" => {
                options.layout =
                    choice(&name, &value, &[("hwc", Layout::Hwc), ("chw", Layout::Chw)])?
            }
            "frame_stack" => options.frame_stack = number(&name, &value, 1, 16)? as usize,
            "max_episode_steps" if value.is_none() => options.max_episode_steps = None,
            "max_episode_steps" => {
                options.max_episode_steps = Some(number(&name, &value, 1, u32::MAX.into())? as u32)
            }
            "events" => options.events = typed(&name, &value, "True or False")?,
            "seed" if value.is_none() => arguments.seed = None,
            "seed" => arguments.seed = Some(seed(&value)?),
            "safety_budget" if value.is_none() => arguments.safety_budget = None,
            "safety_budget" => {
                let budget: f64 = typed(&name, &value, "a number")?;
                if budget.is_nan() || budget < 0.0 {
                    let text = shown(&value);
                    let why = format!("{name} cannot be {text}; it must be a number, 0 or more");
                    return Err(INVALID_OPTION.error(py, why));
                }
                arguments.safety_budget = Some(budget);
            }
            "iwad" => iwad = typed(&name, &value, "a path or 'auto'")?,
            "maps" | "map" if value.is_none() => {}
            "maps" | "map" => {
                maps.give(&name, &value, typed::<PathBuf>(&name, &value, "a path or 'auto'")?)?
            }
            "published_depth" => options.published_depth = typed(&name, &value, "True or False")?,
            "published_colours" => {
                options.published_colours = typed(&name, &value, "True or False")?
            }
            _ => return Err(unknown(py, &name)?),
        }
    }
    let (defaults, maps) = (&mut arguments.options, maps.value());
    defaults.hard = hard.value().unwrap_or(defaults.hard);
    defaults.size = resolution.value().unwrap_or(defaults.size);
    if maps.is_some() || iwad.is_some() {
        // Together: pictures of a map lie over those of the IWAD. What is left out of a map the
        // program says, where people look.
        let looks = py.detach(|| hasard_cli::looks(maps.as_deref(), iwad.as_deref(), |_| ()));
        let looks = looks.map_err(|line| INVALID_OPTION.error(py, line))?;
        (arguments.options.maps, arguments.options.assets) = (looks.maps, looks.assets);
    }
    arguments.options.check().map_err(|error| raise(py, &error))?;
    Ok(arguments)
}

/// What an argument of two names was given: by which name, as it was written, and its value.
struct Either<T>(Option<(String, String, T)>);

impl<T> Default for Either<T> {
    fn default() -> Either<T> {
        Either(None)
    }
}

impl<T: PartialEq> Either<T> {
    /// Takes a value by one of the names. Where the other name has another value neither is dropped
    /// in silence: that is an error.
    fn give(&mut self, name: &str, given: &Bound<'_, PyAny>, value: T) -> PyResult<()> {
        let text = shown(given);
        if let Some((other, before, kept)) = &self.0
            && *kept != value
        {
            let why = format!(
                "{other}={before} and {name}={text} contradict each other: both name one argument; give one of them"
            );
            return Err(INVALID_OPTION.error(given.py(), why));
        }
        self.0 = Some((name.to_string(), text, value));
        Ok(())
    }

    fn value(self) -> Option<T> {
        self.0.map(|(_, _, value)| value)
    }
}

/// A mode of going on after an end, by Gymnasium's name, in snake case, or as Gymnasium's enum.
pub fn autoreset(given: &Bound<'_, PyAny>) -> PyResult<Autoreset> {
    let value = if given.is_instance_of::<PyString>() {
        given.clone()
    } else {
        given.getattr("value").unwrap_or_else(|_| given.clone())
    };
    let names = [
        ("NextStep", Autoreset::NextStep),
        ("next_step", Autoreset::NextStep),
        ("SameStep", Autoreset::SameStep),
        ("same_step", Autoreset::SameStep),
        ("Disabled", Autoreset::Disabled),
        ("disabled", Autoreset::Disabled),
    ];
    choice("autoreset_mode", &value, &names)
}

/// A seed: any non-negative integer, modulo 2^64.
pub fn seed(given: &Bound<'_, PyAny>) -> PyResult<u64> {
    let py = given.py();
    let index = match given.call_method0("__index__") {
        Ok(index) => index,
        Err(_) => {
            return Err(PyTypeError::new_err(format!(
                "a seed must be an integer, got {}",
                shown(given)
            )));
        }
    };
    if index.lt(0)? {
        return Err(pyo3::exceptions::PyValueError::new_err(format!(
            "a seed must not be negative, got {}",
            shown(given)
        )));
    }
    index
        .call_method1("__and__", (u64::MAX,))?
        .extract()
        .map_err(|error: PyErr| INVALID_OPTION.error(py, error.to_string()))
}

/// What was given, cut short, for a message.
fn shown(given: &Bound<'_, PyAny>) -> String {
    let text = given.repr().map(|text| text.to_string()).unwrap_or_default();
    text.chars().take(60).collect()
}

fn refused(given: &Bound<'_, PyAny>, name: &str, allowed: &str) -> PyErr {
    INVALID_OPTION
        .error(given.py(), format!("{name} cannot be {}; it must be {allowed}", shown(given)))
}

fn typed<'py, T: FromPyObjectOwned<'py>>(
    name: &str,
    given: &Bound<'py, PyAny>,
    allowed: &str,
) -> PyResult<T> {
    given.extract().map_err(|_| refused(given, name, allowed))
}

/// A whole number from `least` to `most`.
pub fn number(name: &str, given: &Bound<'_, PyAny>, least: u64, most: u64) -> PyResult<u64> {
    let value: Result<u64, _> = given.call_method0("__index__").and_then(|index| index.extract());
    value
        .ok()
        .filter(|value| (least..=most).contains(value))
        .ok_or_else(|| refused(given, name, &format!("{least}..={most}")))
}

/// The number of one of several: none if no machine could have so many, or the number is negative.
fn place(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    let wrong =
        |_| PyTypeError::new_err(format!("{name} must be an integer, got {}", shown(given)));
    Ok(given.call_method0("__index__").map_err(wrong)?.extract().ok())
}

/// A lane to look at; whether there are so many is for the worlds to say, by the same `IndexError`.
pub fn lane(given: &Bound<'_, PyAny>) -> PyResult<usize> {
    let none = || {
        PyIndexError::new_err(format!(
            "lane {} is not one of these; they are counted from 0",
            shown(given)
        ))
    };
    place("a lane", given)?.ok_or_else(none)
}

/// Lanes to step, or `None`.
pub fn lanes(given: &Bound<'_, PyAny>) -> PyResult<Option<Vec<usize>>> {
    let one = |lane: Bound<'_, PyAny>| {
        place("a lane to step", &lane)?.ok_or_else(|| {
            refused(&lane, "a lane to step", "less than the number of lanes, from 0")
        })
    };
    if given.is_none() {
        Ok(None)
    } else {
        given.try_iter()?.map(|lane| one(lane?)).collect::<PyResult<_>>().map(Some)
    }
}

/// A group of lanes; whether there are so many is for the worlds to say.
pub fn group(given: &Bound<'_, PyAny>) -> PyResult<usize> {
    place("group", given)?
        .ok_or_else(|| refused(given, "group", "less than the number of groups, from 0"))
}

/// One of several choices, by its name.
pub fn choice<T: Copy>(name: &str, given: &Bound<'_, PyAny>, choices: &[(&str, T)]) -> PyResult<T> {
    let text: Option<String> = given.extract().ok();
    let found = choices.iter().find(|(name, _)| text.as_deref() == Some(*name));
    found.map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        refused(given, name, &names.join(" or "))
    })
}

/// `"160x120"` in either case, or a pair of width and height: a list too, which is what JSON makes
/// of a tuple.
pub fn size(name: &str, given: &Bound<'_, PyAny>) -> PyResult<FrameSize> {
    let wrong = || refused(given, name, "'WxH' or (width, height), from 64x48 to 1920x1080");
    let (width, height) = match given.extract::<String>() {
        Ok(text) => {
            let text = text.to_lowercase();
            let (width, height) = text.split_once('x').ok_or_else(wrong)?;
            (width.parse().map_err(|_| wrong())?, height.parse().map_err(|_| wrong())?)
        }
        Err(_) if given.len().is_ok_and(|length| length == 2) => {
            let side = |index: usize| -> PyResult<u16> {
                let side = given
                    .get_item(index)
                    .and_then(|side| side.call_method0("__index__"))
                    .map_err(|_| wrong())?;
                side.extract().map_err(|_| wrong())
            };
            (side(0)?, side(1)?)
        }
        Err(_) => return Err(wrong()),
    };
    let size = FrameSize { width, height };
    size.check().map_err(|_| wrong())?;
    Ok(size)
}

/// frame_size(name, resolution) -> (width, height)
///
/// Returns the size that `resolution` says, for the argument of this `name`. Raises InvalidOption.
#[pyfunction]
pub fn frame_size(name: &str, resolution: &Bound<'_, PyAny>) -> PyResult<(u16, u16)> {
    let size = size(name, resolution)?;
    Ok((size.width, size.height))
}

/// The `TypeError` of a name that is not known.
fn unknown(py: Python<'_>, name: &str) -> PyResult<PyErr> {
    let near: Vec<String> = py
        .import("difflib")?
        .call_method1("get_close_matches", (name, NAMES.to_vec(), 1, 0.5))?
        .extract()?;
    let hint = near.first().map_or_else(String::new, |near| format!("; did you mean '{near}'?"));
    Ok(PyTypeError::new_err(format!("unexpected keyword argument '{name}'{hint}")))
}

/// The error of a wrong number of lanes.
pub(crate) fn one_a_lane(what: &str, lanes: usize, given: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(format!(
        "{what} must have one entry for each of {lanes} lanes, got {given}"
    ))
}
