//! Bit strings.

/// Bits, the highest of each byte first.
#[derive(Clone, Debug, Default)]
pub(super) struct BitWriter {
    bytes: Vec<u8>,
    /// Bits that do not fill a byte yet, right-aligned.
    rest: u64,
    rest_bits: u32,
}

impl BitWriter {
    /// Appends the lowest `count` bits of `value`, at most 32.
    pub fn put(&mut self, value: u32, count: u32) {
        debug_assert!(count == 32 || value >> count == 0, "{value} in {count} bits");
        self.rest = (self.rest << count) | u64::from(value);
        self.rest_bits += count;
        while self.rest_bits >= 8 {
            self.rest_bits -= 8;
            self.bytes.push((self.rest >> self.rest_bits) as u8);
        }
        self.rest &= (1 << self.rest_bits) - 1;
    }

    /// A flag.
    pub fn flag(&mut self, on: bool) {
        self.put(u32::from(on), 1);
    }

    /// An unsigned Exp-Golomb code (clause 9.1).
    pub fn unsigned(&mut self, value: u32) {
        let bits = 32 - (value + 1).leading_zeros();
        self.put(0, bits - 1);
        self.put(value + 1, bits);
    }

    /// A signed Exp-Golomb code (clause 9.1.1).
    pub fn signed(&mut self, value: i32) {
        self.unsigned(if value > 0 { 2 * value as u32 - 1 } else { 2 * value.unsigned_abs() });
    }

    /// Ends a payload: a one and zeros up to a byte (clause 7.3.2.11).
    pub fn finish(mut self) -> Vec<u8> {
        self.put(1, 1);
        if self.rest_bits > 0 {
            self.put(0, 8 - self.rest_bits);
        }
        self.bytes
    }
}

/// A NAL unit: its header byte and the payload, in which a 3 is put after every two zero bytes that a byte of 0 to 3
/// follows, so that no start code occurs inside (clause 7.4.1).
pub(super) fn nal_unit(header: u8, payload: &[u8]) -> Vec<u8> {
    let mut unit = Vec::with_capacity(payload.len() + payload.len() / 64 + 1);
    unit.push(header);
    let mut zeros = 0;
    for &byte in payload {
        if zeros == 2 && byte <= 3 {
            unit.push(3);
            zeros = 0;
        }
        zeros = if byte == 0 { zeros + 1 } else { 0 };
        unit.push(byte);
    }
    unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_as_in_the_standard() {
        let mut bits = BitWriter::default();
        // Table 9-1 and 9-3: 0 -> 1, 1 -> 010, 2 -> 011, 3 -> 00100; signed 1, -1, 2 -> codes 1, 2, 3.
        for value in 0..4 {
            bits.unsigned(value);
        }
        for value in [0, 1, -1, 2] {
            bits.signed(value);
        }
        assert_eq!(bits.finish(), [0b1010_0110, 0b0100_1010, 0b0110_0100, 0b1000_0000]);
        assert_eq!(nal_unit(0x65, &[0, 0, 0, 0, 0, 1, 9, 0, 0, 4]), [0x65, 0, 0, 3, 0, 0, 3, 0, 1, 9, 0, 0, 4]);
    }
}
