//! The town yard of Remedy Rush: a large fenced square among houses, with shops and a court to the
//! south.
//!
//! What can be walked on, the heights and the light levels are those of the benchmark; the houses,
//! their fronts and what lies beyond the fences are our own. Built from north to south: the ground,
//! the houses that stand on it, what is cut into the houses, and the fences.
//!
//! Long because it is a drawing: one list of houses, walls and things, in map order.

use hasard_engine::map::{MapBuilder, MapSource, Mark, Style};

/// First and last tag of the sectors whose light the rules switch: the ground inside the fences and
/// its alcoves.
pub const STROBE_TAGS: std::ops::RangeInclusive<i32> = 101..=118;

const YARD_TAG: i32 = 101;
const PAVEMENT_TAG: i32 = 102;
const ALCOVE_TAG: i32 = 103;
const COURT_TAG: i32 = 104;
const WRECK_TAG: i32 = 105;
const PLAZA_TAG: i32 = 106;

/// Open ground under the sky.
const GROUND: Style = Style {
    floor: 0,
    ceiling: 160,
    light: 240,
    floor_texture: "RROCK20",
    ceiling_texture: "F_SKY1",
    wall: "BIGSTON3",
    step: "BRIKS20",
    lintel: "BIGSTON3",
    special: 0,
    tag: 0,
};

/// Ground inside the fences.
const YARD: Style = Style { tag: YARD_TAG, ..GROUND };
/// Light in the shadow of a house.
const SHADE: i32 = 208;
const PAVEMENT: Style = Style { floor_texture: "TILES6", tag: PAVEMENT_TAG, ..GROUND };
/// Under a low roof.
const ALCOVE: Style = Style {
    ceiling: 128,
    light: 208,
    floor_texture: "TILES6",
    ceiling_texture: "FLAT19",
    wall: "MODWALL4",
    tag: ALCOVE_TAG,
    ..GROUND
};
const ROOM: Style = Style {
    ceiling: 112,
    light: 208,
    ceiling_texture: "FLAT5_5",
    tag: 0,
    wall: "SILVER3",
    ..ALCOVE
};
/// Furniture and other things too high to step on.
const COUNTER: Style = Style { floor: 40, step: "SUPPORT3", floor_texture: "FLAT19", ..ROOM };

const fn wall(texture: &'static str) -> Mark {
    Mark {
        wall: Some(texture),
        middle: None,
        step: None,
        lintel: None,
        blocking: false,
        kept: false,
        lower_unpegged: true,
        upper_unpegged: false,
        offset: None,
    }
}

/// See-through, but nobody passes.
const FENCE: Mark = Mark { wall: None, middle: Some("MIDBARS3"), blocking: true, ..wall("") };
const RAILING: Mark = Mark { middle: Some("MIDSPACE"), ..FENCE };

/// The map of every level.
#[must_use]
pub fn source() -> MapSource {
    let mut town = Town { builder: MapBuilder::new() };
    town.ground();
    town.north();
    town.west();
    town.east();
    town.middle();
    town.south();
    town.south_west();
    town.fences();
    town.scenery();
    town.builder.finish().expect("the town fits together")
}

struct Town {
    builder: MapBuilder,
}

/// Which way a wall is seen from: the side of the wall that the open ground lies on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Facing {
    North,
    East,
    South,
    West,
}

