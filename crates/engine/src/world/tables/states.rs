//! How actors look and what they do over time: lists of frames, each shown for some tics.
//!
//! An actor is in one [`Phase`] and one step of that phase's animation. Animations that only loop
//! and act on nothing (items, decor, a barrel at rest) need no counter: their frame is a function
//! of the tics since they appeared, so that a hundred items at rest cost nothing per tic.
//!
//! Long because it is one table: the frames of every kind.

use crate::assets::sprite_index;

use crate::world::tables::info::kinds;
use crate::world::tables::kinds::ActorKind;

/// Which of its animations an actor is in.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[repr(u8)]
pub enum Phase {
    /// As it appears: items, decor, missiles in flight, monsters without anything to do.
    #[default]
    Idle,
    /// Monsters on their way.
    Walk,
    /// Monsters that feel a hit.
    Pain,
    /// Dying monsters and barrels, exploding missiles.
    Death,
}

/// What an actor does on entering a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Action {
    /// Nothing.
    None,
    /// Looks for somewhere to go.
    Look,
    /// Walks one step.
    Chase,
    /// A dying monster stops being in the way.
    StopBlocking,
    /// Bursts: a blast.
    Explode,
    /// A rocket leaves a puff of smoke.
    Smoke,
}

/// A picture and how long it is shown.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Index into [`SPRITE_NAMES`](crate::assets::SPRITE_NAMES).
    pub sprite: u8,
    /// Letter of the picture, 0 = `A`.
    pub frame: u8,
    /// Drawn at full brightness.
    pub bright: bool,
    /// Tics shown; -1 for ever.
    pub tics: i16,
    /// Done on entering it.
    pub action: Action,
}

/// What comes after the last frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Then {
    /// The first frame again.
    Loop,
    /// On with [`Phase::Walk`].
    Walk,
    /// The actor is removed.
    Vanish,
}

/// A list of frames.
#[derive(Clone, Copy, Debug)]
pub struct Animation {
    /// At least one frame.
    pub frames: &'static [Frame],
    /// What comes after the last.
    pub then: Then,
}

/// What of an actor is drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Picture {
    /// Index into [`SPRITE_NAMES`](crate::assets::SPRITE_NAMES).
    pub sprite: u8,
    /// Letter of the picture, 0 = `A`.
    pub frame: u8,
    /// Drawn at full brightness whatever the sector's light.
    pub bright: bool,
    /// How much of it hides what is behind, in parts of [`OPAQUE`].
    pub opacity: u8,
}

/// The opacity of what hides all that is behind it. Twice as fine as colours are mixed: either
/// colour's part is cut to a 64th, so that what is two fifths opaque shows 25 of them and
/// leaves 38.
pub const OPAQUE: u8 = 128;

/// Tics of a blur sphere's pulse: half of them it fades, by a 32nd a tic, the other half it comes
/// back.
const PULSE_TICS: u32 = 48;

/// A fraction of [`OPAQUE`].
fn parts(upper: u16, lower: u16) -> u8 {
    (u16::from(OPAQUE) * upper / lower) as u8
}

/// How opaque a kind is in a phase and at an age in tics, as measured in the original; barrels
/// burst without shining through.
pub(in crate::world) fn opacity(kind: ActorKind, phase: Phase, age: u32) -> u8 {
    match (kind, phase) {
        (K::BulletPuff, _) => OPAQUE / 2,
        (K::BlurSphere, _) => {
            let faded = age % PULSE_TICS;
            OPAQUE - OPAQUE / 32 * faded.min(PULSE_TICS - faded) as u8
        }
        (K::RocketSmokeTrail, _) => parts(2, 5),
        (K::LostSoul, _) => parts(3, 4),
        (K::Rocket, Phase::Death) => parts(2, 3),
        _ => OPAQUE,
    }
}

