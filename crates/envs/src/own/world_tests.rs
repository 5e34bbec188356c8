//! What worlds of a file do with floors, thing ids and an episode's last events.

use super::tests::{env, play, stat};
use super::{check, register};
use crate::{Env, EnvOptions, FrameSize, RuleSet};
use hasard_engine::world::ActorKind;

/// A task with a map and rules of its own.
fn task(name: &str, rest: &str) -> String {
    format!(
        "[scenario]\nname = \"{name}\"\ntics = 700\nactions = [[\"MOVE_FORWARD\"], [\"ATTACK\"], [\"JUMP\"]]\n{rest}"
    )
}

/// Cost of an episode that does something for so many steps at most.
fn cost_of(env: &mut Env, buttons: &str, steps: usize) -> f64 {
    let command = crate::parse_command(buttons).unwrap();
    let mut cost = 0.0;
    for _ in 0..steps {
        let step = env.step_buttons(command);
        cost += step.cost;
        if step.ended() {
            break;
        }
    }
    cost
}

/// A rocket's first flight step comes after the scripts of its tic: a wall so near that the blast
/// kills there and then costs what one a little further off does, and both deaths are noted.
#[test]
fn a_death_after_the_scripts_of_the_last_tic_is_charged() {
    let costs = [48, 64, 80, 120].map(|tile| {
        let text = task(
            &format!("Boom{tile}"),
            &format!(
                "[map]\ntile = {tile}\nascii = \"\"\"\n#####\n#..@#\n#####\"\"\"\n[map.legend]\n\"@\" = {{ like = \".\", start = true, angle = 0 }}\n\
                 [player]\nweapons = [\"RocketLauncher\"]\nammo = {{ rockets = 20 }}\n\
                 [[when]]\nevent = \"death\"\ncost.death = 100.0\n"
            ),
        );
        let scenario = register("boom.toml", &text).unwrap();
        let size = FrameSize { width: 64, height: 48 };
        let options =
            EnvOptions { scenario: Some(scenario), events: true, size, ..EnvOptions::default() };
        let id = scenario.environments().next().unwrap().to_string();
        let mut env = Env::new(&id, &options).unwrap();
        env.reset(1);
        // A launcher does not fire by itself while the trigger is held from the start.
        play(&mut env, "", 10);
        let cost = cost_of(&mut env, "ATTACK", 90);
        let deaths = env.happenings().iter().filter(|one| one.kind == crate::HappeningKind::Death);
        (cost, deaths.count())
    });
    assert_eq!(costs, [(100.0, 1); 4]);
}

/// Floors drawn anew carry what stands on them: the agent walks off, and every item can be taken.
#[test]
fn what_stands_on_a_floor_at_random_stands_on_it() {
    let text = task(
        "Loose",
        "[map]\nascii = \"\"\"\n##########\n#@.o.o.o.#\n##########\"\"\"\n[map.legend]\n\
         \"@\" = { like = \".\", start = true, angle = 0, floor = [-8, 8] }\n\
         o = { like = \".\", floor = [0, 24], thing = \"HealthBonus\" }\n\
         [[when]]\nevent = \"pickup\"\nof = \"HealthBonus\"\ncount = \"taken\"\n",
    );
    let mut env = env(&text, false);
    for seed in 0..10 {
        env.reset(seed);
        let world = env.world();
        let items = world.living().filter(|(_, thing)| thing.kind == ActorKind::HealthBonus);
        for (_, item) in items {
            assert_eq!(item.z, world.sector(world.map.sector_at(item.x, item.y)).floor);
        }
        play(&mut env, "MOVE_FORWARD+JUMP", 120);
        assert_eq!(stat(&env, "taken"), 3.0, "seed {seed}");
    }
}

