use super::*;
use crate::assets::{Assets, SPRITE_NAMES};

#[test]
fn blur_spheres_pulse_as_measured() {
    // Of a sphere called up beside a player who stands still: opaque at first, a quarter after
    // 24 tics, opaque again after 48.
    let opacities = [0, 1, 12, 23, 24, 25, 47, 48, 49]
        .map(|age| opacity(ActorKind::BlurSphere, Phase::Idle, age));
    assert_eq!(opacities, [64, 62, 40, 18, 16, 18, 62, 64, 62].map(|parts| OPAQUE / 64 * parts));
}

#[test]
fn every_frame_of_every_animation_is_painted() {
    let assets = Assets::embedded();
    for kind in ActorKind::all() {
        for phase in [Phase::Idle, Phase::Walk, Phase::Pain, Phase::Death] {
            for shown in
                animation(kind, phase).frames.iter().filter(|shown| shown.sprite != u8::MAX)
            {
                let painted = assets.sprites[usize::from(shown.sprite)].frames.len();
                let name = SPRITE_NAMES[usize::from(shown.sprite)];
                assert!(
                    usize::from(shown.frame) < painted,
                    "{kind:?} {phase:?}: {name} lacks frame {}",
                    shown.frame
                );
            }
        }
    }
}
