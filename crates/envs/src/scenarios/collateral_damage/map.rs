//! The range of Collateral Damage: a long room with a few low crates between the shooter and the
//! far wall.

use hasard_engine::map::{MapBuilder, MapSource, Mark, Style};

const ROOM: Style = Style {
    floor: 0,
    ceiling: 80,
    light: 210,
    floor_texture: "STONE5",
    ceiling_texture: "TLITE6_5",
    wall: "STARGR2",
    step: "CRATE1",
    lintel: "STARGR2",
    special: 0,
    tag: 0,
};

/// The map with the shooter at (`player_x`, 0), looking east.
#[must_use]
pub fn source(player_x: i32) -> MapSource {
    let mut builder = MapBuilder::new();
    builder.polygon(
        ROOM,
        &[
            (-576, -640),
            (256, -640),
            (256, 192),
            (224, 192),
            (224, 320),
            (256, 320),
            (256, 640),
            (-576, 640),
        ],
    );
    builder.rectangle(Style { ceiling_texture: "TLITE6_4", ..ROOM }, 64, -576, 192, -448);
    let crate_of = |floor| Style { floor, floor_texture: "CRATE1", ..ROOM };
    builder.rectangle(crate_of(24), 160, -352, 192, -320);
    builder.polygon(crate_of(32), &[(192, -288), (224, -320), (256, -288), (224, -256)]);
    builder.polygon(crate_of(32), &[(-128, 448), (-96, 416), (-64, 448), (-96, 480)]);
    builder.rectangle(crate_of(24), -256, -448, -192, -384);
    builder.rectangle(crate_of(24), 160, 544, 192, 576);

    let wall = |texture| Mark { wall: Some(texture), ..Mark::default() };
    // Behind the shooter and at the ends of the range; the far wall stays plain so that targets
    // stand out. In the original's pieces: how a body in the air stops at a wall depends on its
    // length.
    for (y, cuts) in [(640, [0, 64]), (-640, [-320, -256])] {
        for [west, east] in [[-576, cuts[0]], cuts, [cuts[1], 256]] {
            builder.mark(wall("SLIME16"), &[(west, y), (east, y)]);
        }
    }
    builder.mark(Mark::default(), &[(256, 0), (256, 192)]);
    builder.mark(wall("SILVER3"), &[(-576, -640), (-576, 640)]);
    builder.mark(wall("SILVER3"), &[(256, 192), (224, 192), (224, 320), (256, 320)]);
    builder.thing(1, f64::from(player_x), 0.0, 0);
    let mut map = builder.finish().expect("the shapes fit together");
    // The room is in front of all lines but those of the northernmost crate.
    map.turn_lines(|[(_, y), _], [front, _]| {
        let in_room =
            front.floor == ROOM.floor && front.ceiling_texture.as_str() == ROOM.ceiling_texture;
        in_room == (544.0..=576.0).contains(&y)
    });
    map
}