/// Index of a sprite name; an unknown name stops the build.
pub(in crate::world) const fn sprite(name: &str) -> u8 {
    match sprite_index(name) {
        Some(index) => index,
        None => panic!("not in SPRITE_NAMES"),
    }
}

/// A frame that shows picture `letter` of `name`.
const fn still(name: &str, letter: u8, tics: i16) -> Frame {
    Frame { sprite: sprite(name), frame: letter - b'A', bright: false, tics, action: Action::None }
}

const fn bright(name: &str, letter: u8, tics: i16) -> Frame {
    Frame { bright: true, ..still(name, letter, tics) }
}

const fn act(frame: Frame, action: Action) -> Frame {
    Frame { action, ..frame }
}

/// `N` frames of `name`, picture by picture of `letters`, each for `tics` and with the same action.
const fn run<const N: usize>(
    name: &str,
    letters: &[u8; N],
    tics: i16,
    lit: bool,
    action: Action,
) -> [Frame; N] {
    let mut frames = [Frame { bright: lit, action, ..still(name, letters[0], tics) }; N];
    let mut i = 1;
    while i < N {
        frames[i].frame = letters[i] - b'A';
        i += 1;
    }
    frames
}

/// A looping animation of evenly timed pictures without actions.
macro_rules! idle {
    ($name:literal, $letters:literal, $tics:literal) => {
        idle!($name, $letters, $tics, false)
    };
    ($name:literal, $letters:literal, $tics:literal, $lit:literal) => {{
        const FRAMES: [Frame; $letters.len()] = run($name, $letters, $tics, $lit, Action::None);
        Animation { frames: &FRAMES, then: Then::Loop }
    }};
}

/// The walk of a monster: a step on every frame.
macro_rules! walk {
    ($name:literal, $letters:literal, $tics:literal, $lit:literal) => {{
        const FRAMES: [Frame; $letters.len()] = run($name, $letters, $tics, $lit, Action::Chase);
        Animation { frames: &FRAMES, then: Then::Loop }
    }};
}

/// The stand of a monster: a look around on every frame.
macro_rules! stand {
    ($name:literal, $letters:literal, $lit:literal) => {{
        const FRAMES: [Frame; $letters.len()] = run($name, $letters, 10, $lit, Action::Look);
        Animation { frames: &FRAMES, then: Then::Loop }
    }};
}

/// Frames one by one, then something else than the first of them.
macro_rules! once {
    ($then:ident: $($frame:expr),+ $(,)?) => {{
        const FRAMES: &[Frame] = &[$($frame),+];
        Animation { frames: FRAMES, then: Then::$then }
    }};
}

use ActorKind as K;

