//! The state of a moment that ViZDoom does not report: what explains its picture best.

use crate::dump::{Moment, Pictures};
use crate::pose::{Posed, Stage};
use hasard_engine::assets::sprite_index;
use hasard_engine::map::SectorId;
use hasard_engine::math::Fixed;
use hasard_engine::render::Buffers;
use hasard_engine::world::{Face, Phase, PlayerSprite, Weapon, World, animation, is_timed};

/// Tics within which every animated texture has shown each of its frames.
const CLOCK_TICS: u32 = 32;
/// Sectors of Remedy Rush that its scripts darken by turns, by tag.
const DARKENED_TAGS: std::ops::RangeInclusive<i32> = 101..=118;
/// What the scripts switch their light to.
const SCRIPTED_LIGHTS: [i16; 2] = [255, 0];
/// A power-up with more tics left than this does not blink.
const LASTING: u32 = 1000;
/// Where the weapon rests, 16.16 of the 320x200 screen.
const AT_REST: [Fixed; 2] = [Fixed::ZERO, Fixed((32 << 16) + 24_576)];

/// Finds everything, part by part, and reports it in a line.
pub fn find(
    stage: &mut Stage,
    posed: &mut Posed,
    theirs: &Pictures,
    scenario: &str,
    moment: &Moment,
) -> String {
    let view = stage.renderer.view().view_rows() * stage.size[0];
    let bar = |at: usize| at >= view;
    let world = |at: usize| at < view && theirs.labels[at] <= 1;
    let everywhere = |at: usize| at < view;

    let mut try_all = |posed: &mut Posed, variants: Vec<Change>, counts: &dyn Fn(usize) -> bool| {
        best(stage, &mut posed.world, theirs, variants, counts);
    };
    let bonus = (0..=16).map(|count| flash(count, 0, 0));
    let damage = (1..=100).map(|count| flash(0, count, 0));
    let suit = (0..=6).map(|count| flash(count, 0, LASTING));
    try_all(posed, bonus.chain(damage).chain(suit).collect(), &bar);
    let faces = [
        Face::Glance(1),
        Face::Glance(0),
        Face::Glance(2),
        Face::Ouch,
        Face::Grin,
        Face::Rage,
        Face::Dead,
    ];
    let show = |face| -> Change {
        Box::new(move |world: &mut World| world.players[0].face_state.shown = face)
    };
    try_all(posed, faces.into_iter().map(show).collect(), &bar);
    let spent = |rounds: i32| -> Change {
        Box::new(move |world: &mut World| {
            let player = &mut world.players[0];
            if let Some(kind) = player.weapon.map(Weapon::ammo_type) {
                player.just_spent[kind] = rounds;
            }
        })
    };
    try_all(posed, (0..=2).map(spent).collect(), &bar);
    if scenario == "remedy_rush" {
        let variants = darkness(&posed.world);
        try_all(posed, variants, &world);
    }
    let muzzle = |light| -> Change {
        Box::new(move |world: &mut World| world.players[0].extra_light = light)
    };
    try_all(posed, (0..=2).map(muzzle).collect(), &world);
    let clock = |tics: u32| -> Change {
        let tic = moment.tic + tics;
        Box::new(move |world: &mut World| world.tic = tic)
    };
    try_all(posed, (0..CLOCK_TICS).map(clock).collect(), &world);
    if scenario == "collateral_damage" {
        try_all(posed, launcher(), &everywhere);
    }
    let marks = posed.world.soot.len();
    for mark in 0..marks {
        try_all(posed, turned(&[mark]), &world);
    }
    // Where marks overlap, how one is turned shows only together with the others.
    for (one, other) in (0..marks).flat_map(|one| (0..one).map(move |other| (one, other))) {
        try_all(posed, turned(&[one, other]), &world);
    }
    let things = |at: usize| at < view && !matches!(theirs.labels[at], 0 | 1 | 255);
    // What shines through shows only together with what is behind it: another round, by the
    // pixels of all things.
    for again in [false, true] {
        for (label, id) in posed.actors.clone() {
            let slot = usize::from(id.slot);
            let dead = moment
                .labels
                .iter()
                .any(|thing| thing.value == label && thing.name.starts_with("Dead"));
            let variants = frames(&posed.world, slot, dead);
            try_all(posed, variants, &|at| {
                if again { things(at) } else { at < view && theirs.labels[at] == label }
            });
        }
        for mark in 0..marks {
            try_all(posed, turned(&[mark]), &everywhere);
        }
    }
    let player = &posed.world.players[0];
    format!(
        "flash {} {} {}, face {:?}, spent {:?}, muzzle {}, clock +{}",
        player.bonus_count,
        player.damage_count,
        player.rad_suit_tics,
        player.face_state.shown,
        player.just_spent,
        player.extra_light,
        posed.world.tic - moment.tic
    )
}

