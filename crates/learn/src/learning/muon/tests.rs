use super::*;
use crate::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};
use crate::learning::optimiser::Adam;
use crate::networks::cpu::product::tests::noise;

fn block(rows: usize, columns: usize, matrices: usize) -> Block {
    Block { range: 0..rows * columns * matrices, rows, columns, matrices }
}

/// What the weights of a block, zero at first, are after one step down a gradient, in units of the
/// step's size.
fn stepped(kernels: Simd, block: &Block, gradient: &[f32]) -> Vec<f32> {
    let mut parameters = vec![0.0; gradient.len()];
    let mut momentum = vec![0.0; gradient.len()];
    let size = Step { gradient_scale: 3.0, beta: 0.9, size: 1.0 };
    let scratch = &mut Scratch::default();
    step(kernels, block, size, gradient, &mut momentum, &mut parameters, scratch);
    for (momentum, gradient) in momentum.iter().zip(gradient) {
        assert!((momentum - 0.1 * 3.0 * gradient).abs() <= 1e-6 * gradient.abs());
    }
    parameters.iter().map(|parameter| -parameter).collect()
}

/// `left` transposed times `right`, both of so many columns.
fn transposed_product(left: &[f64], right: &[f64], columns: usize) -> Vec<f64> {
    let mut out = vec![0.0; columns * columns];
    for (left, right) in left.chunks(columns).zip(right.chunks(columns)) {
        for (out, left) in out.chunks_mut(columns).zip(left) {
            out.iter_mut().zip(right).for_each(|(out, right)| *out += left * right);
        }
    }
    out
}

/// U Vᵀ of a matrix of no more columns than rows, exactly: X (3 - XᵀX) / 2 until nothing changes
/// (Higham 2008, Functions of Matrices, equation 8.20).
fn polar(matrix: &[f32], columns: usize) -> Vec<f64> {
    let norm = matrix.iter().map(|&value| f64::from(value).powi(2)).sum::<f64>().sqrt();
    let mut x: Vec<f64> = matrix.iter().map(|&value| f64::from(value) / norm).collect();
    for _ in 0..60 {
        let gram = transposed_product(&x, &x, columns);
        for row in x.chunks_mut(columns) {
            let old = row.to_vec();
            for (column, value) in row.iter_mut().enumerate() {
                let moved: f64 =
                    old.iter().enumerate().map(|(k, x)| x * gram[k * columns + column]).sum();
                *value = 1.5 * *value - 0.5 * moved;
            }
        }
    }
    x
}

fn transpose(matrix: &[f32], columns: usize) -> Vec<f32> {
    let rows = matrix.len() / columns;
    (0..columns)
        .flat_map(|column| (0..rows).map(move |row| matrix[row * columns + column]))
        .collect()
}

/// The largest eigenvalue of a symmetric matrix, whatever its sign, by powers.
fn spectral_norm(matrix: &[f64], side: usize) -> f64 {
    let mut vector = vec![1.0; side];
    vector[0] = 2.0;
    let mut norm = 0.0;
    for _ in 0..300 {
        let product = |row: &[f64]| row.iter().zip(&vector).map(|(a, b)| a * b).sum::<f64>();
        let next: Vec<f64> = matrix.chunks(side).map(product).collect();
        norm = next.iter().map(|value| value * value).sum::<f64>().sqrt();
        vector = next.into_iter().map(|value| value / norm).collect();
    }
    norm
}

/// A step X has the singular vectors of the momentum U S Vᵀ, and singular values near 1: with P = U Vᵀ,
/// PᵀX is symmetric, and XᵀX has eigenvalues between 0.3 and 1.7.
#[test]
fn a_step_is_near_the_polar_factor() {
    for kernels in Simd::all() {
        let tolerance = if kernels.family().rounds() { 0.03 } else { 0.001 };
        for (rows, columns) in [(64, 32), (32, 64), (50, 32), (96, 64)] {
            let shape = format!("{kernels:?}, {rows} x {columns}");
            let gradient = noise(rows * columns, 7);
            let found = stepped(kernels, &block(rows, columns, 1), &gradient);
            // Standing, so that there is a column for each singular value.
            let (gradient, found, low) = if rows < columns {
                (transpose(&gradient, columns), transpose(&found, columns), rows)
            } else {
                (gradient, found, columns)
            };
            let root = (rows.max(columns) as f64).sqrt();
            let found: Vec<f64> = found.iter().map(|&value| f64::from(value) / root).collect();
            let stretch = transposed_product(&polar(&gradient, low), &found, low);
            for row in 0..low {
                for column in 0..row {
                    let (one, other) = (stretch[row * low + column], stretch[column * low + row]);
                    assert!((one - other).abs() < tolerance, "{shape}: {one} {other}");
                }
                assert!(stretch[row * low + row] > 0.5, "{shape}: it goes the other way");
            }
            let mut gram = transposed_product(&found, &found, low);
            (0..low).for_each(|at| gram[at * low + at] -= 1.0);
            let most = spectral_norm(&gram, low);
            assert!(most < 0.7, "{shape}: {most}");
        }
    }
}

