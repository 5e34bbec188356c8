//! Two-legged fiends: the imp, the bull-like demon, the revenant.

use super::humanoid::{Leg, Pose, falling, laid_over};
use crate::assets::embedded::model::{Material, Model};
use crate::assets::embedded::vector::{Frame, Vector, joint};

const BONE: Material = Material::new(0x4A4030, 0xA89C80, 0xF0E8D0).polished(0.3);
const CLAW: Material = Material::new(0x2A2420, 0x8C8068, 0xE8DCC0).fine();
const MAW: Material = Material::new(0x180404, 0x4C0C08, 0x841C14);
const EMBER: Material = Material::new(0xE04808, 0xFFA020, 0xFFF080).glowing().fine();

/// What a fiend is doing.
#[derive(Clone, Copy)]
pub(super) enum Deed {
    /// Walking, at a moment of its cycle.
    Walk(usize),
    /// Striking or throwing.
    Strike,
    /// Flinching from a hit.
    Hurt,
    /// Falling: the step and the number of steps.
    Die(usize, usize),
}

/// The pose of a deed, with the roll of the falling body.
fn pose_of(deed: Deed, hips: f32, stance: f32, stride: f32, moments: usize) -> (Pose, f32) {
    match deed {
        Deed::Walk(moment) => (Pose::walking(hips, stance, stride, moment, moments), 0.0),
        Deed::Strike => (Pose::standing(hips, stance + 1.0), 0.0),
        Deed::Hurt => (Pose::flinching(hips, stance), 0.0),
        Deed::Die(step, count) => falling(hips, stance, step, count),
    }
}

/// A hand of three claws at the end of an arm.
fn claws(model: &mut Model, hand: Vector, ahead: Vector, size: f32, material: Material) {
    let frame = Frame::facing(ahead, Vector::UP);
    for spread in [-1.0, 0.0, 1.0] {
        let tip = hand + frame.out(Vector(size, spread * size * 0.55, -0.3 * size));
        model.limb(
            hand + frame.out(Vector(0.0, spread * size * 0.3, 0.0)),
            tip,
            (size * 0.22, 0.25),
            material,
        );
    }
}

