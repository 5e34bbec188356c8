//! `hasard render`: a moment of an episode as PNG.

use crate::args::{Buffer, RenderArgs, Size};
use crate::failure::{Failure, Outcome};
use crate::settings;
use hasard_engine::render::{Buffers, SegmentationColours};
use hasard_envs::{Env, Move, Policy, PolicyRun};
use hasard_media::Picture;

/// Runs the command.
pub fn run(args: &RenderArgs) -> Outcome {
    let options = settings::env_options(&args.env_args, Size { width: 640, height: 480 })?;
    let policy: Policy = args.policy.parse().map_err(Failure::bad)?;
    let mut env = Env::new(&args.env, &options).map_err(Failure::bad)?;
    env.reset(args.seed);
    let mut policy = PolicyRun::new(policy, env.action_space(), args.seed);
    for step in 0..args.step {
        let outcome = match policy.next_move() {
            Move::Action(actions, deltas) => env.step(actions, deltas),
            Move::Buttons(command) => env.step_buttons(command),
        };
        if outcome.ended() && step + 1 < args.step {
            return Err(Failure::bad(format!("--step {}: the episode ends at step {}; give a smaller one", args.step, step + 1)));
        }
    }
    let picture = picture(&mut env, args.buffer)?;
    hasard_media::png::write(&picture, &args.out).map_err(Failure::bad)?;
    say!("{}: {}x{}", args.out.display(), picture.width(), picture.height());
    Ok(())
}

/// A buffer of the present moment, as colours.
pub fn picture(env: &mut Env, buffer: Buffer) -> Result<Picture, Failure> {
    let size = env.options().size;
    let (width, height) = (usize::from(size.width), usize::from(size.height));
    let buffers = Buffers { depth: buffer == Buffer::Depth, labels: buffer == Buffer::Segmented };
    let colours =
        if env.options().published_colours { SegmentationColours::published() } else { SegmentationColours::distinct() };
    let renderer = env.render(buffers);
    let mut rgb = vec![0; width * height * 3];
    match buffer {
        Buffer::Rgb => renderer.write_rgb_hwc(&mut rgb),
        Buffer::Segmented => renderer.write_segmented_hwc(&colours, &mut rgb),
        Buffer::Depth => return Picture::from_grey(width, height, renderer.depth()).map_err(Failure::bad),
    }
    Picture::from_rgb(width, height, rgb).map_err(Failure::bad)
}
