//! The shape of one network and the table of its parameters.

use serde::{Deserialize, Serialize};

use crate::config::{Convolution, RecurrentCell, Reflected};
use crate::error::LearnError;
use crate::networks::layers::{EncoderLayer, ImageShape, STAGE, encoder_layers};

/// Bounds on networks, a hundred times the original's: beyond them a number in a settings file is
/// surely a slip.
const WIDEST: usize = 1 << 16;
const MOST_LAYERS: usize = 64;
const MOST_PARAMETERS: usize = 1 << 28;

/// One network: convolutions or a residual encoder, dense layers, an optional recurrent layer, and
/// linear heads, all on one 8-bit image.
///
/// The original's is [`NetworkShape::default`]: 32@8/4, 64@4/2, 128@3/2, dense 512, GRU 512.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct NetworkShape {
    /// Height, width, channels of the observation, stored in this order.
    pub image: ImageShape,
    /// Convolutions, the first one on the image.
    pub convolutions: Vec<Convolution>,
    /// Channels of each stage of a residual encoder in place of the convolutions.
    #[serde(default)]
    pub residual: Vec<usize>,
    /// Units of the dense layers after them, multiples of 32.
    pub dense: Vec<usize>,
    /// Numbers that join the last dense layer's output (the safety state of PPOSaute).
    pub extra_inputs: usize,
    /// Units of the recurrent layer, a multiple of 32; `None` for a feed-forward network.
    pub recurrent: Option<usize>,
    /// What it is made of.
    #[serde(default)]
    pub cell: RecurrentCell,
    /// Outputs of each linear head; they follow each other in the output row.
    pub heads: Vec<usize>,
    /// Which output of the picture's mirror image each output is averaged with; empty for a network
    /// that sees no mirror image.
    #[serde(default)]
    pub mirror: Vec<Reflected>,
}

impl Default for NetworkShape {
    fn default() -> NetworkShape {
        NetworkShape {
            image: ImageShape { height: 72, width: 128, channels: 3 },
            convolutions: vec![
                Convolution { channels: 32, kernel: 8, stride: 4 },
                Convolution { channels: 64, kernel: 4, stride: 2 },
                Convolution { channels: 128, kernel: 3, stride: 2 },
            ],
            residual: vec![],
            dense: vec![512],
            extra_inputs: 0,
            recurrent: Some(512),
            cell: RecurrentCell::Gru,
            heads: vec![9, 1],
            mirror: vec![],
        }
    }
}

/// What a parameter is, which decides how it is initialised.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ParameterKind {
    /// Weights of a convolution.
    Convolution,
    /// Weights of a dense layer.
    Dense,
    /// Weights of a recurrent layer.
    Recurrent,
    /// Weights of a head; the others of its row of heads are initialised apart.
    Head,
    /// Biases of a layer with this fan-in.
    Bias,
    /// Biases of a recurrent layer.
    RecurrentBias,
}

/// A named block of the flat parameter vector: a matrix of `inputs` rows and `outputs` columns, row
/// by row.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Parameter {
    /// Name in checkpoints.
    pub name: String,
    /// Logical shape; a convolution's is [kernel row, kernel column, input channel, output
    /// channel].
    pub shape: Vec<usize>,
    /// Where the block starts in the flat vector.
    pub offset: usize,
    /// Rows, which is the fan-in; for a bias that of its layer.
    pub inputs: usize,
    /// Columns.
    pub outputs: usize,
    /// What it is.
    pub kind: ParameterKind,
}

impl Parameter {
    /// Number of values.
    #[must_use]
    pub fn size(&self) -> usize {
        self.shape.iter().product()
    }

    /// Where the block lies in the flat vector.
    #[must_use]
    pub fn range(&self) -> std::ops::Range<usize> {
        self.offset..self.offset + self.size()
    }
}

