//! The tile of pairs by the processor's unit for tiles of matrices (AMX): 16 rows, 16 columns and 16
//! pairs of the inner dimension at once.
//!
//! Four tiles of sums stay in its registers, 32 rows x 32 columns. A tile of the left factor is read
//! where it lies if the pairs of a row stand side by side; otherwise it is put so into memory of the
//! processor's nearest cache.
//!
//! The compiler knows none of the unit's registers, so what is in them outlasts an `asm!` block; no
//! code of this program is compiled for the unit.

use std::arch::asm;
use std::arch::x86_64::{
    __m512i, _mm512_add_ps, _mm512_loadu_ps, _mm512_maskz_loadu_epi32, _mm512_setzero_si512,
    _mm512_shuffle_i32x4, _mm512_storeu_ps, _mm512_storeu_si512, _mm512_unpackhi_epi32,
    _mm512_unpackhi_epi64, _mm512_unpacklo_epi32, _mm512_unpacklo_epi64,
};
use std::cell::Cell;

use crate::networks::cpu::bfloat16::number::Pair;
use crate::networks::cpu::tile::{Finish, Tile};

/// Rows, and pairs of the inner dimension, of a register.
pub const SIDE: usize = 16;

/// What the registers hold, as the processor reads it.
#[repr(C, align(64))]
struct Layout {
    palette: u8,
    start_row: u8,
    reserved: [u8; 14],
    row_bytes: [u16; 16],
    rows: [u8; 16],
}

thread_local! {
    /// Upper rows, lower rows and pairs that this thread's registers are laid out for; zeros where
    /// the unit is not in use.
    static LAID_OUT: Cell<[u8; 3]> = const { Cell::new([0; 3]) };
}

/// Lays the registers out, if they are not yet: it takes as long as eight products. They are zero
/// afterwards, or hold what they held.
#[inline]
fn lay_out(upper: usize, lower: usize, pairs: usize) {
    let wanted = [upper as u8, lower as u8, pairs as u8];
    if LAID_OUT.replace(wanted) == wanted {
        return;
    }
    let mut layout =
        Layout { palette: 1, start_row: 0, reserved: [0; 14], row_bytes: [0; 16], rows: [0; 16] };
    let (sums, left, right) = ([upper, upper, lower, lower], [upper, lower], [pairs, pairs]);
    let rows = sums.into_iter().chain(left).chain(right);
    for (register, rows) in rows.enumerate().filter(|&(_, rows)| rows > 0) {
        let numbers = if matches!(register, 4 | 5) { pairs } else { SIDE };
        layout.rows[register] = rows as u8;
        layout.row_bytes[register] = 4 * numbers as u16;
    }
    // SAFETY: the layout is one that the processor allows: at most 16 rows of at most 64 bytes.
    unsafe {
        asm!("ldtilecfg [{}]", in(reg) &raw const layout, options(nostack, readonly, preserves_flags));
    }
}

/// Gives the registers back, so that the system need not keep them when this thread rests.
pub fn release() {
    if LAID_OUT.replace([0; 3]) != [0; 3] {
        // SAFETY: they were laid out by this thread, so the processor has them.
        unsafe { asm!("tilerelease", options(nostack, nomem, preserves_flags)) };
    }
}

/// A factor's tile, put together.
#[repr(C, align(64))]
struct Gathered([[Pair; SIDE]; SIDE]);

/// Computes a tile of up to 32 rows. After the last of a product comes [`release`].
///
/// # Safety
/// All elements of the tile must lie inside the allocations behind the pointers.
#[target_feature(enable = "avx512f")]
pub unsafe fn tile_of(
    tile: Tile,
    height: usize,
    left: *const u16,
    right: *const Pair,
    out: *mut f32,
) {
    // SAFETY: as the caller promised.
    unsafe {
        if height > SIDE {
            rows::<true>(tile, height, left, right, out);
        } else {
            rows::<false>(tile, height, left, right, out);
        }
    }
}

/// Loads a register from memory whose rows are `$stride` bytes apart.
macro_rules! load {
    ($register:literal, $from:expr, $stride:expr) => {
        asm!(
            concat!("tileloadd ", $register, ", [{from} + {stride}]"),
            from = in(reg) $from, stride = in(reg) $stride, options(nostack, readonly, preserves_flags)
        )
    };
}

