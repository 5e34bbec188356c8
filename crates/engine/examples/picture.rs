//! The engine alone: a map of two rooms, a thing in it, and what a player there sees, as colour and
//! depth: `cargo run --release -p hasard-engine --example picture -- OUT.png`.

use hasard_engine::assets::Assets;
use hasard_engine::map::{Map, MapBuilder, Style};
use hasard_engine::math::{Angle, Fixed};
use hasard_engine::render::{Buffers, FrameScratch, FrameSize, Renderer, Scene, View};
use hasard_engine::world::{ActorKind, World};
use std::io::BufWriter;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or("picture.png".into());
    let room = Style {
        floor: 0,
        ceiling: 160,
        light: 200,
        floor_texture: "FLOOR0_5",
        ceiling_texture: "F_SKY1",
        wall: "STONE2",
        step: "STONE2",
        lintel: "STONE2",
        special: 0,
        tag: 0,
    };
    let mut builder = MapBuilder::new();
    builder.rectangle(room, 0, 0, 512, 512);
    builder.rectangle(Style { floor: 24, ceiling: 128, light: 130, ..room }, 512, 160, 900, 352);
    let map = Arc::new(Map::build(&builder.finish()?, "two rooms", &[])?);
    let scene = Arc::new(Scene::new(&map, Assets::embedded()));
    let mut world = World::new(map, 1);
    world.add_player(Fixed::from_int(64), Fixed::from_int(256), Angle::EAST);
    let at = [300, 300].map(Fixed::from_int);
    world.spawn(ActorKind::HealthBonus, at[0], at[1], Fixed::ZERO);
    let size = FrameSize { width: 640, height: 480 };
    let mut renderer = Renderer::new(scene, Arc::new(View::new(size)?));
    // What frames are drawn in: one for each thread, for any number of renderers.
    let mut scratch = FrameScratch::default();
    renderer.render(&mut scratch, &world, 0, Buffers { depth: true, labels: false });
    let mut rgb = vec![0; 640 * 480 * 3];
    renderer.write_rgb_hwc(&mut rgb);
    let mut encoder = png::Encoder::new(BufWriter::new(std::fs::File::create(&path)?), 640, 480);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&rgb)?;
    println!(
        "{path}; the middle of the picture is {} of 255 deep",
        renderer.depth()[240 * 640 + 320]
    );
    Ok(())
}
