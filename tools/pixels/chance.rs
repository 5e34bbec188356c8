//! What chance gave the squares of rockets in ViZDoom (docs/results/pixels.md,
//! "Squares").
//!
//! Its pictures have a stream of chance of their own, begun anew with every episode, whose bytes
//! only the squares and the face in the status bar take: every rocket that flies 75 a tic, in the
//! order in which they were thrown, and the face one whenever it is chosen, which is after a tic,
//! when a frame is drawn. So who knows when rockets flew knows what each square got.

use crate::dump::Moment;
use hasard_engine::world::{Lots, SQUARES};

/// Tics between frames, and the tic of the first one in an episode begun anew.
const FRAME_TICS: u32 = 4;
const FIRST_FRAME: u32 = 16;
/// The first episode of a game draws a frame in its first tic.
const FIRST_EPISODE_FRAME: u32 = 1;
/// Fewest tics that a glance lasts, and a grimace.
const GLANCE_TICS: u32 = 18;
const GRIMACE_TICS: u32 = 2;
/// Tics of a shot before the rocket flies and after, and of shooting after which the face is drawn
/// in anger.
const BEFORE_FLIGHT: u32 = 8;
const AFTER_FLIGHT: u32 = 12;
const ANGER_TICS: u32 = 70;

/// What the squares of each tic of every rocket's flight got.
pub fn lots(seed: u32, moment: &Moment) -> Vec<Vec<[Lots; SQUARES as usize]>> {
    let mut stream = Sfmt607::new(&[0, seed]);
    let mut lots: Vec<Vec<_>> = moment.flights.iter().map(|_| Vec::new()).collect();
    let is_first = moment.episode == 0;
    let (mut chosen_next, mut angry) =
        (if is_first { FIRST_EPISODE_FRAME } else { FIRST_FRAME }, false);
    for tic in 1..=moment.tic {
        for (flight, lots) in moment.flights.iter().zip(&mut lots) {
            if (flight.tic..flight.tic + flight.tics.unwrap_or(u32::MAX - flight.tic))
                .contains(&tic)
            {
                lots.push(Lots::of_tic(|| stream.next() as u8));
            }
        }
        let is_drawn =
            tic >= FIRST_FRAME && tic % FRAME_TICS == 0 || is_first && tic == FIRST_EPISODE_FRAME;
        let grimaces = is_angry(moment, tic);
        if is_drawn && (tic >= chosen_next || grimaces && !angry) {
            stream.next();
            chosen_next = tic + if grimaces { GRIMACE_TICS } else { GLANCE_TICS };
            angry = grimaces;
        }
    }
    lots
}

/// Whether the player has been shooting on and on in a tic.
fn is_angry(moment: &Moment, tic: u32) -> bool {
    let mut since = None;
    let mut last = 0;
    for shot in moment
        .flights
        .iter()
        .map(|flight| flight.tic)
        .filter(|shot| shot.saturating_sub(BEFORE_FLIGHT) <= tic)
    {
        if since.is_none() || shot - last > BEFORE_FLIGHT + AFTER_FLIGHT {
            since = Some(shot.saturating_sub(BEFORE_FLIGHT));
        }
        last = shot;
    }
    since.is_some_and(|since| tic >= since + ANGER_TICS && tic <= last + AFTER_FLIGHT)
}

/// The generator SFMT with the period 2^607 - 1: Saito and Matsumoto, *SIMD-oriented Fast Mersenne
/// Twister* (MCQMC 2006), section 2 and the authors' table of parameters.
struct Sfmt607 {
    /// Words of 128 bits, the lowest 32 first.
    state: [u128; 5],
    /// Numbers of 32 bits that were taken of it.
    taken: usize,
}

const PICKED: usize = 2;
const SHIFTS_OF_32: [u32; 2] = [15, 13];
const SHIFTS_OF_128: [u32; 2] = [24, 24];
const MASK: u128 = 0x7ff7_fb2f_ff77_7b7d_ef7f_3f7d_fdff_37ff;
const PARITY: u128 = 0x5986_f054_0000_0000_0000_0000_0000_0001;

impl Sfmt607 {
    /// From a list of numbers, as the authors' program begins ("init_by_array").
    fn new(key: &[u32]) -> Sfmt607 {
        const SIZE: usize = 20;
        const LAG: usize = 3;
        const MIDDLE: usize = (SIZE - LAG) / 2;
        let mut words = [0x8b8b_8b8b_u32; SIZE];
        let mut mix = |at: usize, number: Option<u32>| {
            let [other, far] = [(at + MIDDLE) % SIZE, (at + MIDDLE + LAG) % SIZE];
            let before = words[(at + SIZE - 1) % SIZE];
            let mixed = |from: u32, by: u32| (from ^ from >> 27).wrapping_mul(by);
            if let Some(number) = number {
                let first = mixed(words[at] ^ words[other] ^ before, 1_664_525);
                let second = first.wrapping_add(number);
                words[other] = words[other].wrapping_add(first);
                words[far] = words[far].wrapping_add(second);
                words[at] = second;
            } else {
                let first =
                    mixed(words[at].wrapping_add(words[other]).wrapping_add(before), 1_566_083_941);
                let second = first.wrapping_sub(at as u32);
                words[other] ^= first;
                words[far] ^= second;
                words[at] = second;
            }
        };
        mix(0, Some(key.len() as u32));
        for at in 1..SIZE {
            mix(at, Some(key.get(at - 1).copied().unwrap_or(0).wrapping_add(at as u32)));
        }
        (0..SIZE).for_each(|at| mix(at, None));
        let word = |at: usize| {
            (0..4).rev().fold(0, |word, part| word << 32 | u128::from(words[4 * at + part]))
        };
        let mut state = [0, 1, 2, 3, 4].map(word);
        if (state[0] & PARITY).count_ones().is_multiple_of(2) {
            state[0] ^= PARITY & PARITY.wrapping_neg();
        }
        Sfmt607 { state, taken: 4 * state.len() }
    }

