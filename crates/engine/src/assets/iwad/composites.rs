//! Textures that a `TEXTURES` lump puts together from others.

use super::budget::SIDE_LIMIT;
use super::reader::Reader;
use super::sections::Sections;
use super::words::words;
use super::{IwadError, Wanted, push, still};
use crate::assets::{Assets, Image};
use crate::map::TextureName;
use crate::wad::Wad;

/// Most parts of one texture.
const PART_LIMIT: usize = 1 << 12;

/// A picture within a texture.
struct Part<'a> {
    name: &'a str,
    x: i32,
    y: i32,
    flip: [bool; 2],
}

/// A texture as the text defines it.
struct Definition<'a> {
    name: TextureName,
    size: [i32; 2],
    parts: Vec<Part<'a>>,
    /// What it asks for beyond pictures laid over each other.
    strange: Option<&'a str>,
}

/// Composes the textures that are wanted, in their order. One that asks for more than pictures laid
/// over each other is left out, and a line says so.
pub(super) fn load(
    set: &mut Assets,
    wad: &Wad<'_>,
    sections: &Sections<'_>,
    wanted: Wanted<'_>,
    reader: &mut Reader,
) -> Result<(), IwadError> {
    for lump in wad.lumps.iter().filter(|lump| lump.name.as_str() == "TEXTURES") {
        let mut text = Text { words: &words(lump.bytes), at: 0 };
        while let Some(definition) = text.definition() {
            if !wanted(definition.name) {
                continue;
            }
            if let Some(strange) = definition.strange {
                set.left_out.insert(format!("texture {:?} ({strange})", definition.name));
                continue;
            }
            let image = compose(&definition, set, sections, reader)?;
            let index = push(set, image);
            set.textures.insert(definition.name, still(index));
        }
    }
    Ok(())
}

fn compose(
    definition: &Definition<'_>,
    set: &Assets,
    sections: &Sections<'_>,
    reader: &mut Reader,
) -> Result<Image, IwadError> {
    let [width, height] = definition.size;
    if !(1..=SIDE_LIMIT as i32).contains(&width) || !(1..=SIDE_LIMIT as i32).contains(&height) {
        return Err(IwadError::Picture { lump: definition.name, what: "its size is absurd" });
    }
    let size = (width * height) as usize;
    reader.budget.keep(size)?;
    let mut pixels = vec![0; size].into_boxed_slice();
    let mut mask = vec![0; size].into_boxed_slice();
    for part in &definition.parts {
        let name = TextureName::new(part.name);
        let patch = sections.patches.iter().chain(&sections.rest).rfind(|lump| lump.name == name);
        let decoded;
        let picture = match (patch, set.textures.get(&name)) {
            (Some(lump), _)
                if sections.patches.iter().any(|other| other.name == name)
                    || !set.textures.contains_key(&name) =>
            {
                decoded = reader.picture(lump)?;
                &decoded
            }
            (_, Some(entry)) => &set.images[entry.first as usize],
            _ => continue,
        };
        let (across, down) = (i32::from(picture.width), i32::from(picture.height));
        reader.budget.visit((across * down) as usize)?;
        for x in part.x.max(0)..part.x.saturating_add(across).min(width) {
            let from_x = if part.flip[0] { across - 1 - (x - part.x) } else { x - part.x };
            for y in part.y.max(0)..part.y.saturating_add(down).min(height) {
                let from_y = if part.flip[1] { down - 1 - (y - part.y) } else { y - part.y };
                let (from, to) = ((from_x * down + from_y) as usize, (x * height + y) as usize);
                if picture.mask.as_ref().is_none_or(|mask| mask[from] == 1) {
                    pixels[to] = picture.pixels[from];
                    mask[to] = 1;
                }
            }
        }
    }
    let opaque = mask.iter().all(|&opaque| opaque == 1);
    Ok(Image {
        width: width as u16,
        height: height as u16,
        offset_x: 0,
        offset_y: 0,
        pixels,
        mask: (!opaque).then_some(mask),
    })
}

/// A reader of the text's words.
struct Text<'a, 'w> {
    words: &'w [&'a str],
    at: usize,
}

impl<'a> Text<'a, '_> {
    fn next(&mut self) -> Option<&'a str> {
        let word = self.words.get(self.at).copied();
        self.at += 1;
        word
    }

    fn is(&self, word: &str) -> bool {
        self.words.get(self.at).is_some_and(|found| found.eq_ignore_ascii_case(word))
    }

    /// A comma and a number; 0 for anything else.
    fn number(&mut self) -> i32 {
        if self.is(",") {
            self.at += 1;
        }
        self.next().and_then(|word| word.parse().ok()).unwrap_or(0)
    }

    /// The next definition of a texture.
    fn definition(&mut self) -> Option<Definition<'a>> {
        const KINDS: [&str; 3] = ["texture", "walltexture", "flat"];
        while !KINDS.iter().any(|kind| self.is(kind)) {
            self.next()?;
        }
        self.at += 1;
        if self.is("optional") {
            self.at += 1;
        }
        let name = TextureName::new(self.next()?);
        let size = [self.number(), self.number()];
        let mut definition = Definition { name, size, parts: Vec::new(), strange: None };
        if !self.is("{") {
            return Some(definition);
        }
        self.at += 1;
        while !self.is("}") {
            if self.is("patch") && definition.parts.len() < PART_LIMIT {
                self.at += 1;
                let (name, x, y) = (self.next()?, self.number(), self.number());
                let limit = SIDE_LIMIT as i32;
                let mut part = Part {
                    name,
                    x: x.clamp(-limit, limit),
                    y: y.clamp(-limit, limit),
                    flip: [false; 2],
                };
                if self.is("{") {
                    self.at += 1;
                    self.part_options(&mut part, &mut definition.strange)?;
                }
                definition.parts.push(part);
            } else {
                let word = self.next()?;
                if ["xscale", "yscale", "offset", "worldpanning", "nodecals", "nulltexture"]
                    .contains(&word.to_ascii_lowercase().as_str())
                {
                    definition.strange = Some(word);
                }
            }
        }
        self.at += 1;
        Some(definition)
    }

    fn part_options(&mut self, part: &mut Part<'a>, strange: &mut Option<&'a str>) -> Option<()> {
        while !self.is("}") {
            let word = self.next()?;
            match word.to_ascii_lowercase().as_str() {
                "flipx" => part.flip[0] = true,
                "flipy" => part.flip[1] = true,
                "rotate" | "blend" | "translation" | "alpha" | "style" => *strange = Some(word),
                _ => {}
            }
        }
        self.at += 1;
        Some(())
    }
}
