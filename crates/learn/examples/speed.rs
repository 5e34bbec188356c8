use hasard_learn::cpu::network::{CpuActor, CpuLearner};
use hasard_learn::cpu::product::*;
use hasard_learn::model::*;
use std::time::Instant;
fn main() {
    let threads: usize = std::env::args().nth(1).map_or(2, |a| a.parse().unwrap());
    let shape = NetworkShape { heads: vec![9, 1, 1], ..NetworkShape::default() };
    let parameters = shape.initial_parameters(Initialisation::OrthogonalHeads, 1, 0);
    let pixels = PixelScale::unit(shape.image.size());
    let n = 1024usize;
    let (a, b) = (vec![0.5f32; n * n], vec![0.25f32; n * n]);
    for _ in 0..3 {
    let t = Instant::now();
    let reps = 20;
    std::thread::scope(|s| for _ in 0..threads { s.spawn(|| { let mut c = vec![0.0; n*n]; for _ in 0..reps { multiply(Size { rows: n, columns: n, inner: n }, Left { data: &a, row_stride: n, inner_stride: 1 }, Right::panels(&b, n), &mut c, n, false) } }); });
    let rate = (threads * reps) as f64 * 2.0 * (n*n*n) as f64 / t.elapsed().as_secs_f64();
    let mut learner = CpuLearner::new(&shape, threads);
    let t = Instant::now();
    learner.load(&parameters, &pixels);
    let first = t.elapsed();
    let t = Instant::now();
    learner.load(&parameters, &pixels);
    println!("load {first:?} {:?}", t.elapsed());
    let obs: Vec<u8> = (0..shape.image.size() * 1024).map(|i| (i * 7919 >> 3) as u8).collect();
    let batch = Sequences { steps: 32, lanes: 32, observations: obs.chunks_exact(shape.image.size()).collect(), extra: vec![], initial_state: vec![0.0; 32*512], reset: vec![false; 1024] };
    let mut g = vec![0.0; parameters.len()];
    let dout = vec![1e-3; 1024 * shape.outputs()];
    learner.forward(&batch); learner.backward(&batch, &dout, &mut g);
    let t = Instant::now();
    learner.forward(&batch);
    let f = t.elapsed().as_secs_f64();
    let t = Instant::now();
    learner.backward(&batch, &dout, &mut g);
    let bk = t.elapsed().as_secs_f64();
    println!("rate {:.1} GFLOP/s; forward {:.1} ms ({:.0} %), backward {:.1} ms ({:.0} %)", rate/1e9, f*1e3, 100.0*1024.0*shape.forward_flop()/rate/f, bk*1e3, 100.0*1024.0*(shape.training_flop()-shape.forward_flop())/rate/bk);
    for lanes in [8usize, 16, 32] {
        let t = std::thread::scope(|s| {
            let hs: Vec<_> = (0..threads).map(|_| s.spawn(|| {
        let mut actor = CpuActor::new(&shape);
        actor.load(&parameters, &pixels);
        let mut state = vec![0.0; lanes * 512];
        let mut out = vec![0.0; lanes * shape.outputs()];
        let o = &obs[..lanes * shape.image.size()];
        actor.act(o, &[], &mut state, &mut out);
        let t = Instant::now();
        for _ in 0..20 { actor.act(o, &[], &mut state, &mut out); }
        t.elapsed().as_secs_f64() / 20.0
            })).collect();
            hs.into_iter().map(|h| h.join().unwrap()).fold(0.0, f64::max)
        });
        println!("act {lanes}: {:.2} ms ({:.0} %)", t*1e3, 100.0 * (lanes * threads) as f64 * shape.forward_flop() / rate / t);
    }
    }
}
