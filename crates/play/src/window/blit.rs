//! A picture in the pixels of a window.

use hasard_media::Picture;

/// Draws the picture as large as fits, in whole multiples where the window is large enough, black
/// around it.
pub(super) fn show(picture: &Picture, buffer: &mut [u32], (width, height): (usize, usize)) {
    let by_width = width * 1024 / picture.width();
    let mut scale = by_width.min(height * 1024 / picture.height()).max(1);
    if scale >= 1024 {
        scale -= scale % 1024;
    }
    let (shown_width, shown_height) =
        (picture.width() * scale / 1024, picture.height() * scale / 1024);
    let (left, top) = ((width - shown_width) / 2, (height - shown_height) / 2);
    buffer.fill(0);
    for y in 0..shown_height {
        let row = &mut buffer[(top + y) * width + left..][..shown_width];
        for (x, pixel) in row.iter_mut().enumerate() {
            let [red, green, blue] = picture.get(x * 1024 / scale, y * 1024 / scale);
            *pixel = u32::from_be_bytes([0, red, green, blue]);
        }
    }
}
