//! Undead soldiers, each with his weapon: rifleman, shotgunner, chaingunner; and the player's own
//! figure.

use super::humanoid::{Leg, Pose, boots, falling, laid_over};
use crate::assets::embedded::model::{Material, Model};
use crate::assets::embedded::vector::{Frame, Vector, joint};

/// Hips of a soldier above the ground, half his stance, half his stride.
const HIPS: f32 = 25.0;
const STANCE: f32 = 4.6;
const STRIDE: f32 = 7.0;

/// Which of the soldiers.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Soldier {
    Rifleman,
    Shotgunner,
    Chaingunner,
    Player,
}

const DEAD_SKIN: Material = Material::new(0x3A3428, 0x8C8468, 0xD0C8A4).mottled(0.25, 1.6);
const PALE_SKIN: Material = Material::new(0x4A2C20, 0xA87858, 0xE8BC98).mottled(0.12, 1.6);
const GUN: Material = Material::new(0x101214, 0x383C40, 0x788088).polished(0.7);
const WOOD: Material = Material::new(0x28140A, 0x5C3418, 0x98602C);
const BLACK_LEATHER: Material = Material::new(0x0C0A0A, 0x282422, 0x58504A).polished(0.4);
const RED_EYE: Material = Material::new(0xA01008, 0xFF2010, 0xFF6840).glowing().fine();
const BLOOD: Material = Material::new(0x300404, 0x7C0C08, 0xC02018).mottled(0.4, 1.0);

/// What a soldier wears.
struct Outfit {
    skin: Material,
    jacket: Material,
    trousers: Material,
    vest: Material,
    boots: Material,
    /// Breadth of the trunk compared with the rifleman's.
    bulk: f32,
}

impl Soldier {
    fn outfit(self) -> Outfit {
        match self {
            Soldier::Rifleman => Outfit {
                skin: DEAD_SKIN,
                jacket: Material::new(0x443820, 0x98865C, 0xD4C498).mottled(0.35, 2.2),
                trousers: Material::new(0x3C3420, 0x7C7048, 0xB0A070).mottled(0.3, 2.4),
                vest: Material::new(0x2A2010, 0x5C4828, 0x8C7044),
                boots: BLACK_LEATHER,
                bulk: 1.0,
            },
            Soldier::Shotgunner => Outfit {
                skin: DEAD_SKIN,
                jacket: Material::new(0x1A1416, 0x4C4448, 0x847A7E).mottled(0.25, 2.0),
                trousers: Material::new(0x161418, 0x403C44, 0x747078).mottled(0.2, 2.2),
                vest: Material::new(0x4C0404, 0xC01C14, 0xFF5840).polished(0.4),
                boots: BLACK_LEATHER,
                bulk: 1.05,
            },
            Soldier::Chaingunner => Outfit {
                skin: Material::new(0x4A2A20, 0x9C6C54, 0xD8A88C).mottled(0.2, 2.0),
                jacket: Material::new(0x480A08, 0xB02018, 0xE85848).mottled(0.25, 2.4),
                trousers: Material::new(0x101C38, 0x2C4C84, 0x6090D0).mottled(0.2, 2.4),
                vest: Material::new(0x24282C, 0x5C6468, 0x9CA8AC).polished(0.5),
                boots: BLACK_LEATHER,
                bulk: 1.28,
            },
            Soldier::Player => Outfit {
                skin: PALE_SKIN,
                jacket: Material::new(0x0C240C, 0x2C5C28, 0x5C9850).mottled(0.15, 2.0),
                trousers: Material::new(0x12200E, 0x345030, 0x587C4C).mottled(0.15, 2.4),
                vest: Material::new(0x10300E, 0x347430, 0x74B864).polished(0.4),
                boots: Material::new(0x1A120A, 0x443422, 0x786048),
                bulk: 1.1,
            },
        }
    }

    /// Walking, at one of four moments.
    pub(super) fn walking(self, moment: usize) -> Model {
        self.figure(&Pose::walking(HIPS, STANCE, STRIDE, moment, 4), false)
    }

    /// Aiming straight ahead, with or without fire at the muzzle.
    pub(super) fn aiming(self, firing: bool) -> Model {
        let mut model = self.figure(&Pose::standing(HIPS, STANCE + 1.0), true);
        if firing {
            let flash = Material::new(0xFF9020, 0xFFD040, 0xFFFFD0).glowing();
            model.ball(Vector(28.0, -3.0, 37.5), 3.4, flash);
        }
        model
    }

