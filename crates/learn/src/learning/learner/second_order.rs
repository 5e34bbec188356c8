//! What second-order steps ask of a learner: the policy network alone, under parameters of its own.

use super::{Learner, Minibatch};
use crate::learning::loss::Heads;
use crate::networks::ModelSequences;

impl Learner {
    /// The policy network's outputs under its present parameters: where actors recorded them, they
    /// are not computed anew.
    pub fn present_outputs(&mut self, batch: &mut ModelSequences<'_>) -> Vec<f32> {
        self.refresh();
        self.networks.forward_network(0, batch)
    }

    /// Policy outputs under other parameters of the policy network.
    pub fn policy_outputs(
        &mut self,
        batch: &mut ModelSequences<'_>,
        parameters: &[f32],
    ) -> Vec<f32> {
        self.refresh_pixels();
        self.stale[0] = true;
        self.networks.load_network(0, parameters);
        self.networks.forward_network(0, batch)
    }

    /// The policy that some outputs of its network are, as heads without values.
    #[must_use]
    pub fn policy_heads(&self, minibatch: &Minibatch<'_>, outputs: &[f32]) -> Heads {
        Heads::new(&self.shape, outputs, self.shape.action.parameters(), minibatch)
    }

    /// The gradient in the policy network's parameters from that of its outputs of the last forward
    /// pass.
    pub fn policy_backward(
        &mut self,
        batch: &mut ModelSequences<'_>,
        rows: &[f32],
        gradient: &mut [f32],
    ) {
        self.networks.backward_network(0, batch, rows, gradient);
    }

    /// Replaces the policy network's parameters.
    pub fn set_policy_parameters(&mut self, parameters: &[f32]) {
        let range = self.shape.parameter_range(0);
        self.parameters[range].copy_from_slice(parameters);
        self.stale[0] = true;
    }

    /// Policy outputs under parameters of the policy network, in float32 whatever the run's
    /// products: differences of outputs a little way apart are what rounding leaves nothing of.
    pub fn fisher_outputs(
        &mut self,
        batch: &mut ModelSequences<'_>,
        parameters: &[f32],
    ) -> Vec<f32> {
        self.refresh_pixels();
        let Some(fisher) = &mut self.fisher else { return self.policy_outputs(batch, parameters) };
        fisher.load_network(0, parameters);
        fisher.forward_network(0, batch)
    }

    /// The same under the present parameters; where products are not rounded, what actors recorded
    /// is not computed anew.
    pub fn fisher_origin(&mut self, batch: &mut ModelSequences<'_>) -> Vec<f32> {
        if self.fisher.is_none() {
            return self.present_outputs(batch);
        }
        self.fisher_outputs(batch, &self.policy_parameters())
    }

    /// The gradient from that of the outputs of the last [`Learner::fisher_outputs`].
    pub fn fisher_backward(
        &mut self,
        batch: &mut ModelSequences<'_>,
        rows: &[f32],
        gradient: &mut [f32],
    ) {
        let network = self.fisher.as_mut().unwrap_or(&mut self.networks);
        network.backward_network(0, batch, rows, gradient);
    }
}
