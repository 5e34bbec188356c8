//! The cave of Detonator's Dilemma: a long hall under the open sky, with courts to the west and
//! north.
//!
//! What can be walked on, the heights and the light levels are those of the benchmark; the rock
//! faces, the ledges behind the bays and what grows there are our own. First the ground is painted
//! without regard to walls, then the rock is laid around it with the cave cut out, then what stands
//! in the cave and in the rock.
//!
//! Long because it is a drawing: one list of courts, walls and things, in map order.

use crate::scenarios::detonators_dilemma::terrain;
use hasard_engine::map::{MapBuilder, MapSource, Mark, SourceThing, Style};
use hasard_engine::math::Rng;

/// Light where no rock shades the ground.
const OPEN: i32 = 208;
/// Light along the foot of the walls.
const SHADE: i32 = 176;
/// The seven goals of the walkers: x, y; their thing ids are 11 and up.
const PATROL_POINTS: [(i32, i32); 7] = [
    (-576, -1408),
    (-576, -384),
    (-64, -384),
    (320, -1024),
    (704, -448),
    (1664, -1024),
    (1792, -448),
];
/// Editor number of a patrol point.
const PATROL_POINT: i32 = 9024;

const GROUND: Style = Style {
    floor: 256,
    ceiling: 688,
    light: OPEN,
    floor_texture: "GRASS1",
    ceiling_texture: "F_SKY1",
    wall: "ZIMMER3",
    step: "STONE7",
    lintel: "ZIMMER3",
    special: 0,
    tag: 0,
};

/// The foot of the rock, clockwise, and the face of each stretch as it goes on from its point.
#[rustfmt::skip]
const OUTLINE: [(i32, i32, &str); 91] = [
    // The hall's western wall with its niche, and the gate in the north-west.
    (-716, -1620, "ZIMMER3"), (-716, -1180, "ASHWALL4"), (-716, -724, "ZIMMER8"), (-732, -684, "ZIMMER8"),
    (-732, -652, "ZIMMER8"), (-716, -612, "ZIMMER3"), (-716, -236, "STONE7"), (-716, -160, "ZIMMER3"),
    // The western court.
    (-740, -112, "ZIMMER3"), (-756, -216, "ZIMMER2"), (-884, -352, "ZIMMER3"), (-880, -900, "ASHWALL4"),
    (-876, -1612, "ZIMMER3"), (-1244, -1604, "ZIMMER3"), (-1240, -600, "ZIMMER2"), (-1228, 268, "ZIMMER3"),
    (-860, 268, "ASHWALL4"), (-732, 396, "ZIMMER3"), (-380, 396, "STONE7"), (-372, 264, "ZIMMER3"),
    (-228, 268, "ZIMMER3"), (-100, 140, "ZIMMER3"), (260, 140, "ZIMMER8"), (428, 88, "ZIMMER8"),
    (428, 140, "ZIMMER8"), (532, 148, "ZIMMER3"),
    // The northern courts.
    (412, 308, "ASHWALL4"), (-332, 308, "ZIMMER3"), (-340, 440, "ZIMMER3"), (-588, 436, "ZIMMER2"),
    (-588, 780, "ZIMMER3"), (-348, 780, "ZIMMER3"), (-340, 916, "ZIMMER3"), (-116, 916, "ASHWALL4"),
    (-100, 528, "ZIMMER3"), (52, 540, "ZIMMER3"), (52, 916, "ZIMMER3"), (404, 916, "ASHWALL4"),
    (412, 652, "ZIMMER3"), (1060, 652, "ZIMMER3"), (1076, 916, "ZIMMER3"), (1188, 916, "ZIMMER8"),
    (1220, 772, "ZIMMER8"), (1308, 916, "ZIMMER3"), (1420, 916, "ASHWALL4"), (1436, 528, "ZIMMER3"),
    (1588, 540, "ZIMMER3"), (1580, 916, "ZIMMER3"), (1812, 916, "ZIMMER3"), (1820, 780, "ZIMMER3"),
    (2068, 780, "ZIMMER2"), (2060, 428, "ZIMMER3"), (1828, 436, "ZIMMER3"), (1804, 308, "ZIMMER3"),
    (1004, 284, "ZIMMER3"), (908, 156, "STONE7"), (908, -332, "STONE7"), (564, -332, "STONE7"),
    (540, -76, "ZIMMER3"), (316, -76, "ZIMMER8"), (212, -20, "ZIMMER8"), (100, -84, "ZIMMER3"),
    (-236, -76, "STONE7"), (-236, -236, "ZIMMER3"),
    // The hall's northern wall, its eastern tip, and the wedge of rock between its two arms.
    (-232, -244, "ZIMMER3"), (156, -244, "ZIMMER2"), (172, -284, "ZIMMER2"), (284, -372, "ZIMMER3"),
    (920, -372, "ZIMMER3"), (1844, -372, "ZIMMER8"), (1948, -404, "ZIMMER8"), (1996, -448, "ASHWALL4"),
    (1996, -472, "ASHWALL4"), (1932, -572, "ASHWALL4"), (1868, -596, "ZIMMER2"), (1572, -590, "ZIMMER2"),
    (1516, -612, "ZIMMER2"), (1428, -732, "ASHWALL4"), (1428, -748, "ASHWALL4"), (1562, -882, "ZIMMER3"),
    (1924, -876, "ZIMMER3"),
    // The southern wall with its three bays, and the dead end in the south-west.
    (1932, -1100, "ZIMMER3"), (1052, -1100, "ZIMMER8"), (1006, -1138, "ZIMMER8"), (1012, -1268, "ZIMMER3"),
    (708, -1268, "ZIMMER2"), (708, -1164, "ZIMMER2"), (676, -1100, "ZIMMER2"), (652, -1100, "ZIMMER2"),
    (604, -1204, "ZIMMER3"), (212, -1208, "ZIMMER2"),
];

