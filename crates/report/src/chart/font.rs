//! The letters of PDF figures: DejaVu Sans cut down to Latin-1 (`data/font/LICENSE`), embedded so
//! that a figure looks the same everywhere and a publisher's check finds no font missing.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::FontFlags;
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref};
use std::io::Write;

/// A font: its name, file, box around all letters, and what the letters from the space (32) to 255
/// are wide, in thousandths of their size, in the encoding of Windows.
pub(super) struct Font {
    name: &'static str,
    file: &'static [u8],
    bounds: [i16; 4],
    widths: [u16; 224],
}

pub(super) const PLAIN: Font = Font {
    name: "HasardPlotSans",
    file: include_bytes!("../../data/font/plain.ttf"),
    bounds: [-1021, -463, 1793, 1232],
    widths: [
        318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636,
        636, 636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698,
        770, 632, 575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635, 611, 732,
        684, 989, 685, 611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352, 635,
        634, 278, 278, 579, 278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,
        525, 636, 337, 636, 838, 0, 0, 0, 0, 0, 0, 0, 500, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 318, 0,
        0, 0, 500, 1000, 0, 0, 0, 0, 0, 0, 0, 0, 318, 401, 636, 636, 636, 636, 337, 500, 500, 1000,
        471, 612, 838, 361, 1000, 500, 500, 838, 401, 401, 500, 636, 636, 318, 500, 401, 471, 612,
        969, 969, 969, 531, 684, 684, 684, 684, 684, 684, 974, 698, 632, 632, 632, 632, 295, 295,
        295, 295, 775, 748, 787, 787, 787, 787, 787, 838, 787, 732, 732, 732, 732, 611, 605, 630,
        613, 613, 613, 613, 613, 613, 982, 550, 615, 615, 615, 615, 278, 278, 278, 278, 612, 634,
        612, 612, 612, 612, 612, 838, 612, 634, 634, 634, 634, 592, 635, 592,
    ],
};

pub(super) const BOLD: Font = Font {
    name: "HasardPlotSans-Bold",
    file: include_bytes!("../../data/font/bold.ttf"),
    bounds: [-1069, -415, 1975, 1175],
    widths: [
        348, 456, 521, 838, 696, 1002, 872, 306, 457, 457, 523, 838, 380, 415, 380, 365, 696, 696,
        696, 696, 696, 696, 696, 696, 696, 696, 400, 400, 838, 838, 838, 580, 1000, 774, 762, 734,
        830, 683, 683, 821, 837, 372, 372, 775, 637, 995, 837, 850, 733, 850, 770, 720, 682, 812,
        774, 1103, 771, 724, 725, 457, 365, 457, 838, 500, 500, 675, 716, 593, 716, 678, 435, 716,
        712, 343, 343, 665, 343, 1042, 712, 687, 716, 716, 493, 595, 478, 712, 652, 924, 645, 652,
        582, 712, 365, 712, 838, 0, 0, 0, 0, 0, 0, 0, 500, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 380, 0,
        0, 0, 500, 1000, 0, 0, 0, 0, 0, 0, 0, 0, 348, 456, 696, 696, 636, 696, 365, 500, 500, 1000,
        564, 646, 838, 415, 1000, 500, 500, 838, 438, 438, 500, 736, 636, 380, 500, 438, 564, 646,
        1035, 1035, 1035, 580, 774, 774, 774, 774, 774, 774, 1085, 734, 683, 683, 683, 683, 372,
        372, 372, 372, 838, 837, 850, 850, 850, 850, 850, 838, 850, 812, 812, 812, 812, 724, 738,
        719, 675, 675, 675, 675, 675, 675, 1048, 593, 678, 678, 678, 678, 343, 343, 343, 343, 687,
        712, 687, 687, 687, 687, 687, 838, 687, 712, 712, 712, 712, 652, 716, 652,
    ],
};

/// Heights above and below the base line, and of capitals: of both fonts.
const ASCENT: f32 = 928.0;
const DESCENT: f32 = -236.0;
const CAPITALS: f32 = 729.0;

impl Font {
    /// What letters are wide, in parts of their size.
    pub(super) fn width(&self, letters: &[u8]) -> f32 {
        let of =
            |letter: &u8| letter.checked_sub(b' ').map_or(0, |at| self.widths[usize::from(at)]);
        letters.iter().map(|letter| f32::from(of(letter))).sum::<f32>() / 1000.0
    }

    /// Writes the font, its description and its file into a document.
    pub(super) fn embed(&self, pdf: &mut Pdf, [font, description, file]: [Ref; 3]) {
        let name = Name(self.name.as_bytes());
        let mut written = pdf.indirect(font).dict();
        written
            .pair(Name(b"Type"), Name(b"Font"))
            .pair(Name(b"Subtype"), Name(b"TrueType"))
            .pair(Name(b"BaseFont"), name)
            .pair(Name(b"FirstChar"), 32)
            .pair(Name(b"LastChar"), 255)
            .pair(Name(b"FontDescriptor"), description)
            .pair(Name(b"Encoding"), Name(b"WinAnsiEncoding"));
        let widths = self.widths.iter().map(|width| i32::from(*width));
        written.insert(Name(b"Widths")).array().items(widths);
        written.finish();
        let [left, bottom, right, top] = self.bounds.map(f32::from);
        pdf.font_descriptor(description)
            .name(name)
            .flags(FontFlags::NON_SYMBOLIC)
            .bbox(Rect::new(left, bottom, right, top))
            .italic_angle(0.0)
            .ascent(ASCENT)
            .descent(DESCENT)
            .cap_height(CAPITALS)
            .stem_v(if self.name.ends_with("Bold") { 140.0 } else { 90.0 })
            .font_file2(file);
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
        packed.write_all(self.file).expect("memory takes all bytes");
        let packed = packed.finish().expect("memory takes all bytes");
        pdf.stream(file, &packed)
            .filter(Filter::FlateDecode)
            .pair(Name(b"Length1"), self.file.len() as i32);
    }
}
