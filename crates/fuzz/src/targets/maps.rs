//! Maps: UDMF text, and the WADs that hold it.

use super::{Target, assert_presentable, nothing_to_repair};
use hasard_engine::map::{Map, MapBuilder, MapSource, Style, udmf};
use hasard_engine::math::Fixed;
use hasard_engine::wad::{self, Wad};
use hasard_engine::world::{Command, World};
use hasard_envs::{RuleSet, scenarios};
use std::sync::Arc;

/// Names and values of the format.
const FIELDS: &[&str] = &[
    "namespace=\"zdoom\";",
    "vertex{x=0;y=0;}",
    "linedef{v1=0;v2=1;sidefront=0;}",
    "sidedef{sector=0;}",
    "sector{texturefloor=\"A\";textureceiling=\"B\";}",
    "thing{x=0;y=0;type=1;}",
    "sideback=1;",
    "twosided=true;",
    "blocking=true;",
    "heightfloor=-32768;",
    "heightceiling=32767;",
    "x=32767.99;",
    "y=-32768;",
    "id=1;",
    "special=9;",
    "arg0=",
    "TEXTMAP",
    "ENDMAP",
    "MAP01",
];

/// Text of maps.
pub const UDMF: Target = Target {
    name: "udmf",
    samples: || vec![udmf::write(&room()).into_bytes(), udmf::write(&hall()).into_bytes()],
    words: FIELDS,
    repair: nothing_to_repair,
    run: read_text,
    memory: 64 << 20,
};

/// Maps in WADs.
pub const MAP_WAD: Target = Target {
    name: "map_wad",
    samples: || vec![wad::write_map("MAP01", &room()), wad::write_map("MAP01", &hall())],
    words: FIELDS,
    repair: nothing_to_repair,
    run: |bytes| match Wad::read(bytes).and_then(|wad| wad.map_text("MAP01").map(<[u8]>::to_vec)) {
        Ok(text) => read_text(&text),
        Err(error) => {
            assert_presentable(&error.to_string());
            false
        }
    },
    memory: 64 << 20,
};

fn style(floor: i32, tag: i32) -> Style {
    Style {
        floor,
        ceiling: 128,
        light: 200,
        floor_texture: "FLAT5",
        ceiling_texture: "F_SKY1",
        wall: "STONE",
        step: "STEP",
        lintel: "STONE",
        special: 0,
        tag,
    }
}

/// A small map with everything that the format has.
pub(super) fn room() -> MapSource {
    let mut builder = MapBuilder::new();
    builder.rectangle(style(0, 0), 0, 0, 512, 384);
    builder.polygon(style(24, 7), &[(64, 64), (200, 90), (120, 220)]);
    builder.solid(&[(300, 300), (340, 300), (340, 340), (300, 340)]);
    builder.thing(1, 32.5, 32.0, 90).thing(2014, 400.0, 200.0, 0).thing(3004, 430.0, 200.0, 180);
    builder.finish().expect("the sample is sound")
}

/// The smallest of the benchmark's own maps.
fn hall() -> MapSource {
    let id = "CollateralDamageLevel1-v0".parse().expect("an id of the benchmark");
    scenarios::map_source(id, RuleSet::Paper, false).0
}

pub(super) fn read_text(bytes: &[u8]) -> bool {
    let source = match udmf::read(bytes) {
        Ok(source) => source,
        Err(error) => {
            assert_presentable(&error.to_string());
            return false;
        }
    };
    let again = udmf::write(&source);
    assert_eq!(
        udmf::read(again.as_bytes()).map(|source| udmf::write(&source)),
        Ok(again),
        "written and read, it is another map"
    );
    match Map::build(&source, "spoiled", &[]) {
        Ok(map) => {
            inhabit(map);
            true
        }
        Err(error) => {
            assert_presentable(&error.to_string());
            false
        }
    }
}

/// Lives in a map for some tics, in ways that could trip over its numbers.
fn inhabit(map: Map) {
    for i in 0..64 {
        let (x, y) = (Fixed::from_int(i * 37 % 700 - 50), Fixed::from_int(i * 61 % 500 - 50));
        let block = map.blockmap.lines_in(map.blockmap.column_of(x), map.blockmap.row_of(y));
        std::hint::black_box((map.sector_at(x, y), map.is_inside(x, y), block));
    }
    let mut world = World::new(Arc::new(map), 1);
    let keys = ["MOVE_FORWARD+SPEED", "ATTACK", "TURN_LEFT+JUMP", "USE+MOVE_RIGHT"];
    for tic in 0..24 {
        let command = hasard_envs::parse_command(keys[tic / 6]).unwrap_or_default();
        world.run_thinkers(&vec![command; world.players.len().min(1)]);
        world.events.clear();
        world.finish_tic();
    }
    std::hint::black_box((world.state_hash(), Command::default()));
}
