//! What each flag of a line stops, measured in ViZDoom (vizdoom 1.3.2) in the same room.

mod hall;

use hall::run;
use hasard_engine::map::{Map, udmf};
use hasard_engine::math::Fixed;
use hasard_engine::world::{ActorKind, Buttons, Weapon, World};
use std::sync::Arc;

/// A room of 1024 x 512, cut at x = 0 by a line with these flags; the player stands at x = -256 and
/// looks east.
fn room(line: &str) -> World {
    let mut text = String::from("namespace = \"zdoom\";\n");
    for (x, y) in [(-512, -256), (-512, 256), (0, 256), (512, 256), (512, -256), (0, -256)] {
        text += &format!("vertex {{ x = {x}; y = {y}; }}\n");
    }
    for (index, (v1, v2)) in
        [(0, 1), (1, 2), (5, 0), (2, 3), (3, 4), (4, 5)].into_iter().enumerate()
    {
        text +=
            &format!("linedef {{ v1 = {v1}; v2 = {v2}; sidefront = {index}; blocking = true; }}\n");
        text += &format!("sidedef {{ sector = {}; texturemiddle = \"STONE2\"; }}\n", index / 3);
    }
    text += &format!(
        "linedef {{ v1 = 2; v2 = 5; sidefront = 6; sideback = 7; twosided = true; {line} }}\n"
    );
    for sector in 0..2 {
        text += &format!("sidedef {{ sector = {sector}; }}\n");
        text += "sector { heightceiling = 256; texturefloor = \"FLOOR4_8\"; textureceiling = \"FLOOR4_8\"; }\n";
    }
    text += "thing { x = -256; y = 0; type = 1; }\n";
    let map = Map::build(&udmf::read(text.as_bytes()).unwrap(), "room", &[]).unwrap();
    World::new(Arc::new(map), 1)
}

/// Where somebody ends who runs east for 140 tics.
fn walks_to(line: &str) -> f64 {
    let mut world = room(line);
    run(&mut world, 140, Buttons::MOVE_FORWARD);
    world.get(world.players[0].actor).unwrap().x.to_f64()
}

/// How far east anything of a kind gets while a weapon fires.
fn reaches(line: &str, kind: ActorKind, weapon: Weapon) -> f64 {
    let mut world = room(line);
    world.give_weapon(0, weapon, false);
    world.players[0].ammo[weapon.ammo_type()] = 50;
    // The weapon comes up before it fires.
    run(&mut world, 50, Buttons::default());
    let mut farthest = f64::MIN;
    for _ in 0..120 {
        run(&mut world, 1, Buttons::ATTACK);
        let east = world
            .living()
            .filter(|(_, actor)| actor.kind == kind)
            .map(|(_, actor)| actor.x.to_f64());
        farthest = east.fold(farthest, f64::max);
    }
    farthest
}

#[test]
fn walkers_are_stopped_as_in_the_published_engine() {
    for (line, measured) in [
        ("", 495.9756),
        ("blocking = true;", -16.0244),
        ("blockplayers = true;", -16.0244),
        ("blockeverything = true;", -16.0244),
        ("blockmonsters = true;", 495.9756),
        ("blockfloaters = true;", 495.9756),
        ("blockprojectiles = true;", 495.9756),
        ("blockhitscan = true;", 495.9756),
        ("blocksight = true;", 495.9756),
        ("blockplayers = true; blockplayers = false;", 495.9756),
    ] {
        let x = walks_to(line);
        assert!((x - measured).abs() < 0.01, "{line}: {x}, measured {measured}");
    }
}

#[test]
fn bullets_are_stopped_as_in_the_published_engine() {
    for (line, measured) in [
        ("", 507.0),
        ("blocking = true;", 507.0),
        ("blockplayers = true;", 507.0),
        ("blocksight = true;", 507.0),
        ("blockprojectiles = true;", 507.0),
        ("blockhitscan = true;", -5.0),
        ("blockeverything = true;", -5.0),
    ] {
        let x = reaches(line, ActorKind::BulletPuff, Weapon::Pistol);
        assert!((x - measured).abs() < 2.0, "{line}: {x}, measured {measured}");
    }
}

#[test]
fn missiles_are_stopped_by_their_own_flags_alone() {
    for (line, stops) in [
        ("", false),
        ("blocking = true;", false),
        ("blockplayers = true;", false),
        ("blockmonsters = true;", false),
        ("blockprojectiles = true;", true),
        ("blockeverything = true;", true),
    ] {
        let x = reaches(line, ActorKind::Rocket, Weapon::RocketLauncher);
        assert!(x > -256.0, "{line}: a rocket flew");
        assert_eq!(x < 0.0, stops, "{line}: {x}");
    }
}

#[test]
fn monsters_are_stopped_by_theirs() {
    for (line, kind, stops) in [
        ("", ActorKind::ZombieMan, false),
        ("blockmonsters = true;", ActorKind::ZombieMan, true),
        ("blockplayers = true;", ActorKind::ZombieMan, false),
        ("blockfloaters = true;", ActorKind::ZombieMan, false),
        ("blockfloaters = true;", ActorKind::LostSoul, true),
        ("blockmonsters = true;", ActorKind::LostSoul, true),
        ("blockeverything = true;", ActorKind::ZombieMan, true),
    ] {
        let mut world = room(line);
        let id = world
            .spawn_checked(kind, Fixed::from_int(-100), Fixed::from_int(100), Fixed::ZERO, 0)
            .unwrap();
        let slot = (0..world.actors.len()).find(|&slot| world.id_of(slot) == id).unwrap();
        let moved = world.try_move(slot, Fixed::ZERO, Fixed::from_int(100), true).moved;
        assert_eq!(moved, !stops, "{line} {kind:?}");
    }
}
