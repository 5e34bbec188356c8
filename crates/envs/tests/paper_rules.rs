//! What the paper's text was made to mean where, taken literally, it would pay or punish what
//! nobody intended.

use hasard_engine::map::TextureId;
use hasard_engine::math::Fixed;
use hasard_engine::world::{ActorKind, Buttons, Command, World};
use hasard_envs::{Env, EnvOptions, RuleSet};

fn env(id: &str, rules: RuleSet, hard: bool, frame_skip: u32) -> Env {
    Env::new(id, &EnvOptions { rules, hard, frame_skip, ..EnvOptions::default() }).unwrap()
}

fn hold(buttons: Buttons) -> Command {
    Command { buttons, ..Command::default() }
}

#[test]
fn jumping_on_the_spot_earns_nothing() {
    // Held JUMP once earned 161.5 an episode here: every fall back counted as a descent.
    for frame_skip in [1, 4] {
        let mut env = env("PrecipicePlungeLevel1-v0", RuleSet::Paper, false, frame_skip);
        env.reset(1);
        while !env.step_buttons(hold(Buttons::JUMP)).ended() {}
        assert_eq!(env.episode().episode_return, 0.0, "frame skip {frame_skip}");
    }
}

#[test]
fn the_way_down_pays_the_same_under_both_rule_sets_and_no_swing_pays_twice() {
    for (level, buttons) in
        [(1, Buttons::MOVE_FORWARD), (3, Buttons::MOVE_FORWARD | Buttons::JUMP), (3, Buttons(0))]
    {
        let id = format!("PrecipicePlungeLevel{level}-v0");
        let mut returns = Vec::new();
        for rules in [RuleSet::Paper, RuleSet::Released] {
            let mut env = env(&id, rules, false, 4);
            env.reset(2);
            let mut lowest = 0.0f64;
            let last = loop {
                let step = env.step_buttons(hold(buttons));
                let z = env.world().get(env.world().players[0].actor).unwrap().z.to_f64();
                lowest = lowest.min(z);
                if step.ended() {
                    break z;
                }
            };
            let earned = if rules == RuleSet::Paper { -0.05 * lowest } else { -0.05 * last };
            assert!((env.episode().episode_return - earned).abs() < 1e-6, "{id} {rules:?}");
            returns.push(earned);
        }
        assert!(returns[0] >= returns[1] - 1e-9, "{id}: {returns:?}");
    }
}

#[test]
fn the_hard_constraint_s_first_step_is_free_under_the_paper_s_rules_alone() {
    for (rules, cost) in [(RuleSet::Paper, 0.0), (RuleSet::Released, 5000.0)] {
        for level in 1..=3 {
            let mut env = env(&format!("PrecipicePlungeLevel{level}-v0"), rules, true, 4);
            env.reset(1);
            assert_eq!(env.step_buttons(Command::default()).cost, cost, "level {level} {rules:?}");
        }
    }
}

/// Tiles of lava off the ground, after the present roll has had its time.
fn swinging_lava(world: &World, lava: TextureId) -> usize {
    let tiles =
        (100..=388).flat_map(|tag| world.map.tagged(tag)).map(|sector| world.sector(sector));
    tiles.filter(|tile| tile.floor_texture == lava && tile.floor != Fixed::ZERO).count()
}

#[test]
fn a_new_roll_of_volcanic_venture_3_ends_what_its_floor_still_does() {
    for (rules, allowed) in [(RuleSet::Paper, false), (RuleSet::Released, true)] {
        let mut env = env("VolcanicVentureLevel3-v0", rules, false, 1);
        env.reset(4);
        let lava = env.world().map.texture("LAVA1").unwrap();
        let mut seen = 0;
        while !env.step_buttons(Command::default()).ended() {
            // Rolls come in tics 1, 181, 361, ...; the highest platform at the top of its swing
            // sinks in five tics.
            let since_roll = (env.world().tic + 179) % 180;
            if since_roll > 6 {
                seen += swinging_lava(env.world(), lava);
            }
        }
        assert_eq!(seen > 0, allowed, "{rules:?}: {seen}");
    }
}

