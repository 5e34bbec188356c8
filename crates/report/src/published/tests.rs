use super::*;

fn config(extra: &str, algo: &str, env: &str) -> Config {
    Config::parse(&format!("{{\"env\":{{\"id\":\"{env}\",\"rules\":\"tables\"{extra}}},\"algo\":\"{algo}\",\"seed\":1}}"))
        .unwrap()
}

fn of(extra: &str, algo: &str, env: &str) -> Option<&'static Published> {
    published(&config(extra, algo, env))
}

/// Cells of each table, and sums of (place in the table) x (value in hundredths) over returns and
/// costs in the paper's order, computed from the paper's LaTeX: a missing, mistyped or exchanged
/// value changes them.
const CHECKSUMS: [(&str, i64, i64, i64); 7] = [
    ("main", 108, 27_234_174, 38_048_645),
    ("trpo", 18, 899_692, 1_381_204),
    ("hard", 18, 413_952, 346_268),
    ("cost-scale", 24, 2_226_486, 883_712),
    ("full-actions", 6, 42_291, 60_765),
    ("curriculum", 4, 14_731, 5_005),
    ("human", 18, 958_338, 326_593),
];

#[test]
fn every_cell_of_the_papers_tables_is_there() {
    for (table, cells, returns, costs) in CHECKSUMS {
        let own: Vec<&Published> = PUBLISHED.iter().filter(|cell| cell.table == table).collect();
        let sum = |of: fn(&Published) -> f64| -> i64 {
            own.iter()
                .enumerate()
                .map(|(place, cell)| (place as i64 + 1) * (of(cell) * 100.0).round() as i64)
                .sum()
        };
        assert_eq!(own.len() as i64, cells, "{table}");
        assert_eq!(
            (sum(|cell| cell.printed_return), sum(|cell| cell.cost)),
            (returns, costs),
            "{table}"
        );
    }
    assert_eq!(PUBLISHED.len(), 196);
    for cell in PUBLISHED.iter() {
        let known =
            crate::group::scenario_order(&cell.scenario) < 6 && (1..=3).contains(&cell.level);
        assert!(
            known
                && (crate::group::algorithm_order(&cell.algorithm) < 13
                    || cell.algorithm == "Human"),
            "{cell:?}"
        );
    }
}

#[test]
fn the_numbers_of_the_papers_text() {
    assert_eq!(published_figure("segmentation_return_ratio"), Some(1.21));
    assert_eq!(published_figure("depth_return_ratio"), Some(1.34));
    assert_eq!(published_figure("frames_per_second"), Some(53_985.0));
    assert_eq!(published_figure("updates_per_second"), Some(15.12));
    assert_eq!(published_figure("frames"), None);
}

#[test]
fn an_experiment_finds_its_own_cell() {
    let main = of("", "PPOLag", "RemedyRushLevel1-v0").unwrap();
    assert_eq!((main.episode_return, main.cost), (36.37, 5.25));
    assert!(
        main.note().contains("5.25, not 5") && main.note().contains("three seeds"),
        "{}",
        main.note()
    );
    assert_eq!(of("", "TRPOPID", "RemedyRushLevel1-v0").unwrap().episode_return, 10.36);
    assert_eq!(of(",\"hard\":true", "PPO", "VolcanicVentureLevel1-v0").unwrap().cost, 1410.0);
    let hard = of(",\"hard\":true", "PPO", "ArmamentBurdenLevel1-v0").unwrap();
    assert!(hard.note().contains("last step") && hard.note().contains("twice"), "{}", hard.note());
    assert_eq!(
        of(",\"full_actions\":true", "PPOLag", "RemedyRushLevel1-v0").unwrap().episode_return,
        24.96
    );
    assert_eq!(of(",\"early_creatures\":true", "PPOLag", "RemedyRushLevel1-v0"), None);
    assert_eq!(of(",\"observation\":\"segmented\"", "PPOLag", "VolcanicVentureLevel1-v0"), None);
    assert!(
        of("", "P3O", "DetonatorsDilemmaLevel1-v0").unwrap().note().contains("other creatures")
    );
    assert_eq!(published_human("CollateralDamage", 2).unwrap().episode_return, 17.34);
    let parse = |extra: &str, algo: &str, env: &str| {
        Config::parse(&format!(
            "{{\"env\":\"{env}\",\"rules\":\"tables\",\"algo\":\"{algo}\",\"seed\":1{extra}}}"
        ))
        .unwrap()
    };
    let scaled = parse(",\"cost_scale\":0.5", "PPOCost", "PrecipicePlungeLevel1-v0");
    // 441.61 - 0.5 x 399.14, the paper's cost-scale table.
    assert!((published(&scaled).unwrap().episode_return - 242.04).abs() < 1e-9);
    let lessons = parse(",\"curriculum\":[1,2,3]", "PPOPID", "CollateralDamageLevel1-v0");
    assert_eq!(published(&lessons).unwrap().episode_return, 15.32);
    assert_eq!(
        published(&parse(",\"safety_budget\":25", "PPOLag", "VolcanicVentureLevel1-v0")),
        None
    );
    let alone = config("", "PPOPID", "RemedyRushLevel3-v0");
    assert_eq!(published(&alone).unwrap().episode_return, 13.51);
    assert_eq!(published_in(&alone, "curriculum").unwrap().episode_return, 6.65);
    // The main table's PPOCost on Armament Burden ran at scale 0.1: 5.47 - 0.9 x 3.67.
    let cost = of("", "PPOCost", "ArmamentBurdenLevel1-v0").unwrap();
    assert!((cost.episode_return - 2.167).abs() < 1e-9 && cost.note().contains("printed as 5.47"));
}