/// The imp: lean, brown, hunched, with spikes on shoulders and elbows, long arms and burning eyes.
pub(super) fn imp(deed: Deed) -> Model {
    let skin = Material::new(0x34180A, 0x945428, 0xD89860).mottled(0.45, 2.0);
    let dark_skin = Material::new(0x26120A, 0x663A20, 0x9C6840).mottled(0.4, 1.8);
    let (mut pose, roll) = pose_of(deed, 24.0, 5.2, 7.5, 4);
    pose.lean[0] += 14.0;
    let mut m = Model::new();
    let leg = Leg {
        spread: 3.8,
        bones: (12.5, 13.0),
        radii: [4.6, 3.0, 2.0],
        bend: Vector(1.0, 0.0, 0.0),
        thigh: skin,
        shin: dark_skin,
    };
    for knee in leg.build(&mut m, &pose) {
        m.limb(knee, knee + Vector(4.0, 0.0, 2.4), (1.3, 0.3), BONE);
    }
    for foot in pose.feet {
        m.egg(foot + Vector(2.0, 0.0, -0.6), Vector(4.2, 2.4, 1.7), dark_skin);
        claws(&mut m, foot + Vector(4.4, 0.0, -0.8), Vector::FORWARD, 3.0, CLAW);
    }
    let (frame, base) = pose.trunk();
    let at = |x: f32, y: f32, z: f32| base + frame.out(Vector(x, y, z));
    m.egg_in(frame, at(0.0, 0.0, 1.0), Vector(4.6, 5.6, 4.6), dark_skin);
    m.egg_in(frame, at(0.4, 0.0, 7.0), Vector(4.6, 5.4, 6.6), skin);
    m.egg_in(frame, at(0.6, 0.0, 14.6), Vector(6.0, 8.4, 6.6), skin);
    for side in [1.0, -1.0] {
        // Chest muscles and shoulder spikes.
        m.egg_in(frame, at(4.2, side * 3.2, 15.4), Vector(2.6, 3.4, 3.0), skin);
        m.ball(at(-0.4, side * 8.6, 18.6), 3.6, skin);
        m.limb(at(-0.8, side * 9.0, 20.4), at(-3.0, side * 13.0, 28.5), (1.9, 0.3), BONE);
        m.limb(at(-2.4, side * 6.0, 20.4), at(-6.0, side * 7.6, 26.5), (1.6, 0.3), BONE);
    }
    for i in 0..3 {
        m.limb(
            at(-5.2, 0.0, 7.0 + 5.0 * i as f32),
            at(-9.0, 0.0, 9.5 + 5.0 * i as f32),
            (1.5, 0.3),
            BONE,
        );
    }
    // Head: long jaw, swept horns.
    let head =
        Frame::turned(pose.lean[0] * 0.35 - 6.0 * pose.flinch, pose.lean[1], pose.lean[2] * 0.5);
    let neck = at(2.4, 0.0, 22.0);
    let face = |x: f32, y: f32, z: f32| neck + head.out(Vector(x, y, z));
    m.egg_in(head, face(0.6, 0.0, 2.8), Vector(4.8, 4.2, 4.8), skin);
    m.egg_in(head, face(3.0, 0.0, 0.6), Vector(3.6, 3.3, 2.8), skin);
    m.egg_in(head, face(5.2, 0.0, -0.6), Vector(1.6, 2.3, 1.2 + 0.9 * pose.flinch), MAW);
    for side in [1.0, -1.0] {
        m.ball(face(4.5, side * 2.0, 3.4), 1.0, EMBER);
        m.limb(face(-0.6, side * 3.0, 5.4), face(-3.2, side * 6.6, 11.5), (1.7, 0.3), BONE);
        m.limb(face(5.6, side * 1.2, 0.2), face(6.0, side * 1.2, -1.6), (0.5, 0.2), CLAW);
    }
    // Arms: hanging claws, or one raised with a ball of fire.
    let strike = matches!(deed, Deed::Strike);
    for (i, side) in [1.0, -1.0].into_iter().enumerate() {
        let shoulder = at(0.0, side * 8.6, 18.0);
        let swing = if i == 0 { -pose.swing } else { pose.swing };
        let hand = if strike && side < 0.0 {
            at(9.0, -8.0, 27.0)
        } else {
            at(6.0 + 5.0 * swing, side * (12.5 + 3.0 * pose.flinch), 1.5 + 9.0 * pose.flinch)
        };
        let elbow = joint(shoulder, hand, 10.0, 10.5, Vector(-0.7, side * 1.0, -0.2));
        m.jointed([shoulder, elbow, hand], [3.2, 2.4, 1.8], skin);
        m.limb(elbow, elbow + Vector(-4.0, side * 1.2, -1.0), (1.4, 0.3), BONE);
        claws(&mut m, hand, hand - elbow, 4.6, CLAW);
        if strike && side < 0.0 {
            m.ball(
                hand + Vector(2.5, 0.0, 3.5),
                4.4,
                Material::new(0xE04808, 0xFF9018, 0xFFF090).glowing(),
            );
        }
    }
    finish(m, deed, roll, at(4.0, 0.0, 13.0))
}

