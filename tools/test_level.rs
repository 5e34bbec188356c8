//! Draws views of a small test level, to be looked at: `cargo run --release -p
//! hasard-engine --example test_level -- OUTDIR`.

use hasard_engine::assets::{Assets, sprite_index};
use hasard_engine::map::{Map, MapBuilder, Mark, SectorId, Style, TileGrid};
use hasard_engine::math::{Angle, Fixed, Rng};
use hasard_engine::render::{
    Buffers, FrameScratch, FrameSize, Renderer, Scene, SegmentationColours, TopDown, View,
};
use hasard_engine::world::{ActorKind, PlayerSprite, Weapon, World};
use std::path::Path;
use std::sync::Arc;

fn volcano() -> Map {
    let style = |column: usize, row: usize| Style {
        floor: 0,
        ceiling: 250,
        light: 210,
        floor_texture: "LAVA1",
        ceiling_texture: "FLAT5_5",
        wall: "A-BROK28",
        step: "AQF052",
        lintel: "AQF052",
        special: 0,
        tag: (100 + row * 17 + column) as i32,
    };
    let mut builder = MapBuilder::new();
    TileGrid::new((0, 64), 128, 17, 17, style).paint(&mut builder);
    Map::build(&builder.finish().unwrap(), "volcano", &["FLOOR0_5"]).unwrap()
}

/// A yard under the sky with steps, a gallery, a rock, a fence and a pit.
fn yard() -> Map {
    let style = Style {
        floor: 0,
        ceiling: 250,
        light: 210,
        floor_texture: "STONE5",
        ceiling_texture: "F_SKY1",
        wall: "A-BROK28",
        step: "AQF052",
        lintel: "RROCK15",
        special: 0,
        tag: 0,
    };
    let mut builder = MapBuilder::new();
    builder.rectangle(style, -600, -300, 1700, 1500);
    let tile = |column: usize, row: usize| Style {
        floor: ((column * 7 + row * 5) % 6) as i32 * 8,
        ..style
    };
    TileGrid::new((0, 0), 128, 8, 8, tile).paint(&mut builder);
    let gallery = Style {
        ceiling: 96,
        light: 120,
        ceiling_texture: "FLAT5_5",
        floor_texture: "FLOOR0_5",
        ..style
    };
    builder.rectangle(gallery, 1100, 100, 1500, 700);
    builder.rectangle(
        Style { floor: -64, light: 100, floor_texture: "LAVA1", ..style },
        -500,
        0,
        -200,
        300,
    );
    builder.solid(&[(-300, 900), (-200, 800), (-100, 900), (-200, 1000)]);
    let fence =
        Mark { middle: Some("MIDBARS3"), blocking: true, lower_unpegged: true, ..Mark::default() };
    builder.mark(fence, &[(-500, 600), (-100, 600)]);
    Map::build(&builder.finish().unwrap(), "yard", &[]).unwrap()
}

fn world(map: &Arc<Map>) -> World {
    let mut world = World::new(map.clone(), 1);
    world.add_player(Fixed::from_int(1088), Fixed::from_int(1152), Angle::EAST);
    world
}

fn items(world: &mut World, seed: u64, count: usize, kinds: &[ActorKind]) {
    let mut rng = Rng::new(seed);
    for i in 0..count {
        let (x, y) =
            (Fixed::from_int(rng.between(20, 2150)), Fixed::from_int(rng.between(84, 2220)));
        let id = world.spawn(kinds[i % kinds.len()], x, y, Fixed::ZERO);
        let actor = world.get_mut(id).unwrap();
        (actor.z, actor.angle) = (actor.floor_z, Angle(rng.next_u64() as u32));
    }
}

fn platforms(world: &mut World, seed: u64, chance: i32, low: i32, high: i32) {
    let mut rng = Rng::new(seed);
    let floor = world.map.texture("FLOOR0_5").unwrap();
    for sector in 0..world.sector_count() as u32 {
        if rng.between(0, 99) < chance {
            let sector = world.sector_mut(SectorId(sector));
            sector.floor = Fixed::from_int(rng.between(low, high));
            sector.floor_texture = floor;
        }
    }
}

fn place(world: &mut World, x: i32, y: i32, degrees: f64, pitch: f64) {
    let (x, y) = (Fixed::from_int(x), Fixed::from_int(y));
    let sector = world.map.sector_at(x, y);
    let floor = world.sector(sector).floor;
    let body = &mut world.actors[0];
    (body.x, body.y, body.angle) = (x, y, Angle::from_degrees(degrees));
    (body.z, body.sector) = (floor, sector);
    world.players[0].view_z = body.z + Fixed::from_int(41);
    world.players[0].pitch = Angle::from_degrees(pitch).0 as i32;
}

