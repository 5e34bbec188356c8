//! What an environment shows its learner: frames drawn, laid out and stacked.

use crate::interface::insight::Insight;
use crate::options::{EnvOptions, Layout, ObservationKind};
use crate::single::lookout::{self, Ends, Seen};
use hasard_engine::render::{
    Buffers, FrameScratch, RenderOptions, Renderer, Scene, SegmentationColours, View,
};
use hasard_engine::world::World;
use std::cell::RefCell;
use std::sync::Arc;

thread_local! {
    /// What frames are drawn in. Each thread that steps environments owns one for all of them, so
    /// that it stays in a near cache.
    static SCRATCH: RefCell<FrameScratch> = RefCell::default();
}

/// Draws observations of one kind; owns the memory for that.
#[derive(Clone, Debug)]
pub(crate) struct Eye {
    renderer: Renderer,
    kind: ObservationKind,
    layout: Layout,
    colours: Arc<SegmentationColours>,
    /// Height, width, channels of one frame.
    frame: [usize; 3],
    /// Frames shown at a time.
    stack: usize,
    /// The last frames, where more than one is shown: a ring of equal parts.
    memory: Vec<u8>,
    /// The map's ends.
    ends: Ends,
    /// Part of the ring that the next frame goes to; it holds the oldest.
    oldest: usize,
}

impl Eye {
    pub fn new(
        scene: Arc<Scene>,
        view: Arc<View>,
        options: &EnvOptions,
        looks: RenderOptions,
        ends: Ends,
    ) -> Eye {
        let mut renderer = Renderer::new(scene, view);
        renderer.set_options(looks);
        let channels = options.observation.channels();
        let frame = [usize::from(options.size.height), usize::from(options.size.width), channels];
        let stack = options.frame_stack;
        let colours = if options.published_colours {
            SegmentationColours::published()
        } else {
            SegmentationColours::distinct()
        };
        Eye {
            renderer,
            kind: options.observation,
            layout: options.layout,
            colours: Arc::new(colours),
            frame,
            stack,
            memory: if stack > 1 {
                vec![0; stack * frame.iter().product::<usize>()]
            } else {
                Vec::new()
            },
            ends,
            oldest: 0,
        }
    }

    /// Shape of an observation.
    pub fn shape(&self) -> [usize; 3] {
        let [height, width, channels] = self.frame;
        match self.layout {
            Layout::Hwc => [height, width, channels * self.stack],
            Layout::Chw => [channels * self.stack, height, width],
        }
    }

    /// An episode begins: every frame of the stack shows its first moment.
    pub fn open(&mut self, world: &World) {
        if self.stack > 1 {
            self.blink(world);
            let size = self.memory.len() / self.stack;
            let newest = (self.oldest + self.stack - 1) % self.stack;
            for part in (0..self.stack).filter(|&part| part != newest) {
                self.memory.copy_within(newest * size..(newest + 1) * size, part * size);
            }
        }
    }

    /// A step is over: remembers what is seen now, if more than the present is shown.
    pub fn blink(&mut self, world: &World) {
        if self.stack > 1 {
            let size = self.memory.len() / self.stack;
            let mut memory = std::mem::take(&mut self.memory);
            let newest = self.oldest * size..(self.oldest + 1) * size;
            self.draw(world, &mut memory[newest], Insight::default(), &mut []);
            self.memory = memory;
            self.oldest = (self.oldest + 1) % self.stack;
        }
    }

    /// Writes the observation.
    pub fn observe(&mut self, world: &World, out: &mut [u8]) {
        let length = self.shape().iter().product::<usize>();
        assert_eq!(out.len(), length, "an observation of {length} bytes is needed");
        if self.stack == 1 {
            self.draw(world, out, Insight::default(), &mut []);
            return;
        }
        let size = self.memory.len() / self.stack;
        let frames = (0..self.stack).map(|i| (self.oldest + i) % self.stack * size);
        match self.layout {
            Layout::Chw => {
                for (start, to) in frames.zip(out.chunks_exact_mut(size)) {
                    to.copy_from_slice(&self.memory[start..start + size]);
                }
            }
            Layout::Hwc => {
                let channels = self.frame[2];
                for (i, start) in frames.enumerate() {
                    let pixels = self.memory[start..start + size].chunks_exact(channels);
                    for (to, pixel) in out.chunks_exact_mut(channels * self.stack).zip(pixels) {
                        to[i * channels..(i + 1) * channels].copy_from_slice(pixel);
                    }
                }
            }
        }
    }

    /// Writes the observation and what learners see beside it.
    pub fn observe_with(&mut self, world: &World, out: &mut [u8], what: Insight, row: &mut [u8]) {
        if self.stack == 1 {
            self.draw(world, out, what, row);
            return;
        }
        // The frames are drawn already, without what is asked for now.
        self.observe(world, out);
        let [depth, labels] = lookout::needs(what);
        let (ends, width) = (self.ends, self.frame[1]);
        SCRATCH.with_borrow_mut(|scratch| {
            self.renderer.render_then(scratch, world, 0, Buffers { depth, labels }, |renderer| {
                lookout::write(what, world, &ends, Seen { renderer, width }, row);
            });
        });
    }

    /// Draws one frame, and writes what else is asked for.
    fn draw(&mut self, world: &World, out: &mut [u8], what: Insight, row: &mut [u8]) {
        let [more_depth, more_labels] = lookout::needs(what);
        let depth = more_depth || self.kind == ObservationKind::RgbDepth;
        let labels = more_labels || self.kind == ObservationKind::Segmented;
        let (kind, layout, colours, ends) = (self.kind, self.layout, &self.colours, self.ends);
        let width = self.frame[1];
        let mut write = |renderer: &Renderer| match (kind, layout) {
            (ObservationKind::Rgb, Layout::Hwc) => renderer.write_rgb_hwc(out),
            (ObservationKind::Rgb, Layout::Chw) => renderer.write_rgb_chw(out),
            (ObservationKind::Grey, _) => renderer.write_grey(out),
            (ObservationKind::Segmented, Layout::Hwc) => renderer.write_segmented_hwc(colours, out),
            (ObservationKind::Segmented, Layout::Chw) => renderer.write_segmented_chw(colours, out),
            (ObservationKind::RgbDepth, Layout::Chw) => {
                let (colour, depth) = out.split_at_mut(out.len() / 4 * 3);
                renderer.write_rgb_chw(colour);
                renderer.write_depth(depth);
            }
            (ObservationKind::RgbDepth, Layout::Hwc) => renderer.write_rgb_depth_hwc(out),
        };
        let buffers = Buffers { depth, labels };
        SCRATCH.with_borrow_mut(|scratch| {
            self.renderer.render_then(scratch, world, 0, buffers, |renderer| {
                write(renderer);
                if what != Insight::default() {
                    lookout::write(what, world, &ends, Seen { renderer, width }, row);
                }
            });
        });
    }

    /// Draws the present with the wanted buffers, for tools that read them.
    pub fn render(&mut self, world: &World, buffers: Buffers) -> &Renderer {
        SCRATCH.with_borrow_mut(|scratch| self.renderer.render(scratch, world, 0, buffers));
        &self.renderer
    }

    /// The frames remembered, as part of a snapshot.
    pub fn memory(&self) -> (Vec<u8>, usize) {
        (self.memory.clone(), self.oldest)
    }

    /// Comes back to remembered frames.
    pub fn remember(&mut self, (memory, oldest): &(Vec<u8>, usize)) {
        self.memory.clone_from(memory);
        self.oldest = *oldest;
    }
}
