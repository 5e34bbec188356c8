//! How samples are spoiled.

use hasard_engine::math::Rng;

/// Longest input that is tried.
pub const LONGEST: usize = 1 << 19;

/// Numbers that break arithmetic.
const SHARP: [i64; 20] = [
    0,
    1,
    -1,
    2,
    7,
    127,
    128,
    255,
    256,
    4096,
    32_767,
    -32_768,
    65_535,
    65_536,
    i32::MAX as i64,
    i32::MIN as i64,
    u32::MAX as i64,
    1 << 40,
    i64::MAX,
    i64::MIN,
];

/// Words that break readers of text.
const WORDS: [&str; 30] = [
    "-1",
    "0",
    "1e308",
    "-1e308",
    "1e-400",
    "1e999",
    "nan",
    "inf",
    "-0",
    "2147483648",
    "-2147483649",
    "4294967296",
    "9223372036854775808",
    "18446744073709551615",
    "340282366920938463463374607431768211456",
    "0x7fffffff",
    "null",
    "true",
    "\"",
    "{",
    "}",
    "[",
    "]",
    ",",
    "\\u0000",
    "\u{0}",
    "\u{1b}[2J",
    "\n",
    "\u{feff}",
    "\u{10ffff}",
];

/// What a text nests by.
const NESTS: [&str; 6] = ["[", "{\"a\":", "[[", "{", "/*", "a."];

/// A copy with one to eight faults; `words` are the target's own, `others` are inputs to splice
/// from.
#[must_use]
pub fn mutated(rng: &mut Rng, bytes: &[u8], words: &[&str], others: &[Vec<u8>]) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..1 + rng.below(8) {
        spoil(rng, &mut out, words, others);
        out.truncate(LONGEST);
    }
    out
}

/// One fault.
fn spoil(rng: &mut Rng, out: &mut Vec<u8>, words: &[&str], others: &[Vec<u8>]) {
    if out.is_empty() {
        out.push(rng.next_u64() as u8);
        return;
    }
    let mut at = rng.below(out.len() as u32) as usize;
    // Where a file mixes text and numbers, its text says what the numbers mean: that is more worth
    // spoiling.
    for _ in 0..rng.below(6) {
        if !out[at].is_ascii_graphic() {
            at = rng.below(out.len() as u32) as usize;
        }
    }
    let end = (at + 1 + rng.below(64) as usize).min(out.len());
    let sharp = SHARP[rng.below(SHARP.len() as u32) as usize];
    match rng.below(18) {
        0 => out[at] ^= 1 << rng.below(8),
        1 => out[at] = rng.next_u64() as u8,
        2 => out[at] = out[at].wrapping_add(rng.between(-4, 4) as u8),
        3 => out.truncate(at),
        4 => drop(out.drain(at..end)),
        5 => {
            let copy = out[at..end].to_vec();
            let to = rng.below(out.len() as u32) as usize;
            out.splice(to..to, copy);
        }
        6 => {
            let copy = out[at..end].to_vec();
            let to = rng.below(out.len() as u32) as usize;
            overwrite(out, to, &copy);
        }
        7 => overwrite(out, at, &sharp.to_le_bytes()),
        8 => overwrite(out, at & !3, &(sharp as i32).to_le_bytes()),
        9 => overwrite(out, at & !1, &(sharp as i16).to_le_bytes()),
        10 => length_attack(rng, out, at),
        11 | 12 => number_attack(rng, out, at),
        13 => {
            let word = if words.is_empty() || rng.below(3) == 0 {
                WORDS[rng.below(WORDS.len() as u32) as usize]
            } else {
                words[rng.below(words.len() as u32) as usize]
            };
            out.splice(at..at, word.bytes());
        }
        14 => swap_lines(rng, out),
        15 => {
            let nest = NESTS[rng.below(NESTS.len() as u32) as usize];
            let times = 1usize << rng.below(14);
            out.splice(at..at, nest.bytes().cycle().take(nest.len() * times).collect::<Vec<_>>());
        }
        16 => {
            let copy = out[at..end].to_vec();
            let times = 1usize << rng.below(10);
            out.splice(
                at..at,
                copy.iter().copied().cycle().take(copy.len() * times).collect::<Vec<_>>(),
            );
        }
        _ => splice(rng, out, at, others),
    }
}

/// The beginning of one input, the end of another.
fn splice(rng: &mut Rng, out: &mut Vec<u8>, at: usize, others: &[Vec<u8>]) {
    if others.is_empty() {
        return;
    }
    let other = &others[rng.below(others.len() as u32) as usize];
    if !other.is_empty() {
        let from = if rng.below(2) == 0 {
            at.min(other.len() - 1)
        } else {
            rng.below(other.len() as u32) as usize
        };
        out.truncate(at);
        out.extend_from_slice(&other[from..]);
    }
}

/// A number that could be a length or a place is made a little or a lot too large.
fn length_attack(rng: &mut Rng, out: &mut [u8], at: usize) {
    let length = out.len() as u32;
    let Some(word) = out.get(at..at + 4) else { return };
    let value = u32::from_le_bytes([word[0], word[1], word[2], word[3]]);
    let new = match rng.below(6) {
        0 => value.wrapping_add(1),
        1 => value.wrapping_sub(1),
        2 => length,
        3 => length - at as u32,
        4 => value.wrapping_mul(2),
        _ => u32::MAX - rng.below(16),
    };
    overwrite(out, at, &new.to_le_bytes());
}

/// The next decimal number in a text is replaced.
fn number_attack(rng: &mut Rng, out: &mut Vec<u8>, at: usize) {
    let Some(skip) = out[at..].iter().position(u8::is_ascii_digit) else { return };
    let start = at + skip;
    let digits = out[start..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let new = match rng.below(4) {
        0 => SHARP[rng.below(SHARP.len() as u32) as usize].to_string(),
        1 => WORDS[rng.below(18) as usize].to_string(),
        2 => rng.below(300).to_string(),
        _ => format!("{}.{}e{}", rng.below(10), rng.below(1000), rng.between(-320, 320)),
    };
    out.splice(start..start + digits, new.into_bytes());
}

fn swap_lines(rng: &mut Rng, out: &mut Vec<u8>) {
    let mut lines: Vec<Vec<u8>> = out.split(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    let count = lines.len() as u32;
    let (a, b) = (rng.below(count) as usize, rng.below(count) as usize);
    if rng.below(2) == 0 {
        lines.swap(a, b);
    } else {
        lines[a] = lines[b].clone();
    }
    *out = lines.join(&b'\n');
}

fn overwrite(out: &mut [u8], at: usize, bytes: &[u8]) {
    for (to, from) in out[at..].iter_mut().zip(bytes) {
        *to = *from;
    }
}