fn save(path: &Path, size: FrameSize, colour: png::ColorType, data: &[u8]) {
    let file = std::fs::File::create(path).expect("the output folder is writable");
    let mut encoder = png::Encoder::new(
        std::io::BufWriter::new(file),
        u32::from(size.width),
        u32::from(size.height),
    );
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(data).unwrap();
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let assets = Assets::embedded();
    let map = Arc::new(volcano());
    let scene = Arc::new(Scene::new(&map, assets.clone()));
    let mut world = world(&map);
    platforms(&mut world, 3, 40, 16, 16);
    items(&mut world, 5, 30, &[ActorKind::ArmorBonus]);
    let folder = Path::new(arguments.first().map_or("/tmp/frames", String::as_str));
    std::fs::create_dir_all(folder).expect("the output folder is writable");
    let all: Vec<ActorKind> = ActorKind::all().collect();
    items(&mut world, 6, 200, &all);
    let views = [
        ("centre", 1088, 1152, 30.0, 16.5),
        ("corner", 40, 100, 50.0, 0.0),
        ("up", 1088, 1152, 100.0, -32.0),
        ("down", 1000, 1000, 200.0, 56.0),
        ("wall", 30, 1000, 170.0, 0.0),
    ];
    draw(folder, &scene, &mut world, &views);
    draw_top_down(&folder.join("volcano_map.png"), &scene, &world);

    let map = Arc::new(yard());
    let scene = Arc::new(Scene::new(&map, assets.clone()));
    let mut world = self::world(&map);
    items(&mut world, 8, 200, &all);
    let player = &mut world.players[0];
    let weapon = |name, bright| PlayerSprite {
        sprite: sprite_index(name).unwrap(),
        frame: 0,
        bright,
        x: Fixed::ONE,
        y: Fixed::from_f64(32.375),
    };
    player.sprites = [Some(weapon("PISG", false)), Some(weapon("PISF", true))];
    (player.weapon, player.weapons, player.ammo[0], player.keys) =
        (Some(Weapon::Pistol), 255, 142, 3);
    let views = [
        ("yard", -550, -250, 45.0, 0.0),
        ("gallery", 800, 500, 0.0, -10.0),
        ("inside", 1400, 600, 225.0, 0.0),
        ("fence", -300, 400, 90.0, 0.0),
        ("behind", -300, 780, 275.0, -32.0),
        ("pit", -560, 150, 0.0, 30.0),
    ];
    draw(folder, &scene, &mut world, &views);
    draw_top_down(&folder.join("yard_map.png"), &scene, &world);
}

fn draw_top_down(path: &Path, scene: &Arc<Scene>, world: &World) {
    let size = FrameSize { width: 640, height: 480 };
    let mut rgb = vec![0; size.pixels() * 3];
    TopDown::new(world.map.clone(), scene.clone(), 640, 480).draw(world, &mut rgb);
    save(path, size, png::ColorType::Rgb, &rgb);
}

fn draw(
    folder: &Path,
    scene: &Arc<Scene>,
    world: &mut World,
    views: &[(&str, i32, i32, f64, f64)],
) {
    for &(name, x, y, angle, pitch) in views {
        place(world, x, y, angle, pitch);
        for (width, height) in [(128, 72), (160, 120), (320, 240), (640, 480)] {
            let size = FrameSize { width, height };
            let mut renderer = Renderer::new(scene.clone(), Arc::new(View::new(size).unwrap()));
            renderer.render(
                &mut FrameScratch::default(),
                world,
                0,
                Buffers { depth: true, labels: true },
            );
            let mut rgb = vec![0; size.pixels() * 3];
            renderer.write_rgb_hwc(&mut rgb);
            save(&folder.join(format!("{name}_{width}.png")), size, png::ColorType::Rgb, &rgb);
            renderer.write_segmented_hwc(&SegmentationColours::distinct(), &mut rgb);
            save(
                &folder.join(format!("{name}_{width}_classes.png")),
                size,
                png::ColorType::Rgb,
                &rgb,
            );
            save(
                &folder.join(format!("{name}_{width}_depth.png")),
                size,
                png::ColorType::Grayscale,
                renderer.depth(),
            );
        }
    }
}
