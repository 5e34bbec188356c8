//! Division by a number of things, such as columns of a frame, by a product: most processors take
//! several times as long to divide.

/// Counts that are divided by so: columns of the widest frame.
const MOST: usize = 1920;

/// For each count `2^64` divided by it, rounded up; the first two are not used.
static INVERSES: [u64; MOST + 1] = {
    let mut list = [0; MOST + 1];
    let mut count = 2;
    while count <= MOST {
        list[count] = u64::MAX / count as u64 + 1;
        count += 1;
    }
    list
};

/// `whole / count`, rounded towards 0. Counts below 1 count as 1.
#[inline]
pub(crate) fn divided_by_count(whole: i64, count: i64) -> i64 {
    // An inverse is too large by less than one part in `2^64 / count`: too little to show in the
    // quotient.
    const LIMIT: u64 = u64::MAX / MOST as u64;
    let size = whole.unsigned_abs();
    if count <= 1 {
        return whole;
    }
    match INVERSES.get(count as usize) {
        Some(&inverse) if size < LIMIT => {
            let quotient = ((u128::from(size) * u128::from(inverse)) >> 64) as i64;
            if whole < 0 { -quotient } else { quotient }
        }
        _ => whole / count,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn products_divide_exactly() {
        let mut rng = Rng::new(55);
        for count in -1..=MOST as i64 + 2 {
            let divisor = count.max(1);
            let limit = (u64::MAX / MOST as u64) as i64;
            for round in 0..60 {
                let any = rng.next_u64() as i64 >> (round % 60);
                // Multiples and what is next to them are where a quotient jumps.
                let multiple = any / divisor * divisor;
                for whole in [
                    any,
                    multiple,
                    multiple - 1,
                    multiple + 1,
                    limit - round,
                    -limit + round,
                    i64::MAX,
                    i64::MIN + 1,
                ] {
                    assert_eq!(
                        divided_by_count(whole, count),
                        whole / divisor,
                        "{whole} / {count}"
                    );
                }
            }
        }
    }
}
