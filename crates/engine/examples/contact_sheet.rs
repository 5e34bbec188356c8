//! Writes every embedded picture to contact sheets, to be looked at: `cargo run --release -p hasard-engine --example
//! contact_sheet -- OUTDIR [ZOOM [NAMES [FRAMES]]]`, NAMES beginnings of names joined by commas. Textures are shown tiled twice across and down, sprites by frame and rotation.

use hasard_engine::assets::{Assets, Image, SPRITE_NAMES};
use std::path::Path;

/// A sheet under construction: RGB rows that grow downwards.
struct Sheet {
    width: usize,
    zoom: usize,
    rgb: Vec<u8>,
    cursor_x: usize,
    row_height: usize,
    row_top: usize,
}

impl Sheet {
    fn new(width: usize, zoom: usize) -> Sheet {
        Sheet { width, zoom, rgb: Vec::new(), cursor_x: 0, row_height: 0, row_top: 0 }
    }

    fn next_row(&mut self) {
        self.row_top += self.row_height + 4;
        self.cursor_x = 0;
        self.row_height = 0;
    }

    fn put(&mut self, assets: &Assets, image: &Image, mirrored: bool, tiles: usize) {
        let (width, height) = (image.width as usize, image.height as usize);
        let (full_width, full_height) = (width * tiles * self.zoom, height * tiles * self.zoom);
        if self.cursor_x + full_width > self.width && self.cursor_x > 0 {
            self.next_row();
        }
        self.row_height = self.row_height.max(full_height);
        let rows = self.row_top + full_height;
        if self.rgb.len() < rows * self.width * 3 {
            let background = [60u8, 70, 90];
            let missing = rows * self.width - self.rgb.len() / 3;
            self.rgb.extend(background.iter().copied().cycle().take(missing * 3));
        }
        for y in 0..full_height {
            for x in 0..full_width.min(self.width - self.cursor_x) {
                let (column, row) = (x / self.zoom % width, y / self.zoom % height);
                let column = if mirrored { width - 1 - column } else { column };
                let at = column * height + row;
                if image.mask.as_ref().is_none_or(|mask| mask[at] != 0) {
                    let colour = assets.palette[image.pixels[at] as usize];
                    let to = ((self.row_top + y) * self.width + self.cursor_x + x) * 3;
                    self.rgb[to..to + 3].copy_from_slice(&colour);
                }
            }
        }
        self.cursor_x += full_width + 4;
    }

    fn save(&self, path: &Path) {
        let height = self.rgb.len() / 3 / self.width;
        if height == 0 {
            return;
        }
        let file = std::fs::File::create(path).expect("the output folder is writable");
        let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), self.width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a PNG header can be written");
        writer.write_image_data(&self.rgb).expect("the pixels can be written");
        println!("{} {}x{height}", path.display(), self.width);
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let Some(out) = arguments.get(1).map(Path::new) else {
        eprintln!("contact_sheet: give the folder to write to");
        std::process::exit(2);
    };
    let zoom = arguments.get(2).and_then(|z| z.parse().ok()).unwrap_or(2);
    let only = arguments.get(3);
    let frames_shown = arguments.get(4).and_then(|n| n.parse().ok()).unwrap_or(usize::MAX);
    std::fs::create_dir_all(out).expect("the output folder can be made");
    let start = std::time::Instant::now();
    let assets = Assets::embedded();
    println!("painted {} pictures in {:.1} ms", assets.images.len(), start.elapsed().as_secs_f64() * 1e3);

    let chosen = |name: &str| only.is_none_or(|only| only.split(',').any(|part| name.starts_with(part)));
    let mut textures = Sheet::new(1400, zoom.min(2));
    for (name, entry) in assets.textures.iter().filter(|(name, _)| chosen(name.as_str())) {
        let image = &assets.images[entry.first as usize];
        let mut sum = [0usize; 3];
        for &pixel in &image.pixels {
            (0..3).for_each(|c| sum[c] += assets.palette[pixel as usize][c] as usize);
        }
        let mean = sum.map(|s| s / image.pixels.len());
        println!("{:8} {}x{} frames {} mean {mean:?}", name.as_str(), image.width, image.height, entry.frames);
        textures.put(&assets, image, false, if image.width <= 64 { 2 } else { 1 });
    }
    textures.save(&out.join("textures.png"));

    let mut sprites = Sheet::new(1400, zoom);
    for (sprite, _) in assets.sprites.iter().zip(SPRITE_NAMES).filter(|(_, name)| chosen(name)) {
        sprites.next_row();
        for frame in sprite.frames.iter().take(frames_shown) {
            let same = frame.images.iter().all(|&image| image == frame.images[0]);
            for rotation in 0..if same { 1 } else { 8 } {
                if let Some(image) = assets.images.get(frame.images[rotation] as usize) {
                    sprites.put(&assets, image, frame.mirrored[rotation], 1);
                }
            }
        }
    }
    sprites.save(&out.join("sprites.png"));

    let mut graphics = Sheet::new(1400, zoom);
    for (_, &image) in assets.graphics.iter().filter(|(name, _)| chosen(name.as_str())) {
        graphics.put(&assets, &assets.images[image as usize], false, 1);
    }
    graphics.save(&out.join("graphics.png"));

    let mut palette = Sheet::new(16 * 16 * 4, 16);
    for index in 0..=255u8 {
        let swatch = Image { width: 1, height: 1, offset_x: 0, offset_y: 0, pixels: Box::new([index]), mask: None };
        palette.put(&assets, &swatch, false, 1);
    }
    palette.save(&out.join("palette.png"));
}
