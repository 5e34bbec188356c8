//! The network in tensors of the `burn` crate, for every device that burn has: the portable twin of
//! [`crate::networks::cpu`].
//!
//! The flat parameter vector stays on the host, where the optimiser and checkpoints are the same
//! for all devices; a load uploads it and a backward pass downloads one gradient of its length.

use std::sync::Arc;

use burn::tensor::activation::{elu, relu, sigmoid, tanh};
use burn::tensor::module::{conv2d, max_pool2d};
use burn::tensor::ops::{ConvOptions, MaxPoolOptions};
use burn::tensor::{Device, Int, Tensor, TensorData};

use crate::config::RecurrentCell;
use crate::networks::{
    ActingNetwork, LearningNetwork, NetworkShape, NetworkWeights, PixelScale, Place, Sequences,
};

/// One network on a burn device.
pub struct BurnNetwork {
    shape: NetworkShape,
    device: Device,
    /// In the order of the table of parameters.
    parameters: Vec<Tensor<1>>,
    /// Factor and summand of pixels, `[1, pixels]`.
    pixels: Option<(Tensor<2>, Tensor<2>)>,
    /// What was loaded, as actors are given it.
    host: (Arc<Vec<f32>>, Arc<PixelScale>),
    /// Outputs of the last forward pass, still attached to their graph.
    outputs: Option<Tensor<2>>,
}

impl BurnNetwork {
    /// A network without weights yet.
    #[must_use]
    pub fn new(shape: &NetworkShape, device: &Device) -> BurnNetwork {
        BurnNetwork {
            shape: shape.clone(),
            device: device.clone(),
            parameters: Vec::new(),
            pixels: None,
            host: (Arc::default(), Arc::new(PixelScale::unit(0))),
            outputs: None,
        }
    }

    fn load_on(&mut self, parameters: &[f32], device: &Device, track: bool) {
        self.parameters = self
            .shape
            .parameters()
            .iter()
            .map(|parameter| {
                let values =
                    TensorData::new(parameters[parameter.range()].to_vec(), [parameter.size()]);
                let tensor = Tensor::<1>::from_data(values, device);
                if track { tensor.require_grad() } else { tensor }
            })
            .collect();
    }

    fn load_pixels_on(&mut self, pixels: &PixelScale, device: &Device) {
        let row = |values: &[f32]| {
            Tensor::<2>::from_data(TensorData::new(values.to_vec(), [1, values.len()]), device)
        };
        self.pixels = Some((row(&pixels.scale), row(&pixels.shift)));
    }

    /// Normalised images, `[rows, channels, height, width]`.
    fn images(&self, observations: &[&[u8]], device: &Device) -> Tensor<4> {
        let image = self.shape.image;
        let rows = observations.len();
        let (scale, shift) = self.pixels.clone().expect("weights loaded");
        // Four pixels travel in one word: a quarter of the transfer, and every device has 32-bit
        // integers.
        let words = image.size().div_ceil(4);
        let mut packed = Vec::with_capacity(rows * words);
        for observation in observations {
            assert_eq!(observation.len(), image.size(), "observation of the wrong size");
            packed.extend(observation.chunks(4).map(|pixels| {
                let mut bytes = [0; 4];
                bytes[..pixels.len()].copy_from_slice(pixels);
                i32::from_le_bytes(bytes)
            }));
        }
        let words = Tensor::<3, Int>::from_data(TensorData::new(packed, [rows, words, 1]), device);
        let bytes = (0..4)
            .map(|byte| words.clone().bitwise_right_shift_scalar(8 * byte).bitwise_and_scalar(255))
            .collect();
        let pixels =
            Tensor::cat(bytes, 2).float().reshape([rows as i32, -1]).narrow(1, 0, image.size());
        (pixels * scale + shift)
            .clamp(-5.0, 5.0)
            .reshape([rows, image.height, image.width, image.channels])
            .permute([0, 3, 1, 2])
    }