    /// Flinching from a hit.
    pub(super) fn hurt(self) -> Model {
        self.figure(&Pose::flinching(HIPS, STANCE), false)
    }

    /// Falling, step by step, to lie dead.
    pub(super) fn dying(self, step: usize, count: usize) -> Model {
        let (pose, roll) = falling(HIPS, STANCE, step, count);
        let mut model = self.figure(&pose, false);
        if step > 0 {
            let wound = Vector(4.0, 0.0, 38.0);
            model.egg(wound, Vector(2.8, 3.5, 4.0), BLOOD);
            model.ball(wound + Vector(-1.0, 4.0, 4.0), 2.2, BLOOD);
        }
        laid_over(&model, roll, 6.0)
    }

    /// What an explosion leaves of the player.
    pub(super) fn remains() -> Model {
        let outfit = Soldier::Player.outfit();
        let mut m = Model::new();
        m.egg(Vector(0.0, 0.0, 0.8), Vector(12.0, 19.0, 1.2), BLOOD);
        m.egg(Vector(3.0, -9.0, 3.0), Vector(4.4, 4.6, 3.4), outfit.vest);
        m.limb(Vector(4.0, 3.0, 2.4), Vector(1.0, 12.0, 2.0), (2.6, 1.8), outfit.trousers);
        m.egg(Vector(2.0, 14.0, 2.2), Vector(2.4, 3.4, 2.0), outfit.boots);
        m.ball(Vector(6.0, -2.0, 2.4), 2.6, BLOOD);
        m.egg(Vector(-4.0, 2.0, 3.4), Vector(4.0, 5.0, 3.0), BLOOD);
        m
    }

    fn figure(self, pose: &Pose, aiming: bool) -> Model {
        let outfit = self.outfit();
        let mut model = Model::new();
        let leg = Leg {
            spread: 3.4 * outfit.bulk,
            bones: (12.0, 12.5),
            radii: [4.1 * outfit.bulk, 3.1, 2.4],
            bend: Vector(1.0, 0.0, 0.0),
            thigh: outfit.trousers,
            shin: outfit.trousers,
        };
        let knees = leg.build(&mut model, pose);
        boots(&mut model, pose, 2.6, outfit.boots);
        if self != Soldier::Rifleman {
            for knee in knees {
                model.ball(knee + Vector(1.6, 0.0, 0.0), 2.3, outfit.vest);
            }
        }
        let (frame, base) = pose.trunk();
        let at = |x: f32, y: f32, z: f32| base + frame.out(Vector(x, y, z));
        self.trunk(&mut model, &outfit, frame, base);
        self.head(
            &mut model,
            &outfit,
            Frame::turned(pose.lean[0] * 0.5 - 8.0 * pose.flinch, pose.lean[1], 0.0),
            at(1.2, 0.0, 23.4),
        );
        self.arms(&mut model, &outfit, pose, aiming);
        model
    }

