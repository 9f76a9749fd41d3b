//! From the lines of a driver to a scene.

use super::dialect::{Dialect, recognise};
use crate::report::{Remedy, Report, Source, nearest};
use crate::words::{Line, lines};
use snell::film::Rgb;
use snell::scene::{Camera, Light, Material, Mesh, Render, Scene, Sphere, Step, Transfer, Transform, WarningCode};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// What a driver says. The models are not read yet.
#[derive(Clone, Debug)]
pub struct Driver {
    /// The year, given or recognised.
    pub dialect: Dialect,
    /// Everything but the models.
    pub scene: Scene,
    /// The models, in order.
    pub models: Vec<Model>,
    /// Odd lines.
    pub warnings: Vec<Report>,
    places: Vec<(Vec<Step>, Range<usize>)>,
}

/// A model that a driver asks for.
#[derive(Clone, Debug)]
pub struct Model {
    /// The file name, as written.
    pub file: String,
    /// Where it is put.
    pub transform: Vec<Transform>,
    /// Smoothing limit in degrees.
    pub smooth_angle: f64,
}

/// In 2018, `smooth` means up to this angle.
const SMOOTH_2018: f64 = 22.5;

/// 2020: steps add up until `trans clear`. Real drivers have three.
const MOST_STEPS: usize = 100;

/// No course wrote pictures anywhere near this; it keeps products of sizes within 64 bits.
const MAX_SIDE: u32 = 1 << 24;

impl Driver {
    /// Bytes of the line that a place in the scene comes from.
    pub fn place(&self, steps: &[Step]) -> Option<Range<usize>> {
        let fits = |(place, _): &&(Vec<Step>, Range<usize>)| steps.starts_with(place);
        self.places.iter().filter(fits).max_by_key(|(place, _)| place.len()).map(|(_, range)| range.clone())
    }

    /// The scene with a mesh for each model, not read yet.
    pub fn scene_with_models(&self) -> Scene {
        let mesh = |model: &Model| Mesh {
            file: Some(model.file.clone()),
            smooth_angle: model.smooth_angle,
            transform: model.transform.clone(),
            ..Mesh::default()
        };
        Scene { meshes: self.models.iter().map(mesh).collect(), ..self.scene.clone() }
    }
}

/// Does any line start like one of a driver? Of another text, each line would be an unknown keyword.
pub fn has_keywords(source: &Source) -> bool {
    lines(source).iter().any(|line| KEYWORDS.contains(&line.keyword.text))
}

/// Reads a driver. Without a `dialect` the year is recognised.
///
/// # Errors
/// A line with the wrong number or kind of values, or a line that must be there and is not; after the warnings so far,
/// which may well say why.
pub fn parse(source: &Source, dialect: Option<Dialect>) -> Result<Driver, Vec<Report>> {
    let lines = lines(source);
    let (recognised, unclear) = recognise(&lines);
    let mut reader = Reader {
        dialect: dialect.unwrap_or(recognised),
        seen: HashSet::new(),
        values: Values::default(),
        known_materials: HashMap::new(),
        models: Vec::new(),
        transform: Vec::new(),
        cutoff: 0.0,
        settings: Vec::new(),
        places: Vec::new(),
        warnings: if dialect.is_none() { unclear } else { Vec::new() },
    };
    let read = lines.iter().try_for_each(|line| reader.line(line));
    let mut warnings = std::mem::take(&mut reader.warnings);
    match read.and_then(|()| reader.finish(source)) {
        Ok(driver) => Ok(Driver { warnings, ..driver }),
        Err(report) => {
            warnings.push(report);
            Err(warnings)
        }
    }
}

#[derive(Default)]
struct Values {
    eye: Option<[f64; 3]>,
    look: Option<[f64; 3]>,
    up: Option<[f64; 3]>,
    near: Option<f64>,
    bounds: Option<[f64; 4]>,
    size: Option<[u32; 2]>,
    depth: u32,
    ambient: Rgb,
    eta_outside: Option<f64>,
    lights: Vec<Light>,
    materials: Vec<Material>,
    spheres: Vec<Sphere>,
}

struct Reader {
    dialect: Dialect,
    /// Settings that were given already.
    seen: HashSet<String>,
    values: Values,
    /// Materials of spheres by their numbers, so that equal ones have one name.
    known_materials: HashMap<[u64; 17], usize>,
    models: Vec<Model>,
    /// 2020: steps so far.
    transform: Vec<Transform>,
    /// 2020: smoothing limit so far.
    cutoff: f64,
    /// Lines of the settings, at most one each, and of the things of which there may be many.
    settings: Vec<(Vec<Step>, Range<usize>)>,
    places: Vec<(Vec<Step>, Range<usize>)>,
    warnings: Vec<Report>,
}