impl Town {
    /// The whole town, then the ground inside the fences over it.
    fn ground(&mut self) {
        let b = &mut self.builder;
        b.polygon(
            GROUND,
            &[(-1200, -464), (1560, -464), (1560, 1500), (1180, 1840), (-760, 1840), (-1200, 1400)],
        );
        // Along the fences and house fronts from the south-west, clockwise.
        b.polygon(
            YARD,
            &[
                (-480, -92),
                (-480, 140),
                (-464, 180),
                (-376, 268),
                (-336, 284),
                (-336, 692),
                (-368, 692),
                (-464, 788),
                (-488, 800),
                (-592, 800),
                (-704, 1068),
                (-704, 1292),
                (-64, 1292),
                (156, 1072),
                (292, 1072),
                (512, 1292),
                (1088, 1292),
                (1088, 820),
                (1032, 800),
                (936, 800),
                (920, 788),
                (824, 692),
                (776, 692),
                (776, 268),
                (828, 268),
                (916, 180),
                (904, 180),
                (904, -100),
                (672, -100),
                (672, -228),
                (408, -228),
                (408, -464),
                (52, -464),
                (-80, -464),
                (-80, -212),
                (-220, -212),
                (-220, -92),
            ],
        );
        // Pavements: around the towers, and the way from the court to the north fence.
        b.polygon(
            PAVEMENT,
            &[(-160, -152), (88, -152), (88, 56), (56, 88), (-128, 88), (-160, 56)],
        );
        b.polygon(
            PAVEMENT,
            &[(360, -152), (604, -152), (604, 56), (572, 88), (392, 88), (360, 56)],
        );
        b.rectangle(PAVEMENT, 176, 88, 272, 448);
        b.rectangle(PAVEMENT, 176, 640, 272, 1056);
        let plaza = Style { floor_texture: "FLAT19", tag: PLAZA_TAG, ..GROUND };
        b.polygon(
            plaza,
            &[
                (160, 448),
                (288, 448),
                (336, 496),
                (336, 592),
                (288, 640),
                (160, 640),
                (112, 592),
                (112, 496),
            ],
        );
        let flower_bed = Style { floor_texture: "GRASS1", ..plaza };
        b.polygon(
            flower_bed,
            &[
                (192, 496),
                (256, 496),
                (288, 528),
                (288, 560),
                (256, 592),
                (192, 592),
                (160, 560),
                (160, 528),
            ],
        );
        // Cracks in the ground.
        let crack = Style { floor_texture: "FLAT10", ..plaza };
        for (x, y) in [(-150, 224), (600, 224), (-210, 900), (660, 1120), (420, 760)] {
            b.polygon(
                crack,
                &[
                    (x - 36, y - 8),
                    (x - 4, y - 20),
                    (x + 30, y - 6),
                    (x + 12, y + 6),
                    (x + 2, y + 26),
                    (x - 14, y + 4),
                ],
            );
        }
        // Shadows that the houses throw.
        for shadow in [
            &[(-336, 268), (-336, 640), (-288, 592), (-288, 316)][..],
            &[
                (-704, 1292),
                (-64, 1292),
                (-144, 1212),
                (-592, 1212),
                (-592, 820),
                (-544, 868),
                (-544, 1164),
            ],
            &[(512, 1292), (1088, 1292), (1088, 1212), (592, 1212)],
            &[(776, 268), (776, 692), (728, 644), (728, 268)],
            &[(904, 180), (904, -96), (856, -96), (856, 132)],
            &[(-464, 180), (-480, 140), (-480, -92), (-416, -92), (-416, 132)],
            &[(-120, 36), (-108, 48), (-108, 112), (-184, 36), (-184, -100), (-120, -100)],
            &[(400, 36), (412, 48), (412, 112), (336, 36), (336, -100), (400, -100)],
        ] {
            b.shade(SHADE, shadow);
        }
    }

    /// A house without inside, its walls in one texture.
    fn house(&mut self, texture: &'static str, corners: &[(i32, i32)]) {
        self.builder.solid(corners);
        let mut around = corners.to_vec();
        around.push(corners[0]);
        self.builder.mark(wall(texture), &around);
    }

    fn block(&mut self, texture: &'static str, west: i32, south: i32, east: i32, north: i32) {
        self.house(texture, &[(west, south), (east, south), (east, north), (west, north)]);
    }

    /// `count` windows of 64 units, 128 apart, in a wall: shallow recesses too high to jump into,
    /// their back in `pane`. (`x`, `y`) is the middle of the first window, on the wall.
    fn windows(
        &mut self,
        facing: Facing,
        x: i32,
        y: i32,
        count: i32,
        house: &'static str,
        pane: &'static str,
    ) {
        let style = Style {
            floor: 64,
            ceiling: 128,
            light: 255,
            ceiling_texture: "FLAT19",
            step: house,
            lintel: house,
            ..GROUND
        };
        let style = Style { wall: pane, floor_texture: "FLAT19", ..style };
        for i in 0..count {
            let along = 128 * i;
            let (west, south, east, north) = match facing {
                Facing::North => (x - 32 + along, y - 8, x + 32 + along, y),
                Facing::South => (x - 32 + along, y, x + 32 + along, y + 8),
                Facing::East => (x - 8, y - 32 + along, x, y + 32 + along),
                Facing::West => (x, y - 32 + along, x + 8, y + 32 + along),
            };
            self.builder.rectangle(style, west, south, east, north);
            let back = match facing {
                Facing::North => [(west, south), (east, south)],
                Facing::South => [(west, north), (east, north)],
                Facing::East => [(west, south), (west, north)],
                Facing::West => [(east, south), (east, north)],
            };
            self.builder.mark(Mark { lower_unpegged: false, ..wall(pane) }, &back);
        }
    }