    fn trunk(self, model: &mut Model, outfit: &Outfit, frame: Frame, base: Vector) {
        let bulk = outfit.bulk;
        let at = |x: f32, y: f32, z: f32| base + frame.out(Vector(x, y, z));
        model.egg_in(frame, at(0.0, 0.0, 1.0), Vector(4.4, 5.8 * bulk, 4.4), outfit.trousers);
        model.egg_in(frame, at(0.0, 0.0, 7.5), Vector(4.6 * bulk, 6.0 * bulk, 7.0), outfit.jacket);
        model.egg_in(frame, at(0.2, 0.0, 14.5), Vector(5.4 * bulk, 7.6 * bulk, 6.8), outfit.jacket);
        model.tube(at(0.0, 0.0, 2.2), at(0.0, 0.0, 4.6), (5.6 * bulk, 5.6 * bulk), BLACK_LEATHER);
        model.limb(at(0.0, 0.0, 19.0), at(0.6, 0.0, 23.0), (2.6, 2.4), outfit.skin);
        match self {
            Soldier::Rifleman => {
                // A torn shirt shows dead flesh; a strap crosses the chest.
                model.egg_in(frame, at(3.4, 2.0, 11.5), Vector(2.0, 2.6, 3.0), BLOOD);
                model.limb(at(3.6, -5.0, 5.0), at(4.2, 3.5, 20.0), (1.3, 1.3), outfit.vest);
                model.limb(at(-3.6, -5.0, 5.0), at(-4.2, 3.5, 20.0), (1.3, 1.3), outfit.vest);
                model.block_in(frame, at(4.4, 4.2, 3.6), Vector(1.2, 1.6, 2.0), outfit.vest);
            }
            Soldier::Shotgunner => {
                model.egg_in(frame, at(1.8, 0.0, 14.0), Vector(4.8, 6.4, 5.6), outfit.vest);
                for side in [1.0, -1.0] {
                    model.egg_in(
                        frame,
                        at(0.0, side * 8.8, 19.0),
                        Vector(3.8, 3.4, 3.2),
                        outfit.vest,
                    );
                }
                for shell in -2..3 {
                    let shell_red = Material::new(0x602008, 0xC05818, 0xF0A040);
                    model.tube(
                        at(5.4, shell as f32 * 1.9, 2.0),
                        at(5.4, shell as f32 * 1.9, 5.0),
                        (0.8, 0.8),
                        shell_red,
                    );
                }
            }
            Soldier::Chaingunner => {
                model.egg_in(frame, at(1.6, 0.0, 13.5), Vector(5.8, 7.2, 7.6), outfit.vest);
                model.block_in(frame, at(-7.0, 0.0, 13.0), Vector(3.0, 5.0, 6.0), outfit.vest);
                // Bandolier of brass.
                let brass = Material::new(0x5C4008, 0xC49420, 0xFFE070).polished(0.8).fine();
                for i in 0..7 {
                    let part = i as f32 / 6.0;
                    model.ball(
                        at(
                            6.2 + 1.4 * (1.0 - (2.0 * part - 1.0) * (2.0 * part - 1.0)),
                            -6.5 + 12.0 * part,
                            6.0 + 14.0 * part,
                        ),
                        1.35,
                        brass,
                    );
                }
            }
            Soldier::Player => {
                model.egg_in(frame, at(1.0, 0.0, 14.2), Vector(5.6, 7.2, 6.4), outfit.vest);
                model.block_in(
                    frame,
                    at(5.6, 0.0, 15.0),
                    Vector(1.0, 2.6, 2.2),
                    Material::new(0x303430, 0x606860, 0xA0A8A0),
                );
                for side in [1.0, -1.0] {
                    model.egg_in(
                        frame,
                        at(0.0, side * 8.8, 19.2),
                        Vector(3.6, 3.3, 3.0),
                        outfit.vest,
                    );
                }
                model.block_in(frame, at(-6.0, 0.0, 14.0), Vector(2.2, 4.6, 5.0), outfit.trousers);
            }
        }
    }

    fn head(self, model: &mut Model, outfit: &Outfit, frame: Frame, neck: Vector) {
        let at = |x: f32, y: f32, z: f32| neck + frame.out(Vector(x, y, z));
        model.egg_in(frame, at(0.0, 0.0, 3.0), Vector(4.6, 4.3, 5.2), outfit.skin);
        model.egg_in(frame, at(1.2, 0.0, 0.4), Vector(3.5, 3.3, 2.9), outfit.skin);
        let dark = Material::new(0x140808, 0x281410, 0x402018);
        match self {
            Soldier::Rifleman => {
                let hair = Material::new(0x1C1408, 0x443418, 0x6C5830).mottled(0.4, 1.2);
                model.egg_in(frame, at(-0.8, 0.0, 5.2), Vector(4.4, 4.3, 3.6), hair);
                eyes(model, frame, neck, RED_EYE);
                model.block_in(frame, at(4.1, 0.0, 0.2), Vector(0.5, 1.5, 0.7), dark.fine());
            }
            Soldier::Shotgunner => {
                // Bald, with a steel jaw strap and a headset.
                let strap = Material::new(0x24282C, 0x50585C, 0x98A0A4);
                model.egg_in(frame, at(-0.4, 0.0, 4.6), Vector(4.6, 4.4, 4.4), strap.polished(0.6));
                model.block_in(frame, at(4.1, 0.0, 0.0), Vector(0.6, 1.7, 0.8), dark.fine());
                eyes(model, frame, neck, RED_EYE);
            }
            Soldier::Chaingunner => {
                let hair = Material::new(0x100C0A, 0x2C2018, 0x503C28);
                model.egg_in(frame, at(-1.8, 0.0, 4.6), Vector(3.4, 3.6, 3.6), hair);
                let cyber = Material::new(0x202428, 0x606870, 0xB0B8C0).polished(0.8);
                model.egg_in(frame, at(1.6, 2.0, 3.8), Vector(2.8, 2.2, 2.0), cyber);
                eyes(model, frame, neck, RED_EYE);
                model.block_in(frame, at(4.0, 0.0, -0.4), Vector(0.6, 1.8, 0.9), dark.fine());
            }
            Soldier::Player => {
                let helmet = outfit.vest;
                model.egg_in(frame, at(-0.4, 0.0, 4.0), Vector(5.1, 4.7, 5.0), helmet);
                let visor = Material::new(0x1C2C3C, 0x4878A0, 0xB0E0FF).polished(1.0);
                model.egg_in(frame, at(2.4, 0.0, 3.2), Vector(2.7, 3.5, 1.9), visor);
            }
        }
    }

