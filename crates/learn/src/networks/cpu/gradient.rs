//! Gradients of parameters: sums over the rows of a batch, dealt out to threads.
//!
//! Threads share out the numbers of a dense layer's gradient, each of them summed over all rows in
//! order, and the lanes of the convolutions' in a number of groups that follows from the batch
//! alone. So no bit depends on the number of threads.

use crate::networks::PixelScale;
use crate::networks::cpu::backward::RowGradients;
use crate::networks::cpu::elementwise::add;
use crate::networks::cpu::encoder_gradient::{EncoderGradient, Scratch};
use crate::networks::cpu::outer::{Workspace, sum_outer_products};
use crate::networks::cpu::tape::{Tape, TapeLane};
use crate::networks::cpu::weights::{Backward, PackedWeights, Plan};
use crate::threads::{Piece, deal, in_parallel, pieces};
use hasard_engine::simd::Simd;

/// Most groups that lanes are dealt into, which bounds memory and the threads that convolutions
/// keep busy.
const MOST_GROUPS: usize = 16;

/// Buffers that are used again.
#[derive(Default)]
pub struct ParameterGradients {
    threads: Vec<(Scratch, Workspace)>,
    groups: Vec<EncoderGradient>,
    joined_heads: Vec<f32>,
    joined_biases: Vec<f32>,
}

/// A batch whose row gradients are known.
pub struct Finished<'a> {
    /// Where each lane's activations are.
    pub lanes: &'a [TapeLane<'a>],
    /// Images, by lane, then by time.
    pub observations: &'a [&'a [u8]],
    /// Weights of that pass.
    pub weights: &'a PackedWeights,
    /// How pixels enter.
    pub pixels: &'a PixelScale,
    /// Gradients of rows, their lanes one after the other.
    pub rows: &'a [&'a RowGradients],
}

type Work<'a> = Piece<'a, (Scratch, Workspace)>;

/// The factors of a weight gradient, row by row.
struct Factors<'a> {
    inputs: Vec<&'a [f32]>,
    sums: Vec<&'a [f32]>,
    width: usize,
    columns: usize,
}

impl<'a> Factors<'a> {
    /// The gradient of the weights, its rows in so many pieces, and that of the biases.
    fn deal_out<'b>(
        &'b self,
        kernels: Simd,
        pieces: usize,
        mut weights: &'b mut [f32],
        biases: &'b mut [f32],
        work: &mut Vec<Work<'b>>,
    ) {
        for rows in deal(weights.len() / self.columns, pieces) {
            let out;
            (out, weights) = weights.split_at_mut(rows.len() * self.columns);
            work.push(Box::new(move |(_, workspace)| {
                sum_outer_products(
                    kernels,
                    &self.inputs,
                    rows,
                    &self.sums,
                    self.columns,
                    out,
                    workspace,
                );
            }));
        }
        work.push(Box::new(move |_| {
            biases.fill(0.0);
            self.sums.iter().for_each(|row| add(kernels, biases, row));
        }));
    }
}

impl<'a> Finished<'a> {
    /// The factors of every dense layer and of the recurrent one, in the order of the parameters.
    fn layers(&self, plan: &Plan) -> Vec<Factors<'a>> {
        let shape = &plan.shape;
        let mut layers = Vec::new();
        for (index, &units) in shape.dense.iter().enumerate() {
            let input = |tape: &'a Tape| -> &'a [f32] {
                if index == 0 { &tape.features } else { &tape.dense[index - 1] }
            };
            layers.push(self.factors(
                input,
                plan.dense(index).inputs,
                |rows| &rows.dense[index],
                units,
                false,
            ));
        }
        if let Some(units) = shape.recurrent {
            let (inputs, columns) = (shape.core_inputs(), shape.gate_columns());
            layers.push(self.factors(
                |tape| &tape.core_input,
                inputs,
                |rows| &rows.input_sums,
                columns,
                false,
            ));
            layers.push(self.factors(
                |tape| &tape.before,
                units,
                |rows| &rows.state_sums,
                columns,
                true,
            ));
        }
        layers
    }

    /// One buffer of the tapes and the row gradients that belong to it.
    fn factors(
        &self,
        input: impl Fn(&'a Tape) -> &'a [f32],
        width: usize,
        sums: impl Fn(&'a RowGradients) -> &'a [f32],
        columns: usize,
        by_time: bool,
    ) -> Factors<'a> {
        let steps = self.lanes.first().map_or(0, |lane| lane.tape.steps);
        let inputs = self
            .lanes
            .iter()
            .flat_map(|lane| lane.of(input(lane.tape), width).chunks_exact(width))
            .collect();
        let rows = self.rows.iter().flat_map(|rows| {
            let sums = sums(rows);
            (0..rows.lanes).flat_map(move |lane| {
                (0..steps).map(move |step| {
                    let row = if by_time { step * rows.lanes + lane } else { lane * steps + step };
                    &sums[row * columns..(row + 1) * columns]
                })
            })
        });
        Factors { inputs, sums: rows.collect(), width, columns }
    }
}

