//! Weights in the order that the kernels read them in.

use crate::networks::cpu::convolution::ConvolutionPlan;
use crate::networks::cpu::elementwise::NOWHERE;
use crate::networks::cpu::panels::Panels;
use crate::networks::cpu::tile::PANEL;
use crate::networks::{EncoderLayer, NetworkShape, Parameter, PixelScale};
use crate::threads::Piece;
use hasard_engine::simd::Simd;

/// What follows from a shape once and for all: plans of the convolutions, places of parameters.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What computes it.
    pub kernels: Simd,
    /// The shape.
    pub shape: NetworkShape,
    /// The convolutions of the encoder.
    pub layers: Vec<EncoderLayer>,
    /// A plan for each of them.
    pub convolutions: Vec<ConvolutionPlan>,
    /// The table of parameters.
    pub parameters: Vec<Parameter>,
    /// Values that the encoder hands to the first dense layer.
    pub features: usize,
    /// Width of the output rows inside: the outputs rounded up to whole panels.
    pub padded_outputs: usize,
}

impl Plan {
    /// The plan of a checked shape.
    #[must_use]
    pub fn new(kernels: Simd, shape: &NetworkShape) -> Plan {
        let layers = shape.encoder_layers();
        Plan {
            kernels,
            convolutions: layers.iter().map(|layer| ConvolutionPlan::of(kernels, layer)).collect(),
            layers,
            parameters: shape.parameters(),
            features: shape.features(),
            padded_outputs: shape.outputs().next_multiple_of(PANEL),
            shape: shape.clone(),
        }
    }

    /// Weights of convolution `index`; its biases follow at one more.
    #[must_use]
    pub fn convolution(&self, index: usize) -> &Parameter {
        &self.parameters[2 * index]
    }

    /// Weights of dense layer `index`; its biases follow.
    #[must_use]
    pub fn dense(&self, index: usize) -> &Parameter {
        &self.parameters[2 * (self.convolutions.len() + index)]
    }

    /// Parameter after another one in the table: the biases of a layer.
    #[must_use]
    pub fn after(&self, parameter: &Parameter) -> &Parameter {
        let at = self
            .parameters
            .iter()
            .position(|other| other.offset == parameter.offset)
            .expect("from this table");
        &self.parameters[at + 1]
    }

    /// The four parameters of the recurrent layer: input weights and biases, hidden weights and
    /// biases.
    #[must_use]
    pub fn cell(&self) -> [&Parameter; 4] {
        let first = 2 * (self.convolutions.len() + self.shape.dense.len());
        [0, 1, 2, 3].map(|index| &self.parameters[first + index])
    }

    /// Weights of head `index`; its biases follow.
    #[must_use]
    pub fn head(&self, index: usize) -> &Parameter {
        let cell = if self.shape.recurrent.is_some() { 4 } else { 0 };
        &self.parameters[2 * (self.convolutions.len() + self.shape.dense.len() + index) + cell]
    }
}

/// Everything that the kernels read, made from the flat parameters by [`PackedWeights::load`].
#[derive(Clone, Debug, Default)]
pub struct PackedWeights {
    /// Convolutions, forward.
    pub convolutions: Vec<Panels>,
    /// Dense layers, forward.
    pub dense: Vec<Panels>,
    /// Recurrent layer, from its input.
    pub cell_input: Panels,
    /// Recurrent layer, from its output before.
    pub cell_hidden: Panels,
    /// All heads side by side, columns padded to whole panels.
    pub heads: Panels,
    /// Biases: of the convolutions, of the dense layers.
    pub convolution_biases: Vec<Vec<f32>>,
    /// Biases of the dense layers.
    pub dense_biases: Vec<Vec<f32>>,
    /// Biases of the recurrent layer: with the input's product, with the output's.
    pub cell_biases: [Vec<f32>; 2],
    /// Biases of the heads, padded.
    pub head_biases: Vec<f32>,
}

/// Transposed weights, which carry gradients back: learners alone need them.
#[derive(Clone, Debug, Default)]
pub struct Backward {
    /// Convolutions; the first is empty, for nothing flows into the image.
    pub convolutions: Vec<Panels>,
    /// Dense layers; empty where nothing flows further back.
    pub dense: Vec<Panels>,
    /// Recurrent layer, to its input (without the extra inputs).
    pub cell_input: Panels,
    /// Recurrent layer, to its output before.
    pub cell_hidden: Panels,
    /// Heads.
    pub heads: Panels,
}

impl PackedWeights {
    /// Packs `parameters`, reusing this value's memory.
    pub fn load(&mut self, plan: &Plan, parameters: &[f32]) {
        self.loading(plan, parameters).into_iter().for_each(|piece| piece(&mut ()));
    }

