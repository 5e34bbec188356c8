//! The readers, each with valid samples made by our own writers.

mod agents;
mod episodes;
mod learning;
mod levels;
mod maps;
mod pictures;
mod runs;
mod scenarios;
mod sweeps;
mod words;

/// A reader of bytes.
pub struct Target {
    /// Its name, and that of its folder in `hostile/`.
    pub name: &'static str,
    /// Valid samples.
    pub samples: fn() -> Vec<Vec<u8>>,
    /// Words that mean something to it.
    pub words: &'static [&'static str],
    /// Makes checksums fit again, as an attacker would.
    pub repair: fn(Vec<u8>) -> Vec<u8>,
    /// Reads an input and uses what was read; says whether it was accepted. May panic only where
    /// there is a fault.
    pub run: fn(&[u8]) -> bool,
    /// Bytes that it may hold at a time, beside 64 for each of the input.
    pub memory: usize,
}

/// All of them.
pub static ALL: &[Target] = &[
    maps::UDMF,
    maps::MAP_WAD,
    levels::LEVEL,
    pictures::IWAD,
    episodes::EPISODE,
    sweeps::SWEEP,
    scenarios::SCENARIO,
    runs::RUN,
    words::WORDS,
    learning::SETTINGS,
    learning::CHECKPOINT,
    agents::AGENT,
];

/// For formats without checksums.
fn nothing_to_repair(bytes: Vec<u8>) -> Vec<u8> {
    bytes
}

/// Every message is one line, of bounded length, and nothing in it commands a terminal.
#[track_caller]
fn assert_presentable(message: &str) {
    assert!(!message.is_empty() && message.len() < 4096, "a message of {} bytes", message.len());
    assert!(
        !message.contains(char::is_control),
        "a message with control characters: {}",
        message.escape_debug()
    );
}
