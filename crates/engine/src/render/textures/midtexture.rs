//! A texture with holes in an opening: where its posts are, its runs of texels without holes.

use crate::assets::Image;
use crate::render::textures::masked::MaskedTexture;

/// A run of texels without holes of a column: the first, and the one past the last.
pub(crate) type Post = [u16; 2];

/// A picture with the runs of its columns.
#[derive(Clone, Debug)]
pub(crate) struct Midtexture {
    pub picture: MaskedTexture,
    /// Last of the columns whose runs are kept: the first where there is no hole, as in most
    /// pictures of walls.
    last_runs: u32,
    /// Where the runs of each of them begin in the list, and where the last one's end.
    begins: Vec<u32>,
    /// Column by column from top to bottom.
    runs: Vec<Post>,
}

impl Midtexture {
    pub fn new(image: &Image) -> Midtexture {
        let picture = MaskedTexture::new(image);
        let has_holes = picture.texels.iter().any(|texel| texel & MaskedTexture::OPAQUE == 0);
        let kept = if has_holes { picture.width } else { 1 };
        let (mut begins, mut runs) = (vec![0], Vec::new());
        for column in picture.texels.chunks(picture.height as usize).take(kept as usize) {
            runs.extend(posts_of(column.iter().map(is_opaque)));
            begins.push(runs.len() as u32);
        }
        Midtexture { picture, last_runs: kept.saturating_sub(1), begins, runs }
    }

    /// The texels of a column and their runs.
    #[inline]
    pub fn column(&self, column: u32) -> (&[u16], &[Post]) {
        let kept = column.min(self.last_runs) as usize;
        (
            self.picture.column(column),
            &self.runs[self.begins[kept] as usize..self.begins[kept + 1] as usize],
        )
    }
}

/// Whether a texel is no hole.
pub(crate) fn is_opaque(texel: &u16) -> bool {
    texel & MaskedTexture::OPAQUE != 0
}

/// The runs of a column of which it is known what is no hole, from top to bottom.
pub(crate) fn posts_of(shown: impl Iterator<Item = bool>) -> impl Iterator<Item = Post> {
    let mut texels = (0..).zip(shown.chain([false]));
    std::iter::from_fn(move || {
        let (start, _) = texels.find(|&(_, is_shown)| is_shown)?;
        let (end, _) = texels.find(|&(_, is_shown)| !is_shown)?;
        Some([start, end])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_end_at_holes() {
        let runs = |texels: &[u16]| posts_of(texels.iter().map(is_opaque)).collect::<Vec<Post>>();
        assert_eq!(runs(&[1, 0x101, 0x102, 2, 0x103]), [[1, 3], [4, 5]]);
        assert_eq!(
            (runs(&[0x100, 0x1FF]), runs(&[7, 8]), runs(&[])),
            (vec![[0, 2]], vec![], vec![])
        );
    }

    #[test]
    fn a_picture_without_holes_keeps_the_runs_of_one_column() {
        let image = |mask: Option<[u8; 6]>| {
            let mask = mask.map(|mask| mask.into());
            Midtexture::new(&Image {
                width: 3,
                height: 2,
                offset_x: 0,
                offset_y: 0,
                pixels: [1, 2, 3, 4, 5, 6].into(),
                mask,
            })
        };
        let shown = |fence: &Midtexture| {
            [0, 1, 2].map(|column| {
                let (texels, runs) = fence.column(column);
                ([texels[0] as u8, texels[1] as u8], runs.to_vec())
            })
        };
        let whole = [([1, 2], vec![[0, 2]]), ([3, 4], vec![[0, 2]]), ([5, 6], vec![[0, 2]])];
        assert_eq!((shown(&image(None)), image(None).runs.len()), (whole, 1));
        let holes = [([1, 2], vec![[0, 2]]), ([3, 4], vec![[1, 2]]), ([5, 6], vec![[0, 2]])];
        let masked = image(Some([1, 1, 0, 1, 1, 1]));
        assert_eq!((shown(&masked), masked.runs.len()), (holes, 3));
    }
}
