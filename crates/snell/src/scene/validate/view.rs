//! Checks of what looks and of what shines: camera, lights, sky.

use super::{Findings, Step};
use crate::geometry::Vec3;
use crate::scene::{Light, Scene};

pub(super) fn camera(scene: &Scene, found: &mut Findings) {
    let camera = &scene.camera;
    let at = |key: &str| place!["camera", key];
    let mut fine = true;
    for (key, value) in [("eye", &camera.eye), ("look_at", &camera.look_at), ("up", &camera.up)] {
        fine &= found.numbers(&at(key), value);
    }
    if let Some(far) = camera.far {
        found.number(at("far"), far);
    }
    if let Some(near) = camera.near
        && found.number(at("near"), near)
        && near >= 0.0
    {
        let message = format!("near must be negative, read {near}");
        found.problem(at("near"), message, "the image plane stands in front of the eye, on the negative side, like -5");
    }
    window(scene, found);
    if !fine {
        return;
    }
    let (eye, look_at, up) = (Vec3::from(camera.eye), Vec3::from(camera.look_at), Vec3::from(camera.up));
    if !(eye - look_at).unit().is_finite() {
        found.problem(
            at("look_at"),
            "look_at is where the eye is, or too near, so there is no direction to look in",
            "",
        );
    } else if !up.unit().is_finite() {
        found.problem(at("up"), "up is (0, 0, 0), or too short to be a direction", "try [0, 1, 0]");
    } else if camera.axes().is_none() {
        let message = "up is parallel to the view, so there is no upright picture";
        found.problem(at("up"), message, "choose another up, like [0, 0, 1] when looking straight down y");
    }
}

/// What the picture takes in: bounds, or an angle.
fn window(scene: &Scene, found: &mut Findings) {
    let camera = &scene.camera;
    let at = |key: &str| place!["camera", key];
    if let Some(bounds) = camera.bounds {
        let [left, right, bottom, top] = bounds;
        if found.numbers(&at("bounds"), &bounds) && (left == right || bottom == top) {
            let message = format!("the bounds have no area: left {left}, right {right}, bottom {bottom}, top {top}");
            found.problem(at("bounds"), message, "the order is left, right, bottom, top, like [-2, 2, -2, 2]");
        }
        if camera.near.is_none() && camera.fov.is_none() {
            let help =
                "add `near = -distance`, how far before the eye it stands, or give `fov = degrees` instead of `bounds`";
            found.problem(at("near"), "`bounds` are measured on the image plane, and nothing says where that is", help);
        }
    }
    if let Some(fov) = camera.fov
        && !(1e-3..=179.0).contains(&fov)
    {
        found.problem(at("fov"), format!("expected an angle from 0.001 to 179 degrees, read {fov}"), "40 is usual");
    }
    match (camera.bounds, camera.fov) {
        (Some(_), Some(_)) => {
            found.problem(at("fov"), "a camera has bounds or an angle of view, not both", "remove one of them");
        }
        (None, None) => {
            let help = "add `bounds = [left, right, bottom, top]`, or `fov = degrees`";
            found.problem(place!["camera"], "a camera needs bounds or an angle of view", help);
        }
        _ => {}
    }
}

pub(super) fn lights(scene: &Scene, found: &mut Findings) {
    for (i, light) in scene.lights.iter().enumerate() {
        found.color(&place!["light", i, "color"], light.color);
        spot(light, i, found);
        match (light.position, light.direction) {
            (Some(position), None) => {
                found.numbers(&place!["light", i, "position"], &position);
            }
            (None, Some(direction)) => {
                let at = place!["light", i, "direction"];
                if found.numbers(&at, &direction) && !Vec3::from(direction).unit().is_finite() {
                    found.problem(at, "direction is (0, 0, 0), or too short to be one", "");
                }
            }
            (Some(_), Some(_)) => {
                let message = "a light has a position or a direction, not both";
                found.problem(place!["light", i, "direction"], message, "remove one of them");
            }
            (None, None) => {
                let help = "add `position = [x, y, z]`, or `direction = [x, y, z]` for a light at infinity";
                found.problem(place!["light", i], "a light needs a position or a direction", help);
            }
        }
    }
}

fn spot(light: &Light, i: usize, found: &mut Findings) {
    let at = |key: &str| place!["light", i, key];
    let Some(target) = light.target else {
        for key in [light.cone.map(|_| "cone"), light.edge.map(|_| "edge")].into_iter().flatten() {
            let message = format!("`{key}` is for spot lights, and this light has no `target`");
            found.problem(at(key), message, "add `target = [x, y, z]`, or remove it");
        }
        return;
    };
    let towards = Vec3::from(target) - Vec3::from(light.position.unwrap_or_default());
    if found.numbers(&at("target"), &target) && light.position.is_some() && !towards.unit().is_finite() {
        found.problem(at("target"), "the target is where the light is, so it shines nowhere", "");
    }
    if light.direction.is_some() {
        let message = "a light at infinity has no target";
        found.problem(at("target"), message, "give the light a `position`, or remove `target`");
    }
    let Some(cone) = light.cone else {
        let help = "add `cone = degrees`, from its middle to its edge";
        return found.problem(at("target"), "a spot light needs a cone", help);
    };
    if !(cone > 0.0 && cone <= 180.0) {
        let message = format!("expected an angle above 0 and at most 180 degrees, read {cone}");
        found.problem(at("cone"), message, "30 is a usual spot light");
    } else if let Some(edge) = light.edge
        && !(0.0..=cone).contains(&edge)
    {
        let message = format!("expected an angle from 0 to that of the cone, {cone} degrees, read {edge}");
        found.problem(at("edge"), message, "");
    }
}

pub(super) fn sky(scene: &Scene, found: &mut Findings) {
    let Some(sky) = &scene.sky else { return };
    let at = |key: &str| place!["sky", key];
    if scene.background != crate::color::Rgb::gray(0.0) {
        let message = "where nothing is, there is a background or a sky, not both";
        found.problem(place!["background"], message, "remove one of them");
    }
    let colors = [("horizon", sky.horizon), ("zenith", sky.zenith), ("nadir", sky.nadir)];
    for (key, color) in colors.into_iter().filter_map(|(key, color)| Some((key, color?))) {
        found.color(&at(key), color);
        if sky.image.is_some() {
            let message = "a sky has colours or a picture, not both";
            found.problem(at(key), message, "remove one of them");
        }
    }
    if sky.horizon.is_none() && sky.image.is_none() && sky.pixels.is_none() {
        let help = "add `horizon = [r, g, b]`, or `image = \"sky.exr\"`";
        found.problem(place!["sky"], "a sky needs a colour at the horizon, or a picture", help);
    }
    for (key, given) in [("brightness", sky.brightness != 1.0), ("rotate", sky.rotate != 0.0)] {
        if given && sky.horizon.is_some() {
            found.problem(at(key), format!("`{key}` is for pictures of a sky"), "remove it, or change the colours");
        }
    }
    found.number(at("rotate"), sky.rotate);
    found.not_negative(at("brightness"), sky.brightness, "a brightness");
}