impl ParameterGradients {
    /// Writes the gradients of all parameters to `gradient`, on `threads` threads.
    pub fn run(
        &mut self,
        plan: &Plan,
        back: &Backward,
        batch: &Finished<'_>,
        threads: usize,
        gradient: &mut [f32],
    ) {
        let (kernels, shape) = (plan.kernels, &plan.shape);
        let steps = batch.lanes.first().map_or(0, |lane| lane.tape.steps);
        let layers = batch.layers(plan);
        let heads = batch.factors(
            |tape| tape.core(plan),
            shape.head_inputs(),
            |rows| &rows.outputs,
            plan.padded_outputs,
            false,
        );
        let (convolutions, mut rest) = gradient.split_at_mut(plan.dense(0).offset);
        let lanes: Vec<_> = deal(batch.lanes.len(), MOST_GROUPS).collect();
        self.groups.resize_with(lanes.len(), Default::default);
        let features = plan.features;
        let feature_gradients: Vec<&[f32]> = batch
            .rows
            .iter()
            .flat_map(|rows| {
                (0..rows.lanes)
                    .map(|lane| rows.features.get(lane * steps * features..).unwrap_or(&[]))
            })
            .collect();
        let mut work: Vec<Work<'_>> = Vec::new();
        // The longest pieces first.
        if !plan.convolutions.is_empty() {
            for (group, lanes) in self.groups.iter_mut().zip(&lanes) {
                let feature_gradients = &feature_gradients;
                work.push(Box::new(move |(scratch, _)| {
                    group.clear(plan);
                    for lane in lanes.clone() {
                        let observations = &batch.observations[lane * steps..(lane + 1) * steps];
                        let from = feature_gradients[lane];
                        let lane = batch.lanes[lane];
                        group.add_lane(
                            plan,
                            batch.weights,
                            back,
                            batch.pixels,
                            lane,
                            observations,
                            from,
                            scratch,
                        );
                    }
                }));
            }
        }
        for factors in &layers {
            let (weights, biases);
            (weights, rest) = rest.split_at_mut(factors.width * factors.columns);
            (biases, rest) = rest.split_at_mut(factors.columns);
            factors.deal_out(kernels, pieces(threads), weights, biases, &mut work);
        }
        // The heads' lie side by side, padded to whole panels, until they are split.
        self.joined_heads.resize(heads.width * heads.columns, 0.0);
        self.joined_biases.resize(heads.columns, 0.0);
        heads.deal_out(
            kernels,
            pieces(threads),
            &mut self.joined_heads,
            &mut self.joined_biases,
            &mut work,
        );
        self.threads.resize_with(threads, Default::default);
        self.threads.iter_mut().for_each(|(scratch, _)| scratch.prepare(plan));
        in_parallel(&mut self.threads, work);

        let mut rest = convolutions;
        let mut work = Vec::new();
        for (layer, convolution) in plan.convolutions.iter().enumerate() {
            let (weights, biases);
            (weights, rest) = rest.split_at_mut(plan.convolution(layer).size());
            (biases, rest) = rest.split_at_mut(convolution.channels());
            let groups = &self.groups;
            work.push(move |_: &mut _| {
                weights.fill(0.0);
                biases.fill(0.0);
                groups
                    .iter()
                    .for_each(|group| group.add_to(layer, convolution, plan, weights, biases));
            });
        }
        in_parallel(&mut self.threads, work);
        self.split_heads(plan, gradient);
    }

    /// From the heads side by side to the parameters of each.
    fn split_heads(&self, plan: &Plan, gradient: &mut [f32]) {
        let mut first = 0;
        for (index, &count) in plan.shape.heads.iter().enumerate() {
            let parameter = plan.head(index);
            let rows = self.joined_heads.chunks_exact(plan.padded_outputs);
            for (to, from) in gradient[parameter.range()].chunks_exact_mut(count).zip(rows) {
                to.copy_from_slice(&from[first..first + count]);
            }
            gradient[plan.after(parameter).range()]
                .copy_from_slice(&self.joined_biases[first..first + count]);
            first += count;
        }
    }
}
