//! Authoring a map in Rust: paint polygons over each other, mark stretches of wall, put things, and
//! get the source.
//!
//! Later polygons cover earlier ones, as paper on a table. What is left visible of each becomes its
//! sector; where two sectors meet there is a two-sided line, where one meets nothing there is a
//! wall.
//!
//! Long because it is the whole vocabulary for drawing maps, which one reads as a page.

use super::arrangement::{self, Owner, POINTS_PER_UNIT, Piece, Point, Regions};
use super::{
    MapSource, SourceLine, SourceSector, SourceSide, SourceThing, SourceVertex, TextureName,
};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// How a polygon's sector looks and behaves.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Style {
    /// Floor height, map units.
    pub floor: i32,
    /// Ceiling height, map units.
    pub ceiling: i32,
    /// Light, 0..=255.
    pub light: i32,
    /// Floor texture.
    pub floor_texture: &'static str,
    /// Ceiling texture; `F_SKY1` is the sky.
    pub ceiling_texture: &'static str,
    /// Walls around it, where nothing is behind.
    pub wall: &'static str,
    /// Its own flank, as seen from a neighbour with a lower floor.
    pub step: &'static str,
    /// The face above it, as seen from a neighbour with a higher ceiling.
    pub lintel: &'static str,
    /// Sector special.
    pub special: i32,
    /// Tag, 0 for none. Polygons with a tag never share a sector.
    pub tag: i32,
}

/// What is different about a stretch of line; `None` leaves what the neighbouring sectors say.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Mark {
    /// Instead of [`Style::wall`].
    pub wall: Option<&'static str>,
    /// Masked texture in the opening of a two-sided line.
    pub middle: Option<&'static str>,
    /// Instead of [`Style::step`].
    pub step: Option<&'static str>,
    /// Instead of [`Style::lintel`].
    pub lintel: Option<&'static str>,
    /// Stops every walker. Also keeps the line where it parts no two sectors.
    pub blocking: bool,
    /// Keeps the line where it parts no two sectors. Nothing of it is seen, but slides of bodies
    /// know it.
    pub kept: bool,
    /// The wall texture stands on the floor, or the lower texture hangs from the higher ceiling.
    pub lower_unpegged: bool,
    /// The upper texture hangs from the higher ceiling.
    pub upper_unpegged: bool,
    /// Texture offset right and down; the horizontal one replaces the automatic alignment.
    pub offset: Option<(i32, i32)>,
}

/// Why an authored map does not come together.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum BuilderError {
    /// A polygon or path has fewer points than it needs.
    TooFewPoints {
        /// Which one, counted over polygons and marks in the order drawn.
        index: usize,
    },
    /// The edges could not be cut into a clean arrangement.
    Tangled,
    /// A blocking or see-through line lies where there is no sector at all.
    MarkInVoid {
        /// A point on it, map units.
        at: (i64, i64),
    },
}

impl fmt::Display for BuilderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BuilderError::TooFewPoints { index } => write!(f, "shape {index} has too few points"),
            BuilderError::Tangled => {
                f.write_str("the outlines meet at angles too sharp to be cut cleanly")
            }
            BuilderError::MarkInVoid { at } => {
                write!(f, "the line at {at:?} has no sector on either side")
            }
        }
    }
}

impl std::error::Error for BuilderError {}

/// What a polygon does to what lies under it.
#[derive(Clone, Copy, Debug)]
enum Paint {
    /// Covers it with the sector of this index in [`MapBuilder::sectors`].
    Sector(usize),
    /// Covers it with solid rock.
    Rock,
    /// Leaves it and changes its light.
    Light(i32),
}

/// A sector to be: a style, and the light that shade gives it.
type Region = (usize, Option<i32>);

/// Collects polygons, marks and things.
#[derive(Clone, Debug, Default)]
pub struct MapBuilder {
    polygons: Vec<(Paint, Vec<Point>)>,
    sectors: Vec<Style>,
    marks: Vec<(Mark, Vec<Point>)>,
    things: Vec<SourceThing>,
}

impl MapBuilder {
    /// An empty map.
    #[must_use]
    pub fn new() -> MapBuilder {
        MapBuilder::default()
    }

    /// Paints a polygon, given by its corners in map units, in either direction. Untagged polygons
    /// of equal style share a sector, so that no line runs between two that touch.
    pub fn polygon(&mut self, style: Style, corners: &[(i32, i32)]) -> &mut MapBuilder {
        let shared = self.sectors.iter().position(|&other| style.tag == 0 && other == style);
        let sector = shared.unwrap_or_else(|| {
            self.sectors.push(style);
            self.sectors.len() - 1
        });
        self.polygons.push((Paint::Sector(sector), points(corners)));
        self
    }