    /// A closed door of 64 units in a wall.
    fn door(&mut self, facing: Facing, x: i32, y: i32, house: &'static str, texture: &'static str) {
        let style = Style {
            ceiling: 96,
            light: 208,
            ceiling_texture: "FLAT19",
            lintel: house,
            wall: house,
            ..GROUND
        };
        let (corners, back) = match facing {
            Facing::North => ((x - 32, y - 8, x + 32, y), [(x - 32, y - 8), (x + 32, y - 8)]),
            Facing::South => ((x - 32, y, x + 32, y + 8), [(x - 32, y + 8), (x + 32, y + 8)]),
            Facing::East => ((x - 8, y - 32, x, y + 32), [(x - 8, y - 32), (x - 8, y + 32)]),
            Facing::West => ((x, y - 32, x + 8, y + 32), [(x + 8, y - 32), (x + 8, y + 32)]),
        };
        let style = Style { floor_texture: "TILES6", ..style };
        self.builder.rectangle(style, corners.0, corners.1, corners.2, corners.3);
        self.builder.mark(Mark { offset: Some((0, 0)), ..wall(texture) }, &back);
        let threshold = match facing {
            Facing::North | Facing::South => [(x - 32, y), (x + 32, y)],
            Facing::East | Facing::West => [(x, y - 32), (x, y + 32)],
        };
        // A recess of 8 units holds on to who slides along the wall: closed for bodies.
        self.builder.mark(Mark { blocking: true, ..Mark::default() }, &threshold);
    }

    /// The two halls behind the yard and the V of fences between them.
    fn north(&mut self) {
        self.block("BIGSTON3", -624, 1292, -64, 1584);
        self.block("BIGSTON3", 512, 1292, 1088, 1584);
        self.windows(Facing::South, -512, 1292, 2, "BIGSTON3", "COMPUTE2");
        self.door(Facing::South, -352, 1292, "BIGSTON3", "MODWALL4");
        self.windows(Facing::South, -256, 1292, 2, "BIGSTON3", "COMPUTE2");
        self.windows(Facing::South, 624, 1292, 1, "BIGSTON3", "STARGR2");
        self.door(Facing::South, 736, 1292, "BIGSTON3", "SUPPORT3");
        self.windows(Facing::South, 848, 1292, 2, "BIGSTON3", "STARGR2");
        for west in [144, 280] {
            self.block("SUPPORT3", west, 1044, west + 24, 1076);
        }
    }

