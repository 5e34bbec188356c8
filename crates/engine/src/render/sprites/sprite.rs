//! Sprites: which actors are in view, where, and their drawing.

use crate::math::{Angle, Fixed};
use crate::render::patch::data::{Patch, PatchColumns, TEXEL_BITS, first_row};
use crate::render::scene::prepared::Scene;
use crate::render::textures::sprite::SpriteTexture;
use crate::render::view::camera::Camera;
use crate::render::view::light::{Light, ONE_TABLE_DISTANCE};
use crate::render::view::line::INVERSE_BITS;
use crate::render::view::tables::View;
use crate::world::{Actor, ActorKind, OPAQUE, World};

/// Actors nearer than this, in 16.16 map units, are not drawn.
const NEAREST: i64 = 4 << 16;

/// Where something flat that sidedefs the eye is: what decides which walls hide it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// Inverse distance, [`INVERSE_BITS`] fractional bits.
    pub inverse: i64,
    /// Where it stands, 16.16.
    pub x: i64,
    pub y: i64,
    /// Height of its upper and lower end.
    pub top: Fixed,
    pub bottom: Fixed,
    /// Frame columns.
    pub first: usize,
    pub end: usize,
}

/// An actor in view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VisSprite {
    /// Its slot.
    pub slot: u16,
    /// What it is.
    pub kind: ActorKind,
    /// Index into [`Scene::sprite_pictures`].
    pub picture: u32,
    /// How opaque it is, in parts of [`OPAQUE`].
    pub opacity: u8,
    /// Distance, 16.16.
    pub distance: i64,
    /// Light table.
    pub table: usize,
    /// What of the frame its picture may cover.
    pub extent: Extent,
    /// Frame rows before clipping.
    pub first_row: i16,
    pub end_row: i16,
    /// Texture column at base column 0 and its change a column, 16.16; mirrored pictures are walked
    /// from their right end.
    u: i64,
    u_step: i64,
    /// Texture row at the lower edge of base row 0 and its change a row.
    v: i64,
    v_step: i64,
}

/// Beyond all distances.
const FARTHEST: i64 = 1 << 40;

/// The sprites of a frame.
#[derive(Debug, Default)]
pub(crate) struct Sprites {
    list: Vec<VisSprite>,
    /// Far to near: distance from the farthest possible one with the actor's slot below, and place
    /// in the list. Keys are sorted in place of sprites, which are large.
    order: Vec<(u64, u32)>,
}

impl Sprites {
    /// Far to near.
    pub fn far_to_near(&self) -> impl Iterator<Item = &VisSprite> {
        self.order.iter().map(|&(_, place)| &self.list[place as usize])
    }
}

/// Collects the actors that the frame may show.
pub(crate) fn collect(
    Sprites { list: seen, order }: &mut Sprites,
    scene: &Scene,
    view: &View,
    camera: &Camera,
    world: &World,
    player: usize,
    entered: &[bool],
) {
    seen.clear();
    let own = usize::from(world.players[player].actor.slot);
    for (slot, actor) in world.actors.iter().enumerate() {
        let in_sight = entered.get(actor.sector.0 as usize).is_some_and(|&entered| entered);
        if in_sight && !actor.removed && slot != own {
            // Light may have to be computed: only for what is in view.
            let level = || i32::from(world.sector(actor.sector).light);
            seen.extend(see(scene, view, camera, actor, slot as u16, world.tic, level));
        }
    }
    order.clear();
    let key =
        |sprite: &VisSprite| ((FARTHEST - sprite.distance) as u64) << 16 | u64::from(sprite.slot);
    order.extend(seen.iter().map(key).zip(0..));
    order.sort_unstable();
}