    /// Paints the rectangle from (`west`, `south`) to (`east`, `north`).
    pub fn rectangle(
        &mut self,
        style: Style,
        west: i32,
        south: i32,
        east: i32,
        north: i32,
    ) -> &mut MapBuilder {
        self.polygon(style, &[(west, south), (east, south), (east, north), (west, north)])
    }

    /// Carves solid rock: a pillar, a wall, a house without inside.
    pub fn solid(&mut self, corners: &[(i32, i32)]) -> &mut MapBuilder {
        self.polygons.push((Paint::Rock, points(corners)));
        self
    }

    /// Gives everything painted so far inside the polygon another light: a shadow, a pool of
    /// lamplight.
    pub fn shade(&mut self, light: i32, corners: &[(i32, i32)]) -> &mut MapBuilder {
        self.polygons.push((Paint::Light(light), points(corners)));
        self
    }

    /// Marks every line that comes to lie along the path. A later mark wins over an earlier one.
    pub fn mark(&mut self, mark: Mark, path: &[(i32, i32)]) -> &mut MapBuilder {
        self.marks.push((mark, points(path)));
        self
    }

    /// Puts a thing of editor number `kind`, facing `angle` degrees.
    pub fn thing(&mut self, kind: i32, x: f64, y: f64, angle: i32) -> &mut MapBuilder {
        self.things.push(SourceThing { x, y, angle, kind, ..SourceThing::default() });
        self
    }

    /// Puts a thing with every field chosen.
    pub fn thing_with(&mut self, thing: SourceThing) -> &mut MapBuilder {
        self.things.push(thing);
        self
    }

    /// Cuts everything into lines and sectors.
    ///
    /// # Errors
    /// Where shapes are degenerate or cannot be cut apart.
    pub fn finish(&self) -> Result<MapSource, BuilderError> {
        let pieces = self.arrange()?;
        let regions = Regions::new(&pieces, self.polygons.len());
        let region_at = |a, b, left| -> Option<Region> {
            let (mut light, mut region) = (None, None);
            regions.beside(a, b, left, |polygon| {
                match self.polygons[polygon].0 {
                    Paint::Sector(sector) => region = Some((sector, light)),
                    Paint::Rock => {}
                    Paint::Light(shade) => {
                        light = light.or(Some(shade));
                        return false;
                    }
                }
                true
            });
            // Shade of the light that is there already makes no border.
            region.map(|(sector, light)| {
                (sector, light.filter(|&light| light != self.sectors[sector].light))
            })
        };
        let mut edges = Vec::new();
        for piece in &pieces {
            let marks = || {
                piece.owners.iter().rev().filter_map(|owner| match *owner {
                    Owner::Mark(mark) => Some(mark),
                    Owner::Polygon(_) => None,
                })
            };
            // Textures run on past a line that is only kept.
            let mark =
                marks().find(|&mark| self.marks[mark].0 != Mark { kept: true, ..Mark::default() });
            let keep = marks().any(|mark| self.marks[mark].0.kept)
                || mark.is_some_and(|mark| {
                    self.marks[mark].0.blocking || self.marks[mark].0.middle.is_some()
                });
            let (right, left) =
                (region_at(piece.a, piece.b, false), region_at(piece.a, piece.b, true));
            match (right, left) {
                (None, None) if keep => {
                    return Err(BuilderError::MarkInVoid {
                        at: (piece.a.0 / POINTS_PER_UNIT, piece.a.1 / POINTS_PER_UNIT),
                    });
                }
                (right, left) if right == left && !keep => {}
                (Some(front), back) => {
                    edges.push(Edge { a: piece.a, b: piece.b, front, back, mark })
                }
                (None, Some(front)) => {
                    edges.push(Edge { a: piece.b, b: piece.a, front, back: None, mark })
                }
                (None, None) => {}
            }
        }
        join_straight(&mut edges);
        Ok(self.write(&edges))
    }

    fn arrange(&self) -> Result<Vec<Piece>, BuilderError> {
        let mut edges = Vec::new();
        for (index, (_, corners)) in self.polygons.iter().enumerate() {
            if corners.len() < 3 {
                return Err(BuilderError::TooFewPoints { index });
            }
            for (i, &corner) in corners.iter().enumerate() {
                edges.push((corner, corners[(i + 1) % corners.len()], Owner::Polygon(index)));
            }
        }
        for (index, (_, path)) in self.marks.iter().enumerate() {
            if path.len() < 2 {
                return Err(BuilderError::TooFewPoints { index: self.polygons.len() + index });
            }
            edges.extend(path.windows(2).map(|ends| (ends[0], ends[1], Owner::Mark(index))));
        }
        arrangement::cut(edges.into_iter()).ok_or(BuilderError::Tangled)
    }

