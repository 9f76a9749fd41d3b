//! The light path of a contribution: `camera → glass(refract) → green`.

use crate::trace::{Node, RayKind, RayTree};
use crate::world::CompiledScene;
use std::fmt;

/// What a ray did at an object on its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum How {
    /// Its mirror image was followed.
    Mirror,
    /// It went through, after so many reflections inside.
    Refract(u32),
}

/// One object on the path.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Leg {
    /// Its name.
    pub object: String,
    /// What happened there.
    pub how: How,
}

/// From the camera, by some objects, to what is seen at the end: an object's own colour, or the `sky`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Path {
    /// The objects on the path.
    pub legs: Vec<Leg>,
    /// What is seen.
    pub end: String,
}

/// What the background is called at the end of a path.
pub const SKY: &str = "sky";

/// A text that is no path.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no step of a path: expected `name(mirror)`, `name(refract)` or, at the end, a name")]
pub struct PathError(pub String);

impl Path {
    /// The path of a node's contribution.
    pub fn of(compiled: &CompiledScene, tree: &RayTree, node: usize) -> Self {
        let end = tree.nodes[node].hit.as_ref().map_or(SKY, |hit| compiled.object(hit.primitive)).to_owned();
        let mut chain: Vec<&Node> =
            std::iter::successors(Some(&tree.nodes[node]), |n| n.parent.map(|p| &tree.nodes[p])).collect();
        chain.reverse();
        let mut legs: Vec<Leg> = Vec::new();
        // The objects that have been entered, and their legs: what happens inside belongs to them.
        let mut within: Vec<(&str, usize)> = Vec::new();
        for pair in chain.windows(2) {
            let Some(hit) = &pair[0].hit else { continue };
            let object = compiled.object(hit.primitive);
            let refracts = pair[1].kind == RayKind::Refracted;
            let entered = within.iter().rposition(|(name, _)| *name == object).filter(|_| !hit.outer);
            match entered.map(|at| (at, &mut legs[within[at].1].how)) {
                // Out of it, or against its wall from inside.
                Some((at, How::Refract(_))) if refracts => {
                    within.remove(at);
                }
                Some((_, How::Refract(inside))) => *inside += 1,
                _ => {
                    if refracts && pair[1].medium.is_some() {
                        within.push((object, legs.len()));
                    }
                    let how = if refracts { How::Refract(0) } else { How::Mirror };
                    legs.push(Leg { object: object.to_owned(), how });
                }
            }
        }
        Self { legs, end }
    }

    /// Reads what [`Display`](fmt::Display) writes; arrows and `camera` may be left out, and names may be in quotes.
    ///
    /// # Errors
    /// The first step that is none.
    pub fn parse(text: &str) -> Result<Self, PathError> {
        let mut steps = split(text);
        if steps.first().is_some_and(|step| step == "camera") {
            steps.remove(0);
        }
        let is_leg = |end: &str| end.ends_with("(mirror)") || (end.contains("(refract") && end.ends_with(')'));
        let end = steps.pop().filter(|end| !is_leg(end)).ok_or_else(|| PathError(text.to_owned()))?;
        let leg = |step: String| {
            let (object, how) =
                step.strip_suffix(')').and_then(|s| s.rsplit_once('(')).ok_or(PathError(step.clone()))?;
            let how = match how.split_whitespace().collect::<Vec<_>>().as_slice() {
                ["mirror"] => How::Mirror,
                ["refract"] => How::Refract(0),
                ["refract,", count, "inside"] => How::Refract(count.parse().map_err(|_| PathError(step.clone()))?),
                _ => return Err(PathError(step.clone())),
            };
            Ok(Leg { object: object.to_owned(), how })
        };
        Ok(Self { legs: steps.into_iter().map(leg).collect::<Result<_, _>>()?, end })
    }
}

/// Steps between arrows; or, where there is none, between spaces outside of brackets and quotes.
fn split(text: &str) -> Vec<String> {
    // Quotes around a name, perhaps with what happened there behind it.
    let clean = |step: &str| {
        let step = step.trim();
        let quote = step.chars().next().filter(|c| ['"', '`'].contains(c));
        let rest = quote.and_then(|quote| step[1..].split_once(quote).map(|(name, how)| format!("{name}{how}")));
        rest.unwrap_or_else(|| step.to_owned())
    };
    if text.contains('→') || text.contains("->") {
        return text.replace("->", "→").split('→').map(clean).filter(|s| !s.is_empty()).collect();
    }
    let (mut steps, mut step, mut quoted, mut nested) = (Vec::new(), String::new(), false, 0);
    for c in text.chars() {
        match c {
            '"' | '`' => quoted = !quoted,
            '(' => nested += 1,
            ')' => nested -= 1,
            _ => {}
        }
        if c.is_whitespace() && !quoted && nested <= 0 {
            steps.push(std::mem::take(&mut step));
        } else {
            step.push(c);
        }
    }
    steps.push(step);
    steps.iter().map(|step| clean(step)).filter(|s| !s.is_empty()).collect()
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("camera → ")?;
        for Leg { object, how } in &self.legs {
            match how {
                How::Mirror => write!(f, "{object}(mirror) → ")?,
                How::Refract(0) => write!(f, "{object}(refract) → ")?,
                How::Refract(inside) => write!(f, "{object}(refract, {inside} inside) → ")?,
            }
        }
        f.write_str(&self.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_read_as_they_are_written() {
        let leg = |object: &str, how| Leg { object: object.to_owned(), how };
        let paths = [
            Path { legs: vec![], end: "green".to_owned() },
            Path {
                legs: vec![leg("glass", How::Refract(0)), leg("my mirror", How::Mirror)],
                end: "red ball".to_owned(),
            },
            Path { legs: vec![leg("glass", How::Refract(3))], end: "sky".to_owned() },
        ];
        for path in &paths {
            assert_eq!(Path::parse(&path.to_string()).as_ref(), Ok(path));
        }
        assert_eq!(Path::parse("glass(refract) \"my mirror\"(mirror) \"red ball\"").as_ref(), Ok(&paths[1]));
        assert_eq!(Path::parse("glass(refract, 3 inside) sky").as_ref(), Ok(&paths[2]));
        for wrong in ["", "glass(refract)", "glass(bent) green", "glass green blue"] {
            assert!(Path::parse(wrong).is_err(), "{wrong}");
        }
    }
}
