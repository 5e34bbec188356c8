use hasard_engine::math::Rng;
use hasard_envs::{Env, EnvOptions, FrameSize};
use std::time::Instant;
fn main(){
 let id=std::env::args().nth(1).unwrap(); let lanes:usize=std::env::args().nth(2).unwrap().parse().unwrap();
 let options=EnvOptions{size:FrameSize::LEARNER,..EnvOptions::default()};
 let first=Env::new(&id,&options).unwrap();
 let mut envs:Vec<Env>=(0..lanes).map(|_|first.sibling()).collect();
 (0..).zip(&mut envs).for_each(|(s,e)|e.reset(s));
 let sizes=first.action_space().sizes(); let deltas=vec![0.0;first.action_space().deltas.len()];
 let mut rng=Rng::new(1); let mut seed=100; let mut a=vec![0u8;sizes.len()];
 let mut frame=vec![0u8;128*72*3];
 let mut t=[0f64;6]; let mut n=0;
 for round in 0..(9600/lanes) { for e in envs.iter_mut(){
   for (a,&s) in a.iter_mut().zip(&sizes){*a=rng.below(s as u32) as u8;}
   if e.step(&a,&deltas).unwrap().ended(){seed+=1;e.reset(seed);}
   if round*lanes<1600 {continue}
   n+=1;
   for k in 0..6 { let reps= if k==5 {100} else {1}; let s=Instant::now(); for _ in 0..reps {e.observe(&mut frame);} t[k]+=s.elapsed().as_secs_f64()/reps as f64; }
 }}
 for x in t {print!("{:.2} ",x*1e6/n as f64);} println!();
}
