//! From the editable source to the built map: checks, fixed point, cross references.

use super::{
    Blockmap, Line, LineFlags, Locator, Map, MapError, MapSource, MapThing, Sector, SectorId, Side,
    SideId, TextureId, TextureName, Vertex, bsp, special,
};
use crate::math::{Angle, Fixed};
use std::collections::BTreeMap;

/// Most vertices, lines, sides, sectors or things of a map. The largest original map has some
/// 7,000.
const ELEMENT_LIMIT: usize = 65_535;

/// Largest coordinate and height: differences of two then still fit 16.16.
const COORDINATE_LIMIT: i32 = 16_383;

/// Largest light level.
const LIGHT_LIMIT: i32 = 32_767;

impl Map {
    /// Checks a source and builds it. `extra_texture_names` are interned too, so that rules which
    /// change textures during play find their [`TextureId`]s by [`Map::texture`].
    ///
    /// # Errors
    /// The first fault found, with the element's index.
    pub fn build(
        source: &MapSource,
        name: &str,
        extra_texture_names: &[&str],
    ) -> Result<Map, MapError> {
        check_counts(source)?;
        let vertices = source
            .vertices
            .iter()
            .enumerate()
            .map(|(i, v)| {
                Ok(Vertex {
                    x: coordinate("vertex", i, "x", v.x)?,
                    y: coordinate("vertex", i, "y", v.y)?,
                })
            })
            .collect::<Result<Vec<_>, MapError>>()?;
        let mut names = Names::default();
        let mut sides = build_sides(source, &mut names)?;
        let lines = build_lines(source, &vertices, &mut sides)?;
        let mut sectors = build_sectors(source, &mut names)?;
        join_sectors_and_lines(&mut sectors, &lines);
        check_closed(source, sectors.len())?;
        let things = build_things(source)?;
        for name in extra_texture_names {
            names.intern(TextureName::new(name));
        }
        let textures = names.finish()?;
        let mut tags: Vec<(i32, SectorId)> = sectors
            .iter()
            .enumerate()
            // A sector that no line faces has no place where rules could act.
            .filter(|(_, sector)| sector.tag != 0 && !sector.lines.is_empty())
            .map(|(i, sector)| (sector.tag, SectorId(i as u32)))
            .collect();
        tags.sort_unstable();
        let blockmap = Blockmap::build(&lines)?;
        let tree = bsp::build(&lines, &sides)?;
        let locator = Locator::build(&vertices, &tree.nodes);
        Ok(Map {
            name: name.to_owned(),
            textures,
            vertices,
            lines,
            sides,
            sectors,
            things,
            segs: tree.segs,
            subsectors: tree.subsectors,
            nodes: tree.nodes,
            blockmap,
            locator,
            tags,
        })
    }
}

/// Texture names in order of first mention.
#[derive(Default)]
struct Names {
    list: Vec<TextureName>,
    index: BTreeMap<TextureName, u32>,
}

impl Names {
    fn intern(&mut self, name: TextureName) -> TextureId {
        let next = self.list.len() as u32;
        let id = *self.index.entry(name).or_insert(next);
        if id == next {
            self.list.push(name);
        }
        // Cut here, checked once in `finish`.
        TextureId(id as u16)
    }

    fn optional(&mut self, name: TextureName) -> Option<TextureId> {
        name.is_some().then(|| self.intern(name))
    }

    fn finish(self) -> Result<Vec<TextureName>, MapError> {
        if self.list.len() > ELEMENT_LIMIT {
            return Err(MapError::TooMany {
                what: "texture names",
                count: self.list.len(),
                limit: ELEMENT_LIMIT,
            });
        }
        Ok(self.list)
    }
}

