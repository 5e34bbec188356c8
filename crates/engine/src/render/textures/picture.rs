//! Textures prepared for drawing: sizes and reciprocals worked out, flats cut to powers of two.

use crate::assets::{Assets, Image, TextureEntry};
use crate::render::textures::local_palette::OwnColours;
use crate::render::textures::midtexture::Fence;
use std::sync::Arc;

/// Most texels of a column of the pictures whose columns are drawn in batches: two vectors.
#[cfg(target_arch = "x86_64")]
pub(crate) const MOST_TEXELS: usize = 128;

/// A texture on a wall: opaque, tiled both ways.
#[derive(Clone, Debug)]
pub(crate) struct WallPicture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `2^32 / height`, rounded up so that whole heights come out whole.
    pub inverse_height: i64,
    /// `width - 1` where that masks a column number, otherwise 0.
    column_mask: u32,
    /// Palette indices, column by column.
    pub pixels: Arc<[u8]>,
}

impl WallPicture {
    /// Whether the columns of a picture can be listed: they fill one or two vectors, and wrap as numbers do.
    #[cfg(target_arch = "x86_64")]
    pub fn fits_batch(&self) -> bool {
        matches!(self.height, 64 | 128) && self.width.is_power_of_two()
    }

    pub fn new(image: &Image) -> WallPicture {
        let (width, height) = (u32::from(image.width).max(1), u32::from(image.height).max(1));
        let mut pixels = image.pixels.to_vec();
        pixels.resize((width * height) as usize, 0);
        WallPicture {
            width,
            height,
            inverse_height: ((1 << 32) + i64::from(height) - 1) / i64::from(height),
            column_mask: if width.is_power_of_two() { width - 1 } else { 0 },
            pixels: pixels.into(),
        }
    }

    /// The texels of the column that holds the horizontal texture position `u`, 16.16.
    #[inline]
    pub fn column(&self, u: i64) -> &[u8] {
        let start = self.column_start((u >> 16) as i32);
        &self.pixels[start..start + self.height as usize]
    }

    /// Index of the first texel of the column that holds a whole texel of a tiled wall.
    #[inline]
    pub fn column_start(&self, u: i32) -> usize {
        let column = if self.column_mask != 0 { u as u32 & self.column_mask } else { u.rem_euclid(self.width as i32) as u32 };
        (column * self.height) as usize
    }
}

/// A texture on a floor or ceiling, a square of 64 or 128, column by column.
#[derive(Clone, Debug)]
pub(crate) enum FlatPicture {
    /// The usual size.
    Small(Arc<[u8; 64 * 64]>),
    /// Textures with a side of 128 or more.
    Large(Arc<[u8; 128 * 128]>),
}

impl FlatPicture {
    fn new(image: &Image) -> FlatPicture {
        let (width, height) = (usize::from(image.width).max(1), usize::from(image.height).max(1));
        // Sides become powers of two, cut rather than scaled, as one texel is one map unit.
        let (across, down) = (1 << width.ilog2().min(7), 1 << height.ilog2().min(7));
        let texel = |u: usize, v: usize| image.pixels.get((u % across) * height + v % down).copied().unwrap_or(0);
        if across <= 64 && down <= 64 {
            FlatPicture::Small(Arc::new(std::array::from_fn(|i| texel(i / 64, i % 64))))
        } else {
            let mut pixels = Box::new([0; 128 * 128]);
            pixels.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = texel(i / 128, i % 128));
            FlatPicture::Large(Arc::from(pixels))
        }
    }
}

/// A picture with holes: sprites, fences, weapons, the status bar.
#[derive(Clone, Debug)]
pub(crate) struct MaskedPicture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Columns left of the anchor.
    pub offset_x: i32,
    /// Rows above the anchor.
    pub offset_y: i32,
    /// Column by column: palette index, and [`MaskedPicture::OPAQUE`] where there is no hole.
    pub texels: Arc<[u16]>,
}

impl MaskedPicture {
    /// Set in opaque texels.
    pub const OPAQUE: u16 = 0x100;

    pub fn new(image: &Image) -> MaskedPicture {
        let opaque = |i: usize| image.mask.as_ref().is_none_or(|mask| mask.get(i).is_some_and(|&m| m != 0));
        let texels = image
            .pixels
            .iter()
            .enumerate()
            .map(|(i, &pixel)| u16::from(pixel) | if opaque(i) { MaskedPicture::OPAQUE } else { 0 })
            .collect::<Vec<u16>>();
        let (width, height) = (u32::from(image.width), u32::from(image.height));
        let mut texels = texels;
        texels.resize((width * height) as usize, 0);
        MaskedPicture {
            width,
            height,
            offset_x: i32::from(image.offset_x),
            offset_y: i32::from(image.offset_y),
            texels: texels.into(),
        }
    }

    /// The texels of a column.
    #[inline]
    pub fn column(&self, column: u32) -> &[u16] {
        let start = (column * self.height) as usize;
        &self.texels[start..start + self.height as usize]
    }
}

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
    pub walls: Vec<WallPicture>,
    /// The same by their own colours.
    pub own: Vec<OwnColours>,
    /// By frame.
    pub flats: Vec<FlatPicture>,
    /// By frame.
    pub fences: Vec<Fence>,
    /// By frame: whether it is a square of 64 texels.
    pub squares: Vec<bool>,
    /// The texels of all walls that can be drawn as a list of columns, and as many more as a column has.
    #[cfg(target_arch = "x86_64")]
    pub listed: Vec<u8>,
    /// By frame: where its texels begin in `listed`.
    #[cfg(target_arch = "x86_64")]
    pub listed_from: Vec<Option<u32>>,
}

impl Textures {
    /// Adds the texture with the next id; a picture that the set lacks is a solid fill of `missing`.
    pub fn add(&mut self, assets: &Assets, entry: TextureEntry, missing: u8) {
        let first = self.walls.len() as u32;
        let frames = u32::from(entry.frames).max(1);
        let solid = Image { width: 1, height: 1, offset_x: 0, offset_y: 0, pixels: Box::new([missing]), mask: None };
        for frame in 0..frames {
            let image = assets.images.get(entry.first.saturating_add(frame) as usize);
            let image = image.filter(|image| image.width > 0 && image.height > 0).unwrap_or(&solid);
            let wall = WallPicture::new(image);
            #[cfg(target_arch = "x86_64")]
            self.list_texels(&wall);
            self.own.push(OwnColours::new(&wall.pixels, &assets.light_tables[..]));
            self.walls.push(wall);
            self.flats.push(FlatPicture::new(image));
            self.fences.push(Fence::new(image));
            self.squares.push((image.width, image.height) == (64, 64));
        }
        self.list.push(Texture { first, frames, tics: u32::from(entry.tics).max(1) });
    }

    #[cfg(target_arch = "x86_64")]
    fn list_texels(&mut self, wall: &WallPicture) {
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
