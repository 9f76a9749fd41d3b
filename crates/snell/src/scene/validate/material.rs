//! Checks of materials and of their textures.

use super::{Findings, MAX_BANDS, Step};
use crate::color::Rgb;
use crate::optics::dispersion::{LINE_D_NM, NoIndex};
use crate::optics::spectrum;
use crate::scene::{Integrator, Material, Scene, Shadows, WarningCode};

/// More terms of Sellmeier's sum than anybody publishes.
const MAX_TERMS: usize = 8;

pub(super) fn materials(scene: &Scene, found: &mut Findings) {
    for (name, m) in &scene.materials {
        let at = |key: &str| place!["material", name.as_str(), key];
        let colors = [("ka", m.ka), ("kd", m.kd), ("ks", m.ks), ("kr", m.kr), ("ko", m.ko), ("emission", m.emission)];
        for (key, value) in colors {
            found.color(&at(key), value);
            if let Some(below) = value.to_array().into_iter().find(|&v| v < 0.0) {
                let what = match key {
                    "ko" => "more goes through than arrives",
                    _ => "light is taken away where it should be added",
                };
                let message = format!("{key} of material `{name}` is {below}: {what}");
                found.warning(WarningCode::NegativeCoefficient, at(key), message);
            }
        }
        if m.ko.to_array().iter().any(|&ko| ko > 1.0) {
            let message = format!("material `{name}` is more than opaque: its transparent share 1 - ko is negative");
            found.warning(WarningCode::OpacityAboveOne, at("ko"), message);
        }
        found.not_negative(at("spow"), m.spow, "an exponent");
        absorption(found, &at, m);
        dispersion(scene, found, &at, m);
        if let Some(thickness) = m.thickness {
            found.not_negative(at("thickness"), thickness, "a thickness");
        }
        if let Some(texture) = &m.texture
            && !scene.textures.contains_key(texture)
        {
            let known = super::names(scene.textures.keys());
            let help = format!("textures of this scene: {known}; or add [texture.{texture}]");
            found.problem(at("texture"), format!("no texture is called `{texture}`"), &help);
        }
        found.positive(at("eta"), m.eta, "an index of refraction", "glass is about 1.5, water 1.33");
    }
}

/// What glows is seen, but lights nothing: once for a scene with something that could be lit, and where light is not only painted.
pub(super) fn emission(scene: &Scene, found: &mut Findings) {
    let black = |color: Rgb| color == Rgb::gray(0.0);
    let painted = scene.render.integrator != Integrator::Whitted || scene.render.shadows() == Shadows::Off;
    let could_be_lit = !painted && scene.materials.values().any(|m| black(m.emission) && !black(m.kd));
    let glows = scene.materials.iter().find(|(_, m)| !black(m.emission));
    if let Some((name, _)) = glows.filter(|_| could_be_lit) {
        let message = format!("`{name}` glows, but lights nothing around it: only a [[light]] does");
        found.warning(WarningCode::EmissionLightsNothing, place!["material", name.as_str(), "emission"], message);
    }
}

