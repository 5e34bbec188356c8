//! Spoiling of valid files for the tests of everything that reads bytes.
//!
//! The ordinary tests make some thousand attempts. For a longer search:
//! `HASARD_FUZZ_ITERATIONS=1000000 cargo test --release -p hasard-engine mutated`. What it finds
//! belongs into `attacks/`.

use crate::math::Rng;

/// Attempts that one test makes: `HASARD_FUZZ_ITERATIONS`, or `default`.
pub(crate) fn iterations(default: u64) -> u64 {
    std::env::var("HASARD_FUZZ_ITERATIONS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(default)
}

/// Numbers that break arithmetic.
const SHARP: [i32; 12] = [0, 1, -1, 2, 127, 255, 256, 32_767, -32_768, 65_536, i32::MAX, i32::MIN];

/// Words that break readers of text.
const WORDS: [&str; 18] = [
    "-1",
    "0",
    "1e308",
    "1e-308",
    "nan",
    "inf",
    "2147483648",
    "-2147483649",
    "9223372036854775808",
    "0x7fffffff",
    "077",
    "\"",
    "{",
    "}",
    ";",
    "/*",
    "//",
    "\"LONGERTHANEIGHT\"",
];

/// A copy with one to eight faults.
pub(crate) fn mutated(rng: &mut Rng, bytes: &[u8]) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..rng.between(1, 8) {
        if out.is_empty() {
            return out;
        }
        let at = rng.below(out.len() as u32) as usize;
        let end = (at + 1 + rng.below(64) as usize).min(out.len());
        match rng.below(9) {
            0 => out[at] ^= 1 << rng.below(8),
            1 => out[at] = rng.next_u64() as u8,
            2 => out.truncate(at),
            3 => drop(out.drain(at..end)),
            4 => {
                let copy = out[at..end].to_vec();
                let to = rng.below(out.len() as u32) as usize;
                out.splice(to..to, copy);
            }
            5 => write(&mut out, at, &SHARP[rng.below(12) as usize].to_le_bytes()),
            6 => write(&mut out, at, &(SHARP[rng.below(12) as usize] as i16).to_le_bytes()),
            7 => write(&mut out, at & !3, &rng.between(-16, 70_000).to_le_bytes()),
            _ => {
                let word = WORDS[rng.below(18) as usize].bytes();
                let number = out[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
                out.splice(at..at + number, word);
            }
        }
    }
    out
}

fn write(out: &mut [u8], at: usize, bytes: &[u8]) {
    for (to, from) in out[at..].iter_mut().zip(bytes) {
        *to = *from;
    }
}