/// The animation of a kind as it appears.
const fn idle_of(kind: ActorKind) -> Animation {
    match kind {
        K::Player => idle!("PLAY", b"A", -1),
        K::HealthBonus => idle!("BON1", b"ABCDCB", 6),
        K::Stimpack => idle!("STIM", b"A", -1),
        K::Medikit => idle!("MEDI", b"A", -1),
        K::ArmorBonus => idle!("BON2", b"ABCDCB", 6),
        K::RocketAmmo => idle!("ROCK", b"A", -1),
        K::Shell => idle!("SHEL", b"A", -1),
        K::Cell => idle!("CELL", b"A", -1),
        K::Clip => idle!("CLIP", b"A", -1),
        K::Infrared => once!(Loop: bright("PVIS", b'A', 6), still("PVIS", b'B', 6)),
        K::BlurSphere => idle!("PINS", b"ABCD", 6, true),
        K::Allmap => idle!("PMAP", b"ABCDCB", 6, true),
        K::Backpack => idle!("BPAK", b"A", -1),
        K::RadSuit => idle!("SUIT", b"A", -1, true),
        K::YellowCard => once!(Loop: still("YKEY", b'A', 10), bright("YKEY", b'B', 10)),
        K::BlueSkull => once!(Loop: still("BSKU", b'A', 10), bright("BSKU", b'B', 10)),
        K::Pistol => idle!("PIST", b"A", -1),
        K::Shotgun => idle!("SHOT", b"A", -1),
        K::SuperShotgun => idle!("SGN2", b"A", -1),
        K::Chaingun => idle!("MGUN", b"A", -1),
        K::RocketLauncher => idle!("LAUN", b"A", -1),
        K::PlasmaRifle => idle!("PLAS", b"A", -1),
        K::Bfg9000 => idle!("BFUG", b"A", -1),
        K::Cacodemon => stand!("HEAD", b"A", false),
        K::ZombieMan => stand!("POSS", b"AB", false),
        K::ShotgunGuy => stand!("SPOS", b"AB", false),
        K::ChaingunGuy => stand!("CPOS", b"AB", false),
        K::DoomImp => stand!("TROO", b"AB", false),
        K::Demon => stand!("SARG", b"AB", false),
        K::Revenant => stand!("SKEL", b"AB", false),
        K::LostSoul => stand!("SKUL", b"AB", true),
        K::ExplosiveBarrel => idle!("BAR1", b"AB", 6),
        K::Rocket => once!(Loop: act(bright("MISL", b'A', 4), Action::Smoke)),
        K::RocketSmokeTrail => {
            once!(Vanish: still("RSMK", b'A', 5), still("RSMK", b'B', 5), still("RSMK", b'C', 5),
            still("RSMK", b'D', 5), still("RSMK", b'E', 5))
        }
        K::PlasmaBall => idle!("PLSS", b"AB", 6, true),
        K::BfgBall => idle!("BFS1", b"AB", 4, true),
        K::BulletPuff => {
            once!(Vanish: bright("PUFF", b'A', 4), still("PUFF", b'B', 4), still("PUFF", b'C', 4),
            still("PUFF", b'D', 4))
        }
        K::Blood => {
            once!(Vanish: still("BLUD", b'C', 8), still("BLUD", b'B', 8), still("BLUD", b'A', 8))
        }
        K::TechLamp => idle!("TLMP", b"ABCD", 4, true),
        K::TechLamp2 => idle!("TLP2", b"ABCD", 4, true),
        K::ShortRedColumn => idle!("COL4", b"A", -1),
        K::ShortGreenColumn => idle!("COL2", b"A", -1),
        K::HeartColumn => idle!("COL5", b"AB", 14),
        K::TechPillar => idle!("ELEC", b"A", -1),
        K::TorchTree => idle!("TRE1", b"A", -1),
        K::Stalagtite => idle!("SMIT", b"A", -1),
        K::BigTree => idle!("TRE2", b"A", -1),
        K::Gibs | K::SmallBloodPool => idle!("POL5", b"A", -1),
        K::GibbedMarine => idle!("PLAY", b"W", -1),
        K::BrainStem => idle!("BRS1", b"A", -1),
        K::DeadMarine => idle!("PLAY", b"N", -1),
        K::DeadZombieMan => idle!("POSS", b"L", -1),
        K::DeadShotgunGuy => idle!("SPOS", b"L", -1),
        K::Candlestick => idle!("CAND", b"A", -1, true),
        K::ShortBlueTorch => idle!("SMBT", b"ABCD", 4, true),
        K::ShortGreenTorch => idle!("SMGT", b"ABCD", 4, true),
        K::ShortRedTorch => idle!("SMRT", b"ABCD", 4, true),
        K::ColonGibs => idle!("POB1", b"A", -1),
        K::BurningTop => idle!("FTOP", b"ABC", 4, true),
        K::BurningDebris => idle!("FDEB", b"ABC", 4, true),
        K::PatrolPoint => Animation {
            frames: &[Frame {
                sprite: u8::MAX,
                frame: 0,
                bright: false,
                tics: -1,
                action: Action::None,
            }],
            then: Then::Loop,
        },
    }
}

