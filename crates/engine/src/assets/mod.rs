//! Pictures behind one interface: the embedded set that this project draws itself, or an IWAD with
//! files laid over it.
//!
//! Everything is paletted (one byte a pixel); the renderer maps bytes through a light table, then
//! the palette.

mod embedded;
mod iwad;

pub use iwad::IwadError;

/// A picture: column-major, `pixels[x * height + y]`, so that a wall or sprite column is
/// contiguous.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in texels.
    pub width: u16,
    /// Height in texels.
    pub height: u16,
    /// Pixels to the left of the anchor (sprites), or the patch's left offset (view weapons).
    pub offset_x: i16,
    /// Pixels above the anchor.
    pub offset_y: i16,
    /// Palette indices, column by column.
    pub pixels: Box<[u8]>,
    /// Opacity of each pixel (0 or 1), column by column; `None` when every pixel is opaque.
    pub mask: Option<Box<[u8]>>,
}

/// Something dark on a wall: how much it hides of what is under it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stain {
    /// Width in texels.
    pub width: u16,
    /// Height in texels.
    pub height: u16,
    /// Texels to the left of its anchor.
    pub offset_x: i16,
    /// Texels above its anchor.
    pub offset_y: i16,
    /// How much each texel hides, 0 to 255, column by column.
    pub texels: Box<[u8]>,
}

impl Stain {
    /// A column, from the left or, mirrored, from the right; none beside the picture.
    #[must_use]
    pub fn column(&self, u: i64, mirrored: bool) -> Option<&[u8]> {
        let u = usize::try_from(if mirrored { i64::from(self.width) - 1 - u } else { u }).ok()?;
        let height = usize::from(self.height);
        self.texels.get(u * height..(u + 1) * height)
    }
}

/// The views of one frame of a sprite: for each of the 8 rotations (0 = facing the viewer, then
/// counter-clockwise as the viewer walks around it: the classic rotation digits 1..=8) an index
/// into [`Assets::images`] and whether it is mirrored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct SpriteFrame {
    /// Image index of each rotation; `u32::MAX` where there is none.
    pub images: [u32; 8],
    /// Whether each rotation is drawn mirrored.
    pub mirrored: [bool; 8],
}

/// A sprite: frames `A`, `B`, ...
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Sprite {
    /// Frames in letter order.
    pub frames: Vec<SpriteFrame>,
}

/// A set of pictures.
#[derive(Clone, Debug)]
pub struct Assets {
    /// 256 colours.
    pub palette: [[u8; 3]; 256],
    /// 32 light tables, 0 full bright to 31 nearly black: palette index to palette index.
    pub light_tables: Box<[[u8; 256]; 32]>,
    /// Every picture.
    pub images: Vec<Image>,
    /// Textures and flats by name: first image, number of animation frames (consecutive images),
    /// tics a frame.
    pub textures: std::collections::BTreeMap<crate::map::TextureName, TextureEntry>,
    /// Textures that stand in for names which [`Assets::textures`] lacks, so that a map by someone
    /// else is never full of holes.
    pub fallbacks: Vec<TextureEntry>,
    /// Sprites, in the order of [`SPRITE_NAMES`].
    pub sprites: Vec<Sprite>,
    /// Status bar, font, face and sky pictures by lump name (`STBAR`, `STTNUM0`, `STFST00`, `SKY1`,
    /// ...).
    pub graphics: std::collections::BTreeMap<crate::map::TextureName, u32>,
    /// The picture of the sky, where the files name one.
    pub sky: Option<crate::map::TextureName>,
    /// What bursting rockets leave on walls, where the files bring it; without it walls stay clean.
    pub soot: Option<Stain>,
    /// What the files hold and wanted textures ask for, but is not drawn as they say; a phrase
    /// each.
    pub left_out: std::collections::BTreeSet<String>,
}

impl Assets {
    /// The texture or flat of a name; a name that the set lacks always gets the same one of
    /// [`Assets::fallbacks`].
    #[must_use]
    pub fn texture(&self, name: crate::map::TextureName) -> TextureEntry {
        self.textures.get(&name).copied().unwrap_or_else(|| {
            let hash = name
                .0
                .iter()
                .fold(0u32, |hash, &byte| hash.wrapping_mul(31).wrapping_add(u32::from(byte)));
            let first_picture = TextureEntry { first: 0, frames: 1, tics: 1 };
            self.fallbacks
                .get(hash as usize % self.fallbacks.len().max(1))
                .copied()
                .unwrap_or(first_picture)
        })
    }
}

/// Where a texture's pictures are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureEntry {
    /// Index of the first image.
    pub first: u32,
    /// Number of animation frames.
    pub frames: u8,
    /// Tics that each frame is shown.
    pub tics: u8,
}

/// Four-letter sprite names; an actor's `sprite` is an index into this list.
pub const SPRITE_NAMES: [&str; 73] = [
    "BON1", "STIM", "MEDI", "BON2", "ROCK", "SHEL", "CELL", "CLIP", "PVIS", "PINS", "PMAP", "BPAK",
    "SUIT", "YKEY", "BSKU", // items
    "PIST", "SHOT", "SGN2", "MGUN", "LAUN", "PLAS", "BFUG", // weapons to pick up
    "HEAD", "POSS", "SPOS", "CPOS", "TROO", "SARG", "SKEL", "SKUL", // monsters
    "BAR1", "BEXP", "MISL", "PLSS", "PLSE", "BFS1", "BFE1", "PUFF", "BLUD", // effects
    "TLMP", "TLP2", "COL4", "COL2", "COL5", "ELEC", "TRE1", "SMIT", "TRE2", "POL5", "PLAY", "BRS1",
    "COL1", // decor, player
    "PISG", "PISF", "SHTG", "SHTF", "CHGG", "CHGF", "MISG", "MISF", "PLSG", "BFGG", "SHT2", "PLSF",
    "BFGF", // view weapons
    "CAND", "SMBT", "SMGT", "SMRT", "POB1", "FTOP", "FDEB", // decor of the published maps
    "RSMK", // smoke of rockets
];

/// The index of a sprite name; `const`, so that the state tables resolve their names while
/// compiling.
#[must_use]
pub const fn sprite_index(name: &str) -> Option<u8> {
    let name = name.as_bytes();
    let mut i = 0;
    while i < SPRITE_NAMES.len() {
        let other = SPRITE_NAMES[i].as_bytes();
        if name.len() == 4
            && name[0] == other[0]
            && name[1] == other[1]
            && name[2] == other[2]
            && name[3] == other[3]
        {
            return Some(i as u8);
        }
        i += 1;
    }
    None
}
