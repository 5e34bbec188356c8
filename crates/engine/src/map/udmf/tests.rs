use super::{UdmfFault, read, write};
use crate::map::{
    Blocks, MapSource, SourceLine, SourceSector, SourceSide, SourceThing, SourceVertex, TextureName,
};
use crate::math::Rng;

/// Every field filled at random with anything that the format can hold.
fn random_source(rng: &mut Rng) -> MapSource {
    let any = |rng: &mut Rng| match rng.below(4) {
        0 => rng.between(i32::MIN, i32::MAX),
        1 => 0,
        _ => rng.between(-300, 300),
    };
    let float = |rng: &mut Rng| match rng.below(4) {
        0 => f64::from(rng.between(-16_000, 16_000)),
        1 => f64::from(rng.between(i32::MIN, i32::MAX)) / 65536.0,
        2 => f64::from(rng.between(-1000, 1000)) / 7.0e8,
        _ => f64::from(rng.between(-1000, 1000)) * 1.0e17,
    };
    let texture = |rng: &mut Rng| {
        let letters: Vec<u8> =
            (0..rng.below(9)).map(|_| b"AZ09_-\"\\}{;=/#"[rng.below(14) as usize]).collect();
        TextureName::new(std::str::from_utf8(&letters).unwrap())
    };
    let index = |rng: &mut Rng| rng.between(0, i32::MAX) as usize;
    let args = |rng: &mut Rng| std::array::from_fn(|_| any(rng));
    let mut source = MapSource { namespace: "zdoom".into(), ..Default::default() };
    for _ in 0..rng.below(5) {
        source.vertices.push(SourceVertex { x: float(rng), y: float(rng) });
        source.lines.push(SourceLine {
            v1: index(rng),
            v2: index(rng),
            front: index(rng),
            back: (rng.below(2) == 0).then(|| index(rng)),
            blocking: rng.below(2) == 0,
            blocks: Blocks::FIELDS
                .iter()
                .filter(|_| rng.below(2) == 0)
                .fold(Blocks::default(), |all, (_, flag)| all.with(*flag)),
            upper_unpegged: rng.below(2) == 0,
            lower_unpegged: rng.below(2) == 0,
            id: any(rng),
            special: any(rng),
            triggered: false,
            args: args(rng),
        });
        source.sides.push(SourceSide {
            sector: index(rng),
            offset_x: float(rng),
            offset_y: float(rng),
            top: texture(rng),
            middle: texture(rng),
            bottom: texture(rng),
        });
        source.sectors.push(SourceSector {
            floor: any(rng),
            ceiling: any(rng),
            floor_texture: texture(rng),
            ceiling_texture: texture(rng),
            light: any(rng),
            special: any(rng),
            tag: any(rng),
        });
        source.things.push(SourceThing {
            x: float(rng),
            y: float(rng),
            height: float(rng),
            angle: any(rng),
            kind: any(rng),
            id: any(rng),
            args: args(rng),
        });
    }
    source
}

#[test]
fn what_is_written_reads_back_equal() {
    let mut rng = Rng::new(1);
    for _ in 0..400 {
        let source = random_source(&mut rng);
        let text = write(&source);
        let again = read(text.as_bytes()).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(again, source);
        assert_eq!(write(&again), text);
    }
}