/// The demon: a pink bull of a beast, nearly all jaw.
pub(super) fn demon(deed: Deed) -> Model {
    let hide = Material::new(0x44161A, 0xB4625C, 0xF0A498).mottled(0.28, 2.6);
    let belly = Material::new(0x4C2420, 0xB87868, 0xECB8A4).mottled(0.2, 2.0);
    let (mut pose, roll) = pose_of(deed, 21.0, 9.5, 8.0, 4);
    pose.lean[0] += 8.0;
    let mut m = Model::new();
    let leg = Leg {
        spread: 7.5,
        bones: (11.5, 11.5),
        radii: [7.6, 5.2, 4.2],
        bend: Vector(1.0, 0.0, 0.0),
        thigh: hide,
        shin: hide,
    };
    leg.build(&mut m, &pose);
    for foot in pose.feet {
        m.egg(foot + Vector(2.6, 0.0, 0.6), Vector(6.4, 4.8, 3.2), hide);
        for toe in [-1.0, 0.0, 1.0] {
            m.limb(
                foot + Vector(7.0, toe * 3.0, 0.2),
                foot + Vector(9.6, toe * 3.4, -1.0),
                (1.6, 0.5),
                CLAW,
            );
        }
    }
    let (frame, base) = pose.trunk();
    let at = |x: f32, y: f32, z: f32| base + frame.out(Vector(x, y, z));
    m.egg_in(frame, at(-3.0, 0.0, 4.0), Vector(11.0, 12.0, 9.5), hide);
    m.egg_in(frame, at(-1.0, 0.0, 15.0), Vector(13.0, 16.0, 13.0), hide);
    m.egg_in(frame, at(4.0, 0.0, 7.0), Vector(9.0, 9.6, 8.0), belly);
    for side in [1.0, -1.0] {
        m.ball(at(1.0, side * 14.0, 18.0), 7.4, hide);
    }
    // Spine ridge.
    for i in 0..4 {
        let part = i as f32;
        m.limb(
            at(-11.0 + 3.0 * part, 0.0, 11.0 + 5.0 * part),
            at(-15.0 + 3.0 * part, 0.0, 15.0 + 5.0 * part),
            (2.4, 0.4),
            BONE,
        );
    }
    // Head: the jaw drops when it bites or is hurt.
    let gape = match deed {
        Deed::Walk(moment) => 3.4 + if moment % 2 == 0 { 0.0 } else { 0.9 },
        Deed::Strike => 7.0,
        Deed::Hurt | Deed::Die(..) => 5.6,
    };
    let face = |x: f32, y: f32, z: f32| at(8.0 + x, y, 17.0 + z);
    m.egg_in(frame, face(0.0, 0.0, 4.0), Vector(10.0, 10.6, 8.6), hide);
    m.egg_in(frame, face(4.5, 0.0, 4.6), Vector(7.6, 8.8, 4.6), hide);
    m.egg_in(frame, face(3.4, 0.0, -1.6 - gape * 0.8), Vector(8.0, 8.4, 3.4), hide);
    m.egg_in(frame, face(6.6, 0.0, 1.0 - gape * 0.4), Vector(5.6, 7.6, 1.8 + gape * 0.5), MAW);
    for i in 0..5 {
        let y = -5.6 + 2.8 * i as f32;
        let x = 11.6 - y * y * 0.09;
        let size = if i % 4 == 0 { 3.8 } else { 2.6 };
        m.limb(face(x, y, 2.4), face(x + 0.4, y, 2.4 - size), (1.05, 0.25), CLAW);
        m.limb(
            face(x - 0.6, y + 0.9, -0.8 - gape * 0.8),
            face(x, y + 0.9, -0.8 - gape * 0.8 + size * 0.8),
            (1.0, 0.25),
            CLAW,
        );
    }
    for side in [1.0, -1.0] {
        m.ball(
            face(8.2, side * 4.4, 7.2),
            1.5,
            Material::new(0xC08008, 0xFFD020, 0xFFFF90).glowing().fine(),
        );
        m.limb(face(6.6, side * 2.4, 8.6), face(8.2, side * 6.6, 9.6), (1.4, 1.4), hide);
        m.limb(face(0.0, side * 8.0, 8.6), face(3.0, side * 14.0, 13.0), (2.8, 2.0), BONE);
        m.limb(face(3.0, side * 14.0, 13.0), face(9.0, side * 14.5, 17.5), (2.0, 0.4), BONE);
        m.ball(face(11.6, side * 1.6, 4.6), 0.8, MAW.fine());
    }
    // Small arms.
    for (i, side) in [1.0, -1.0].into_iter().enumerate() {
        let swing = if i == 0 { -pose.swing } else { pose.swing };
        let shoulder = at(3.0, side * 15.5, 14.5);
        let hand = at(13.0 + 2.5 * swing, side * (14.5 + 4.0 * pose.flinch), 2.5);
        let elbow = joint(shoulder, hand, 9.0, 9.0, Vector(-0.6, side * 1.2, -0.5));
        m.jointed([shoulder, elbow, hand], [4.8, 3.6, 2.8], hide);
        claws(&mut m, hand, Vector(0.8, 0.0, -0.7), 5.0, CLAW);
    }
    finish(m, deed, roll, at(8.0, 0.0, 8.0))
}

