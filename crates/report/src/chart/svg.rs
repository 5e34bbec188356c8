//! Figures as SVG.

use super::{Anchor, Drawing, Hover, Ink, SERIES_COLOURS, Shape};
use crate::escape::escape;
use std::fmt::Write;

/// Colours of the inks in light and in dark surroundings; a page and a single SVG file both carry
/// them.
pub const INK_STYLE: &str = include_str!("ink.css");

/// A figure for a page that has [`INK_STYLE`] itself; panels of curves carry their values for the
/// page's script.
#[must_use]
pub fn inline_svg(drawing: &Drawing, label: &str) -> String {
    let mut svg = format!(
        "<svg class=\"figure\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" role=\"img\" aria-label=\"{}\">",
        escape(label),
        w = n(drawing.width),
        h = n(drawing.height)
    );
    shapes(drawing, &mut svg);
    for hover in &drawing.hovers {
        let [x, y, w, h] = hover.place;
        let _ = write!(
            svg,
            "<rect class=\"hover\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" data-values=\"{}\"/>",
            n(x),
            n(y),
            n(w),
            n(h),
            escape(&hover_values(hover))
        );
    }
    svg.push_str("</svg>");
    svg
}

/// A figure as a file of its own, which follows the viewer's light or dark setting.
#[must_use]
pub fn standalone_svg(drawing: &Drawing, label: &str) -> String {
    let (w, h) = (n(drawing.width + 16.0), n(drawing.height + 16.0));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-8 -8 {w} {h}\" width=\"{w}\" height=\"{h}\" role=\"img\" aria-label=\"{}\">\
         <style>{INK_STYLE}</style><rect class=\"ground\" x=\"-8\" y=\"-8\" width=\"{w}\" height=\"{h}\"/>",
        escape(label)
    );
    shapes(drawing, &mut svg);
    svg.push_str("</svg>\n");
    svg
}

fn shapes(drawing: &Drawing, svg: &mut String) {
    for shape in &drawing.shapes {
        let _ = match shape {
            Shape::Line { points, ink, width, dashed, opacity } => {
                let dash = if *dashed { " stroke-dasharray=\"5 4\"" } else { "" };
                write!(
                    svg,
                    "<polyline class=\"{} line\" points=\"{}\" stroke-width=\"{}\"{dash}{}/>",
                    class(*ink),
                    join(points),
                    n(*width),
                    opaque("stroke-opacity", *opacity)
                )
            }
            Shape::Area { points, ink, opacity } => {
                write!(
                    svg,
                    "<polygon class=\"{}\" points=\"{}\"{}/>",
                    class(*ink),
                    join(points),
                    opaque("fill-opacity", *opacity)
                )
            }
            Shape::Box { place: [x, y, w, h], ink, opacity, title } => write!(
                svg,
                "<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}><title>{}</title></rect>",
                class(*ink),
                n(*x),
                n(*y),
                n(*w),
                n(*h),
                opaque("fill-opacity", *opacity),
                escape(title)
            ),
            Shape::Dot { at, radius, ink, title } => write!(
                svg,
                "<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"><title>{}</title></circle>",
                class(*ink),
                n(at.0),
                n(at.1),
                n(*radius),
                escape(title)
            ),
            Shape::Text { at, anchor, size, ink, bold, text } => {
                let anchor = match anchor {
                    Anchor::Start => "",
                    Anchor::Middle => " text-anchor=\"middle\"",
                    Anchor::End => " text-anchor=\"end\"",
                };
                let weight = if *bold { " font-weight=\"600\"" } else { "" };
                let (x, y, size) = (n(at.0), n(at.1), n(*size));
                write!(
                    svg,
                    "<text class=\"{}\" x=\"{x}\" y=\"{y}\" font-size=\"{size}\"{anchor}{weight}>{}</text>",
                    class(*ink),
                    escape(text)
                )
            }
        };
    }
}

/// Values for the page's script: plain JSON, numbers to four digits.
fn hover_values(hover: &Hover) -> String {
    let curves: Vec<String> = hover
        .curves
        .iter()
        .map(|curve| {
            let points: Vec<String> = curve
                .points
                .iter()
                .map(|(x, mean, half, count)| {
                    format!(
                        "[{},{},{},{count}]",
                        if x.abs() < 1000.0 { four(*x) } else { format!("{x:.0}") },
                        four(*mean),
                        half.map_or_else(|| "null".into(), four)
                    )
                })
                .collect();
            let name = serde_json::to_string(&curve.name).unwrap_or_else(|_| "\"\"".into());
            format!(
                "{{\"name\":{name},\"ink\":\"{}\",\"points\":[{}]}}",
                class(curve.ink),
                points.join(",")
            )
        })
        .collect();
    {
        let axis = serde_json::to_string(&hover.axis).unwrap_or_else(|_| "\"\"".into());
        let (from, to) = hover.horizontal;
        format!("{{\"from\":{from},\"to\":{to},\"axis\":{axis},\"curves\":[{}]}}", curves.join(","))
    }
}

/// A number with four significant digits.
fn four(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".into();
    }
    let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 8) as usize;
    format!("{value:.digits$}")
}

fn class(ink: Ink) -> String {
    match ink {
        Ink::Text => "ink-text".into(),
        Ink::Muted => "ink-muted".into(),
        Ink::Grid => "ink-grid".into(),
        Ink::Budget => "ink-budget".into(),
        Ink::Series(index) => format!("ink-{}", index % SERIES_COLOURS),
    }
}

fn opaque(attribute: &str, opacity: f64) -> String {
    if opacity >= 1.0 { String::new() } else { format!(" {attribute}=\"{}\"", n(opacity)) }
}

fn join(points: &[(f64, f64)]) -> String {
    points
        .iter()
        .map(|point| format!("{},{}", n(point.0), n(point.1)))
        .collect::<Vec<_>>()
        .join(" ")
}

/// A coordinate: two decimals, no trailing zeros.
fn n(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}