/// Stores a register.
macro_rules! store {
    ($register:literal, $to:expr, $stride:expr) => {
        asm!(
            concat!("tilestored [{to} + {stride}], ", $register),
            to = in(reg) $to, stride = in(reg) $stride, options(nostack, preserves_flags)
        )
    };
}

/// Clears a register.
macro_rules! zero {
    ($register:literal) => {
        asm!(concat!("tilezero ", $register), options(nostack, nomem, preserves_flags))
    };
}

/// Adds the product of two registers to a third.
macro_rules! multiply {
    ($sums:literal, $left:literal, $right:literal) => {
        asm!(
            concat!("tdpbf16ps ", $sums, ", ", $left, ", ", $right),
            options(nostack, nomem, preserves_flags)
        )
    };
}

/// Loads or stores the sums of a tile whose rows are `$stride` numbers apart.
macro_rules! sums {
    ($do:ident, $at:expr, $stride:expr, $lower:expr) => {
        $do!("tmm0", $at, 4 * $stride);
        $do!("tmm1", $at.add(SIDE), 4 * $stride);
        if $lower {
            $do!("tmm2", $at.add(SIDE * $stride), 4 * $stride);
            $do!("tmm3", $at.add(SIDE * $stride + SIDE), 4 * $stride);
        }
    };
}

/// Registers 0 to 3 are sums (upper rows left and right, lower rows left and right), 4 and 5 the
/// left factor's rows, 6 and 7 the right factor's columns.
#[target_feature(enable = "avx512f")]
unsafe fn rows<const LOWER: bool>(
    tile: Tile,
    height: usize,
    left: *const u16,
    right: *const Pair,
    out: *mut f32,
) {
    let at_once = tile.inner.min(SIDE);
    let (upper, lower) = (height.min(SIDE), height.saturating_sub(SIDE));
    lay_out(upper, lower, at_once);
    // SAFETY: registers are loaded from elements of the tile, whose addresses the caller vouches
    // for, and from memory of this function; those without rows are not touched. A product of two
    // registers touches no memory.
    unsafe {
        if tile.finish == Finish::Continue {
            sums!(load, out, tile.out_stride, LOWER);
        } else {
            zero!("tmm0");
            zero!("tmm1");
            if LOWER {
                zero!("tmm2");
                zero!("tmm3");
            }
        }
        let (mut part, mut right) = (left, right);
        for _ in 0..tile.parts {
            let mut left = part;
            for first in (0..tile.inner).step_by(at_once) {
                let count = at_once.min(tile.inner - first);
                let whole = count == at_once;
                if whole {
                    load!("tmm6", right, 4 * tile.right_inner);
                    load!("tmm7", right.add(SIDE), 4 * tile.right_inner);
                } else {
                    let [first, second] =
                        [0, SIDE].map(|half| padded(right.add(half), tile, count));
                    load!("tmm6", &raw const first, 4 * SIDE);
                    load!("tmm7", &raw const second, 4 * SIDE);
                }
                let lower_left = left.wrapping_add(SIDE * tile.row_stride);
                if whole && tile.left_inner == 2 {
                    load!("tmm4", left, 2 * tile.row_stride);
                    if LOWER {
                        load!("tmm5", lower_left, 2 * tile.row_stride);
                    }
                } else {
                    let gathered = gather(left, tile, upper, count);
                    load!("tmm4", &raw const gathered, 4 * SIDE);
                    if LOWER {
                        let gathered = gather(lower_left, tile, lower, count);
                        load!("tmm5", &raw const gathered, 4 * SIDE);
                    }
                }
                multiply!("tmm0", "tmm4", "tmm6");
                multiply!("tmm1", "tmm4", "tmm7");
                if LOWER {
                    multiply!("tmm2", "tmm5", "tmm6");
                    multiply!("tmm3", "tmm5", "tmm7");
                }
                left = left.wrapping_add(count * tile.left_inner);
                right = right.wrapping_add(count * tile.right_inner);
            }
            part = part.wrapping_add(tile.left_part);
        }
        if tile.finish != Finish::Add {
            sums!(store, out, tile.out_stride, LOWER);
            return;
        }
        const WIDTH: usize = 2 * SIDE;
        let mut found = [[0f32; WIDTH]; 2 * SIDE];
        sums!(store, found.as_mut_ptr().cast::<f32>(), WIDTH, LOWER);
        for (row, found) in found.iter().take(height).enumerate() {
            for half in [0, SIDE] {
                let to = out.add(row * tile.out_stride + half);
                let sum = _mm512_loadu_ps(found.as_ptr().add(half));
                _mm512_storeu_ps(to, _mm512_add_ps(_mm512_loadu_ps(to), sum));
            }
        }
    }
}

