use super::*;
use std::path::PathBuf;
use std::process::Command;

/// A picture of a moving scene: a scrolling textured wall, a box that crosses it, noise, a flash.
fn scene(width: usize, height: usize, k: usize) -> Picture {
    let mut rgb = Vec::with_capacity(width * height * 3);
    let mut state = k as u64 + 1;
    for y in 0..height {
        for x in 0..width {
            let u = x + 5 * k;
            let brick = (u / 12 + y / 7) % 2 * 60 + (u * 7 + y * 13) % 23;
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let noise = if y > height * 3 / 4 { (state >> 58) as usize } else { 0 };
            let flash = if k % 9 == 8 { 90 } else { 0 };
            rgb.extend([(80 + brick + flash).min(255) as u8, (50 + brick / 2 + noise) as u8, (30 + y * 120 / height) as u8]);
        }
    }
    let mut picture = Picture::from_rgb(width, height, rgb).unwrap();
    picture.fill((k * 9) % width, height / 3, 18, 25, [250, 20, 30]);
    picture
}

fn temporary(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("hasard-video-{}-{name}", std::process::id()))
}

/// Encodes frames and keeps what a decoder must show.
fn encode(path: &Path, width: usize, height: usize, frames: usize) -> Vec<plane::Frame> {
    let mut writer = VideoWriter::create(path, width, height, (35, 4)).unwrap();
    let mut expected = Vec::new();
    for k in 0..frames {
        writer.push(&scene(width, height, k)).unwrap();
        expected.push(writer.encoder.shown().clone());
    }
    writer.finish().unwrap();
    expected
}

/// The visible part of a frame as raw planes.
fn visible(frame: &plane::Frame, width: usize, height: usize) -> Vec<u8> {
    let (width, height) = (width.next_multiple_of(2), height.next_multiple_of(2));
    let mut bytes = Vec::new();
    for (plane, shrink) in frame.planes.iter().zip([1, 2, 2]) {
        for row in plane.samples.chunks_exact(plane.width).take(height / shrink) {
            bytes.extend(&row[..width / shrink]);
        }
    }
    bytes
}

#[test]
fn a_foreign_decoder_shows_exactly_what_ours_expects() {
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        eprintln!("skipped: no ffmpeg on this machine to decode with (apt-get install ffmpeg)");
        return;
    }
    for (width, height, frames) in [(96, 64, 20), (160, 120, 30), (128, 72, 150), (50, 34, 8), (331, 203, 5), (16, 16, 3)] {
        let path = temporary(&format!("{width}x{height}.mp4"));
        let expected = encode(&path, width, height, frames);
        let output = Command::new("ffmpeg")
            .args([
                "-v",
                "warning",
                "-i",
                path.to_str().unwrap(),
                "-f",
                "rawvideo",
                "-pix_fmt",
                "yuv420p",
                "-fps_mode",
                "passthrough",
                "-",
            ])
            .output()
            .unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
        let size = visible(&expected[0], width, height).len();
        assert_eq!(output.stdout.len(), size * frames, "{width}x{height}");
        for (k, frame) in expected.iter().enumerate() {
            assert!(output.stdout[k * size..][..size] == visible(frame, width, height), "{width}x{height}: frame {k} differs");
        }
        std::fs::remove_file(path).unwrap();
    }
}

#[test]
fn pictures_stay_close_to_the_source_and_files_small() {
    let path = temporary("close.mp4");
    let expected = encode(&path, 160, 120, 30);
    for (k, frame) in expected.iter().enumerate() {
        let mut source = plane::Frame::new(160, 120);
        source.fill(&scene(160, 120, k));
        let squares = |a: &plane::Plane, b: &plane::Plane| -> f64 {
            let pairs = a.samples.iter().zip(&b.samples);
            pairs.map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>() / a.samples.len() as f64
        };
        for (plane, (a, b)) in source.planes.iter().zip(&frame.planes).enumerate() {
            let noise = 10.0 * (255.0 * 255.0 / squares(a, b).max(1e-9)).log10();
            assert!(noise > 38.0, "frame {k} plane {plane}: {noise:.1} dB");
        }
    }
    // A quarter of the pixels is noise that cannot be predicted; stored plainly it would be 57,600 bytes a frame.
    let bytes = std::fs::metadata(&path).unwrap().len();
    assert!(bytes < 30 * 12_000, "{bytes}");
    std::fs::remove_file(path).unwrap();
}

#[test]
fn the_bytes_are_those_that_were_checked_with_a_foreign_decoder() {
    // If this fails, the encoder was changed: run the test above on a machine that has ffmpeg, then set the new sum here.
    let path = temporary("golden.mp4");
    encode(&path, 96, 64, 20);
    let mut crc = flate2::Crc::new();
    crc.update(&std::fs::read(&path).unwrap());
    assert_eq!(crc.sum(), GOLDEN);
    std::fs::remove_file(path).unwrap();
}

const GOLDEN: u32 = 1_241_597_353;

#[test]
fn what_cannot_be_is_refused() {
    let path = temporary("refused.mp4");
    assert!(VideoWriter::create(&path, 0, 10, (35, 4)).is_err());
    assert!(VideoWriter::create(&path, 5000, 10, (35, 4)).is_err());
    assert!(VideoWriter::create(&path, 10, 10, (0, 4)).is_err());
    assert!(VideoWriter::create(&path, 10, 10, (u32::MAX, 1)).is_err());
    let mut writer = VideoWriter::create(&path, 10, 10, (35, 1)).unwrap();
    assert!(writer.push(&Picture::filled(11, 10, [0; 3])).is_err());
    assert!(writer.finish().unwrap_err().to_string().contains("at least one frame"));
    assert!(!path.exists());
}
