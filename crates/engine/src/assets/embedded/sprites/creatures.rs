//! The cast: which figures give which sprite frames.

use super::fiends::{Deed, demon, imp, revenant};
use super::floaters::{burst_cacodemon, cacodemon, dying_soul, lost_soul};
use super::soldiers::Soldier;
use crate::assets::SpriteFrame;
use crate::assets::embedded::camera::{Portrait, View, portrait};
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::model::Model;

/// Paints every creature and the player's figure.
pub(super) fn paint(gallery: &mut Gallery) {
    for (name, soldier, steps) in [
        ("POSS", Soldier::Rifleman, 5),
        ("SPOS", Soldier::Shotgunner, 5),
        ("CPOS", Soldier::Chaingunner, 7),
        ("PLAY", Soldier::Player, 7),
    ] {
        // A-D walk, E-F aim and fire, G pain, H on death.
        for moment in 0..4 {
            around(gallery, name, &soldier.walking(moment));
        }
        around(gallery, name, &soldier.aiming(false));
        around(gallery, name, &soldier.aiming(true));
        around(gallery, name, &soldier.hurt());
        for step in 0..steps {
            ahead(gallery, name, &soldier.dying(step, steps));
        }
    }
    // The player torn apart: frames O to W, of which maps only ever show the last.
    let remains = Soldier::remains();
    for _ in 0..8 {
        gallery.repeat_last("PLAY");
    }
    ahead(gallery, "PLAY", &remains);
    walker(gallery, "TROO", imp, [4, 3, 5]);
    walker(gallery, "SARG", demon, [4, 3, 6]);
    walker(gallery, "SKEL", revenant, [6, 5, 5]);
    floaters(gallery);
}

/// A fiend on legs: so many frames of its walk, of attack (then one of pain) and of death.
fn walker(
    gallery: &mut Gallery,
    name: &str,
    figure: fn(Deed) -> Model,
    [moments, strikes, steps]: [usize; 3],
) {
    for moment in 0..moments {
        around(gallery, name, &figure(Deed::Walk(moment)));
    }
    // One striking pose serves all attack frames: no scenario lets these fiends attack.
    let strike = seen_around(gallery, &figure(Deed::Strike));
    for _ in 0..strikes {
        gallery.frame(name, strike);
    }
    around(gallery, name, &figure(Deed::Hurt));
    for step in 0..steps {
        ahead(gallery, name, &figure(Deed::Die(step, steps)));
    }
}

fn floaters(gallery: &mut Gallery) {
    // A floats, B-D open the mouth, E-F wince, G on death.
    for gape in [0.0, 0.35, 0.7, 1.0] {
        around(gallery, "HEAD", &cacodemon(gape, 0.0));
    }
    around(gallery, "HEAD", &cacodemon(0.5, 0.5));
    around(gallery, "HEAD", &cacodemon(0.8, 1.0));
    for step in 0..6 {
        ahead(gallery, "HEAD", &burst_cacodemon(step, 6));
    }
    // A-B float, C-D charge, E pain, F on death.
    for (flicker, gape) in [(0, 0.5), (1, 0.5), (2, 1.8), (3, 1.8), (4, 1.2)] {
        around(gallery, "SKUL", &lost_soul(flicker, gape));
    }
    for step in 0..6 {
        ahead(gallery, "SKUL", &dying_soul(step, 6));
    }
}

fn hang(gallery: &mut Gallery, portrait: &Portrait) -> u32 {
    gallery.picture(&portrait.canvas, portrait.offset_x, portrait.offset_y)
}

/// Adds a frame seen from all sides.
fn around(gallery: &mut Gallery, name: &str, model: &Model) {
    let frame = seen_around(gallery, model);
    gallery.frame(name, frame);
}

/// The pictures of a model from five sides, the other three mirrored.
pub(super) fn seen_around(gallery: &mut Gallery, model: &Model) -> SpriteFrame {
    let images: [u32; 5] =
        std::array::from_fn(|side| hang(gallery, &portrait(model, View::side(side))));
    let mut frame = SpriteFrame::default();
    for rotation in 0..8 {
        let mirrored = rotation > 4;
        frame.images[rotation] = images[if mirrored { 8 - rotation } else { rotation }];
        frame.mirrored[rotation] = mirrored;
    }
    frame
}

/// Adds a frame that shows the front to every side.
fn ahead(gallery: &mut Gallery, name: &str, model: &Model) {
    ahead_from(gallery, name, model, View::side(0));
}

/// Adds a frame that shows one view to every side.
pub(super) fn ahead_from(gallery: &mut Gallery, name: &str, model: &Model, view: View) {
    let image = hang(gallery, &portrait(model, view));
    gallery.frame(name, SpriteFrame { images: [image; 8], mirrored: [false; 8] });
}
