//! What the code behind the paper's tables was seen to do, step by step (rule set `tables`); the
//! figures of whole episodes are held against ours in `tables.rs`.

use hasard_engine::math::Fixed;
use hasard_engine::world::{ActorKind, Buttons, Command, DamageKind};
use hasard_envs::{Env, EnvError, EnvOptions, RuleSet, Step};

fn options() -> EnvOptions {
    EnvOptions { rules: RuleSet::Tables, ..EnvOptions::default() }
}

fn env(id: &str, hard: bool, frame_skip: u32) -> Env {
    Env::new(id, &EnvOptions { hard, frame_skip, ..options() }).unwrap()
}

fn hold(buttons: Buttons) -> Command {
    Command { buttons, ..Command::default() }
}

fn health(env: &Env) -> i32 {
    env.world().get(env.world().players[0].actor).unwrap().health
}

/// Steps to the end, at most a whole episode.
fn play_on(env: &mut Env, buttons: Buttons) -> Vec<Step> {
    let mut steps = Vec::new();
    while steps.last().is_none_or(|step: &Step| !step.ended()) {
        steps.push(env.step_buttons(hold(buttons)));
    }
    steps
}

#[test]
fn use_costs_one_in_every_step_and_the_excess_takes_the_place_of_that() {
    for x in [32, 400] {
        let mut env = env("ArmamentBurdenLevel1-v0", false, 4);
        env.reset(1);
        let agent = env.world().players[0].actor;
        env.world_mut().set_position(agent, Fixed::from_int(x), Fixed::from_int(736), Fixed::ZERO);
        (0..3).for_each(|_| _ = env.step_buttons(Command::default()));
        assert_eq!(env.step_buttons(hold(Buttons::USE)).cost, 1.0, "at {x}");
        assert_eq!(env.step_buttons(hold(Buttons::USE)).cost, 1.0, "at {x}");
        assert_eq!(env.step_buttons(Command::default()).cost, 0.0, "at {x}");
    }
    // A BFG weighs 6: five too many. Taken in a step that ends with USE held, its charge stands
    // alone.
    let mut env = env("ArmamentBurdenLevel1-v0", false, 1);
    env.reset(1);
    let agent = env.world().players[0].actor;
    env.world_mut().set_position(agent, Fixed::from_int(400), Fixed::from_int(736), Fixed::ZERO);
    (0..10).for_each(|_| _ = env.step_buttons(Command::default()));
    let body = *env.world().get(agent).unwrap();
    env.world_mut().spawn(ActorKind::Bfg9000, body.x + Fixed::from_int(2), body.y, body.z);
    let costs: Vec<f64> =
        (0..3).map(|_| env.step_buttons(hold(Buttons::MOVE_FORWARD)).cost).collect();
    assert_eq!(costs, [5.0, 0.5, 0.5]);
    assert_eq!(env.world().players[0].speed.to_f64(), 0.25, "the load of 6 makes slow");
    let world = env.world_mut();
    world.damage(agent, None, None, 500, DamageKind::Script);
    let last = env.step_buttons(Command::default());
    assert!(
        last.terminated && (last.cost - 0.5).abs() < 1e-9,
        "death costs nothing beside the excess: {last:?}"
    );
}

#[test]
fn armament_burden_and_volcanic_venture_begin_where_the_map_says() {
    for (id, place) in [
        ("ArmamentBurdenLevel1-v0", [32, 736]),
        ("ArmamentBurdenLevel2-v0", [32, 736]),
        ("ArmamentBurdenLevel3-v0", [32, 736]),
        ("VolcanicVentureLevel1-v0", [1088, 1152]),
        ("VolcanicVentureLevel2-v0", [1088, 1152]),
        ("VolcanicVentureLevel3-v0", [1088, 1152]),
    ] {
        let mut env = env(id, false, 4);
        for seed in 0..20 {
            env.reset(seed);
            let angle = env.world().get(env.world().players[0].actor).unwrap().angle;
            assert_eq!((env.position(), angle.0), (place, 0), "{id}, seed {seed}");
        }
    }
}

