//! Why a whole picture is black.

use super::{Explanation, explain};
use crate::color::Rgb;
use crate::film::Film;
use crate::geometry::Bounds;
use crate::scene::{Integrator, Warning, WarningCode};
use crate::trace::{FirstSurface, Propagation};
use crate::world::CompiledScene;

/// So many columns and rows of pixels are looked at.
const GRID: usize = 12;

/// W203 for a finished film without any light, with the reason.
pub fn black_picture(compiled: &CompiledScene, film: &Film) -> Option<Warning> {
    let black = !film.pixels.is_empty() && film.is_finished() && film.pixels.iter().all(|&p| p == Rgb::gray(0.0));
    black.then(|| {
        let message = format!("every pixel is black: {}", reason(compiled, film));
        Warning { code: WarningCode::BlackPicture, place: Vec::new(), message }
    })
}

fn reason(compiled: &CompiledScene, film: &Film) -> String {
    let world = compiled.world();
    if world.primitive_count() == 0 {
        return "there is nothing in the scene".to_owned();
    }
    let black = |color: Rgb| color == Rgb::gray(0.0);
    let glows = world.materials.iter().any(|m| !black(m.emission));
    if black(world.ambient)
        && world.lights.iter().all(|light| black(light.color))
        && world.background.is_black()
        && !glows
    {
        let lights = if world.lights.is_empty() { "the scene has no lights" } else { "its lights are black" };
        return format!("nothing sends out light: {lights}, and there is no `ambient`");
    }
    let (columns, rows) = (film.width(), film.height());
    let all_over = |count: usize| (0..count).step_by(count.div_ceil(GRID)).map(|i| i as u32);
    let pixels = all_over(rows).flat_map(|y| all_over(columns).map(move |x| [film.crop.x + x, film.crop.y + y]));
    let seen = pixels.filter_map(|[x, y]| explain(compiled, x, y)).map(|(explanation, _)| explanation);
    match seen.into_iter().find_map(|explanation| at_surface(compiled, &explanation)) {
        Some(reason) => reason,
        None if all_too_near(compiled) => format!(
            "all of it is so small that it is overlooked: nothing nearer than {:e} counts in this model of light; choose units in which it \
             is larger, or `whitted`",
            FirstSurface::T_MIN
        ),
        None if all_behind(compiled) => "everything lies behind the camera".to_owned(),
        None => "the camera looks past everything that is there: see `eye`, `look_at` and the angle of view".to_owned(),
    }
}

/// Why what the camera's ray meets has no colour.
fn at_surface(compiled: &CompiledScene, explanation: &Explanation) -> Option<String> {
    let [x, y] = explanation.pixel;
    let node = explanation.samples.first()?.nodes.first()?;
    let hit = node.hit.as_ref()?;
    let material = compiled.scene().materials.get(&hit.material);
    let object = &hit.object;
    if material.is_some_and(|m| [m.ka, m.kd, m.ks].iter().all(|&c| c == Rgb::gray(0.0)) && !m.is_transparent()) {
        return Some(format!(
            "`{object}` in pixel {x},{y} has no colour: ka, kd and ks of its material `{}` are 0",
            hit.material
        ));
    }
    let lights = node.local.as_ref().map_or(&[][..], |local| &local.lights);
    let why = match lights {
        [] => "no light shines on it".to_owned(),
        [first, ..] => match &first.blocked_by {
            _ if lights.iter().all(|light| !light.facing) => "it faces away from every light".to_owned(),
            Some(blocker) => format!("`{blocker}` blocks its light `{}`", first.name),
            None => "none of its light reaches the camera".to_owned(),
        },
    };
    Some(format!("`{object}` is seen in pixel {x},{y}, but {why}"))
}

/// Is everything nearer than what the models of the lecture and the course overlook?
fn all_too_near(compiled: &CompiledScene) -> bool {
    let (world, model) = (compiled.world(), compiled.settings().integrator);
    let [width, height] = world.camera.size;
    let (eye, _) = world.camera.ray(width / 2, height / 2);
    let is_near = |Bounds { min, max }: Bounds| {
        let corners: [[f64; 3]; 2] = [(min - eye).into(), (max - eye).into()];
        corners.as_flattened().iter().all(|along| along.abs() < FirstSurface::T_MIN)
    };
    model != Integrator::Whitted
        && world.objects.iter().all(|object| is_near(world.shape(object.first as usize).bounds()))
}

/// Does no shape begin in front of the camera?
fn all_behind(compiled: &CompiledScene) -> bool {
    let world = compiled.world();
    let [width, height] = world.camera.size;
    let (eye, ahead) = world.camera.ray(width / 2, height / 2);
    world.objects.iter().all(|object| {
        let Bounds { min, max } = world.shape(object.first as usize).bounds();
        (min + (max - min) * 0.5 - eye).dot(ahead) < 0.0
    })
}
