//! A network by its definition: loops in 64 bits over the table of parameters, nothing shared with
//! what it is held against.

use hasard_learn::config::RecurrentCell;
use hasard_learn::networks::{ImageShape, NetworkShape, PixelScale, Sequences};

fn elu(values: &mut [f64]) {
    values.iter_mut().filter(|value| **value < 0.0).for_each(|value| *value = value.exp() - 1.0);
}

fn sigmoid(value: f64) -> f64 {
    1.0 / (1.0 + (-value).exp())
}

/// `inputs * weights + biases`, the weights row by row.
fn dense(inputs: &[f64], weights: &[f64], biases: &[f64]) -> Vec<f64> {
    let mut outputs = biases.to_vec();
    for (input, row) in inputs.iter().zip(weights.chunks_exact(biases.len())) {
        outputs.iter_mut().zip(row).for_each(|(output, weight)| *output += input * weight);
    }
    outputs
}

fn rectified(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| value.max(0.0)).collect()
}

/// A 3x3 convolution that keeps the size of the image, what is outside counting as zero.
fn convolved(
    values: &[f64],
    image: ImageShape,
    (weights, biases): (&[f64], &[f64]),
) -> (Vec<f64>, ImageShape) {
    let mut next = Vec::new();
    for (y, x) in (0..image.height).flat_map(|y| (0..image.width).map(move |x| (y, x))) {
        let mut patch = Vec::new();
        for (row, column) in (0..3).flat_map(|dy| (0..3).map(move |dx| (y + dy, x + dx))) {
            let inside = (1..=image.height).contains(&row) && (1..=image.width).contains(&column);
            let pixel = |channel| ((row - 1) * image.width + column - 1) * image.channels + channel;
            patch.extend(
                (0..image.channels)
                    .map(|channel| if inside { values[pixel(channel)] } else { 0.0 }),
            );
        }
        next.extend(dense(&patch, weights, biases));
    }
    (next, ImageShape { channels: biases.len(), ..image })
}

/// The largest of the 3x3 pixels around every second one of every second row.
fn pooled(values: &[f64], image: ImageShape) -> (Vec<f64>, ImageShape) {
    let mut next = Vec::new();
    for (y, x) in
        (0..image.height).step_by(2).flat_map(|y| (0..image.width).step_by(2).map(move |x| (y, x)))
    {
        for channel in 0..image.channels {
            let mut largest = f64::NEG_INFINITY;
            for row in y.saturating_sub(1)..(y + 2).min(image.height) {
                for column in x.saturating_sub(1)..(x + 2).min(image.width) {
                    largest = largest
                        .max(values[(row * image.width + column) * image.channels + channel]);
                }
            }
            next.push(largest);
        }
    }
    (next, ImageShape { height: image.height.div_ceil(2), width: image.width.div_ceil(2), ..image })
}

/// Outputs of all rows, one after the other.
pub fn forward(
    shape: &NetworkShape,
    parameters: &[f64],
    pixels: &PixelScale,
    batch: &Sequences<'_>,
) -> Vec<f64> {
    let table = shape.parameters();
    let mut blocks = table.iter().map(|parameter| &parameters[parameter.range()]);
    let mut next = || blocks.next().expect("a block of each layer");
    let convolutions: Vec<_> = shape.convolutions.iter().map(|_| (next(), next())).collect();
    // Of each stage: the one before the pooling, then two for each of two blocks.
    let stages: Vec<_> =
        shape.residual.iter().map(|_| [(); 5].map(|()| (next(), next()))).collect();
    let layers: Vec<_> = shape.dense.iter().map(|_| (next(), next())).collect();
    let cell = shape.recurrent.map(|units| (units, [next(), next(), next(), next()]));
    let heads: Vec<_> = shape.heads.iter().map(|_| (next(), next())).collect();

    let mut states: Vec<Vec<f64>> = batch
        .initial_state
        .iter()
        .map(|&value| f64::from(value))
        .collect::<Vec<_>>()
        .chunks(shape.state_size().max(1))
        .map(<[f64]>::to_vec)
        .collect();
    let mut outputs = Vec::new();
    for row in 0..batch.rows() {
        let mut values: Vec<f64> = batch.observations[row]
            .iter()
            .zip(pixels.scale.iter().zip(&pixels.shift))
            .map(|(&pixel, (&scale, &shift))| {
                (f64::from(pixel) * f64::from(scale) + f64::from(shift)).clamp(-5.0, 5.0)
            })
            .collect();
        let mut image = shape.image;
        for (layer, (weights, biases)) in shape.convolutions.iter().zip(&convolutions) {
            let after = image.after(layer).expect("the kernel fits");
            let mut next = Vec::with_capacity(after.size());
            for y in 0..after.height {
                for x in 0..after.width {
                    let mut patch = Vec::new();
                    for kernel_row in 0..layer.kernel {
                        let first = ((y * layer.stride + kernel_row) * image.width
                            + x * layer.stride)
                            * image.channels;
                        patch.extend_from_slice(
                            &values[first..first + layer.kernel * image.channels],
                        );
                    }
                    next.extend(dense(&patch, weights, biases));
                }
            }
            elu(&mut next);
            (values, image) = (next, after);
        }
        for stage in &stages {
            (values, image) = convolved(&values, image, stage[0]);
            (values, image) = pooled(&values, image);
            for block in stage[1..].chunks(2) {
                let (once, _) = convolved(&rectified(&values), image, block[0]);
                let (twice, _) = convolved(&rectified(&once), image, block[1]);
                values.iter_mut().zip(&twice).for_each(|(value, change)| *value += change);
            }
        }
        if !stages.is_empty() {
            values = rectified(&values);
        }
        for (weights, biases) in &layers {
            values = dense(&values, weights, biases);
            elu(&mut values);
        }
        values.extend(
            batch.extra[row * shape.extra_inputs..][..shape.extra_inputs]
                .iter()
                .map(|&value| f64::from(value)),
        );
        if let Some((units, [input, input_bias, hidden, hidden_bias])) = cell {
            let state = &mut states[row % batch.lanes];
            if batch.reset[row] {
                state.fill(0.0);
            }
            let (x, s) =
                (dense(&values, input, input_bias), dense(&state[..units], hidden, hidden_bias));
            for unit in 0..units {
                let sum = |gate: usize| x[gate * units + unit] + s[gate * units + unit];
                match shape.cell {
                    // Cho et al. 2014, equations 5 to 8, the reset applied behind the product:
                    // reset, update, new.
                    RecurrentCell::Gru => {
                        let (reset, update) = (sigmoid(sum(0)), sigmoid(sum(1)));
                        let new = (x[2 * units + unit] + reset * s[2 * units + unit]).tanh();
                        state[unit] = (1.0 - update) * new + update * state[unit];
                    }
                    // Gers et al. 2000, section 3, with tanh for both squashing functions: input,
                    // forget, candidate, output.
                    RecurrentCell::Lstm => {
                        let cell =
                            sigmoid(sum(1)) * state[units + unit] + sigmoid(sum(0)) * sum(2).tanh();
                        state[units + unit] = cell;
                        state[unit] = sigmoid(sum(3)) * cell.tanh();
                    }
                }
            }
            values = state[..units].to_vec();
        }
        for (weights, biases) in &heads {
            outputs.extend(dense(&values, weights, biases));
        }
    }
    outputs
}