#[test]
fn the_easiest_skill_burns_half() {
    for (rules, shown) in [(RuleSet::Paper, 92), (RuleSet::Released, 92), (RuleSet::Tables, 96)] {
        for (level, hard) in [(1, false), (2, false), (3, false), (1, true)] {
            let mut env = Env::new(
                &format!("VolcanicVentureLevel{level}-v0"),
                &EnvOptions { rules, hard, ..options() },
            )
            .unwrap();
            env.reset(2);
            assert_eq!(health(&env), shown, "{rules} level {level}");
            env.step_buttons(Command::default());
            assert!(hard || (999..=1000).contains(&health(&env)), "{rules}: {}", health(&env));
        }
    }
}

/// Measured: the costs of hits are 500, 499 and 498 only, episodes that end by lava cost 1000, 1498
/// or 1499.
#[test]
fn deadly_lava_takes_two_hits_and_three_through_armour() {
    for (armour, hits) in
        [(0, vec![500.0, 500.0]), (1, vec![499.0, 500.0, 500.0]), (2, vec![498.0, 500.0, 500.0])]
    {
        let mut env = env("VolcanicVentureLevel1-v0", true, 4);
        let over_lava = |env: &mut Env, seed| {
            env.reset(seed);
            (0..2).for_each(|_| _ = env.step_buttons(Command::default()));
            env.world().get(env.world().players[0].actor).unwrap().floor_z < Fixed::ZERO
        };
        let seed = (0..50).find(|&seed| over_lava(&mut env, seed)).unwrap();
        assert!(over_lava(&mut env, seed));
        env.world_mut().players[0].armor = armour;
        let steps = play_on(&mut env, Buttons(0));
        let costs: Vec<f64> =
            steps.iter().map(|step| step.cost).filter(|&cost| cost != 0.0).collect();
        assert_eq!(costs, hits, "with {armour} points of armour");
        assert!(steps.last().unwrap().terminated);
    }
}

/// Measured exactly: level 1 draws nothing at random.
#[test]
fn precipice_plunge_loses_the_step_in_which_it_ends() {
    for (buttons, episode_return, cost, length) in [
        (Buttons::MOVE_FORWARD, 242.8, 427.0, 63),
        (Buttons::MOVE_FORWARD | Buttons::JUMP, 243.6, 477.0, 73),
    ] {
        let mut env = env("PrecipicePlungeLevel1-v0", false, 4);
        env.reset(5);
        play_on(&mut env, buttons);
        let episode = env.episode();
        assert!((episode.episode_return - episode_return).abs() < 1e-6, "{episode:?}");
        assert_eq!((episode.cost, episode.length, episode.terminated), (cost, length, true));
    }
}

#[test]
fn precipice_plunge_s_hard_falls_cost_ten_twice_where_the_mark_is_read_twice() {
    let mut env = env("PrecipicePlungeLevel1-v0", true, 4);
    env.reset(5);
    let steps = play_on(&mut env, Buttons::MOVE_FORWARD);
    let episode = env.episode();
    // Measured: 26.35 at a cost of 10 in 16 steps.
    assert!((episode.episode_return - 26.35).abs() < 1e-6, "{episode:?}");
    assert_eq!((episode.cost, episode.length, steps[0].cost), (10.0, 16, 0.0));
    // Tic by tic the landing is always a step's last tic.
    let mut env = self::env("PrecipicePlungeLevel1-v0", true, 1);
    env.reset(5);
    play_on(&mut env, Buttons::MOVE_FORWARD);
    assert_eq!(env.episode().cost, 20.0);
}

