//! [`MapSource`] to UDMF text.

use crate::map::{Blocks, MapSource, TextureName};
use std::fmt::{Display, Write};

/// Writes a map as UDMF text that [`read`](super::read) gives back equal and that engines of the
/// ZDoom family load.
///
/// Fields at the specification's default are left out. Things get the flags that make them appear
/// at every skill and in every kind of game, and two-sided lines their `twosided`: the source has
/// no such switches.
#[must_use]
pub fn write(source: &MapSource) -> String {
    let mut text = String::new();
    text.push_str("namespace = ");
    quote(&mut text, &source.namespace);
    text.push_str(";\n");
    for (i, thing) in source.things.iter().enumerate() {
        let mut block = Block::open(&mut text, "thing", i);
        block.float("x", thing.x, None);
        block.float("y", thing.y, None);
        block.float("height", thing.height, Some(0.0));
        block.whole("angle", thing.angle, 0);
        block.field("type", thing.kind);
        block.whole("id", thing.id, 0);
        block.arguments(&thing.args);
        for flag in ["skill1", "skill2", "skill3", "skill4", "skill5", "single", "coop", "dm"] {
            block.field(flag, true);
        }
        for flag in ["class1", "class2", "class3"] {
            block.field(flag, true);
        }
        block.close();
    }
    for (i, vertex) in source.vertices.iter().enumerate() {
        let mut block = Block::open(&mut text, "vertex", i);
        block.float("x", vertex.x, None);
        block.float("y", vertex.y, None);
        block.close();
    }
    for (i, line) in source.lines.iter().enumerate() {
        let mut block = Block::open(&mut text, "linedef", i);
        block.field("v1", line.v1);
        block.field("v2", line.v2);
        block.field("sidefront", line.front);
        if let Some(back) = line.back {
            block.field("sideback", back);
            block.field("twosided", true);
        }
        block.flag("blocking", line.blocking);
        for (name, flag) in Blocks::FIELDS {
            block.flag(name, line.blocks.any(flag));
        }
        block.flag("dontpegtop", line.upper_unpegged);
        block.flag("dontpegbottom", line.lower_unpegged);
        block.whole("id", line.id, 0);
        block.whole("special", line.special, 0);
        block.arguments(&line.args);
        block.close();
    }
    for (i, side) in source.sides.iter().enumerate() {
        let mut block = Block::open(&mut text, "sidedef", i);
        block.field("sector", side.sector);
        block.float("offsetx", side.offset_x, Some(0.0));
        block.float("offsety", side.offset_y, Some(0.0));
        block.texture("texturetop", side.top);
        block.texture("texturemiddle", side.middle);
        block.texture("texturebottom", side.bottom);
        block.close();
    }
    for (i, sector) in source.sectors.iter().enumerate() {
        let mut block = Block::open(&mut text, "sector", i);
        block.whole("heightfloor", sector.floor, 0);
        block.whole("heightceiling", sector.ceiling, 0);
        block.name("texturefloor", sector.floor_texture);
        block.name("textureceiling", sector.ceiling_texture);
        block.field("lightlevel", sector.light);
        block.whole("special", sector.special, 0);
        block.whole("id", sector.tag, 0);
        block.close();
    }
    text
}

fn quote(text: &mut String, value: &str) {
    text.push('"');
    for character in value.chars() {
        if matches!(character, '"' | '\\') {
            text.push('\\');
        }
        text.push(character);
    }
    text.push('"');
}

struct Block<'a> {
    text: &'a mut String,
}

impl Block<'_> {
    fn open<'a>(text: &'a mut String, kind: &str, index: usize) -> Block<'a> {
        push(text, format_args!("\n{kind} // {index}\n{{\n"));
        Block { text }
    }

    fn field(&mut self, name: &str, value: impl Display) {
        push(self.text, format_args!("{name} = {value};\n"));
    }

    fn whole(&mut self, name: &str, value: i32, default: i32) {
        if value != default {
            self.field(name, value);
        }
    }

    fn flag(&mut self, name: &str, value: bool) {
        if value {
            self.field(name, value);
        }
    }

    fn float(&mut self, name: &str, value: f64, default: Option<f64>) {
        if default != Some(value) {
            // The grammar wants a point in every float.
            let point = if value.fract() == 0.0 { ".0" } else { "" };
            push(self.text, format_args!("{name} = {value}{point};\n"));
        }
    }

    fn arguments(&mut self, args: &[i32; 5]) {
        for (i, &arg) in args.iter().enumerate().filter(|&(_, &arg)| arg != 0) {
            push(self.text, format_args!("arg{i} = {arg};\n"));
        }
    }

    /// A texture that defaults to none.
    fn texture(&mut self, name: &str, texture: TextureName) {
        if texture.is_some() {
            self.name(name, texture);
        }
    }

    fn name(&mut self, name: &str, texture: TextureName) {
        push(self.text, format_args!("{name} = "));
        quote(self.text, if texture.is_some() { texture.as_str() } else { "-" });
        self.text.push_str(";\n");
    }

    fn close(self) {
        self.text.push_str("}\n");
    }
}

fn push(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = text.write_fmt(arguments);
}
