//! A map made ready for drawing with a set of pictures.

use crate::assets::{Assets, TextureEntry};
use crate::map::{Map, Node, Seg, Side, TextureId, TextureName};
use crate::math::Fixed;
use crate::render::colour::blend::Blend;
use crate::render::colour::palette::Colours;
use crate::render::colour::palette::{self, mean, nearest_colour};
use crate::render::textures::hud::BarArt;
use crate::render::textures::set::Textures;
use crate::render::textures::sprite::SpriteTexture;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The name of the ceiling texture that is the sky.
const SKY_FLAT: TextureName = TextureName::new("F_SKY1");
/// Names of sky pictures, where the pictures do not name one themselves: the first that they have
/// is taken.
const SKY_NAMES: [TextureName; 2] = [TextureName::new("SKY1"), TextureName::new("RSKY1")];
/// The sector of the other side of a one-sided line.
pub(crate) const NO_SECTOR: u32 = u32::MAX;

/// Light that walls running north-south have more and walls running east-west less than their
/// sector.
const CONTRAST: i32 = 16;

/// A seg as the renderer wants it.
#[derive(Clone, Debug)]
pub(crate) struct SceneSeg {
    /// The line's distance from the origin along the normal, 44 fractional bits.
    pub offset: i64,
    /// Unit normal towards the seg's own sector, 28 fractional bits.
    pub normal: [i32; 2],
    /// Ends, left to right as seen from its sector; 16.16.
    pub ends: [[i32; 2]; 2],
    /// Sector that it sidedefs.
    pub front: u32,
    /// Sector behind, or [`NO_SECTOR`].
    pub back: u32,
    /// Index into [`Scene::sidedefs`].
    pub face: u32,
    /// It has a masked texture in its opening.
    pub masked: bool,
    /// It is a piece of its line, not all of it.
    pub piece: bool,
}

impl SceneSeg {
    /// Distance of a point in 16.16 from the line, positive on the seg's side; 44 fractional bits.
    #[inline]
    pub fn away(&self, x: i64, y: i64) -> i64 {
        x * i64::from(self.normal[0]) + y * i64::from(self.normal[1]) - self.offset
    }
}

/// One side of a line: how its textures lie.
#[derive(Clone, Debug)]
pub(crate) struct Sidedef {
    /// Ends of the line, left to right as seen from this side; 16.16.
    pub ends: [[i32; 2]; 2],
    /// Texels of the line.
    pub texels: i64,
    /// Texture position of the line's start, 16.16.
    pub u_offset: i64,
    /// Moves textures up, 16.16 map units.
    pub v_offset: i64,
    /// Texture above the opening.
    pub top: Option<TextureId>,
    /// Texture of a one-sided wall, or the masked one in the opening.
    pub middle: Option<TextureId>,
    /// Texture below the opening.
    pub bottom: Option<TextureId>,
    /// Upper texture starts at the higher ceiling.
    pub upper_unpegged: bool,
    /// Lower texture hangs from the higher ceiling; the middle one stands on the floor.
    pub lower_unpegged: bool,
    /// Added to the sector's light: walls along one axis are lighter, along the other darker.
    pub contrast: i32,
}

impl Sidedef {
    /// Position along its line of a point on it, 16.16 texels from the line's start.
    pub fn position(&self, [x, y]: [Fixed; 2]) -> i64 {
        let [[from_x, from_y], [to_x, to_y]] = self.ends.map(|end| end.map(i64::from));
        let (_, along) = texels_along(to_x - from_x, to_y - from_y);
        ((i64::from(x.0) - from_x) * along[0] + (i64::from(y.0) - from_y) * along[1]) >> 28
    }

    /// Last position on its line, 16.16 texels.
    pub fn last_position(&self) -> i64 {
        (self.texels << 16) - 1
    }

    /// One without textures.
    pub fn bare() -> Sidedef {
        Sidedef {
            ends: [[0; 2]; 2],
            texels: 1,
            u_offset: 0,
            v_offset: 0,
            top: None,
            middle: None,
            bottom: None,
            upper_unpegged: false,
            lower_unpegged: false,
            contrast: 0,
        }
    }
}

