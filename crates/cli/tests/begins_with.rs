//! A run that begins with another's weights plays as that one does.

mod folder;

use folder::Folder;

/// Returns and costs of two episodes, likeliest choices alone.
fn played(folder: &Folder, agent: &str) -> String {
    let text = folder.ok(&format!("eval {agent} --greedy --episodes 2 --json"));
    text.lines().take(2).map(|row| row.split("\"stats\"").next().unwrap().to_string()).collect()
}

/// `tables` lists JUMP before SPEED, `paper` after it: the agent's jumps must not become sprints.
/// At a learning rate of 0 the run stays the agent that it began with.
#[test]
fn an_agent_keeps_its_buttons_under_rules_that_list_them_otherwise() {
    let folder = Folder::new("begins_with");
    let train = "train RemedyRushLevel1 --frames 128 --envs 4 --threads 1 --eval-every 0 --quiet --set sampling.rollout=8 \
                 --set learning.rate=0 --set learning.final_rate=0";
    folder.ok(&format!("{train} --rules tables --init-from zoo:RemedyRushLevel1 --out from_agent"));
    folder.ok(&format!("{train} --init-from zoo:RemedyRushLevel1 --out paper"));
    folder.ok(&format!("{train} --rules tables --init-from paper --out from_run"));
    let agent = played(&folder, "zoo:RemedyRushLevel1 --rules tables");
    assert_eq!(played(&folder, "from_agent --latest"), agent);
    assert_eq!(played(&folder, "from_run --latest"), agent);
}

/// A sweep of one run that begins with the weights of a place; `more` are further settings.
fn sweep(frames: u32, init_from: &str, more: &str) -> String {
    format!(
        "out = \"runs\"\nframes = {frames}\nscenarios = [\"RemedyRush\"]\nlevels = [1]\nalgorithms = [\"PPO\"]\nseeds = [1]\n\
         [options]\ninit-from = \"{init_from}\"\nthreads = 1\nenvs = 2\neval-every = 0\n[settings]\nsampling.rollout = 8\n{more}"
    )
}

/// A sweep took runs from an agent for those from nothing, and could not go on with one.
#[test]
fn a_sweep_knows_what_its_runs_began_with() {
    let folder = Folder::new("begins_with_sweep");
    let sweep = |frames: u32| sweep(frames, "zoo:RemedyRushLevel1", "");
    folder.file("s.toml", sweep(256).as_bytes());
    let line = "sweep s.toml --json";
    assert!(folder.ok(line).contains("\"finished\":1"));
    assert!(folder.ok(line).contains("\"skipped\":1"));
    // What still lacks frames goes on, with the command that began it.
    folder.file("s.toml", sweep(512).as_bytes());
    assert!(folder.ok(line).contains("\"finished\":1"));
    // Its own beginning may be said again, another is refused.
    let path = "runs/RemedyRushLevel1-v0/PPO";
    let run = std::fs::read_dir(folder.0.join(path)).unwrap().next().unwrap().unwrap().path();
    let run = format!("{path}/{}/seed1", run.file_name().unwrap().to_string_lossy());
    let train = "train RemedyRushLevel1 --resume --algo PPO --out";
    let said = folder.refused(&format!("{train} {run} --init-from zoo:VolcanicVentureLevel1"));
    assert!(said.contains("began with other weights, of zoo:RemedyRushLevel1"), "{said}");
    let said = folder.refused(&format!("{train} {run} --init-from nowhere"));
    assert!(said.contains("nowhere") && !said.contains("other weights"), "{said}");
    folder.ok(&format!("{train} {run} --init-from zoo:RemedyRushLevel1 --frames 768 --quiet"));
}

/// What a sweep's runs began with may be gone, or trained on, once they have it.
#[test]
fn a_sweep_needs_no_weights_that_its_runs_have_had() {
    let folder = Folder::new("begins_with_gone");
    let small = "--algo PPO --envs 2 --threads 1 --set sampling.rollout=8 --set network.dense=[32] --set network.recurrent=32 \
                 --eval-every 0 --quiet";
    folder.ok(&format!("train RemedyRushLevel1 {small} --frames 64 --out base"));
    let layers = "network.dense = [32]\nnetwork.recurrent = 32\n";
    let sweep = |frames: u32| sweep(frames, "base", layers);
    folder.file("s.toml", sweep(64).as_bytes());
    assert!(folder.ok("sweep s.toml --json").contains("\"finished\":1"));
    folder.ok("train RemedyRushLevel1 --resume --frames 128 --quiet --out base");
    assert!(folder.ok("sweep s.toml --json").contains("\"skipped\":1"));
    std::fs::remove_dir_all(folder.0.join("base")).unwrap();
    assert!(folder.ok("sweep s.toml --json").contains("\"skipped\":1"));
    folder.file("s.toml", sweep(128).as_bytes());
    assert!(folder.ok("sweep s.toml --json").contains("\"finished\":1"));
    // A run from nothing began with nothing that could be named.
    folder.ok(&format!("train RemedyRushLevel1 {small} --frames 64 --out plain"));
    let said = folder
        .refused("train RemedyRushLevel1 --resume --out plain --init-from zoo:RemedyRushLevel1");
    assert!(said.contains("says of no other weights"), "{said}");
}
