//! A convolution as products whose rows overlap in memory, so that no patch is ever copied.
//!
//! Where the kernel is a multiple of the stride, the input is stored as a grid of stride x stride
//! blocks. The patch of an output pixel is then, for each row of blocks, one contiguous run of
//! numbers, and the runs of neighbouring pixels start one block apart: a matrix with overlapping
//! rows. At the end of each row of the grid this computes a few pixels that do not exist; they are
//! cheap, ignored going forward and zero going backward.
//!
//! Others, and all in bfloat16, read their patches out of the image as it is: a patch is a run of
//! numbers in each of some of its rows, and both the pixels of a row and those runs are as far
//! apart as the shapes say.
//!
//! Long because forward and both backward passes share one layout in memory, explained once.

use hasard_engine::simd::Simd;

use crate::config::Convolution;
use crate::networks::cpu::bfloat16::{
    Pair, halves, pair_rows, pair_with_distant, pair_with_zeros, round,
};
use crate::networks::cpu::elementwise::NOWHERE;
use crate::networks::cpu::panels::Panels;
use crate::networks::cpu::product::{
    Axis, Factor, Grouped, Left, Right, Size, add_to_overlapping_rows, multiply, multiply_grouped,
};
use crate::networks::cpu::tile::PANEL;
use crate::networks::{EncoderLayer, ImageShape};