#[test]
fn published_values_stand_beside_the_tables_rules_alone() {
    for rules in [",\"rules\":\"paper\"", ",\"rules\":\"released\"", ""] {
        let config = Config::parse(&format!(
            "{{\"env\":\"RemedyRushLevel1-v0\",\"algo\":\"PPO\",\"seed\":1{rules}}}"
        ))
        .unwrap();
        assert_eq!((published(&config), published_in(&config, "hard")), (None, None));
        assert!(published_curve(&config, "return").is_none());
    }
}

#[test]
fn the_curves_are_those_of_the_figures() {
    let (curves, points) = curves::size();
    assert_eq!(curves, 360);
    assert!((25_000..36_000).contains(&points), "{points}");
    // Copied from the figures' own points: frames in millions, mean, half width.
    type Case = (&'static str, &'static str, &'static str, &'static str, [(f64, f64, f64); 3]);
    let cases: [Case; 5] = [
        (
            "",
            "PPOPID",
            "VolcanicVentureLevel1-v0",
            "return",
            [(5.0, 10.72, 1.45), (50.0, 32.02, 0.745), (499.0, 45.0, 0.449)],
        ),
        (
            "",
            "PPOPID",
            "CollateralDamageLevel1-v0",
            "cost",
            [(10.0, 30.53, 1.32), (50.0, 6.607, 0.274), (499.0, 5.097, 0.352)],
        ),
        (
            "",
            "TRPOLag",
            "ArmamentBurdenLevel1-v0",
            "cost",
            [(5.0, 161.8, 48.9), (100.0, 38.12, 35.2), (499.0, 50.8, 11.9)],
        ),
        (
            "",
            "PPO",
            "PrecipicePlungeLevel3-v0",
            "cost",
            [(5.0, 890.3, 6.46), (100.0, 896.1, 6.59), (499.0, 898.1, 2.21)],
        ),
        (
            ",\"full_actions\":true",
            "PPOLag",
            "RemedyRushLevel1-v0",
            "return",
            [(5.0, 6.11, 0.0), (100.0, 3.85, 0.0), (499.0, 25.88, 0.0)],
        ),
    ];
    for (extra, algo, env, metric, expected) in cases {
        let curve = published_curve(&config(extra, algo, env), metric).unwrap();
        for (millions, mean, half) in expected {
            let point = curve.mean.iter().find(|point| point.frames == millions * 1e6).unwrap();
            // Quantised to a 20,000th of the curve's height.
            assert!(
                (point.value.mean - mean).abs() < mean * 2e-3,
                "{algo} {env} {metric} {millions}: {point:?}"
            );
            assert!(
                (point.value.half_width.unwrap_or(0.0) - half).abs() < mean * 1e-3,
                "{point:?}"
            );
        }
    }
    // 5.257 - 0.9 x 3.501 at 499 million frames: corrected as the table's cell is.
    let curve =
        published_curve(&config("", "PPOCost", "ArmamentBurdenLevel1-v0"), "return").unwrap();
    assert!(
        (curve.mean.last().unwrap().value.mean - 2.106).abs() < 5e-3,
        "{:?}",
        curve.mean.last()
    );
}
