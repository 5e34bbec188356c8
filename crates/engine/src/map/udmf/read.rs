//! UDMF text to [`MapSource`].

use super::error::{UdmfError, UdmfFault};
use super::lexer::{Lexer, TokenKind};
use super::unplayed::unplayed;
use crate::map::{
    Blocks, MapSource, SourceLine, SourceSector, SourceSide, SourceThing, SourceVertex, TextureName,
};
use std::collections::BTreeMap;

/// Fields of a line by which somebody can set off its special.
const TRIGGERS: [&str; 10] = [
    "playeruse",
    "playeruseback",
    "playercross",
    "playerpush",
    "monsteruse",
    "monstercross",
    "monsterpush",
    "missilecross",
    "impact",
    "anycross",
];

/// Editor numbers of players' starts.
const STARTS: std::ops::RangeInclusive<i32> = 1..=4;

/// What a thing needs to appear to one player, at the skill that the published package plays at.
const ALONE: &str = "single";
const SKILL: &str = "skill3";

/// How things without these are reported.
const ABSENT: &str = "thing without single or skill3";

/// What a field of a line stops.
fn blocks(name: &str) -> Option<Blocks> {
    Blocks::FIELDS.iter().find(|(field, _)| *field == name).map(|&(_, flag)| flag)
}

/// Reads UDMF text. Indices are not checked here; [`Map::build`](crate::map::Map::build) does.
///
/// # Errors
/// The first fault, with its line and column.
pub fn read(text: &[u8]) -> Result<MapSource, UdmfError> {
    let mut reader = Reader { lexer: Lexer::new(text), fields: Vec::new() };
    let mut source = MapSource::default();
    let mut named = false;
    loop {
        let token = reader.lexer.next()?;
        let word = match token.kind {
            TokenKind::Word(word) => word,
            TokenKind::End if named => return Ok(source),
            TokenKind::End => return Err(reader.lexer.fault(token.offset, UdmfFault::NoNamespace)),
            TokenKind::Mark(b';') => continue,
            other => return Err(reader.expected(token.offset, "a block or an assignment", &other)),
        };
        match reader.lexer.next()? {
            next if next.kind == TokenKind::Mark(b'=') => {
                let field = reader.value(word)?;
                if word.eq_ignore_ascii_case("namespace") {
                    source.namespace = reader.text(&field)?.to_ascii_lowercase();
                    named = true;
                }
            }
            next if next.kind == TokenKind::Mark(b'{') => {
                if !named {
                    return Err(reader.lexer.fault(token.offset, UdmfFault::NoNamespace));
                }
                reader.block()?;
                reader.take(&word.to_ascii_lowercase(), token.offset, &mut source)?;
            }
            next => return Err(reader.expected(next.offset, "`=` or `{`", &next.kind)),
        }
    }
}

/// A field of a block; the value is never a mark.
struct Field<'a> {
    offset: usize,
    name: String,
    value: TokenKind<'a>,
}

struct Reader<'a> {
    lexer: Lexer<'a>,
    /// Fields of the block at hand.
    fields: Vec<Field<'a>>,
}

impl<'a> Reader<'a> {
    fn expected(&self, offset: usize, what: &'static str, found: &TokenKind<'_>) -> UdmfError {
        self.lexer.fault(offset, UdmfFault::Expected { what, found: found.describe() })
    }