    fn west(&mut self) {
        // North-western house: a niche in its front and a low-roofed alcove in its corner.
        self.block("BRIKS20", -864, 788, -592, 1340);
        let b = &mut self.builder;
        b.rectangle(Style { ceiling: 128, wall: "BRIKS20", ..ALCOVE }, -624, 836, -592, 1020);
        b.rectangle(Style { floor: 32, ceiling: 128, ..ALCOVE }, -704, 1068, -592, 1292);
        b.rectangle(
            Style { floor: 32, ceiling: 128, light: 255, ceiling_texture: "TLITE6_4", ..ALCOVE },
            -664,
            1100,
            -632,
            1260,
        );
        b.rectangle(Style { floor: 32, ceiling: 128, ..ALCOVE }, -704, 1052, -664, 1068);
        b.mark(wall("COMPUTE2"), &[(-704, 1068), (-704, 1292)]);
        self.windows(Facing::East, -624, 880, 2, "BRIKS20", "LITEYEL3");
        // Western house: the front is open; behind the counter hang the shelves.
        self.block("MODWALL4", -496, 268, -336, 692);
        let b = &mut self.builder;
        b.polygon(ALCOVE, &[(-400, 308), (-336, 308), (-336, 652), (-448, 652), (-448, 356)]);
        let shelf = Style {
            floor: 64,
            ceiling: 96,
            light: 240,
            tag: 0,
            step: "CRATE1",
            lintel: "MODWALL4",
            ..ALCOVE
        };
        b.polygon(
            Style { wall: "COMPUTE2", floor_texture: "FLAT5", ..shelf },
            &[(-448, 372), (-448, 636), (-472, 636), (-472, 372)],
        );
        b.rectangle(
            Style { light: 255, ceiling_texture: "TLITE6_5", ..ALCOVE },
            -400,
            400,
            -376,
            560,
        );
        // A bench along the counter, and a screen before the northern corner: who strays behind it
        // stays for a while.
        let bench = Style { step: "CRATE1", floor_texture: "FLAT5", tag: 0, ..ALCOVE };
        b.polygon(
            Style { floor: 32, ..bench },
            &[(-448, 356), (-432, 340), (-432, 540), (-448, 540)],
        );
        b.rectangle(Style { floor: 16, ..bench }, -432, 352, -416, 500);
        b.polygon(
            Style { floor: 32, ..bench },
            &[(-416, 324), (-400, 308), (-352, 308), (-352, 324)],
        );
        b.rectangle(Style { floor: 32, ..bench }, -388, 572, -352, 588);
        self.block("SILVER3", -376, 588, -364, 652);
        // South-western house: machines under an awning.
        self.block("BIGSTON3", -624, -108, -464, 180);
        let b = &mut self.builder;
        b.rectangle(Style { ceiling: 112, ..ALCOVE }, -480, -92, -464, 140);
        b.rectangle(GROUND, -616, -100, -504, 172);
        for south in [-72, 0, 72] {
            let cabinet = Style {
                floor: 64,
                ceiling: 96,
                light: 255,
                wall: "COMPUTE2",
                step: "METAL5",
                ..ALCOVE
            };
            b.rectangle(Style { tag: 0, ..cabinet }, -496, south, -480, south + 48);
        }
    }

    fn east(&mut self) {
        // North-eastern house: its front steps back twice; a loading bay under a low roof.
        self.builder.solid(&[
            (1032, 788),
            (1240, 788),
            (1240, 1340),
            (1088, 1340),
            (1088, 1220),
            (1056, 1220),
            (1056, 1092),
            (1032, 1092),
        ]);
        self.builder.mark(
            wall("BRIKS20"),
            &[
                (1088, 1300),
                (1088, 1220),
                (1056, 1220),
                (1056, 1092),
                (1032, 1092),
                (1032, 788),
                (1240, 788),
                (1240, 1340),
            ],
        );
        let b = &mut self.builder;
        b.rectangle(Style { floor: 32, ceiling: 128, ..ALCOVE }, 1032, 828, 1144, 1044);
        b.rectangle(
            Style { floor: 32, ceiling: 128, light: 255, ceiling_texture: "TLITE6_4", ..ALCOVE },
            1072,
            860,
            1104,
            1012,
        );
        for step in 0..3 {
            let (floor, south) = (24 - 8 * step, 876 - 20 * step);
            b.rectangle(Style { floor, ceiling: 128, ..ALCOVE }, 1032, south - 20, 1072, south);
        }
        b.mark(wall("SILVER3"), &[(1144, 828), (1144, 1044)]);
        self.windows(Facing::West, 1056, 1156, 1, "BRIKS20", "LITEYEL3");
        // Eastern house: closed, with a row of lit windows and two doors.
        self.block("MODWALL4", 776, 268, 944, 692);
        // Behind the fronts there are yards that nobody enters: supplies that fall there are lost,
        // as many as in the published town.
        self.builder.rectangle(GROUND, 792, 284, 936, 676);
        self.windows(Facing::West, 776, 320, 1, "MODWALL4", "CONS1_5");
        self.door(Facing::West, 776, 416, "MODWALL4", "CITY06");
        self.windows(Facing::West, 776, 512, 1, "MODWALL4", "CONS1_1");
        self.door(Facing::West, 776, 608, "MODWALL4", "CITY06");
        // South-eastern house.
        self.block("BIGSTON3", 904, -100, 1064, 180);
        self.windows(Facing::West, 904, -40, 2, "BIGSTON3", "COMPUTE2");
    }