    /// Outputs of all rows and the states after the last step.
    fn run(&self, batch: &Sequences<'_>, device: &Device) -> (Tensor<2>, Option<Tensor<2>>) {
        let shape = &self.shape;
        let rows = batch.rows();
        let table = shape.parameters();
        let mut parameters = self.parameters.iter().zip(&table);
        let mut next = || parameters.next().expect("table of parameters");
        let mut images = self.images(&batch.observations, device);
        let mut convolved = |images: Tensor<4>, stride: usize, border: usize| -> Tensor<4> {
            let (weights, entry) = next();
            let [a, b, c, d] = [entry.shape[0], entry.shape[1], entry.shape[2], entry.shape[3]];
            let weights = weights.clone().reshape([a, b, c, d]).permute([3, 2, 0, 1]);
            let (biases, _) = next();
            conv2d(
                images,
                weights,
                Some(biases.clone()),
                ConvOptions::new([stride; 2], [border; 2], [1; 2], 1),
            )
        };
        for layer in &shape.convolutions {
            images = elu(convolved(images, layer.stride, 0), 1.0);
        }
        for _ in &shape.residual {
            let options = MaxPoolOptions {
                kernel_size: [3; 2],
                stride: [2; 2],
                padding: [(1, 1); 2],
                dilation: [1; 2],
                ceil_mode: false,
            };
            images = max_pool2d(convolved(images, 1, 1), options);
            for _block in 0..2 {
                let once = convolved(relu(images.clone()), 1, 1);
                images = images + convolved(relu(once), 1, 1);
            }
        }
        if !shape.residual.is_empty() {
            images = relu(images);
        }
        let mut values: Tensor<2> = images.permute([0, 2, 3, 1]).reshape([rows, shape.features()]);
        let mut matrix = || -> Tensor<2> {
            let (weights, entry) = next();
            weights.clone().reshape([entry.shape[0], entry.size() / entry.shape[0]])
        };
        for _ in &shape.dense {
            values = elu(values.matmul(matrix()) + matrix().transpose(), 1.0);
        }
        if shape.extra_inputs > 0 {
            let extra = TensorData::new(batch.extra.clone(), [rows, shape.extra_inputs]);
            values = Tensor::cat(vec![values, Tensor::from_data(extra, device)], 1);
        }
        let mut state = None;
        if let Some(units) = shape.recurrent {
            let (input, input_bias, hidden, hidden_bias) = (matrix(), matrix(), matrix(), matrix());
            let from_input = values.matmul(input) + input_bias.transpose();
            let hidden_bias = hidden_bias.transpose();
            let initial =
                TensorData::new(batch.initial_state.clone(), [batch.lanes, shape.state_size()]);
            let mut carried: Tensor<2> = Tensor::from_data(initial, device);
            let mut states = Vec::with_capacity(batch.steps);
            for step in 0..batch.steps {
                let first = step * batch.lanes;
                if batch.reset[first..first + batch.lanes].contains(&true) {
                    let keep: Vec<f32> = (0..batch.lanes)
                        .map(|lane| if batch.reset[first + lane] { 0.0 } else { 1.0 })
                        .collect();
                    carried = carried
                        * Tensor::<2>::from_data(TensorData::new(keep, [batch.lanes, 1]), device);
                }
                let part =
                    |tensor: &Tensor<2>, gate: usize| tensor.clone().narrow(1, gate * units, units);
                let h = part(&carried, 0);
                let x = from_input.clone().narrow(0, first, batch.lanes);
                let s = h.clone().matmul(hidden.clone()) + hidden_bias.clone();
                let sum = |gate: usize| part(&x, gate) + part(&s, gate);
                carried = match shape.cell {
                    RecurrentCell::Gru => {
                        let (r, z) = (sigmoid(sum(0)), sigmoid(sum(1)));
                        let n = tanh(part(&x, 2) + r * part(&s, 2));
                        n.clone() + z * (h - n)
                    }
                    RecurrentCell::Lstm => {
                        let cell =
                            sigmoid(sum(1)) * part(&carried, 1) + sigmoid(sum(0)) * tanh(sum(2));
                        Tensor::cat(vec![sigmoid(sum(3)) * tanh(cell.clone()), cell], 1)
                    }
                };
                states.push(part(&carried, 0));
            }
            values = Tensor::cat(states, 0);
            state = Some(carried);
        }
        let heads = shape
            .heads
            .iter()
            .map(|_| values.clone().matmul(matrix()) + matrix().transpose())
            .collect();
        (Tensor::cat(heads, 1), state)
    }
}

fn to_vec(tensor: Tensor<2>) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("32-bit floats")
}

impl ActingNetwork for BurnNetwork {
    fn load(&mut self, weights: &NetworkWeights) {
        let NetworkWeights::Plain { parameters, pixels } = weights else {
            unreachable!("weights packed for the processor are given to its own actors alone");
        };
        let device = self.device.clone();
        self.load_on(parameters, &device, false);
        self.load_pixels_on(pixels, &device);
    }

    fn act(
        &mut self,
        observations: &[u8],
        extra: &[f32],
        state: &mut [f32],
        outputs: &mut [f32],
        _: Option<Place<'_>>,
    ) {
        let observations: Vec<&[u8]> = observations.chunks_exact(self.shape.image.size()).collect();
        let lanes = observations.len();
        let batch = Sequences {
            steps: 1,
            lanes,
            observations,
            extra: extra.to_vec(),
            initial_state: state.to_vec(),
            reset: vec![false; lanes],
            recorded: Vec::new(),
        };
        let (tensor, after) = self.run(&batch, &self.device);
        outputs.copy_from_slice(&to_vec(tensor));
        if let Some(after) = after {
            state.copy_from_slice(&to_vec(after));
        }
    }
}

impl LearningNetwork for BurnNetwork {
    fn shape(&self) -> &NetworkShape {
        &self.shape
    }

    fn load(&mut self, parameters: &[f32]) {
        let device = self.device.clone().autodiff();
        self.load_on(parameters, &device, true);
        self.host.0 = Arc::new(parameters.to_vec());
    }

    fn load_pixels(&mut self, pixels: &PixelScale) {
        let device = self.device.clone().autodiff();
        self.load_pixels_on(pixels, &device);
        self.host.1 = Arc::new(pixels.clone());
    }

    fn publish(&self) -> NetworkWeights {
        NetworkWeights::Plain {
            parameters: Arc::clone(&self.host.0),
            pixels: Arc::clone(&self.host.1),
        }
    }

    fn forward(&mut self, batch: &Sequences<'_>) -> Vec<f32> {
        let device = self.device.clone().autodiff();
        let (outputs, _) = self.run(batch, &device);
        let values = to_vec(outputs.clone().detach());
        self.outputs = Some(outputs);
        values
    }

    fn backward(&mut self, batch: &Sequences<'_>, output_gradient: &[f32], gradient: &mut [f32]) {
        let outputs = self.outputs.take().expect("a forward pass before each backward pass");
        let device = self.device.clone().autodiff();
        let weights =
            TensorData::new(output_gradient.to_vec(), [batch.rows(), self.shape.outputs()]);
        let gradients = (outputs * Tensor::<2>::from_data(weights, &device)).sum().backward();
        for (tensor, parameter) in self.parameters.iter().zip(self.shape.parameters()) {
            let into = &mut gradient[parameter.range()];
            match tensor.grad(&gradients) {
                Some(values) => into.copy_from_slice(
                    &values.into_data().try_to_vec::<f32>().expect("32-bit floats"),
                ),
                None => into.fill(0.0),
            }
        }
    }
}