/// The walk of a monster; others have none.
const fn walk_of(kind: ActorKind) -> Option<Animation> {
    Some(match kind {
        K::Cacodemon => walk!("HEAD", b"A", 3, false),
        K::ZombieMan => walk!("POSS", b"AABBCCDD", 4, false),
        K::ShotgunGuy => walk!("SPOS", b"AABBCCDD", 3, false),
        K::ChaingunGuy => walk!("CPOS", b"AABBCCDD", 3, false),
        K::DoomImp => walk!("TROO", b"AABBCCDD", 3, false),
        K::Demon => walk!("SARG", b"AABBCCDD", 2, false),
        K::Revenant => walk!("SKEL", b"AABBCCDDEEFF", 2, false),
        K::LostSoul => walk!("SKUL", b"AB", 6, true),
        _ => return None,
    })
}

/// How a monster feels a hit; others do not.
const fn pain_of(kind: ActorKind) -> Option<Animation> {
    Some(match kind {
        K::Cacodemon => {
            once!(Walk: still("HEAD", b'E', 3), still("HEAD", b'E', 3), still("HEAD", b'F', 6))
        }
        K::ZombieMan => once!(Walk: still("POSS", b'G', 3), still("POSS", b'G', 3)),
        K::ShotgunGuy => once!(Walk: still("SPOS", b'G', 3), still("SPOS", b'G', 3)),
        K::ChaingunGuy => once!(Walk: still("CPOS", b'G', 3), still("CPOS", b'G', 3)),
        K::DoomImp => once!(Walk: still("TROO", b'H', 2), still("TROO", b'H', 2)),
        K::Demon => once!(Walk: still("SARG", b'H', 2), still("SARG", b'H', 2)),
        K::Revenant => once!(Walk: still("SKEL", b'L', 5), still("SKEL", b'L', 5)),
        K::LostSoul => once!(Walk: bright("SKUL", b'E', 3), bright("SKUL", b'E', 3)),
        _ => return None,
    })
}

/// How a kind dies or bursts.
const fn death_of(kind: ActorKind) -> Option<Animation> {
    use Action::{Explode, StopBlocking};
    Some(match kind {
        K::Player => {
            once!(Loop: still("PLAY", b'H', 10), still("PLAY", b'I', 10), still("PLAY", b'J', 10),
            still("PLAY", b'K', 10), still("PLAY", b'L', 10), still("PLAY", b'M', 10), still("PLAY", b'N', -1))
        }
        K::Cacodemon => {
            once!(Loop: still("HEAD", b'G', 8), still("HEAD", b'H', 8), still("HEAD", b'I', 8),
            still("HEAD", b'J', 8), act(still("HEAD", b'K', 8), StopBlocking), still("HEAD", b'L', -1))
        }
        K::ZombieMan => once!(Loop: still("POSS", b'H', 5), still("POSS", b'I', 5),
            act(still("POSS", b'J', 5), StopBlocking), still("POSS", b'K', 5), still("POSS", b'L', -1)),
        K::ShotgunGuy => once!(Loop: still("SPOS", b'H', 5), still("SPOS", b'I', 5),
            act(still("SPOS", b'J', 5), StopBlocking), still("SPOS", b'K', 5), still("SPOS", b'L', -1)),
        K::ChaingunGuy => once!(Loop: still("CPOS", b'H', 5), still("CPOS", b'I', 5),
            act(still("CPOS", b'J', 5), StopBlocking), still("CPOS", b'K', 5), still("CPOS", b'L', 5),
            still("CPOS", b'M', 5), still("CPOS", b'N', -1)),
        K::DoomImp => {
            once!(Loop: still("TROO", b'I', 8), still("TROO", b'J', 8), still("TROO", b'K', 6),
            act(still("TROO", b'L', 6), StopBlocking), still("TROO", b'M', -1))
        }
        K::Demon => {
            once!(Loop: still("SARG", b'I', 8), still("SARG", b'J', 8), still("SARG", b'K', 4),
            act(still("SARG", b'L', 4), StopBlocking), still("SARG", b'M', 4), still("SARG", b'N', -1))
        }
        K::Revenant => {
            once!(Loop: still("SKEL", b'L', 7), still("SKEL", b'M', 7), still("SKEL", b'N', 7),
            act(still("SKEL", b'O', 7), StopBlocking), still("SKEL", b'P', 7), still("SKEL", b'Q', -1))
        }
        K::LostSoul => {
            once!(Vanish: bright("SKUL", b'F', 6), bright("SKUL", b'G', 6), bright("SKUL", b'H', 6),
            act(bright("SKUL", b'I', 6), StopBlocking), still("SKUL", b'J', 6), still("SKUL", b'K', 6))
        }
        K::ExplosiveBarrel => {
            once!(Vanish: bright("BEXP", b'A', 5), bright("BEXP", b'B', 5), bright("BEXP", b'C', 5),
            act(bright("BEXP", b'D', 5), Explode), bright("BEXP", b'E', 10))
        }
        K::Rocket => once!(Vanish: act(bright("MISL", b'B', 8), Explode), bright("MISL", b'C', 6),
            bright("MISL", b'D', 4)),
        K::PlasmaBall => {
            once!(Vanish: bright("PLSE", b'A', 4), bright("PLSE", b'B', 4), bright("PLSE", b'C', 4),
            bright("PLSE", b'D', 4), bright("PLSE", b'E', 4))
        }
        K::BfgBall => {
            once!(Vanish: bright("BFE1", b'A', 8), bright("BFE1", b'B', 8), bright("BFE1", b'C', 8),
            bright("BFE1", b'D', 8), bright("BFE1", b'E', 8), bright("BFE1", b'F', 8))
        }
        _ => return None,
    })
}

