//! Borders of what is drawn, as they were seen in ViZDoom (docs/results/pixels.md).

use super::*;
use crate::map::{Map, MapBuilder, Mark, Style};
use crate::math::{Angle, Fixed};
use crate::render::render_tests::{STYLE, assets};
use crate::world::World;
use std::sync::Arc;

const YARD: Style = Style { ceiling: 300, ceiling_texture: "F_SKY1", ..STYLE };

/// A world of what is built and one who surfaces east from (0, 0) at a height, and a renderer for
/// 160x120.
fn stand(builder: MapBuilder, view_z: i32) -> (World, Renderer, Arc<Scene>) {
    let map = Arc::new(Map::build(&builder.finish().unwrap(), "yard", &[]).unwrap());
    let scene = Arc::new(Scene::new(&map, assets()));
    let mut world = World::new(map, 1);
    world.add_player(Fixed::ZERO, Fixed::ZERO, Angle::EAST);
    world.players[0].view_z = Fixed::from_int(view_z);
    let renderer = Renderer::new(scene.clone(), Arc::new(View::new(FrameSize::CLASSIC).unwrap()));
    (world, renderer, scene)
}

/// Base row and column of the middle of the view, just below the horizon.
const MIDDLE: [usize; 2] = [50, 80];

#[test]
fn the_sky_above_a_far_lower_neighbour_leaves_the_floor() {
    let mut scratch = FrameScratch::default();
    let mut builder = MapBuilder::new();
    builder.rectangle(YARD, -64, -512, 256, 512);
    builder.rectangle(Style { floor: -8000, ceiling: -8000, ..YARD }, 256, -512, 512, 512);
    let (world, mut renderer, _) = stand(builder, 41);
    renderer.render(&mut scratch, &world, 0, Buffers { depth: false, labels: true });
    let class_at = |row: usize| renderer.classes()[row * 160 + MIDDLE[1]];
    assert_eq!((class_at(MIDDLE[0] - 10), class_at(99)), (class::SKY, class::FLOOR));
}

#[test]
fn runs_of_a_fence_that_begin_at_the_eye_s_height_show_only_below_it() {
    let mut scratch = FrameScratch::default();
    let mut builder = MapBuilder::new();
    builder.rectangle(YARD, -64, -512, 512, 512);
    builder.rectangle(Style { floor: 8, ..YARD }, 128, -256, 256, 256);
    builder.mark(
        Mark { middle: Some("MIDSPACE"), lower_unpegged: true, ..Mark::default() },
        &[(128, -256), (128, 256)],
    );
    let (mut world, mut renderer, _) = stand(builder, 0);
    // Which columns show the fence, 128 units away, in the row just above the horizon.
    let mut shown = |view_z: Fixed| {
        world.players[0].view_z = view_z;
        renderer.render(&mut scratch, &world, 0, Buffers { depth: true, labels: false });
        let row = &renderer.depth()[(MIDDLE[0] - 1) * 160..][..160];
        row.iter().map(|&depth| depth < 20).collect::<Vec<bool>>()
    };
    let mut begin = 0;
    for height in 10..130 {
        let height = Fixed::from_int(height);
        let [level, above, below] = [height, height + Fixed(1), height - Fixed(1)].map(&mut shown);
        for column in 0..160 {
            // From above the texel over the eye's height is seen there, from below the one under
            // it.
            assert_eq!(
                level[column],
                above[column] && below[column],
                "column {column}, {height:?}"
            );
            begin += usize::from(below[column] && !above[column]);
        }
    }
    assert!(begin > 100, "{begin}");
}