/// The revenant: a tall skeleton in grey mail with a rocket tube on each shoulder.
pub(super) fn revenant(deed: Deed) -> Model {
    let mail = Material::new(0x1C2024, 0x606870, 0xB0B8C0).polished(0.7);
    let tube = Material::new(0x14100E, 0x4A3C34, 0x8C786C).polished(0.5);
    let sinew = Material::new(0x3C100C, 0x843028, 0xB85C4C).mottled(0.3, 1.4);
    let (pose, roll) = pose_of(deed, 30.0, 4.8, 8.5, 6);
    let mut m = Model::new();
    let leg = Leg {
        spread: 3.6,
        bones: (15.0, 15.0),
        radii: [2.2, 1.7, 1.3],
        bend: Vector(1.0, 0.0, 0.0),
        thigh: BONE,
        shin: BONE,
    };
    for knee in leg.build(&mut m, &pose) {
        m.ball(knee + Vector(0.6, 0.0, 0.0), 2.3, BONE);
    }
    for foot in pose.feet {
        m.egg(foot + Vector(2.4, 0.0, -0.8), Vector(4.2, 1.9, 1.3), BONE);
    }
    let (frame, base) = pose.trunk();
    let at = |x: f32, y: f32, z: f32| base + frame.out(Vector(x, y, z));
    m.egg_in(frame, at(0.0, 0.0, 0.0), Vector(3.4, 5.2, 2.8), BONE);
    m.limb(at(-0.6, 0.0, 1.0), at(-0.6, 0.0, 12.0), (1.9, 1.9), BONE);
    m.egg_in(frame, at(0.4, 0.0, 4.4), Vector(2.2, 3.0, 3.0), sinew);
    // Breastplate over ribs.
    m.egg_in(frame, at(0.4, 0.0, 16.0), Vector(5.4, 7.8, 7.2), mail);
    for i in 0..3 {
        let z = 8.6 + 1.9 * i as f32;
        m.limb(at(3.6, -5.2, z), at(4.8, 0.0, z - 0.8), (0.9, 0.9), BONE);
        m.limb(at(3.6, 5.2, z), at(4.8, 0.0, z - 0.8), (0.9, 0.9), BONE);
    }
    for side in [1.0, -1.0] {
        m.ball(at(0.0, side * 8.4, 20.0), 3.0, mail);
        // Launchers.
        let mount = at(-1.0, side * 8.6, 26.0);
        m.tube(
            mount + frame.out(Vector(-7.0, 0.0, -0.6)),
            mount + frame.out(Vector(8.0, 0.0, 1.0)),
            (3.4, 3.8),
            tube,
        );
        m.tube(
            mount + frame.out(Vector(7.4, 0.0, 0.9)),
            mount + frame.out(Vector(8.8, 0.0, 1.1)),
            (2.6, 2.6),
            MAW,
        );
        m.limb(at(0.0, side * 7.6, 20.0), mount, (1.5, 1.5), mail);
    }
    m.limb(at(0.2, 0.0, 22.0), at(1.2, 0.0, 26.0), (1.5, 1.4), BONE);
    let head =
        Frame::turned(pose.lean[0] * 0.5 - 8.0 * pose.flinch, pose.lean[1], -pose.lean[2] * 0.5);
    let neck = at(1.6, 0.0, 26.0);
    let gape = if pose.flinch > 0.0 || matches!(deed, Deed::Strike) { 1.6 } else { 0.4 };
    skull(&mut m, head, neck + head.out(Vector(0.6, 0.0, 4.4)), 4.7, gape);
    for (i, side) in [1.0, -1.0].into_iter().enumerate() {
        let swing = if i == 0 { -pose.swing } else { pose.swing };
        let shoulder = at(0.0, side * 9.2, 19.4);
        let hand = if matches!(deed, Deed::Strike) {
            at(13.0, side * 7.0, 22.0)
        } else {
            at(5.5 + 6.0 * swing, side * (11.5 + 4.0 * pose.flinch), 0.5 + 8.0 * pose.flinch)
        };
        let elbow = joint(shoulder, hand, 11.0, 11.0, Vector(-0.8, side * 0.8, -0.2));
        m.jointed([shoulder, elbow, hand], [1.9, 1.5, 1.2], BONE);
        m.ball(elbow, 2.0, BONE);
        claws(&mut m, hand, hand - elbow, 4.4, BONE.fine());
    }
    finish(m, deed, roll, at(3.0, 0.0, 12.0))
}