fn dispersion(scene: &Scene, found: &mut Findings, at: &impl Fn(&str) -> Vec<Step>, m: &Material) {
    // An infinite Abbe number is no dispersion at all.
    let abbe = m.abbe.filter(|&abbe| abbe != f64::INFINITY);
    let given = [
        ("glass", m.glass.is_some()),
        ("abbe", abbe.is_some()),
        ("cauchy", m.cauchy.is_some()),
        ("sellmeier", m.sellmeier.is_some()),
    ];
    let mut given = given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key);
    let Some(key) = given.next() else { return };
    if let Some(other) = given.next() {
        found.problem(
            at(other),
            format!("dispersion is given twice: by `{key}` and by `{other}`"),
            "remove one of them",
        );
        return;
    }
    if key != "abbe" && m.eta != 1.0 {
        let message = format!("the index is given twice: by `{key}` and by `eta`");
        found.problem(at("eta"), message, "remove one of them");
    }
    if abbe.is_some_and(|abbe| !found.number(at("abbe"), abbe) || abbe <= 0.0) {
        found.problem(at("abbe"), "an Abbe number must be above 0", "crown glass has about 60, flint about 30");
        return;
    }
    if m.cauchy.is_some_and(|cauchy| !found.numbers(&at("cauchy"), &cauchy)) {
        return;
    }
    if let Some(pairs) = &m.sellmeier
        && (!found.numbers(&at("sellmeier"), pairs.as_flattened()) || pairs.is_empty() || pairs.len() > MAX_TERMS)
    {
        let message = format!("expected 1 to {MAX_TERMS} pairs B, C");
        return found.problem(at("sellmeier"), message, "most glasses have three, like those of docs/glasses.md");
    }
    let dispersion = match m.dispersion() {
        Ok(dispersion) => dispersion,
        Err(unknown) => return found.problem(at("glass"), unknown.to_string(), "docs/glasses.md lists them all"),
    };
    let bands = if scene.render.integrator == Integrator::Whitted { scene.render.bands } else { 1 };
    if (1..=MAX_BANDS).contains(&bands) {
        let mut wavelengths =
            spectrum::bands(bands as usize).into_iter().map(|band| band.wavelength_nm).chain([LINE_D_NM]);
        if let Some(error) = wavelengths.find_map(|nm| dispersion.eta(nm).err()) {
            let message = match (error, &m.glass) {
                (NoIndex::OutOfRange { range_nm: [from, to], .. }, Some(glass)) => {
                    format!(
                        "the index of `{glass}` is known from {from} to {to} nm; pictures need it from 380 to 780 nm"
                    )
                }
                _ => format!("{error}; pictures need it from 380 to 780 nm"),
            };
            found.problem(at(key), message, "give the index by `eta`");
        }
    }
}

fn absorption(found: &mut Findings, at: &impl Fn(&str) -> Vec<Step>, m: &Material) {
    if let Some(distance) = m.attenuation_distance {
        found.positive(at("attenuation_distance"), distance, "a distance", "");
    }
    let colors = [("attenuation_color", m.attenuation_color), ("sigma_a", m.sigma_a)];
    for (key, color) in colors.into_iter().filter_map(|(key, color)| Some((key, color?))) {
        found.color(&at(key), color);
        for value in color.to_array() {
            found.not_negative(at(key), value, if key == "sigma_a" { "an absorption" } else { "a colour" });
            if key == "attenuation_color" && value > 1.0 {
                found.problem(at(key), format!("glass does not make light: read {value}, expected 0 to 1"), "");
            }
        }
    }
    if m.sigma_a.is_some() && m.attenuation_color.is_some() {
        let message = "absorption is given twice: by `sigma_a`, and by a colour at a distance";
        found.problem(at("sigma_a"), message, "remove one of them");
    }
    if m.attenuation_color.is_some() != m.attenuation_distance.is_some() {
        let key = if m.attenuation_color.is_some() { "attenuation_color" } else { "attenuation_distance" };
        let message =
            "`attenuation_color` is the colour of white light after `attenuation_distance`: one says nothing alone";
        found.problem(
            at(key),
            message,
            "give both, like attenuation_color = [0.9, 1, 0.95] and attenuation_distance = 10",
        );
    }
}

/// Real optics squares indices, and nothing known is beyond these.
const INDICES: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

pub(super) fn indices(scene: &Scene, found: &mut Findings) {
    if scene.render.integrator != Integrator::Whitted {
        return;
    }
    let outside = (place!["eta_outside"], scene.eta_outside);
    let materials = scene.materials.iter().map(|(name, m)| (place!["material", name.as_str(), "eta"], m.eta));
    for (place, eta) in materials.chain([outside]) {
        if eta > 0.0 && !INDICES.contains(&eta) {
            found.problem(place, format!("expected an index of refraction from 0.001 to 1000, read {eta}"), "");
        }
    }
}

pub(super) fn textures(scene: &Scene, found: &mut Findings) {
    for (name, texture) in &scene.textures {
        let at = |key: &str| place!["texture", name.as_str(), key];
        found.numbers(&at("repeat"), &texture.repeat);
        for color in texture.checker.iter().flatten() {
            found.color(&at("checker"), *color);
        }
        match (texture.checker.is_some(), texture.image.is_some() || texture.pixels.is_some()) {
            (true, true) => {
                let message = "a texture has a checker or an image, not both";
                found.problem(at("checker"), message, "remove one of them");
            }
            (false, false) => {
                let help = "add `checker = [[1, 1, 1], [0, 0, 0]]`, or `image = \"picture.png\"`";
                let place = place!["texture", name.as_str()];
                found.problem(place, "a texture needs two colours of a checker, or an image", help);
            }
            _ => {}
        }
    }
}
