//! A world of ours as ViZDoom reported a moment.

use crate::dump::{Level, Moment};
use crate::{Any, chance};
use hasard_engine::assets::Assets;
use hasard_engine::map::{Map, SectorId, udmf};
use hasard_engine::math::{Angle, Fixed};
use hasard_engine::render::{FrameScratch, FrameSize, RenderOptions, Renderer, Scene, View};
use hasard_engine::wad::Wad;
use hasard_engine::world::{ActorId, ActorKind, Chance, Trail, Weapon, World};
use hasard_envs::maps::pictures_beside;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// What scripts paint floors with.
const SCRIPTED_TEXTURES: [&str; 3] = ["LAVA1", "FLOOR0_5", "NUKAGE1"];

/// One level, ready to draw.
pub struct Stage {
    map: Arc<Map>,
    /// The world as scripts left it at the last moment's tic.
    world: World,
    pub renderer: Renderer,
    pub scratch: FrameScratch,
    pub size: [usize; 2],
    /// The last picture.
    pub rgb: Vec<u8>,
    /// By the published name.
    kinds: BTreeMap<&'static str, ActorKind>,
}

/// The world of a moment.
pub struct Posed {
    pub world: World,
    /// Published label and actor of the things that were placed.
    pub actors: Vec<(u8, ActorId)>,
}

fn fixed(units: f64) -> Fixed {
    Fixed::from_f64(units)
}

impl Stage {
    pub fn new(level: &Level) -> Any<Stage> {
        let read = |path: &str| std::fs::read(path).map_err(|error| format!("{path}: {error}"));
        let (iwad, pwad) = (read(&level.iwad)?, read(&level.wad)?);
        let mut source = udmf::read(Wad::read(&pwad)?.map_text("MAP01")?)?;
        source.things.retain(|thing| thing.kind == 1);
        source.things.truncate(1);
        let map = Arc::new(Map::build(&source, &level.scenario, &SCRIPTED_TEXTURES)?);
        let engine = pictures_beside(Path::new(&level.iwad))?;
        let additions: Vec<&[u8]> = engine.as_deref().into_iter().chain([&pwad[..]]).collect();
        let assets =
            Arc::new(Assets::from_wads(&iwad, &additions, &|name| map.textures.contains(&name))?);
        let scene = Arc::new(Scene::new(&map, assets));
        let size = FrameSize { width: level.width, height: level.height };
        let mut renderer = Renderer::new(scene, Arc::new(View::new(size)?));
        renderer.set_options(RenderOptions { published_depth: true, ..RenderOptions::default() });
        let world = World::new(Arc::clone(&map), 1);
        let kinds = ActorKind::all().map(|kind| (kind.class_name(), kind)).collect();
        Ok(Stage {
            world,
            map,
            renderer,
            scratch: FrameScratch::default(),
            size: [level.width, level.height].map(usize::from),
            rgb: vec![0; size.pixels() * 3],
            kinds,
        })
    }

    /// Poses the world of a moment.
    pub fn pose(&mut self, level: &Level, moment: &Moment) -> Posed {
        self.run_to(level, moment.tic);
        let mut world = self.world.clone();
        self.set_sectors(&mut world, level, moment);
        set_player(&mut world, moment);
        moment.bursts.iter().for_each(|&burst| leave_soot(&mut world, burst));
        let actors = moment.labels.iter().filter_map(|thing| {
            let name = thing.name.strip_prefix("Dead").unwrap_or(&thing.name);
            let &kind = self.kinds.get(name).filter(|&&kind| kind != ActorKind::Player)?;
            let [x, y, z] = [thing.px, thing.py, thing.pz].map(fixed);
            let id = world.spawn(kind, x, y, z);
            let actor = world.get_mut(id)?;
            (actor.x, actor.y, actor.z, actor.angle) = (x, y, z, Angle::from_degrees(thing.angle));
            Some((thing.value, id))
        });
        let actors = actors.collect();
        Posed { world, actors }
    }

    /// Brings lights to a tic; scripts begin anew with every episode.
    fn run_to(&mut self, level: &Level, tic: u32) {
        if self.world.tic > tic || self.world.tic == 0 {
            self.world = World::new(Arc::clone(&self.map), 1);
            self.world.run_thinkers(&[]);
            light_by_script(level, &mut self.world);
            self.world.finish_tic();
        }
        while self.world.tic < tic {
            self.world.run_thinkers(&[]);
            self.world.finish_tic();
        }
    }

    fn set_sectors(&self, world: &mut World, level: &Level, moment: &Moment) {
        let texture = |name| self.map.texture(name);
        for (index, (&floor, &ceiling)) in moment.floors.iter().zip(&moment.ceilings).enumerate() {
            let sector = world.sector_mut(SectorId(index as u32));
            (sector.floor, sector.ceiling) = (fixed(floor), fixed(ceiling));
            let painted = match (level.scenario.as_str(), level.level) {
                ("volcanic_venture", 1) => texture(if floor < 8.0 { "LAVA1" } else { "FLOOR0_5" }),
                ("volcanic_venture", _) => texture(if floor == 0.0 { "LAVA1" } else { "FLOOR0_5" }),
                ("armament_burden", 3) if floor == -24.0 => texture("NUKAGE1"),
                _ => None,
            };
            sector.floor_texture = painted.unwrap_or(sector.floor_texture);
        }
    }
}

