use super::axis::{short, ticks};
use super::*;
use crate::curve::{Curve, Point};
use crate::statistics::Estimate;

fn some_curve(slope: f64) -> Curve {
    let mean = (0..50)
        .map(|k| {
            let frames = f64::from(k) * 1e5;
            Point {
                frames,
                value: Estimate { mean: slope * f64::from(k), half_width: Some(5.0), n: 3 },
                band: None,
            }
        })
        .collect();
    let seed = |s: f64| (0..60).map(|k| (f64::from(k) * 1e5, slope * f64::from(k) + s)).collect();
    Curve { mean, seeds: vec![(1, seed(0.0)), (2, seed(3.0)), (3, seed(-3.0))] }
}

fn panel() -> Drawing {
    let series = |name: &str, index, slope| Series {
        name: name.into(),
        ink: Ink::Series(index),
        curve: some_curve(slope),
        behind: false,
    };
    line_panel(&LinePanel {
        title: "cost & <more>".into(),
        axis: String::new(),
        series: vec![series("PPO", 0, 1.5), series("PPO\"Lag", 2, 0.8)],
        budget: Some(50.0),
        size: (380.0, 230.0),
    })
}

#[test]
fn ticks_are_round_and_cover() {
    for (low, high) in [(0.0, 1.0), (0.0, 123.4), (-7.0, 3.0), (0.0, 5e8), (0.2, 0.21), (0.0, 0.0)]
    {
        let values = ticks(low, high, 4);
        assert!(values[0] <= low && values[values.len() - 1] >= high, "{low} {high}: {values:?}");
        assert!((2..=8).contains(&values.len()), "{values:?}");
    }
    assert_eq!(ticks(0.0, 100.0, 4), [0.0, 25.0, 50.0, 75.0, 100.0]);
    assert_eq!(
        [0.0, 2.5, 12_000.0, 1.5e6, 2e9, -40.0].map(short),
        ["0", "2.5", "12k", "1.5M", "2G", "-40"]
    );
}

#[test]
fn names_of_users_cannot_break_the_svg() {
    let svg = standalone_svg(
        &figure("a < b & \"c\"", vec![panel()], 2, &[("x<y".into(), Ink::Series(1))]),
        "l\"<",
    );
    assert!(
        svg.contains("cost &amp; &lt;more&gt;")
            && svg.contains("x&lt;y")
            && !svg.contains("<more>")
    );
    let inline = inline_svg(&panel(), "label");
    assert!(inline.contains("data-values=\"{&quot;from&quot;:0"), "{inline}");
    assert!(inline.contains("PPO\\&quot;Lag"));
}

#[test]
fn the_picture_has_the_colours_of_the_style() {
    for (index, [r, g, b]) in raster::LIGHT.iter().enumerate() {
        let name = match index.checked_sub(SERIES_COLOURS) {
            None => format!("--ink-{index}"),
            Some(other) => ["--ink-text", "--ink-muted", "--ink-grid", "--ink-budget", "--ground"]
                [other]
                .to_owned(),
        };
        assert!(svg::INK_STYLE.contains(&format!("{name}:#{r:02x}{g:02x}{b:02x};")), "{name}");
    }
    let picture = rasterise(&panel()).unwrap();
    let has = |colour: [u8; 3]| picture.rgb().chunks_exact(3).any(|pixel| pixel == colour);
    assert!(has(raster::LIGHT[0]) && has(raster::LIGHT[2]) && has([255; 3]));
}

#[test]
fn empty_and_immense_figures_are_drawn() {
    let empty = line_panel(&LinePanel { size: (300.0, 200.0), ..LinePanel::default() });
    assert!(inline_svg(&empty, "").contains("no report yet"));
    assert!(rasterise(&Drawing::new(1e9, 10.0)).is_none());
    assert!(rasterise(&Drawing::new(f64::NAN, 10.0)).is_none());
    let bars = bar_panel(
        "t",
        &[BarGroup { name: "g".into(), bars: vec![], budget: None }],
        (200.0, 150.0),
    );
    assert!(rasterise(&bars).is_some());
    let bar = Bar {
        name: "b".into(),
        value: -3.0,
        interval: Some((-900.0, 800.0)),
        ink: Ink::Series(40),
        pale: false,
    };
    let bars = bar_panel(
        "t",
        &[BarGroup { name: "a rather long name".into(), bars: vec![bar], budget: Some(2.0) }],
        (200.0, 150.0),
    );
    assert!(rasterise(&bars).is_some());
}

#[test]
fn names_of_many_narrow_groups_stand_whole_in_two_rows() {
    let names = ["PPO", "PPOCost", "PPOLag", "PPOSaute", "PPOPID", "P3O"];
    let bar = || Bar {
        name: "seed".into(),
        value: 1.0,
        interval: None,
        ink: Ink::Series(0),
        pale: false,
    };
    let groups = names.map(|name| BarGroup { name: name.into(), bars: vec![bar()], budget: None });
    let drawn = |groups: &[BarGroup]| -> Vec<(String, f64)> {
        let shapes = bar_panel("return", groups, (260.0, 190.0)).shapes;
        let texts = shapes.into_iter().filter_map(|shape| match shape {
            Shape::Text { text, at, .. } => Some((text, at.1)),
            _ => None,
        });
        texts.filter(|(text, _)| names.contains(&text.as_str())).collect()
    };
    let all = drawn(&groups);
    assert_eq!(all.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), names);
    assert!(all[0].1 < all[1].1 && all[0].1 == all[2].1, "{all:?}");
    // Where there is room, one row.
    let few = drawn(&groups[..2]);
    assert_eq!(few[0].1, few[1].1);
}

/// As the report draws thirteen algorithms beside the paper's: each is named whole, and none runs
/// into another or out of the picture.
#[test]
fn names_of_all_algorithms_stand_whole_and_apart() {
    let bar = || Bar {
        name: "here".into(),
        value: 1.0,
        interval: None,
        ink: Ink::Series(0),
        pale: false,
    };
    let names = crate::group::ALGORITHMS;
    let groups =
        names.map(|name| BarGroup { name: name.into(), bars: vec![bar(), bar()], budget: None });
    let shapes = bar_panel("return", &groups, (306.0, 180.0)).shapes;
    let texts = shapes.into_iter().filter_map(|shape| match shape {
        Shape::Text { text, at, .. } if names.contains(&text.as_str()) => Some((text, at)),
        _ => None,
    });
    let texts: Vec<(String, (f64, f64))> = texts.collect();
    assert_eq!(texts.len(), names.len());
    let ends = |(text, (x, _)): &(String, (f64, f64))| {
        let half = text_width(text, 11.0) / 2.0;
        (x - half, x + half)
    };
    for (at, one) in texts.iter().enumerate() {
        let (left, right) = ends(one);
        assert!(left >= 0.0 && right <= 306.0 && one.1.1 <= 180.0, "{one:?}");
        for other in texts[at + 1..].iter().filter(|other| other.1.1 == one.1.1) {
            assert!(ends(other).0 > right || ends(other).1 < left, "{one:?} {other:?}");
        }
    }
}
