//! What the report reads in run directories: settings, metrics, episodes, heatmaps.

use super::{Target, assert_presentable, nothing_to_repair};
use hasard_report::run::{Config, parse_heatmaps, parse_metrics, read_episode_lines};
use std::path::Path;

/// The text files of a run: the first byte says which.
pub const RUN: Target = Target {
    name: "run",
    samples: || {
        let config = "{\"algorithm\":\"PPOLag\",\"preset\":\"paper\",\"env\":{\"id\":\"RemedyRushLevel1-v0\",\"rules\":\"paper\",\
                      \"hard\":false,\"size\":[128,72]},\"seed\":3,\"frames\":2000000,\"constraints\":[{\"term\":null,\"budget\":5.0},\
                      {\"term\":\"harm\",\"budget\":2}],\"curriculum\":\"1,2,3\"}";
        let metrics = "{\"frames\":4096,\"return_mean\":1.5,\"multipliers\":[0.25],\"losses\":{\"value\":2}}\n\
                       {\"frames\":8192,\"return_mean\":null,\"cost_mean\":3}\n{\"frames\":6000,\"fps\":1e3}\n";
        let episodes = "{\"env\":\"RemedyRushLevel1-v0\",\"return\":4.5,\"cost\":2,\"length\":525}\n{\"summary\":{\"return\":1}}\n";
        let heatmap = "{\"frames\":100,\"episodes\":3,\"extent\":[0,0,64,32],\"columns\":2,\"rows\":1,\"steps\":[1,0.5]}\n";
        [config, metrics, episodes, heatmap]
            .into_iter()
            .zip(b"cmeh")
            .map(|(text, &kind)| [&[kind][..], text.as_bytes()].concat())
            .collect()
    },
    words: &[
        "\"frames\":",
        "\"extent\":[",
        "\"columns\":1024,\"rows\":1024,",
        "\"budget\":",
        "\"safety_budget\":",
        "\"cost_scale\":",
        "PPOCost",
        "\"curriculum\":\",,\"",
    ],
    repair: nothing_to_repair,
    run: |bytes| {
        let Some((kind, text)) = bytes.split_first() else { return false };
        let (text, path) = (String::from_utf8_lossy(text), Path::new("run/file"));
        let mut warnings = Vec::new();
        let read = match kind {
            b'm' => parse_metrics(&text, path, &mut warnings).len(),
            b'e' => read_episode_lines(&text, path, &mut warnings).len(),
            b'h' => parse_heatmaps(&text, path, &mut warnings).len(),
            _ => match Config::parse(&text) {
                Ok(config) => usize::from(std::hint::black_box(config).seed != 1),
                Err(problem) => {
                    assert_presentable(&problem);
                    0
                }
            },
        };
        warnings.iter().for_each(|warning| assert_presentable(&warning.to_string()));
        read > 0
    },
    memory: 64 << 20,
};
