//! Muon (Jordan et al. 2024, <https://kellerjordan.github.io/posts/muon/>): steps of matrices in
//! which all directions count the same.
//!
//! A matrix of weights goes by the orthogonal matrix that is nearest to its momentum, U Vᵀ of
//! M = U S Vᵀ, so that directions which gradients rarely point in are learned as fast as the others.
//! Five steps of a polynomial of odd powers bring the singular values to between about 0.7 and 1.2,
//! which is near enough.

use crate::networks::cpu::panels::Panels;
use crate::networks::cpu::product::{Left, Size, multiply_panels};
use crate::networks::cpu::symmetric::multiply_symmetric;
use crate::networks::cpu::tile::PANEL;
use crate::networks::{NetworkShape, Parameter, ParameterKind};
use hasard_engine::simd::Simd;
use std::ops::Range;

/// Steps of the polynomial.
const STEPS: usize = 5;
/// Its coefficients, of x, x³ and x⁵: those of the page above, which raise small singular values the
/// fastest.
const COEFFICIENTS: [f32; 3] = [3.4445, -4.7750, 2.0315];

/// Matrices that stand side by side in one block of the flat parameters, as the gates of a
/// recurrent layer do; each is made orthogonal by itself.
#[derive(Clone, PartialEq, Debug)]
pub struct Block {
    /// Its place in the flat vector.
    pub range: Range<usize>,
    rows: usize,
    /// Columns of each matrix.
    columns: usize,
    matrices: usize,
}

impl Block {
    /// The blocks of a network: weights of its hidden layers. Heads and biases are no such.
    #[must_use]
    pub fn all(shape: &NetworkShape) -> Vec<Block> {
        let block = |parameter: &Parameter| {
            let matrices = match parameter.kind {
                ParameterKind::Convolution | ParameterKind::Dense => 1,
                ParameterKind::Recurrent => parameter.outputs / shape.recurrent?,
                _ => return None,
            };
            let rows = parameter.size() / parameter.outputs;
            let columns = parameter.outputs / matrices;
            Some(Block { range: parameter.range(), rows, columns, matrices })
        };
        shape.parameters().iter().filter_map(block).collect()
    }
}

/// What a step makes of gradients.
#[derive(Clone, Copy)]
pub struct Step {
    /// Factor of the gradient.
    pub gradient_scale: f32,
    /// Decay of the momentum.
    pub beta: f32,
    /// Root mean square of the entries of a matrix's step.
    pub size: f32,
}

/// Room for one matrix.
#[derive(Default)]
pub struct Scratch {
    /// The matrix, lying: no more rows than columns.
    matrix: Vec<f32>,
    next: Vec<f32>,
    gram: Vec<f32>,
    square: Vec<f32>,
    panels: Panels,
    rounded: Vec<u16>,
}

/// One step of all matrices of a block: `momentum` and `parameters` are changed.
pub fn step(
    kernels: Simd,
    block: &Block,
    step: Step,
    gradient: &[f32],
    momentum: &mut [f32],
    parameters: &mut [f32],
    scratch: &mut Scratch,
) {
    let Step { gradient_scale, beta, size } = step;
    for (momentum, gradient) in momentum.iter_mut().zip(gradient) {
        *momentum = beta * *momentum + (1.0 - beta) * gradient_scale * gradient;
    }
    let Block { rows, columns, matrices, .. } = *block;
    // Lying, and padded with zeros, which change no singular value but 0.
    let (low, wide) = (rows.min(columns), rows.max(columns));
    let (low, wide) = (low.next_multiple_of(PANEL), wide.next_multiple_of(PANEL));
    let is_turned = rows > columns;
    let place = |row: usize, column: usize| {
        if is_turned { column * wide + row } else { row * wide + column }
    };
    // An orthogonal matrix has so much in each entry, in the mean.
    let entry = 1.0 / (rows.max(columns) as f32).sqrt();
    for matrix in 0..matrices {
        let at = |row: usize| (row * matrices + matrix) * columns;
        scratch.matrix.clear();
        scratch.matrix.resize(low * wide, 0.0);
        for row in 0..rows {
            let own = at(row)..at(row) + columns;
            for (column, (momentum, gradient)) in
                momentum[own.clone()].iter().zip(&gradient[own]).enumerate()
            {
                // Nesterov's: as though the momentum had been moved by this gradient once more.
                scratch.matrix[place(row, column)] =
                    beta * momentum + (1.0 - beta) * gradient_scale * gradient;
            }
        }
        scratch.orthogonalise(kernels, low, wide);
        for row in 0..rows {
            for (column, parameter) in parameters[at(row)..][..columns].iter_mut().enumerate() {
                *parameter -= size / entry * scratch.matrix[place(row, column)];
            }
        }
    }
}

impl Scratch {
    /// Brings the singular values of its matrix near 1; one of zeros stays so.
    fn orthogonalise(&mut self, kernels: Simd, low: usize, wide: usize) {
        let [first, third, fifth] = COEFFICIENTS;
        let norm = crate::networks::cpu::elementwise::sum_of_squares(kernels, &self.matrix).sqrt();
        // At most 1 each then.
        let scale = 1.0 / (norm as f32).max(f32::MIN_POSITIVE);
        self.matrix.iter_mut().for_each(|value| *value *= scale);
        self.gram.resize(low * low, 0.0);
        self.square.resize(low * low, 0.0);
        self.next.resize(low * wide, 0.0);
        let Scratch { matrix, next, gram, square, panels, rounded } = self;
        for _ in 0..STEPS {
            panels.pack_transposed(kernels, matrix, wide, low);
            multiply_symmetric(kernels, low, Left::rows(matrix, wide), panels, wide, gram, rounded);
            panels.pack(kernels, gram, low, low);
            multiply_symmetric(kernels, low, Left::rows(gram, low), panels, low, square, rounded);
            for (gram, square) in gram.iter_mut().zip(square.iter()) {
                *gram = third * *gram + fifth * square;
            }
            panels.pack(kernels, matrix, low, wide);
            let (size, left) =
                (Size { rows: low, columns: wide, inner: low }, Left::rows(gram, low));
            multiply_panels(kernels, size, left, panels, next, wide, false, rounded);
            for (matrix, next) in matrix.iter_mut().zip(next.iter()) {
                *matrix = first * *matrix + next;
            }
        }
    }
}

#[cfg(test)]
mod tests;
