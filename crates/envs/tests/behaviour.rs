//! What the paper says of how agents behave is counted: weapons discarded, decoys taken, goggles
//! taken first, barrels pushed.

use hasard_engine::math::Fixed;
use hasard_engine::world::{ActorKind, Buttons, Command};
use hasard_envs::{Env, EnvOptions, RuleSet};

fn env(id: &str, rules: RuleSet) -> Env {
    Env::new(id, &EnvOptions { rules, ..EnvOptions::default() }).unwrap()
}

fn hold(buttons: Buttons) -> Command {
    Command { buttons, ..Command::default() }
}

fn stat(env: &Env, name: &str) -> f64 {
    env.stats()
        .into_iter()
        .find(|stat| stat.0 == name)
        .unwrap_or_else(|| panic!("no statistic {name}"))
        .1
}

/// Empties the world but for the agent, which is put to a place.
fn alone_at(env: &mut Env, x: i32, y: i32) {
    let agent = env.world().players[0].actor;
    let things: Vec<_> = env.world().living().map(|(id, _)| id).filter(|&id| id != agent).collect();
    things.into_iter().for_each(|id| env.world_mut().remove(id));
    let z = env.world().get(agent).unwrap().z;
    assert!(env.world_mut().set_position(agent, Fixed::from_int(x), Fixed::from_int(y), z));
    (0..5).for_each(|_| _ = env.step_buttons(Command::default()));
}

/// Lays something a little ahead and walks a step.
fn take(env: &mut Env, kind: ActorKind) {
    let body = *env.world().get(env.world().players[0].actor).unwrap();
    env.world_mut().spawn(
        kind,
        body.x + body.angle.cos() * Fixed::from_int(8),
        body.y + body.angle.sin() * Fixed::from_int(8),
        body.z,
    );
    env.step_buttons(hold(Buttons::MOVE_FORWARD));
}

#[test]
fn discarded_weapons_and_decoys_are_counted() {
    for rules in RuleSet::ALL {
        let mut env = env("ArmamentBurdenLevel1-v0", rules);
        env.reset(1);
        alone_at(&mut env, 400, 736);
        take(&mut env, ActorKind::Pistol);
        take(&mut env, ActorKind::Shotgun);
        take(&mut env, ActorKind::BlurSphere);
        let counts = |env: &Env| {
            ["weapons_collected", "weapons_discarded", "decoys_taken"].map(|name| stat(env, name))
        };
        assert_eq!(counts(&env), [2.0, 0.0, 1.0], "{rules}");
        env.step_buttons(hold(Buttons::USE));
        env.step_buttons(hold(Buttons::USE));
        assert_eq!(counts(&env), [2.0, 2.0, 1.0], "{rules}: empty hands discard nothing");
    }
}

#[test]
fn goggles_before_any_health_are_goggles_first() {
    use ActorKind::{HealthBonus, Infrared, Medikit, Shell};
    for (way, first) in [
        (&[][..], 0.0),
        (&[Infrared][..], 1.0),
        (&[Shell, Infrared, HealthBonus], 1.0),
        (&[HealthBonus, Infrared], 0.0),
        (&[Medikit, Infrared], 0.0),
    ] {
        let mut env = env("RemedyRushLevel2-v0", RuleSet::Paper);
        env.reset(2);
        let place = env.position();
        alone_at(&mut env, place[0], place[1]);
        way.iter().for_each(|&kind| take(&mut env, kind));
        assert_eq!(stat(&env, "goggles"), f64::from(u8::from(way.contains(&Infrared))), "{way:?}");
        assert_eq!(stat(&env, "goggles_first"), first, "{way:?}");
    }
}

#[test]
fn each_approach_to_a_barrel_is_a_push() {
    for (rules, pushes) in [(RuleSet::Paper, 1.0), (RuleSet::Released, 0.0)] {
        let mut env = env("DetonatorsDilemmaLevel2-v0", rules);
        env.reset(3);
        let place = env.position();
        alone_at(&mut env, place[0], place[1]);
        assert_eq!(stat(&env, "barrels_pushed"), 0.0);
        let body = *env.world().get(env.world().players[0].actor).unwrap();
        let barrel = env.world_mut().spawn(
            ActorKind::ExplosiveBarrel,
            body.x + Fixed::from_int(40),
            body.y,
            body.z,
        );
        env.world_mut().get_mut(barrel).unwrap().tid = 45;
        (0..10).for_each(|_| _ = env.step_buttons(Command::default()));
        assert_eq!(stat(&env, "barrels_pushed"), pushes, "{rules}");
    }
}
