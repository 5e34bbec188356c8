//! Things that matter are different in the learner's 128x72 pixels.

use hasard_engine::math::{Angle, Fixed};
use hasard_engine::render::{Buffers, SegmentationColours};
use hasard_engine::world::ActorKind::{self, *};
use hasard_envs::{Env, EnvOptions, FrameSize};

/// Where one looks from in which environment, what may lie there, and the direction in quarter
/// turns from east.
struct Scene {
    env: &'static str,
    from: (i32, i32),
    quarter: usize,
    kinds: &'static [ActorKind],
}

const SCENES: [Scene; 4] = [
    Scene {
        env: "ArmamentBurdenLevel1-v0",
        from: (40, 736),
        quarter: 0,
        kinds: &[
            Pistol,
            Shotgun,
            SuperShotgun,
            Chaingun,
            RocketLauncher,
            PlasmaRifle,
            Bfg9000,
            BlurSphere,
            Allmap,
            Backpack,
            RadSuit,
        ],
    },
    Scene {
        env: "RemedyRushLevel1-v0",
        from: (0, 900),
        quarter: 0,
        kinds: &[
            HealthBonus,
            Stimpack,
            Medikit,
            ArmorBonus,
            RocketAmmo,
            Shell,
            Cell,
            Infrared,
            YellowCard,
            BlueSkull,
        ],
    },
    Scene {
        env: "CollateralDamageLevel1-v0",
        from: (-256, 100),
        quarter: 0,
        kinds: &[Cacodemon, ZombieMan],
    },
    Scene {
        env: "DetonatorsDilemmaLevel1-v0",
        from: (1600, -900),
        quarter: 2,
        kinds: &[
            ExplosiveBarrel,
            LostSoul,
            ZombieMan,
            ShotgunGuy,
            ChaingunGuy,
            DoomImp,
            Demon,
            Revenant,
        ],
    },
];

/// A frame with a thing alone ahead, the same frame without it, and which pixels are the thing's.
struct Look {
    frame: Vec<u8>,
    before: Vec<u8>,
    covered: Vec<bool>,
}

fn look(env: &mut Env, scene: &Scene, kind: ActorKind, distance: i32) -> Look {
    env.reset(3);
    let world = env.world_mut();
    let body = world.players[0].actor;
    (world.players[0].damage_count, world.players[0].bonus_count) = (0, 0);
    let others: Vec<_> = world.living().map(|(id, _)| id).filter(|&id| id != body).collect();
    others.into_iter().for_each(|id| world.remove(id));
    let (x, y) = (Fixed::from_int(scene.from.0), Fixed::from_int(scene.from.1));
    let sector = world.map.sector_at(x, y);
    let floor = world.sector(sector).floor;
    let angle = Angle::from_degrees(90.0 * scene.quarter as f64);
    let player = world.get_mut(body).unwrap();
    (player.x, player.y, player.z, player.sector, player.angle) = (x, y, floor, sector, angle);
    world.players[0].view_z = floor + Fixed::from_int(41);
    let mut before = vec![0; 128 * 72 * 3];
    env.render(Buffers::default()).write_rgb_hwc(&mut before);
    let (dx, dy) = [(distance, 0), (0, distance), (-distance, 0), (0, -distance)][scene.quarter];
    let world = env.world_mut();
    let id = world.spawn(kind, x + Fixed::from_int(dx), y + Fixed::from_int(dy), Fixed::ZERO);
    let thing = world.get_mut(id).unwrap();
    (thing.z, thing.angle) = (thing.floor_z, angle + Angle::DEG_180);
    let (mut rgb, mut classes) = (before.clone(), before.clone());
    let renderer = env.render(Buffers { labels: true, ..Buffers::default() });
    renderer.write_rgb_hwc(&mut rgb);
    let colours = SegmentationColours::distinct();
    renderer.write_segmented_hwc(&colours, &mut classes);
    let covered = classes.chunks_exact(3).map(|class| class == colours.actor(kind)).collect();
    Look { frame: rgb, before, covered }
}

/// Of the pixels that either thing covers: how many there are, and the share of them whose colours
/// in the two frames nobody takes for each other.
fn difference([a, b]: [&[u8]; 2], covered: [&[bool]; 2]) -> (usize, f64) {
    let pixels = a.chunks_exact(3).zip(b.chunks_exact(3)).zip(covered[0].iter().zip(covered[1]));
    let inside: Vec<bool> = pixels
        .filter(|(_, (a, b))| **a || **b)
        .map(|((a, b), _)| {
            let squares: i32 =
                a.iter().zip(b).map(|(&a, &b)| (i32::from(a) - i32::from(b)).pow(2)).sum();
            squares > 40 * 40
        })
        .collect();
    let unlike = inside.iter().filter(|&&unlike| unlike).count();
    (inside.len(), unlike as f64 / inside.len().max(1) as f64)
}

/// Least share of a thing's pixels that differ from what is behind it.
const SEEN: f64 = 0.55;
/// Least share of the pixels of two things in one place that differ between them.
const APART: f64 = 0.6;

#[test]
fn classes_of_a_scenario_are_distinguishable_at_128x72() {
    let mut alike = Vec::new();
    for scene in &SCENES {
        let options = EnvOptions { size: FrameSize::LEARNER, ..EnvOptions::default() };
        let mut env = Env::new(scene.env, &options).unwrap();
        for distance in [120, 250] {
            let looks: Vec<Look> =
                scene.kinds.iter().map(|&kind| look(&mut env, scene, kind, distance)).collect();
            for (i, a) in looks.iter().enumerate() {
                let kind = scene.kinds[i];
                let (pixels, seen) = difference([&a.frame, &a.before], [&a.covered, &a.covered]);
                if pixels < 4 || seen < SEEN {
                    alike.push(format!(
                        "{kind:?} at {distance}: {:.0} % of {pixels} pixels stand out",
                        seen * 100.0
                    ));
                }
                for (j, b) in looks[..i].iter().enumerate() {
                    let (_, apart) = difference([&a.frame, &b.frame], [&a.covered, &b.covered]);
                    if apart < APART {
                        alike.push(format!(
                            "{kind:?} and {:?} at {distance}: {:.0} %",
                            scene.kinds[j],
                            apart * 100.0
                        ));
                    }
                }
            }
        }
    }
    assert!(alike.is_empty(), "hard to distinguish:\n{}", alike.join("\n"));
}
