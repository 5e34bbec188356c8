//! Every field of UDMF is played, reported, or without effect, as `docs/guide/maps.md` says of it.

use hasard_engine::map::{Map, MapSource, udmf};

/// A row of the table.
struct Row<'a> {
    block: &'a str,
    field: &'a str,
    example: &'a str,
    what: &'a str,
}

fn table(page: &str) -> Vec<Row<'_>> {
    let rows = page.lines().filter_map(|line| {
        let cells: Vec<&str> = line.split('|').map(|cell| cell.trim().trim_matches('`')).collect();
        let &["", block, field, example, what, _, ""] = cells.as_slice() else { return None };
        ["vertex", "linedef", "sidedef", "sector", "thing"].contains(&block).then_some(Row {
            block,
            field,
            example,
            what,
        })
    });
    rows.collect()
}

/// Two rooms side by side with an item in the first; `field` goes into the block of its kind that
/// it acts on.
fn map(block: &str, field: &str) -> MapSource {
    let mut text = String::from("namespace = \"zdoom\";\n");
    let mut add = |kind: &str, fields: String, here: bool| {
        text +=
            &format!("{kind} {{ {fields} {} }}\n", if here && kind == block { field } else { "" });
    };
    for (i, (x, y)) in
        [(0, 0), (0, 256), (256, 256), (512, 256), (512, 0), (256, 0)].into_iter().enumerate()
    {
        add("vertex", format!("x = {x}; y = {y};"), i == 0);
    }
    for (i, (v1, v2)) in [(0, 1), (1, 2), (5, 0), (2, 3), (3, 4), (4, 5)].into_iter().enumerate() {
        add("linedef", format!("v1 = {v1}; v2 = {v2}; sidefront = {i};"), i == 0);
        add("sidedef", format!("sector = {}; texturemiddle = \"STONE2\";", i / 3), i == 0);
    }
    add(
        "linedef",
        "v1 = 2; v2 = 5; sidefront = 6; sideback = 7; twosided = true;".to_owned(),
        false,
    );
    for sector in 0..2 {
        add("sidedef", format!("sector = {sector};"), false);
        let flats = "texturefloor = \"FLOOR4_8\"; textureceiling = \"FLOOR4_8\";";
        add("sector", format!("heightceiling = 128; {flats}"), sector == 0);
    }
    let there = "single = true; coop = true; dm = true; skill1 = true; skill2 = true; skill3 = true; class1 = true;";
    add("thing", format!("x = 64; y = 64; type = 2014; {there}"), true);
    add("thing", "x = 64; y = 128; type = 1;".to_owned(), false);
    udmf::read(text.as_bytes()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn every_field_does_what_the_page_says() {
    let page = std::fs::read_to_string("../../docs/guide/maps.md").unwrap();
    let rows = table(&page);
    // The base specification has 80 fields, and the extension more than as many.
    assert!(rows.len() > 200, "{} rows", rows.len());
    let plain = map("", "");
    assert_eq!(plain.left_out(), Vec::<String>::new());
    Map::build(&plain, "plain", &[]).unwrap();
    let mut wrong = Vec::new();
    for Row { block, field, example, what } in rows {
        assert!(
            example.contains(&format!("{field} = ")),
            "the example of {block} {field} is {example}"
        );
        let source = map(block, example);
        let left_out = source.left_out().join(", ");
        let is_played = MapSource { unplayed: plain.unplayed.clone(), ..source.clone() } != plain;
        let right = match what {
            "played" => is_played,
            // The number of a special, which a field lets somebody set off, is what is reported.
            "reported" => left_out.contains(field) || left_out.contains(" special "),
            // Arguments are kept, and nothing asks for them.
            "no effect" => left_out.is_empty() && (!is_played || field.starts_with("arg")),
            other => panic!("{block} {field}: {other} is no answer"),
        };
        if !right {
            wrong.push(format!("{block} {example}: {what}, but left out is {left_out:?} and the map differs: {is_played}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn defaults_are_not_reported_and_the_last_value_of_a_field_counts() {
    let silent = [
        (
            "sector",
            "gravity = 1.0; damageamount = 0; lightcolor = 0xFFFFFF; moreids = \"\"; rotationfloor = 0.0; xscalefloor = 1.0;",
        ),
        ("sector", "gravity = 0.5; gravity = 1;"),
        ("linedef", "jumpover = false; alpha = 1.0; renderstyle = \"Translucent\";"),
        ("thing", "ambush = false; special = 0; health = 1; user_mood = 3;"),
    ];
    for (block, fields) in silent {
        assert_eq!(map(block, fields).left_out(), Vec::<String>::new(), "{block} {fields}");
    }
    assert_eq!(
        map("sector", "GRAVITY = 1; gravity = 0.5;").left_out(),
        ["sector field gravity (1)"]
    );
    assert_eq!(map("thing", "single = false;").left_out(), ["thing without single or skill3 (1)"]);
}
