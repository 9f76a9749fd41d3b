//! Wavefront MTL: materials, read with the rule of the year.

use super::not_drawn;
use crate::report::{Report, Source};
use crate::words::{Line, Word, lines, number};
use snell::film::Rgb;
use snell::scene::{LARGEST_NUMBER, Material, WarningCode};

/// A material as the file has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlMaterial {
    /// After `newmtl`.
    pub name: String,
    ka: Rgb,
    kd: Option<Rgb>,
    ks: Rgb,
    kr: Option<Rgb>,
    /// `Ke`.
    emission: Rgb,
    exponent: Option<f64>,
    /// `illum 3`.
    mirrors: bool,
    /// `d`, or 1 − `Tr`.
    opacity: Option<f64>,
    /// `Ni`.
    eta: Option<f64>,
    /// The picture of `map_Kd`, which colours the diffuse part, by the name that the file gives it; without options.
    pub map_kd: Option<String>,
}

/// How a year reads the materials of polygons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MtlRule {
    /// Where the mirror coefficient comes from.
    pub mirror: Mirror,
    /// Exponent of the highlight where the file has none.
    pub default_exponent: f64,
    /// Does light go through what is not opaque, and does it come from what emits it? Not in the models of the course.
    pub real_optics: bool,
}

/// Where the mirror coefficient of a polygon comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mirror {
    /// (1, 1, 1), whatever the file says.
    One,
    /// `Kr`, or (1, 1, 1) without it.
    KrOrOne,
    /// `Ks` if `illum` is 3, else 0.
    KsIfIllum3,
    /// `Kr`; without it `Ks` if `illum` is 3, else 0.
    KrOrKsIfIllum3,
}

impl MtlMaterial {
    /// The gray of a model without a material.
    pub fn gray() -> Self {
        let half = Rgb::gray(0.5);
        Self { name: "gray".to_owned(), ka: Rgb::gray(0.2), kd: Some(half), ks: half, ..Self::default() }
    }

    /// What the file says of it that only real optics draws.
    pub fn beyond_the_course(&self) -> Vec<&'static str> {
        let through = self.opacity.is_some_and(|opacity| opacity < 1.0).then_some("`d` or `Tr`");
        let glow = (self.emission != Rgb::gray(0.0)).then_some("`Ke`");
        through.into_iter().chain(glow).collect()
    }

    /// The material by the rule of a year. Where light goes through, it goes through panes without thickness: whether a mesh is a
    /// solid, its material does not know.
    pub fn material(&self, rule: MtlRule) -> Material {
        let by_illum = if self.mirrors { self.ks } else { Rgb::gray(0.0) };
        let kr = match rule.mirror {
            Mirror::One => Rgb::gray(1.0),
            Mirror::KrOrOne => self.kr.unwrap_or(Rgb::gray(1.0)),
            Mirror::KsIfIllum3 => by_illum,
            Mirror::KrOrKsIfIllum3 => self.kr.unwrap_or(by_illum),
        };
        // A map without a colour is multiplied by nothing.
        let without = if self.map_kd.is_some() { 1.0 } else { 0.0 };
        let mut material = Material {
            ka: self.ka,
            kd: self.kd.unwrap_or(Rgb::gray(without)),
            ks: self.ks,
            kr,
            spow: self.exponent.unwrap_or(rule.default_exponent),
            ..Material::default()
        };
        if rule.real_optics {
            material.emission = self.emission;
            if let Some(opacity) = self.opacity.filter(|&opacity| opacity < 1.0) {
                material.ko = Rgb::gray(opacity);
                material.eta = self.eta.unwrap_or(1.0);
                material.thickness = Some(0.0);
            }
        }
        material
    }
}