/// A map and the pictures it is drawn with, worked out once and shared by every world of the map.
#[derive(Debug)]
pub struct Scene {
    /// No other scene of the process has it.
    pub(crate) serial: u64,
    pub(crate) assets: Arc<Assets>,
    /// The palette without a tint.
    pub(crate) colours: Colours,
    pub(crate) segs: Vec<SceneSeg>,
    pub(crate) sidedefs: Vec<Sidedef>,
    pub(crate) nodes: Vec<Node>,
    /// First seg, one past the last, sector.
    pub(crate) subsectors: Vec<[u32; 3]>,
    /// Most segs of a subsector.
    pub(crate) most_segs: usize,
    pub(crate) sector_count: usize,
    pub(crate) textures: Textures,
    /// The ceiling texture that shows the sky.
    pub(crate) sky_flat: Option<TextureId>,
    /// Index of the sky's picture in `textures.walls`.
    pub(crate) sky: usize,
    /// The images that sprites use, by index into `Assets::images`.
    pub(crate) sprite_pictures: Vec<Option<SpriteTexture>>,
    /// No picture of these reaches farther to a side of its anchor, mirrored or not; texels.
    pub(crate) sprite_reach: i64,
    /// Index of the solid picture that fills what has no texture, in `textures.walls`.
    pub(crate) missing_picture: usize,
    /// The status bar's pictures.
    pub(crate) bar: BarArt,
    /// What shines through.
    pub(crate) blend: Blend,
    /// Palette indices of the squares that rockets shed, by [`Shade`](crate::world::Shade).
    pub(crate) shades: [u8; 3],
}

impl Scene {
    /// Resolves every texture and sprite name of the map against the pictures.
    #[must_use]
    pub fn new(map: &Map, assets: Arc<Assets>) -> Scene {
        let missing = nearest_colour(&assets.palette, [96, 96, 96]);
        let mut textures = Textures::default();
        for &name in &map.textures {
            textures.add(&assets, assets.texture(name), missing);
        }
        let sky = textures.walls.len();
        let sky_entry = assets.sky.iter().chain(&SKY_NAMES).find_map(|name| {
            let graphic =
                assets.graphics.get(name).map(|&first| TextureEntry { first, frames: 1, tics: 1 });
            assets.textures.get(name).copied().or(graphic)
        });
        let no_entry = TextureEntry { first: u32::MAX, frames: 1, tics: 1 };
        textures.add(&assets, sky_entry.unwrap_or(no_entry), missing);
        let missing_picture = textures.walls.len();
        textures.add(&assets, no_entry, missing);

        let sprite_pictures = sprite_pictures(&assets);
        let mut sidedefs = vec![None; map.sides.len()];
        for line in &map.lines {
            let (dx, dy) = (i64::from(line.dx.0), i64::from(line.dy.0));
            let contrast = if dx == 0 {
                CONTRAST
            } else if dy == 0 {
                -CONTRAST
            } else {
                0
            };
            let (texels, _) = texels_along(dx, dy);
            let ends = [line.v1, line.v2].map(|vertex| [vertex.x.0, vertex.y.0]);
            let sides =
                [Some((line.front, ends)), line.back.map(|back| (back, [ends[1], ends[0]]))];
            for (id, ends) in sides.into_iter().flatten() {
                let side: &Side = &map.sides[id.0 as usize];
                sidedefs[id.0 as usize] = Some(Sidedef {
                    ends,
                    texels,
                    u_offset: i64::from(side.offset_x.0),
                    v_offset: i64::from(side.offset_y.0),
                    top: side.top,
                    middle: side.middle,
                    bottom: side.bottom,
                    upper_unpegged: line.flags.upper_unpegged,
                    lower_unpegged: line.flags.lower_unpegged,
                    contrast,
                });
            }
        }
        static MADE: AtomicU64 = AtomicU64::new(0);
        Scene {
            serial: MADE.fetch_add(1, Ordering::Relaxed),
            segs: map.segs.iter().map(|seg| scene_seg(map, seg)).collect(),
            // A side that no line uses is never drawn.
            sidedefs: sidedefs.into_iter().map(|face| face.unwrap_or_else(Sidedef::bare)).collect(),
            nodes: map.nodes.clone(),
            subsectors: map
                .subsectors
                .iter()
                .map(|s| [s.first_seg, s.first_seg + s.seg_count, s.sector.0])
                .collect(),
            most_segs: map
                .subsectors
                .iter()
                .map(|subsector| subsector.seg_count as usize)
                .max()
                .unwrap_or(0),
            sector_count: map.sectors.len(),
            sky_flat: map
                .textures
                .iter()
                .position(|&name| name == SKY_FLAT)
                .map(|i| TextureId(i as u16)),
            sky,
            sprite_reach: sprite_pictures
                .iter()
                .flatten()
                .map(SpriteTexture::reach)
                .max()
                .unwrap_or(0),
            sprite_pictures,
            textures,
            missing_picture,
            bar: BarArt::new(&assets),
            blend: Blend::new(&assets.palette),
            shades: palette::SHADES.map(|colour| nearest_colour(&assets.palette, colour)),
            colours: Colours::new(assets.palette),
            assets,
        }
    }

