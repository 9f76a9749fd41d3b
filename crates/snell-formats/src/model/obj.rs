//! Wavefront OBJ: vertices, texture coordinates, faces and the names of their materials.

use super::polygon::Polygons;
use super::{Model, not_drawn};
use crate::report::{Report, Source};
use crate::words::{Word, number, words};
use snell::geometry::{NO_UVS, Vec3};
use snell::scene::WarningCode;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// Keywords that say nothing about the surface as Snell draws it: names of parts and groups of smoothing, which is the scene's
/// own.
const IGNORED: &[&str] = &["o", "g", "s", "mg", "usemap", "maplib", "shadow_obj", "trace_obj"];

/// Keywords of what is not drawn, with its name.
const NOT_DRAWN: &[(&str, &str)] = &[
    ("l", "lines (`l`)"),
    ("p", "points (`p`)"),
    ("vp", "curves and free-form surfaces"),
    ("cstype", "curves and free-form surfaces"),
    ("deg", "curves and free-form surfaces"),
    ("curv", "curves and free-form surfaces"),
    ("curv2", "curves and free-form surfaces"),
    ("surf", "curves and free-form surfaces"),
    ("parm", "curves and free-form surfaces"),
    ("trim", "curves and free-form surfaces"),
    ("end", "curves and free-form surfaces"),
];

/// So many unknown keywords are named; a file of the wrong kind has thousands.
const NAMED: usize = 5;

/// Reads an OBJ file. Polygons become triangles. A face has texture coordinates if each of its corners has; of `vt u v w`
/// the third number is not kept.
///
/// # Errors
/// A number that is none, an index of a vertex out of range, a face with fewer than three corners.
pub fn parse_obj(source: &Source) -> Result<Model, Report> {
    let mut reader = Reader {
        source,
        model: Model::default(),
        slots: HashMap::new(),
        slot: None,
        later: Vec::new(),
        corners: Vec::new(),
        corner_uvs: Vec::new(),
        ends: Vec::new(),
        unknown: HashSet::new(),
        not_drawn: Vec::new(),
        libraries: HashSet::new(),
    };
    let mut start = 0;
    let mut line: Vec<Word<'_>> = Vec::new();
    for physical in source.text.split_inclusive('\n') {
        let content = physical.split('#').next().unwrap_or_default().trim_end();
        // A backslash at the end joins a line with the next; one in a comment does not.
        let joined = content.strip_suffix('\\');
        line.extend(words(joined.unwrap_or(content), start));
        start += physical.len();
        if joined.is_none() || start == source.text.len() {
            if let Some((keyword, rest)) = line.split_first() {
                reader.line(keyword, rest)?;
            }
            line.clear();
        }
    }
    reader.finish()
}

struct Reader<'a> {
    source: &'a Source,
    model: Model,
    slots: HashMap<String, u32>,
    /// Slot of the current `usemtl`.
    slot: Option<u32>,
    /// What a face named before it came, to be checked at the end, and by which corner.
    later: Vec<(Kind, u32, Range<usize>, usize)>,
    /// Corners of all polygons, and where each ends, with its slot. They become triangles when all vertices are there.
    corners: Vec<u32>,
    /// The texture coordinates of each corner, or [`NO_UV`].
    corner_uvs: Vec<u32>,
    ends: Vec<(usize, u32)>,
    unknown: HashSet<String>,
    not_drawn: Vec<&'static str>,
    libraries: HashSet<String>,
}

/// What corners of faces name by numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Vertex,
    Uv,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Uv => "`vt`",
        }
    }
}

/// Of a corner without texture coordinates.
const NO_UV: u32 = NO_UVS[0];

