//! Left and right learned at once: a network that sees each picture and its mirror image, and whose
//! outputs are the means of what it says of both.
//!
//! A world of which left and right are exchanged asks for the same actions with left and right
//! exchanged, and returns as much. A policy that is built so, pi(ga | gs) = pi(a | s) for the
//! reflection g (van der Pol et al. 2020, arXiv 2006.16908), need not learn both sides apart. Here it
//! is the mean over the group of what any network says, for two passes in place of one. Each lane is
//! two of that network, side by side, each with a state of its own.

use crate::config::Reflected;
use crate::networks::layers::ImageShape;
use crate::networks::network::{
    ActingNetwork, LearningNetwork, NetworkWeights, Place, RecordedLane, Sequences,
};
use crate::networks::pixels::PixelScale;
use crate::networks::shape::NetworkShape;

/// Writes the mirror image of a picture.
fn mirror(image: ImageShape, from: &[u8], to: &mut [u8]) {
    let row = image.width * image.channels;
    for (to, from) in to.chunks_exact_mut(row).zip(from.chunks_exact(row)) {
        match image.channels {
            1 => mirror_row::<1>(from, to),
            3 => mirror_row::<3>(from, to),
            4 => mirror_row::<4>(from, to),
            channels => {
                let pixels = from.chunks_exact(channels).rev();
                to.chunks_exact_mut(channels)
                    .zip(pixels)
                    .for_each(|(to, from)| to.copy_from_slice(from));
            }
        }
    }
}

fn mirror_row<const CHANNELS: usize>(from: &[u8], to: &mut [u8]) {
    let (from, to) = (from.as_chunks::<CHANNELS>().0, to.as_chunks_mut::<CHANNELS>().0);
    to.iter_mut().zip(from.iter().rev()).for_each(|(to, from)| *to = *from);
}

/// The means of two rows each: of a picture, and of its mirror image.
fn means(reflected: &[Reflected], twice: &[f32], rows: &mut [f32]) {
    let width = reflected.len();
    for (row, pair) in rows.chunks_exact_mut(width).zip(twice.chunks_exact(2 * width)) {
        let (seen, mirrored) = pair.split_at(width);
        for ((out, seen), other) in row.iter_mut().zip(seen).zip(reflected) {
            *out = 0.5 * (seen + other.sign() * mirrored[other.column]);
        }
    }
}

/// The gradient of both rows from that of their means.
fn spread(reflected: &[Reflected], rows: &[f32]) -> Vec<f32> {
    let width = reflected.len();
    let mut twice = vec![0.0; 2 * rows.len()];
    for (row, pair) in rows.chunks_exact(width).zip(twice.chunks_exact_mut(2 * width)) {
        let (seen, mirrored) = pair.split_at_mut(width);
        for ((value, seen), other) in row.iter().zip(seen).zip(reflected) {
            *seen = 0.5 * value;
            mirrored[other.column] = 0.5 * other.sign() * value;
        }
    }
    twice
}

/// Each number of a row twice, one row after the other.
fn twice(values: &[f32], width: usize) -> Vec<f32> {
    values.chunks_exact(width.max(1)).flat_map(|row| [row, row]).flatten().copied().collect()
}

/// A mirrored network that learns.
pub struct MirroredLearner {
    shape: NetworkShape,
    own: Box<dyn LearningNetwork>,
    /// Mirror images of the last forward pass, row by row.
    images: Vec<u8>,
}

impl MirroredLearner {
    /// The mirrored network of a shape, around one of its plain shape.
    #[must_use]
    pub fn new(shape: &NetworkShape, own: Box<dyn LearningNetwork>) -> MirroredLearner {
        MirroredLearner { shape: shape.clone(), own, images: Vec::new() }
    }