    fn write(&self, edges: &[Edge]) -> MapSource {
        let mut source = MapSource {
            namespace: "zdoom".to_owned(),
            things: self.things.clone(),
            ..Default::default()
        };
        // In order of painting; what was painted over completely has no line and is left out.
        let used: BTreeSet<Region> =
            edges.iter().flat_map(|edge| [Some(edge.front), edge.back]).flatten().collect();
        let mut numbers: BTreeMap<Region, usize> = BTreeMap::new();
        for region in used {
            numbers.insert(region, source.sectors.len());
            source.sectors.push(sector_of(&self.sectors[region.0], region.1));
        }
        let mut vertices: BTreeMap<Point, usize> = BTreeMap::new();
        let offsets = self.align(edges);
        for (edge, offset) in edges.iter().zip(offsets) {
            let [v1, v2] = [edge.a, edge.b].map(|(x, y)| {
                *vertices.entry((x, y)).or_insert_with(|| {
                    let scale = POINTS_PER_UNIT as f64;
                    source.vertices.push(SourceVertex { x: x as f64 / scale, y: y as f64 / scale });
                    source.vertices.len() - 1
                })
            });
            let mark = self.mark_of(edge);
            let front = source.sides.len();
            source.sides.push(self.side(
                edge.front,
                edge.back,
                &mark,
                numbers[&edge.front],
                offset[0],
            ));
            if let Some(back) = edge.back {
                source.sides.push(self.side(
                    back,
                    Some(edge.front),
                    &mark,
                    numbers[&back],
                    offset[1],
                ));
            }
            source.lines.push(SourceLine {
                v1,
                v2,
                front,
                back: edge.back.map(|_| front + 1),
                blocking: mark.blocking,
                upper_unpegged: mark.upper_unpegged,
                lower_unpegged: mark.lower_unpegged,
                ..SourceLine::default()
            });
        }
        source
    }

    fn mark_of(&self, edge: &Edge) -> Mark {
        edge.mark.map(|mark| self.marks[mark].0).unwrap_or_default()
    }

    fn side(
        &self,
        facing: Region,
        behind: Option<Region>,
        mark: &Mark,
        sector: usize,
        run: i64,
    ) -> SourceSide {
        let name = |own: Option<&'static str>, default| TextureName::new(own.unwrap_or(default));
        let (offset_x, offset_y) =
            mark.offset.map_or((run as f64, 0.0), |(x, y)| (f64::from(x), f64::from(y)));
        let mut side = SourceSide { sector, offset_x, offset_y, ..SourceSide::default() };
        let facing = &self.sectors[facing.0];
        match behind.map(|behind| &self.sectors[behind.0]) {
            None => side.middle = name(mark.wall, facing.wall),
            Some(behind) => {
                side.bottom = name(mark.step, behind.step);
                let open_sky =
                    [behind, facing].iter().all(|style| style.ceiling_texture == "F_SKY1");
                if !open_sky {
                    side.top = name(mark.lintel, behind.lintel);
                }
                side.middle = name(mark.middle, "-");
            }
        }
        side
    }