impl Reader<'_> {
    fn error(&self, word: &Word<'_>, message: String) -> Report {
        Report::error(message).at(self.source, word.range.clone())
    }

    fn line(&mut self, keyword: &Word<'_>, rest: &[Word<'_>]) -> Result<(), Report> {
        match keyword.text {
            "v" => self.vertex(keyword, rest),
            "vt" => self.uv(keyword, rest),
            "f" | "fo" => self.face(keyword, rest),
            "usemtl" => {
                self.use_material(&joined(self.source, rest));
                Ok(())
            }
            "mtllib" => {
                let name = joined(self.source, rest);
                if self.libraries.insert(name.clone()) {
                    self.model.libraries.push(name);
                }
                Ok(())
            }
            "vn" => {
                self.model.has_normals = true;
                Ok(())
            }
            word if IGNORED.contains(&word) => Ok(()),
            word => {
                match NOT_DRAWN.iter().find(|(known, _)| *known == word) {
                    Some((_, what)) if self.not_drawn.contains(what) => {}
                    Some((_, what)) => self.not_drawn.push(what),
                    None => self.unknown_keyword(keyword),
                }
                Ok(())
            }
        }
    }

    fn unknown_keyword(&mut self, keyword: &Word<'_>) {
        if self.unknown.insert(keyword.text.to_owned()) && self.unknown.len() <= NAMED {
            let message = format!("unknown keyword `{}` in a model: such lines are ignored", keyword.text);
            let report = Report::warning(WarningCode::UnknownKeyword, message);
            self.model.warnings.push(report.at(self.source, keyword.range.clone()));
        }
    }

    fn vertex(&mut self, keyword: &Word<'_>, rest: &[Word<'_>]) -> Result<(), Report> {
        let [x, y, z, ..] = rest else {
            return Err(self.error(keyword, format!("`v` takes 3 numbers, read {}", rest.len())));
        };
        let vertex = Vec3::new(self.coordinate(x)?, self.coordinate(y)?, self.coordinate(z)?);
        self.model.mesh.vertices.push(vertex);
        Ok(())
    }

    fn uv(&mut self, keyword: &Word<'_>, rest: &[Word<'_>]) -> Result<(), Report> {
        let Some(u) = rest.first() else {
            return Err(self.error(keyword, "`vt` takes 1 to 3 numbers, read 0".to_owned()));
        };
        // Of a texture that is a line `v` is left out.
        let v = rest.get(1).map_or(Ok(0.0), |v| self.coordinate(v))?;
        self.model.mesh.uvs.push([self.coordinate(u)?, v]);
        Ok(())
    }

    fn coordinate(&self, word: &Word<'_>) -> Result<f64, Report> {
        number(word).ok_or_else(|| self.error(word, format!("expected a number, read `{}`", word.text)))
    }

    fn use_material(&mut self, name: &str) {
        let next = self.slots.len() as u32;
        let slot = *self.slots.entry(name.to_owned()).or_insert(next);
        if slot == next {
            self.model.mesh.slots.push(name.to_owned());
        }
        self.slot = Some(slot);
    }

    fn face(&mut self, keyword: &Word<'_>, rest: &[Word<'_>]) -> Result<(), Report> {
        if rest.len() < 3 {
            return Err(self.error(keyword, format!("a face has at least 3 corners, read {}", rest.len())));
        }
        for word in rest {
            // A corner is `a`, `a/b`, `a//c` or `a/b/c`.
            let mut parts = word.text.split('/');
            let vertex = self.index(Kind::Vertex, parts.next().unwrap_or_default(), word)?;
            let uv = match parts.next() {
                None | Some("") => NO_UV,
                Some(text) => self.index(Kind::Uv, text, word)?,
            };
            self.corners.push(vertex);
            self.corner_uvs.push(uv);
        }
        if self.slot.is_none() {
            self.use_material("");
        }
        let slot = self.slot.unwrap_or(0);
        self.ends.push((self.corners.len(), slot));
        Ok(())
    }

    fn count(&self, kind: Kind) -> usize {
        match kind {
            Kind::Vertex => self.model.mesh.vertices.len(),
            Kind::Uv => self.model.mesh.uvs.len(),
        }
    }

    /// A number in a corner: counted from 1, or from the end if negative.
    fn index(&mut self, kind: Kind, text: &str, word: &Word<'_>) -> Result<u32, Report> {
        let count = self.count(kind) as i64;
        let Ok(index) = text.parse::<i64>() else {
            let message = format!("expected the number of a {}, read `{}`", kind.name(), word.text);
            return Err(self.error(word, message));
        };
        let from_zero = if index < 0 { count.saturating_add(index) } else { index - 1 };
        match u32::try_from(from_zero) {
            Ok(number) if from_zero < count => Ok(number),
            // A vertex may come after the face that names it.
            Ok(number) if index > 0 => {
                self.later.push((kind, number, word.range.clone(), self.corners.len()));
                Ok(number)
            }
            _ => {
                let report = self.out_of_range(kind, index, word.range.clone());
                match kind {
                    Kind::Vertex => Err(report),
                    Kind::Uv => {
                        self.model.lost_uv.get_or_insert(report);
                        Ok(NO_UV)
                    }
                }
            }
        }
    }

    fn out_of_range(&self, kind: Kind, index: i64, range: Range<usize>) -> Report {
        let (count, name) = (self.count(kind), kind.name());
        let so_far = if index <= 0 { " so far" } else { "" };
        let help = match kind {
            Kind::Vertex => "vertices are counted from 1, or backwards from -1, the latest",
            Kind::Uv => {
                "lines `vt` are counted from 1, or backwards from -1, the latest; a corner without is `1` or `1//1`"
            }
        };
        Report::error(format!("there is no {name} {index}: the file has {count}{so_far}"))
            .at(self.source, range)
            .help(help)
    }

    fn finish(mut self) -> Result<Model, Report> {
        for (kind, number, range, corner) in std::mem::take(&mut self.later) {
            if (number as usize) < self.count(kind) {
                continue;
            }
            let report = self.out_of_range(kind, i64::from(number) + 1, range);
            match kind {
                Kind::Vertex => return Err(report),
                Kind::Uv => {
                    self.model.lost_uv.get_or_insert(report);
                    self.corner_uvs[corner] = NO_UV;
                }
            }
        }
        let textured = self.corner_uvs.iter().any(|&uv| uv != NO_UV);
        let mut polygons = Polygons::default();
        let mut start = 0;
        for &(end, slot) in &self.ends {
            let (corners, uvs) = (&self.corners[start..end], &self.corner_uvs[start..end]);
            let triangles = polygons.places(corners, &self.model.mesh.vertices);
            self.model.mesh.face_slots.extend(triangles.iter().map(|_| slot));
            self.model.mesh.faces.extend(triangles.iter().map(|t| t.map(|i| corners[i as usize])));
            if textured {
                let whole = !uvs.contains(&NO_UV);
                let of = |t: &[u32; 3]| if whole { t.map(|i| uvs[i as usize]) } else { NO_UVS };
                self.model.mesh.face_uvs.extend(triangles.iter().map(of));
            }
            start = end;
        }
        if self.model.mesh.faces.is_empty() {
            let help = "is it an OBJ file? Its faces are lines that start with `f`";
            return Err(Report::error(format!("`{}` has no faces", self.source.name)).at(self.source, 0..0).help(help));
        }
        if self.unknown.len() > NAMED {
            let message = format!("{} more unknown keywords in a model", self.unknown.len() - NAMED);
            self.model.warnings.push(Report::warning(WarningCode::UnknownKeyword, message));
        }
        self.model.warnings.extend(not_drawn(&self.source.name, self.not_drawn));
        Ok(self.model)
    }
}

