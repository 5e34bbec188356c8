//! Numbers and names as people write them.

use hasard_envs::EnvId;
use hasard_envs::own::{is_file, open, path_and_level};

/// The whole number that a text such as `2000000`, `2_000_000`, `2,000,000`, `2M`, `1.5M`, `400k`
/// or `1e6` stands for.
///
/// # Errors
/// What to write instead.
pub fn whole(text: &str) -> Result<u64, String> {
    let remedy = || "write a whole number such as 2000000, 2_000_000, 2M, 400k or 1e6".to_string();
    let plain: String = text.trim().chars().filter(|letter| !matches!(letter, '_' | ',')).collect();
    let (digits, exponent) = match plain.char_indices().last() {
        Some((at, 'k' | 'K')) => (&plain[..at], 3),
        Some((at, 'm' | 'M')) => (&plain[..at], 6),
        Some((at, 'g' | 'G' | 'b' | 'B')) => (&plain[..at], 9),
        _ => match plain.split_once(['e', 'E']) {
            Some((digits, exponent)) => {
                (digits, exponent.trim_start_matches('+').parse().map_err(|_| remedy())?)
            }
            None => (plain.as_str(), 0),
        },
    };
    let (before, after) = digits.split_once('.').unwrap_or((digits, ""));
    let after = after.trim_end_matches('0');
    let all = [before, after].concat();
    // In whole numbers throughout: no digit is lost.
    let shift: u32 = u32::try_from(after.len())
        .ok()
        .and_then(|places| u32::checked_sub(exponent, places))
        .ok_or_else(remedy)?;
    if all.is_empty() || !all.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err(remedy());
    }
    let number =
        all.parse::<u64>().ok().and_then(|number| number.checked_mul(10u64.checked_pow(shift)?));
    number.ok_or_else(remedy)
}

/// The same from 1 on.
///
/// # Errors
/// What to write instead.
pub fn positive(text: &str) -> Result<u64, String> {
    match whole(text)? {
        0 => Err("it must be at least 1".into()),
        number => Ok(number),
    }
}

/// An environment's id as people write it: any case, without `-v0`, with Python's `hasard/`; or a
/// scenario's file, `my_task.toml` or `my_task.toml#2`, which is read and known by its id from then
/// on; or several of them with commas between, a mixed batch. Other texts stay as they are; what makes the environment names the nearest id.
///
/// # Errors
/// What is wrong with a scenario's file, or that a file has another ending.
pub fn env_id(text: &str) -> Result<String, String> {
    if text.contains(',') && !std::path::Path::new(text).exists() {
        let words: Vec<&str> = text.split(',').map(str::trim).collect();
        let mut ids = Vec::new();
        let mut own: Vec<(&str, EnvId)> = Vec::new();
        for &word in &words {
            if !is_file(word) {
                ids.push(env_id(word)?);
                continue;
            }
            let id = open(word).map_err(|error| error.to_string())?;
            // Equal texts are one scenario, wherever they are read from.
            let other = own.iter().find(|(_, other)| {
                other.scenario != id.scenario
                    && other.scenario.name.eq_ignore_ascii_case(id.scenario.name)
            });
            if let Some((other, _)) = other {
                return Err(format!(
                    "{other} and {word} are both {}; give one of them another `name`",
                    id.scenario.name
                ));
            }
            own.push((word, id));
            ids.push(id.to_string());
        }
        return Ok(ids.join(","));
    }
    if is_file(text) {
        return open(text).map(|id| id.to_string()).map_err(|error| error.to_string());
    }
    let plain = text.to_ascii_lowercase();
    let plain = plain.strip_prefix("hasard/").unwrap_or(&plain);
    let plain = plain.strip_suffix("-v0").unwrap_or(plain);
    let known = EnvId::every()
        .map(|id| id.to_string())
        .find(|id| id.trim_end_matches("-v0").eq_ignore_ascii_case(plain));
    if known.is_none() && std::path::Path::new(text).is_file() {
        return Err("a task's file ends in .toml; rename it".to_string());
    }
    Ok(known.unwrap_or_else(|| text.to_string()))
}

/// As [`env_id`], for `train`: files that are not there stay as they were typed, since a run that
/// goes on has kept the text of its task.
///
/// # Errors
/// As there.
pub fn env_id_of_run(text: &str) -> Result<String, String> {
    let absent = text.split(',').any(is_absent_file);
    env_id(text).or_else(|why| if absent { Ok(text.to_string()) } else { Err(why) })
}

/// Whether a word names a scenario's file where none is.
pub fn is_absent_file(word: &str) -> bool {
    let (path, _) = path_and_level(word.trim());
    is_file(path) && std::path::Path::new(path).try_exists().is_ok_and(|there| !there)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_people_write_them() {
        for (text, number) in [
            ("0", 0),
            ("2000000", 2_000_000),
            ("2_000_000", 2_000_000),
            ("2,000,000", 2_000_000),
            ("2M", 2_000_000),
            ("1.5m", 1_500_000),
            ("400k", 400_000),
            ("1e6", 1_000_000),
            ("2.5e+3", 2_500),
            ("5e8", 500_000_000),
            ("0.5G", 500_000_000),
            ("18446744073709551615", u64::MAX),
            ("7.0", 7),
        ] {
            assert_eq!(whole(text), Ok(number), "{text}");
        }
        for wrong in [
            "",
            "-5",
            "1.5",
            "1e-3",
            "M",
            "e6",
            "1e",
            "1e99",
            "2 M",
            "0x10",
            "1.2.3",
            "1e6e6",
            "18446744073709551616",
            "nan",
            "٣",
            "1é",
        ] {
            assert!(whole(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn ids_are_read_as_people_write_them() {
        for text in [
            "VolcanicVentureLevel1-v0",
            "volcanicventurelevel1-v0",
            "VolcanicVentureLevel1",
            "hasard/VolcanicVentureLevel1-v0",
        ] {
            assert_eq!(env_id(text).unwrap(), "VolcanicVentureLevel1-v0", "{text}");
        }
        for text in
            ["VolcanicVentureLevel4-v0", "VolcanicVentureLevel1-v1", "runs/one", "", "\u{e9}"]
        {
            assert_eq!(env_id(text).unwrap(), text);
        }
    }
}