/// Reads an MTL file: the materials, and warnings about what is not drawn.
///
/// `d` (1 is opaque) and `Tr` = 1 − `d` are one thing; where both are given, `d` counts.
///
/// # Errors
/// A number that is none, or a setting before the first `newmtl`.
pub fn parse_mtl(source: &Source) -> Result<(Vec<MtlMaterial>, Vec<Report>), Report> {
    let mut materials: Vec<MtlMaterial> = Vec::new();
    let mut warnings = Vec::new();
    let mut ignored: Vec<String> = Vec::new();
    // What `d` says of the material.
    let mut opacity = None;
    for line in lines(source) {
        let keyword = line.keyword.text;
        if keyword == "newmtl" {
            let name = line.rest.first().map_or(0, |w| w.range.start)..line.range().end;
            let name = if line.rest.is_empty() { String::new() } else { source.text[name].to_owned() };
            materials.push(MtlMaterial { name, ..MtlMaterial::default() });
            opacity = None;
            continue;
        }
        let Some(material) = materials.last_mut() else {
            return Err(line.error(format!("`{keyword}` stands before the first `newmtl`")));
        };
        let mut ignore = |what: String| {
            if !ignored.contains(&what) {
                ignored.push(what);
            }
        };
        match keyword {
            "Ka" => material.ka = color(&line)?,
            "Kd" => material.kd = Some(color(&line)?),
            "Ks" => material.ks = color(&line)?,
            "Kr" => material.kr = Some(color(&line)?),
            "Ke" => match color(&line) {
                Ok(emission) => material.emission = emission,
                // Spectra and CIEXYZ, or what no one can read.
                Err(_) => ignore(line_text(&line)),
            },
            "Ns" => material.exponent = Some(exponent(&line)?),
            // Other programs take these as they come, and so what is none of theirs is left out, not refused.
            "Ni" => match line.exactly("Ni index_of_refraction") {
                Ok([eta]) if INDICES.contains(&eta) => material.eta = Some(eta),
                // Some exporters write 0 for what is not transparent.
                Ok([0.0]) => {}
                _ => ignore(line_text(&line)),
            },
            "d" | "Tr" => match line.exactly("d or Tr, and a number from 0 to 1") {
                Ok([share]) if (0.0..=1.0).contains(&share) => {
                    if keyword == "d" {
                        opacity = Some(share);
                    }
                    material.opacity = opacity.or(material.opacity).or(Some(1.0 - share));
                }
                _ => ignore(line_text(&line)),
            },
            "Tf" => {
                // The colour of what goes through; without spectra and CIEXYZ, which nobody writes.
                if !line.rest.iter().all(|word| number(word) == Some(1.0)) {
                    ignore("`Tf`".to_owned());
                }
            }
            "illum" => {
                let [illum] = line.exactly("illum number")?;
                material.mirrors = illum == 3.0;
                if illum > 3.0 {
                    ignore(format!("`illum {illum}`"));
                }
            }
            "Pr" | "Pm" | "Ps" | "Pc" | "Pcr" | "aniso" | "anisor" | "sharpness" => ignore(format!("`{keyword}`")),
            "map_Kd" | "map_kd" => {
                let Map { file, options } = Map::of(&line);
                if let Some(options) = options {
                    let message = format!("the options `{options}` of the texture `{file}` are ignored");
                    warnings.push(Report::warning(WarningCode::TextureIgnored, message).at(source, line.range()));
                }
                material.map_kd = Some(file.to_owned()).filter(|file| !file.is_empty());
            }
            _ if keyword.starts_with("map_") || matches!(keyword, "bump" | "disp" | "decal" | "refl" | "norm") => {
                warnings.push(map_not_drawn(&line, Map::of(&line).file));
            }
            _ => {
                let message = format!("unknown keyword `{keyword}` in a material: line ignored");
                warnings.push(Report::warning(WarningCode::UnknownKeyword, message).at(source, line.range()));
            }
        }
    }
    warnings.extend(not_drawn(&source.name, ignored.iter().map(String::as_str)));
    Ok((materials, warnings))
}

/// Indices that real optics takes.
const INDICES: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// What stands behind the keyword of a texture.
#[derive(Debug, PartialEq)]
struct Map<'a> {
    /// May have spaces in its name; empty if there is none.
    file: &'a str,
    options: Option<&'a str>,
}

impl<'a> Map<'a> {
    fn of(line: &Line<'a>) -> Self {
        let (words, source) = (&line.rest, line.source);
        let text = |words: &[Word<'a>]| match (words.first(), words.last()) {
            (Some(first), Some(last)) => &source.text[first.range.start..last.range.end],
            _ => "",
        };
        let mut start = 0;
        while let Some(option) = words.get(start).map(|w| w.text).filter(|w| w.starts_with('-')) {
            let values = &words[start + 1..];
            let most = match option {
                "-blendu" | "-blendv" | "-boost" | "-bm" | "-cc" | "-clamp" | "-imfchan" | "-texres" | "-type" => 1,
                "-mm" => 2,
                // One to three numbers.
                "-o" | "-s" | "-t" => values.iter().take(3).take_while(|w| number(w).is_some()).count(),
                // Of an option that nobody knows, the last word is the file.
                _ => values.len().saturating_sub(1),
            };
            start += 1 + most.min(values.len());
        }
        let (options, file) = words.split_at(start);
        Self { file: text(file), options: (!options.is_empty()).then(|| text(options)) }
    }
}