    fn next(&mut self) -> u32 {
        if self.taken == 4 * self.state.len() {
            self.go_on();
        }
        self.taken += 1;
        (self.state[(self.taken - 1) / 4] >> (32 * ((self.taken - 1) % 4))) as u32
    }

    /// The recursion (2) of the paper, for all words.
    fn go_on(&mut self) {
        let each = |word: u128, shifted: fn(u32) -> u32| {
            (0..4).fold(0, |all, part| {
                all | u128::from(shifted((word >> (32 * part)) as u32)) << (32 * part)
            })
        };
        let count = self.state.len();
        for at in 0..count {
            let [first, picked] = [self.state[at], self.state[(at + PICKED) % count]];
            let [before_last, last] = [2, 1].map(|back| self.state[(at + count - back) % count]);
            self.state[at] = first
                ^ first << SHIFTS_OF_128[0]
                ^ each(picked, |part| part >> SHIFTS_OF_32[1]) & MASK
                ^ before_last >> SHIFTS_OF_128[1]
                ^ each(last, |part| part << SHIFTS_OF_32[0]);
        }
        self.taken = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dump::Flight;
    use std::collections::BTreeMap;

    /// What episodes of the seed 1 begin with: the first numbers of its Mersenne Twister.
    const FIRST: u32 = 1_791_095_845;

    /// A moment of the first episode in which nothing but these flights was seen.
    fn moment(tic: u32, flights: Vec<Flight>) -> Moment {
        let (variables, labels) = (BTreeMap::new(), Vec::new());
        let (floors, ceilings, bursts) = (Vec::new(), Vec::new(), Vec::new());
        Moment {
            number: 0,
            tic,
            variables,
            floors,
            ceilings,
            chance: Some(FIRST),
            episode: 0,
            bursts,
            flights,
            labels,
        }
    }

    #[test]
    fn the_stream_is_what_squares_and_faces_showed() {
        let mut stream = Sfmt607::new(&[0, FIRST]);
        let bytes: Vec<u8> = (0..150).map(|_| stream.next() as u8).collect();
        // Where the face looked in tics 20, 40, 60 and 80 of Collateral Damage 1, after a first
        // choice that nobody saw.
        assert_eq!([1, 2, 3, 4].map(|choice| bytes[choice] % 3), [1, 0, 1, 1]);
        // In a bare room without a status bar, what squares of a rocket's second tic lay back and
        // above, as seen on the screen: the yellow one, and the grey ones.
        let seen = [[125, 0], [177, 205], [126, 217], [235, 233], [86, 113], [47, 255], [211, 69]];
        let mut draws = bytes[75..].iter().copied();
        for (lots, [back, up]) in Lots::of_tic(|| draws.next().unwrap_or_default()).iter().zip(seen)
        {
            assert!(
                lots.back.abs_diff(back) <= 2 && lots.up.abs_diff(up) <= 2,
                "{lots:?}, not {back} and {up}"
            );
        }
        assert_eq!(draws.len(), 0);
    }

    #[test]
    fn rockets_take_bytes_while_they_fly_and_the_face_takes_some_between() {
        let flight = |tic, tics| Flight { tic, place: [0.0; 3], velocity: [20.0, 0.0, 0.0], tics };
        let flights = vec![flight(85, Some(2)), flight(87, Some(0)), flight(89, None)];
        let drawn = lots(FIRST, &moment(92, flights));
        assert_eq!(drawn.iter().map(Vec::len).collect::<Vec<_>>(), [2, 0, 4]);
        // Choices of the face in tics 1, 20, 40, 60 and 80 come first.
        let mut stream = Sfmt607::new(&[0, FIRST]);
        for _face in 0..5 {
            stream.next();
        }
        for tic in drawn.iter().flatten() {
            assert_eq!(*tic, Lots::of_tic(|| stream.next() as u8));
        }
    }

    #[test]
    fn who_shoots_on_and_on_is_angry_from_70_tics_until_the_last_shot_is_over() {
        let flights = [1017, 1037, 1057, 1077, 1161].map(|tic| Flight {
            tic,
            place: [0.0; 3],
            velocity: [0.0; 3],
            tics: Some(0),
        });
        let moment = moment(0, flights.into());
        // As seen: in the frames of tics 1080, 1084 and 1088.
        let angry: Vec<u32> =
            (1000..1300).step_by(4).filter(|&tic| is_angry(&moment, tic)).collect();
        assert_eq!(angry, [1080, 1084, 1088]);
    }
}
