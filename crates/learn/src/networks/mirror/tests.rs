use super::*;
use crate::algorithms::small;
use crate::config::{AlgorithmKind, Convolution, EnvConfig, RecurrentCell, reflections};
use crate::networks::cpu::network::{CpuActor, CpuLearner};
use crate::networks::network::Recording;
use crate::random::{Purpose, Stream};
use hasard_engine::simd::Simd;
use hasard_envs::{ActionSpace, DeltaButton};

const STEPS: usize = 4;
const LANES: usize = 3;

/// Nothing, left or right; nothing or ahead; how far to turn and to look; a value.
fn shape() -> NetworkShape {
    let space = ActionSpace {
        groups: space(true).groups[..2].to_vec(),
        deltas: vec![DeltaButton::Turn, DeltaButton::Look],
    };
    let mut mirror = reflections(&space).unwrap();
    mirror.push(Reflected { column: mirror.len(), opposite: false });
    NetworkShape {
        image: ImageShape { height: 9, width: 12, channels: 3 },
        convolutions: vec![Convolution { channels: 32, kernel: 4, stride: 2 }],
        residual: vec![],
        dense: vec![32],
        extra_inputs: 1,
        recurrent: Some(32),
        cell: RecurrentCell::Gru,
        heads: vec![mirror.len() - 1, 1],
        mirror,
    }
}

/// The buttons of Volcanic Venture 1, and those of its full space.
fn space(simplified: bool) -> ActionSpace {
    let env = EnvConfig { full_actions: !simplified, ..EnvConfig::new("VolcanicVentureLevel1-v0") };
    env.action_space().unwrap().unwrap()
}

struct Trajectories {
    pictures: Vec<Vec<u8>>,
    extra: Vec<f32>,
    state: Vec<f32>,
    reset: Vec<bool>,
}

fn trajectories(shape: &NetworkShape) -> Trajectories {
    let mut stream = Stream::new(5, Purpose::Evaluation, 0, 0);
    let (rows, pixels) = (STEPS * LANES, shape.image.size());
    Trajectories {
        pictures: (0..rows)
            .map(|_| (0..pixels).map(|_| (stream.bits() >> 56) as u8).collect())
            .collect(),
        extra: (0..rows).map(|_| stream.normal() as f32).collect(),
        state: (0..LANES * shape.state_size()).map(|_| 0.3 * stream.normal() as f32).collect(),
        reset: (0..rows).map(|row| row == 7).collect(),
    }
}

impl Trajectories {
    fn sequences(&self) -> Sequences<'_> {
        Sequences {
            steps: STEPS,
            lanes: LANES,
            observations: self.pictures.iter().map(Vec::as_slice).collect(),
            extra: self.extra.clone(),
            initial_state: self.state.clone(),
            reset: self.reset.clone(),
            recorded: Vec::new(),
        }
    }
}

fn parameters(shape: &NetworkShape) -> Vec<f32> {
    let mut stream = Stream::new(6, Purpose::Evaluation, 0, 0);
    (0..shape.parameter_count()).map(|_| 0.2 * stream.normal() as f32).collect()
}

fn pixels(shape: &NetworkShape) -> PixelScale {
    // Not alike on both sides.
    let each = |factor: f32| (0..shape.image.size()).map(move |at| factor * (1 + at % 7) as f32);
    PixelScale { scale: each(0.002).collect(), shift: each(-0.1).collect() }
}

fn learner(shape: &NetworkShape, kernels: Simd) -> MirroredLearner {
    let own = Box::new(CpuLearner::new(kernels, &shape.plain(), 1));
    let mut learner = MirroredLearner::new(shape, own);
    learner.load(&parameters(shape));
    learner.load_pixels(&pixels(shape));
    learner
}

