//! The common build of two-legged figures: a pose, the limbs that follow from it, and how such a
//! figure walks, flinches and falls.

use crate::assets::embedded::model::{Material, Model};
use crate::assets::embedded::vector::{Frame, Vector, joint};

/// How a figure holds itself. Lengths in texels.
#[derive(Clone, Copy)]
pub(super) struct Pose {
    /// Ankles, left and right.
    pub(super) feet: [Vector; 2],
    /// Middle of the hips.
    pub(super) hips: Vector,
    /// Forward lean, sideways lean and turn of the trunk, degrees.
    pub(super) lean: [f32; 3],
    /// How far the arms have swung, -1..1, left forward positive.
    pub(super) swing: f32,
    /// How much the figure is thrown open by a blow, 0..1.
    pub(super) flinch: f32,
}

impl Pose {
    /// Standing, with the hips at a height.
    pub(super) fn standing(hip_height: f32, stance: f32) -> Pose {
        Pose {
            feet: [Vector(0.0, stance, 2.0), Vector(0.0, -stance, 2.0)],
            hips: Vector(0.0, 0.0, hip_height),
            lean: [4.0, 0.0, 0.0],
            swing: 0.0,
            flinch: 0.0,
        }
    }

    /// One of the `count` moments of a walk: the feet go around, half a cycle apart.
    pub(super) fn walking(
        hip_height: f32,
        stance: f32,
        stride: f32,
        moment: usize,
        count: usize,
    ) -> Pose {
        let mut pose = Pose::standing(hip_height, stance);
        // Where a foot is along the cycle: planted and carried back in the first half, lifted and
        // swung forward in the second.
        let foot = |phase: f32| {
            let phase = phase - phase.floor();
            if phase < 0.5 {
                (stride * (1.0 - 4.0 * phase), 0.0)
            } else {
                let up = (phase - 0.5) * 2.0;
                (stride * (-1.0 + 2.0 * up), 4.0 * up * (1.0 - up) * stride * 0.62)
            }
        };
        let phase = moment as f32 / count as f32;
        let (left, right) = (foot(phase), foot(phase + 0.5));
        pose.feet[0] = Vector(left.0, stance, 2.0 + left.1);
        pose.feet[1] = Vector(right.0, -stance, 2.0 + right.1);
        let apart = (left.0 - right.0).abs() / (2.0 * stride);
        pose.hips.2 -= 1.6 * apart;
        pose.swing = (left.0 - right.0) / (2.0 * stride);
        pose.lean = [6.0, 2.0 * (right.1 - left.1) / stride, 5.0 * pose.swing];
        pose
    }

    /// Hit: thrown back.
    pub(super) fn flinching(hip_height: f32, stance: f32) -> Pose {
        let mut pose = Pose::standing(hip_height - 2.0, stance + 1.5);
        pose.lean = [-16.0, 8.0, 12.0];
        pose.feet[0].0 = 3.0;
        pose.feet[1].0 = -3.0;
        pose.flinch = 1.0;
        pose
    }

    /// The frame and the base of the trunk.
    pub(super) fn trunk(&self) -> (Frame, Vector) {
        (Frame::turned(self.lean[0], self.lean[1], self.lean[2]), self.hips)
    }
}

/// A leg: thigh and shin to the foot, with a boot.
pub(super) struct Leg {
    /// Half the distance between the hip joints.
    pub(super) spread: f32,
    /// Lengths of thigh and shin.
    pub(super) bones: (f32, f32),
    /// Radii at hip, knee and ankle.
    pub(super) radii: [f32; 3],
    /// Which way the knee points.
    pub(super) bend: Vector,
    pub(super) thigh: Material,
    pub(super) shin: Material,
}

impl Leg {
    /// Adds both legs and returns the knees.
    pub(super) fn build(&self, model: &mut Model, pose: &Pose) -> [Vector; 2] {
        [0, 1].map(|i| {
            let side = if i == 0 { 1.0 } else { -1.0 };
            let hip = pose.hips + Vector(0.0, side * self.spread, -1.0);
            let ankle = pose.feet[i];
            let knee = joint(
                hip,
                ankle,
                self.bones.0,
                self.bones.1,
                self.bend + Vector(0.0, side * 0.25, 0.0),
            );
            model.limb(hip, knee, (self.radii[0], self.radii[1]), self.thigh);
            model.limb(knee, ankle, (self.radii[1], self.radii[2]), self.shin);
            knee
        })
    }
}

/// Adds a boot at each ankle.
pub(super) fn boots(model: &mut Model, pose: &Pose, size: f32, material: Material) {
    for (foot, side) in pose.feet.into_iter().zip([1.0, -1.0]) {
        let frame = Frame::turned(0.0, 0.0, side * 12.0);
        model.egg_in(
            frame,
            foot + Vector(size * 0.6, side * 0.3, -0.4),
            Vector(size * 1.5, size * 0.85, size * 0.75),
            material,
        );
        model.limb(
            foot + Vector(0.0, 0.0, 0.5),
            foot + Vector(0.0, 0.0, 4.0),
            (size * 0.85, size * 0.95),
            material,
        );
    }
}

/// How a figure falls to the ground in `count` steps and lies on its side in the last: the pose of
/// a step and the roll of the whole figure around its feet, degrees.
pub(super) fn falling(hip_height: f32, stance: f32, step: usize, count: usize) -> (Pose, f32) {
    let part = step as f32 / (count - 1) as f32;
    let mut pose = Pose::flinching(hip_height * (1.0 - 0.12 * part), stance);
    pose.lean = [-16.0 + 30.0 * part, 10.0, 14.0 * (1.0 - part)];
    pose.flinch = 1.0 - 0.6 * part;
    // The fall gains speed.
    (pose, 84.0 * part * part.sqrt())
}

/// Lays a figure over by `roll` degrees to its left, keeping its lower side of half thickness
/// `thickness` on the ground.
pub(super) fn laid_over(model: &Model, roll: f32, thickness: f32) -> Model {
    let part = roll / 84.0;
    model.moved(Frame::turned(0.0, -roll, 0.0), Vector(0.0, 26.0 * part, thickness * part))
}
