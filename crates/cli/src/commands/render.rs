//! `hasard render`: a moment of an episode as PNG.

use crate::actor::Performance;
use crate::args::{RenderArgs, Size, View};
use crate::commands::record::is_png;
use crate::failure::{Failure, Outcome};
use crate::places::absent_folder;
use crate::settings;
use hasard_engine::render::InView;
use hasard_play::Views;
use serde_json::{Value, json};

/// Runs the command.
pub fn run(args: &RenderArgs) -> Outcome {
    is_png(&args.out)?;
    let looks = settings::looking(
        settings::env_options(&args.env_args, Size { width: 640, height: 480 })?,
        &args.looks,
    );
    let mut performance =
        Performance::new(&args.env, &args.policy, &looks, args.env_args.elsewhere(), args.seed)?;
    let mut steps = 0;
    while steps < args.step {
        let Some(step) = performance.tic(None)? else { continue };
        steps += 1;
        if step.ended() && steps < args.step {
            return Err(Failure::bad(format!(
                "--step {}: the episode ends at step {steps}; give a smaller one",
                args.step
            )));
        }
    }
    let stage = &performance.stage;
    let mut views = Views::new(stage, looks.size, &settings::views(args.buffer, &args.beside))
        .map_err(Failure::bad)?;
    let picture = views.draw(stage);
    let made = absent_folder(&args.out);
    hasard_media::png::write(&picture, &args.out).map_err(Failure::bad)?;
    if args.json {
        let labelled = [args.buffer]
            .iter()
            .chain(&args.beside)
            .any(|view| matches!(view, View::Labels | View::Segmented));
        let labels = if labelled { labels(&views) } else { Value::Null };
        let file = args.out.display().to_string();
        say!(
            "{}",
            json!({ "file": file, "width": picture.width(), "height": picture.height(), "labels": labels })
        );
    } else {
        say!("{}: {}x{}", args.out.display(), picture.width(), picture.height());
        if let Some(folder) = made {
            say!("made the folder {}", folder.display());
        }
    }
    Ok(())
}

/// The things in view, far to near: what each is, its value in the picture of labels, its pixels
/// and the box around them.
fn labels(views: &Views) -> Value {
    let thing = |InView { label, value, pixels }: InView| {
        json!({
            "name": format!("{:?}", label.kind),
            "value": value,
            "x": label.x,
            "y": label.y,
            "width": label.width,
            "height": label.height,
            "pixels": pixels,
        })
    };
    views.renderer().in_view().into_iter().map(thing).collect()
}