/// A skull of a size around a centre, jaw dropped by `gape`.
pub(super) fn skull(m: &mut Model, frame: Frame, centre: Vector, size: f32, gape: f32) {
    let at = |x: f32, y: f32, z: f32| centre + frame.out(Vector(x, y, z) * size);
    let egg = |x: f32, y: f32, z: f32| Vector(x, y, z) * size;
    let socket = Material::new(0x0C0404, 0x1C0808, 0x2C1010).fine();
    m.egg_in(frame, at(-0.1, 0.0, 0.2), egg(1.02, 0.86, 0.92), BONE);
    m.egg_in(frame, at(0.42, 0.0, -0.42), egg(0.56, 0.52, 0.5), BONE);
    m.egg_in(frame, at(0.46, 0.0, -0.98 - 0.22 * gape), egg(0.48, 0.46, 0.26), BONE);
    m.egg_in(frame, at(0.72, 0.0, -0.72 - 0.11 * gape), egg(0.3, 0.4, 0.08 + 0.12 * gape), socket);
    for side in [1.0, -1.0] {
        m.egg_in(frame, at(0.66, side * 0.36, 0.08), egg(0.34, 0.28, 0.27), socket);
        m.egg_in(frame, at(0.86, side * 0.36, 0.08), egg(0.16, 0.14, 0.14), EMBER);
    }
    m.egg_in(frame, at(0.92, 0.0, -0.3), egg(0.12, 0.12, 0.17), socket);
    for i in 0..4 {
        let y = -0.27 + 0.18 * i as f32;
        m.egg_in(frame, at(0.9, y, -0.66), egg(0.07, 0.07, 0.12), CLAW);
    }
}

/// Blood on the dying, and their fall.
fn finish(mut model: Model, deed: Deed, roll: f32, wound: Vector) -> Model {
    if let Deed::Die(step, _) = deed {
        let blood = Material::new(0x300404, 0x840C08, 0xC82018).mottled(0.4, 1.0);
        if step > 0 {
            model.egg(wound + Vector(1.0, 0.0, 0.0), Vector(3.0, 4.0, 4.4), blood);
            model.ball(wound + Vector(0.0, 4.5, 3.0), 2.4, blood);
        }
        return laid_over(&model, roll, 6.0);
    }
    model
}
