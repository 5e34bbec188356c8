//! Initial weights.

use crate::config::Initialisation;
use crate::networks::shape::{NetworkShape, Parameter, ParameterKind};
use crate::random::{Purpose, Stream};

impl NetworkShape {
    /// A fresh flat parameter vector; `network` counts the networks of a model, so that no two
    /// begin alike.
    #[must_use]
    pub fn initial_parameters(&self, scheme: Initialisation, seed: u64, network: u64) -> Vec<f32> {
        let mut values = vec![0.0; self.parameter_count()];
        for (index, parameter) in self.parameters().iter().enumerate() {
            let mut stream = Stream::new(seed, Purpose::Weights, network, index as u64);
            fill(&mut values[parameter.range()], parameter, scheme, &mut stream);
        }
        values
    }

    /// Multiplies the weights of a head by a factor.
    pub fn scale_head(&self, head: usize, factor: f32, values: &mut [f32]) {
        let name = format!("head{head}.weight");
        let weights = self.parameters().into_iter().find(|parameter| parameter.name == name);
        for value in weights.into_iter().flat_map(|parameter| parameter.range()) {
            values[value] *= factor;
        }
    }
}

fn fill(values: &mut [f32], parameter: &Parameter, scheme: Initialisation, stream: &mut Stream) {
    use ParameterKind::{Bias, Convolution, Dense, Head, Recurrent, RecurrentBias};
    let orthogonal_here = match (scheme, parameter.kind) {
        (_, Bias) if scheme != Initialisation::Uniform => return,
        (Initialisation::Orthogonal, RecurrentBias) => return,
        (Initialisation::Orthogonal, Convolution | Dense | Recurrent | Head) => true,
        (Initialisation::OrthogonalHeads, Head) => true,
        _ => false,
    };
    if orthogonal_here {
        orthogonal(values, parameter.size() / parameter.outputs, parameter.outputs, stream);
    } else {
        let bound = 1.0 / (parameter.inputs as f64).sqrt();
        for value in values {
            *value = ((2.0 * stream.uniform() - 1.0) * bound) as f32;
        }
    }
}

/// Fills a `rows` x `columns` matrix with orthonormal rows or columns, whichever are fewer: Gram
/// and Schmidt's method, applied twice to normal draws, which is exact to rounding.
fn orthogonal(values: &mut [f32], rows: usize, columns: usize, stream: &mut Stream) {
    let (count, length) = (rows.min(columns), rows.max(columns));
    let mut vectors: Vec<Vec<f32>> = Vec::with_capacity(count);
    for _ in 0..count {
        let mut vector: Vec<f32> = (0..length).map(|_| stream.normal() as f32).collect();
        for _ in 0..2 {
            for earlier in &vectors {
                let overlap = dot(&vector, earlier);
                for (value, other) in vector.iter_mut().zip(earlier) {
                    *value -= overlap * other;
                }
            }
            let norm = dot(&vector, &vector).sqrt();
            for value in &mut vector {
                *value /= norm;
            }
        }
        vectors.push(vector);
    }
    for (index, vector) in vectors.iter().enumerate() {
        for (position, value) in vector.iter().enumerate() {
            let at = if columns <= rows {
                position * columns + index
            } else {
                index * columns + position
            };
            values[at] = *value;
        }
    }
}

/// Sum of products in sixteen partial sums, which the compiler keeps in vector registers.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0f32; 16];
    let (a_blocks, b_blocks) = (a.chunks_exact(16), b.chunks_exact(16));
    let rest: f32 = a_blocks.remainder().iter().zip(b_blocks.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a_blocks.zip(b_blocks) {
        for lane in 0..16 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    sums.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orthogonal_matrices_are_orthonormal() {
        for (rows, columns) in [(48, 16), (16, 48), (7, 1), (32, 32)] {
            let mut values = vec![0.0; rows * columns];
            orthogonal(&mut values, rows, columns, &mut Stream::new(3, Purpose::Weights, 0, 0));
            let count = rows.min(columns);
            for i in 0..count {
                for j in 0..=i {
                    let product: f32 = if columns <= rows {
                        (0..rows).map(|r| values[r * columns + i] * values[r * columns + j]).sum()
                    } else {
                        (0..columns)
                            .map(|c| values[i * columns + c] * values[j * columns + c])
                            .sum()
                    };
                    let expected = if i == j { 1.0 } else { 0.0 };
                    assert!(
                        (product - expected).abs() < 1e-5,
                        "{rows}x{columns}: {i}, {j}: {product}"
                    );
                }
            }
        }
    }

    /// Andrychowicz et al. 2020 begin with weights of the policy's last layer that are a hundred
    /// times smaller: of orthonormal columns each then has the length 0.01, and no other parameter
    /// is another.
    #[test]
    fn a_head_alone_is_made_smaller() {
        let shape =
            NetworkShape { dense: vec![32], recurrent: Some(32), ..NetworkShape::default() };
        let plain = shape.initial_parameters(Initialisation::Orthogonal, 1, 0);
        let mut small = plain.clone();
        shape.scale_head(0, 0.01, &mut small);
        for parameter in shape.parameters() {
            let (before, after) = (&plain[parameter.range()], &small[parameter.range()]);
            if parameter.name == "head0.weight" {
                for column in 0..parameter.outputs {
                    let values = after.iter().skip(column).step_by(parameter.outputs);
                    let length = values.map(|value| value * value).sum::<f32>().sqrt();
                    assert!((length - 0.01).abs() < 1e-6, "{length}");
                }
            } else {
                assert_eq!(before, after, "{}", parameter.name);
            }
        }
    }

    #[test]
    fn schemes_reach_the_parameters_that_they_should() {
        let shape =
            NetworkShape { dense: vec![32], recurrent: Some(32), ..NetworkShape::default() };
        for scheme in
            [Initialisation::Orthogonal, Initialisation::OrthogonalHeads, Initialisation::Uniform]
        {
            let values = shape.initial_parameters(scheme, 1, 0);
            for parameter in shape.parameters() {
                let block = &values[parameter.range()];
                let zero = block.iter().all(|&v| v == 0.0);
                let biases = match parameter.kind {
                    ParameterKind::Bias => scheme == Initialisation::Uniform,
                    ParameterKind::RecurrentBias => scheme != Initialisation::Orthogonal,
                    _ => true,
                };
                assert_eq!(zero, !biases, "{scheme:?} {}", parameter.name);
                if parameter.kind == ParameterKind::Dense && scheme != Initialisation::Orthogonal {
                    let bound = 1.0 / (parameter.inputs as f32).sqrt();
                    let largest = block.iter().fold(0.0f32, |m, v| m.max(v.abs()));
                    assert!(largest <= bound && largest > 0.9 * bound);
                }
            }
            assert_eq!(values, shape.initial_parameters(scheme, 1, 0));
            assert_ne!(values, shape.initial_parameters(scheme, 2, 0));
            assert_ne!(values, shape.initial_parameters(scheme, 1, 1));
        }
    }
}
