//! Figures as PDF: vectors and letters, for papers.

use super::font::{BOLD, PLAIN};
use super::raster::colour;
use super::{Anchor, Drawing, Ink, Shape};
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str};

/// Points for a CSS pixel.
const POINTS: f32 = 0.75;
/// Margin around the figure, in CSS pixels.
const MARGIN: f32 = 4.0;
/// Steps between seen through and opaque.
const OPACITIES: u8 = 20;
/// A figure in its light colours as a page of its own size. It carries the fonts of its letters.
#[must_use]
pub fn pdf(drawing: &Drawing) -> Vec<u8> {
    let (width, height) =
        (drawing.width as f32 + 2.0 * MARGIN, drawing.height as f32 + 2.0 * MARGIN);
    let [catalog, pages, page, content] = [1, 2, 3, 4].map(Ref::new);
    let (plain, bold) = ([5, 6, 7].map(Ref::new), [8, 9, 10].map(Ref::new));
    let is_bold = |shape: &Shape| matches!(shape, Shape::Text { bold: true, .. });
    let has_bold = drawing.shapes.iter().any(is_bold);
    let mut file = Pdf::new();
    file.catalog(catalog).pages(pages);
    file.pages(pages).kids([page]).count(1);
    let mut one = file.page(page);
    one.media_box(Rect::new(0.0, 0.0, width * POINTS, height * POINTS))
        .parent(pages)
        .contents(content);
    let mut resources = one.resources();
    let mut fonts = resources.fonts();
    fonts.pair(Name(b"F1"), plain[0]);
    if has_bold {
        fonts.pair(Name(b"F2"), bold[0]);
    }
    fonts.finish();
    let mut states = resources.ext_g_states();
    for step in 0..=OPACITIES {
        let share = f32::from(step) / f32::from(OPACITIES);
        states
            .insert(Name(state(step).as_bytes()))
            .start::<pdf_writer::writers::ExtGraphicsState>()
            .stroking_alpha(share)
            .non_stroking_alpha(share);
    }
    states.finish();
    resources.finish();
    one.finish();
    PLAIN.embed(&mut file, plain);
    if has_bold {
        BOLD.embed(&mut file, bold);
    }
    let mut drawn = Content::new();
    // From CSS pixels downwards to points upwards.
    drawn.transform([POINTS, 0.0, 0.0, -POINTS, MARGIN * POINTS, (height - MARGIN) * POINTS]);
    drawing.shapes.iter().for_each(|shape| draw(shape, &mut drawn));
    file.stream(content, &drawn.finish());
    file.finish()
}

fn state(step: u8) -> String {
    format!("G{step}")
}