    /// How far along its run of equal lines each side begins, front and back, so that a texture
    /// goes around corners without a seam.
    fn align(&self, edges: &[Edge]) -> Vec<[i64; 2]> {
        // A face is (edge, is back); faces of one run have equal keys and end where the next
        // begins. A wall seen from here and there looks the same if the styles' looks and the marks
        // do, whatever the light.
        type Key = (Style, Option<Style>, Option<usize>);
        let looks = |region: Region| only_looks(self.sectors[region.0]);
        let key = |edge: &Edge, back: bool| -> Key {
            let (facing, behind) = match edge.back {
                Some(other) if back => (other, Some(edge.front)),
                other => (edge.front, other),
            };
            (looks(facing), behind.map(looks), edge.mark)
        };
        let ends = |edge: &Edge, back: bool| if back { (edge.b, edge.a) } else { (edge.a, edge.b) };
        let faces: Vec<(usize, bool)> = edges
            .iter()
            .enumerate()
            .flat_map(|(i, edge)| std::iter::once((i, false)).chain(edge.back.map(|_| (i, true))))
            .collect();
        let mut starting: BTreeMap<Point, Vec<(usize, bool)>> = BTreeMap::new();
        let mut ending: BTreeMap<Point, Vec<(usize, bool)>> = BTreeMap::new();
        for &(i, back) in &faces {
            let (from, to) = ends(&edges[i], back);
            starting.entry(from).or_default().push((i, back));
            ending.entry(to).or_default().push((i, back));
        }
        let mut offsets: Vec<[Option<i64>; 2]> = vec![[None; 2]; edges.len()];
        let has_predecessor = |&(i, back): &(usize, bool)| {
            let from = ends(&edges[i], back).0;
            ending.get(&from).is_some_and(|list| {
                list.iter().any(|&(j, other)| {
                    (j, other) != (i, back) && key(&edges[j], other) == key(&edges[i], back)
                })
            })
        };
        // Runs with a beginning first, then closed loops from wherever.
        let (loops, beginnings): (Vec<_>, Vec<_>) =
            faces.iter().copied().partition(has_predecessor);
        for start in beginnings.into_iter().chain(loops) {
            let (mut run, mut face) = (0.0, Some(start));
            while let Some((i, back)) =
                face.filter(|&(i, back)| offsets[i][usize::from(back)].is_none())
            {
                offsets[i][usize::from(back)] = Some((run as i64) % 4096);
                run += edges[i].length();
                let to = ends(&edges[i], back).1;
                face = starting.get(&to).and_then(|list| {
                    list.iter().copied().find(|&(j, other)| {
                        offsets[j][usize::from(other)].is_none()
                            && key(&edges[j], other) == key(&edges[i], back)
                    })
                });
            }
        }
        offsets.into_iter().map(|pair| pair.map(|offset| offset.unwrap_or(0))).collect()
    }
}

/// A line to be.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Edge {
    a: Point,
    b: Point,
    front: Region,
    back: Option<Region>,
    mark: Option<usize>,
}

impl Edge {
    /// Length in map units.
    fn length(&self) -> f64 {
        let (dx, dy) = (self.b.0 - self.a.0, self.b.1 - self.a.1);
        ((dx * dx + dy * dy) as f64).sqrt() / POINTS_PER_UNIT as f64
    }
}

/// Style reduced to what a face behind shows, so that runs go on past changes of height or tag.
fn only_looks(style: Style) -> Style {
    Style {
        floor: 0,
        ceiling: 0,
        light: 0,
        special: 0,
        tag: 0,
        floor_texture: "",
        ceiling_texture: "",
        ..style
    }
}

fn points(corners: &[(i32, i32)]) -> Vec<Point> {
    corners
        .iter()
        .map(|&(x, y)| (i64::from(x) * POINTS_PER_UNIT, i64::from(y) * POINTS_PER_UNIT))
        .collect()
}

fn sector_of(style: &Style, shade: Option<i32>) -> SourceSector {
    SourceSector {
        floor: style.floor,
        ceiling: style.ceiling,
        floor_texture: TextureName::new(style.floor_texture),
        ceiling_texture: TextureName::new(style.ceiling_texture),
        light: shade.unwrap_or(style.light),
        special: style.special,
        tag: style.tag,
    }
}

/// Joins pairs of edges that go straight on through a point where nothing else ends: cuts that
/// covered outlines left.
fn join_straight(edges: &mut Vec<Edge>) {
    let mut at: BTreeMap<Point, Vec<usize>> = BTreeMap::new();
    for (i, edge) in edges.iter().enumerate() {
        at.entry(edge.a).or_default().push(i);
        at.entry(edge.b).or_default().push(i);
    }
    // `moved[i]` is the edge that took edge i in.
    let mut moved: Vec<usize> = (0..edges.len()).collect();
    for (&point, list) in &at {
        let &[i, j] = list.as_slice() else { continue };
        let (i, j) = (find(&moved, i), find(&moved, j));
        let (p, q) = (edges[i], edges[j]);
        if i == j || (p.front, p.back, p.mark) != (q.front, q.back, q.mark) {
            continue;
        }
        let (first, second) = if p.b == point && q.a == point {
            (p, q)
        } else if q.b == point && p.a == point {
            (q, p)
        } else {
            continue;
        };
        let (dx, dy) = (first.b.0 - first.a.0, first.b.1 - first.a.1);
        let (ex, ey) = (second.b.0 - second.a.0, second.b.1 - second.a.1);
        if dx * ey == dy * ex && dx * ex + dy * ey > 0 {
            edges[i] = Edge { a: first.a, b: second.b, ..p };
            moved[j] = i;
        }
    }
    let mut index = 0;
    edges.retain(|_| {
        index += 1;
        moved[index - 1] == index - 1
    });
}

fn find(moved: &[usize], mut i: usize) -> usize {
    while moved[i] != i {
        i = moved[i];
    }
    i
}