fn check_counts(source: &MapSource) -> Result<(), MapError> {
    for (what, count) in [
        ("vertices", source.vertices.len()),
        ("linedefs", source.lines.len()),
        ("sidedefs", source.sides.len()),
        ("sectors", source.sectors.len()),
    ] {
        if count == 0 {
            return Err(MapError::Missing { what });
        }
        // Two sides a line.
        let limit = if what == "sidedefs" { 2 * ELEMENT_LIMIT } else { ELEMENT_LIMIT };
        if count > limit {
            return Err(MapError::TooMany { what, count, limit });
        }
    }
    if source.things.len() > ELEMENT_LIMIT {
        return Err(MapError::TooMany {
            what: "things",
            count: source.things.len(),
            limit: ELEMENT_LIMIT,
        });
    }
    Ok(())
}

fn coordinate(
    element: &'static str,
    index: usize,
    field: &'static str,
    value: f64,
) -> Result<Fixed, MapError> {
    if value.abs() <= f64::from(COORDINATE_LIMIT) {
        Ok(Fixed::from_f64(value))
    } else {
        Err(MapError::Range {
            element,
            index,
            field,
            value: value.to_string(),
            limit: COORDINATE_LIMIT,
        })
    }
}

fn whole(
    element: &'static str,
    index: usize,
    field: &'static str,
    value: i32,
    limit: i32,
) -> Result<i32, MapError> {
    if (-limit..=limit).contains(&value) {
        Ok(value)
    } else {
        Err(MapError::Range { element, index, field, value: value.to_string(), limit })
    }
}

fn reference(
    element: &'static str,
    index: usize,
    field: &'static str,
    refers_to: usize,
    count: usize,
) -> Result<usize, MapError> {
    if refers_to < count {
        Ok(refers_to)
    } else {
        Err(MapError::Index { element, index, field, refers_to, count })
    }
}

fn build_sides(source: &MapSource, names: &mut Names) -> Result<Vec<Side>, MapError> {
    let convert = |(i, side): (usize, &super::SourceSide)| {
        let sector = reference("sidedef", i, "sector", side.sector, source.sectors.len())?;
        Ok(Side {
            sector: SectorId(sector as u32),
            offset_x: coordinate("sidedef", i, "offsetx", side.offset_x)?,
            offset_y: coordinate("sidedef", i, "offsety", side.offset_y)?,
            top: names.optional(side.top),
            middle: names.optional(side.middle),
            bottom: names.optional(side.bottom),
        })
    };
    source.sides.iter().enumerate().map(convert).collect()
}

/// The lines that have a length: those of none are left away, as other loaders do. Lines that share
/// a side get one each, as the world may change it for one of them alone.
fn build_lines(
    source: &MapSource,
    vertices: &[Vertex],
    sides: &mut Vec<Side>,
) -> Result<Vec<Line>, MapError> {
    let mut side_used = vec![false; sides.len()];
    let mut lines = Vec::with_capacity(source.lines.len());
    for (i, line) in source.lines.iter().enumerate() {
        let v1 = vertices[reference("linedef", i, "v1", line.v1, vertices.len())?];
        let v2 = vertices[reference("linedef", i, "v2", line.v2, vertices.len())?];
        let front = reference("linedef", i, "sidefront", line.front, source.sides.len())?;
        let back = line
            .back
            .map(|back| reference("linedef", i, "sideback", back, source.sides.len()))
            .transpose()?;
        if v1 == v2 {
            continue;
        }
        let mut own = |side: usize| {
            if !std::mem::replace(&mut side_used[side], true) {
                return side;
            }
            sides.push(sides[side]);
            sides.len() - 1
        };
        let (front, back) = (own(front), back.map(own));
        lines.push(Line {
            v1,
            v2,
            dx: v2.x - v1.x,
            dy: v2.y - v1.y,
            bounds: [v1.x.min(v2.x), v1.x.max(v2.x), v1.y.min(v2.y), v1.y.max(v2.y)],
            flags: LineFlags {
                blocking: line.blocking,
                blocks: line.blocks,
                upper_unpegged: line.upper_unpegged,
                lower_unpegged: line.lower_unpegged,
            },
            front: SideId(front as u32),
            back: back.map(|back| SideId(back as u32)),
            front_sector: sides[front].sector,
            back_sector: back.map(|back| sides[back].sector),
            id: line.id,
            special: line.special,
            args: line.args,
        });
    }
    if lines.is_empty() {
        return Err(MapError::Missing { what: "linedef with a length" });
    }
    Ok(lines)
}

