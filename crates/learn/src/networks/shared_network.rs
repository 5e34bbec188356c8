//! A network that several workers compute together, each on its own lanes.

use crate::networks::network::{LearningNetwork, NetworkWeights, Sequences};
use crate::networks::pixels::PixelScale;
use crate::networks::shape::NetworkShape;
use crate::team::Team;

/// A network of which this worker computes the lanes whose pixels it has: output rows are handed to
/// everyone, gradients are summed over all.
pub struct SharedNetwork {
    own: Box<dyn LearningNetwork>,
    team: Team,
}

impl SharedNetwork {
    /// What everyone computes with a network of its own.
    #[must_use]
    pub fn new(own: Box<dyn LearningNetwork>, team: Team) -> SharedNetwork {
        SharedNetwork { own, team }
    }

    /// Puts the output rows of a worker's lanes into those of all; false if they are none.
    fn place(&self, batch: &Sequences<'_>, part: &[u8], rows: &mut [f32]) -> bool {
        let (words, rest) = part.as_chunks::<4>();
        let Some((count, words)) = words.split_first().filter(|_| rest.is_empty()) else {
            return false;
        };
        let (count, width) = (u32::from_le_bytes(*count) as usize, self.own.shape().outputs());
        let Some((lanes, outputs)) = words.split_at_checked(count) else { return false };
        if outputs.len() != batch.steps * count * width {
            return false;
        }
        for (index, lane) in lanes.iter().map(|lane| u32::from_le_bytes(*lane) as usize).enumerate()
        {
            if lane >= batch.lanes {
                return false;
            }
            for step in 0..batch.steps {
                let from = &outputs[(step * count + index) * width..][..width];
                let to = &mut rows[(step * batch.lanes + lane) * width..][..width];
                to.iter_mut().zip(from).for_each(|(to, from)| *to = f32::from_le_bytes(*from));
            }
        }
        true
    }
}

/// The lanes whose pixels are here.
fn lanes_here(batch: &Sequences<'_>) -> Vec<usize> {
    (0..batch.lanes).filter(|&lane| !batch.observations[lane].is_empty()).collect()
}

impl LearningNetwork for SharedNetwork {
    fn shape(&self) -> &NetworkShape {
        self.own.shape()
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
        let lanes = lanes_here(batch);
        let part = batch.part(self.own.shape(), &lanes);
        let outputs = if lanes.is_empty() { Vec::new() } else { self.own.forward(&part) };
        let numbers = std::iter::once(lanes.len())
            .chain(lanes)
            .flat_map(|number| (number as u32).to_le_bytes());
        let bytes = numbers.chain(outputs.iter().flat_map(|output| output.to_le_bytes())).collect();
        let mut rows = vec![0.0; batch.rows() * self.own.shape().outputs()];
        // What cannot be exchanged is reported by the team once the rollout is learned from.
        let all = self.team.gather(bytes).unwrap_or_default();
        if !all.iter().all(|part| self.place(batch, part, &mut rows)) {
            self.team.break_off("a worker's outputs are not those of its lanes; start them all from one version of hasard");
        }
        rows
    }

    fn backward(&mut self, batch: &Sequences<'_>, output_gradient: &[f32], gradient: &mut [f32]) {
        let lanes = lanes_here(batch);
        if lanes.is_empty() {
            gradient.fill(0.0);
        } else {
            let width = self.own.shape().outputs();
            let own = batch
                .rows_of(&lanes)
                .flat_map(|row| &output_gradient[row * width..(row + 1) * width])
                .copied()
                .collect::<Vec<f32>>();
            self.own.backward(&batch.part(self.own.shape(), &lanes), &own, gradient);
        }
        self.team.sum(gradient);
    }
}
