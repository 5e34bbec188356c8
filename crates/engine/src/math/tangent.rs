//! Tangents of fine angles, of which there are 8192 a turn. The sine table is too coarse to divide
//! by itself.

/// The largest angle that has a tangent here: 60 degrees.
pub(crate) const STEEPEST: i32 = 8192 / 6;
/// Fractional bits of the series.
const BITS: u32 = 60;

/// Tangents of the angles from 0, 16.16, to the nearest.
static TANGENTS: [i32; STEEPEST as usize + 1] = {
    let mut table = [0; STEEPEST as usize + 1];
    let mut i = 0;
    while i < table.len() {
        let (sine, cosine) = sine_and_cosine(i as i128);
        table[i] = (((sine << 16) + cosine / 2) / cosine) as i32;
        i += 1;
    }
    table
};

/// Sine and cosine of a fine angle by their power series.
const fn sine_and_cosine(fine: i128) -> (i128, i128) {
    // Pi with 60 fractional bits.
    const PI: i128 = 0x3243_F6A8_885A_308D;
    let angle = PI * fine / 4096;
    let (mut sine, mut cosine) = (0, 0);
    let (mut term, mut n) = (1i128 << BITS, 0);
    while n < 24 {
        let signed = if n % 4 < 2 { term } else { -term };
        if n % 2 == 0 {
            cosine += signed;
        } else {
            sine += signed;
        }
        n += 1;
        term = ((term * angle) >> BITS) / n;
    }
    (sine, cosine)
}

/// The tangent of an angle from minus [`STEEPEST`] to it, 16.16. Negative ones are rounded towards
/// zero after a half was added, as ViZDoom was seen to do: that moves distant floors
/// by half a texel, and here and there a column of the sky by one.
pub(crate) fn fine_tangent(fine: i32) -> i64 {
    let tangent = i64::from(TANGENTS[fine.unsigned_abs() as usize]);
    if fine < 0 { 1 - tangent } else { tangent }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_are_those_of_floating_point() {
        for fine in -STEEPEST..=STEEPEST {
            let exact = (f64::from(fine) * std::f64::consts::TAU / 8192.0).tan() * 65536.0;
            assert_eq!(fine_tangent(fine), (exact + 0.5) as i64, "fine angle {fine}: {exact}");
        }
    }
}