/// Something about a world that may have been otherwise.
type Change = Box<dyn Fn(&mut World)>;

fn flash(bonus: u8, damage: u8, suit: u32) -> Change {
    Box::new(move |world| {
        let player = &mut world.players[0];
        (player.bonus_count, player.damage_count, player.rad_suit_tics) = (bonus, damage, suit);
    })
}

/// Light as it is in the map, light and darkness as the scripts switch them, and each with goggles.
fn darkness(world: &World) -> Vec<Change> {
    let sectors =
        (0..).zip(&world.map.sectors).filter(|(_, sector)| DARKENED_TAGS.contains(&sector.tag));
    let lit: Vec<_> =
        sectors.map(|(id, _)| (SectorId(id), world.sector(SectorId(id)).light)).collect();
    let variant = |scripted: Option<i16>, goggles: bool| -> Change {
        let lit = lit.clone();
        Box::new(move |world: &mut World| {
            for &(id, light) in &lit {
                world.sector_mut(id).light = scripted.unwrap_or(light);
            }
            world.players[0].infrared_tics = if goggles { LASTING } else { 0 };
        })
    };
    let lights = [None, Some(SCRIPTED_LIGHTS[0]), Some(SCRIPTED_LIGHTS[1])];
    lights
        .into_iter()
        .flat_map(|light| [false, true].map(|goggles| variant(light, goggles)))
        .collect()
}

/// Marks of soot, each every way round.
fn turned(marks: &[usize]) -> Vec<Change> {
    let ways = 1 << (2 * marks.len());
    let turn = |way: usize| -> Change {
        let marks = marks.to_vec();
        Box::new(move |world: &mut World| {
            for (place, &mark) in marks.iter().enumerate() {
                let way = way >> (2 * place);
                (world.soot[mark].mirrored, world.soot[mark].upturned) =
                    (way & 1 != 0, way & 2 != 0);
            }
        })
    };
    (0..ways).map(turn).collect()
}

/// The rocket launcher at rest and every frame of its shot.
fn launcher() -> Vec<Change> {
    let layer = |name: &str, frame: u8, bright: bool| {
        let [x, y] = AT_REST;
        sprite_index(name).map(|sprite| PlayerSprite { sprite, frame, bright, x, y })
    };
    let mut variants: Vec<Change> = Vec::new();
    for frame in 0..2 {
        for flash in 0..5 {
            let flash = if flash == 0 { None } else { layer("MISF", flash - 1, true) };
            let weapon = layer("MISG", frame, false);
            variants.push(Box::new(move |world| world.players[0].sprites = [weapon, flash]));
        }
    }
    variants
}

/// Every frame of an actor's animations; the published name distinguishes the dying from others,
/// but of missiles.
fn frames(world: &World, slot: usize, dead: bool) -> Vec<Change> {
    let set = |phase: Phase, step: u8, spawn_tic: u32| -> Change {
        Box::new(move |world: &mut World| {
            let actor = &mut world.actors[slot];
            (actor.phase, actor.step, actor.spawn_tic) = (phase, step, spawn_tic);
        })
    };
    let kind = world.actors[slot].kind;
    let steps =
        |phase| (0..animation(kind, phase).frames.len() as u8).map(move |step| (phase, step));
    if dead {
        return steps(Phase::Death).map(|(phase, step)| set(phase, step, 0)).collect();
    }
    if is_timed(kind, Phase::Idle) {
        return (0..48).map(|tics| set(Phase::Idle, 0, world.tic.wrapping_sub(tics))).collect();
    }
    let phases = [Phase::Idle, Phase::Walk, Phase::Pain, Phase::Death];
    phases.into_iter().flat_map(steps).map(|(phase, step)| set(phase, step, 0)).collect()
}

/// Leaves the world with that change, the first of equals, by which most of the pixels that count
/// are equal.
fn best(
    stage: &mut Stage,
    world: &mut World,
    theirs: &Pictures,
    variants: Vec<Change>,
    counts: &dyn Fn(usize) -> bool,
) {
    let mut most = None;
    for (index, change) in variants.iter().enumerate() {
        change(world);
        stage.renderer.render(&mut stage.scratch, world, 0, Buffers::default());
        stage.renderer.write_rgb_hwc(&mut stage.rgb);
        let pixels = theirs.rgb.chunks_exact(3).zip(stage.rgb.chunks_exact(3)).enumerate();
        let equal = pixels.filter(|&(at, (a, b))| a == b && counts(at)).count();
        if most.is_none_or(|(count, _)| equal > count) {
            most = Some((equal, index));
        }
    }
    if let Some((_, index)) = most {
        variants[index](world);
    }
}