/// The stored input of a convolution.
#[derive(Clone, Copy)]
pub enum Stored<'a> {
    /// Numbers of 32 bits.
    Numbers(&'a [f32]),
    /// Rounded ones, with [`ConvolutionPlan::rounded`] numbers in all.
    Rounded(&'a [u16]),
}

/// What is rounded on its way into products; unused by other families.
#[derive(Default)]
pub struct Rounded {
    image: Vec<u16>,
    image_pairs: Vec<Pair>,
    gradient: Vec<u16>,
    gradient_pairs: Vec<Pair>,
}

/// How an image is stored as the input of a convolution, and the sizes of the products.
#[derive(Clone, Debug)]
pub struct ConvolutionPlan {
    kernels: Simd,
    input: ImageShape,
    output: ImageShape,
    kernel: usize,
    stride: usize,
    /// Kernel side in blocks if the input is stored in blocks.
    blocks: Option<usize>,
    grid_width: usize,
    grid_height: usize,
    /// Where each input pixel is stored, or [`NOWHERE`].
    pub places: Vec<usize>,
    /// The same for runs of pixels that stay together, as (first value in the image, first stored
    /// value), all of `run_length` values: bytes move faster a run at a time.
    pub runs: Vec<(u32, u32)>,
    /// Values of a run.
    pub run_length: usize,
    /// Numbers of the stored input.
    pub stored: usize,
    /// Where each output pixel lies in the raw result.
    pub raw_places: Vec<usize>,
    /// Where each output pixel lies in the padded gradient of the raw result.
    pub gradient_places: Vec<usize>,
    /// For each row of the stored weights, the row of the canonical ones.
    weight_rows: Vec<usize>,
}

impl ConvolutionPlan {
    /// The plan for a convolution on an image that it fits on.
    #[must_use]
    pub fn new(kernels: Simd, input: ImageShape, convolution: &Convolution) -> ConvolutionPlan {
        let output = input.after(convolution).expect("checked shape");
        let Convolution { kernel, stride, .. } = *convolution;
        let in_blocks = kernel.is_multiple_of(stride) && !kernels.family().rounds();
        let blocks = in_blocks.then_some(kernel / stride);
        let (grid_width, grid_height) = match blocks {
            Some(side) => (output.width - 1 + side, output.height - 1 + side),
            None => (output.width, output.height),
        };
        let channels = input.channels;
        let block_size = stride * stride * channels;
        let mut places = Vec::with_capacity(input.height * input.width);
        for y in 0..input.height {
            for x in 0..input.width {
                places.push(match blocks {
                    None => (y * input.width + x) * channels,
                    Some(_) if y / stride >= grid_height || x / stride >= grid_width => NOWHERE,
                    Some(_) => {
                        ((y / stride) * grid_width + x / stride) * block_size
                            + ((y % stride) * stride + x % stride) * channels
                    }
                });
            }
        }
        let (runs, run_length) = match blocks {
            // Rows of a block stay together; what lies beyond the last block is not read at all.
            Some(_) => {
                let starts = (0..grid_height * stride)
                    .flat_map(|y| (0..grid_width).map(move |x| (y, x * stride)));
                let inside = starts.filter(|&(y, x)| y < input.height && x + stride <= input.width);
                let run = |(y, x): (usize, usize)| {
                    let pixel = y * input.width + x;
                    ((pixel * channels) as u32, places[pixel] as u32)
                };
                (inside.map(run).collect(), stride * channels)
            }
            None => (vec![(0, 0)], input.size()),
        };
        let mut weight_rows = Vec::with_capacity(kernel * kernel * channels);
        match blocks {
            None => weight_rows.extend(0..kernel * kernel * channels),
            Some(side) => {
                for (block_y, block_x) in (0..side).flat_map(|y| (0..side).map(move |x| (y, x))) {
                    for (dy, dx) in (0..stride).flat_map(|y| (0..stride).map(move |x| (y, x))) {
                        let pixel = (block_y * stride + dy) * kernel + block_x * stride + dx;
                        weight_rows.extend((0..channels).map(|channel| pixel * channels + channel));
                    }
                }
            }
        }
        let lead = blocks.map_or(0, |side| (side - 1) * (grid_width + 1));
        let pixels = || (0..output.height).flat_map(|y| (0..output.width).map(move |x| (y, x)));
        ConvolutionPlan {
            kernels,
            raw_places: pixels().map(|(y, x)| (y * grid_width + x) * output.channels).collect(),
            gradient_places: pixels()
                .map(|(y, x)| (lead + y * grid_width + x) * output.channels)
                .collect(),
            stored: if blocks.is_some() {
                grid_width * grid_height * block_size
            } else {
                input.size()
            },
            input,
            output,
            kernel,
            stride,
            blocks,
            grid_width,
            grid_height,
            places,
            runs,
            run_length,
            weight_rows,
        }
    }

    /// The plan of a layer of an encoder: `places` and `runs` speak of its image, without the
    /// border of zeros that the stored input has.
    #[must_use]
    pub fn of(kernels: Simd, layer: &EncoderLayer) -> ConvolutionPlan {
        let (image, border) = (layer.image, layer.border);
        let around = image.bordered(border);
        let mut plan = ConvolutionPlan::new(kernels, around, &layer.convolution);
        if border > 0 {
            let rows = (0..image.height).map(|y| (y + border) * around.width + border);
            plan.places =
                rows.flat_map(|first| plan.places[first..first + image.width].to_vec()).collect();
            plan.runs = (0..)
                .step_by(image.channels)
                .zip(&plan.places)
                .map(|(from, &to)| (from, to as u32))
                .collect();
            plan.run_length = image.channels;
        }
        plan
    }

    /// Channels of the output.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.output.channels
    }

    /// Terms of each sum: kernel pixels times channels.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.weight_rows.len()
    }

    /// Numbers of the raw result.
    #[must_use]
    pub fn raw_size(&self) -> usize {
        self.grid_width * self.grid_height * self.output.channels
    }

    /// Numbers of the padded gradient of the raw result. What lies outside `gradient_places` must
    /// be zero.
    #[must_use]
    pub fn gradient_size(&self) -> usize {
        self.lead() * self.output.channels + self.raw_size()
    }

    /// Numbers of a rounded input: what follows the image is read beside weights of zero.
    #[must_use]
    pub fn rounded(&self) -> usize {
        self.input.size() + self.stride * self.input.channels + 2
    }

    fn lead(&self) -> usize {
        self.blocks.map_or(0, |side| (side - 1) * (self.grid_width + 1))
    }

    fn block_size(&self) -> usize {
        self.stride * self.stride * self.input.channels
    }

    /// Rows of the products of a plan in blocks: up to the last pixel that exists.
    fn rows(&self) -> usize {
        (self.output.height - 1) * self.grid_width + self.output.width
    }

    /// Canonical weights in the order of the stored input, one row an input.
    fn ordered(&self, weights: &[f32]) -> Vec<f32> {
        let channels = self.output.channels;
        self.weight_rows
            .iter()
            .flat_map(|&row| &weights[row * channels..(row + 1) * channels])
            .copied()
            .collect()
    }

    /// Values of a kernel's row.
    fn run(&self) -> usize {
        self.kernel * self.input.channels
    }

    /// The pixels of the output as they are found in the image, whose numbers are `unit` halves or
    /// numbers long.
    fn pixels(&self, unit: usize) -> Axis {
        let (across, down) = (
            self.stride * self.input.channels,
            self.stride * self.input.width * self.input.channels,
        );
        Axis {
            count: self.output.width,
            stride: unit * across,
            groups: self.output.height,
            group_stride: unit * down,
        }
    }

    /// The numbers of a patch, `count` in each of the kernel's rows.
    fn patch(&self, count: usize, stride: usize, unit: usize) -> Axis {
        Axis {
            count,
            stride,
            groups: self.kernel,
            group_stride: unit * self.input.width * self.input.channels,
        }
    }

    /// Weights for [`ConvolutionPlan::forward`].
    pub fn pack_forward(&self, weights: &[f32], packed: &mut Panels) {
        packed.pack_runs(self.kernels, &self.ordered(weights), self.run(), self.output.channels);
    }

    /// Weights for [`ConvolutionPlan::input_gradient`].
    pub fn pack_backward(&self, weights: &[f32], packed: &mut Panels) {
        let ordered = self.ordered(weights);
        let channels = self.output.channels;
        let Some(side) = self.blocks else {
            return packed.pack_transposed(self.kernels, &ordered, channels, self.depth());
        };
        let packed = packed.numbers(weights.len());
        // For each row of blocks a matrix from the gradients of `side` neighbouring pixels to one
        // block.
        let block = self.block_size();
        let inner = side * channels;
        for (part, matrix) in packed.chunks_exact_mut(inner * block).enumerate() {
            for neighbour in 0..side {
                let rows = &ordered[(part * side + side - 1 - neighbour) * block * channels..]
                    [..block * channels];
                for (column, row) in rows.chunks_exact(channels).enumerate() {
                    let start = (column / PANEL) * inner * PANEL
                        + neighbour * channels * PANEL
                        + column % PANEL;
                    for (channel, value) in row.iter().enumerate() {
                        matrix[start + channel * PANEL] = *value;
                    }
                }
            }
        }
    }

    /// The rounded input: as it is, or made of numbers.
    fn round<'a>(&self, stored: Stored<'a>, rounded: &'a mut Vec<u16>) -> &'a [u16] {
        match stored {
            Stored::Rounded(image) => image,
            Stored::Numbers(image) => {
                rounded.resize(self.rounded(), 0);
                let (numbers, rest) = rounded.split_at_mut(self.input.size());
                round(self.kernels, &image[..self.input.size()], numbers);
                rest.fill(0);
                rounded
            }
        }
    }

    /// The raw result, biases and activation still missing.
    pub fn forward(
        &self,
        stored: Stored<'_>,
        weights: &Panels,
        rounded: &mut Rounded,
        raw: &mut [f32],
    ) {
        let (kernels, channels, depth) = (self.kernels, self.output.channels, self.depth());
        let weights = match weights {
            Panels::Numbers(weights) => weights,
            Panels::Pairs(weights) => {
                let run = self.run().div_ceil(2);
                let data = self.round(stored, &mut rounded.image);
                let left = Grouped { data, rows: self.pixels(1), inner: self.patch(run, 2, 1) };
                let right = Right::panels(&weights[..], self.kernel * run);
                return multiply_grouped(kernels, left, right, channels, raw, channels, false);
            }
        };
        let Stored::Numbers(stored) = stored else { unreachable!("rounded only for pairs") };
        let Some(side) = self.blocks else {
            let left =
                Grouped { data: stored, rows: self.pixels(1), inner: self.patch(self.run(), 1, 1) };
            return multiply_grouped(
                kernels,
                left,
                Right::panels(&weights[..], depth),
                channels,
                raw,
                channels,
                false,
            );
        };
        let inner = side * self.block_size();
        for part in 0..side {
            let left = Left {
                data: &stored[part * self.grid_width * self.block_size()..],
                row_stride: self.block_size(),
                inner_stride: 1,
            };
            let right = Right {
                data: &weights[part * inner * PANEL..],
                panel_stride: depth * PANEL,
                inner_stride: PANEL,
            };
            let size = Size { rows: self.rows(), columns: channels, inner };
            multiply(kernels, size, left, right, raw, channels, part > 0);
        }
    }

    /// Adds the gradient of the weights, in the order of the stored input.
    pub fn weight_gradient(
        &self,
        stored: Stored<'_>,
        gradient: &[f32],
        rounded: &mut Rounded,
        weights: &mut [f32],
    ) {
        let (kernels, channels) = (self.kernels, self.output.channels);
        if kernels.family().rounds() {
            return self.weight_gradient_of_pairs(stored, gradient, rounded, weights);
        }
        let Stored::Numbers(stored) = stored else { unreachable!("rounded only for pairs") };
        let right = Right::rows(&gradient[self.lead() * channels..], channels);
        let Some(side) = self.blocks else {
            let left =
                Grouped { data: stored, rows: self.patch(self.run(), 1, 1), inner: self.pixels(1) };
            return multiply_grouped(kernels, left, right, channels, weights, channels, true);
        };
        let rows = side * self.block_size();
        for part in 0..side {
            let left = Left {
                data: &stored[part * self.grid_width * self.block_size()..],
                row_stride: 1,
                inner_stride: self.block_size(),
            };
            let size = Size { rows, columns: channels, inner: self.rows() };
            multiply(
                kernels,
                size,
                left,
                right,
                &mut weights[part * rows * channels..],
                channels,
                true,
            );
        }
    }

    /// The inner dimension are the pixels of the output, two that are neighbours in a row together;
    /// the last of an odd number has none beside it.
    fn weight_gradient_of_pairs(
        &self,
        stored: Stored<'_>,
        gradient: &[f32],
        rounded: &mut Rounded,
        weights: &mut [f32],
    ) {
        let (kernels, channels, width) = (self.kernels, self.output.channels, self.output.width);
        let both = width.div_ceil(2);
        let across = self.stride * self.input.channels;
        let Rounded { image, image_pairs, gradient_pairs, .. } = rounded;
        let image = self.round(stored, image);
        image_pairs.resize(image.len() - across, 0);
        pair_with_distant(kernels, image, across, image_pairs);
        gradient_pairs.resize(self.output.height * both * channels, 0);
        let rows = gradient
            .chunks_exact(width * channels)
            .zip(gradient_pairs.chunks_exact_mut(both * channels));
        for (row, pairs) in rows {
            for (pixels, pairs) in row.chunks(2 * channels).zip(pairs.chunks_exact_mut(channels)) {
                match pixels.split_at(channels) {
                    (first, []) => pair_with_zeros(kernels, first, pairs),
                    (first, second) => pair_rows(kernels, first, second, pairs),
                }
            }
        }
        let pixels = Axis { count: both, stride: 2 * 2 * across, ..self.pixels(2) };
        let left = Grouped {
            data: halves(image_pairs),
            rows: self.patch(self.run(), 2, 2),
            inner: pixels,
        };
        let right = Right::rows(&gradient_pairs[..], channels);
        multiply_grouped(kernels, left, right, channels, weights, channels, true);
    }

    /// Brings a weight gradient back into canonical order, adding it to `canonical`.
    pub fn unorder(&self, ordered: &[f32], canonical: &mut [f32]) {
        let channels = self.output.channels;
        for (&row, values) in self.weight_rows.iter().zip(ordered.chunks_exact(channels)) {
            super::elementwise::add(
                self.kernels,
                &mut canonical[row * channels..(row + 1) * channels],
                values,
            );
        }
    }

    /// The gradient of the stored input.
    pub fn input_gradient(
        &self,
        gradient: &[f32],
        weights: &Panels,
        rounded: &mut Rounded,
        stored: &mut [f32],
    ) {
        let channels = self.output.channels;
        let weights = match weights {
            Panels::Numbers(weights) => weights,
            Panels::Pairs(weights) => {
                rounded.gradient.resize(gradient.len(), 0);
                round(self.kernels, gradient, &mut rounded.gradient);
                return self.add_patches::<u16>(
                    &rounded.gradient,
                    weights,
                    channels / 2,
                    2,
                    stored,
                );
            }
        };
        let Some(side) = self.blocks else {
            return self.add_patches::<f32>(gradient, weights, channels, 1, stored);
        };
        let (inner, block) = (side * channels, self.block_size());
        for part in 0..side {
            // Block b receives from the pixels b - part * grid_width - (0..side): they are
            // contiguous, the farthest first. Rows of blocks above the first such pixel or below
            // the last receive nothing.
            let right =
                Right::panels(&weights[part * inner * block..(part + 1) * inner * block], inner);
            let mut receive = |from: usize, to: usize, accumulate: bool| {
                let size = Size { rows: (to - from) * self.grid_width, columns: block, inner };
                let first = self.lead() + (from - part) * self.grid_width - (side - 1);
                let left = Left {
                    data: &gradient[first * channels..],
                    row_stride: channels,
                    inner_stride: 1,
                };
                multiply(
                    self.kernels,
                    size,
                    left,
                    right,
                    &mut stored[from * self.grid_width * block..],
                    block,
                    accumulate,
                );
            };
            // All but the last of them were reached by the part before already.
            let fresh = if part == 0 { 0 } else { part + self.output.height - 1 };
            receive(part, fresh, part > 0);
            receive(fresh, part + self.output.height, false);
        }
    }

    /// Adds the gradients of all patches to the image, pixel by pixel of the output.
    fn add_patches<T: Factor>(
        &self,
        gradient: &[T],
        weights: &[T::Right],
        inner: usize,
        inner_stride: usize,
        stored: &mut [f32],
    ) {
        let (channels, run) = (self.output.channels, self.run());
        let (across, down) =
            (self.stride * self.input.channels, self.input.width * self.input.channels);
        stored[..self.input.size()].fill(0.0);
        for (y, row) in
            gradient[..self.output.size()].chunks_exact(self.output.width * channels).enumerate()
        {
            let (rows, inner) =
                (Axis::plain(self.output.width, channels), Axis::plain(inner, inner_stride));
            for (ky, weights) in weights.chunks_exact(run * inner.count).enumerate() {
                let (left, right) =
                    (Grouped { data: row, rows, inner }, Right::panels(weights, inner.count));
                let to = &mut stored[(y * self.stride + ky) * down..self.input.size()];
                add_to_overlapping_rows(self.kernels, left, right, run, to, across);
            }
        }
    }
}
