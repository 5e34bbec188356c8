//! Where finished pictures are collected: the set of pictures under construction, with its
//! quantiser.

use super::canvas::Canvas;
use super::palette::Quantiser;
use super::surface::Surface;
use crate::assets::{Assets, SPRITE_NAMES, Sprite, SpriteFrame, TextureEntry};
use crate::map::TextureName;

/// A set of pictures under construction.
pub(super) struct Gallery {
    pub(super) assets: Assets,
    quantiser: Quantiser,
}

impl Gallery {
    /// A gallery for `assets` that already have their palette.
    pub(super) fn new(assets: Assets) -> Gallery {
        let quantiser = Quantiser::new(&assets.palette);
        Gallery { assets, quantiser }
    }

    /// Adds a picture and returns its index.
    pub(super) fn picture(&mut self, canvas: &Canvas, offset_x: i32, offset_y: i32) -> u32 {
        self.assets.images.push(canvas.image(&self.quantiser, offset_x, offset_y));
        self.assets.images.len() as u32 - 1
    }

    /// Adds a still texture under a name.
    pub(super) fn texture(&mut self, name: &str, canvas: &Canvas) {
        let first = self.picture(canvas, 0, 0);
        self.alias(name, TextureEntry { first, frames: 1, tics: 1 });
    }

    /// Adds a finished surface as a still texture.
    pub(super) fn surface(&mut self, name: &str, surface: &Surface) {
        self.texture(name, &surface.canvas());
    }

    /// Adds an animation whose frame `i` is called `names[i]`; a map may name any of them and gets
    /// the cycle from there.
    pub(super) fn animation(&mut self, names: &[&str], frames: &[Canvas], tics: u8) {
        let first = self.assets.images.len() as u32;
        for canvas in frames {
            self.picture(canvas, 0, 0);
        }
        // The cycle's frames must follow one another, so the later names need the beginning again
        // behind the end.
        for canvas in &frames[..frames.len() - 1] {
            self.picture(canvas, 0, 0);
        }
        for (i, name) in names.iter().enumerate() {
            self.alias(
                name,
                TextureEntry { first: first + i as u32, frames: frames.len() as u8, tics },
            );
        }
    }

    /// Gives a texture entry a (further) name.
    pub(super) fn alias(&mut self, name: &str, entry: TextureEntry) {
        let before = self.assets.textures.insert(TextureName::new(name), entry);
        debug_assert!(before.is_none(), "texture {name} is painted twice");
    }

    /// Lets a painted texture also stand in for names that nobody painted.
    pub(super) fn fallback(&mut self, name: &str) {
        let entry = self.assets.textures[&TextureName::new(name)];
        self.assets.fallbacks.push(entry);
    }

    /// Adds a status-bar, font or sky picture.
    pub(super) fn graphic(&mut self, name: &str, canvas: &Canvas, offset_x: i32, offset_y: i32) {
        let index = self.picture(canvas, offset_x, offset_y);
        let before = self.assets.graphics.insert(TextureName::new(name), index);
        debug_assert!(before.is_none(), "graphic {name} is painted twice");
    }

    /// Gives a status-bar, font or sky picture a further name.
    pub(super) fn same_graphic(&mut self, name: &str, of: &str) {
        let index = self.assets.graphics[&TextureName::new(of)];
        self.assets.graphics.insert(TextureName::new(name), index);
    }

    /// Appends a frame to a sprite: one picture for each of the 8 rotations.
    pub(super) fn frame(&mut self, name: &str, frame: SpriteFrame) {
        let index = SPRITE_NAMES
            .iter()
            .position(|&known| known == name)
            .expect("sprites are painted under listed names");
        self.assets.sprites.resize_with(SPRITE_NAMES.len(), Sprite::default);
        self.assets.sprites[index].frames.push(frame);
    }

    /// Appends a sprite's last frame once more.
    pub(super) fn repeat_last(&mut self, name: &str) {
        let index = SPRITE_NAMES
            .iter()
            .position(|&known| known == name)
            .expect("sprites are painted under listed names");
        let frames = &mut self.assets.sprites[index].frames;
        frames.extend(frames.last().copied());
    }

    /// Appends a frame that looks the same from every side, standing on its anchor.
    pub(super) fn standing(&mut self, name: &str, canvas: &Canvas) {
        self.flat_frame(name, canvas, canvas.width / 2, canvas.height);
    }

    /// Appends a frame that looks the same from every side, with its anchor at a given point.
    pub(super) fn flat_frame(&mut self, name: &str, canvas: &Canvas, offset_x: i32, offset_y: i32) {
        let image = self.picture(canvas, offset_x, offset_y);
        self.frame(name, SpriteFrame { images: [image; 8], mirrored: [false; 8] });
    }
}
