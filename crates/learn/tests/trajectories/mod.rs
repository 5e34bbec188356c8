//! Networks of all kinds, and trajectories of pixels made up for them.

use hasard_learn::config::{Convolution, RecurrentCell};
use hasard_learn::networks::{ImageShape, NetworkShape, PixelScale, Sequences};
use hasard_learn::random::{Purpose, Stream};

/// Small networks, each with its name.
pub fn small_shapes() -> Vec<(&'static str, NetworkShape)> {
    let small = NetworkShape {
        image: ImageShape { height: 11, width: 14, channels: 2 },
        convolutions: vec![
            Convolution { channels: 32, kernel: 4, stride: 2 },
            Convolution { channels: 32, kernel: 3, stride: 2 },
        ],
        residual: vec![],
        dense: vec![64, 32],
        extra_inputs: 1,
        recurrent: Some(32),
        cell: RecurrentCell::Gru,
        heads: vec![3, 2],
        mirror: vec![],
    };
    vec![
        ("overlapping kernels, extra input, two dense layers", small.clone()),
        ("feed-forward", NetworkShape { recurrent: None, ..small.clone() }),
        ("long short-term memory", NetworkShape { cell: RecurrentCell::Lstm, ..small.clone() }),
        (
            "residual encoder",
            NetworkShape { convolutions: vec![], residual: vec![32, 64], ..small.clone() },
        ),
        ("no convolution", NetworkShape { convolutions: vec![], ..small.clone() }),
        (
            "block kernels in a row",
            NetworkShape {
                convolutions: vec![
                    Convolution { channels: 32, kernel: 3, stride: 1 },
                    Convolution { channels: 32, kernel: 2, stride: 2 },
                    Convolution { channels: 64, kernel: 2, stride: 1 },
                ],
                heads: vec![40],
                ..small
            },
        ),
    ]
}

/// Trajectories with resets in the middle.
pub struct Case {
    pub pixels: PixelScale,
    pub observations: Vec<Vec<u8>>,
    pub extra: Vec<f32>,
    pub state: Vec<f32>,
    pub reset: Vec<bool>,
    pub steps: usize,
    pub lanes: usize,
}

impl Case {
    pub fn new(shape: &NetworkShape, steps: usize, lanes: usize) -> Case {
        let mut stream = Stream::new(11, Purpose::Evaluation, 0, 0);
        let mut normals = |count: usize| -> Vec<f32> {
            (0..count).map(|_| 0.3 * stream.normal() as f32).collect()
        };
        let (rows, pixels) = (steps * lanes, shape.image.size());
        let extra = normals(rows * shape.extra_inputs);
        let state = normals(lanes * shape.state_size());
        let shift = normals(pixels);
        let scale = (0..pixels).map(|_| (2.0 + stream.uniform() as f32) / 255.0).collect();
        let observations =
            (0..rows).map(|_| (0..pixels).map(|_| (stream.bits() >> 56) as u8).collect()).collect();
        let reset = (0..rows).map(|_| stream.uniform() < 0.2).collect();
        Case {
            pixels: PixelScale { scale, shift },
            observations,
            extra,
            state,
            reset,
            steps,
            lanes,
        }
    }

    pub fn sequences(&self) -> Sequences<'_> {
        Sequences {
            steps: self.steps,
            lanes: self.lanes,
            observations: self.observations.iter().map(Vec::as_slice).collect(),
            extra: self.extra.clone(),
            initial_state: self.state.clone(),
            reset: self.reset.clone(),
            recorded: Vec::new(),
        }
    }
}

/// Numbers of mean 0 and deviation 1.
pub fn normals(count: usize, seed: u64) -> Vec<f32> {
    let mut stream = Stream::new(12, Purpose::Evaluation, seed, 0);
    (0..count).map(|_| stream.normal() as f32).collect()
}