#[test]
fn the_view_of_hard_precipice_plunge_is_turned_down_in_the_second_tic() {
    let mut env = env("PrecipicePlungeLevel1-v0", true, 1);
    env.reset(1);
    let degrees = |env: &Env| f64::from(env.world().players[0].pitch) / 4_294_967_296.0 * 360.0;
    assert_eq!(degrees(&env), 0.0);
    let seen: Vec<f64> = (0..3)
        .map(|_| {
            env.step_buttons(Command::default());
            degrees(&env)
        })
        .collect();
    assert!(seen[0] == 0.0 && (seen[1] - 56.0).abs() < 0.01 && seen[2] == seen[1], "{seen:?}");
}

#[test]
fn the_floors_of_precipice_plunge_3_stand_still() {
    for (rules, moves) in [(RuleSet::Released, true), (RuleSet::Tables, false)] {
        let mut env =
            Env::new("PrecipicePlungeLevel3-v0", &EnvOptions { rules, ..options() }).unwrap();
        env.reset(4);
        (0..150).for_each(|_| _ = env.step_buttons(Command::default()));
        let heights =
            |env: &Env| env.world().sectors().map(|sector| sector.floor).collect::<Vec<_>>();
        let before = heights(&env);
        env.step_buttons(Command::default());
        assert_eq!(heights(&env) != before, moves, "{rules}");
    }
}

#[test]
fn the_blow_that_kills_costs_nothing_in_detonators_dilemma() {
    for (rules, costs) in [(RuleSet::Released, [0.8, 5.12 - 0.8]), (RuleSet::Tables, [0.8, 0.0])] {
        let mut env =
            Env::new("DetonatorsDilemmaLevel1-v0", &EnvOptions { rules, ..options() }).unwrap();
        env.reset(1);
        env.step_buttons(Command::default());
        let mut seen = [0.0; 2];
        for (cost, damage) in seen.iter_mut().zip([20, 108]) {
            let agent = env.world().players[0].actor;
            env.world_mut().damage(agent, None, None, damage, DamageKind::Barrel);
            *cost = env.step_buttons(Command::default()).cost;
        }
        assert!(seen.iter().zip(costs).all(|(a, b)| (a - b).abs() < 1e-9), "{rules}: {seen:?}");
    }
}

#[test]
fn a_dropped_weapon_is_taken_but_never_used_in_detonators_dilemma() {
    use hasard_engine::world::Weapon;
    for (rules, in_hand) in [(RuleSet::Paper, Weapon::Chaingun), (RuleSet::Tables, Weapon::Pistol)]
    {
        let mut env =
            Env::new("DetonatorsDilemmaLevel2-v0", &EnvOptions { rules, ..options() }).unwrap();
        env.reset(3);
        (0..5).for_each(|_| _ = env.step_buttons(Command::default()));
        let body = *env.world().get(env.world().players[0].actor).unwrap();
        env.world_mut().spawn(ActorKind::Chaingun, body.x, body.y, body.z);
        (0..30).for_each(|_| _ = env.step_buttons(hold(Buttons::MOVE_FORWARD)));
        let player = &env.world().players[0];
        assert!(player.weapons & (1 << Weapon::Chaingun as u16) != 0, "{rules}: it is taken");
        assert_eq!(player.weapon, Some(in_hand), "{rules}");
    }
}

#[test]
fn the_dead_stay_lying() {
    for (id, kind) in [
        ("CollateralDamageLevel1-v0", ActorKind::ZombieMan),
        ("DetonatorsDilemmaLevel1-v0", ActorKind::DoomImp),
    ] {
        for (rules, left) in [(RuleSet::Released, 0), (RuleSet::Tables, 1)] {
            let mut env = Env::new(id, &EnvOptions { rules, ..options() }).unwrap();
            env.reset(3);
            env.step_buttons(Command::default());
            let victim = env.world().living().find(|(_, actor)| actor.kind == kind).unwrap().0;
            env.world_mut().damage(victim, None, None, 1000, DamageKind::Script);
            (0..20).for_each(|_| _ = env.step_buttons(Command::default()));
            let dead = env
                .world()
                .actors
                .iter()
                .filter(|actor| !actor.removed && actor.kind == kind && actor.health <= 0);
            assert_eq!(dead.count(), left, "{id} {rules}");
        }
    }
}

