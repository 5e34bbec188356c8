use super::*;

fn header() -> Header {
    Header {
        env: "VolcanicVentureLevel1-v0".into(),
        options: BTreeMap::from([
            ("rules".into(), "paper".into()),
            ("full-actions".into(), "true".into()),
        ]),
        seed: u64::MAX,
        program: "0.1.0".into(),
        player: "human".into(),
        steps: 99,
        groups: 3,
        deltas: 2,
        outcome: None,
    }
}

/// A human's episode: keys held for a while, a mouse that moves now and then.
fn human() -> EpisodeFile {
    let mut file = EpisodeFile::new(header()).unwrap();
    for step in 0..2100u32 {
        let mouse = if step / 90 % 3 == 0 { (step % 17) as f32 * 0.01 - 0.05 } else { 0.0 };
        file.push(&[(step / 40 % 3) as u8, (step / 111 % 2) as u8, 0], &[0.0, mouse]).unwrap();
    }
    file.set_outcome(Outcome {
        episode_return: 12.25,
        cost: 3.0,
        truncated: true,
        state_hash: Some(7),
        ..Outcome::default()
    });
    file
}

fn small_random(state: &mut u64) -> u64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    *state >> 33
}

/// Gives bytes the checksum that fits them, as an attacker would.
fn with_checksum(mut bytes: Vec<u8>) -> Vec<u8> {
    let end = bytes.len() - 4;
    let sum = checksum(&bytes[..end]).to_le_bytes();
    bytes[end..].copy_from_slice(&sum);
    bytes
}

#[test]
fn a_minute_of_play_takes_a_few_kilobytes_and_comes_back() {
    let file = human();
    let bytes = file.to_bytes();
    assert!(bytes.len() < 4096, "{} bytes", bytes.len());
    let back = EpisodeFile::from_bytes(&bytes, Path::new("x.episode")).unwrap();
    assert_eq!(back, file);
    assert_eq!(back.header().steps, 2100);
    assert_eq!(back.step(41), Some((&[1u8, 0, 0][..], &[0.0, (41 % 17) as f32 * 0.01 - 0.05][..])));
    assert_eq!(back.step(2100), None);
    assert_eq!(back.header().seed, u64::MAX);
}

#[test]
fn every_flipped_bit_and_every_cut_is_noticed() {
    let mut file = EpisodeFile::new(header()).unwrap();
    file.push(&[1, 0, 1], &[0.5, -0.5]).unwrap();
    let bytes = file.to_bytes();
    for bit in 0..bytes.len() * 8 {
        let mut changed = bytes.clone();
        changed[bit / 8] ^= 1 << (bit % 8);
        assert!(EpisodeFile::from_bytes(&changed, Path::new("x")).is_err(), "bit {bit}");
    }
    for cut in 0..bytes.len() {
        assert!(EpisodeFile::from_bytes(&bytes[..cut], Path::new("x")).is_err(), "cut at {cut}");
    }
}

#[test]
fn hostile_files_with_a_fitting_checksum_cause_no_panic() {
    let bytes = human().to_bytes();
    let mut state = 1;
    for round in 0..20_000 {
        let mut changed = bytes.clone();
        for _ in 0..=small_random(&mut state) % 4 {
            // Mostly the front, where lengths and the header are.
            let span = if round % 2 == 0 { 400.min(changed.len()) } else { changed.len() };
            let at = small_random(&mut state) as usize % span;
            changed[at] = small_random(&mut state) as u8;
        }
        if round % 5 == 0 {
            changed.truncate(10 + small_random(&mut state) as usize % (changed.len() - 10));
            changed.extend([0; 4]);
        }
        match EpisodeFile::from_bytes(&with_checksum(changed), Path::new("hostile.episode")) {
            // What is accepted can be written and read again.
            Ok(file) => assert_eq!(
                EpisodeFile::from_bytes(&file.to_bytes(), Path::new("again")).unwrap(),
                file
            ),
            Err(error) => {
                let line = error.to_string();
                assert!(line.starts_with("hostile.episode: ") && !line.contains('\n'), "{line}");
            }
        }
    }
}

#[test]
fn a_body_that_inflates_without_end_is_cut_short() {
    let mut bomb = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    bomb.write_all(&vec![0; 32 << 20]).unwrap();
    let body = bomb.finish().unwrap();
    let mut header = header();
    header.steps = 5;
    let header = serde_json::to_vec(&header).unwrap();
    let mut bytes = MAGIC.to_vec();
    bytes.extend(FORMAT_VERSION.to_le_bytes());
    bytes.extend((header.len() as u32).to_le_bytes());
    bytes.extend(&header);
    bytes.extend((body.len() as u32).to_le_bytes());
    bytes.extend(&body);
    bytes.extend([0; 4]);
    let error =
        EpisodeFile::from_bytes(&with_checksum(bytes), Path::new("bomb")).unwrap_err().to_string();
    assert!(error.contains("does not hold the 5 steps"), "{error}");
}

#[test]
fn the_message_says_what_to_do() {
    let message = |bytes: &[u8]| {
        EpisodeFile::from_bytes(bytes, Path::new("a/b.episode")).unwrap_err().to_string()
    };
    assert_eq!(
        message(b"hello"),
        "a/b.episode: is no episode file; `hasard record` and `hasard play` write them"
    );
    let mut newer = human().to_bytes();
    newer[8] = 9;
    assert!(message(&newer).contains("version 9, and this program reads version 1"));
    let mut file = human();
    assert!(file.push(&[0, 0], &[0.0, 0.0]).is_err());
    assert!(file.push(&[0, 0, 0], &[0.0, f32::NAN]).is_err());
    assert!(file.check_actions(&[3, 2, 2], 2, Path::new("x")).is_ok());
    assert!(file.check_actions(&[3, 2], 2, Path::new("x")).is_err());
    let error = file.check_actions(&[2, 2, 2], 2, Path::new("x")).unwrap_err().to_string();
    assert_eq!(error, "x: step 80: sub-action 0 is 2, beyond the 2 choices");
}

#[test]
fn files_are_written_and_read() {
    let path = std::env::temp_dir().join(format!("hasard-{}.episode", std::process::id()));
    human().write(&path).unwrap();
    assert_eq!(EpisodeFile::read(&path).unwrap(), human());
    std::fs::remove_file(&path).unwrap();
    assert!(EpisodeFile::read(&path).unwrap_err().to_string().contains("cannot read"));
}