/// The rest of [`OUTLINE`], from the middle bay westward.
#[rustfmt::skip]
const OUTLINE_SOUTH_WEST: [(i32, i32, &str); 14] = [
    (204, -1124, "ZIMMER2"), (150, -1108, "ZIMMER2"), (96, -1176, "ZIMMER2"), (100, -1238, "ZIMMER3"),
    (-60, -1260, "ZIMMER3"), (-284, -1244, "ZIMMER2"), (-316, -1124, "ZIMMER2"), (-358, -1108, "ZIMMER2"),
    (-372, -1124, "ZIMMER3"), (-372, -1380, "ZIMMER8"), (-348, -1412, "ZIMMER8"), (-308, -1420, "ZIMMER8"),
    (-324, -1604, "ZIMMER3"), (-420, -1636, "ZIMMER3"),
];

/// Everything that grows: editor number, x, y.
const PLANTS: [(i32, i32, i32); 30] = [
    (TORCH_TREE, -176, -1296),
    (TORCH_TREE, -160, -1216),
    (TORCH_TREE, 16, -1224),
    (TORCH_TREE, -640, -1408),
    (BIG_TREE, -640, -1280),
    (TORCH_TREE, -640, -960),
    (TORCH_TREE, -576, -1088),
    (STUMP, -576, -576),
    (TORCH_TREE, -448, -1344),
    (TORCH_TREE, -128, -512),
    (TORCH_TREE, 0, -448),
    (STUMP, 192, -576),
    (TORCH_TREE, 320, -640),
    (TORCH_TREE, 384, -896),
    (TORCH_TREE, 704, -576),
    (TORCH_TREE, 1088, -640),
    (BIG_TREE, 1152, -960),
    (STUMP, 1280, -832),
    (TORCH_TREE, 1344, -960),
    (TORCH_TREE, 1536, -1024),
    (TORCH_TREE, 1875, -424),
    (TORCH_TREE, 1600, -448),
    (TORCH_TREE, 1152, -448),
    (TORCH_TREE, 1344, -448),
    (TORCH_TREE, 501, -1280),
    (TORCH_TREE, 48, -1152),
    (TORCH_TREE, 309, -1200),
    (STUMP, 256, -768),
    (BIG_TREE, 192, -896),
    (STUMP, 64, -320),
];
const TORCH_TREE: i32 = 43;
const STUMP: i32 = 47;
const BIG_TREE: i32 = 54;
/// Plants of the courts, where no walker goes.
const COURT_PLANTS: [(i32, i32, i32); 9] = [
    (TORCH_TREE, -1100, -300),
    (BIG_TREE, -1140, -1400),
    (STUMP, -980, -700),
    (TORCH_TREE, -500, 600),
    (BIG_TREE, 250, 800),
    (TORCH_TREE, 760, 520),
    (STUMP, 1250, 480),
    (TORCH_TREE, 1700, 800),
    (TORCH_TREE, 1960, 600),
];

/// The map of a level, 1..=3. Levels differ in the start, and level 1 has one of the patrol points
/// twice.
#[must_use]
pub fn source(level: u8) -> MapSource {
    let mut builder = MapBuilder::new();
    ground(&mut builder);
    rock(&mut builder);
    shades(&mut builder);
    bays(&mut builder);
    gate(&mut builder);
    barred_window(&mut builder);
    things(&mut builder, level);
    builder.finish().expect("the cave fits together")
}