fn map_not_drawn(line: &Line<'_>, file: &str) -> Report {
    let folder = std::path::Path::new(&*line.source.name).parent().unwrap_or(std::path::Path::new(""));
    let missing = if folder.join(file).is_file() { "" } else { ", and the file is missing" };
    let message = format!("the texture `{file}` is not drawn: only the colours of its material are{missing}");
    Report::warning(WarningCode::TextureIgnored, message).at(line.source, line.range())
}

fn color(line: &Line<'_>) -> Result<Rgb, Report> {
    let expected = "Ka, Kd, Ks, Kr or Ke, and red green blue, or one number for gray";
    let numbers = line.numbers(expected)?;
    if let Some(value) = numbers.iter().find(|v| v.abs() > LARGEST_NUMBER) {
        return Err(line.error(format!("expected numbers between -1e15 and 1e15, read {value}")));
    }
    match numbers.as_slice() {
        &[v] => Ok(Rgb::gray(v)),
        &[r, g, b] => Ok(Rgb::new(r, g, b)),
        other => Err(line.count("1 or 3", other.len(), expected)),
    }
}

fn exponent(line: &Line<'_>) -> Result<f64, Report> {
    let [exponent] = line.exactly("Ns exponent")?;
    if (0.0..=LARGEST_NUMBER).contains(&exponent) {
        return Ok(exponent);
    }
    Err(line.error(format!("an exponent is between 0 and 1e15, read {exponent}")))
}