fn draw(shape: &Shape, drawn: &mut Content) {
    let (ink, opacity) = match shape {
        Shape::Line { ink, opacity, .. }
        | Shape::Area { ink, opacity, .. }
        | Shape::Box { ink, opacity, .. } => (*ink, *opacity),
        Shape::Dot { ink, .. } | Shape::Text { ink, .. } => (*ink, 1.0),
    };
    drawn.save_state();
    drawn.set_parameters(Name(
        state((opacity.clamp(0.0, 1.0) * f64::from(OPACITIES)).round() as u8).as_bytes(),
    ));
    let [r, g, b] = light(ink);
    drawn.set_stroke_rgb(r, g, b).set_fill_rgb(r, g, b);
    match shape {
        Shape::Line { points, width, dashed, .. } => {
            drawn
                .set_line_width(*width as f32)
                .set_line_join(pdf_writer::types::LineJoinStyle::RoundJoin);
            if *dashed {
                drawn.set_dash_pattern([5.0, 4.0], 0.0);
            }
            if outline(points, drawn) {
                drawn.stroke();
            }
        }
        Shape::Area { points, .. } => {
            if outline(points, drawn) {
                drawn.close_path().fill_nonzero();
            }
        }
        Shape::Box { place: [x, y, w, h], .. } => {
            drawn.rect(*x as f32, *y as f32, *w as f32, *h as f32).fill_nonzero();
        }
        Shape::Dot { at, radius, .. } => {
            let (x, y, r) = (at.0 as f32, at.1 as f32, *radius as f32);
            // Four cubic curves, off a circle by less than a thousandth of its radius.
            let k = 0.552_285 * r;
            drawn.move_to(x + r, y);
            drawn.cubic_to(x + r, y + k, x + k, y + r, x, y + r).cubic_to(
                x - k,
                y + r,
                x - r,
                y + k,
                x - r,
                y,
            );
            drawn
                .cubic_to(x - r, y - k, x - k, y - r, x, y - r)
                .cubic_to(x + k, y - r, x + r, y - k, x + r, y)
                .fill_nonzero();
        }
        Shape::Text { at, anchor, size, bold, text, .. } => {
            let letters = win_ansi(text);
            let size = *size as f32;
            let wide = size * if *bold { BOLD.width(&letters) } else { PLAIN.width(&letters) };
            let x = at.0 as f32
                - match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => wide / 2.0,
                    Anchor::End => wide,
                };
            drawn.begin_text().set_font(Name(if *bold { b"F2" } else { b"F1" }), size);
            drawn
                .set_text_matrix([1.0, 0.0, 0.0, -1.0, x, at.1 as f32])
                .show(Str(&letters))
                .end_text();
        }
    }
    drawn.restore_state();
}

/// Begins a path through points; `false` if there is none to draw.
fn outline(points: &[(f64, f64)], drawn: &mut Content) -> bool {
    let mut finite = points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
    let Some((x, y)) = finite.next() else { return false };
    drawn.move_to(*x as f32, *y as f32);
    for (x, y) in finite {
        drawn.line_to(*x as f32, *y as f32);
    }
    true
}

fn light(ink: Ink) -> [f32; 3] {
    colour(ink).map(|value| f32::from(value) / 255.0)
}

/// Letters in the encoding of the font; those that it lacks become question marks.
fn win_ansi(text: &str) -> Vec<u8> {
    let letter = |character: char| match character {
        ' '..='~' | '\u{a0}'..='\u{ff}' => character as u8,
        '–' => 150,
        '—' => 151,
        '’' => 146,
        '†' => 134,
        '‡' => 135,
        _ => b'?',
    };
    text.chars().map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_the_figures_size_and_its_words() {
        let mut drawing = Drawing::new(392.0, 192.0);
        drawing.text((100.0, 50.0), Anchor::End, Ink::Text, "return 3");
        drawing.shapes.push(Shape::Line {
            points: vec![(0.0, 0.0), (10.0, f64::NAN), (20.0, 5.0)],
            ink: Ink::Budget,
            width: 1.5,
            dashed: true,
            opacity: 0.5,
        });
        let bytes = pdf(&drawing);
        let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
        // 400 and 200 pixels with their margins.
        for part in [
            "%PDF-1.7",
            "/MediaBox [0 0 300 150]",
            "(return 3) Tj",
            "0 0 m\n20 5 l\nS",
            "/G10 gs",
            "/BaseFont /HasardPlotSans\n",
            "/FontFile2 7 0 R",
            "%%EOF",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        // No bold letter, no bold font.
        assert!(!text.contains("HasardPlotSans-Bold") && bytes.len() < 40_000, "{}", bytes.len());
        // r, e, t, u, r, n: 411 + 615 + 392 + 634 + 411 + 634 thousandths.
        assert!((PLAIN.width(b"return") - 3.097).abs() < 1e-6);
        drawing.shapes.push(Shape::Text {
            at: (0.0, 0.0),
            anchor: Anchor::Start,
            ink: Ink::Text,
            size: 11.0,
            bold: true,
            text: "cost ±".into(),
        });
        let text: String = pdf(&drawing).iter().map(|byte| char::from(*byte)).collect();
        assert!(text.contains("/BaseFont /HasardPlotSans-Bold\n") && text.contains("10 0 R"));
    }
}
