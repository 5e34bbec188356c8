//! One colour per class, for observations that show what things are rather than how they look.

use crate::render::buffers::frame::class;
use crate::world::ActorKind;

/// Number of classes that are no actors: wall, floor, ceiling, sky, status bar, weapon, other
/// floors, other ceilings.
const SURFACES: usize = 8;

/// Colours that differ by no more than this in every channel are easily taken for each other.
const NEARLY_ALIKE: u8 = 30;

/// The largest difference of two colours in a channel.
fn difference(a: [u8; 3], b: [u8; 3]) -> u8 {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

/// A colour for each class.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SegmentationColours {
    surfaces: [[u8; 3]; SURFACES],
    actors: [[u8; 3]; ActorKind::COUNT],
}

impl Default for SegmentationColours {
    fn default() -> SegmentationColours {
        SegmentationColours::distinct()
    }
}

impl SegmentationColours {
    /// No two classes alike, nor nearly so: some channel differs by more than `NEARLY_ALIKE`.
    #[must_use]
    pub fn distinct() -> SegmentationColours {
        let (floor, ceiling) = ([60, 60, 60], [128, 128, 128]);
        let surfaces = [
            [0, 0, 0],
            floor,
            ceiling,
            [150, 200, 255],
            [20, 30, 100],
            [255, 255, 255],
            floor,
            ceiling,
        ];
        // A walk through a 5 x 5 x 5 cube of colours that comes by each once; its stride and start
        // are those of all that leave the classes of a scenario farthest apart. What is dark, as
        // walls and floors are, or nearly the colour of a surface is passed over.
        let walk = (0..125).map(|i| (i * 123 + 124) % 125);
        let cube = walk.map(|at| [at / 25, at / 5 % 5, at % 5].map(|level| 20 + 55 * level as u8));
        let bright = cube.filter(|colour| colour.iter().any(|&channel| channel > 128));
        let mut free = bright.filter(|&colour| {
            surfaces.iter().all(|&surface| difference(surface, colour) > NEARLY_ALIKE)
        });
        let actors = std::array::from_fn(|_| {
            free.next().expect("the cube has more colours than there are kinds")
        });
        SegmentationColours { surfaces, actors }
    }

    /// The published colours, several of which are alike: floors and ceilings with a picture of 64
    /// by 64 texels are grey together, all other surfaces black.
    #[must_use]
    pub fn published() -> SegmentationColours {
        let mut actors = [[200; 3]; ActorKind::COUNT];
        for kind in ActorKind::all() {
            actors[kind as usize] = published(kind);
        }
        let [dark, plane, own] = [[0; 3], [128; 3], [255; 3]];
        SegmentationColours { surfaces: [dark, plane, plane, dark, dark, own, dark, dark], actors }
    }

    /// The colour of a surface class, see [`class`].
    pub(crate) fn surface(&self, class: u16) -> [u8; 3] {
        self.surfaces
            .get(usize::from(class))
            .copied()
            .unwrap_or(self.surfaces[usize::from(class::WALL)])
    }

    /// The colour of a kind of actor.
    #[must_use]
    pub fn actor(&self, kind: ActorKind) -> [u8; 3] {
        self.actors[kind as usize]
    }
}

fn published(kind: ActorKind) -> [u8; 3] {
    use ActorKind as K;
    match kind {
        K::Player | K::LostSoul => [255, 255, 255],
        K::Pistol => [64, 64, 64],
        K::Shotgun | K::DoomImp => [139, 69, 19],
        K::SuperShotgun => [160, 82, 45],
        K::Chaingun => [0, 0, 128],
        K::RocketLauncher | K::RocketAmmo => [128, 0, 0],
        K::PlasmaRifle => [0, 128, 128],
        K::Bfg9000 => [0, 255, 255],
        K::ArmorBonus | K::HealthBonus => [0, 255, 0],
        K::BlurSphere => [255, 0, 255],
        K::Allmap | K::Shell => [255, 255, 0],
        K::Backpack => [153, 102, 51],
        K::RadSuit => [0, 102, 102],
        K::Infrared => [255, 165, 0],
        K::Cacodemon | K::ExplosiveBarrel | K::Medikit => [255, 0, 0],
        K::ZombieMan | K::Stalagtite | K::RocketSmokeTrail => [128, 128, 128],
        K::ShotgunGuy => [64, 0, 64],
        K::ChaingunGuy => [0, 64, 128],
        K::Demon => [255, 105, 180],
        K::Revenant => [210, 180, 140],
        K::Stimpack => [192, 0, 0],
        K::Cell => [0, 0, 255],
        K::TorchTree => [0, 255, 150],
        K::BigTree => [0, 200, 100],
        K::Gibs => [100, 200, 150],
        K::BrainStem => [100, 0, 200],
        K::HeartColumn => [200, 0, 50],
        K::TechPillar => [150, 150, 255],
        K::ShortRedColumn => [255, 50, 50],
        K::ShortGreenColumn => [50, 255, 50],
        K::Rocket => [200, 0, 0],
        K::BulletPuff => [220, 220, 220],
        K::Blood => [150, 0, 0],
        K::GibbedMarine => [180, 50, 50],
        K::TechLamp => [100, 100, 255],
        K::SmallBloodPool => [80, 0, 0],
        _ => [200, 200, 200],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distinct_colours_are_distinct() {
        let colours = SegmentationColours::distinct();
        // The last two surfaces share the colours of the floor and the ceiling.
        let all: Vec<[u8; 3]> =
            colours.surfaces[..SURFACES - 2].iter().chain(&colours.actors).copied().collect();
        assert_eq!(all.len(), SURFACES - 2 + ActorKind::COUNT);
        for (i, &colour) in all.iter().enumerate() {
            assert!(
                all[..i].iter().all(|&other| difference(colour, other) > NEARLY_ALIKE),
                "{colour:?}"
            );
        }
    }
}
