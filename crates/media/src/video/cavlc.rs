//! Coding of a block's coefficients (clause 9.2).

use super::bits::BitWriter;
use super::tables::{CHROMA_DC_TOKENS, CHROMA_DC_TOTAL_ZEROS, COEFFICIENT_TOKENS, RUN_BEFORE, TOTAL_ZEROS};

/// What the code of a block depends on beside its levels.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Context {
    /// Coefficients of the neighbours, by their mean.
    Neighbours(u8),
    /// First coefficients of colour differences.
    ChromaDc,
}

/// Writes levels that are given in the order of frequency (zigzag). Gives the number of levels that are not zero.
pub(super) fn write_levels(bits: &mut BitWriter, levels: &[i32], context: Context) -> u8 {
    // Nonzero levels from the highest frequency down, and the zeros before each.
    let mut nonzero = [0i32; 16];
    let mut runs = [0usize; 16];
    let mut count = 0;
    let mut run = 0;
    for &level in levels {
        if level == 0 {
            run += 1;
        } else {
            nonzero[count] = level;
            runs[count] = run;
            count += 1;
            run = 0;
        }
    }
    nonzero[..count].reverse();
    runs[..count].reverse();
    let ones = nonzero[..count].iter().take(3).take_while(|level| level.abs() == 1).count();
    write_token(bits, count, ones, context);
    if count == 0 {
        return 0;
    }
    for &level in &nonzero[..ones] {
        bits.flag(level < 0);
    }
    write_magnitudes(bits, &nonzero[ones..count], ones, count);
    let mut zeros_left: usize = runs[..count].iter().sum();
    if count < levels.len() {
        let table = if context == Context::ChromaDc { CHROMA_DC_TOTAL_ZEROS[count - 1] } else { TOTAL_ZEROS[count - 1] };
        put(bits, table[zeros_left]);
    }
    // The run before the lowest frequency follows from the others.
    for &run in &runs[..count - 1] {
        if zeros_left == 0 {
            break;
        }
        put(bits, RUN_BEFORE[zeros_left.min(7) - 1][run]);
        zeros_left -= run;
    }
    count as u8
}

fn put(bits: &mut BitWriter, (length, code): (u8, u8)) {
    bits.put(u32::from(code), u32::from(length));
}

fn write_token(bits: &mut BitWriter, count: usize, ones: usize, context: Context) {
    match context {
        Context::ChromaDc => put(bits, CHROMA_DC_TOKENS[count][ones]),
        Context::Neighbours(0 | 1) => put(bits, COEFFICIENT_TOKENS[0][count][ones]),
        Context::Neighbours(2 | 3) => put(bits, COEFFICIENT_TOKENS[1][count][ones]),
        Context::Neighbours(4..=7) => put(bits, COEFFICIENT_TOKENS[2][count][ones]),
        Context::Neighbours(_) => bits.put(if count == 0 { 3 } else { 4 * (count as u32 - 1) + ones as u32 }, 6),
    }
}

/// Levels other than the trailing ones (clause 9.2.2.1): a unary prefix and a suffix that grows with the levels seen.
fn write_magnitudes(bits: &mut BitWriter, levels: &[i32], ones: usize, count: usize) {
    let mut suffix_length = u32::from(count > 10 && ones < 3);
    for (index, &level) in levels.iter().enumerate() {
        let mut code = 2 * level.unsigned_abs() - if level > 0 { 2 } else { 1 };
        if index == 0 && ones < 3 {
            // It cannot be a one, or it would be a trailing one.
            code -= 2;
        }
        let (prefix, suffix, suffix_bits) = if suffix_length == 0 {
            match code {
                0..14 => (code, 0, 0),
                14..30 => (14, code - 14, 4),
                _ => (15, code - 30, 12),
            }
        } else if code < 15 << suffix_length {
            (code >> suffix_length, code & ((1 << suffix_length) - 1), suffix_length)
        } else {
            (15, code - (15 << suffix_length), 12)
        };
        bits.put(1, prefix + 1);
        bits.put(suffix, suffix_bits);
        if suffix_length == 0 {
            suffix_length = 1;
        }
        if level.unsigned_abs() > 3 << (suffix_length - 1) && suffix_length < 6 {
            suffix_length += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits_of(levels: &[i32], context: Context) -> String {
        let mut bits = BitWriter::default();
        write_levels(&mut bits, levels, context);
        let text: String = bits.finish().iter().map(|byte| format!("{byte:08b}")).collect();
        // Without the stop bit and its zeros.
        text.trim_end_matches('0').strip_suffix('1').unwrap().to_owned()
    }

    #[test]
    fn worked_by_hand_from_the_tables() {
        // Levels 0 3 0 1 -1 -1 0 1: five coefficients, three trailing ones, three zeros.
        let levels = [0, 3, 0, 1, -1, -1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0];
        assert_eq!(
            bits_of(&levels, Context::Neighbours(0)),
            "0000100".to_owned() + "011" + "1" + "0010" + "111" + "10" + "1" + "1" + "01"
        );
        assert_eq!(bits_of(&[0; 16], Context::Neighbours(9)), "000011");
        assert_eq!(bits_of(&[0, 0, 0, 0], Context::ChromaDc), "01");
        assert_eq!(bits_of(&[1, 0, 0, -1], Context::ChromaDc), "001".to_owned() + "10" + "00" + "00");
    }
}
