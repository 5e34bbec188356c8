//! One colour per class, for observations that show what things are rather than how they look.

use super::frame::class;
use crate::world::ActorKind;

/// Number of classes that are no actors: wall, floor, ceiling, sky, status bar, weapon.
const SURFACES: usize = 6;

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
    /// No two classes alike.
    #[must_use]
    pub fn distinct() -> SegmentationColours {
        let surfaces = [[0, 0, 0], [60, 60, 60], [128, 128, 128], [150, 200, 255], [30, 30, 80], [255, 255, 255]];
        let mut actors = [[0; 3]; ActorKind::COUNT];
        for (i, colour) in actors.iter_mut().enumerate() {
            // A walk through a 5 x 5 x 5 cube of colours that comes by each once and makes neighbours unlike.
            let at = (i * 37 + 12) % 125;
            *colour = [at / 25, at / 5 % 5, at % 5].map(|level| 20 + 55 * level as u8);
        }
        SegmentationColours { surfaces, actors }
    }

    /// The published colours, several of which are alike: walls, floors, sky and status bar are black together.
    #[must_use]
    pub fn published() -> SegmentationColours {
        let mut actors = [[200; 3]; ActorKind::COUNT];
        for kind in ActorKind::all() {
            actors[kind as usize] = published(kind);
        }
        let [dark, ceiling, own] = [[0; 3], [128; 3], [255; 3]];
        SegmentationColours { surfaces: [dark, dark, ceiling, dark, dark, own], actors }
    }

    /// The colour of a surface class, see [`class`].
    pub(super) fn surface(&self, class: u16) -> [u8; 3] {
        self.surfaces.get(usize::from(class)).copied().unwrap_or(self.surfaces[usize::from(class::WALL)])
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
        let mut seen = std::collections::BTreeSet::new();
        assert!(colours.surfaces.iter().chain(&colours.actors).all(|&colour| seen.insert(colour)));
        assert_eq!(seen.len(), SURFACES + ActorKind::COUNT);
    }
}