/// The last pairs of the right factor, 16 columns of them, with zeros beside them.
///
/// # Safety
/// All of them must lie inside the allocation behind the pointer.
unsafe fn padded(right: *const Pair, tile: Tile, count: usize) -> Gathered {
    let mut padded = Gathered([[0; SIDE]; SIDE]);
    for (k, row) in padded.0.iter_mut().take(count).enumerate() {
        // SAFETY: as the caller promised.
        unsafe {
            row.as_mut_ptr().copy_from_nonoverlapping(right.add(k * tile.right_inner), SIDE);
        }
    }
    padded
}

/// Some rows of the left factor, `count` pairs of each and zeros behind them.
///
/// # Safety
/// All of them must lie inside the allocation behind the pointer.
#[target_feature(enable = "avx512f")]
unsafe fn gather(left: *const u16, tile: Tile, rows: usize, count: usize) -> Gathered {
    let mut gathered = Gathered([[0; SIDE]; SIDE]);
    // SAFETY: as the caller promised; rows that are not there are masked out.
    unsafe {
        if tile.row_stride == 2 {
            let mask = ((1u32 << rows) - 1) as u16;
            let mut columns = [_mm512_setzero_si512(); SIDE];
            for (k, column) in columns.iter_mut().take(count).enumerate() {
                *column = _mm512_maskz_loadu_epi32(mask, left.add(k * tile.left_inner).cast());
            }
            for (row, pairs) in gathered.0.iter_mut().zip(transposed(columns)) {
                _mm512_storeu_si512(row.as_mut_ptr().cast(), pairs);
            }
        } else {
            for (row, pairs) in gathered.0.iter_mut().take(rows).enumerate() {
                let from = left.add(row * tile.row_stride);
                for (k, pair) in pairs.iter_mut().take(count).enumerate() {
                    *pair = from.add(k * tile.left_inner).cast::<Pair>().read_unaligned();
                }
            }
        }
    }
    gathered
}

/// The rows of a matrix as its columns.
#[target_feature(enable = "avx512f")]
fn transposed(rows: [__m512i; SIDE]) -> [__m512i; SIDE] {
    let zero = _mm512_setzero_si512();
    let (mut twos, mut fours, mut all) = ([zero; SIDE], [zero; SIDE], [zero; SIDE]);
    for two in 0..8 {
        let (first, second) = (rows[2 * two], rows[2 * two + 1]);
        twos[2 * two] = _mm512_unpacklo_epi32(first, second);
        twos[2 * two + 1] = _mm512_unpackhi_epi32(first, second);
    }
    for four in 0..4 {
        for half in 0..2 {
            let (first, second) = (twos[4 * four + half], twos[4 * four + half + 2]);
            fours[4 * four + 2 * half] = _mm512_unpacklo_epi64(first, second);
            fours[4 * four + 2 * half + 1] = _mm512_unpackhi_epi64(first, second);
        }
    }
    // Column `4 * lane + column` of four rows is in a lane of `fours[4 * four + column]`.
    for column in 0..4 {
        let of = |four: usize| fours[4 * four + column];
        let (even, odd) = (
            [
                _mm512_shuffle_i32x4::<0x88>(of(0), of(1)),
                _mm512_shuffle_i32x4::<0x88>(of(2), of(3)),
            ],
            [
                _mm512_shuffle_i32x4::<0xDD>(of(0), of(1)),
                _mm512_shuffle_i32x4::<0xDD>(of(2), of(3)),
            ],
        );
        all[column] = _mm512_shuffle_i32x4::<0x88>(even[0], even[1]);
        all[4 + column] = _mm512_shuffle_i32x4::<0x88>(odd[0], odd[1]);
        all[8 + column] = _mm512_shuffle_i32x4::<0xDD>(even[0], even[1]);
        all[12 + column] = _mm512_shuffle_i32x4::<0xDD>(odd[0], odd[1]);
    }
    all
}