/// The words as one name, with the spaces between them.
fn joined(source: &Source, words: &[Word<'_>]) -> String {
    match (words.first(), words.last()) {
        (Some(first), Some(last)) => source.text[first.range.start..last.range.end].to_owned(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str) -> Model {
        parse_obj(&Source::new("m.obj", text)).unwrap()
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn every_form_of_a_face() {
        for face in [
            "1 2 3 4",
            "1/1 2/1 3/1 4/1",
            "1/ 2/ 3/ 4/",
            "1//9 2//9 3//9 4//9",
            "1/1/9 2/1/9 3/1/9 4/1/9",
            "-4 -3 -2 -1",
            "1 2 \\\n 3 4",
            "1 2\\\n3 4 # a comment joins nothing \\",
        ] {
            assert_eq!(read(&format!("{SQUARE}vt 0\nf {face}")).mesh.faces, [[0, 1, 2], [0, 2, 3]], "{face}");
        }
        assert_eq!(read(&format!("# C:\\models\\\n{SQUARE}f 1 2 3")).mesh.vertices.len(), 4, "a comment joins nothing");
        assert_eq!(read(&format!("f 1 2 3\n{SQUARE}")).mesh.faces, [[0, 1, 2]], "vertices may come later");
    }

    #[test]
    fn faces_have_texture_coordinates_if_all_their_corners_have() {
        let text = format!("{SQUARE}vt .5 -1 7\nvt 2\nf 1/1 2/2 3/-1 4/4/1\nvt 3 3\nf 1/1 2 3/1\nvt 4 4\nf 1 2 3\n");
        let mesh = read(&text).mesh;
        assert_eq!(mesh.uvs, [[0.5, -1.0], [2.0, 0.0], [3.0, 3.0], [4.0, 4.0]]);
        assert_eq!(mesh.face_uvs, [[0, 1, 1], [0, 1, 3], NO_UVS, NO_UVS], "the fourth came after its face");
        assert_eq!(mesh.corner_uvs(1), Some([[0.5, -1.0], [2.0, 0.0], [4.0, 4.0]]));
        assert_eq!(mesh.corner_uvs(2), None);
        assert_eq!(read(&format!("{SQUARE}vt 1 1\nf 1 2 3\nf 1//1 2//1 3//1")).mesh.face_uvs, [[0; 3]; 0]);
    }

    /// Corners of a polygon that has one vertex twice, with another place on the texture each time.
    #[test]
    fn ears_keep_the_texture_of_their_corners() {
        // The arrow head of the test below, and around a slit to a hole that has no room.
        let vertices = "v 2 -1 0\nv 0 3 0\nv -2 -1 0\nv 0 0 0\nv 1 0 0\n";
        let uvs = "vt 1 0\nvt 2 0\nvt 3 0\nvt 4 0\nvt 5 0\nvt 6 0\n";
        let mesh = read(&format!("{vertices}{uvs}f 1/1 2/2 3/3 4/4 5/5 4/6\n")).mesh;
        let polygon = [0, 1, 2, 3, 4, 3];
        assert_eq!(mesh.faces.len(), 4);
        for (face, uvs) in mesh.faces.iter().zip(&mesh.face_uvs) {
            assert_eq!(
                uvs.map(|uv| polygon[uv as usize]),
                *face,
                "each vertex with a number that it has in the polygon"
            );
        }
        let used = |uv: u32| mesh.face_uvs.iter().flatten().any(|&u| u == uv);
        assert!((0..6).all(used), "{:?}", mesh.face_uvs);
    }

    #[test]
    fn materials_by_name_and_libraries_with_spaces() {
        let text = format!(
            "mtllib my lib.mtl\n{SQUARE}f 1 2 3\nusemtl a b\nf 1 2 3\nusemtl c\nf 1 2 3\nusemtl a b\nf 1 2 4 # x\n"
        );
        let model = read(&text);
        assert_eq!(model.libraries, ["my lib.mtl"]);
        assert_eq!(model.mesh.slots, ["", "a b", "c"]);
        assert_eq!(model.mesh.face_slots, [0, 1, 2, 1]);
    }

    #[test]
    fn a_concave_polygon_is_covered_once() {
        // An arrow head: the fan from its first corner would cover area outside it.
        let text = "v 0 0 0\nv 2 -1 0\nv 0 3 0\nv -2 -1 0\nf 2 3 4 1\nf 3 4 1 2\nf 4 1 2 3\nf 1 2 3 4\n";
        let mesh = read(text).mesh;
        let area = |f: usize| {
            let [a, b, c] = mesh.corners(f);
            (b - a).cross(c - a).z / 2.0
        };
        let (vertices, faces) = text.split_at(text.find('f').unwrap());
        assert_eq!(read(&format!("{faces}{vertices}")).mesh.faces, mesh.faces, "also before its vertices");
        // At 1e9 products of coordinates have lost the last hundred, ten times the area.
        let moved = mesh.vertices.iter().map(|v| format!("v {} {} 0\n", v.x + 1e9, v.y + 1e9));
        let far = read(&format!("{}{faces}", moved.collect::<String>()));
        assert_eq!(far.mesh.faces, mesh.faces, "also far from the origin");
        // Shoelace: 6. Every triangle counter-clockwise, and the areas of each polygon add up to it.
        for polygon in 0..4 {
            let areas = [area(2 * polygon), area(2 * polygon + 1)];
            assert!(areas.iter().all(|&a| a > 0.0) && areas[0] + areas[1] == 6.0, "{areas:?}");
        }
    }

    #[test]
    fn errors_name_the_place() {
        for (text, line, message) in [
            (format!("{SQUARE}f 1 2 5\n"), 5, "no vertex 5: the file has 4"),
            (format!("{SQUARE}f 1 2 0\n"), 5, "no vertex 0"),
            (format!("{SQUARE}f 1 2 -5\n"), 5, "no vertex -5"),
            (format!("{SQUARE}f 1 2 99999999999999999999\n"), 5, "number of a vertex"),
            (format!("{SQUARE}f 1 2\n"), 5, "at least 3 corners, read 2"),
            (format!("{SQUARE}f 1 x 3\n"), 5, "read `x`"),
            (format!("{SQUARE}f 1/x 2/1 3/1\n"), 5, "number of a `vt`, read `1/x`"),
            ("vt\n".to_owned(), 1, "1 to 3 numbers, read 0"),
            ("vt 0 inf\n".to_owned(), 1, "read `inf`"),
            ("v 1 2\n".to_owned(), 1, "3 numbers, read 2"),
            ("v 1 2 nan\n".to_owned(), 1, "read `nan`"),
            (SQUARE.to_owned(), 1, "no faces"),
        ] {
            let report = parse_obj(&Source::new("m.obj", text.as_str())).unwrap_err();
            assert!(report.message.contains(message), "{report}");
            let (source, range) = report.place.unwrap();
            assert_eq!(source.line_column(range.start).0, line, "{text}");
        }
    }

    #[test]
    fn texture_coordinates_that_are_not_there_are_left_to_who_draws() {
        for (face, message) in [
            ("1/1 2/1 3/2", "no `vt` 2: the file has 1"),
            ("1/1 2/1 3/0", "no `vt` 0"),
            ("1/1 2/1 3/-2", "no `vt` -2: the file has 1 so far"),
            ("1/4294967296 2/1 3/1", "no `vt` 4294967296"),
        ] {
            let model = read(&format!("{SQUARE}vt 0 0\nf {face}\nf 1/1 2/1 4/1\n"));
            let report = model.lost_uv.unwrap();
            let (source, range) = report.place.clone().unwrap();
            assert!(report.message.contains(message) && source.line_column(range.start).0 == 6, "{report}");
            assert_eq!(model.mesh.face_uvs, [NO_UVS, [0; 3]]);
        }
        assert!(read(&format!("{SQUARE}vt 0 0\nf 1/1 2/1 3/1")).lost_uv.is_none());
    }

    #[test]
    fn what_is_not_drawn_is_said_once() {
        let lines = "vn 0 0 1\nl 1 2\nl 2 3\np 1\n".repeat(3);
        let unknown: Vec<String> = (0..20_000).map(|i| format!("word{i}")).collect();
        let unknown = unknown.join("\n") + "\n";
        let model = read(&format!("{SQUARE}{lines}{unknown}mtllib a.mtl\nmtllib a.mtl\nf 1 2 3\n"));
        let said: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(said.len(), NAMED + 2, "{said:?}");
        assert!(
            said[NAMED].contains("19995 more") && said[NAMED + 1].contains("lines (`l`), points (`p`)"),
            "{said:?}"
        );
        assert!(model.has_normals && model.libraries == ["a.mtl"]);
    }

    proptest! {
        #[test]
        fn no_text_breaks_the_reader(words in prop::collection::vec(
            prop::sample::select(vec!["v", "vt", "f", "usemtl", "mtllib", "s", "1", "2", "-1", "0", "3/1", "1/-1", "2//2", "1e308", "\\", "\n", "\r\n", "#", "é"]),
            0..120,
        )) {
            if let Ok(model) = parse_obj(&Source::new("m.obj", words.join(" "))) {
                let count = model.mesh.vertices.len();
                prop_assert!(model.mesh.faces.iter().flatten().all(|&v| (v as usize) < count));
                prop_assert_eq!(model.mesh.faces.len(), model.mesh.face_slots.len());
                prop_assert!(model.mesh.face_uvs.is_empty() || model.mesh.face_uvs.len() == model.mesh.faces.len());
                let uvs = model.mesh.face_uvs.iter().filter(|uvs| **uvs != NO_UVS).flatten();
                prop_assert!(uvs.copied().all(|uv| (uv as usize) < model.mesh.uvs.len()));
            }
        }
    }
}