#[test]
fn the_grammar_is_read_in_all_its_forms() {
    let text = r#"
        // A comment, and /* not the start of another
        NameSpace = "ZDoom"; version = 7;
        /* Unknown things are skipped, // whatever they hold */
        mystery { a = 1; b = "}"; c = yes.no; }
        vertex { x = 1; y = -2.5; comment = "quote \" and back\\slash"; }
        VERTEX{X=+0x10;Y=1.5e2;}
        vertex { x = 010; y = .5; ; }
        sector { texturefloor = "flat5"; textureceiling = "-"; heightfloor = 8.0; id = 7; user_glow = true; }
        sidedef { sector = 0; texturemiddle = "stone"; offsetx = 4; offsetx = 5; }
        linedef { v1 = 0; v2 = 1; sidefront = 0; sideback = -1; blocking = true; dontpegtop = FALSE; playerUse = true; arg4 = 3; arg5 = "x"; }
        thing { x = 0.25; y = 0; type = 1; angle = -90; }"#;
    let map = read(text.as_bytes()).unwrap();
    assert_eq!(map.namespace, "zdoom");
    let at: Vec<(f64, f64)> = map.vertices.iter().map(|v| (v.x, v.y)).collect();
    assert_eq!(at, [(1.0, -2.5), (16.0, 150.0), (8.0, 0.5)]);
    assert_eq!((map.sectors[0].floor, map.sectors[0].light, map.sectors[0].tag), (8, 160, 7));
    assert_eq!(map.sectors[0].floor_texture, TextureName::new("FLAT5"));
    assert_eq!(map.sectors[0].ceiling_texture, TextureName::NONE);
    assert_eq!(map.sides[0].offset_x, 5.0, "the last of equal fields counts");
    assert!(
        map.lines[0].triggered
            && map.lines[0].blocking
            && !map.lines[0].upper_unpegged
            && map.lines[0].back.is_none()
    );
    assert_eq!(map.lines[0].args, [0, 0, 0, 0, 3]);
    assert_eq!((map.things[0].kind, map.things[0].angle), (1, -90));
}

#[test]
fn faults_name_their_place() {
    let fault = |text: &str| {
        let text = format!("namespace=\"zdoom\";\n{text}");
        let error = read(text.as_bytes()).expect_err(&text);
        (error.line, error.column, error.fault)
    };
    assert!(matches!(
        fault("vertex { x = 1; }"),
        (2, 1, UdmfFault::MissingField { block: "vertex", field: "y" })
    ));
    assert!(matches!(fault("\n  vertex { x = \"1\"; y = 0; }"), (3, 16, UdmfFault::Value { .. })));
    assert!(matches!(
        fault("vertex { x = 1 y = 0; }"),
        (2, 16, UdmfFault::Expected { what: "`;`", .. })
    ));
    assert!(matches!(
        fault("vertex { x = ; }"),
        (2, 14, UdmfFault::Expected { what: "a value", .. })
    ));
    assert!(matches!(
        fault("vertex { vertex { x = 1; } }"),
        (2, 17, UdmfFault::Expected { what: "`=`", .. })
    ));
    assert!(matches!(fault("vertex {"), (2, 9, UdmfFault::Expected { .. })));
    assert!(matches!(fault("vertex"), (2, 7, UdmfFault::Expected { what: "`=` or `{`", .. })));
    assert!(matches!(fault("/* open"), (2, 1, UdmfFault::Unterminated { what: "comment" })));
    assert!(matches!(fault("a = \"open;\n\n"), (2, 5, UdmfFault::Unterminated { what: "string" })));
    for number in [
        "1e999",
        "99999999999999999999",
        "0x",
        "089",
        "1.2.3",
        "+-1",
        "-",
        "0x1g",
        "1e",
        "-.e5",
        "+inf",
    ] {
        assert!(
            matches!(fault(&format!("a = {number};")), (2, 5, UdmfFault::Number { .. })),
            "{number}"
        );
    }
    for number in ["nan", "inf", "true"] {
        assert!(
            matches!(
                fault(&format!("vertex {{ x = {number}; }}")),
                (2, 14, UdmfFault::Value { .. })
            ),
            "{number}"
        );
    }
    let index = |field: &str| fault(&format!("linedef {{ {field}; }}"));
    assert!(matches!(index("v1 = -1"), (2, 16, UdmfFault::Value { .. })));
    assert!(matches!(index("special = 3000000000"), (2, 21, UdmfFault::Value { .. })));
    assert!(matches!(
        fault("sidedef { texturetop = \"NINECHARS\"; }"),
        (2, 24, UdmfFault::Value { .. })
    ));
    assert!(matches!(fault("\u{1}"), (2, 1, UdmfFault::Expected { .. })));
    assert!(matches!(read(b"vertex { }").unwrap_err().fault, UdmfFault::NoNamespace));
    assert!(matches!(read(b"").unwrap_err().fault, UdmfFault::NoNamespace));
}