    /// The rest of an assignment after `=`.
    fn value(&mut self, name: &str) -> Result<Field<'a>, UdmfError> {
        let value = self.lexer.next()?;
        if matches!(value.kind, TokenKind::Mark(_) | TokenKind::End) {
            return Err(self.expected(value.offset, "a value", &value.kind));
        }
        let end = self.lexer.next()?;
        if end.kind != TokenKind::Mark(b';') {
            return Err(self.expected(end.offset, "`;`", &end.kind));
        }
        Ok(Field { offset: value.offset, name: name.to_ascii_lowercase(), value: value.kind })
    }

    /// The fields of a block after `{`. Blocks do not nest.
    fn block(&mut self) -> Result<(), UdmfError> {
        self.fields.clear();
        loop {
            let token = self.lexer.next()?;
            match token.kind {
                TokenKind::Mark(b'}') => return Ok(()),
                TokenKind::Mark(b';') => {}
                TokenKind::Word(word) => {
                    let next = self.lexer.next()?;
                    if next.kind != TokenKind::Mark(b'=') {
                        return Err(self.expected(next.offset, "`=`", &next.kind));
                    }
                    let field = self.value(word)?;
                    self.fields.push(field);
                }
                other => return Err(self.expected(token.offset, "a field or `}`", &other)),
            }
        }
    }

    fn take(&self, kind: &str, offset: usize, source: &mut MapSource) -> Result<(), UdmfError> {
        match kind {
            "vertex" => source.vertices.push(self.vertex(offset)?),
            "linedef" => {
                let line = self.line(offset)?;
                if line.back.is_some() && !self.flag("twosided")? {
                    *source
                        .unplayed
                        .entry("linedef sideback without twosided".to_owned())
                        .or_default() += 1;
                }
                source.lines.push(line);
            }
            "sidedef" => source.sides.push(self.side(offset)?),
            "sector" => source.sectors.push(self.sector(offset)?),
            "thing" => {
                let thing = self.thing(offset)?;
                if !self.appears(&thing)? {
                    *source.unplayed.entry(ABSENT.to_owned()).or_default() += 1;
                    return Ok(());
                }
                source.things.push(thing);
            }
            _ => {}
        }
        self.count_unplayed(kind, source);
        Ok(())
    }

    /// Counts the fields of the block that are played elsewhere and not here; of a field that comes
    /// twice, the last counts.
    fn count_unplayed(&self, kind: &str, source: &mut MapSource) {
        let mut last: BTreeMap<&str, &Field<'_>> = BTreeMap::new();
        self.fields.iter().for_each(|field| _ = last.insert(&field.name, field));
        for field in
            last.into_values().filter_map(|field| unplayed(kind, &field.name, &field.value))
        {
            *source.unplayed.entry(format!("{kind} field {field}")).or_default() += 1;
        }
    }

    /// Whether a thing is there in a game of one player on the package's skill; starts always are.
    fn appears(&self, thing: &SourceThing) -> Result<bool, UdmfError> {
        Ok(STARTS.contains(&thing.kind) || self.flag(ALONE)? && self.flag(SKILL)?)
    }

    /// A flag of the block, false if it is absent.
    fn flag(&self, name: &str) -> Result<bool, UdmfError> {
        self.fields
            .iter()
            .rfind(|field| field.name == name)
            .map_or(Ok(false), |field| self.truth(field))
    }

    fn vertex(&self, offset: usize) -> Result<SourceVertex, UdmfError> {
        let (mut x, mut y) = (None, None);
        for field in &self.fields {
            match field.name.as_str() {
                "x" => x = Some(self.number(field)?),
                "y" => y = Some(self.number(field)?),
                _ => {}
            }
        }
        let need =
            |value: Option<f64>, field| value.ok_or_else(|| self.missing(offset, "vertex", field));
        Ok(SourceVertex { x: need(x, "x")?, y: need(y, "y")? })
    }

    fn line(&self, offset: usize) -> Result<SourceLine, UdmfError> {
        let mut line = SourceLine::default();
        let (mut v1, mut v2, mut front) = (None, None, None);
        for field in &self.fields {
            match field.name.as_str() {
                "v1" => v1 = Some(self.index(field)?),
                "v2" => v2 = Some(self.index(field)?),
                "sidefront" => front = Some(self.index(field)?),
                "sideback" => line.back = self.optional_index(field)?,
                "blocking" => line.blocking = self.truth(field)?,
                "dontpegtop" => line.upper_unpegged = self.truth(field)?,
                "dontpegbottom" => line.lower_unpegged = self.truth(field)?,
                "id" => line.id = self.whole(field)?,
                "special" => line.special = self.whole(field)?,
                name if TRIGGERS.contains(&name) => line.triggered |= self.truth(field)?,
                name => match blocks(name) {
                    Some(flag) => line.blocks.set(flag, self.truth(field)?),
                    None => self.argument(name, field, &mut line.args)?,
                },
            }
        }
        let need = |value: Option<usize>, field| {
            value.ok_or_else(|| self.missing(offset, "linedef", field))
        };
        Ok(SourceLine {
            v1: need(v1, "v1")?,
            v2: need(v2, "v2")?,
            front: need(front, "sidefront")?,
            ..line
        })
    }

    fn side(&self, offset: usize) -> Result<SourceSide, UdmfError> {
        let mut side = SourceSide::default();
        let mut sector = None;
        for field in &self.fields {
            match field.name.as_str() {
                "sector" => sector = Some(self.index(field)?),
                "offsetx" => side.offset_x = self.number(field)?,
                "offsety" => side.offset_y = self.number(field)?,
                "texturetop" => side.top = self.texture(field)?,
                "texturemiddle" => side.middle = self.texture(field)?,
                "texturebottom" => side.bottom = self.texture(field)?,
                _ => {}
            }
        }
        side.sector = sector.ok_or_else(|| self.missing(offset, "sidedef", "sector"))?;
        Ok(side)
    }

    fn sector(&self, offset: usize) -> Result<SourceSector, UdmfError> {
        // 160 is the specification's default.
        let mut sector = SourceSector { light: 160, ..SourceSector::default() };
        let (mut floor, mut ceiling) = (None, None);
        for field in &self.fields {
            match field.name.as_str() {
                "heightfloor" => sector.floor = self.whole(field)?,
                "heightceiling" => sector.ceiling = self.whole(field)?,
                "texturefloor" => floor = Some(self.texture(field)?),
                "textureceiling" => ceiling = Some(self.texture(field)?),
                "lightlevel" => sector.light = self.whole(field)?,
                "special" => sector.special = self.whole(field)?,
                "id" => sector.tag = self.whole(field)?,
                _ => {}
            }
        }
        sector.floor_texture =
            floor.ok_or_else(|| self.missing(offset, "sector", "texturefloor"))?;
        sector.ceiling_texture =
            ceiling.ok_or_else(|| self.missing(offset, "sector", "textureceiling"))?;
        Ok(sector)
    }

    fn thing(&self, offset: usize) -> Result<SourceThing, UdmfError> {
        let mut thing = SourceThing::default();
        let (mut x, mut y, mut kind) = (None, None, None);
        for field in &self.fields {
            match field.name.as_str() {
                "x" => x = Some(self.number(field)?),
                "y" => y = Some(self.number(field)?),
                "height" => thing.height = self.number(field)?,
                "angle" => thing.angle = self.whole(field)?,
                "type" => kind = Some(self.whole(field)?),
                "id" => thing.id = self.whole(field)?,
                name => self.argument(name, field, &mut thing.args)?,
            }
        }
        thing.x = x.ok_or_else(|| self.missing(offset, "thing", "x"))?;
        thing.y = y.ok_or_else(|| self.missing(offset, "thing", "y"))?;
        thing.kind = kind.ok_or_else(|| self.missing(offset, "thing", "type"))?;
        Ok(thing)
    }

    fn argument(
        &self,
        name: &str,
        field: &Field<'_>,
        args: &mut [i32; 5],
    ) -> Result<(), UdmfError> {
        let number = name.strip_prefix("arg").and_then(|digit| digit.parse::<usize>().ok());
        if let Some(arg) = number.and_then(|number| args.get_mut(number)) {
            *arg = self.whole(field)?;
        }
        Ok(())
    }

    fn missing(&self, offset: usize, block: &'static str, field: &'static str) -> UdmfError {
        self.lexer.fault(offset, UdmfFault::MissingField { block, field })
    }

    fn wrong(&self, field: &Field<'_>, wants: &'static str) -> UdmfError {
        self.lexer.fault(field.offset, UdmfFault::Value { field: field.name.clone(), wants })
    }

    fn number(&self, field: &Field<'_>) -> Result<f64, UdmfError> {
        match field.value {
            TokenKind::Integer(value) => Ok(value as f64),
            TokenKind::Float(value) => Ok(value),
            _ => Err(self.wrong(field, "a number")),
        }
    }

    fn whole(&self, field: &Field<'_>) -> Result<i32, UdmfError> {
        let value = match field.value {
            TokenKind::Integer(value) => i32::try_from(value).ok(),
            // Some editors write heights as floats.
            TokenKind::Float(value) if value as i32 as f64 == value => Some(value as i32),
            _ => None,
        };
        value.ok_or_else(|| self.wrong(field, "a whole number of 32 bits"))
    }

    fn index(&self, field: &Field<'_>) -> Result<usize, UdmfError> {
        usize::try_from(self.whole(field)?).map_err(|_| self.wrong(field, "an index, 0 or more"))
    }

    fn optional_index(&self, field: &Field<'_>) -> Result<Option<usize>, UdmfError> {
        if self.whole(field)? == -1 { Ok(None) } else { self.index(field).map(Some) }
    }

    fn truth(&self, field: &Field<'_>) -> Result<bool, UdmfError> {
        match field.value {
            TokenKind::Word(word) if word.eq_ignore_ascii_case("true") => Ok(true),
            TokenKind::Word(word) if word.eq_ignore_ascii_case("false") => Ok(false),
            _ => Err(self.wrong(field, "true or false")),
        }
    }

    fn text<'f>(&self, field: &'f Field<'_>) -> Result<&'f str, UdmfError> {
        match &field.value {
            TokenKind::Text(text) => Ok(text),
            _ => Err(self.wrong(field, "a string in double quotes")),
        }
    }

    fn texture(&self, field: &Field<'_>) -> Result<TextureName, UdmfError> {
        let text = self.text(field)?;
        if text.len() > 8 || !text.bytes().all(|byte| byte.is_ascii_graphic()) {
            return Err(self.wrong(field, "a texture name of at most 8 printable ASCII characters"));
        }
        Ok(TextureName::new(text))
    }
}
