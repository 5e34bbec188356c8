//! Fields that ViZDoom plays or draws and this one does not: a map that uses one is reported.
//!
//! `docs/guide/maps.md` has every field of the format and what comes of it; a test holds the two
//! together.

use super::lexer::TokenKind;

/// By kind of block: a field and the value at which it changes nothing.
const FIELDS: [(&str, &[(&str, &str)]); 5] = [
    ("vertex", &[("zfloor", ""), ("zceiling", "")]),
    (
        "linedef",
        &[
            ("jumpover", "false"),
            ("midtex3d", "false"),
            ("midtex3dimpassible", "false"),
            ("translucent", "false"),
            ("transparent", "false"),
            ("alpha", "1"),
            ("renderstyle", "translucent"),
            ("clipmidtex", "false"),
            ("wrapmidtex", "false"),
        ],
    ),
    (
        "sidedef",
        &[
            ("scalex_top", "1"),
            ("scaley_top", "1"),
            ("scalex_mid", "1"),
            ("scaley_mid", "1"),
            ("scalex_bottom", "1"),
            ("scaley_bottom", "1"),
            ("offsetx_top", "0"),
            ("offsety_top", "0"),
            ("offsetx_mid", "0"),
            ("offsety_mid", "0"),
            ("offsetx_bottom", "0"),
            ("offsety_bottom", "0"),
            ("light", "0"),
            ("lightabsolute", "false"),
            ("nofakecontrast", "false"),
            ("smoothlighting", "false"),
            ("clipmidtex", "false"),
            ("wrapmidtex", "false"),
            ("nodecals", "false"),
        ],
    ),
    (
        "sector",
        &[
            ("moreids", ""),
            ("floorplane_a", "0"),
            ("floorplane_b", "0"),
            ("floorplane_c", "1"),
            ("floorplane_d", ""),
            ("ceilingplane_a", "0"),
            ("ceilingplane_b", "0"),
            ("ceilingplane_c", "-1"),
            ("ceilingplane_d", ""),
            ("xpanningfloor", "0"),
            ("ypanningfloor", "0"),
            ("xpanningceiling", "0"),
            ("ypanningceiling", "0"),
            ("xscalefloor", "1"),
            ("yscalefloor", "1"),
            ("xscaleceiling", "1"),
            ("yscaleceiling", "1"),
            ("rotationfloor", "0"),
            ("rotationceiling", "0"),
            ("lightfloor", "0"),
            ("lightceiling", "0"),
            ("lightfloorabsolute", "false"),
            ("lightceilingabsolute", "false"),
            ("alphafloor", "1"),
            ("alphaceiling", "1"),
            ("renderstylefloor", "translucent"),
            ("renderstyleceiling", "translucent"),
            ("portal_floor_overlaytype", "translucent"),
            ("portal_ceil_overlaytype", "translucent"),
            ("lightcolor", "16777215"),
            ("fadecolor", "0"),
            ("desaturation", "0"),
            ("gravity", "1"),
            ("nofallingdamage", "false"),
            ("dropactors", "false"),
            ("waterzone", "false"),
            ("damageamount", "0"),
            ("floorterrain", ""),
            ("ceilingterrain", ""),
        ],
    ),
    (
        "thing",
        &[
            ("ambush", "false"),
            ("friend", "false"),
            ("dormant", "false"),
            ("standing", "false"),
            ("strifeally", "false"),
            ("translucent", "false"),
            ("invisible", "false"),
            ("special", "0"),
            ("conversation", "0"),
            ("gravity", "1"),
            ("health", "1"),
            ("renderstyle", ""),
            ("fillcolor", "0"),
            ("alpha", "1"),
            ("pitch", "0"),
            ("roll", "0"),
            ("scale", "1"),
            ("scalex", "1"),
            ("scaley", "1"),
        ],
    ),
];

/// The name of a field that would be played or drawn elsewhere with this value; none where it
/// changes nothing.
pub(super) fn unplayed(block: &str, field: &str, value: &TokenKind<'_>) -> Option<&'static str> {
    let (_, fields) = FIELDS.iter().find(|(kind, _)| *kind == block)?;
    let &(name, without) = fields.iter().find(|(name, _)| *name == field)?;
    let number = |value: f64| without.parse() == Ok(value);
    let idle = match value {
        TokenKind::Integer(value) => number(*value as f64),
        TokenKind::Float(value) => number(*value),
        TokenKind::Word(word) => without.eq_ignore_ascii_case(word),
        TokenKind::Text(text) => without.eq_ignore_ascii_case(text.trim()),
        TokenKind::Mark(_) | TokenKind::End => true,
    };
    (!idle).then_some(name)
}