    fn arms(self, model: &mut Model, outfit: &Outfit, pose: &Pose, aiming: bool) {
        let (frame, base) = pose.trunk();
        let bulk = outfit.bulk;
        let at = |x: f32, y: f32, z: f32| base + frame.out(Vector(x, y, z));
        // The weapon slants across the chest on the march and points ahead when aimed.
        let (grip, heading) = if aiming {
            (Vector(7.0, -3.0, 37.0), Vector(1.0, 0.0, 0.02))
        } else if pose.flinch > 0.0 {
            (at(9.0, -7.0 * bulk, 9.0), Vector(0.55, 0.25, -0.8 * pose.flinch))
        } else {
            (at(7.5, -6.0 * bulk, 7.0 + pose.swing), Vector(0.62, 0.7, 0.34))
        };
        let held = Frame::facing(heading, Vector::UP);
        model.attach(&self.weapon(), held, grip);
        let fore = if pose.flinch > 0.5 {
            at(2.0, 15.0, 20.0)
        } else {
            grip + held.out(Vector(9.0, 0.5, -0.6))
        };
        for (side, hand) in [(1.0, fore), (-1.0, grip)] {
            let shoulder = at(0.0, side * 8.0 * bulk, 18.6);
            let elbow = joint(shoulder, hand, 9.5, 9.0, Vector(-0.6, side * 0.8, -0.9));
            let sleeve = if self == Soldier::Chaingunner { outfit.skin } else { outfit.jacket };
            model.jointed([shoulder, elbow, hand], [3.3 * bulk, 2.6 * bulk, 2.0], sleeve);
            model.ball(
                hand,
                2.2,
                if self == Soldier::Player { BLACK_LEATHER } else { outfit.skin },
            );
        }
    }

    /// The weapon: grip at the origin, barrel forward.
    fn weapon(self) -> Model {
        let mut m = Model::new();
        match self {
            Soldier::Rifleman | Soldier::Player => {
                m.block(Vector(2.0, 0.0, 1.4), Vector(6.5, 1.1, 1.5), GUN);
                m.tube(Vector(8.0, 0.0, 1.6), Vector(17.0, 0.0, 1.6), (0.9, 0.8), GUN);
                m.block(Vector(5.0, 0.0, -1.6), Vector(1.0, 0.8, 2.2), GUN);
                m.block(Vector(-6.0, 0.0, 0.2), Vector(3.0, 0.9, 1.7), WOOD);
            }
            Soldier::Shotgunner => {
                m.tube(Vector(0.0, 0.0, 1.8), Vector(17.0, 0.0, 1.8), (1.1, 1.1), GUN);
                m.tube(Vector(2.0, 0.0, 0.2), Vector(14.0, 0.0, 0.2), (0.9, 0.9), GUN);
                m.limb(Vector(7.0, 0.0, 0.0), Vector(11.5, 0.0, 0.0), (1.7, 1.7), WOOD);
                m.limb(Vector(0.0, 0.0, 0.6), Vector(-8.0, 0.0, -1.6), (1.5, 2.2), WOOD);
            }
            Soldier::Chaingunner => {
                m.tube(Vector(-5.0, 0.0, 0.6), Vector(5.0, 0.0, 0.6), (3.2, 3.2), GUN);
                for (y, z) in [(1.5, 2.0), (-1.5, 2.0), (0.0, -1.0), (0.0, 2.8)] {
                    m.tube(Vector(5.0, y, z), Vector(19.0, y, z), (0.9, 0.9), GUN.polished(1.0));
                }
                m.tube(Vector(14.0, 0.0, 0.9), Vector(15.6, 0.0, 0.9), (3.0, 3.0), GUN);
                m.block(
                    Vector(-1.0, 3.6, -1.6),
                    Vector(3.0, 2.0, 2.6),
                    Material::new(0x2C3018, 0x5C6434, 0x909A5C),
                );
            }
        }
        m
    }
}

fn eyes(model: &mut Model, frame: Frame, neck: Vector, material: Material) {
    for side in [1.0, -1.0] {
        model.ball(neck + frame.out(Vector(3.7, side * 1.7, 3.6)), 0.75, material);
    }
}