impl NetworkShape {
    /// Refuses shapes that no network can have, naming the number at fault.
    pub fn check(&self) -> Result<(), LearnError> {
        let bad = |text: String| Err(LearnError::Config(text));
        let mut image = self.image;
        if image.size() == 0 {
            return bad(format!(
                "observation of {}x{}x{} has no pixels",
                image.height, image.width, image.channels
            ));
        }
        if !self.residual.is_empty() && !self.convolutions.is_empty() {
            return bad("a network has convolutions or a residual encoder, not both: leave one of them empty".into());
        }
        if let Some(channels) =
            self.residual.iter().find(|&&channels| channels == 0 || !channels.is_multiple_of(32))
        {
            return bad(format!("residual stage of {channels} channels: use a multiple of 32"));
        }
        for convolution in &self.convolutions {
            if convolution.channels == 0 || !convolution.channels.is_multiple_of(32) {
                return bad(format!(
                    "network.convolutions: {} channels; use a multiple of 32",
                    convolution.channels
                ));
            }
            if convolution.kernel == 0
                || convolution.stride == 0
                || convolution.stride > convolution.kernel
            {
                return bad(format!(
                    "network.convolutions: kernel {} and stride {}; use 1 <= stride <= kernel",
                    convolution.kernel, convolution.stride
                ));
            }
            match image.after(convolution) {
                Some(next) => image = next,
                None => {
                    return bad(format!(
                        "network.convolutions: kernel {} does not fit into an image of {}x{}; use larger frames or fewer convolutions",
                        convolution.kernel, image.height, image.width
                    ));
                }
            }
        }
        if self.dense.is_empty() {
            return bad("network.dense is empty; give at least one layer, such as [256]".into());
        }
        for units in self.dense.iter().chain(&self.recurrent) {
            if *units == 0 || !units.is_multiple_of(32) {
                return bad(format!(
                    "network.dense and network.recurrent: {units} units; use a multiple of 32"
                ));
            }
        }
        if self.heads.is_empty() || self.heads.contains(&0) {
            return bad("every head needs at least one output".into());
        }
        let widths = self.convolutions.iter().map(|convolution| &convolution.channels);
        let widest = widths
            .chain(&self.residual)
            .chain(&self.dense)
            .chain(&self.recurrent)
            .chain(&self.heads)
            .max()
            .copied()
            .unwrap_or(0);
        let layers = self.convolutions.len()
            + self.residual.len() * STAGE
            + self.dense.len()
            + self.heads.len();
        // With these bounds no product of sizes wraps around.
        if widest > WIDEST || layers > MOST_LAYERS || self.parameter_count() > MOST_PARAMETERS {
            return bad(format!(
                "a network of {layers} layers, the widest of {widest} units, is too large: use at most {MOST_LAYERS} layers of at \
                 most {WIDEST} units, and {MOST_PARAMETERS} parameters"
            ));
        }
        Ok(())
    }

    /// The convolutions of a checked shape.
    #[must_use]
    pub fn encoder_layers(&self) -> Vec<EncoderLayer> {
        encoder_layers(self.image, &self.convolutions, &self.residual)
    }

    /// Values that the encoder hands to the first dense layer.
    #[must_use]
    pub fn features(&self) -> usize {
        self.encoder_layers().last().map_or(self.image, |layer| layer.output).size()
    }

    /// Numbers of the state carried from step to step.
    #[must_use]
    pub fn state_size(&self) -> usize {
        self.recurrent.unwrap_or(0) * self.cell.states() * self.passes()
    }

    /// Passes of one sample: a picture and its mirror image are two.
    #[must_use]
    pub fn passes(&self) -> usize {
        if self.mirror.is_empty() { 1 } else { 2 }
    }

    /// The network that sees one picture.
    #[must_use]
    pub fn plain(&self) -> NetworkShape {
        NetworkShape { mirror: Vec::new(), ..self.clone() }
    }

    /// Columns of the recurrent layer's weights: all gates of all units.
    #[must_use]
    pub fn gate_columns(&self) -> usize {
        self.recurrent.unwrap_or(0) * self.cell.gates()
    }