    /// The two towers and the three pillars before the court.
    fn middle(&mut self) {
        for (west, east) in [(-120, 48), (400, 564)] {
            let (south, north, cut) = (-112, 48, 12);
            self.house(
                "SUPPORT3",
                &[
                    (west + cut, south),
                    (east - cut, south),
                    (east, south + cut),
                    (east, north - cut),
                    (east - cut, north),
                    (west + cut, north),
                    (west, north - cut),
                    (west, south + cut),
                ],
            );
            let middle = (west + east) / 2;
            self.door(Facing::North, middle, north, "SUPPORT3", "METAL5");
            self.windows(Facing::South, middle, south, 1, "SUPPORT3", "CONS1_7");
        }
        for (x, y) in [(160, -31), (96, -97), (352, -97)] {
            self.block("METAL5", x - 8, y - 8, x + 8, y + 8);
        }
    }

    /// The court with the wreck, and a shop on either side of it.
    fn south(&mut self) {
        let court = Style { floor_texture: "TILES6", tag: COURT_TAG, ..GROUND };
        self.builder.rectangle(court, 52, -732, 404, -464);
        self.builder.rectangle(Style { light: 208, ..court }, 52, -732, 404, -640);
        self.builder.mark(wall("BRIKS20"), &[(52, -732), (404, -732)]);
        for (west, texture) in [(72, "MODWALL4"), (168, "SILVER3"), (264, "MODWALL4")] {
            self.builder.mark(wall(texture), &[(west, -732), (west + 64, -732)]);
        }
        self.shop(0);
        self.shop(768);
        // The glass house east of the eastern shop; columns stand in its corners.
        let b = &mut self.builder;
        b.solid(&[(820, -756), (1068, -756), (1068, -468), (820, -468)]);
        let glass =
            Style { ceiling: 128, light: 240, ceiling_texture: "FLAT19", wall: "SILVER3", ..ROOM };
        b.polygon(
            glass,
            &[(836, -484), (1020, -484), (1052, -516), (1052, -700), (1020, -740), (836, -740)],
        );
        b.rectangle(ROOM, 820, -636, 836, -580);
        b.rectangle(
            Style {
                floor: 64,
                ceiling: 112,
                light: 255,
                step: "SILVER3",
                lintel: "SILVER3",
                wall: "LITEBLU4",
                ..glass
            },
            1052,
            -660,
            1060,
            -556,
        );
        for x in [900, 980] {
            self.block("SUPPORT3", x - 8, -740, x + 8, -716);
        }
        self.wreck();
    }

    /// A shop with doors west and east; `shift` moves it east.
    fn shop(&mut self, shift: i32) {
        let at = |x: i32| x + shift;
        self.block("BRIKS20", at(-364), -756, at(52), -464);
        let b = &mut self.builder;
        b.rectangle(ROOM, at(-332), -704, at(20), -512);
        for west in [-364, 20] {
            b.rectangle(
                Style { ceiling: 88, light: 176, ..ROOM },
                at(west),
                -636,
                at(west + 32),
                -580,
            );
        }
        // The counter, the cupboard, and crates in the corner.
        b.rectangle(COUNTER, at(-252), -548, at(20), -512);
        b.rectangle(Style { floor: 72, step: "SILVER3", ..COUNTER }, at(-60), -580, at(20), -512);
        b.rectangle(
            Style { floor: 48, floor_texture: "CRATE1", step: "CRATE1", ..COUNTER },
            at(-332),
            -704,
            at(-268),
            -652,
        );
        // Nobody climbs onto them.
        let blocking = Mark { blocking: true, ..Mark::default() };
        b.mark(
            blocking,
            &[(at(-252), -512), (at(-252), -548), (at(-60), -548), (at(-60), -580), (at(20), -580)],
        );
        b.mark(blocking, &[(at(-332), -652), (at(-268), -652), (at(-268), -704)]);
        // A table to walk over, a rug and a lamp.
        let table = Style { floor: 20, floor_texture: "FLAT5", step: "CRATE1", ..ROOM };
        b.polygon(table, &[(at(-168), -696), (at(-108), -704), (at(-96), -612), (at(-156), -604)]);
        b.rectangle(Style { floor_texture: "FLOOR1_6", ..ROOM }, at(-248), -620, at(-184), -580);
        b.rectangle(
            Style { light: 255, ceiling_texture: "TLITE6_5", ..ROOM },
            at(-48),
            -660,
            at(0),
            -612,
        );
        b.mark(wall("COMPUTE2"), &[(at(-220), -512), (at(-92), -512)]);
        b.mark(wall("SILVER3"), &[(at(-332), -640), (at(-332), -704), (at(20), -704)]);
        // Shop windows beside the court.
        for y in [-540, -690] {
            if shift == 0 {
                self.windows(Facing::East, 52, y, 1, "BRIKS20", "LITEYEL3");
            } else {
                self.windows(Facing::West, 404, y, 1, "BRIKS20", "LITEYEL3");
            }
        }
    }