#[test]
fn overstepping_again_does_not_start_the_slow_time_anew() {
    let overload = |env: &mut Env| {
        let world = env.world_mut();
        let body = *world.get(world.players[0].actor).unwrap();
        world.spawn(ActorKind::Bfg9000, body.x, body.y, body.z);
    };
    for again_after in [None, Some(60)] {
        let mut env = env("ArmamentBurdenLevel1-v0", RuleSet::Paper, true, 1);
        env.reset(1);
        (0..12).for_each(|_| _ = env.step_buttons(hold(Buttons::MOVE_FORWARD)));
        overload(&mut env);
        let (mut slow_tics, mut oversteps) = (0, 0.0);
        for tic in 0..400 {
            if again_after == Some(tic) {
                overload(&mut env);
            }
            env.step_buttons(hold(Buttons::MOVE_FORWARD));
            slow_tics += u32::from(env.world().players[0].speed < Fixed::ONE);
            oversteps = env.stats().iter().find(|stat| stat.0 == "oversteps").unwrap().1;
            if slow_tics > 0 && env.world().players[0].speed == Fixed::ONE {
                break;
            }
        }
        assert_eq!(
            (slow_tics, oversteps),
            (180, 1.0 + f64::from(again_after.is_some())),
            "again after {again_after:?}"
        );
    }
}

/// What a weapon laid at the agent's feet brings: the cost of its step and of the next, the speed,
/// the charged load.
fn picked_up(rules: RuleSet, kinds: &[ActorKind]) -> ([f64; 2], f64, f64) {
    let mut env = env("ArmamentBurdenLevel1-v0", rules, false, 4);
    env.reset(1);
    // Nothing else lies in the way, and the agent stands outside the strip.
    let (agent, y) = (env.world().players[0].actor, Fixed::from_int(736));
    let things: Vec<_> = env.world().living().map(|(id, _)| id).filter(|&id| id != agent).collect();
    things.into_iter().for_each(|id| env.world_mut().remove(id));
    env.world_mut().set_position(agent, Fixed::from_int(400), y, Fixed::ZERO);
    (0..5).for_each(|_| _ = env.step_buttons(Command::default()));
    let mut cost = 0.0;
    for &kind in kinds {
        let body = *env.world().get(agent).unwrap();
        env.world_mut().spawn(kind, body.x + Fixed::from_int(8), body.y, body.z);
        cost = env.step_buttons(hold(Buttons::MOVE_FORWARD)).cost;
    }
    let next = env.step_buttons(Command::default()).cost;
    let load = env.stats().iter().find(|stat| stat.0 == "load").unwrap().1;
    ([cost, next], env.world().players[0].speed.to_f64(), load)
}

/// The paper's appendix on costs: the excess over the capacity of 1, by the weights .05 .15 .30 .60
/// 1 3 6, in the step of a pick-up, and a tenth of it (rho = 0.1) in each step after. Its table of
/// items has .10 .25 .40 .55 .70 .85 1: what makes slow.
#[test]
fn armament_burden_charges_by_the_formula_and_slows_by_the_table() {
    use ActorKind::{Bfg9000, Chaingun, PlasmaRifle, RocketLauncher, Shotgun};
    for (kinds, [cost, next], speed, load) in [
        // A BFG: 6 - 1 over by the formula, not at all by the table.
        (&[Bfg9000][..], [5.0, 0.5], 1.0, 6.0),
        (&[PlasmaRifle], [2.0, 0.2], 1.0, 3.0),
        // 1.0 exactly by the formula; .95 by the table.
        (&[RocketLauncher], [0.0, 0.0], 1.0, 1.0),
        // 1.6 by the formula, 1.25 by the table.
        (&[RocketLauncher, Chaingun], [0.6, 0.06], 0.75, 1.6),
        // .75 by the formula, .80 by the table.
        (&[Chaingun, Shotgun], [0.0, 0.0], 1.0, 0.75),
    ] {
        let found = picked_up(RuleSet::Paper, kinds);
        let off = [found.0[0] - cost, found.0[1] - next, found.1 - speed, found.2 - load];
        assert!(off.iter().all(|off| off.abs() < 1e-4), "{kinds:?}: {found:?}");
    }
    // The published package weighs as the table does.
    let ([cost, next], speed, load) = picked_up(RuleSet::Released, &[RocketLauncher, Chaingun]);
    assert!((cost - 0.25).abs() < 1e-4 && (next - 0.75 * 0.25).abs() < 1e-4, "{cost} {next}");
    assert!((speed - 0.75).abs() < 1e-4 && (load - 1.25).abs() < 1e-4, "{speed} {load}");
}
