//! Checks of names.

use super::{Findings, Step};
use crate::scene::{Scene, WarningCode};

/// Names are shown in explanations, on pages and in messages, where a character that steers a terminal would do so.
pub(super) fn names(scene: &Scene, found: &mut Findings) {
    let mut look = |place: Vec<Step>, name: &str| {
        if let Some(odd) = name.chars().find(|&c| is_unprintable(c)) {
            let message = format!(
                "a name holds the character U+{:04X}, which cannot be seen; it is shown as U+FFFD",
                u32::from(odd)
            );
            found.warning(WarningCode::UnprintableName, place, message);
        }
    };
    for (name, _) in &scene.materials {
        look(place!["material", name.as_str()], name);
    }
    for (name, _) in &scene.textures {
        look(place!["texture", name.as_str()], name);
    }
    let lights = scene.lights.iter().map(|l| &l.name).enumerate().map(|(i, name)| ("light", i, name));
    let spheres = scene.spheres.iter().map(|s| &s.name).enumerate().map(|(i, name)| ("sphere", i, name));
    let meshes = scene.meshes.iter().map(|m| &m.name).enumerate().map(|(i, name)| ("mesh", i, name));
    let planes = scene.planes.iter().map(|p| &p.name).enumerate().map(|(i, name)| ("plane", i, name));
    let boxes = scene.boxes.iter().map(|b| &b.name).enumerate().map(|(i, name)| ("box", i, name));
    let discs = scene.discs.iter().map(|d| &d.name).enumerate().map(|(i, name)| ("disc", i, name));
    let lathes = scene.lathes.iter().map(|l| &l.name).enumerate().map(|(i, name)| ("lathe", i, name));
    for (kind, i, name) in lights.chain(spheres).chain(meshes).chain(planes).chain(boxes).chain(discs).chain(lathes) {
        if let Some(name) = name {
            look(place![kind, i, "name"], name);
        }
    }
}

/// A character that steers a terminal, or changes the direction in which the rest of a line is read (UAX #9).
pub fn is_unprintable(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}
