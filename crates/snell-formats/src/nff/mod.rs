//! Neutral File Format (Haines 1987, "A proposal for standard graphics environments"): the scenes of the Standard
//! Procedural Databases.
//!
//! | NFF | scene |
//! | --- | --- |
//! | `v` | the camera; `hither` is where its image plane stands, which hides nothing: rays start at the eye; `angle` counts between the middles of the first and the last row, and column, as in a scene |
//! | `b` | the background |
//! | `l` | a light; without a colour 1/√n for each of n, as in Haines' own writers |
//! | `f` colour Kd Ks shine T index | `kd` = colour · Kd, `ks` = `kr` = Ks, `spow` = shine, `ko` = 1 − T, `eta` = index, or 1 if that is 0; `ka` = 0 |
//! | `s` | a sphere |
//! | `p` | faces of a mesh, one for each fill; with T > 0 it refracts if it is closed, else it is opaque |
//! | `pp` | the same in a smooth mesh of their own; the normals themselves are not kept, with a warning |
//! | `c` | an open cone of 64 sides in the smooth mesh, with a warning |

mod cone;
mod shapes;

#[cfg(test)]
mod tests;

use crate::report::{Report, Source, nearest};
use crate::words::{Word, number, words};
use shapes::Shapes;
use snell::film::Rgb;
use snell::geometry::Vec3;
use snell::scene::{Camera, Integrator, Light, Material, Render, Scene, Sphere, Step, WarningCode};
use std::iter::Peekable;
use std::ops::Range;

/// The model of light of NFF scenes: the format was made for it.
const INTEGRATOR: Integrator = Integrator::Whitted;

/// Glass in glass needs many bounces; branches that carry little end before.
const MAX_DEPTH: u32 = 32;

/// No picture is anywhere near this wide; it keeps products of sizes within 64 bits.
const MAX_SIDE: f64 = (1u32 << 24) as f64;

/// What an NFF file says.
#[derive(Clone, Debug)]
pub struct Nff {
    /// All of it, meshes written out.
    pub scene: Scene,
    /// What has no equal in a scene.
    pub warnings: Vec<Report>,
    /// Where it says it.
    pub places: Places,
}

/// Where the parts of a scene come from.
#[derive(Clone, Debug, Default)]
pub struct Places(Vec<(Vec<Step>, Range<usize>)>);

impl Places {
    /// Bytes of the entity that a place in the scene comes from.
    pub fn find(&self, steps: &[Step]) -> Option<Range<usize>> {
        let fits = |(place, _): &&(Vec<Step>, Range<usize>)| steps.starts_with(place);
        self.0.iter().filter(fits).max_by_key(|(place, _)| place.len()).map(|(_, range)| range.clone())
    }
}

/// Reads an NFF file.
///
/// # Errors
/// An unknown entity, a number that is none or missing, a polygon with fewer than three corners, no `v`.
pub fn parse(source: &Source) -> Result<Nff, Report> {
    let mut start = 0;
    let lines = source.text.split_inclusive('\n').flat_map(move |line| {
        let content = words(line.split('#').next().unwrap_or_default(), start);
        start += line.len();
        content
    });
    let mut reader = Reader {
        source,
        words: lines.peekable(),
        last: 0..0,
        view: None,
        background: Rgb::gray(0.0),
        lights: Vec::new(),
        shapes: Shapes::default(),
        spheres: Vec::new(),
        places: Vec::new(),
        told: Vec::new(),
        warnings: Vec::new(),
    };
    while let Some(keyword) = reader.words.next() {
        reader.last = keyword.range.clone();
        reader.entity(&keyword)?;
    }
    reader.finish()
}

struct View {
    camera: Camera,
    size: [u32; 2],
}

struct Reader<'a, W: Iterator<Item = Word<'a>>> {
    source: &'a Source,
    words: Peekable<W>,
    /// The word that was read last.
    last: Range<usize>,
    view: Option<View>,
    background: Rgb,
    lights: Vec<([f64; 3], Option<Rgb>)>,
    shapes: Shapes,
    spheres: Vec<Sphere>,
    places: Vec<(Vec<Step>, Range<usize>)>,
    /// What was warned of already.
    told: Vec<&'static str>,
    warnings: Vec<Report>,
}