fn ground(b: &mut MapBuilder) {
    let court = Style { floor: 288, floor_texture: "RROCK18", ..GROUND };
    let high = Style { floor: 336, floor_texture: "MFLR8_3", ..GROUND };
    b.rectangle(court, -1300, -1700, 600, 420);
    // The western court climbs southwards.
    for (north, floor, floor_texture) in [
        (-330, 312, "RROCK19"),
        (-450, 336, "RROCK18"),
        (-560, 360, "RROCK17"),
        (-680, 384, "RROCK19"),
        (-800, 400, "FLAT10"),
        (-920, 416, "RROCK18"),
    ] {
        let edge = [(-1300, 0), (-1180, -30), (-1060, 20), (-940, -20), (-800, 15)]
            .map(|(x, dy)| (x, north + dy));
        let mut corners = edge.to_vec();
        corners.extend([(-800, -1700), (-1300, -1700)]);
        b.polygon(Style { floor, floor_texture, ..GROUND }, &corners);
    }
    b.polygon(
        Style { floor_texture: "GRASS1", ..court },
        &[(-1100, -100), (-980, 20), (-700, 60), (-560, 300), (-800, 300), (-1180, 180)],
    );
    // Stairs up to the northern courts.
    for step in 0..6 {
        let west = 170 + 40 * step;
        b.rectangle(
            Style { floor: 296 + 8 * step, floor_texture: "MFLR8_3", ..GROUND },
            west,
            -200,
            600,
            200,
        );
    }
    b.rectangle(high, 440, -352, 940, 420);
    b.rectangle(high, -620, 250, 2100, 960);
    b.rectangle(court, -1300, 250, -360, 420);
    b.polygon(
        Style { floor: 320, floor_texture: "FLAT10", ..high },
        &[
            (1400, 400),
            (1640, 420),
            (1900, 380),
            (2100, 480),
            (2000, 700),
            (1700, 640),
            (1480, 680),
        ],
    );
    b.polygon(
        Style { floor: 352, floor_texture: "RROCK17", ..high },
        &[(-200, 380), (40, 340), (240, 420), (300, 700), (60, 760), (-60, 560)],
    );
    b.polygon(
        Style { floor: 344, floor_texture: "GRASS1", ..high },
        &[(640, 340), (900, 360), (1010, 500), (900, 620), (700, 600), (600, 460)],
    );
    // The hall: what the patches leave free is as high as its middle.
    b.polygon(
        GROUND,
        &[(-740, -1700), (2020, -1700), (2020, -352), (300, -352), (160, -244), (-740, -244)],
    );
    for patch in &terrain::HALL {
        let (floor_texture, step) = match patch.floor {
            224 => ("FLAT10", "STONE7"),
            232..256 => ("RROCK17", "ZIMMER8"),
            256 => ("GRASS1", "STONE7"),
            272 => ("RROCK19", "ZIMMER2"),
            280 => ("RROCK17", "ZIMMER2"),
            288 => ("RROCK18", "ZIMMER8"),
            _ => ("RROCK17", "ASHWALL4"),
        };
        b.polygon(Style { floor: patch.floor, floor_texture, step, ..GROUND }, patch.outline);
    }
    // The pad where the player of level 1 starts.
    let pad = Style { floor: 264, floor_texture: "MFLR8_3", step: "STONE7", ..GROUND };
    b.polygon(
        pad,
        &[
            (1804, -1030),
            (1844, -1030),
            (1862, -1012),
            (1862, -974),
            (1844, -956),
            (1804, -956),
            (1786, -974),
            (1786, -1012),
        ],
    );
    // The bays of the southern wall rise towards the back.
    for (i, floor_texture) in
        ["RROCK19", "RROCK17", "FLAT10", "RROCK18", "RROCK17"].into_iter().enumerate()
    {
        let (floor, north) = (264 + 8 * i as i32, -1108 - 26 * i as i32);
        for (west, east) in [(-340, 160), (180, 690), (690, 1040)] {
            let middle = (west + east) / 2;
            b.polygon(
                Style { floor, floor_texture, step: "ZIMMER8", ..GROUND },
                &[
                    (west, north - 12),
                    ((west + middle) / 2, north + 6),
                    (middle, north - 14),
                    ((east + middle) / 2, north + 8),
                    (east, north - 8),
                    (east, -1300),
                    (west, -1300),
                ],
            );
        }
    }
}