    /// The mean colour of a texture's first frame.
    pub(crate) fn mean_colour(&self, texture: TextureId) -> [u8; 3] {
        let entry = &self.textures.list[usize::from(texture.0)];
        let picture = &self.textures.walls[entry.first as usize];
        mean(&self.assets.palette, picture.pixels.iter().copied())
    }

    /// The mean colour of a sprite from the front, brightened so that it shows on a map.
    pub(crate) fn sprite_colour(&self, sprite: u8, frame: u8) -> [u8; 3] {
        let frames = self.assets.sprites.get(usize::from(sprite)).map(|sprite| &sprite.frames);
        let image =
            frames.and_then(|frames| frames.get(usize::from(frame))).map(|frame| frame.images[0]);
        let picture = image.and_then(|image| self.sprite_pictures.get(image as usize)?.as_ref());
        let colour =
            mean(&self.assets.palette, picture.iter().flat_map(|picture| picture.opaque_texels()));
        let brightest = u32::from(colour.into_iter().max().unwrap_or(0)).max(1);
        colour.map(|channel| (u32::from(channel) * 255 / brightest) as u8)
    }
}

fn scene_seg(map: &Map, seg: &Seg) -> SceneSeg {
    let line = &map.lines[seg.line as usize];
    let (mut dx, mut dy) = (i64::from(line.dx.0), i64::from(line.dy.0));
    if line.back == Some(seg.side) {
        (dx, dy) = (-dx, -dy);
    }
    let along = unit_vector(dx, dy);
    let normal = [along[1], -along[0]];
    SceneSeg {
        offset: i64::from(line.v1.x.0) * normal[0] + i64::from(line.v1.y.0) * normal[1],
        normal: normal.map(|part| part as i32),
        ends: [[seg.v1.x.0, seg.v1.y.0], [seg.v2.x.0, seg.v2.y.0]],
        front: seg.front_sector.0,
        back: seg.back_sector.map_or(NO_SECTOR, |sector| sector.0),
        face: seg.side.0,
        piece: [seg.v1, seg.v2]
            != if line.back == Some(seg.side) { [line.v2, line.v1] } else { [line.v1, line.v2] },
        masked: seg.back_sector.is_some() && map.sides[seg.side.0 as usize].middle.is_some(),
    }
}

/// The direction of a vector with 28 fractional bits.
fn unit_vector(dx: i64, dy: i64) -> [i64; 2] {
    // 8 more bits than the vector's own, so that rounding the length does not show.
    let length = (square(dx, dy) << 16).isqrt().max(1) as i128;
    let part = |d: i64| {
        let scaled = i128::from(d) << 36;
        ((scaled + scaled.signum() * length / 2) / length) as i64
    };
    [part(dx), part(dy)]
}

fn square(dx: i64, dy: i64) -> u128 {
    u128::from(dx.unsigned_abs()).pow(2) + u128::from(dy.unsigned_abs()).pow(2)
}

/// How many texels a line is long, and what a texture position on it gains with each map unit of
/// the world, 28 fractional bits.
fn texels_along(dx: i64, dy: i64) -> (i64, [i64; 2]) {
    let square = square(dx, dy).max(1);
    let length = square.isqrt() as i64;
    // At most twice as many texels as units, for lines that are shorter than one.
    let texels = ((length + 0x8000) >> 16).max(1);
    let stretched = (i128::from(texels) << 44).min(i128::from(length) << 29);
    (texels, [dx, dy].map(|d| (i128::from(d) * stretched / square as i128) as i64))
}

fn sprite_pictures(assets: &Assets) -> Vec<Option<SpriteTexture>> {
    let mut pictures = vec![None; assets.images.len()];
    for index in
        assets.sprites.iter().flat_map(|sprite| &sprite.frames).flat_map(|frame| frame.images)
    {
        if let Some(image) = assets.images.get(index as usize) {
            pictures[index as usize] = Some(SpriteTexture::new(image));
        }
    }
    pictures
}
