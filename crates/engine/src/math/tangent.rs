//! Tangents of table angles, in whole numbers.

/// `2 pi` with 60 fractional bits.
const TURN: i128 = 7_244_019_458_077_122_842;
/// 1 with 60 fractional bits.
const ONE: i128 = 1 << 60;
/// Terms of the series of sine and cosine together: the next one is below `2^-60`.
const TERMS: i128 = 22;

/// The tangent of a fine angle, of which there are 8192 a turn, from -45 to 45 degrees; 16.16, to the nearest if positive. As the
/// published engine adds a half and then cuts towards zero, those of negative angles are by up to 1.5 of 65536 too near to it.
pub(crate) fn fine_tangent(fine: i32) -> i32 {
    debug_assert!(fine.abs() <= 1024);
    let angle = i128::from(fine) * TURN / 8192;
    let (mut sine, mut cosine, mut term) = (0, 0, ONE);
    for n in 1..=TERMS {
        match n % 4 {
            1 => cosine += term,
            2 => sine += term,
            3 => cosine -= term,
            _ => sine -= term,
        }
        term = ((term * angle) >> 60) / n;
    }
    ((sine * (1 << 17) + cosine) / (2 * cosine)) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_are_those_of_floating_point() {
        for fine in -1024..=1024 {
            let exact = (f64::from(fine) * std::f64::consts::TAU / 8192.0).tan() * 65536.0;
            assert_eq!(fine_tangent(fine), (exact + 0.5) as i32, "{fine}: {exact}");
        }
    }
}