/// A maze keeps its walls where its ground has a height at random.
#[test]
fn a_maze_with_uneven_ground_keeps_its_walls() {
    let closed = |ground: &str| {
        let text = task(
            &format!("Maze{}", ground.len()),
            &format!(
                "[map]\n[map.generate]\nkind = \"maze\"\ncolumns = 9\nrows = 9\n[map.legend]\n\".\" = {{ {ground} }}\n"
            ),
        );
        let mut env = env(&text, false);
        env.reset(3);
        let world = env.world();
        (0..world.map.sectors.len())
            .map(|sector| world.sector(hasard_engine::map::SectorId(sector as u32)))
            .filter(|state| state.floor >= state.ceiling)
            .count()
    };
    let flat = closed("ceiling = 128");
    assert!(flat > 20, "{flat}");
    assert_eq!(closed("ceiling = 128, floor = [-8, 8]"), flat);
}

/// A room of 256 by 256 with a vial of a given thing id, and the half to its east.
fn drawn(id: i32, special: i32) -> String {
    format!(
        "[map]\nudmf = '''namespace=\"zdoom\";\n\
         vertex{{x=0;y=0;}} vertex{{x=0;y=256;}} vertex{{x=256;y=256;}} vertex{{x=256;y=0;}} vertex{{x=512;y=256;}} vertex{{x=512;y=0;}}\n\
         linedef{{v1=0;v2=1;sidefront=0;blocking=true;}} linedef{{v1=1;v2=2;sidefront=1;blocking=true;}} linedef{{v1=3;v2=0;sidefront=2;blocking=true;}}\n\
         linedef{{v1=2;v2=3;sidefront=3;sideback=4;twosided=true;}}\n\
         linedef{{v1=2;v2=4;sidefront=5;blocking=true;}} linedef{{v1=4;v2=5;sidefront=6;blocking=true;}} linedef{{v1=5;v2=3;sidefront=7;blocking=true;}}\n\
         sidedef{{sector=0;texturemiddle=\"STONE5\";}} sidedef{{sector=0;texturemiddle=\"STONE5\";}} sidedef{{sector=0;texturemiddle=\"STONE5\";}} sidedef{{sector=0;}}\n\
         sidedef{{sector=1;}} sidedef{{sector=1;texturemiddle=\"STONE5\";}} sidedef{{sector=1;texturemiddle=\"STONE5\";}} sidedef{{sector=1;texturemiddle=\"STONE5\";}}\n\
         sector{{heightfloor=0;heightceiling=128;texturefloor=\"FLAT5\";textureceiling=\"FLAT5\";lightlevel=192;id=5;}}\n\
         sector{{heightfloor=0;heightceiling=128;texturefloor=\"FLAT5\";textureceiling=\"FLAT5\";lightlevel=192;id=6;special={special};}}\n\
         thing{{x=64;y=128;angle=0;type=1;}}\n\
         thing{{x=128;y=128;angle=0;type=2014;id={id};single=true;skill3=true;}}\n'''\n"
    )
}

/// A room of 512 by 512, tag 5, about a pool of 256 by 256, tag 6.
fn ring() -> String {
    let corners = |from: i32, to: i32| [(from, from), (from, to), (to, to), (to, from)];
    let vertices: String = corners(0, 512)
        .into_iter()
        .chain(corners(128, 384))
        .map(|(x, y)| format!("vertex{{x={x};y={y};}}\n"))
        .collect();
    let (mut lines, mut sides) = (String::new(), String::new());
    for wall in 0..4 {
        let next = (wall + 1) % 4;
        lines += &format!("linedef{{v1={wall};v2={next};sidefront={wall};blocking=true;}}\n");
        sides += "sidedef{sector=0;texturemiddle=\"STONE5\";}\n";
    }
    for wall in 0..4 {
        let (next, side) = ((wall + 1) % 4, 4 + 2 * wall);
        lines += &format!(
            "linedef{{v1={};v2={};sidefront={side};sideback={};twosided=true;}}\n",
            4 + wall,
            4 + next,
            side + 1
        );
        sides += "sidedef{sector=1;}\nsidedef{sector=0;}\n";
    }
    let sector = |tag: i32| {
        format!(
            "sector{{heightfloor=0;heightceiling=128;texturefloor=\"FLAT5\";textureceiling=\"FLAT5\";lightlevel=192;id={tag};}}\n"
        )
    };
    format!(
        "[map]\nudmf = '''namespace=\"zdoom\";\n{vertices}{lines}{sides}{}{}thing{{x=64;y=64;angle=0;type=1;}}\n'''\n",
        sector(5),
        sector(6)
    )
}

