//! Writes every embedded picture to contact sheets, to be looked at: `cargo run --release -p
//! hasard-engine --example embedded_pictures -- OUTDIR [ZOOM [NAMES [FRAMES]]]`, NAMES beginnings
//! of names joined by commas. Textures are shown tiled twice across and down, sprites by frame and
//! rotation.

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
        let mut encoder =
            png::Encoder::new(std::io::BufWriter::new(file), self.width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a PNG header can be written");
        writer.write_image_data(&self.rgb).expect("the pixels can be written");
        println!("{} {}x{height}", path.display(), self.width);
    }
}

/// The view weapons with the sprites of their flashes.
const VIEW_WEAPONS: [(&str, &str); 7] = [
    ("PISG", "PISF"),
    ("SHTG", "SHTF"),
    ("SHT2", "SHTF"),
    ("CHGG", "CHGF"),
    ("MISG", "MISF"),
    ("PLSG", "PLSF"),
    ("BFGG", "BFGF"),
];

/// A 320 by 200 screen that weapons and the status bar are laid on.
struct Screen {
    image: Image,
}

impl Screen {
    fn new() -> Screen {
        let pixels = vec![9; 320 * 200].into();
        Screen {
            image: Image { width: 320, height: 200, offset_x: 0, offset_y: 0, pixels, mask: None },
        }
    }

    fn lay(&mut self, image: &Image, left: i32, top: i32) {
        for x in 0..i32::from(image.width) {
            for y in 0..i32::from(image.height) {
                let at = (x * i32::from(image.height) + y) as usize;
                let (to_x, to_y) = (left + x, top + y);
                let opaque = image.mask.as_ref().is_none_or(|mask| mask[at] != 0);
                if opaque && (0..320).contains(&to_x) && (0..200).contains(&to_y) {
                    self.image.pixels[(to_x * 200 + to_y) as usize] = image.pixels[at];
                }
            }
        }
    }

    /// Lays a view weapon where it rests; the view is centred 16 rows higher than the screen, as
    /// with the status bar.
    fn weapon(&mut self, assets: &Assets, name: &str, frame: usize) {
        let sprite =
            &assets.sprites[SPRITE_NAMES.iter().position(|&n| n == name).expect("a listed sprite")];
        if let Some(frame) = sprite.frames.get(frame) {
            let image = &assets.images[frame.images[0] as usize];
            self.lay(image, 1 - i32::from(image.offset_x), 32 - 16 - i32::from(image.offset_y));
        }
    }

    fn status_bar(&mut self, assets: &Assets) {
        let mut put = |name: &str, x, y| {
            let index = assets.graphics[&hasard_engine::map::TextureName::new(name)];
            self.lay(&assets.images[index as usize], x, y);
        };
        put("STBAR", 0, 168);
        put("STARMS", 104, 168);
        for (i, digit) in [1, 0, 0].into_iter().enumerate() {
            put(&format!("STTNUM{digit}"), 48 + 14 * i as i32, 171);
        }
        put("STTPRCNT", 90, 171);
        put("STTNUM5", 30, 171);
        put("STTNUM0", 207, 171);
        put("STTPRCNT", 221, 171);
        put("STFST01", 148, 170);
        put("STKEYS1", 239, 171);
        for i in 0..6 {
            let name = if i == 3 { "STYSNUM" } else { "STGNUM" };
            put(&format!("{name}{}", 2 + i), 111 + 12 * (i % 3), 172 + 10 * (i / 3));
        }
        for row in 0..4 {
            put("STYSNUM5", 284, 173 + 6 * row);
            put("STYSNUM0", 310, 173 + 6 * row);
            put("STYSNUM5", 306, 173 + 6 * row);
        }
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
    println!(
        "painted {} pictures in {:.1} ms",
        assets.images.len(),
        start.elapsed().as_secs_f64() * 1e3
    );

    let chosen =
        |name: &str| only.is_none_or(|only| only.split(',').any(|part| name.starts_with(part)));
    let mut textures = Sheet::new(1400, zoom.min(2));
    for (name, entry) in assets.textures.iter().filter(|(name, _)| chosen(name.as_str())) {
        let image = &assets.images[entry.first as usize];
        let mut sum = [0usize; 3];
        for &pixel in &image.pixels {
            (0..3).for_each(|c| sum[c] += assets.palette[pixel as usize][c] as usize);
        }
        let mean = sum.map(|s| s / image.pixels.len());
        println!(
            "{:8} {}x{} frames {} mean {mean:?}",
            name.as_str(),
            image.width,
            image.height,
            entry.frames
        );
        textures.put(&assets, image, false, if image.width <= 64 { 2 } else { 1 });
    }
    textures.save(&out.join("textures.png"));

    let mut sprites = Sheet::new(1400, zoom);
    for (sprite, _) in assets.sprites.iter().zip(SPRITE_NAMES).filter(|(_, name)| chosen(name)) {
        if sprite.frames.iter().any(|frame| frame.images[0] != frame.images[1]) {
            sprites.next_row();
        }
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

    let mut screens = Sheet::new(1960, 2);
    for (weapon, flash) in VIEW_WEAPONS.into_iter().filter(|(weapon, _)| chosen(weapon)) {
        for (frame, flash_frame) in [(0, None), (1, Some(0)), (2, None)] {
            let mut screen = Screen::new();
            screen.weapon(&assets, weapon, frame);
            if let Some(flash_frame) = flash_frame {
                screen.weapon(&assets, flash, flash_frame);
            }
            screen.status_bar(&assets);
            screens.put(&assets, &screen.image, false, 1);
        }
    }
    screens.save(&out.join("screens.png"));

    let mut palette = Sheet::new(16 * 16 * 4, 16);
    for index in 0..=255u8 {
        let swatch = Image {
            width: 1,
            height: 1,
            offset_x: 0,
            offset_y: 0,
            pixels: Box::new([index]),
            mask: None,
        };
        palette.put(&assets, &swatch, false, 1);
    }
    palette.save(&out.join("palette.png"));
}