/// By hand: nothing, left, right; nothing, ahead; mean and deviation of two.
#[test]
fn left_stands_beside_right() {
    let columns = |space: &ActionSpace| -> Vec<(usize, bool)> {
        reflections(space).unwrap().iter().map(|other| (other.column, other.opposite)).collect()
    };
    let plain = |columns: &[usize]| -> Vec<(usize, bool)> {
        columns.iter().map(|&column| (column, false)).collect()
    };
    // Turning, walking ahead, jumping, running.
    assert_eq!(columns(&space(true)), plain(&[0, 2, 1, 3, 4, 5, 6, 7, 8]));
    // Moves of the full space: ahead and back, right and left; then buttons without sides; the
    // angle to look up stays, the one to turn by changes its sign.
    let full = columns(&space(false));
    assert_eq!(full[..6], plain(&[0, 1, 2, 3, 5, 4])[..]);
    let (last, deltas) = (full.len(), &full[full.len() - 4..]);
    let expected = [(last - 4, false), (last - 3, false), (last - 2, true), (last - 1, false)];
    assert_eq!(deltas, expected);
    let mut lame = space(true);
    lame.groups[0].buttons.pop();
    let message = reflections(&lame).unwrap_err().to_string();
    assert!(message.contains("TURN_LEFT has no TURN_RIGHT"), "{message}");
}

#[test]
fn pictures_of_any_depth_are_mirrored() {
    for channels in 1..6 {
        let image = ImageShape { height: 2, width: 3, channels };
        let picture: Vec<u8> = (0..image.size() as u8).collect();
        let mut mirrored = vec![0; picture.len()];
        mirror(image, &picture, &mut mirrored);
        for (y, x, channel) in (0..2).flat_map(|y| (0..3).map(move |x| (y, x, channels - 1))) {
            let at = |x: usize| (y * 3 + x) * channels + channel;
            assert_eq!(mirrored[at(x)], picture[at(2 - x)], "{channels} channels");
        }
    }
}

/// The property that is wanted: in a mirrored world it does the same mirrored, to the bit, whatever
/// it remembers.
#[test]
fn a_mirrored_world_is_played_mirrored() {
    let shape = shape();
    let here = trajectories(&shape);
    let units = shape.state_size() / 2;
    let there = Trajectories {
        pictures: here
            .pictures
            .iter()
            .map(|picture| {
                let mut image = vec![0; picture.len()];
                mirror(shape.image, picture, &mut image);
                image
            })
            .collect(),
        extra: here.extra.clone(),
        state: here
            .state
            .chunks_exact(2 * units)
            .flat_map(|both| [&both[units..], &both[..units]].concat())
            .collect(),
        reset: here.reset.clone(),
    };
    for kernels in Simd::available() {
        let mut learner = learner(&shape, kernels);
        let (one, other) =
            (learner.forward(&here.sequences()), learner.forward(&there.sequences()));
        let width = shape.outputs();
        for (one, other) in one.chunks_exact(width).zip(other.chunks_exact(width)) {
            for (column, reflected) in shape.mirror.iter().enumerate() {
                assert_eq!(other[column], reflected.sign() * one[reflected.column], "{column}");
            }
            assert_ne!(one[1], one[2], "left and right are not the same here");
        }
    }
}

