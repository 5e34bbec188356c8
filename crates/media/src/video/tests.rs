use super::*;
use std::io::Write;
use std::process::Command;

/// A picture of a moving scene: a scrolling textured wall and a box that crosses it.
fn scene(width: usize, height: usize, k: usize) -> Picture {
    let mut rgb = Vec::with_capacity(width * height * 3);
    for y in 0..height {
        for x in 0..width {
            let u = x + 3 * k;
            let brick = (u / 12 + y / 7) % 2 * 60 + (u * 7 + y * 13) % 23;
            rgb.extend([(80 + brick) as u8, (50 + brick / 2) as u8, (30 + y * 120 / height) as u8]);
        }
    }
    let mut picture = Picture::from_rgb(width, height, rgb).unwrap();
    picture.fill((k * 9) % width, height / 3, 18, 25, [250, 20, 30]);
    picture
}

fn temporary(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("hasard-video-{}-{name}", std::process::id()))
}

fn write(path: &Path, width: usize, height: usize, frames: usize) {
    let mut writer = VideoWriter::create(path, width, height, (35, 4), Quality::default()).unwrap();
    for k in 0..frames {
        writer.push(&scene(width, height, k)).unwrap();
    }
    writer.finish().unwrap();
}

#[test]
fn a_foreign_decoder_shows_every_frame_much_as_it_was() {
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        // Past the capture of the test runner: ./check counts it.
        let _ = writeln!(
            std::io::stderr(),
            "skipped: no ffmpeg on this machine to decode with (apt-get install ffmpeg)"
        );
        return;
    }
    for (width, height, frames) in [(96, 64, 20), (128, 72, 150), (331, 203, 5), (16, 16, 3)] {
        let path = temporary(&format!("{width}x{height}.mp4"));
        write(&path, width, height, frames);
        let name = path.to_str().unwrap();
        let decode = [
            "-v",
            "warning",
            "-i",
            name,
            "-f",
            "rawvideo",
            "-pix_fmt",
            "yuv420p",
            "-fps_mode",
            "passthrough",
            "-",
        ];
        let output = Command::new("ffmpeg").args(decode).output().unwrap();
        assert!(
            output.status.success() && output.stderr.is_empty(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let mut source = YuvFrame::black(width.next_multiple_of(2), height.next_multiple_of(2));
        let size = source.y.len() * 3 / 2;
        assert_eq!(output.stdout.len(), size * frames, "{width}x{height}");
        for (k, frame) in output.stdout.chunks_exact(size).enumerate() {
            fill(&mut source, &scene(width, height, k));
            let off: u64 = source.y.iter().zip(frame).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
            assert!(
                off / (source.y.len() as u64) < 24,
                "{width}x{height}: frame {k} differs by {off}"
            );
        }
        std::fs::remove_file(path).unwrap();
    }
}

/// Decoded pictures of a file, as brightness.
fn decoded(path: &Path, frames: usize, (width, height): (usize, usize)) -> Option<Vec<Vec<u8>>> {
    Command::new("ffmpeg").arg("-version").output().ok()?;
    let name = path.to_str().unwrap();
    let decode = [
        "-v",
        "warning",
        "-i",
        name,
        "-f",
        "rawvideo",
        "-pix_fmt",
        "yuv420p",
        "-fps_mode",
        "passthrough",
        "-",
    ];
    let output = Command::new("ffmpeg").args(decode).output().unwrap();
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(output.stdout.len(), width * height * 3 / 2 * frames);
    Some(
        output
            .stdout
            .chunks_exact(width * height * 3 / 2)
            .map(|frame| frame[..width * height].to_vec())
            .collect(),
    )
}

/// The size follows from the quality, and the bytes from the pictures alone.
#[test]
fn same_frames_give_same_bytes_and_a_better_quality_costs_more() {
    let sizes: Vec<usize> = ["20", "55", "90"]
        .map(|quality| {
            let (first, second) =
                (temporary(&format!("{quality}-1.mp4")), temporary(&format!("{quality}-2.mp4")));
            let bytes = [first, second].map(|path| {
                let mut writer =
                    VideoWriter::create(&path, 160, 120, (35, 4), quality.parse().unwrap())
                        .unwrap();
                (0..300).for_each(|k| writer.push(&scene(160, 120, k)).unwrap());
                writer.finish().unwrap();
                let bytes = std::fs::read(&path).unwrap();
                std::fs::remove_file(path).unwrap();
                bytes
            });
            assert!(bytes[0] == bytes[1]);
            bytes[0].len()
        })
        .into();
    assert!(sizes[0] * 2 < sizes[1] && sizes[1] * 2 < sizes[2], "{sizes:?}");
    assert!(["101", "-1", "", "good"].iter().all(|bad| bad.parse::<Quality>().is_err()));
}

/// Row 4 of a newcomer's list: after each flash of the screen the pictures were blocks for half a
/// second.
#[test]
fn a_flash_leaves_the_pictures_after_it_as_they_were() {
    let path = temporary("flash.mp4");
    let (width, height, frames) = (160, 120, 60);
    let picture = |k: usize| {
        let mut picture = scene(width, height, 0);
        // A flash of three pictures, as a pick-up's, then the same scene again.
        if (30..33).contains(&k) {
            for y in 0..height {
                for x in 0..width {
                    picture.blend(x as isize, y as isize, [230, 200, 60], 150);
                }
            }
        }
        picture
    };
    let mut writer =
        VideoWriter::create(&path, width, height, (35, 1), Quality::default()).unwrap();
    (0..frames).for_each(|k| writer.push(&picture(k)).unwrap());
    writer.finish().unwrap();
    let shown = decoded(&path, frames, (width, height));
    std::fs::remove_file(path).unwrap();
    let Some(shown) = shown else { return };
    let mut source = YuvFrame::black(width, height);
    let error = |k: usize, source: &mut YuvFrame| {
        fill(source, &picture(k));
        source.y.iter().zip(&shown[k]).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>()
            / source.y.len() as f64
    };
    let before = (20..30).map(|k| error(k, &mut source)).sum::<f64>() / 10.0;
    for k in 30..45 {
        let now = error(k, &mut source);
        assert!(
            now < 2.0 * before + 4.0,
            "picture {k}: squared error {now}, {before} before the flash"
        );
    }
}

/// Stretches are coded on several threads: what players jump to lies where they begin.
#[test]
fn a_cut_begins_a_stretch_that_stands_alone() {
    let frame = |value: u8| {
        let mut frame = YuvFrame::black(32, 32);
        frame.y.fill(value);
        frame
    };
    let mut segments =
        Segments::new(EncoderConfig { mbtree: false, scenecut: 0, ..EncoderConfig::new(32, 32) })
            .unwrap();
    let mut coded = Vec::new();
    for k in 0..400 {
        // A cut at 20, a flicker at 25 that is too near to it, then stretches of 140.
        let value = if k < 20 {
            40
        } else if k == 25 {
            200
        } else {
            90
        };
        coded.extend(segments.push(frame(value)).unwrap());
    }
    coded.extend(segments.finish().unwrap());
    let begins: Vec<usize> = (0..coded.len()).filter(|k| coded[*k].1).collect();
    assert_eq!((coded.len(), begins), (400, vec![0, 20, 160, 300]));
    // Each of them holds the sequence's parameters and an IDR picture (NAL units 7 and 5).
    let holds = |unit: &[u8], kind: u8| {
        unit.windows(4).any(|bytes| bytes[..3] == [0, 0, 1] && bytes[3] & 31 == kind)
    };
    assert!(coded.iter().all(|(unit, alone)| holds(unit, 5) == *alone && holds(unit, 7) == *alone));
}

#[test]
fn white_black_and_pure_colours() {
    for (colour, expected) in [
        ([0, 0, 0], [16, 128, 128]),
        ([255, 255, 255], [235, 128, 128]),
        ([255, 0, 0], [81, 90, 240]),
        ([0, 255, 0], [145, 54, 34]),
        ([0, 0, 255], [41, 240, 110]),
    ] {
        let mut frame = YuvFrame::black(4, 4);
        fill(&mut frame, &Picture::filled(3, 3, colour));
        // The edge goes on into the padding.
        let last = |plane: &[u8]| *plane.last().unwrap();
        assert_eq!([last(&frame.y), last(&frame.u), last(&frame.v)], expected, "{colour:?}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let path = temporary("refused.mp4");
    assert!(VideoWriter::create(&path, 0, 10, (35, 4), Quality::default()).is_err());
    assert!(VideoWriter::create(&path, 5000, 10, (35, 4), Quality::default()).is_err());
    assert!(VideoWriter::create(&path, 10, 10, (0, 4), Quality::default()).is_err());
    assert!(VideoWriter::create(&path, 10, 10, (u32::MAX, 1), Quality::default()).is_err());
    let mut writer = VideoWriter::create(&path, 16, 16, (35, 1), Quality::default()).unwrap();
    assert!(writer.push(&Picture::filled(11, 16, [0; 3])).is_err());
    assert!(writer.finish().unwrap_err().to_string().contains("at least one frame"));
    assert!(!path.exists());
}
