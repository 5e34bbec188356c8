//! The pictures of the status bar.

use crate::assets::Assets;
use crate::map::TextureName;
use crate::render::textures::masked::MaskedTexture;
use crate::world::Face;

/// The pictures of the bar; what a set lacks is not drawn.
#[derive(Clone, Debug)]
pub(crate) struct BarArt {
    pub bar: Option<MaskedTexture>,
    pub arms: Option<MaskedTexture>,
    pub big_digits: [Option<MaskedTexture>; 10],
    pub percent: Option<MaskedTexture>,
    pub grey_digits: [Option<MaskedTexture>; 10],
    pub yellow_digits: [Option<MaskedTexture>; 10],
    /// By band of health: three glances, outcry, grin, rage.
    pub sidedefs: [[Option<MaskedTexture>; 6]; FACE_BANDS],
    pub dead_face: Option<MaskedTexture>,
    /// Blue, yellow and red cards, then skulls.
    pub keys: [Option<MaskedTexture>; 6],
}

/// Bands of health that the face distinguishes.
pub(crate) const FACE_BANDS: usize = 5;

impl BarArt {
    pub fn new(assets: &Assets) -> BarArt {
        let find = |name: String| {
            let index = *assets.graphics.get(&TextureName::new(&name))?;
            Some(MaskedTexture::new(assets.images.get(index as usize)?))
        };
        let digits = |prefix: &str| std::array::from_fn(|digit| find(format!("{prefix}{digit}")));
        BarArt {
            bar: find("STBAR".into()),
            arms: find("STARMS".into()),
            big_digits: digits("STTNUM"),
            percent: find("STTPRCNT".into()),
            grey_digits: digits("STGNUM"),
            yellow_digits: digits("STYSNUM"),
            sidedefs: std::array::from_fn(|band| {
                std::array::from_fn(|mood| {
                    find(match mood {
                        0..=2 => format!("STFST{band}{mood}"),
                        3 => format!("STFOUCH{band}"),
                        4 => format!("STFEVL{band}"),
                        _ => format!("STFKILL{band}"),
                    })
                })
            }),
            dead_face: find("STFDEAD0".into()),
            keys: std::array::from_fn(|i| find(format!("STKEYS{i}"))),
        }
    }

    pub fn face(&self, face: Face, band: usize) -> Option<&MaskedTexture> {
        let moods = &self.sidedefs[band.min(FACE_BANDS - 1)];
        match face {
            Face::Glance(direction) => moods[usize::from(direction.min(2))].as_ref(),
            Face::Ouch => moods[3].as_ref(),
            Face::Grin => moods[4].as_ref(),
            Face::Rage => moods[5].as_ref(),
            Face::Dead => self.dead_face.as_ref(),
        }
    }
}
