//! Layers of weapons as they were drawn before. At rest and in each frame of a shot a weapon is the
//! same picture in the same place and light, from frame to frame and in every world of a thread: it
//! is drawn once, and from then on its pixels are copied.

use crate::math::Fixed;
use crate::render::buffers::frame::{Frame, class};
use crate::render::buffers::written::{ClassBuffer, DepthBuffer, NoDepth, WithClass};
use crate::render::patch;
use crate::render::patch::data::Patch;
use crate::render::view::size::FrameSize;
use crate::render::view::tables::View;
use crate::simd::Simd;

/// Layers that are remembered at most: the light of a few sectors times the pictures of a shot.
const SLOTS: usize = 64;

/// Larger frames are people's, one at a time: their pixels are not kept.
const MOST_PIXELS: usize = 160 * 120;

/// All that a layer's pixels hang on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct LayerKey {
    /// [`Scene::serial`](crate::render::scene::prepared::Scene): of the pictures.
    pub scene: u64,
    pub size: FrameSize,
    pub image: u32,
    pub light_table: usize,
    pub place: [Fixed; 2],
}

/// The layers of a thread's weapons.
#[derive(Debug, Default)]
pub(crate) struct WeaponCache {
    slots: Vec<Option<Slot>>,
}

/// A layer that was drawn last of those that share a slot.
#[derive(Debug)]
struct Slot {
    key: LayerKey,
    /// What it covers, once it was drawn a second time: a weapon that sways is hardly ever where it
    /// was.
    layer: Option<DrawnLayer>,
}

/// The pixels that a layer covers.
#[derive(Debug)]
struct DrawnLayer {
    /// Place in the frame and length of runs of a row without a hole.
    runs: Vec<[u32; 2]>,
    /// The colours of all runs.
    colours: Vec<u8>,
}

impl WeaponCache {
    /// Draws a layer, if its pixels are known; returns whether they are.
    pub fn copy<D: DepthBuffer, C: ClassBuffer>(&self, key: &LayerKey, frame: &mut Frame) -> bool {
        let known =
            self.slots.get(key.slot()).and_then(Option::as_ref).filter(|slot| slot.key == *key);
        let Some(layer) = known.and_then(|slot| slot.layer.as_ref()) else { return false };
        layer.copy::<D, C>(frame);
        true
    }

    #[cfg(test)]
    pub fn known(&self) -> usize {
        self.slots.iter().flatten().filter(|slot| slot.layer.is_some()).count()
    }

    /// Takes note of an opaque layer that is drawn: the second time running that it is drawn of its
    /// slot's, of its pixels.
    pub fn note(&mut self, key: LayerKey, stamp: &Patch, simd: Simd, view: &View) {
        if view.size().pixels() > MOST_PIXELS {
            return;
        }
        self.slots.resize_with(SLOTS, || None);
        let slot = &mut self.slots[key.slot()];
        let is_second = slot.as_ref().is_some_and(|slot| slot.key == key);
        *slot = Some(Slot { key, layer: is_second.then(|| DrawnLayer::new(stamp, simd, view)) });
    }
}

impl LayerKey {
    fn slot(&self) -> usize {
        let place = self.place.map(|part| part.0 as u64);
        let words =
            [self.scene, u64::from(self.image), self.light_table as u64, place[0], place[1]];
        let mixed = words.iter().fold(0, |mixed: u64, word| {
            (mixed ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(23)
        });
        (mixed % SLOTS as u64) as usize
    }
}

impl DrawnLayer {
    /// What a stamp covers of an empty frame.
    fn new(stamp: &Patch, simd: Simd, view: &View) -> DrawnLayer {
        let mut frame = Frame::default();
        frame.fit(view, frame.depths);
        patch::draw::<NoDepth, WithClass>(stamp, simd, &mut frame, &view.rows);
        let (mut runs, mut colours) = (Vec::new(), Vec::new());
        for (row, classes) in frame.class.chunks_exact(frame.width).enumerate() {
            let mut x = 0;
            for run in
                classes.chunk_by(|one, other| (*one == class::WEAPON) == (*other == class::WEAPON))
            {
                if run[0] == class::WEAPON {
                    let at = row * frame.width + x;
                    runs.push([at as u32, run.len() as u32]);
                    colours.extend_from_slice(&frame.colour[at..at + run.len()]);
                }
                x += run.len();
            }
        }
        DrawnLayer { runs, colours }
    }