impl<'a, W: Iterator<Item = Word<'a>>> Reader<'a, W> {
    fn entity(&mut self, keyword: &Word<'a>) -> Result<(), Report> {
        let start = keyword.range.start;
        let place = match keyword.text {
            "v" => {
                self.view()?;
                Some(vec![Step::from("camera")])
            }
            "b" => {
                self.background = self.numbers("b red green blue")?.into();
                Some(vec![Step::from("background")])
            }
            "l" => {
                let position = self.numbers("l x y z, and red green blue if they are not all alike")?;
                let colored = self.words.peek().is_some_and(|w| number(w).is_some());
                let color = if colored { Some(self.numbers::<3>("l x y z red green blue")?) } else { None };
                self.lights.push((position, color.map(|[r, g, b]| Rgb::new(r, g, b))));
                Some(vec![Step::from("light"), Step::from(self.lights.len() - 1)])
            }
            "f" => {
                let [r, g, b, kd, ks, shine, t, index] =
                    self.numbers("f red green blue Kd Ks shine T index_of_refraction")?;
                let material = Material {
                    kd: Rgb::new(r * kd, g * kd, b * kd),
                    ks: Rgb::gray(ks),
                    kr: Rgb::gray(ks),
                    ko: Rgb::gray(1.0 - t),
                    spow: shine,
                    // What is not transparent often has 0 here.
                    eta: if index == 0.0 { 1.0 } else { index },
                    ..Material::default()
                };
                self.shapes.fill(material, start..self.last.end);
                None
            }
            "s" => {
                let [x, y, z, radius] = self.numbers("s x y z radius")?;
                if radius < 0.0 {
                    self.warn(keyword, "a sphere that is seen from inside only is drawn from both sides");
                }
                let material = self.material(keyword)?;
                self.spheres.push(Sphere::new([x, y, z], radius.abs(), &material));
                Some(vec![Step::from("sphere"), Step::from(self.spheres.len() - 1)])
            }
            "p" | "pp" => {
                self.polygon(keyword)?;
                None
            }
            "c" => {
                let [x, y, z, base_radius] = self.numbers("c base x y z radius, apex x y z radius")?;
                let [u, v, w, apex_radius] = self.numbers("c base x y z radius, apex x y z radius")?;
                self.material(keyword)?;
                let ends = [(Vec3::new(x, y, z), base_radius), (Vec3::new(u, v, w), apex_radius)];
                let faces = cone::faces(ends).map_err(|message| self.error(keyword.range.clone(), message))?;
                self.warn(keyword, "cones and cylinders are drawn with 64 flat sides");
                self.shapes.smooth(&faces, start..self.last.end);
                None
            }
            word => {
                let known = ["v", "b", "l", "f", "s", "p", "pp", "c"];
                let near = nearest(word, known).map_or(String::new(), |n| format!("did you mean `{n}`? "));
                let help = format!("{near}entities are v, b, l, f, s, p, pp and c");
                let message = format!("expected an entity of the Neutral File Format, read `{word}`");
                return Err(self.error(keyword.range.clone(), message).help(help));
            }
        };
        if let Some(place) = place {
            self.places.push((place, start..self.last.end));
        }
        Ok(())
    }

    fn view(&mut self) -> Result<(), Report> {
        let (mut from, mut at, mut up) = (None, None, None);
        let (mut angle, mut hither, mut size) = (None, None, None);
        for _ in 0..6 {
            let word = self.next("v, and lines from, at, up, angle, hither and resolution")?;
            let range = word.range.clone();
            match word.text {
                "from" => from = Some(self.numbers("from x y z")?),
                "at" => at = Some(self.numbers("at x y z")?),
                "up" => up = Some(self.numbers("up x y z")?),
                "angle" => {
                    let [degrees] = self.numbers("angle in degrees")?;
                    if !(degrees > 0.0 && degrees < 180.0) {
                        let message = format!("an angle of view is between 0 and 180 degrees, read {degrees}");
                        return Err(self.error(range.start..self.last.end, message));
                    }
                    angle = Some(degrees);
                }
                "hither" => hither = Some(self.numbers::<1>("hither distance")?[0]),
                "resolution" => {
                    let sides = self.numbers::<2>("resolution width height")?;
                    if sides.iter().any(|s| s.fract() != 0.0 || !(1.0..=MAX_SIDE).contains(s)) {
                        let message =
                            format!("expected a width and a height in pixels, read {} {}", sides[0], sides[1]);
                        return Err(self.error(range.start..self.last.end, message));
                    }
                    size = Some(sides.map(|s| s as u32));
                }
                other => {
                    let message = format!("expected from, at, up, angle, hither or resolution, read `{other}`");
                    return Err(self.error(range, message));
                }
            }
        }
        let (Some(eye), Some(look_at), Some(up), Some(angle), Some(hither), Some(size)) =
            (from, at, up, angle, hither, size)
        else {
            let message = "a view gives each of from, at, up, angle, hither and resolution once".to_owned();
            return Err(self.error(self.last.clone(), message));
        };
        let distance = (Vec3::from(eye) - Vec3::from(look_at)).length();
        // The image plane only gives directions; without a hither plane it may stand anywhere.
        let near = if hither > 0.0 {
            hither
        } else if distance > 0.0 {
            distance / 1024.0
        } else {
            1.0
        };
        let half = near * libm::tan((angle / 2.0).to_radians());
        let camera = Camera::new(eye, look_at, up, [-half, half, -half, half], -near);
        self.view = Some(View { camera, size });
        Ok(())
    }

    fn polygon(&mut self, keyword: &Word<'a>) -> Result<(), Report> {
        let patch = keyword.text == "pp";
        let [count] = self.numbers(if patch { "pp corners" } else { "p corners" })?;
        if !(count >= 3.0 && count.fract() == 0.0) {
            let message = format!("a polygon has at least 3 corners, read {count}");
            return Err(self.error(self.last.clone(), message));
        }
        self.material(keyword)?;
        let mut corners = Vec::new();
        for _ in 0..count as u64 {
            corners.push(Vec3::from(self.numbers::<3>("x y z of a corner")?));
            if patch {
                self.numbers::<3>("x y z of a corner, and of its normal")?;
            }
        }
        let range = keyword.range.start..self.last.end;
        if patch {
            self.warn(
                keyword,
                "the normals of patches are not kept: they are computed from the faces around, up to 60 degrees",
            );
            self.shapes.smooth(&[corners], range);
        } else {
            self.shapes.flat(&corners, range);
        }
        Ok(())
    }

    /// The name of the current material.
    fn material(&mut self, keyword: &Word<'a>) -> Result<String, Report> {
        self.shapes.material().ok_or_else(|| {
            let message = format!("`{}` stands before the first fill, so it has no colour", keyword.text);
            self.error(keyword.range.clone(), message)
                .help("put a line `f red green blue Kd Ks shine T index` before it")
        })
    }

    fn next(&mut self, expected: &str) -> Result<Word<'a>, Report> {
        let Some(word) = self.words.next() else {
            let end = self.source.text.len();
            let help = format!("expected: {expected}");
            return Err(self.error(end..end, "the file ends too early".to_owned()).help(help));
        };
        self.last = word.range.clone();
        Ok(word)
    }

    fn numbers<const N: usize>(&mut self, expected: &str) -> Result<[f64; N], Report> {
        let mut numbers = [0.0; N];
        for value in &mut numbers {
            let word = self.next(expected)?;
            *value = number(&word).ok_or_else(|| {
                let message = format!("expected a number, read `{}`", word.text);
                self.error(word.range.clone(), message).help(format!("here stands: {expected}"))
            })?;
        }
        Ok(numbers)
    }

    fn error(&self, range: Range<usize>, message: String) -> Report {
        Report::error(message).at(self.source, range)
    }

    /// Warns once of each thing: a file of a million patches needs no million warnings.
    fn warn(&mut self, keyword: &Word<'a>, message: &'static str) {
        if !self.told.contains(&message) {
            self.told.push(message);
            let report = Report::warning(WarningCode::Approximated, message);
            self.warnings.push(report.at(self.source, keyword.range.clone()));
        }
    }

    fn finish(self) -> Result<Nff, Report> {
        let Some(View { camera, size }) = self.view else {
            let help = "an NFF file starts with a line `v` and lines from, at, up, angle, hither and resolution";
            return Err(Report::error("there is no view `v`").at(self.source, 0..0).help(help));
        };
        // Intensities add up where all lights shine; squares of them, as Haines chose, are a middle way.
        let share = 1.0 / (self.lights.len() as f64).sqrt();
        let light = |(position, color): ([f64; 3], Option<Rgb>)| Light::at(position, color.unwrap_or(Rgb::gray(share)));
        let mut places = self.places;
        let (materials, meshes) = self.shapes.finish(&mut places);
        let render = Render { max_depth: MAX_DEPTH, ..Render::new(INTEGRATOR, size) };
        let scene = Scene {
            background: self.background,
            lights: self.lights.into_iter().map(light).collect(),
            materials,
            spheres: self.spheres,
            meshes,
            ..Scene::new(render, camera)
        };
        Ok(Nff { scene, warnings: self.warnings, places: Places(places) })
    }
}