    /// The same as pieces of work: one a layer, and one for the heads.
    pub fn loading<'a, S>(
        &'a mut self,
        plan: &'a Plan,
        parameters: &'a [f32],
    ) -> Vec<Piece<'a, S>> {
        let (kernels, shape) = (plan.kernels, &plan.shape);
        let mut pieces: Vec<Piece<'a, S>> = Vec::new();
        if let Some(units) = shape.recurrent {
            let [input, input_bias, hidden, hidden_bias] = plan.cell();
            let (inputs, columns) = (shape.core_inputs(), shape.gate_columns());
            let (from_input, from_hidden) = (&mut self.cell_input, &mut self.cell_hidden);
            copy(&mut self.cell_biases[0], &parameters[input_bias.range()]);
            copy(&mut self.cell_biases[1], &parameters[hidden_bias.range()]);
            pieces.push(Box::new(move |_| {
                from_input.pack(kernels, &parameters[input.range()], inputs, columns)
            }));
            pieces.push(Box::new(move |_| {
                from_hidden.pack(kernels, &parameters[hidden.range()], units, columns)
            }));
        }
        self.dense.resize_with(shape.dense.len(), Panels::default);
        self.dense_biases.resize_with(shape.dense.len(), Vec::new);
        for (index, (packed, biases)) in
            self.dense.iter_mut().zip(&mut self.dense_biases).enumerate()
        {
            let weights = plan.dense(index);
            copy(biases, &parameters[plan.after(weights).range()]);
            let units = shape.dense[index];
            pieces.push(Box::new(move |_| {
                packed.pack(kernels, &parameters[weights.range()], weights.inputs, units)
            }));
        }
        self.convolutions.resize_with(plan.convolutions.len(), Panels::default);
        self.convolution_biases.resize_with(plan.convolutions.len(), Vec::new);
        let convolutions =
            self.convolutions.iter_mut().zip(&mut self.convolution_biases).zip(&plan.convolutions);
        for (index, ((packed, biases), convolution)) in convolutions.enumerate() {
            let weights = plan.convolution(index);
            copy(biases, &parameters[plan.after(weights).range()]);
            pieces.push(Box::new(move |_| {
                convolution.pack_forward(&parameters[weights.range()], packed)
            }));
        }
        let (heads, head_biases) = (&mut self.heads, &mut self.head_biases);
        pieces.push(Box::new(move |_| {
            let joined = joined_heads(plan, parameters);
            heads.pack(kernels, &joined, shape.head_inputs(), plan.padded_outputs);
            head_biases.clear();
            for index in 0..shape.heads.len() {
                head_biases.extend_from_slice(&parameters[plan.after(plan.head(index)).range()]);
            }
            head_biases.resize(plan.padded_outputs, 0.0);
        }));
        pieces
    }
}

/// A pixel scale in the order of the first layer's stored input.
#[must_use]
pub fn stored_pixels(plan: &Plan, pixels: &PixelScale) -> PixelScale {
    let Some(first) = plan.convolutions.first() else { return pixels.clone() };
    let channels = plan.shape.image.channels;
    let reorder = |from: &[f32]| {
        let mut to = vec![0.0; first.stored];
        for (values, &place) in from.chunks_exact(channels).zip(&first.places) {
            if place != NOWHERE {
                to[place..place + channels].copy_from_slice(values);
            }
        }
        to
    };
    PixelScale { scale: reorder(&pixels.scale), shift: reorder(&pixels.shift) }
}

impl Backward {
    /// Packs `parameters`, reusing this value's memory: a piece of work a layer, and one for the
    /// heads.
    pub fn loading<'a, S>(
        &'a mut self,
        plan: &'a Plan,
        parameters: &'a [f32],
    ) -> Vec<Piece<'a, S>> {
        let (kernels, shape) = (plan.kernels, &plan.shape);
        let mut pieces: Vec<Piece<'a, S>> = Vec::new();
        if let Some(units) = shape.recurrent {
            let [input, _, hidden, _] = plan.cell();
            let (dense, columns) = (shape.core_inputs() - shape.extra_inputs, shape.gate_columns());
            let rows = &parameters[input.range()][..dense * columns];
            let (to_input, to_hidden) = (&mut self.cell_input, &mut self.cell_hidden);
            pieces.push(Box::new(move |_| to_input.pack_transposed(kernels, rows, columns, dense)));
            let rows = &parameters[hidden.range()];
            pieces
                .push(Box::new(move |_| to_hidden.pack_transposed(kernels, rows, columns, units)));
        }
        self.dense.resize_with(shape.dense.len(), Panels::default);
        for (index, packed) in self.dense.iter_mut().enumerate() {
            if index == 0 && plan.convolutions.is_empty() {
                continue;
            }
            let (weights, units) = (plan.dense(index), shape.dense[index]);
            let rows = &parameters[weights.range()];
            pieces.push(Box::new(move |_| {
                packed.pack_transposed(kernels, rows, units, weights.inputs)
            }));
        }
        self.convolutions.resize_with(plan.convolutions.len(), Panels::default);
        for (index, (packed, convolution)) in
            self.convolutions.iter_mut().zip(&plan.convolutions).enumerate().skip(1)
        {
            let weights = plan.convolution(index);
            pieces.push(Box::new(move |_| {
                convolution.pack_backward(&parameters[weights.range()], packed)
            }));
        }
        let heads = &mut self.heads;
        pieces.push(Box::new(move |_| {
            // Nothing flows into the extra inputs, which without a recurrent layer are the last
            // inputs of the heads.
            let inputs = if shape.recurrent.is_some() {
                shape.head_inputs()
            } else {
                shape.core_inputs() - shape.extra_inputs
            };
            let rows = &joined_heads(plan, parameters)[..inputs * plan.padded_outputs];
            heads.pack_transposed(kernels, rows, plan.padded_outputs, inputs);
        }));
        pieces
    }
}

fn copy(to: &mut Vec<f32>, from: &[f32]) {
    to.clear();
    to.extend_from_slice(from);
}

/// The heads' weights side by side, row by row, padded with zeros to whole panels.
fn joined_heads(plan: &Plan, parameters: &[f32]) -> Vec<f32> {
    let mut joined = vec![0.0; plan.shape.head_inputs() * plan.padded_outputs];
    let mut first = 0;
    for (index, &outputs) in plan.shape.heads.iter().enumerate() {
        let weights = &parameters[plan.head(index).range()];
        for (from, to) in
            weights.chunks_exact(outputs).zip(joined.chunks_exact_mut(plan.padded_outputs))
        {
            to[first..first + outputs].copy_from_slice(from);
        }
        first += outputs;
    }
    joined
}
