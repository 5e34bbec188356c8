//! A convolution as products whose rows overlap in memory, so that no patch is ever copied where that can be helped.
//!
//! Where the kernel is a multiple of the stride, the input is stored as a grid of stride x stride blocks. The patch of
//! an output pixel is then, for each row of blocks, one contiguous run of numbers, and the runs of neighbouring pixels
//! start one block apart: a matrix with overlapping rows. At the end of each row of the grid this computes a few pixels
//! that do not exist; they are cheap, ignored going forward and zero going backward. Other convolutions copy patches.

use super::elementwise::NOWHERE;
use super::product::{Left, Right, Size, multiply};
use super::simd::Kernels;
use super::tile::PANEL;
use crate::config::Convolution;
use crate::networks::{EncoderLayer, ImageShape};

/// How an image is stored as the input of a convolution, and the sizes of the products.
#[derive(Clone, Debug)]
pub struct ConvolutionPlan {
    kernels: Kernels,
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
    /// The same for runs of pixels that stay together, as (first value in the image, first stored value), all of
    /// `run_length` values: bytes move faster a run at a time.
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
    pub fn new(kernels: Kernels, input: ImageShape, convolution: &Convolution) -> ConvolutionPlan {
        let output = input.after(convolution).expect("checked shape");
        let Convolution { kernel, stride, .. } = *convolution;
        let blocks = kernel.is_multiple_of(stride).then_some(kernel / stride);
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
                        ((y / stride) * grid_width + x / stride) * block_size + ((y % stride) * stride + x % stride) * channels
                    }
                });
            }
        }
        let (runs, run_length) = match blocks {
            // Rows of a block stay together; what lies beyond the last block is not read at all.
            Some(_) => {
                let starts = (0..grid_height * stride).flat_map(|y| (0..grid_width).map(move |x| (y, x * stride)));
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
            gradient_places: pixels().map(|(y, x)| (lead + y * grid_width + x) * output.channels).collect(),
            stored: if blocks.is_some() { grid_width * grid_height * block_size } else { input.size() },
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

    /// The plan of a layer of an encoder: `places` and `runs` speak of its image, without the border of zeros that the stored input has.
    #[must_use]
    pub fn of(kernels: Kernels, layer: &EncoderLayer) -> ConvolutionPlan {
        let (image, border) = (layer.image, layer.border);
        let around = image.bordered(border);
        let mut plan = ConvolutionPlan::new(kernels, around, &layer.convolution);
        if border > 0 {
            let rows = (0..image.height).map(|y| (y + border) * around.width + border);
            plan.places = rows.flat_map(|first| plan.places[first..first + image.width].to_vec()).collect();
            plan.runs = (0..).step_by(image.channels).zip(&plan.places).map(|(from, &to)| (from, to as u32)).collect();
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

    /// Numbers of the padded gradient of the raw result. What lies outside `gradient_places` must be zero.
    #[must_use]
    pub fn gradient_size(&self) -> usize {
        self.lead() * self.output.channels + self.raw_size()
    }

    /// Numbers of the scratch that patches are copied to; none for a plan in blocks.
    #[must_use]
    pub fn patch_size(&self) -> usize {
        if self.blocks.is_some() { 0 } else { self.output.height * self.output.width * self.depth() }
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
        self.weight_rows.iter().flat_map(|&row| &weights[row * channels..(row + 1) * channels]).copied().collect()
    }

    /// Weights for [`ConvolutionPlan::forward`].
    pub fn pack_forward(&self, weights: &[f32], packed: &mut [f32]) {
        super::pack::pack(&self.ordered(weights), self.depth(), self.output.channels, packed);
    }

    /// Weights for [`ConvolutionPlan::input_gradient`]; the same number of values.
    pub fn pack_backward(&self, weights: &[f32], packed: &mut [f32]) {
        let ordered = self.ordered(weights);
        let channels = self.output.channels;
        let Some(side) = self.blocks else {
            return super::pack::pack_transposed(&ordered, channels, self.depth(), packed);
        };
        // For each row of blocks a matrix from the gradients of `side` neighbouring pixels to one block.
        let block = self.block_size();
        let inner = side * channels;
        for (part, matrix) in packed.chunks_exact_mut(inner * block).enumerate() {
            for neighbour in 0..side {
                let rows = &ordered[(part * side + side - 1 - neighbour) * block * channels..][..block * channels];
                for (column, row) in rows.chunks_exact(channels).enumerate() {
                    let start = (column / PANEL) * inner * PANEL + neighbour * channels * PANEL + column % PANEL;
                    for (channel, value) in row.iter().enumerate() {
                        matrix[start + channel * PANEL] = *value;
                    }
                }
            }
        }
    }

    /// The raw result, biases and activation still missing.
    pub fn forward(&self, stored: &[f32], weights: &[f32], patches: &mut [f32], raw: &mut [f32]) {
        let (channels, depth) = (self.output.channels, self.depth());
        let Some(side) = self.blocks else {
            self.copy_patches(stored, patches);
            let size = Size { rows: self.output.height * self.output.width, columns: channels, inner: depth };
            let left = Left { data: patches, row_stride: depth, inner_stride: 1 };
            return multiply(self.kernels, size, left, Right::panels(weights, depth), raw, channels, false);
        };
        let inner = side * self.block_size();
        for part in 0..side {
            let left = Left {
                data: &stored[part * self.grid_width * self.block_size()..],
                row_stride: self.block_size(),
                inner_stride: 1,
            };
            let right = Right { data: &weights[part * inner * PANEL..], panel_stride: depth * PANEL, inner_stride: PANEL };
            let size = Size { rows: self.rows(), columns: channels, inner };
            multiply(self.kernels, size, left, right, raw, channels, part > 0);
        }
    }

    /// Adds the gradient of the weights, in the order of the stored input. `patches` is scratch.
    pub fn weight_gradient(&self, stored: &[f32], patches: &mut [f32], gradient: &[f32], weights: &mut [f32]) {
        let (channels, depth) = (self.output.channels, self.depth());
        let right = Right::rows(&gradient[self.lead() * channels..], channels);
        let Some(side) = self.blocks else {
            self.copy_patches(stored, patches);
            let size = Size { rows: depth, columns: channels, inner: self.output.height * self.output.width };
            let left = Left { data: patches, row_stride: 1, inner_stride: depth };
            return multiply(self.kernels, size, left, right, weights, channels, true);
        };
        let rows = side * self.block_size();
        for part in 0..side {
            let left = Left {
                data: &stored[part * self.grid_width * self.block_size()..],
                row_stride: 1,
                inner_stride: self.block_size(),
            };
            let size = Size { rows, columns: channels, inner: self.rows() };
            multiply(self.kernels, size, left, right, &mut weights[part * rows * channels..], channels, true);
        }
    }

    /// Brings a weight gradient back into canonical order, adding it to `canonical`.
    pub fn unorder(&self, ordered: &[f32], canonical: &mut [f32]) {
        let channels = self.output.channels;
        for (&row, values) in self.weight_rows.iter().zip(ordered.chunks_exact(channels)) {
            super::elementwise::add(self.kernels, &mut canonical[row * channels..(row + 1) * channels], values);
        }
    }

    /// The gradient of the stored input. `patches` is scratch.
    pub fn input_gradient(&self, gradient: &[f32], weights: &[f32], patches: &mut [f32], stored: &mut [f32]) {
        let (channels, depth) = (self.output.channels, self.depth());
        let Some(side) = self.blocks else {
            let size = Size { rows: self.output.height * self.output.width, columns: depth, inner: channels };
            let left = Left { data: gradient, row_stride: channels, inner_stride: 1 };
            multiply(self.kernels, size, left, Right::panels(weights, channels), patches, depth, false);
            return self.add_patches(patches, stored);
        };
        let (inner, block) = (side * channels, self.block_size());
        for part in 0..side {
            // Block b receives from the pixels b - part * grid_width - (0..side): they are contiguous, the farthest first.
            // Rows of blocks above the first such pixel or below the last receive nothing.
            let right = Right::panels(&weights[part * inner * block..(part + 1) * inner * block], inner);
            let mut receive = |from: usize, to: usize, accumulate: bool| {
                let size = Size { rows: (to - from) * self.grid_width, columns: block, inner };
                let first = self.lead() + (from - part) * self.grid_width - (side - 1);
                let left = Left { data: &gradient[first * channels..], row_stride: channels, inner_stride: 1 };
                multiply(self.kernels, size, left, right, &mut stored[from * self.grid_width * block..], block, accumulate);
            };
            // All but the last of them were reached by the part before already.
            let fresh = if part == 0 { 0 } else { part + self.output.height - 1 };
            receive(part, fresh, part > 0);
            receive(fresh, part + self.output.height, false);
        }
    }

    fn patch_rows(&self) -> impl Iterator<Item = (usize, usize)> {
        let run = self.kernel * self.input.channels;
        let (width, channels, kernel, stride) = (self.input.width, self.input.channels, self.kernel, self.stride);
        let (rows, columns) = (self.output.height, self.output.width);
        (0..rows * columns * kernel).map(move |index| {
            let (pixel, ky) = (index / kernel, index % kernel);
            let (y, x) = (pixel / columns * stride + ky, pixel % columns * stride);
            ((y * width + x) * channels, index * run)
        })
    }

    fn copy_patches(&self, stored: &[f32], patches: &mut [f32]) {
        let run = self.kernel * self.input.channels;
        for (from, to) in self.patch_rows() {
            patches[to..to + run].copy_from_slice(&stored[from..from + run]);
        }
    }

    fn add_patches(&self, patches: &[f32], stored: &mut [f32]) {
        let run = self.kernel * self.input.channels;
        stored.fill(0.0);
        for (to, from) in self.patch_rows() {
            super::elementwise::add(self.kernels, &mut stored[to..to + run], &patches[from..from + run]);
        }
    }
}