fn line_text(line: &Line<'_>) -> String {
    format!("`{}`", &line.source.text[line.range()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TWO: &str =
        "# c\nnewmtl my wall\nNs 96\nKa .1 .2 .3\nKd 0.5\nKs 1 0 0\nillum 3\nNi 1.5\n\nnewmtl b\nKr .5 .5 .5\n";

    #[test]
    fn the_rule_of_the_year_decides_the_mirror() {
        let (materials, warnings) = parse_mtl(&Source::new("m.mtl", TWO)).unwrap();
        assert!(warnings.is_empty());
        assert_eq!(materials[0].name, "my wall");
        let kr = |i: usize, mirror| {
            materials[i].material(MtlRule { mirror, default_exponent: 19.0, real_optics: false }).kr.to_array()
        };
        let (red, one, half) = ([1.0, 0.0, 0.0], [1.0; 3], [0.5; 3]);
        assert_eq!((kr(0, Mirror::One), kr(1, Mirror::One)), (one, one));
        assert_eq!((kr(0, Mirror::KrOrOne), kr(1, Mirror::KrOrOne)), (one, half));
        assert_eq!((kr(0, Mirror::KsIfIllum3), kr(1, Mirror::KsIfIllum3)), (red, [0.0; 3]));
        assert_eq!((kr(0, Mirror::KrOrKsIfIllum3), kr(1, Mirror::KrOrKsIfIllum3)), (red, half));
        let rule = MtlRule { mirror: Mirror::One, default_exponent: 19.0, real_optics: false };
        assert_eq!((materials[0].material(rule).spow, materials[1].material(rule).spow), (96.0, 19.0));
        assert_eq!(materials[0].material(rule).kd.to_array(), [0.5; 3]);
    }

    #[test]
    fn what_goes_through_and_what_glows() {
        let text = "newmtl a\nd 0.25\nNi 1.5\nKe 1 2 3\nnewmtl b\nTr 0.25\nNi 0\nnewmtl c\nTr 1\nd 1\nmap_Kd x.png\n\
                    newmtl d\nd 0.5\nTr 0.5\nKd .1 .1 .1\nmap_Kd x.png\nnewmtl e\nTf 1 1 1\nillum 2\nNi 1.45\n";
        let (materials, warnings) = parse_mtl(&Source::new("m.mtl", text)).unwrap();
        assert!(warnings.is_empty(), "{warnings:?}");
        let rule = |real_optics| MtlRule { mirror: Mirror::KrOrKsIfIllum3, default_exponent: 16.0, real_optics };
        let glass = |i: usize| {
            let m = materials[i].material(rule(true));
            (m.ko.r, m.eta, m.thickness.is_some())
        };
        let opaque = (1.0, 1.0, false);
        assert_eq!(
            [0, 1, 2, 3, 4].map(glass),
            [(0.25, 1.5, true), (0.75, 1.0, true), opaque, (0.5, 1.0, true), opaque]
        );
        assert_eq!(materials[0].material(rule(true)).emission, Rgb::new(1.0, 2.0, 3.0));
        let kd = |i: usize| materials[i].material(rule(true)).kd.r;
        assert_eq!([2, 3, 4].map(kd), [1.0, 0.1, 0.0], "a map alone shows as it is");
        let course = materials[0].material(rule(false));
        assert!(course.ko == Rgb::gray(1.0) && course.emission == Rgb::gray(0.0));
        assert_eq!(materials[0].beyond_the_course(), ["`d` or `Tr`", "`Ke`"]);
        let (_, warnings) =
            parse_mtl(&Source::new("m.mtl", "newmtl a\nTf .5 1 1\nPm 1\nillum 7\nPm 0\nNi -3\nd -halo 1\n")).unwrap();
        assert!(
            warnings.len() == 1 && warnings[0].message.contains("`Tf`, `Pm`, `illum 7`, `Ni -3`, `d -halo 1`"),
            "{warnings:?}"
        );
        // What was never looked at before is no reason to refuse a model.
        for line in
            ["d 2", "Tr x", "d", "d 0,5", "Tr 1 1 1", "Ke spectral a.rfl", "Ke inf 0 0", "Ni", "Ni 1 2", "Ni nan"]
        {
            let (read, warnings) = parse_mtl(&Source::new("m.mtl", format!("newmtl a\nKd 1 1 1\n{line}\n"))).unwrap();
            assert!(read[0].beyond_the_course().is_empty(), "{line}");
            assert!(warnings.len() == 1 && warnings[0].message.contains(&format!("`{line}`")), "{warnings:?}");
        }
    }

    #[test]
    fn textures_and_unknown_words_are_warned_of() {
        let (_, warnings) = parse_mtl(&Source::new("m.mtl", "newmtl a\nmap_Ks no.png\nKq 3\n")).unwrap();
        assert!(warnings[0].message.contains("`no.png`") && warnings[0].message.contains("missing"));
        assert_eq!(warnings[1].warning, Some(WarningCode::UnknownKeyword));
        assert!(parse_mtl(&Source::new("m.mtl", "Kd 1 1 1\n")).unwrap_err().message.contains("newmtl"));
        assert!(parse_mtl(&Source::new("m.mtl", "newmtl a\nKd 1 1\n")).unwrap_err().message.contains("read 2"));
    }

    #[test]
    fn a_texture_is_a_file_behind_its_options() {
        for (line, file, options) in [
            ("map_Kd wall.png", Some("wall.png"), None),
            ("map_Kd  my  old wall.png  # not new", Some("my  old wall.png"), None),
            ("map_Kd tex\\wall.png", Some("tex\\wall.png"), None),
            ("map_Kd -s 1 1 1 wall.png", Some("wall.png"), Some("-s 1 1 1")),
            (
                "map_Kd -s 2 -o 0.5 -0.5 -clamp on -mm 0 1 a wall.png",
                Some("a wall.png"),
                Some("-s 2 -o 0.5 -0.5 -clamp on -mm 0 1"),
            ),
            ("map_Kd -s 1 1 1 1.png", Some("1.png"), Some("-s 1 1 1")),
            ("map_Kd -odd 3 x wall.png", Some("wall.png"), Some("-odd 3 x")),
            ("map_Kd -clamp", None, Some("-clamp")),
            ("map_Kd", None, None),
            ("map_Ks wall.png", None, None),
        ] {
            let text = format!("newmtl a\n{line}\n");
            let (materials, warnings) = parse_mtl(&Source::new("m.mtl", text.as_str())).unwrap();
            assert_eq!(materials[0].map_kd.as_deref(), file, "{line}");
            let ignored = warnings.iter().find(|w| w.message.contains("options"));
            assert_eq!(ignored.is_some(), options.is_some(), "{line}");
            assert!(ignored.is_none_or(|w| w.message.contains(&format!("`{}`", options.unwrap()))), "{line}");
        }
    }

    proptest! {
        #[test]
        fn no_text_breaks_the_reader(words in prop::collection::vec(
            prop::sample::select(vec!["newmtl", "Ka", "Kd", "Ns", "illum", "map_Kd", "-s", "-clamp", "-x", "1", "-.5", "nan", "x", "\n", "#"]), 0..60,
        )) {
            let _ = parse_mtl(&Source::new("m.mtl", words.join(" ")));
        }
    }
}