    /// The batch with each lane twice.
    fn doubled<'b>(&self, batch: &Sequences<'b>, images: &'b [u8]) -> Sequences<'b> {
        let images = images.chunks_exact(self.shape.image.size());
        let recorded = batch.recorded.iter().flat_map(|lane| {
            [2 * lane.lane, 2 * lane.lane + 1]
                .map(|own| RecordedLane { recording: lane.recording, lane: own })
        });
        Sequences {
            steps: batch.steps,
            lanes: 2 * batch.lanes,
            observations: batch
                .observations
                .iter()
                .zip(images)
                .flat_map(|(&seen, image)| [seen, image])
                .collect(),
            extra: twice(&batch.extra, self.shape.extra_inputs),
            initial_state: batch.initial_state.clone(),
            reset: batch.reset.iter().flat_map(|&reset| [reset, reset]).collect(),
            recorded: recorded.collect(),
        }
    }
}

impl LearningNetwork for MirroredLearner {
    fn shape(&self) -> &NetworkShape {
        &self.shape
    }

    fn load(&mut self, parameters: &[f32]) {
        self.own.load(parameters);
    }

    fn load_pixels(&mut self, pixels: &PixelScale) {
        self.own.load_pixels(pixels);
    }

    fn publish(&self) -> NetworkWeights {
        self.own.publish()
    }

    fn forward(&mut self, batch: &Sequences<'_>) -> Vec<f32> {
        let mut images = std::mem::take(&mut self.images);
        let pixels = self.shape.image.size();
        images.resize(batch.rows() * pixels, 0);
        for (image, seen) in images.chunks_exact_mut(pixels).zip(&batch.observations) {
            mirror(self.shape.image, seen, image);
        }
        let outputs = self.own.forward(&self.doubled(batch, &images));
        self.images = images;
        let mut rows = vec![0.0; outputs.len() / 2];
        means(&self.shape.mirror, &outputs, &mut rows);
        rows
    }

    fn backward(&mut self, batch: &Sequences<'_>, output_gradient: &[f32], gradient: &mut [f32]) {
        let images = std::mem::take(&mut self.images);
        let rows = spread(&self.shape.mirror, output_gradient);
        self.own.backward(&self.doubled(batch, &images), &rows, gradient);
        self.images = images;
    }
}

/// A mirrored network that acts.
pub struct MirroredActor {
    shape: NetworkShape,
    own: Box<dyn ActingNetwork>,
    images: Vec<u8>,
    outputs: Vec<f32>,
}

impl MirroredActor {
    /// The mirrored network of a shape, around one of its plain shape.
    #[must_use]
    pub fn new(shape: &NetworkShape, own: Box<dyn ActingNetwork>) -> MirroredActor {
        MirroredActor { shape: shape.clone(), own, images: Vec::new(), outputs: Vec::new() }
    }
}

impl ActingNetwork for MirroredActor {
    fn load(&mut self, weights: &NetworkWeights) {
        self.own.load(weights);
    }

    fn act(
        &mut self,
        observations: &[u8],
        extra: &[f32],
        state: &mut [f32],
        outputs: &mut [f32],
        place: Option<Place<'_>>,
    ) {
        let pixels = self.shape.image.size();
        self.images.resize(2 * observations.len(), 0);
        for (seen, pair) in
            observations.chunks_exact(pixels).zip(self.images.chunks_exact_mut(2 * pixels))
        {
            let (own, image) = pair.split_at_mut(pixels);
            own.copy_from_slice(seen);
            mirror(self.shape.image, seen, image);
        }
        self.outputs.resize(2 * outputs.len(), 0.0);
        let place = place.map(|place| Place {
            all_lanes: 2 * place.all_lanes,
            lanes: 2 * place.lanes.start..2 * place.lanes.end,
            ..place
        });
        let extra = twice(extra, self.shape.extra_inputs);
        self.own.act(&self.images, &extra, state, &mut self.outputs, place);
        means(&self.shape.mirror, &self.outputs, outputs);
    }
}

#[cfg(test)]
mod tests;