    /// Numbers that enter the recurrent layer, or the heads without one.
    #[must_use]
    pub fn core_inputs(&self) -> usize {
        self.dense.last().copied().unwrap_or(0) + self.extra_inputs
    }

    /// Numbers that enter the heads.
    #[must_use]
    pub fn head_inputs(&self) -> usize {
        self.recurrent.unwrap_or_else(|| self.core_inputs())
    }

    /// Length of an output row: all heads one after the other.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.heads.iter().sum()
    }

    /// The table of parameters in the order of the flat vector.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut table = Table::default();
        for EncoderLayer {
            name, convolution: Convolution { kernel, channels, .. }, image, ..
        } in self.encoder_layers()
        {
            table.layer(
                &name,
                vec![kernel, kernel, image.channels, channels],
                ParameterKind::Convolution,
            );
        }
        let mut inputs = self.features();
        for (index, &units) in self.dense.iter().enumerate() {
            table.layer(&format!("dense{index}"), vec![inputs, units], ParameterKind::Dense);
            inputs = units;
        }
        if let Some(units) = self.recurrent {
            let (cell, columns) = (self.cell, self.gate_columns());
            for (name, inputs) in [("input", self.core_inputs()), ("hidden", units)] {
                table.push(
                    format!("{cell}.{name}_weight"),
                    vec![inputs, columns],
                    units,
                    columns,
                    ParameterKind::Recurrent,
                );
                table.push(
                    format!("{cell}.{name}_bias"),
                    vec![columns],
                    units,
                    columns,
                    ParameterKind::RecurrentBias,
                );
            }
        }
        for (index, &outputs) in self.heads.iter().enumerate() {
            table.layer(
                &format!("head{index}"),
                vec![self.head_inputs(), outputs],
                ParameterKind::Head,
            );
        }
        table.parameters
    }

    /// Number of parameters.
    #[must_use]
    pub fn parameter_count(&self) -> usize {
        self.parameters().iter().map(Parameter::size).sum()
    }

    /// Floating-point operations of one forward pass of one sample (a multiply-add is two), matrix
    /// products alone.
    #[must_use]
    pub fn forward_flop(&self) -> f64 {
        let once = |parameter: &Parameter| match parameter.kind {
            ParameterKind::Bias | ParameterKind::RecurrentBias | ParameterKind::Convolution => 0.0,
            _ => parameter.size() as f64,
        };
        let convolved: f64 = self.encoder_layers().iter().map(EncoderLayer::products).sum();
        let products = convolved + self.parameters().iter().map(once).sum::<f64>();
        2.0 * self.passes() as f64 * products
    }

    /// Floating-point operations of forward and backward passes of one sample; nothing flows back
    /// into the image.
    #[must_use]
    pub fn training_flop(&self) -> f64 {
        let first = match self.encoder_layers().first() {
            Some(layer) => layer.products(),
            None => (self.features() * self.dense[0]) as f64,
        };
        3.0 * self.forward_flop() - 2.0 * self.passes() as f64 * first
    }
}

#[derive(Default)]
struct Table {
    parameters: Vec<Parameter>,
    offset: usize,
}

impl Table {
    fn push(
        &mut self,
        name: String,
        shape: Vec<usize>,
        inputs: usize,
        outputs: usize,
        kind: ParameterKind,
    ) {
        let parameter = Parameter { name, shape, offset: self.offset, inputs, outputs, kind };
        self.offset += parameter.size();
        self.parameters.push(parameter);
    }

    /// Weights and biases of a layer whose last axis are its outputs.
    fn layer(&mut self, name: &str, shape: Vec<usize>, kind: ParameterKind) {
        let outputs = shape[shape.len() - 1];
        let inputs = shape[..shape.len() - 1].iter().product();
        self.push(format!("{name}.weight"), shape, inputs, outputs, kind);
        self.push(format!("{name}.bias"), vec![outputs], inputs, outputs, ParameterKind::Bias);
    }
}

#[cfg(test)]
mod tests;
