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
