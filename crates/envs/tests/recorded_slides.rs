//! Bodies that random buttons drive along walls, crates and their corners in the published system,
//! beside ours: every bit.

use hasard_engine::math::{Angle, Fixed};
use hasard_engine::world::{Buttons, Command, World};
use hasard_envs::{Env, EnvOptions};

/// The button of each bit.
const BUTTONS: [Buttons; 10] = [
    Buttons::TURN_LEFT,
    Buttons::TURN_RIGHT,
    Buttons::MOVE_FORWARD,
    Buttons::MOVE_BACKWARD,
    Buttons::MOVE_LEFT,
    Buttons::MOVE_RIGHT,
    Buttons::JUMP,
    Buttons::SPEED,
    Buttons::CROUCH,
    Buttons::TURN180,
];

/// A body at rest in a map without its scenario's rules.
fn start(line: &str) -> World {
    let words: Vec<&str> = line.split(' ').collect();
    let env = Env::new(words[0], &EnvOptions::default()).unwrap();
    let mut world = World::new(env.world().map.clone(), 1);
    for _ in 0..20 {
        world.run_thinkers(&[]);
        world.finish_tic();
    }
    let at = |i: usize| Fixed::from_int(words[i].parse().unwrap());
    let angle = words[4].parse::<f64>().unwrap() / 360.0 * 4_294_967_296.0;
    world.place_player(0, at(1), at(2), at(3), Angle(angle.round() as u32), 0);
    world
}

#[test]
fn bodies_slide_along_walls_as_recorded() {
    let (mut episode, mut compared) = (String::new(), 0);
    let mut world = None;
    for line in
        include_str!("published_figures/slides.txt").lines().filter(|line| !line.starts_with('#'))
    {
        if let Some(recorded) = line.strip_prefix("= ") {
            let recorded: Vec<i32> =
                recorded.split(' ').map(|word| word.parse().unwrap()).collect();
            let world: &World = world.as_ref().unwrap();
            let body = &world.actors[usize::from(world.players[0].actor.slot)];
            let ours = [body.x, body.y, body.z, body.vx, body.vy, body.vz].map(|part| part.0);
            assert_eq!(ours[..], recorded, "{episode}, after {} tics", world.tic - 20);
            compared += 1;
        } else if line.contains('*') {
            for run in line.split_whitespace() {
                let (count, mask) = run.split_once('*').unwrap();
                let mask: u32 = mask.parse().unwrap();
                let mut buttons = Buttons::default();
                BUTTONS
                    .iter()
                    .enumerate()
                    .filter(|(bit, _)| mask >> bit & 1 == 1)
                    .for_each(|(_, button)| buttons |= *button);
                for _ in 0..count.parse().unwrap() {
                    let world = world.as_mut().unwrap();
                    world.run_thinkers(&[Command { buttons, ..Command::default() }]);
                    world.finish_tic();
                }
            }
        } else {
            world = Some(start(line));
            episode = line.to_string();
        }
    }
    assert_eq!(compared, 48);
}
