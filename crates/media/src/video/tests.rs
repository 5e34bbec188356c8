use super::*;
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
    let mut writer = VideoWriter::create(path, width, height, (35, 4)).unwrap();
    for k in 0..frames {
        writer.push(&scene(width, height, k)).unwrap();
    }
    writer.finish().unwrap();
}

#[test]
fn a_foreign_decoder_shows_every_frame_much_as_it_was() {
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        eprintln!("skipped: no ffmpeg on this machine to decode with (apt-get install ffmpeg)");
        return;
    }
    for (width, height, frames) in [(96, 64, 20), (128, 72, 150), (331, 203, 5), (16, 16, 3)] {
        let path = temporary(&format!("{width}x{height}.mp4"));
        write(&path, width, height, frames);
        let name = path.to_str().unwrap();
        let decode = ["-v", "warning", "-i", name, "-f", "rawvideo", "-pix_fmt", "yuv420p", "-fps_mode", "passthrough", "-"];
        let output = Command::new("ffmpeg").args(decode).output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
        let mut source = YuvFrame::black(width.next_multiple_of(2), height.next_multiple_of(2));
        let size = source.y.len() * 3 / 2;
        assert_eq!(output.stdout.len(), size * frames, "{width}x{height}");
        for (k, frame) in output.stdout.chunks_exact(size).enumerate() {
            fill(&mut source, &scene(width, height, k));
            let off: u64 = source.y.iter().zip(frame).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
            assert!(off / (source.y.len() as u64) < 24, "{width}x{height}: frame {k} differs by {off}");
        }
        std::fs::remove_file(path).unwrap();
    }
}

#[test]
fn same_frames_give_same_bytes_and_no_more_than_the_rate() {
    let (first, second) = (temporary("first.mp4"), temporary("second.mp4"));
    write(&first, 160, 120, 140);
    write(&second, 160, 120, 140);
    let bytes = std::fs::read(&first).unwrap();
    assert!(bytes == std::fs::read(&second).unwrap());
    let limit = 160.0 * 120.0 * 140.0 * BITS_A_PIXEL / 8.0;
    assert!((bytes.len() as f64) < 1.2 * limit, "{} of {limit}", bytes.len());
    std::fs::remove_file(first).unwrap();
    std::fs::remove_file(second).unwrap();
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
    assert!(VideoWriter::create(&path, 0, 10, (35, 4)).is_err());
    assert!(VideoWriter::create(&path, 5000, 10, (35, 4)).is_err());
    assert!(VideoWriter::create(&path, 10, 10, (0, 4)).is_err());
    assert!(VideoWriter::create(&path, 10, 10, (u32::MAX, 1)).is_err());
    let mut writer = VideoWriter::create(&path, 16, 16, (35, 1)).unwrap();
    assert!(writer.push(&Picture::filled(11, 16, [0; 3])).is_err());
    assert!(writer.finish().unwrap_err().to_string().contains("at least one frame"));
    assert!(!path.exists());
}