fn see(
    scene: &Scene,
    view: &View,
    camera: &Camera,
    actor: &Actor,
    slot: u16,
    tic: u32,
    level: impl FnOnce() -> i32,
) -> Option<VisSprite> {
    let (x, y) = (i64::from(actor.x.0), i64::from(actor.y.0));
    let [left, right] = camera.edges(x, y);
    let distance = (left + right) / 2;
    if distance < NEAREST {
        return None;
    }
    // Most actors of a large map are far beside the view: no picture of theirs would reach into it.
    let reach = (scene.sprite_reach + 1) << 16;
    if (left < -reach) | (right < -reach) {
        return None;
    }
    let shown = actor.picture(tic);
    let frame = scene
        .assets
        .sprites
        .get(usize::from(shown.sprite))?
        .frames
        .get(usize::from(shown.frame))?;
    let rotation = if frame.images.iter().all(|&image| image == frame.images[0]) {
        0
    } else {
        rotation(camera, actor, x, y)
    };
    let index = frame.images[rotation];
    let picture = scene.sprite_pictures.get(index as usize)?.as_ref()?;

    let width = i64::from(view.base_width);
    // The picture is stretched over whole columns. A mirrored one hangs by its mirrored anchor.
    let mirrored = frame.mirrored[rotation];
    let texels = i64::from(picture.width);
    let offset = i64::from(picture.offset_x);
    let across = (left - right) / 2 - (if mirrored { texels - 1 - offset } else { offset } << 16);
    // The outermost rays are as far to the side as forward.
    let across = [across, across + (texels << 16)];
    // Wholly beside the view: the divisions would only show so.
    if across[0] >= distance || across[1] <= -distance {
        return None;
    }
    let ends = across.map(|across| (width + (across * width).div_euclid(distance)) >> 1);
    let [first, end] =
        ends.map(|column| usize::from(view.first_column[column.clamp(0, width) as usize]));
    if first >= end {
        return None;
    }
    let u_step = (texels << 16) / (ends[1] - ends[0]);
    let (u, u_step) = if mirrored {
        ((texels << 16) - 1 + u_step * ends[0], -u_step)
    } else {
        (-u_step * ends[0], u_step)
    };
    let top = actor.z + Fixed::from_int(picture.offset_y);
    let v_step = (distance * view.inverse_focal_y) >> (48 - TEXEL_BITS);
    let above = i64::from(top.0) - camera.z;
    let v = (above << (TEXEL_BITS - 16)) - camera.to_horizon(v_step);
    let (first_row, end_row) =
        (first_row(view, 0, v, v_step), first_row(view, picture.height, v, v_step));
    if first_row >= end_row {
        return None;
    }
    let nearness = (ONE_TABLE_DISTANCE << 32) / distance;
    let table = match (shown.bright, camera.fixed_table) {
        (true, None) => 0,
        _ => Light::new(camera, level()).table(nearness),
    };
    Some(VisSprite {
        slot,
        kind: actor.kind,
        picture: index,
        opacity: shown.opacity,
        distance,
        table,
        extent: Extent {
            inverse: (1 << (INVERSE_BITS + 16)) / distance,
            x,
            y,
            top,
            bottom: top - Fixed::from_int(picture.height as i32),
            first,
            end,
        },
        first_row,
        end_row,
        u,
        u_step,
        v,
        v_step,
    })
}

/// Which of the 8 views of an actor the camera has: 0 from the front, then counter-clockwise around
/// it.
fn rotation(camera: &Camera, actor: &Actor, x: i64, y: i64) -> usize {
    // Halved, so that differences fit.
    let half = |difference: i64| Fixed((difference >> 1) as i32);
    let towards = Angle::of_vector(half(x - camera.x), half(y - camera.y));
    // Half a turn because 0 is the front, half an eighth so that each view is centred on its
    // direction.
    ((towards - actor.angle + Angle(0x9000_0000)).0 >> 29) as usize
}

impl VisSprite {
    /// Opens its columns in rows down to `view_rows`; what stands before it clips them.
    pub fn open(&self, columns: &mut PatchColumns, view: &View) {
        let texel = |&column: &u32| ((self.u + self.u_step * i64::from(column)) >> 16) as u16;
        columns.open(
            0..view.view_rows as i16,
            view.columns[self.extent.first..self.extent.end].iter().map(texel),
        );
    }

    /// The picture on its way to the frame; `depth` and `class` are what its pixels get.
    pub fn stamp<'a>(
        &self,
        scene: &'a Scene,
        picture: &'a SpriteTexture,
        columns: &'a PatchColumns,
        depth: u8,
        class: u16,
    ) -> Patch<'a> {
        Patch {
            picture,
            table: &scene.assets.light_tables[self.table],
            first: self.extent.first,
            columns,
            rows: self.first_row as usize..self.end_row as usize,
            v: self.v,
            v_step: self.v_step,
            mixture: (self.opacity < OPAQUE).then(|| scene.blend.mixture(self.opacity)),
            depth,
            class,
        }
    }
}