    /// A burnt-out car, low enough to clamber over.
    fn wreck(&mut self) {
        let body =
            Style { floor: 16, floor_texture: "FLAT19", step: "METAL5", tag: WRECK_TAG, ..GROUND };
        let b = &mut self.builder;
        b.polygon(
            body,
            &[
                (184, -384),
                (272, -384),
                (280, -372),
                (280, -204),
                (268, -192),
                (188, -192),
                (176, -204),
                (176, -372),
            ],
        );
        b.rectangle(Style { floor: 24, ..body }, 188, -280, 268, -204);
        b.rectangle(
            Style { floor: 40, step: "SILVER3", floor_texture: "FLOOR0_5", ..body },
            192,
            -348,
            264,
            -292,
        );
        b.rectangle(Style { floor: 24, ..body }, 188, -376, 268, -356);
        let rubble = Style { floor: 8, floor_texture: "RROCK18", step: "STONE7", ..body };
        for (x, y) in [(150, -300), (300, -250), (310, -300), (136, -220), (296, -350)] {
            b.polygon(
                rubble,
                &[(x - 12, y - 6), (x + 4, y - 12), (x + 12, y + 2), (x - 2, y + 12)],
            );
        }
    }

    /// The gate house, the walled court behind it and the waste ground beyond.
    fn south_west(&mut self) {
        let b = &mut self.builder;
        b.solid(&[(-1200, -464), (-1200, -108), (-236, -108), (-236, -464)]);
        let court = Style { light: 208, floor_texture: "RROCK18", wall: "STONE7", ..GROUND };
        b.rectangle(court, -588, -476, -236, -108);
        b.polygon(
            Style { floor_texture: "GRASS1", ..court },
            &[(-560, -440), (-420, -452), (-380, -330), (-440, -200), (-552, -240)],
        );
        b.polygon(
            Style { light: 240, wall: "ASHWALL4", ..court },
            &[(-588, -492), (-364, -492), (-364, -916), (-1012, -916)],
        );
        b.polygon(
            Style { light: 240, floor_texture: "FLAT10", ..court },
            &[(-560, -620), (-440, -580), (-400, -720), (-520, -800), (-640, -760)],
        );
        // The gate house over the passage.
        self.block("BIGSTON3", -236, -464, -80, -212);
        let b = &mut self.builder;
        let passage =
            Style { ceiling: 112, light: 208, ceiling_texture: "FLAT19", tag: 0, ..ALCOVE };
        b.rectangle(passage, -236, -420, -80, -292);
        b.rectangle(
            Style { light: 255, ceiling_texture: "TLITE6_4", ..passage },
            -180,
            -320,
            -136,
            -300,
        );
        b.rectangle(
            Style { floor: 56, floor_texture: "FLAT19", step: "SUPPORT3", ..passage },
            -188,
            -420,
            -132,
            -340,
        );
        let blocking = Mark { blocking: true, ..Mark::default() };
        b.mark(blocking, &[(-188, -420), (-188, -340), (-132, -340), (-132, -420)]);
        // Low walls with railings: seen over, not climbed.
        let low_wall = Style { floor: 40, floor_texture: "FLAT19", step: "BRIKS20", ..GROUND };
        for (west, south, east, north) in
            [(-464, -108, -252, -92), (-236, -212, -220, -124), (-588, -492, -364, -476)]
        {
            b.rectangle(low_wall, west, south, east, north);
            b.mark(
                RAILING,
                &[(west, south), (east, south), (east, north), (west, north), (west, south)],
            );
        }
        let (x, y, far, near) = (-224, -96, 28, 16);
        self.house(
            "SUPPORT3",
            &[
                (x - near, y - far),
                (x + near, y - far),
                (x + far, y - near),
                (x + far, y + near),
                (x + near, y + far),
                (x - near, y + far),
                (x - far, y + near),
                (x - far, y - near),
            ],
        );
        // Torches light a shuttered front west of the court.
        self.builder.mark(wall("SILVER3"), &[(-588, -340), (-588, -180)]);
    }

