//! An agent's file, which is handed from one person to another: read, and acted by.

use super::learning::{fit_header, folder, of_a_run, small};
use super::{Target, assert_presentable};
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::agent::{Choice, TrainedPolicy, Which};
use hasard_learn::runs::agent_file::export;

/// An agent's file.
pub const AGENT: Target = Target {
    name: "agent",
    samples: || {
        let mut config = small();
        config.evaluation.every = Some(config.frames);
        (config.evaluation.episodes, config.evaluation.confirming_episodes) = (1, Some(1));
        config.constraints[0].budget = 1000.0;
        vec![of_a_run("export", config, |run| {
            export(run).expect("the sample run exports an agent")
        })]
    },
    words: &[
        "\\\"dense\\\":[65536]",
        "\\\"residual\\\":[32]",
        "\\\"recurrent\\\":65536",
        "\\\"separate\\\":true",
        "\\\"format\\\":2",
        "\"dtype\":\"F32\"",
        "\"data_offsets\":[0,0]",
        "\"shape\":[]",
        "\"__metadata__\":{}",
        "network0.dense0.weight.scale",
    ],
    repair: |bytes| fit_header(&bytes),
    run: act,
    memory: 64 << 20,
};

fn act(bytes: &[u8]) -> bool {
    let path = folder("agent");
    std::fs::write(&path, bytes).expect("a place for files");
    let (pixels, action) = ([48, 64, 1], ActionShape { sizes: vec![3, 2], deltas: 0 });
    match TrainedPolicy::load(&path, Which::Selected, pixels, action, &mut |_| {}) {
        Ok(policy) => {
            let mut agent = policy.agent(Choice::Greedy, 2);
            assert_eq!(agent.act(&[7; 2 * 48 * 64]).len(), 2);
            true
        }
        Err(error) => {
            assert_presentable(&error.to_string());
            false
        }
    }
}