    fn copy<D: DepthBuffer, C: ClassBuffer>(&self, frame: &mut Frame) {
        let mut colours = &self.colours[..];
        for &[at, length] in &self.runs {
            let pixels = at as usize..(at + length) as usize;
            let (own, rest) = colours.split_at(length as usize);
            colours = rest;
            copy_run(&mut frame.colour[pixels.clone()], own);
            if D::WRITTEN {
                frame.depth[pixels.clone()].fill(0);
            }
            if C::WRITTEN {
                frame.class[pixels].fill(class::WEAPON);
            }
        }
    }
}

/// Copies a run of pixels, by pieces that overlap where its length is no whole number of them: for
/// so few a call costs more.
#[inline(always)]
fn copy_run(to: &mut [u8], from: &[u8]) {
    const PIECE: usize = 16;
    let Some(last) = from.last_chunk::<PIECE>() else {
        return to.iter_mut().zip(from).for_each(|(to, &from)| *to = from);
    };
    for (to, from) in to.as_chunks_mut::<PIECE>().0.iter_mut().zip(from.as_chunks::<PIECE>().0) {
        *to = *from;
    }
    *to.last_chunk_mut().expect("as long as what is copied") = *last;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::{Assets, SPRITE_NAMES};
    use crate::map::stone_room;
    use crate::math::{Angle, Rng};
    use crate::render::buffers::request::Buffers;
    use crate::render::renderer::Renderer;
    use crate::render::scene::prepared::Scene;
    use crate::render::scratch::FrameScratch;
    use crate::world::{PlayerSprite, World};
    use std::sync::Arc;

    type Shot = (Vec<u8>, Vec<u8>, Vec<u16>);

    fn shoot(
        scratch: &mut FrameScratch,
        world: &World,
        scene: &Arc<Scene>,
        size: FrameSize,
        simd: Simd,
    ) -> Shot {
        let mut renderer = Renderer::new(Arc::clone(scene), Arc::new(View::new(size).unwrap()));
        renderer.set_simd(simd);
        renderer.render(scratch, world, 0, Buffers { depth: true, labels: true });
        (renderer.indices().to_vec(), renderer.depth().to_vec(), renderer.classes().to_vec())
    }

    #[test]
    fn copied_weapons_are_those_that_were_drawn() {
        let mut world = World::new(stone_room(40, [-64, -256, 256, 256], &[[0.0, 0.0]]), 1);
        let scenes = [(); 2].map(|()| Arc::new(Scene::new(&world.map, Assets::embedded())));
        let launcher = SPRITE_NAMES.iter().position(|&name| name == "MISG").unwrap();
        let held = PlayerSprite {
            sprite: launcher as u8,
            frame: 0,
            bright: false,
            x: Fixed::ZERO,
            y: Fixed::from_int(32),
        };
        let (mut rng, mut shown) = (Rng::new(21), 0);
        let mut scratch = FrameScratch::default();
        for round in 0..200 {
            // Few places, pictures and lights, so that many come again.
            let mut any = |count: u32| rng.below(count) as i32;
            let player = &mut world.players[0];
            let (x, y) = (Fixed::from_int(7 * any(2)), held.y + Fixed::from_int(20 * any(2)));
            player.sprites[0] =
                Some(PlayerSprite { frame: any(2) as u8, bright: any(4) == 0, x, y, ..held });
            (player.extra_light, player.blur_tics) =
                (any(2) as u8, if any(9) == 0 { 200 } else { 0 });
            let (scene, simd) = (
                &scenes[any(2) as usize],
                Simd::available()[any(Simd::available().len() as u32) as usize],
            );
            let size =
                [FrameSize::LEARNER, FrameSize::CLASSIC, FrameSize { width: 320, height: 240 }]
                    [any(9) as usize / 4];
            // Drawn, drawn and noted, copied.
            for time in 0..3 {
                let id = world.players[0].actor;
                world.get_mut(id).unwrap().angle = Angle(rng.next_u64() as u32);
                let here = shoot(&mut scratch, &world, scene, size, simd);
                // Other memory has drawn nothing before.
                let afresh = shoot(&mut FrameScratch::default(), &world, scene, size, Simd::PLAIN);
                assert!(here == afresh, "round {round}, time {time}, {simd:?}, {size:?}");
                shown += usize::from(here.2.contains(&class::WEAPON));
            }
        }
        assert!(shown > 300, "{shown} of 600 frames show a weapon");
        let known = scratch.weapons_known();
        assert!(known > 20, "the pixels of {known} layers are known");
    }
}