    fn fences(&mut self) {
        for (west, south) in [(-488, 788), (912, 788)] {
            self.block("SUPPORT3", west, south, west + 24, south + 24);
        }
        for (west, south) in [(664, -108), (664, -236), (400, -236)] {
            self.block("SUPPORT3", west, south, west + 16, south + 16);
        }
        for path in [
            &[(-64, 1292), (152, 1076)][..],
            &[(168, 1052), (280, 1052)],
            &[(296, 1076), (512, 1292)],
            &[(-592, 800), (-488, 800)],
            &[(-464, 788), (-368, 692)],
            &[(-464, 180), (-376, 268)],
            &[(936, 800), (1032, 800)],
            &[(920, 788), (824, 692)],
            &[(828, 268), (916, 180)],
            &[(904, -100), (680, -100)],
            &[(672, -108), (672, -220)],
            &[(664, -228), (416, -228)],
            &[(408, -236), (408, -464)],
        ] {
            self.builder.mark(FENCE, path);
        }
    }

    /// What is seen over the fences: streets, more houses, trees, and the things that lie about.
    fn scenery(&mut self) {
        let b = &mut self.builder;
        let street = Style { floor_texture: "STONE5", ..GROUND };
        b.rectangle(street, -1040, -100, -900, 1500);
        b.rectangle(street, 1300, -464, 1440, 1500);
        b.rectangle(street, -900, 1640, 1300, 1740);
        let lawn = Style { floor_texture: "GRASS1", ..GROUND };
        b.polygon(lawn, &[(0, 1330), (448, 1330), (400, 1560), (48, 1560)]);
        let fountain = Style { floor: 24, floor_texture: "FLOOR0_5", step: "STONE7", ..GROUND };
        b.polygon(
            fountain,
            &[
                (184, 1400),
                (264, 1400),
                (300, 1436),
                (300, 1484),
                (264, 1520),
                (184, 1520),
                (148, 1484),
                (148, 1436),
            ],
        );
        b.rectangle(
            Style { floor: 88, floor_texture: "FLAT19", step: "SUPPORT3", ..GROUND },
            208,
            1444,
            240,
            1476,
        );
        // Sheds lower than the sky, for a broken skyline.
        let shed = Style { floor: 104, floor_texture: "FLAT19", step: "AQRUST07", ..GROUND };
        b.rectangle(shed, -800, 300, -640, 560);
        b.rectangle(Style { floor: 72, step: "BRIKS20", ..shed }, -860, 620, -760, 740);
        b.rectangle(shed, 1100, 340, 1260, 600);
        b.rectangle(
            Style { floor: 64, step: "CRATE1", floor_texture: "CRATE1", ..shed },
            1120,
            -300,
            1216,
            -204,
        );
        b.rectangle(Style { floor: 32, step: "METAL5", ..shed }, 760, -360, 840, -270);
        // Town houses at the edge of the map.
        let edge = |texture, from, to| (Mark { lower_unpegged: true, ..wall(texture) }, [from, to]);
        for (mark, path) in [
            edge("CITY06", (-1200, -100), (-1200, 1400)),
            edge("CITY06", (1560, -464), (1560, 1500)),
            edge("BRIKS20", (-760, 1840), (1180, 1840)),
            edge("MODWALL4", (-1200, 1400), (-760, 1840)),
            edge("MODWALL4", (1560, 1500), (1180, 1840)),
        ] {
            b.mark(mark, &path);
        }
        b.thing(1, 224.0, 20.0, 90);
        for (kind, x, y) in [
            (24, 224.0, -28.0),
            (24, 754.0, 412.0),
            (10, 754.0, 312.0),
            (10, -236.0, 372.0),
            (81, 120.0, -420.0),
            (54, 60.0, 1360.0),
            (54, 388.0, 1360.0),
            (54, -560.0, 560.0),
            (54, 1010.0, 470.0),
            (85, 980.0, -180.0),
            (85, -620.0, 720.0),
        ] {
            b.thing(kind, x, y, 0);
        }
    }
}