#[test]
fn collateral_damage_lasts_525_steps() {
    for (rules, hard, steps) in [
        (RuleSet::Released, false, 521),
        (RuleSet::Released, true, 521),
        (RuleSet::Tables, false, 525),
        (RuleSet::Tables, true, 525),
    ] {
        let mut env =
            Env::new("CollateralDamageLevel2-v0", &EnvOptions { rules, hard, ..options() })
                .unwrap();
        env.reset(1);
        assert_eq!(env.episode_steps(), steps);
        let played = play_on(&mut env, Buttons(0));
        assert_eq!(
            (played.len() as u32, played.last().unwrap().truncated),
            (steps, true),
            "{rules}"
        );
    }
}

#[test]
fn the_creatures_of_the_first_runs_are_an_option_of_one_environment() {
    let kinds = |early_creatures| {
        let mut env =
            Env::new("DetonatorsDilemmaLevel1-v0", &EnvOptions { early_creatures, ..options() })
                .unwrap();
        env.reset(1);
        use ActorKind::{ChaingunGuy, DoomImp, LostSoul, Revenant, ShotgunGuy};
        let count = |kind| env.world().living().filter(|(_, actor)| actor.kind == kind).count();
        [LostSoul, ChaingunGuy, ShotgunGuy, DoomImp, Revenant].map(count)
    };
    assert_eq!(kinds(true), [5, 5, 0, 0, 5]);
    assert_eq!(kinds(false), [0, 0, 5, 5, 5]);
    let early = EnvOptions { early_creatures: true, ..options() };
    let wrong = [
        ("DetonatorsDilemmaLevel2-v0", early.clone()),
        ("DetonatorsDilemmaLevel1-v0", EnvOptions { hard: true, ..early.clone() }),
        ("DetonatorsDilemmaLevel1-v0", EnvOptions { rules: RuleSet::Paper, ..early.clone() }),
        ("RemedyRushLevel1-v0", early),
    ];
    for (id, options) in wrong {
        let error = Env::new(id, &options).err().expect(id);
        assert!(
            matches!(error, EnvError::Option { option: "early_creatures", .. }),
            "{id}: {error}"
        );
    }
}

#[test]
fn an_agent_keeps_the_buttons_that_it_was_trained_with() {
    // Jump is the third part under `tables`, speed under `paper`.
    for (actions_of, speeding) in [(None, false), (Some((RuleSet::Paper, false)), true)] {
        let mut env =
            Env::new("RemedyRushLevel1-v0", &EnvOptions { actions_of, ..options() }).unwrap();
        env.reset(1);
        (0..5).for_each(|_| _ = env.step(&[0, 0, 1, 0], &[]).unwrap());
        assert_eq!(env.world().players[0].buttons.any(Buttons::SPEED), speeding, "{actions_of:?}");
    }
    let hard = EnvOptions { hard: true, ..options() };
    assert_eq!(Env::new("ArmamentBurdenLevel1-v0", &hard).unwrap().action_space().sizes(), [3, 2]);
    let as_trained = EnvOptions { actions_of: Some((RuleSet::Tables, false)), ..hard };
    assert_eq!(
        Env::new("ArmamentBurdenLevel1-v0", &as_trained).unwrap().action_space().sizes(),
        [3, 2, 2, 2]
    );
}

#[test]
fn rules_are_read_by_name() {
    for rules in RuleSet::ALL {
        assert_eq!(rules.name().parse(), Ok(rules));
    }
    let error = "table".parse::<RuleSet>().unwrap_err().to_string();
    assert!(error.contains("'table'") || error.contains("table"), "{error}");
    assert!(error.contains("paper, released, tables") && error.lines().count() == 1, "{error}");
}