const KEYWORDS: &[&str] = &[
    "eye",
    "look",
    "up",
    "d",
    "camera",
    "bounds",
    "res",
    "recursionLevel",
    "ambient",
    "light",
    "sphere",
    "model",
    "trans",
    "cutoffAngle",
    "load",
    "eta_outside",
];

impl Reader {
    fn line(&mut self, line: &Line<'_>) -> Result<(), Report> {
        let keyword = line.keyword.text;
        match keyword {
            "eye" => self.values.eye = Some(self.setting(line, &["camera", "eye"], "eye x y z")?),
            "look" => self.values.look = Some(self.setting(line, &["camera", "look_at"], "look x y z")?),
            "up" => self.values.up = Some(self.setting(line, &["camera", "up"], "up x y z")?),
            "d" => {
                let [d] = self.setting(line, &["camera", "near"], "d distance")?;
                self.near(line, d)?;
            }
            "camera" => {
                let expected = "camera eye_x eye_y eye_z look_x look_y look_z up_x up_y up_z d";
                let v: [f64; 10] = self.setting(line, &["camera"], expected)?;
                self.values.eye = Some([v[0], v[1], v[2]]);
                self.values.look = Some([v[3], v[4], v[5]]);
                self.values.up = Some([v[6], v[7], v[8]]);
                self.near(line, v[9])?;
            }
            "bounds" => {
                let early = self.dialect.is_early();
                let expected = if early { "bounds left bottom right top" } else { "bounds left right bottom top" };
                let [a, b, c, d] = self.setting(line, &["camera", "bounds"], expected)?;
                self.values.bounds = Some(if early { [a, c, b, d] } else { [a, b, c, d] });
            }
            "res" => {
                let expected = "res width height";
                let _: [f64; 2] = self.setting(line, &["render", "size"], expected)?;
                let side = |i: usize| line.whole(&line.rest[i], MAX_SIDE, expected);
                self.values.size = Some([side(0)?, side(1)?]);
            }
            "recursionLevel" | "recursionlevel" => {
                let expected = "recursionLevel number";
                let _: [f64; 1] = self.setting(line, &["render", "max_depth"], expected)?;
                self.values.depth = line.whole(&line.rest[0], u32::MAX, expected)?;
            }
            "ambient" => self.values.ambient = self.setting(line, &["ambient"], "ambient r g b")?.into(),
            "eta_outside" => {
                let [eta] = self.setting(line, &["eta_outside"], "eta_outside index")?;
                self.values.eta_outside = Some(eta);
            }
            "light" => self.light(line)?,
            "sphere" => self.sphere(line)?,
            "model" => self.model(line)?,
            "trans" => self.trans(line)?,
            "cutoffAngle" => {
                let [angle] = line.exactly("cutoffAngle degrees")?;
                self.cutoff = angle;
            }
            "load" => self.load(line)?,
            _ => self.unknown(line),
        }
        Ok(())
    }

    fn unknown(&mut self, line: &Line<'_>) {
        let word = line.keyword.text;
        let mut report =
            Report::warning(WarningCode::UnknownKeyword, format!("unknown keyword `{word}`: line ignored"))
                .at(line.source, line.range());
        if let Some(near) = nearest(word, KEYWORDS.iter().copied()) {
            report = report.help(format!("did you mean `{near}`?"));
        }
        self.warnings.push(report);
    }

    /// A line that should be given once.
    fn setting<const N: usize>(&mut self, line: &Line<'_>, place: &[&str], expected: &str) -> Result<[f64; N], Report> {
        let keyword = line.keyword.text.to_lowercase();
        if !self.seen.insert(keyword) {
            let message = format!("`{}` is given more than once; this later line counts", line.keyword.text);
            self.warnings.push(Report::warning(WarningCode::RepeatedLine, message).at(line.source, line.range()));
        }
        // The last line that sets a value is the one to show.
        let place: Vec<Step> = place.iter().map(|&key| key.into()).collect();
        self.settings.retain(|(other, _)| *other != place);
        self.settings.push((place, line.range()));
        line.exactly(expected)
    }

