//! Claims: what holds is confirmed to the bit, on any kernels and threads; what was forged is
//! refused.

mod folder;

use folder::Folder;
use serde_json::{Value, json};

const SMALL: &str = "--algo PPOLag --envs 2 --threads 1 --set network.dense=[32] --set network.recurrent=32 --set sampling.rollout=8 \
                     --set episode_steps=8 --observation grey --size 64x48 --frames 64 --quiet --eval-every 64 \
                     --set evaluation.episodes=1 --set evaluation.confirming_episodes=2";

/// A folder with a claim of a small agent, and another agent's file. Four episodes are enough for
/// other rules to make a difference.
fn claimed(name: &str) -> (Folder, String, Value) {
    let folder = Folder::new(name);
    folder.ok(&format!("train RemedyRushLevel1-v0 --out run --seed 1 {SMALL}"));
    folder.ok(&format!("train RemedyRushLevel1-v0 --out other --seed 2 {SMALL}"));
    folder.ok("export-agent other -o other.agent");
    let printed = folder.ok("claim run --name mine --episodes 4 -o board --json");
    let path =
        serde_json::from_str::<Value>(&printed).unwrap()["claim"].as_str().unwrap().to_string();
    let claim = serde_json::from_slice(&folder.read(&path)).unwrap();
    (folder, path, claim)
}

#[test]
fn a_claim_holds_on_all_kernels_and_threads() {
    let (folder, path, claim) = claimed("claim_holds");
    assert_eq!(
        (&claim["rules"], &claim["episodes"], &claim["first_seed"]),
        (&json!("paper"), &json!(4), &json!(9_000_000))
    );
    for simd in ["plain", "avx2", "avx512"] {
        for threads in [1, 2] {
            let output = folder
                .run_with(&format!("verify {path} --threads {threads}"), &[("HASARD_SIMD", simd)]);
            let printed = String::from_utf8_lossy(&output.stdout).into_owned();
            // A processor without the instructions refuses the variable.
            let lacks =
                simd != "plain" && String::from_utf8_lossy(&output.stderr).contains("HASARD_SIMD");
            assert!(
                lacks || (output.status.success() && printed.contains("holds")),
                "{simd}, {threads}: {printed}"
            );
        }
    }
    // Under other rules the same agent makes another claim.
    folder.ok("claim run --name mine --rules released --episodes 2 -o board --json");
    assert_eq!(folder.ok("verify board --json").lines().count(), 2);
}

#[test]
fn forged_claims_are_refused() {
    let (folder, path, claim) = claimed("claim_forged");
    let agent = claim["agent"].as_str().unwrap().to_string();
    let sha = |bytes: &[u8]| hasard_learn::runs::checksum::sha256(bytes);
    let other = folder.read("other.agent");
    let forgeries: &[(&str, Value, &str)] = &[
        ("return_mean", json!(claim["return_mean"].as_f64().unwrap() + 1.0), "return"),
        (
            "return_mean",
            json!(f64::from_bits(claim["return_mean"].as_f64().unwrap().to_bits() + 1)),
            "return",
        ),
        ("cost_mean", json!(claim["cost_mean"].as_f64().unwrap() - 0.5), "cost"),
        ("digest", json!("00"), "digest"),
        ("first_seed", json!(1), "seed 1"),
        ("episodes", json!(1), "digest"),
        ("episodes", json!(0), "0 episodes"),
        ("rules", json!("released"), "episodes were others"),
        ("rules", json!("mild"), "no rules 'mild'"),
        ("environment", json!("RemedyRushLevel2-v0"), "environment"),
        ("hard", json!(true), "hard"),
        ("algorithm", json!("PPO"), "algorithm"),
        ("frames", json!(1), "frames"),
        ("agent_sha256", json!(sha(&other)), "another agent"),
        ("agent", json!("../run/checkpoints"), "plain name"),
    ];
    for (field, value, word) in forgeries {
        let mut forged = claim.clone();
        forged[*field] = value.clone();
        folder.file("board/forged.claim.json", forged.to_string().as_bytes());
        let output = folder.run("verify board/forged.claim.json");
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(1), "{field} {value}: {printed}");
        assert!(
            printed.contains("does not hold") && printed.contains(word),
            "{field} {value}: {printed}"
        );
    }
    // Weights swapped, with and without their own digest.
    folder.file(&format!("board/{agent}"), &other);
    assert_eq!(folder.run(&format!("verify {path}")).status.code(), Some(1));
    let mut forged = claim.clone();
    forged["agent_sha256"] = json!(sha(&other));
    folder.file("board/forged.claim.json", forged.to_string().as_bytes());
    assert_eq!(folder.run("verify board/forged.claim.json").status.code(), Some(1));
    // Not a claim at all: bad input.
    for text in ["", "{}", "[1]", &json!({ "format": 9 }).to_string()] {
        folder.file("bad.claim.json", text.as_bytes());
        assert!(folder.refused("verify bad.claim.json").contains("bad.claim.json"), "{text}");
    }
    assert!(folder.refused("verify missing.claim.json").contains("missing.claim.json"));
}