/// Rock everywhere but inside the outline, which is roughened on the way.
fn rock(b: &mut MapBuilder) {
    let mut rng = Rng::new(0x0C1F);
    let corners: Vec<(i32, i32, &'static str)> =
        OUTLINE.iter().chain(&OUTLINE_SOUTH_WEST).copied().collect();
    let mut stretches: Vec<(&'static str, Vec<(i32, i32)>)> = Vec::new();
    for (i, &(x, y, texture)) in corners.iter().enumerate() {
        let (to_x, to_y, _) = corners[(i + 1) % corners.len()];
        stretches.push((texture, roughened((x, y), (to_x, to_y), &mut rng)));
    }
    // Around the map, then in to the outline and around that: what lies between is rock.
    let (west, south, east, north) = (-1400, -1800, 2200, 1060);
    let mut cut = vec![(west, south), (east, south), (east, north), (west, north), (west, south)];
    cut.extend(stretches.iter().flat_map(|(_, path)| &path[..path.len() - 1]));
    cut.push(stretches[0].1[0]);
    b.solid(&cut);
    for (texture, path) in &stretches {
        b.mark(Mark { wall: Some(texture), ..Mark::default() }, path);
    }
    // A pinnacle in the hall, with a tree on it.
    let pinnacle = Style { floor: 392, floor_texture: "RROCK17", step: "ZIMMER3", ..GROUND };
    b.polygon(
        pinnacle,
        &[
            (206, -982),
            (164, -960),
            (150, -884),
            (102, -836),
            (96, -782),
            (114, -738),
            (132, -742),
            (220, -816),
            (210, -862),
            (210, -890),
            (222, -948),
        ],
    );
    b.polygon(
        Style { floor: 424, ..pinnacle },
        &[(198, -950), (172, -930), (164, -880), (192, -860), (202, -900)],
    );
}

/// Points about 90 apart from one corner to the next, both included, those between pushed up to 11
/// units into the rock, which is on the left.
fn roughened(from: (i32, i32), to: (i32, i32), rng: &mut Rng) -> Vec<(i32, i32)> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = (dx * dx + dy * dy).isqrt();
    let pieces = (length / 90).max(1);
    let mut path = vec![from];
    for piece in 1..pieces {
        let depth = rng.between(1, 11);
        let along = |start: i32, delta: i32, normal: i32| {
            start + delta * piece / pieces + normal * depth / length
        };
        path.push((along(from.0, dx, -dy), along(from.1, dy, dx)));
    }
    path.push(to);
    path
}

/// Shadow along the foot of the southern and western walls and behind the pinnacle.
fn shades(b: &mut MapBuilder) {
    for corners in [
        &[(-740, -1640), (-660, -1560), (-660, -300), (-740, -240)][..],
        &[
            (-740, -330),
            (-660, -300),
            (130, -300),
            (260, -430),
            (620, -430),
            (1840, -430),
            (2000, -520),
            (2000, -350),
            (-740, -220),
        ],
        &[
            (1340, -620),
            (1420, -560),
            (1850, -560),
            (2000, -460),
            (2000, -620),
            (1500, -640),
            (1400, -740),
            (1340, -740),
        ],
        &[(228, -954), (227, -810), (142, -738), (200, -690), (290, -780), (280, -930)],
        &[
            (-1250, -1620),
            (-1180, -1560),
            (-1180, 200),
            (-840, 200),
            (-720, 330),
            (-360, 330),
            (-360, 410),
            (-760, 410),
            (-1250, 290),
        ],
        &[
            (420, 140),
            (480, 260),
            (1010, 250),
            (1810, 260),
            (1850, 420),
            (1700, 330),
            (560, 340),
            (-340, 360),
            (-340, 300),
            (410, 300),
        ],
    ] {
        b.shade(SHADE, corners);
    }
}

/// Ledges behind the bays of the southern wall: scenery that nobody reaches.
fn bays(b: &mut MapBuilder) {
    for (west, east, south) in [(-380, 160, -1300), (140, 680, -1300), (660, 1080, -1300)] {
        b.shade(SHADE, &[(west, south), (east, south), (east - 40, -1170), (west + 40, -1150)]);
    }
    let ledge = Style {
        floor: 332,
        floor_texture: "RROCK17",
        step: "ZIMMER2",
        wall: "ZIMMER3",
        light: 192,
        ..GROUND
    };
    let back = Style { floor: 400, step: "ASHWALL4", ..ledge };
    let blocking = Mark { blocking: true, ..Mark::default() };
    // (front of the ledge, depth of the ledge); the front follows the rock's foot exactly.
    for (front, deep) in [
        (&[(-284, -1244), (-60, -1260), (100, -1238)][..], -1400),
        (&[(212, -1208), (604, -1204)], -1380),
        (&[(708, -1268), (1012, -1268)], -1420),
    ] {
        let (first, last) = (front[0], front[front.len() - 1]);
        let mut corners: Vec<(i32, i32)> = front.to_vec();
        corners.extend([
            (last.0 + 30, (last.1 + deep) / 2),
            (last.0 - 10, deep),
            (first.0 + 20, deep + 16),
            (first.0 - 24, (first.1 + deep) / 2),
        ]);
        b.polygon(ledge, &corners);
        let middle = (first.0 + last.0) / 2;
        b.polygon(
            back,
            &[
                (first.0 + 20, deep + 16),
                (last.0 - 10, deep),
                (last.0 - 20, deep + 70),
                (middle, deep + 100),
                (first.0 + 50, deep + 64),
            ],
        );
        b.mark(blocking, front);
        b.mark(
            Mark { middle: Some("MIDSPACE"), ..blocking },
            &[(last.0 + 30, (last.1 + deep) / 2), (first.0 - 24, (first.1 + deep) / 2)],
        );
    }
    // The dead end in the south-west looks into a lower cave.
    let pool = Style {
        ceiling: 400,
        light: 144,
        floor_texture: "NUKAGE1",
        ceiling_texture: "RROCK15",
        floor: 280,
        ..GROUND
    };
    b.polygon(pool, &[(-640, -1624), (-420, -1636), (-420, -1720), (-560, -1750), (-650, -1720)]);
    b.mark(Mark { middle: Some("MIDBARS3"), ..blocking }, &[(-640, -1624), (-420, -1636)]);
}

/// The portico between the hall and the courts.
fn gate(b: &mut MapBuilder) {
    let under = Style {
        floor: 288,
        ceiling: 432,
        light: SHADE,
        floor_texture: "MFLR8_3",
        ceiling_texture: "RROCK15",
        ..GROUND
    };
    let under = Style { wall: "STONE7", lintel: "ZIMMER2", ..under };
    b.polygon(under, &[(-716, -224), (-236, -224), (-236, -100), (-716, -160)]);
    for (x, y) in [(-606, -112), (-351, -112), (-606, -216), (-351, -216)] {
        b.solid(&[(x - 10, y - 10), (x + 10, y - 10), (x + 10, y + 10), (x - 10, y + 10)]);
        b.mark(
            Mark { wall: Some("STONE7"), ..Mark::default() },
            &[
                (x - 10, y - 10),
                (x + 10, y - 10),
                (x + 10, y + 10),
                (x - 10, y + 10),
                (x - 10, y - 10),
            ],
        );
    }
}

/// A barred opening between the hall and the northern courts: seen through, never passed.
fn barred_window(b: &mut MapBuilder) {
    let sill = Style {
        floor: 352,
        ceiling: 496,
        light: SHADE,
        floor_texture: "MFLR8_3",
        ceiling_texture: "RROCK15",
        ..GROUND
    };
    b.rectangle(Style { wall: "STONE7", lintel: "ZIMMER3", ..sill }, 580, -384, 892, -320);
    for west in [676, 780] {
        b.solid(&[(west, -372), (west + 16, -372), (west + 16, -340), (west, -340)]);
    }
    let bars =
        Mark { middle: Some("MIDBARS3"), blocking: true, lower_unpegged: true, ..Mark::default() };
    for y in [-384, -320] {
        b.mark(bars, &[(580, y), (892, y)]);
    }
}

fn things(b: &mut MapBuilder, level: u8) {
    let (x, y) = if level == 1 { (1824.0, -992.0) } else { (1811.0, -974.0) };
    b.thing(1, x, y, 180);
    for (kind, x, y) in PLANTS.into_iter().chain(COURT_PLANTS) {
        b.thing(kind, f64::from(x), f64::from(y), 0);
    }
    // Two barrels in the western court, which the rules know nothing of.
    b.thing(2035, -1052.0, -1132.0, 0).thing(2035, -982.0, -1122.0, 0);
    for (i, (x, y)) in PATROL_POINTS.into_iter().enumerate() {
        let id = 11 + i as i32;
        let point = SourceThing {
            x: f64::from(x),
            y: f64::from(y),
            kind: PATROL_POINT,
            id,
            ..SourceThing::default()
        };
        b.thing_with(point);
        if level == 1 && id == 16 {
            b.thing_with(point);
        }
    }
}
