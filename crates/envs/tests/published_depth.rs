//! Frames with ViZDoom's depth are today what they were before: fingerprints of 200 steps.
//!
//! The goldens draw colours alone. Here the frames have soot with holes on walls (Collateral
//! Damage), midtextures (Remedy Rush) and sky, in whole frames and in a reduced one.

use hasard_engine::assets::{Assets, Stain};
use hasard_engine::math::Rng;
use hasard_engine::render::Buffers;
use hasard_envs::{Env, EnvOptions, FrameSize};
use std::sync::Arc;

/// Recorded at commit 307e52c.
const RECORDED: [(&str, [u16; 2], u64); 4] = [
    ("CollateralDamageLevel3-v0", [160, 120], 0xEA00_833D_6097_9021),
    ("RemedyRushLevel2-v0", [160, 120], 0x92DB_BB78_1BD0_3A68),
    ("VolcanicVentureLevel1-v0", [200, 150], 0x943E_DA1F_D9B4_77E3),
    ("CollateralDamageLevel3-v0", [128, 72], 0xB4A7_CA86_2BC3_804F),
];

/// A third of its texels are holes: a column has several runs.
fn soot() -> Stain {
    let mut rng = Rng::new(3);
    let mut texel = || if rng.below(3) == 0 { 0 } else { rng.byte() as u8 };
    let texels = (0..32 * 32).map(|_| texel()).collect();
    Stain { width: 32, height: 32, offset_x: 16, offset_y: 16, texels }
}

fn fingerprint(id: &str, [width, height]: [u16; 2], assets: &Arc<Assets>) -> u64 {
    let options = EnvOptions {
        size: FrameSize { width, height },
        assets: Some(Arc::clone(assets)),
        published_depth: true,
        ..EnvOptions::default()
    };
    let mut env = Env::new(id, &options).unwrap();
    let mut rng = Rng::new(7);
    let sizes = env.action_space().sizes();
    let deltas = vec![0.0; env.action_space().deltas.len()];
    let mut actions = vec![0; sizes.len()];
    let (mut episode, mut hash) = (0, 0xCBF2_9CE4_8422_2325u64);
    env.reset(episode);
    for step in 0..200 {
        for (action, &size) in actions.iter_mut().zip(&sizes) {
            if rng.below(4) == 0 {
                *action = rng.below(size as u32) as u8;
            }
        }
        let ended = env.step(&actions, &deltas).unwrap().ended();
        let (depth, labels) = (step % 7 != 6, step % 2 == 0);
        let frame = env.render(Buffers { depth, labels });
        let mut put = |byte: u8| hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3);
        frame.indices().iter().for_each(|&byte| put(byte));
        if depth {
            frame.depth().iter().for_each(|&byte| put(byte));
        }
        if labels {
            frame.classes().iter().flat_map(|class| class.to_le_bytes()).for_each(put);
        }
        if ended {
            episode += 1;
            env.reset(episode);
        }
    }
    hash
}

#[test]
fn frames_with_published_depth_are_as_recorded() {
    let assets = Arc::new(Assets { soot: Some(soot()), ..(*Assets::embedded()).clone() });
    for (id, size, recorded) in RECORDED {
        assert_eq!(fingerprint(id, size, &assets), recorded, "{id} {size:?}");
    }
}
