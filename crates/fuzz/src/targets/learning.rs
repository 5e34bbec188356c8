//! What training writes: settings and checkpoints.