/// A zone of a tag is its sectors, not the rectangle about them.
#[test]
fn a_zone_of_a_tag_has_the_shape_of_its_sectors() {
    let text = task(
        "Ring",
        &format!(
            "{}[zones]\nring = {{ tag = 5 }}\npool = {{ tag = 6 }}\n[player]\nin = \"ring\"\n\
             [[spawn]]\nkind = \"Clip\"\ncount = 20\nin = \"ring\"\n",
            ring()
        ),
    );
    let mut env = env(&text, false);
    for seed in 0..20 {
        env.reset(seed);
        let world = env.world();
        for (_, thing) in world.living() {
            let tag = world.map.sectors[world.map.sector_at(thing.x, thing.y).0 as usize].tag;
            assert_eq!(tag, 5, "seed {seed}: {:?}", thing.kind);
        }
    }
    let absent = check(&text.replace("tag = 6", "tag = 7"));
    let said = &absent.mistakes[0].text;
    assert!(
        said.contains("zone pool has the tag 7") && said.contains("the map has 5, 6"),
        "{said}"
    );
}

/// A map's own thing ids are none of the names of a file's spawns.
#[test]
fn a_maps_own_ids_are_no_names_of_spawns() {
    for id in [0, 1, 2, 70] {
        let text = task(
            &format!("Ids{id}"),
            &format!(
                "{}[[spawn]]\nname = \"poison\"\nkind = \"Shell\"\nin = [400, 10, 450, 40]\n\
                 [[when]]\nevent = \"pickup\"\nof = \"poison\"\ncost.poison = 1.0\n\
                 [[when]]\nevent = \"pickup\"\nof = \"HealthBonus\"\ncount = \"vials\"\n",
                drawn(id, 0)
            ),
        );
        let mut env = env(&text, false);
        env.reset(1);
        let cost = cost_of(&mut env, "MOVE_FORWARD", 25);
        assert_eq!((cost, stat(&env, "vials")), (0.0, 1.0), "id {id}");
    }
}

/// `free` is anywhere that does not hurt, in maps that somebody drew as well.
#[test]
fn nobody_begins_on_a_floor_that_hurts() {
    let text = task("Free", &format!("{}[player]\nin = \"free\"\n", drawn(0, 83)));
    let mut env = env(&text, false);
    let mut wests = Vec::new();
    for seed in 0..40 {
        env.reset(seed);
        let world = env.world();
        wests.push(world.get(world.players[0].actor).unwrap().x.floor());
    }
    assert!(wests.iter().all(|x| *x < 256) && wests.iter().any(|x| *x < 100), "{wests:?}");
}

/// A spawn brings back what it put down, not what the map had.
#[test]
fn what_the_map_had_does_not_come_back() {
    let text = task(
        "Back",
        "[map]\nascii = \"\"\"\n########\n#@ooooo#\n########\"\"\"\n[map.legend]\n\
         \"@\" = { like = \".\", start = true, angle = 0 }\no = { like = \".\", thing = \"HealthBonus\" }\n\
         [[spawn]]\nkind = \"HealthBonus\"\ncount = 1\nrespawn = 1\nin = [64, 64, 128, 128]\n\
         [[when]]\nevent = \"pickup\"\nof = \"HealthBonus\"\ncount = \"got\"\n",
    );
    let mut env = env(&text, false);
    env.reset(1);
    play(&mut env, "MOVE_FORWARD", 100);
    assert!(stat(&env, "got") >= 5.0);
    let vials = env.world().living().filter(|(_, thing)| thing.kind == ActorKind::HealthBonus);
    assert_eq!(vials.count(), 1);
}

