//! `--light`: why a light is, or is not, on what the pixel shows.

use super::shown;
use snell::explain::Explanation;
use snell::explain::text::{head, mean, numbers, six_digits};
use std::fmt::Write;

/// What the light does at every surface of the pixel that shows its own colour.
pub fn text(explanation: &Explanation, name: &str) -> String {
    let mut text = shown(&head(explanation));
    text.push('\n');
    let mut asks = false;
    for sample in &explanation.samples {
        for node in &sample.nodes {
            let (Some(hit), Some(local)) = (&node.hit, &node.local) else { continue };
            let Some(light) = local.lights.iter().find(|light| light.name == name) else { continue };
            asks = true;
            let at = |point: [f64; 3]| format!("({})", point.map(six_digits).join(", "));
            let _ = write!(text, "on {} at {}: ", hit.object, at(hit.point));
            let through = light.through.join(", ");
            let _ = match (&light.blocked_by, light.block_point) {
                (Some(blocker), Some(point)) => {
                    let under = if through.is_empty() { String::new() } else { format!(", behind {through}") };
                    writeln!(text, "blocked by {blocker} at {}{under}", at(point))
                }
                _ if !light.facing => writeln!(text, "the surface faces away from it"),
                _ if mean(light.transmittance) == 0.0 => {
                    writeln!(text, "nothing of it arrives: out of its cone, or absorbed on the way")
                }
                _ => {
                    let by = if through.is_empty() { String::new() } else { format!(" through {through}") };
                    let [d, h] = [light.diffuse, light.highlight].map(numbers);
                    writeln!(
                        text,
                        "{:.1} % of it arrives{by}: diffuse {d}, highlight {h}",
                        100.0 * mean(light.transmittance)
                    )
                }
            };
        }
    }
    if !asks {
        text.push_str("nothing seen in this pixel is lit by lights\n");
    }
    text
}