/// Names that differ in signs alone make one file's name, and the second claim replaced the first.
#[test]
fn a_claim_of_another_name_is_not_replaced() {
    let (folder, path, claim) = claimed("claim_names");
    let refused = folder.refused("claim run --name MINE! --episodes 2 -o board");
    assert!(refused.contains("the claim of 'mine'"), "{refused}");
    assert_eq!(serde_json::from_slice::<Value>(&folder.read(&path)).unwrap(), claim);
    folder.ok("claim run --name mine --episodes 2 -o board");
}

#[test]
fn a_scoreboard_lists_what_holds_and_says_what_does_not() {
    let (folder, path, claim) = claimed("claim_board");
    // Two episodes are too few to be listed.
    let output = folder.run("scoreboard board --json");
    let printed: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((output.status.code(), &printed["hold"]), (Some(1), &json!(0)), "{printed}");
    assert!(
        printed["refused"][0]["why"].as_str().unwrap().contains("one of 200, 1000, 10000"),
        "{printed}"
    );
    let page = String::from_utf8(folder.read("board/index.html")).unwrap();
    assert!(page.contains("Not listed"), "the page says why");
    let _ = (path, claim);
    assert!(folder.refused("scoreboard other").contains("hasard claim"));
}

/// Neither a claim's own words nor a reader that leaves make a claim hold that does not.
#[test]
fn words_and_readers_change_no_verdict() {
    let (folder, path, claim) = claimed("claim_words");
    let mut forged = claim.clone();
    forged["environment"] = json!("\u{1b}[31mX\n fake.claim.json: holds: return 99");
    folder.file("board/forged.claim.json", forged.to_string().as_bytes());
    let output = folder.run("verify board");
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!((output.status.code(), printed.lines().count()), (Some(1), 2), "{printed}");
    assert!(!printed.contains('\u{1b}'), "{printed}");
    for line in ["verify board", "verify board --json", "scoreboard board"] {
        let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_hasard"))
            .args(line.split(' '))
            .current_dir(&folder.0)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        assert_eq!(child.wait().unwrap().code(), Some(1), "{line}, and nobody reads");
    }
    // Names that do not show, or that turn the row round.
    for name in ["", "  ", "a\u{202e}b", "a\u{7}", &"x".repeat(81)] {
        let mut forged = claim.clone();
        forged["name"] = json!(name);
        folder.file("board/forged.claim.json", forged.to_string().as_bytes());
        assert!(folder.refused("verify board/forged.claim.json").contains("its name must have"));
    }
    let long = "x".repeat(81);
    assert!(folder.refused(&format!("claim run --name {long} -o board")).contains("80 letters"));
    // Another agent's claim of the same name keeps its place.
    let refused = folder.refused("claim other --name mine --episodes 2 -o board");
    assert!(refused.contains("the claim of another agent"), "{refused}");
    assert_eq!(serde_json::from_slice::<Value>(&folder.read(&path)).unwrap(), claim);
}

/// A published folder would lack the file that a link leads to.
#[cfg(unix)]
#[test]
fn an_agent_that_is_a_link_is_refused() {
    let (folder, path, claim) = claimed("claim_link");
    let agent = folder.0.join("board").join(claim["agent"].as_str().unwrap());
    std::fs::rename(&agent, folder.0.join("elsewhere.agent")).unwrap();
    std::os::unix::fs::symlink(folder.0.join("elsewhere.agent"), &agent).unwrap();
    let output = folder.run(&format!("verify {path}"));
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.code() == Some(1) && printed.contains("is a link"), "{printed}");
}
