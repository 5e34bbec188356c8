//! Spoiled copies of level files, each given to the reader of `--maps` within its limits.
//!
//! ```sh
//! cargo run --release -p hasard-fuzz --example spoiled_levels -- COUNT SEED FILE...
//! ```
//!
//! The files are the user's own copies; prints how many copies were read, were refused in one line,
//! or failed (panic, more than 3 s, memory beyond the format's bound).

use hasard_engine::math::Rng;
use hasard_engine::wad::{self, Lump, Wad, WadKind};
use hasard_fuzz::mutation::mutated;
use hasard_fuzz::targets;
use hasard_fuzz::verdict::{Verdict, listen, try_input};
use std::process::ExitCode;

/// A copy with faults: in its bytes as they lie in one of four; otherwise within one lump, in a
/// file that is sound around it. The texts are chosen as often as all pictures.
fn spoiled(rng: &mut Rng, bytes: &[u8], words: &[&str]) -> Vec<u8> {
    let Ok(file) = Wad::read(bytes) else { return mutated(rng, bytes, words, &[]) };
    if rng.below(4) == 0 {
        return mutated(rng, bytes, words, &[]);
    }
    let is_text = |lump: &Lump<'_>| TEXTS.contains(&lump.name.as_str());
    let texts = rng.below(2) == 0;
    let full = |lump: &Lump<'_>| !lump.bytes.is_empty();
    let chosen: Vec<usize> = (0..file.lumps.len())
        .filter(|&i| full(&file.lumps[i]) && is_text(&file.lumps[i]) == texts)
        .collect();
    let Some(&at) = chosen.get(rng.below(chosen.len().max(1) as u32) as usize) else {
        return mutated(rng, bytes, words, &[]);
    };
    let fault = mutated(rng, file.lumps[at].bytes, words, &[]);
    let mut lumps = file.lumps.clone();
    lumps[at].bytes = &fault;
    wad::write(WadKind::Pwad, &lumps)
}

/// Lumps of text that are read.
const TEXTS: [&str; 4] = ["TEXTMAP", "TEXTURES", "ANIMDEFS", "MAPINFO"];

fn main() -> Result<ExitCode, Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [count, seed, files @ ..] = words.as_slice() else {
        return Err("give COUNT SEED FILE...".into());
    };
    let (count, mut rng): (usize, Rng) = (count.parse()?, Rng::new(seed.parse()?));
    let target = targets::ALL
        .iter()
        .find(|target| target.name == "level")
        .ok_or("no target of that name")?;
    let files = files.iter().map(std::fs::read).collect::<Result<Vec<_>, _>>()?;
    if files.is_empty() {
        return Err("name the files to spoil".into());
    }
    listen();
    let (mut read, mut refused, mut failed) = (0, 0, 0);
    for copy in 0..count {
        let spoiled = (target.repair)(spoiled(&mut rng, &files[copy % files.len()], target.words));
        match try_input(target, &spoiled) {
            Verdict::Accepted => read += 1,
            Verdict::Refused => refused += 1,
            Verdict::Failed(kind, text) => {
                failed += 1;
                println!("copy {copy}: {kind}: {}", text.escape_debug());
            }
        }
    }
    println!(
        "{count} spoiled copies of {} files: {read} read, {refused} refused, {failed} failed",
        files.len()
    );
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