/// The gates of a recurrent layer are matrices of their own.
#[test]
fn matrices_side_by_side_are_stepped_apart() {
    let kernels = Simd::widest();
    let parts: Vec<Vec<f32>> = (0..3).map(|seed| noise(40 * 32, seed)).collect();
    let rows = (0..40).flat_map(|row| parts.iter().flat_map(move |part| &part[row * 32..][..32]));
    let together: Vec<f32> = rows.copied().collect();
    let found = stepped(kernels, &block(40, 32, 3), &together);
    for (index, part) in parts.iter().enumerate() {
        let own: Vec<f32> =
            found.chunks(96).flat_map(|row| &row[index * 32..][..32]).copied().collect();
        assert_eq!(own, stepped(kernels, &block(40, 32, 1), part));
    }
}

/// Nothing is learned of nothing, and the size is that of the rate.
#[test]
fn no_gradient_makes_no_step_and_any_other_one_of_the_size_asked_for() {
    let kernels = Simd::widest();
    assert_eq!(stepped(kernels, &block(64, 32, 1), &[0.0; 2048]), [0.0; 2048]);
    for size in [1e-6, 1.0, 1e6] {
        let gradient: Vec<f32> = noise(2048, 3).into_iter().map(|value| size * value).collect();
        let squares = stepped(kernels, &block(64, 32, 1), &gradient).into_iter();
        let mean = squares.map(|value| value * value).sum::<f32>() / 2048.0;
        assert!((0.8..1.2).contains(&mean.sqrt()), "{mean}");
    }
}

/// Muon steps three convolutions, a dense layer and the two weights of the gates.
#[test]
fn heads_and_biases_are_left_to_adam() {
    let shape = NetworkShape::default();
    let blocks = Block::all(&shape);
    let of = |name: &str| {
        let parameters = shape.parameters();
        let parameter = parameters.iter().find(|one| one.name == name).unwrap();
        blocks.iter().find(|block| block.range == parameter.range()).cloned()
    };
    assert_eq!(blocks.len(), 6);
    let hidden = of("gru.hidden_weight").unwrap();
    assert_eq!((hidden.rows, hidden.columns, hidden.matrices), (512, 512, 3));
    let first = of("convolution0.weight").unwrap();
    assert_eq!((first.rows, first.columns, first.matrices), (8 * 8 * 3, 32, 1));
    assert!(of("head0.weight").is_none() && of("gru.hidden_bias").is_none());
}

/// Two steps of a network's parameters: those of heads and biases go as Adam steps them, the others
/// do not, and threads change no bit.
#[test]
fn what_is_in_no_block_is_stepped_as_adam_steps_it() {
    let shape = NetworkShape { recurrent: Some(32), dense: vec![32], ..NetworkShape::default() };
    let (count, blocks) = (shape.parameter_count(), Block::all(&shape));
    let env = EnvConfig::new("RemedyRushLevel1-v0");
    let mut settings = TrainConfig::plain(AlgorithmKind::Ppo, Preset::Quick, env).learning;
    let mut moved = |blocks: &[Block], threads: usize| {
        settings.threads = threads;
        let (mut adam, mut parameters) = (Adam::new(count, blocks.to_vec()), noise(count, 1));
        for seed in 2..4 {
            adam.step(Simd::widest(), &noise(count, seed), &mut parameters, 0.5, 0.001, &settings);
        }
        parameters
    };
    let (adam, muon) = (moved(&[], 1), moved(&blocks, 1));
    assert!(moved(&blocks, 3) == muon, "threads change a bit");
    for (at, (one, other)) in adam.iter().zip(&muon).enumerate() {
        let is_in_a_block = blocks.iter().any(|block| block.range.contains(&at));
        assert_eq!(one != other, is_in_a_block, "parameter {at}");
    }
}