    fn place(&mut self, list: &str, index: usize, line: &Line<'_>) {
        self.places.push((vec![list.into(), index.into()], line.range()));
    }

    fn near(&mut self, line: &Line<'_>, d: f64) -> Result<(), Report> {
        let (near, expected) = if self.dialect.is_early() { (-d, "positive") } else { (d, "negative") };
        if near >= 0.0 {
            let dialect = self.dialect.name();
            let message = format!("in the dialect {dialect} the distance d is {expected}, read {d}");
            return Err(line.error(message).help("the image plane must stand in front of the eye"));
        }
        self.values.near = Some(near);
        Ok(())
    }

    fn light(&mut self, line: &Line<'_>) -> Result<(), Report> {
        let expected = "light x y z w r g b, with w 1 for a point and 0 for a light at infinity";
        let [x, y, z, w, r, g, b] = line.exactly(expected)?;
        self.place("light", self.values.lights.len(), line);
        let at = [x, y, z];
        let color = Rgb::new(r, g, b);
        self.values.lights.push(if w == 1.0 {
            Light::at(at, color)
        } else if w == 0.0 {
            Light::from_direction(at, color)
        } else {
            let word = &line.rest[3];
            return Err(Report::error(format!("w must be 0 or 1, read `{}`", word.text))
                .at(line.source, word.range.clone())
                .help(format!("this line is: {expected}")));
        });
        Ok(())
    }

    fn sphere(&mut self, line: &Line<'_>) -> Result<(), Report> {
        let (counts, expected): (&[usize], _) = match self.dialect {
            Dialect::Course2018 => (&[13, 16], "sphere x y z r, Ka, Kd, Ks [, Kr], three numbers each"),
            Dialect::Lecture => (
                &[13, 16, 20, 21],
                "sphere x y z r, Ka, Kd, Ks, Kr, Ko, three numbers each, [exponent] eta; or up to Ks or Kr only",
            ),
            Dialect::Course2019 | Dialect::Course2020 => {
                (&[13, 16, 17], "sphere x y z r, Ka, Kd, Ks [, Kr [, Ni]], three numbers each but Ni")
            }
        };
        let v = line.numbers(expected)?;
        if !counts.contains(&v.len()) {
            let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
            return Err(line.count(&counts.join(" or "), v.len(), expected));
        }
        let color = |i: usize| v.get(i..i + 3).map_or(Rgb::gray(0.0), |c| Rgb::new(c[0], c[1], c[2]));
        let mut material = Material {
            ka: color(4),
            kd: color(7),
            ks: color(10),
            kr: color(13),
            spow: self.dialect.default_exponent(),
            ..Material::default()
        };
        match v.len() {
            20 => (material.ko, material.eta) = (color(16), v[19]),
            21 => (material.ko, material.spow, material.eta) = (color(16), v[19], v[20]),
            // 2019 and 2020 know no Ko: an index other than 0 makes a sphere transparent.
            17 if v[16] != 0.0 => (material.ko, material.eta) = (Rgb::gray(0.0), v[16]),
            _ => {}
        }
        self.place("sphere", self.values.spheres.len(), line);
        let count = self.values.materials.len();
        let index = *self.known_materials.entry(bits(&material)).or_insert(count);
        if index == count {
            self.places.push((vec!["material".into(), sphere_material(index).as_str().into()], line.range()));
            self.values.materials.push(material);
        }
        self.values.spheres.push(Sphere::new([v[0], v[1], v[2]], v[3], &sphere_material(index)));
        Ok(())
    }

    fn model(&mut self, line: &Line<'_>) -> Result<(), Report> {
        let expected = match self.dialect {
            Dialect::Course2019 => "model axis_x axis_y axis_z degrees scale tx ty tz cutoffAngle file.obj",
            _ => "model axis_x axis_y axis_z degrees scale tx ty tz [smooth|sharp] file.obj",
        };
        if line.rest.len() < 9 {
            return Err(line.count("at least 9", line.rest.len(), expected));
        }
        let mut v = [0.0; 8];
        for (value, word) in v.iter_mut().zip(&line.rest) {
            *value = line.number(word, expected)?;
        }
        let (smooth_angle, file) = match (line.rest[8].text, line.rest.len()) {
            ("smooth", 10..) => (SMOOTH_2018, 9),
            ("sharp", 10..) => (0.0, 9),
            (_, count) if self.dialect == Dialect::Course2019 => {
                if count < 10 {
                    return Err(line.count("at least 10", count, expected));
                }
                (line.number(&line.rest[8], expected)?, 9)
            }
            _ => (0.0, 8),
        };
        let transform = vec![
            Transform::Rotate { axis: [v[0], v[1], v[2]], degrees: v[3] },
            Transform::Scale([v[4]; 3]),
            Transform::Move([v[5], v[6], v[7]]),
        ];
        self.add_model(line, file, transform, smooth_angle);
        Ok(())
    }