fn build_sectors(source: &MapSource, names: &mut Names) -> Result<Vec<Sector>, MapError> {
    let convert = |(i, sector): (usize, &super::SourceSector)| {
        let height =
            |field, value| whole("sector", i, field, value, COORDINATE_LIMIT).map(Fixed::from_int);
        Ok(Sector {
            floor: height("heightfloor", sector.floor)?,
            ceiling: height("heightceiling", sector.ceiling)?,
            floor_texture: names.intern(sector.floor_texture),
            ceiling_texture: names.intern(sector.ceiling_texture),
            light: whole("sector", i, "lightlevel", sector.light, LIGHT_LIMIT)? as i16,
            // Those of an older game mean something else.
            special: if special::are_of(&source.namespace) { sector.special } else { 0 },
            tag: sector.tag,
            bounds: [Fixed::MAX, Fixed::MIN, Fixed::MAX, Fixed::MIN],
            lines: Vec::new(),
        })
    };
    source.sectors.iter().enumerate().map(convert).collect()
}

fn join_sectors_and_lines(sectors: &mut [Sector], lines: &[Line]) {
    for (i, line) in lines.iter().enumerate() {
        let back = line.back_sector.filter(|&back| back != line.front_sector);
        for id in [Some(line.front_sector), back].into_iter().flatten() {
            let sector = &mut sectors[id.0 as usize];
            sector.lines.push(i as u32);
            sector.bounds = [
                sector.bounds[0].min(line.bounds[0]),
                sector.bounds[1].max(line.bounds[1]),
                sector.bounds[2].min(line.bounds[2]),
                sector.bounds[3].max(line.bounds[3]),
            ];
        }
    }
    // One that no line faces lies nowhere.
    sectors
        .iter_mut()
        .filter(|sector| sector.lines.is_empty())
        .for_each(|sector| sector.bounds = [Fixed::ZERO; 4]);
}

/// Every vertex must end as many of a sector's outlines as it begins: walking with the sector on
/// the right, what comes in goes out.
fn check_closed(source: &MapSource, sector_count: usize) -> Result<(), MapError> {
    let mut balance: Vec<BTreeMap<usize, i32>> = vec![BTreeMap::new(); sector_count];
    // Vertices at one place are one, whatever their indices.
    let mut first_at: BTreeMap<(i64, i64), usize> = BTreeMap::new();
    let places: Vec<usize> = source
        .vertices
        .iter()
        .enumerate()
        .map(|(i, v)| {
            let raw = (i64::from(Fixed::from_f64(v.x).0), i64::from(Fixed::from_f64(v.y).0));
            *first_at.entry(raw).or_insert(i)
        })
        .collect();
    for line in &source.lines {
        let (v1, v2) = (places[line.v1], places[line.v2]);
        let mut walk = |side: usize, from: usize, to: usize| {
            let sector = &mut balance[source.sides[side].sector];
            *sector.entry(from).or_insert(0) += 1;
            *sector.entry(to).or_insert(0) -= 1;
        };
        walk(line.front, v1, v2);
        if let Some(back) = line.back {
            walk(back, v2, v1);
        }
    }
    for (sector, vertices) in balance.iter().enumerate() {
        if let Some((&vertex, _)) = vertices.iter().find(|&(_, &count)| count != 0) {
            return Err(MapError::Unclosed { sector, vertex });
        }
    }
    Ok(())
}

fn build_things(source: &MapSource) -> Result<Vec<MapThing>, MapError> {
    let convert = |(i, thing): (usize, &super::SourceThing)| {
        Ok(MapThing {
            x: coordinate("thing", i, "x", thing.x)?,
            y: coordinate("thing", i, "y", thing.y)?,
            height: coordinate("thing", i, "height", thing.height)?,
            angle: Angle::from_degrees(f64::from(thing.angle.rem_euclid(360))),
            kind: thing.kind,
            id: thing.id,
            args: thing.args,
        })
    };
    source.things.iter().enumerate().map(convert).collect()
}
