#[path = "../tests/hall/mod.rs"]
mod hall;
use hasard_engine::map::*;
use hasard_engine::math::*;
use hasard_engine::world::*;
fn main() {
    let grid = TileGrid::new((0, 64), 128, 17, 17, |c, r| hall::style(0, 250, (1 + r * 17 + c) as i32));
    let template = hall::world_of(&grid, (1088.0, 1152.0));
    let mut rng = Rng::new(std::env::args().nth(1).map_or(1, |a| a.parse().unwrap()));
    let episodes = 1500;
    let mut total = 0u32;
    let mut sq = 0u32;
    let mut path = 0.0;
    let mut dists: Vec<f64> = vec![];
    for _ in 0..episodes {
        let mut w = template.clone();
        let item = |w: &mut World, rng: &mut Rng| loop {
            let (x, y) = (rng.between(1 << 16, 2239 << 16), rng.between(1 << 16, 2239 << 16));
            if w.spawn_checked(ActorKind::ArmorBonus, Fixed(x), Fixed(y), Fixed::from_int(20), 0).is_some() {
                break;
            }
        };
        let mut n = 0;
        let mut last = (1088.0f64, 1152.0f64);
        let mut far = 0.0f64;
        let mut cmd = Command::default();
        for tic in 0..2101u32 {
            if tic >= 1 && (tic - 1) % 4 == 0 {
                let mut b = [Buttons(0), Buttons::TURN_LEFT, Buttons::TURN_RIGHT][rng.below(3) as usize];
                if rng.below(2) == 1 {
                    b |= Buttons::MOVE_FORWARD
                }
                if rng.below(2) == 1 {
                    b |= Buttons::JUMP
                }
                if rng.below(2) == 1 {
                    b |= Buttons::SPEED
                }
                cmd.buttons = b;
            }
            w.run_thinkers(&[cmd]);
            if tic == 0 {
                for t in 1..=289 {
                    if rng.below(10) < 4 || t == 145 {
                        w.floor_move_to_value(t, 100, 16)
                    }
                }
                for _ in 0..30 {
                    item(&mut w, &mut rng)
                }
            }
            if tic % 60 == 0 {
                item(&mut w, &mut rng)
            }
            if tic == 1 {
                let id = w.players[0].actor;
                while !w.set_position(
                    id,
                    Fixed(rng.between(0, 2176 << 16)),
                    Fixed(rng.between(64 << 16, 2240 << 16)),
                    Fixed::from_int(20),
                ) {}
                let a = Angle(rng.next_u64() as u32);
                w.get_mut(id).unwrap().angle = a;
                w.players[0].freeze_tics = 0;
            }
            w.finish_tic();
            if tic % 4 == 0 {
                let (x, y) = (w.actors[0].x.to_f64(), w.actors[0].y.to_f64());
                path += (x - last.0).hypot(y - last.1);
                last = (x, y);
                far = far.max((x - 1088.0).hypot(y - 1152.0));
            }
            n += w.events.iter().filter(|e| matches!(e, Event::PickedUp { .. })).count() as u32;
            w.events.clear();
        }
        total += n;
        dists.push(far);
        sq += n * n;
    }
    let m = f64::from(total) / f64::from(episodes);
    dists.sort_by(f64::total_cmp);
    println!("{:?}", [0, 375, 750, 1125, 1499].map(|i| dists[i]));
    println!(
        "mean {m:.3} std {:.3} path {:.0}",
        (f64::from(sq) / f64::from(episodes) - m * m).sqrt(),
        path / f64::from(episodes)
    );
}