    fn load(&mut self, line: &Line<'_>) -> Result<(), Report> {
        if line.rest.is_empty() {
            return Err(line.count("1", 0, "load file.obj"));
        }
        self.add_model(line, 0, self.transform.clone(), self.cutoff);
        Ok(())
    }

    /// The file name is the rest of the line: it may contain spaces.
    fn add_model(&mut self, line: &Line<'_>, file: usize, transform: Vec<Transform>, smooth_angle: f64) {
        let range = line.rest[file].range.start..line.range().end;
        self.place("mesh", self.models.len(), line);
        self.models.push(Model { file: line.source.text[range].to_owned(), transform, smooth_angle });
    }

    fn trans(&mut self, line: &Line<'_>) -> Result<(), Report> {
        let expected = "trans clear | rota axis_x axis_y axis_z degrees | scale sx sy sz | move x y z";
        let kind = line.rest.first().map_or("", |w| w.text);
        let numbers: Vec<f64> = line.rest.iter().skip(1).map(|w| line.number(w, expected)).collect::<Result<_, _>>()?;
        if self.transform.len() >= MOST_STEPS && kind != "clear" {
            let message = format!("more than {MOST_STEPS} steps without `trans clear`");
            return Err(line.error(message).help("every model repeats all steps so far"));
        }
        match (kind, numbers.as_slice()) {
            ("clear", []) => self.transform.clear(),
            ("rota", &[x, y, z, degrees]) => self.transform.push(Transform::Rotate { axis: [x, y, z], degrees }),
            ("scale", &[x, y, z]) => self.transform.push(Transform::Scale([x, y, z])),
            ("move", &[x, y, z]) => self.transform.push(Transform::Move([x, y, z])),
            _ => {
                let message = format!("`trans {kind}` with {} values is unknown", numbers.len());
                return Err(line.error(message).help(format!("this line is: {expected}")));
            }
        }
        Ok(())
    }

    fn finish(self, source: &Source) -> Result<Driver, Report> {
        let Self { dialect, values, models, settings, mut places, .. } = self;
        places.extend(settings);
        let missing = |what: &str| {
            let end = source.text.trim_end().len();
            Report::error(format!("this driver has no `{what}` line"))
                .at(source, end..end)
                .help(format!("read as a driver of the dialect {}", dialect.name()))
                .remedy(Remedy::NameDialect)
        };
        let eye = if dialect == Dialect::Course2020 { "camera" } else { "eye" };
        let near = if dialect == Dialect::Course2020 { "camera" } else { "d" };
        let render = Render {
            max_depth: values.depth,
            transfer: Transfer::Linear,
            rounding: dialect.rounding(),
            ..Render::new(dialect.integrator(), values.size.ok_or_else(|| missing("res"))?)
        };
        let camera = Camera::new(
            values.eye.ok_or_else(|| missing(eye))?,
            values.look.ok_or_else(|| missing("look"))?,
            values.up.ok_or_else(|| missing("up"))?,
            values.bounds.ok_or_else(|| missing("bounds"))?,
            values.near.ok_or_else(|| missing(near))?,
        );
        let scene = Scene {
            ambient: values.ambient,
            eta_outside: values.eta_outside.unwrap_or(1.0),
            lights: values.lights,
            materials: values.materials.into_iter().enumerate().map(|(i, m)| (sphere_material(i), m)).collect(),
            spheres: values.spheres,
            ..Scene::new(render, camera)
        };
        Ok(Driver { dialect, scene, models, warnings: Vec::new(), places })
    }
}

/// All numbers of a material, to the bit.
fn bits(m: &Material) -> [u64; 17] {
    let mut bits = [0; 17];
    let colors = [m.ka, m.kd, m.ks, m.kr, m.ko].into_iter().flat_map(Rgb::to_array);
    for (bits, value) in bits.iter_mut().zip(colors.chain([m.spow, m.eta])) {
        *bits = value.to_bits();
    }
    bits
}

fn sphere_material(index: usize) -> String {
    format!("sphere_{}", index + 1)
}
