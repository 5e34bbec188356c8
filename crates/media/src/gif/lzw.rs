//! The compression of GIF, which may write a near colour where that makes the file smaller.
//!
//! LZW writes a number for the longest run of symbols that it has met before. A symbol that is not
//! quite the wanted one, but near, lets runs go on for longer. Terry Welch, *A Technique for
//! High-Performance Data Compression*, IEEE Computer 17 (6), 1984, is LZW; that it may be inexact
//! is an old trade of GIF tools.

const CLEAR: u16 = 256;
const END: u16 = 257;
const FIRST_FREE: u16 = 258;
const FULL: u16 = 4096;
const NONE: u16 = u16::MAX;

/// Codes of 9 to 12 bits, the lowest bit first.
struct Bits {
    bytes: Vec<u8>,
    waiting: u32,
    count: u32,
}

impl Bits {
    fn push(&mut self, code: u16, width: u32) {
        self.waiting |= u32::from(code) << self.count;
        self.count += width;
        while self.count >= 8 {
            self.bytes.push(self.waiting as u8);
            self.waiting >>= 8;
            self.count -= 8;
        }
    }
}

/// Runs met so far: a tree in which each has its last symbol, its first longer run and its next of
/// the same length.
struct Runs {
    symbol: Vec<u8>,
    longer: Vec<u16>,
    next: Vec<u16>,
}

impl Runs {
    fn new() -> Runs {
        let symbol = (0..FIRST_FREE).map(|code| code as u8).collect();
        let nothing = vec![NONE; usize::from(FIRST_FREE)];
        Runs { symbol, longer: nothing.clone(), next: nothing }
    }

    fn len(&self) -> u16 {
        self.symbol.len() as u16
    }

    fn add(&mut self, run: u16, symbol: u8) {
        let new = self.len();
        self.symbol.push(symbol);
        self.longer.push(NONE);
        self.next.push(self.longer[usize::from(run)]);
        self.longer[usize::from(run)] = new;
    }

    /// The run that goes on with a symbol, or with the one of least difference that may stand for
    /// it.
    fn go_on(&self, run: u16, wanted: u8, difference: impl Fn(u8) -> Option<u32>) -> Option<u16> {
        let mut best: Option<(u32, u16)> = None;
        let mut at = self.longer[usize::from(run)];
        while at != NONE {
            let symbol = self.symbol[usize::from(at)];
            if symbol == wanted {
                return Some(at);
            }
            if let Some(found) = difference(symbol)
                && best.is_none_or(|(least, _)| found < least)
            {
                best = Some((found, at));
            }
            at = self.next[usize::from(at)];
        }
        best.map(|(_, at)| at)
    }
}

/// Compresses symbols. `difference` of a position and a symbol is how wrong the symbol is there,
/// `None` where it may not be written; what is written takes the place of what was wanted. The
/// first byte is the width that the format wants in front.
pub(super) fn encode(symbols: &mut [u8], difference: impl Fn(usize, u8) -> Option<u32>) -> Vec<u8> {
    let mut bits = Bits { bytes: vec![8], waiting: 0, count: 0 };
    let mut runs = Runs::new();
    let mut width = 9;
    bits.push(CLEAR, width);
    let mut position = 0;
    while position < symbols.len() {
        let mut run = u16::from(symbols[position]);
        position += 1;
        while position < symbols.len() {
            let wanted = symbols[position];
            let Some(longer) = runs.go_on(run, wanted, |symbol| difference(position, symbol))
            else {
                break;
            };
            symbols[position] = runs.symbol[usize::from(longer)];
            run = longer;
            position += 1;
        }
        bits.push(run, width);
        if position < symbols.len() {
            // A reader learns of a run one code later: so does the width.
            width += u32::from(runs.len() == 1 << width);
            runs.add(run, symbols[position]);
            if runs.len() == FULL {
                bits.push(CLEAR, width);
                (runs, width) = (Runs::new(), 9);
            }
        }
    }
    bits.push(END, width);
    bits.push(0, 7);
    bits.bytes
}
