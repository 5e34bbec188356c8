//! All textures of a map, by id, prepared for drawing in each form.

use crate::assets::{Assets, Image, TextureEntry};
use crate::render::textures::flat::FlatTexture;
use crate::render::textures::local_palette::LocalPalette;
use crate::render::textures::midtexture::Midtexture;
use crate::render::textures::wall::{MOST_TEXELS, WallTexture};

/// What the renderer needs of one texture name: every frame of its animation, in each form.
#[derive(Clone, Debug)]
pub(crate) struct Texture {
    /// Index of its first frame in the lists of pictures.
    pub first: u32,
    /// Number of frames.
    pub frames: u32,
    /// Tics a frame.
    pub tics: u32,
}

/// The prepared textures of a map, by [`TextureId`](crate::map::TextureId).
#[derive(Clone, Debug, Default)]
pub(crate) struct Textures {
    /// By texture id.
    pub list: Vec<Texture>,
    /// By frame.
    pub walls: Vec<WallTexture>,
    /// The same by their own colours.
    pub own: Vec<LocalPalette>,
    /// By frame.
    pub flats: Vec<FlatTexture>,
    /// By frame.
    pub midtextures: Vec<Midtexture>,
    /// By frame: whether it is a square of 64 texels.
    pub squares: Vec<bool>,
    /// The texels of all walls that can be drawn as a list of columns, and as many more as a column
    /// has.
    pub listed: Vec<u8>,
    /// By frame: where its texels begin in `listed`.
    pub listed_from: Vec<Option<u32>>,
}

impl Textures {
    /// Adds the texture with the next id; a picture that the set lacks is a solid fill of
    /// `missing`.
    pub fn add(&mut self, assets: &Assets, entry: TextureEntry, missing: u8) {
        let first = self.walls.len() as u32;
        let frames = u32::from(entry.frames).max(1);
        let solid = Image {
            width: 1,
            height: 1,
            offset_x: 0,
            offset_y: 0,
            pixels: Box::new([missing]),
            mask: None,
        };
        for frame in 0..frames {
            let image = assets.images.get(entry.first.saturating_add(frame) as usize);
            let image = image.filter(|image| image.width > 0 && image.height > 0).unwrap_or(&solid);
            let wall = WallTexture::new(image);
            self.list_texels(&wall);
            self.own.push(LocalPalette::new(&wall.pixels, &assets.light_tables[..]));
            self.walls.push(wall);
            self.flats.push(FlatTexture::new(image));
            self.midtextures.push(Midtexture::new(image));
            self.squares.push((image.width, image.height) == (64, 64));
        }
        self.list.push(Texture { first, frames, tics: u32::from(entry.tics).max(1) });
    }

    fn list_texels(&mut self, wall: &WallTexture) {
        let end = self.listed.len().saturating_sub(MOST_TEXELS);
        let takes = wall.fits_batch();
        if takes {
            self.listed.truncate(end);
            self.listed.extend_from_slice(&wall.pixels);
            self.listed.resize(self.listed.len() + MOST_TEXELS, 0);
        }
        self.listed_from.push(takes.then_some(end as u32));
    }
}