/// Acting step by step has the rows of learning, and what it notes is what a learner would compute.
#[test]
fn acting_and_learning_agree() {
    let shape = shape();
    let data = trajectories(&shape);
    let mut learner = learner(&shape, Simd::PLAIN);
    let rows = learner.forward(&data.sequences());
    let mut actor =
        MirroredActor::new(&shape, Box::new(CpuActor::new(Simd::PLAIN, &shape.plain())));
    actor.load(&learner.publish());
    let (mut state, width, units) = (data.state.clone(), shape.outputs(), shape.state_size());
    let mut recording = Recording::default();
    for step in 0..STEPS {
        let now = step * LANES..(step + 1) * LANES;
        for (lane, row) in now.clone().enumerate() {
            if step > 0 && data.reset[row] {
                state[lane * units..(lane + 1) * units].fill(0.0);
            }
        }
        // The lanes in two groups, as samplers have them.
        for lanes in [0..1, 1..LANES] {
            let own = now.start + lanes.start..now.start + lanes.end;
            let mut outputs = vec![0.0; lanes.len() * width];
            let place = Place {
                recording: &mut recording,
                steps: STEPS,
                all_lanes: LANES,
                step,
                lanes: lanes.clone(),
            };
            actor.act(
                &data.pictures[own.clone()].concat(),
                &data.extra[own.clone()],
                &mut state[lanes.start * units..lanes.end * units],
                &mut outputs,
                Some(place),
            );
            assert_eq!(outputs, rows[own.start * width..own.end * width], "step {step}");
        }
    }
    let recorded = || -> Vec<RecordedLane<'_>> {
        (0..LANES).map(|lane| RecordedLane { recording: &recording, lane }).collect()
    };
    let gradient = |learner: &mut MirroredLearner, batch: &Sequences<'_>| {
        let outputs = learner.forward(batch);
        let mut gradient = vec![0.0; shape.parameter_count()];
        learner.backward(batch, &outputs, &mut gradient);
        (outputs, gradient)
    };
    let anew = gradient(&mut learner, &data.sequences());
    let reused = gradient(&mut learner, &Sequences { recorded: recorded(), ..data.sequences() });
    assert_eq!(reused, anew);
}

/// The gradient is the slope of a sum of outputs, by central differences.
#[test]
fn gradients_are_slopes() {
    let shape = shape();
    let data = trajectories(&shape);
    let weights: Vec<f32> =
        (0..STEPS * LANES * shape.outputs()).map(|index| (index as f32 * 0.7).cos()).collect();
    let mut learner = learner(&shape, Simd::PLAIN);
    let start = parameters(&shape);
    let _ = learner.forward(&data.sequences());
    let mut gradient = vec![0.0; start.len()];
    learner.backward(&data.sequences(), &weights, &mut gradient);
    let mut sum = |parameters: &[f32]| -> f64 {
        learner.load(parameters);
        let rows = learner.forward(&data.sequences());
        rows.iter().zip(&weights).map(|(row, weight)| f64::from(row * weight)).sum()
    };
    let mut stream = Stream::new(7, Purpose::Evaluation, 0, 0);
    for _ in 0..5 {
        let way: Vec<f32> = start.iter().map(|_| stream.normal() as f32).collect();
        let at = |step: f32| -> Vec<f32> {
            start.iter().zip(&way).map(|(from, way)| from + step * way).collect()
        };
        let step = 1e-3;
        let measured = (sum(&at(step)) - sum(&at(-step))) / f64::from(2.0 * step);
        let derived: f64 = gradient.iter().zip(&way).map(|(a, b)| f64::from(a * b)).sum();
        let scale = gradient.iter().map(|one| f64::from(one * one)).sum::<f64>().sqrt();
        assert!((measured - derived).abs() < 0.02 * scale, "{measured} {derived} {scale}");
    }
}

/// As many parameters, and twice the arithmetic and state.
#[test]
fn it_costs_two_passes() {
    let (mirrored, plain) = (shape(), shape().plain());
    assert_eq!(mirrored.parameters(), plain.parameters());
    assert_eq!(mirrored.state_size(), 2 * plain.state_size());
    assert_eq!(mirrored.forward_flop(), 2.0 * plain.forward_flop());
    assert_eq!(mirrored.training_flop(), 2.0 * plain.training_flop());
}

#[test]
fn predictions_of_what_a_cell_shows_are_refused() {
    let mut config = small::config(AlgorithmKind::PpoLag);
    config.env = EnvConfig::new("VolcanicVentureLevel1-v0");
    config.network.mirror = true;
    config.check().unwrap();
    config.learning.auxiliary_labels = 0.1;
    let message = config.check().unwrap_err().to_string();
    assert!(message.contains("network.mirror"), "{message}");
}