/// Every animation of a kind.
pub(in crate::world) struct Animations {
    pub(in crate::world) by_phase: [Animation; 4],
    /// The idle animation loops without acting, so that its frame follows from the tics alone.
    pub(in crate::world) idle_is_timed: bool,
    /// Tics of one turn of the idle animation, 0 for a still picture.
    pub(in crate::world) idle_period: u32,
}

pub(in crate::world) static ANIMATIONS: [Animations; ActorKind::COUNT] = {
    let mut table = [const { animations_of(K::Player) }; ActorKind::COUNT];
    let mut i = 0;
    while i < KINDS.len() {
        table[i] = animations_of(KINDS[i]);
        i += 1;
    }
    table
};

/// Kinds by number, for the constant table above.
const KINDS: [ActorKind; ActorKind::COUNT] = kinds();

const fn animations_of(kind: ActorKind) -> Animations {
    let idle = idle_of(kind);
    let mut by_phase = [idle; 4];
    if let Some(walk) = walk_of(kind) {
        by_phase[Phase::Walk as usize] = walk;
    }
    if let Some(pain) = pain_of(kind) {
        by_phase[Phase::Pain as usize] = pain;
    }
    if let Some(death) = death_of(kind) {
        by_phase[Phase::Death as usize] = death;
    }
    let mut timed = matches!(idle.then, Then::Loop);
    let mut period = 0;
    let mut i = 0;
    while i < idle.frames.len() {
        timed &= matches!(idle.frames[i].action, Action::None);
        if idle.frames[i].tics > 0 {
            period += idle.frames[i].tics as u32;
        }
        i += 1;
    }
    Animations { by_phase, idle_is_timed: timed, idle_period: period }
}

/// The animation of a kind in a phase; a phase that the kind lacks is its idle one.
#[must_use]
pub fn animation(kind: ActorKind, phase: Phase) -> &'static Animation {
    &ANIMATIONS[kind as usize].by_phase[phase as usize]
}

/// Whether an actor's frame follows from the tics alone, so that nothing has to be done for it.
#[must_use]
pub fn is_timed(kind: ActorKind, phase: Phase) -> bool {
    phase == Phase::Idle && ANIMATIONS[kind as usize].idle_is_timed
}

#[cfg(test)]
mod tests;
