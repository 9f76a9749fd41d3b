//! What a person would say first about a pixel.

use super::angles::angles;
use super::path::SKY;
use super::{How, Leg, Path, by_path};
use crate::color::Rgb;
use crate::trace::{PixelTrace, RayKind, RayTree};
use crate::world::CompiledScene;

/// Parts that are named; the rest is summed up.
const NAMED: usize = 3;

/// A share in words: `61 %`, `0.4 %`.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent.abs() >= 9.95 || percent == 0.0 { format!("{percent:.0} %") } else { format!("{percent:.1} %") }
}

/// A word for a linear colour.
pub fn color_name(color: Rgb) -> &'static str {
    let [r, g, b] = color.to_array().map(|c| c.clamp(0.0, 1.0));
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    if most < 0.004 {
        return "black";
    }
    if most - least < 0.12 * most {
        return match most {
            _ if most < 0.03 => "nearly black",
            _ if most < 0.6 => "grey",
            _ if most < 0.9 => "light grey",
            _ => "white",
        };
    }
    // The angle of hue of HSV, in degrees.
    let hue = 60.0
        * match () {
            () if most == r => (g - b) / (most - least),
            () if most == g => 2.0 + (b - r) / (most - least),
            () => 4.0 + (r - g) / (most - least),
        };
    match if hue < 0.0 { hue + 360.0 } else { hue } {
        h if !(12.0..345.0).contains(&h) => "red",
        h if h < 42.0 => {
            if most < 0.25 {
                "brown"
            } else {
                "orange"
            }
        }
        h if h < 68.0 => "yellow",
        h if h < 165.0 => "green",
        h if h < 200.0 => "turquoise",
        h if h < 255.0 => "blue",
        h if h < 300.0 => "violet",
        _ => "pink",
    }
}

/// The sentence.
pub(super) fn of(compiled: &CompiledScene, trace: &PixelTrace) -> String {
    let mut parts = by_path(compiled, trace);
    // Light may be negative, in the colours of single wavelengths. Of equally strong parts the first stays the first.
    parts.sort_by(|a, b| b.1.mean().abs().total_cmp(&a.1.mean().abs()));
    let total: f64 = parts.iter().map(|(_, sum)| sum.mean().abs()).sum();
    let Some((strongest, sum)) = parts.first() else {
        return "Black because no ray of this pixel found any light.".to_owned();
    };
    let share = |sum: f64| if parts.len() == 1 { "all".to_owned() } else { percent(sum / total) };
    let mut clauses = vec![format!(
        "{} because {} of this pixel is {}{}",
        capitalized(color_name(trace.radiance)),
        share(sum.mean()),
        what(compiled, strongest),
        bending(compiled, trace, strongest)
    )];
    for (path, sum) in parts.iter().take(NAMED).skip(1) {
        clauses.push(format!("{} is {}", share(sum.mean()), what(compiled, path)));
    }
    if parts.len() > NAMED {
        let rest: f64 = parts[NAMED..].iter().map(|(_, sum)| sum.mean()).sum();
        let others = parts.len() - NAMED;
        clauses.push(format!("{} comes along {others} other path{}", share(rest), if others == 1 { "" } else { "s" }));
    }
    clauses.join("; ") + "."
}

/// What is seen at the end of a path, and along which path.
fn what(compiled: &CompiledScene, path: &Path) -> String {
    let end = match path.end.as_str() {
        SKY => "the background".to_owned(),
        name if path.legs.is_empty() => format!("{}`{name}` itself", kind(compiled, name)),
        name => format!("{}`{name}`", kind(compiled, name)),
    };
    let mut legs: Vec<(String, u32)> = Vec::new();
    for Leg { object, how } in &path.legs {
        let leg = match how {
            How::Mirror => format!("in the mirror of `{object}`"),
            How::Refract(0) => format!("through `{object}`"),
            How::Refract(1) => format!("through `{object}` after a reflection inside"),
            How::Refract(n) => format!("through `{object}` after {n} reflections inside"),
        };
        match legs.last_mut() {
            Some((last, times)) if *last == leg => *times += 1,
            _ => legs.push((leg, 1)),
        }
    }
    let legs: Vec<String> = legs
        .into_iter()
        .map(|(leg, times)| match times {
            1 => leg,
            2 => format!("twice {leg}"),
            n => format!("{n} times {leg}"),
        })
        .collect();
    if legs.is_empty() { end } else { format!("{end}, seen {}", legs.join(" and ")) }
}

fn kind(compiled: &CompiledScene, name: &str) -> &'static str {
    let sphere = compiled.world().objects.iter().find(|object| object.name == name);
    let is_sphere = sphere.is_some_and(|object| (object.first as usize) < compiled.world().spheres.len());
    // A name like `sphere 3` says it already.
    if is_sphere && !name.starts_with("sphere") { "the sphere " } else { "" }
}

/// How a path is bent where it first goes into something.
fn bending(compiled: &CompiledScene, trace: &PixelTrace, path: &Path) -> String {
    let mut ends = trace.samples.iter().flat_map(|tree| (0..tree.nodes.len()).map(move |node| (tree, node)));
    let shows = |&(tree, node): &(&RayTree, usize)| {
        tree.nodes[node].contribution != Rgb::gray(0.0) && Path::of(compiled, tree, node) == *path
    };
    let Some((tree, node)) = ends.find(shows) else { return String::new() };
    let chain = std::iter::successors(Some(node), |&n| tree.nodes[n].parent);
    let hits = chain.filter_map(|n| tree.nodes[n].parent.map(|parent| (n, parent)));
    let first = hits.filter(|&(child, _)| tree.nodes[child].kind == RayKind::Refracted).last();
    let Some((_, at)) = first else { return String::new() };
    let Some(hit) = &tree.nodes[at].hit else { return String::new() };
    let bent = angles(tree.nodes[at].dir, hit);
    bent.behind.map_or(String::new(), |behind| format!(" (in at {:.1}° → {behind:.1}°)", bent.before))
}

fn capitalized(word: &str) -> String {
    let mut chars = word.chars();
    chars.next().map_or(String::new(), |first| first.to_uppercase().chain(chars).collect())
}