/// Speed of rockets, map units a tic.
const ROCKET_SPEED: i32 = 20;

/// Leaves the soot of a rocket that has burst at a place: it bursts there once more if a wall was
/// in its way.
fn leave_soot(world: &mut World, [x, y, z, angle]: [f64; 4]) {
    let mut again = world.clone();
    let place = [x, y, z].map(fixed);
    let id = again.spawn(ActorKind::Rocket, place[0], place[1], place[2]);
    if let Some(rocket) = again.get_mut(id) {
        (rocket.x, rocket.y, rocket.z) = place.into();
        let way = Angle::from_degrees(angle);
        (rocket.vx, rocket.vy) = (way.cos() * ROCKET_SPEED, way.sin() * ROCKET_SPEED);
    }
    again.run_thinkers(&[]);
    again.finish_tic();
    if again.get(id).is_some_and(|rocket| [rocket.x, rocket.y, rocket.z] == place) {
        world.soot = again.soot;
    }
}

/// Leaves the trails of the rockets that have flown, with the squares that chance gave them there,
/// if that was noted.
pub fn leave_trails(world: &mut World, moment: &Moment) {
    let lots = moment.chance.map_or_else(Vec::new, |seed| chance::lots(seed, moment));
    for (flight, lots) in moment.flights.iter().zip(lots) {
        let [place, velocity] = [flight.place, flight.velocity].map(|vector| vector.map(fixed));
        // Ours counts tics from nought; and the world's clock may be ahead, where textures are
        // animated.
        let begun = world.tic + flight.tic - 1 - moment.tic;
        let (id, sector) = (world.players[0].actor, world.map.sector_at(place[0], place[1]));
        let mut trail = Trail::new(id, place, velocity, begun, sector, Chance::Given(lots.into()));
        trail.ended = flight.tics.map_or(Trail::FLYING, |tics| begun + tics);
        world.trails.push(trail);
    }
}

/// What the scripts of Precipice Plunge do to light at the start of a level; no other scenario's
/// do.
fn light_by_script(level: &Level, world: &mut World) {
    if level.scenario != "precipice_plunge" {
        return;
    }
    let (first, tiles) = (127, if level.level == 1 { 35 * 7 } else { 57 * 7 });
    let tags: Vec<i32> = world.map.sectors.iter().map(|sector| sector.tag).collect();
    for tag in tags.into_iter().filter(|&tag| tag > first && tag <= first + tiles) {
        let light =
            if level.level == 1 { 255 + (first - tag) / 2 } else { 255 - 155 * tag / tiles };
        // How far tiles glow up and down from there.
        let glow = if level.level == 3 { 50 } else { 30 };
        world.light_change_to_value(tag, light);
        world.light_glow(tag, light + glow, light - glow, 50);
    }
}

fn set_player(world: &mut World, moment: &Moment) {
    let value = |name: &str| moment.value(name);
    let [x, y, z] =
        ["CAMERA_POSITION_X", "CAMERA_POSITION_Y", "POSITION_Z"].map(|name| fixed(value(name)));
    let [angle, pitch] =
        ["CAMERA_ANGLE", "CAMERA_PITCH"].map(|name| Angle::from_degrees(value(name)));
    world.place_player(0, x, y, z, angle, pitch.0 as i32);
    let player = &mut world.players[0];
    player.view_z = fixed(value("CAMERA_POSITION_Z"));
    player.sprites = [None; 2];
    player.armor = value("ARMOR") as i32;
    player.dead = value("DEAD") != 0.0;
    let slots = (2..).zip(WEAPONS).filter(|(slot, _)| value(&format!("WEAPON{slot}")) > 0.0);
    player.weapons = slots.map(|(_, weapon)| weapon.bit()).fold(0, |all, bit| all | bit);
    // The published ammunition slots 2 to 6: clip, shells, clip again, rockets, cells.
    player.ammo = [2, 3, 5, 6].map(|slot| value(&format!("AMMO{slot}")) as i32);
    let selected = value("SELECTED_WEAPON") as usize;
    player.weapon = selected.checked_sub(2).and_then(|slot| WEAPONS.get(slot).copied());
    let id = player.actor;
    if let Some(body) = world.get_mut(id) {
        body.health = value("HEALTH") as i32;
    }
}

/// By published slot, from 2.
const WEAPONS: [Weapon; 6] = [
    Weapon::Pistol,
    Weapon::Shotgun,
    Weapon::Chaingun,
    Weapon::RocketLauncher,
    Weapon::PlasmaRifle,
    Weapon::Bfg9000,
];