/// `most` holds up to its largest value, and what was full has room again once things are taken.
#[test]
fn the_most_of_a_spawn_holds_whatever_its_number() {
    for (most, expected) in [("", 500), ("most = 499\n", 499), ("most = 500\n", 500)] {
        let text = task(
            &format!("Most{}{expected}", most.len()),
            &format!(
                "[map]\nascii = \"\"\"\n######\n#....#\n#....#\n#...@#\n######\"\"\"\n\
                 [[spawn]]\nkind = \"HealthBonus\"\ncount = 500\nevery = 7\nfirst = 1\neach = 100\n{most}"
            ),
        );
        let mut env = env(&text, false);
        env.reset(1);
        play(&mut env, "", 3);
        let vials = env.world().living().filter(|(_, one)| one.kind == ActorKind::HealthBonus);
        assert_eq!(vials.count(), expected, "{most}");
    }
}

/// A fall counts from where it began: from the air the agent starts in, and from where a rule put
/// it.
#[test]
fn falls_are_counted_from_their_highest_point() {
    let text = task(
        "Fall",
        "[map]\nascii = \"\"\"\n######\n#....#\n#.@..#\n######\"\"\"\n[map.legend]\n\".\" = { ceiling = 512 }\n\
         [player]\nin = [64, 64, 200, 180]\nheight = 200\n[[when]]\nevent = \"land\"\ncount = \"landings\"\ncost.fallen = 1.0\n",
    );
    let mut env = env(&text, false);
    env.reset(1);
    assert_eq!((cost_of(&mut env, "", 30), stat(&env, "landings")), (200.0, 1.0));
}

/// A door that is to close while it opens does.
#[test]
fn a_floor_on_its_way_obeys_the_later_order() {
    let text = task(
        "Door",
        "[map]\nascii = \"\"\"\n#####\n#.@.#\n#ddd#\n#####\"\"\"\n[map.legend]\nd = { like = \".\", zone = \"door\" }\n\
         [[when]]\nevent = \"timer\"\nfirst = 10\nfloor = { of = \"door\", to = 64, speed = 4 }\n\
         [[when]]\nevent = \"timer\"\nfirst = 20\nfloor = { of = \"door\", to = -32, speed = 16 }\n",
    );
    let mut env = env(&text, false);
    env.reset(1);
    play(&mut env, "", 60);
    let world = env.world();
    let lowest = (0..world.map.sectors.len() as u32)
        .map(|sector| world.sector(hasard_engine::map::SectorId(sector)).floor.floor())
        .min();
    assert_eq!(lowest, Some(-32));
}

/// `check` tries what the hard constraint, a level or a rule set has otherwise.
#[test]
fn maps_of_other_settings_are_tried_too() {
    let good =
        "[map]\nascii = \"\"\"\n###\n#@#\n###\"\"\"\n[zones]\nyard = { area = [0, 0, 64, 64] }\n";
    let text = task("Harder", &format!("{good}[hard.zones]\ncellar = {{ tags = [77, 78] }}\n"));
    let checked = check(&text);
    let found: Vec<String> = checked.mistakes.iter().map(ToString::to_string).collect();
    assert!(!checked.can_be_played() && found.len() == 1, "{found:?}");
    assert!(found[0].contains("--hard: ") && found[0].contains("77"), "{found:?}");
    let text =
        task("Ruled", &format!("{good}[rules.released.zones]\ncellar = {{ tags = [78, 79] }}\n"));
    let found: Vec<String> = check(&text).mistakes.iter().map(ToString::to_string).collect();
    assert!(found.len() == 1 && found[0].contains("--rules released: "), "{found:?}");
}

/// A saved moment is refused where another folder of maps is played.
#[test]
fn a_moment_of_another_map_is_refused() {
    let place = |name: &str| {
        Some(std::sync::Arc::new(crate::maps::Maps::new(std::path::Path::new(name), None)))
    };
    let plain = EnvOptions::default();
    let [one, other] = ["one.wad", "other.wad"]
        .map(|name| EnvOptions { maps: place(name), ..EnvOptions::default() });
    assert_eq!(plain.difference(&one), Some("the folder of maps"));
    assert_eq!(one.difference(&other), Some("the folder of maps"));
    assert_eq!(one.difference(&one.clone()), None);
    assert_eq!(
        EnvOptions { rules: RuleSet::Tables, ..one.clone() }.difference(&one),
        Some("rules")
    );
}
