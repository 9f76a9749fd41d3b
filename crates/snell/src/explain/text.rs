//! An explanation as a tree of text, which whoever shows it puts together of its pieces.

use super::{Ending, ExplainedNode, ExplainedSample, Explanation, LocalLight, NodeKind, percent};
use crate::film::transfer::{Encoding, Rounding, Transfer};
use crate::scene::Integrator;
use std::fmt::{self, Write};

/// How much of the tree is written.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// So many of the strongest branches are shown.
    pub top: usize,
    /// Bounces that are shown.
    pub depth: u32,
}

impl Default for Style {
    fn default() -> Self {
        Self { top: 16, depth: u32::MAX }
    }
}

/// A part of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Piece {
    /// Words as they are.
    Words(String),
    /// A colour in 8 bit, to be shown before the words that follow, or left out.
    Patch([u16; 3]),
    /// A line of its own: so many rays are not shown, and how to see more of them.
    MoreRays(usize),
}

/// A text, written with `write!`, and patches of colour in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Text {
    /// Its parts, in order.
    pub pieces: Vec<Piece>,
}

impl Text {
    /// Adds a patch of a linear colour.
    pub fn patch(&mut self, color: [f64; 3], transfer: Transfer) {
        self.pieces.push(Piece::Patch(bytes(color, transfer)));
    }
}

impl Write for Text {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        match self.pieces.last_mut() {
            Some(Piece::Words(last)) => last.push_str(words),
            _ => self.pieces.push(Piece::Words(words.to_owned())),
        }
        Ok(())
    }
}

/// A colour in 8 bit.
pub fn bytes(color: [f64; 3], transfer: Transfer) -> [u16; 3] {
    color.map(|c| Encoding { transfer, rounding: Rounding::Round }.encode(c, 255))
}

/// A colour in four digits.
pub fn numbers(color: [f64; 3]) -> String {
    let [r, g, b] = color.map(|c| format!("{c:.4}"));
    format!("({r}, {g}, {b})")
}

/// The mean of a colour.
pub fn mean(color: [f64; 3]) -> f64 {
    color.iter().sum::<f64>() / 3.0
}

/// A length or a coordinate in at most six digits, whatever its unit.
pub fn six_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let text = format!("{rounded:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

/// Title, sentence, and the tree of each sample.
pub fn text(explanation: &Explanation, style: Style) -> Text {
    let mut text = head(explanation);
    let total = mean(explanation.color) * f64::from(explanation.spp);
    for (number, sample) in explanation.samples.iter().enumerate() {
        if explanation.samples.len() > 1 {
            let _ = writeln!(text, "\nsample {} of {}  {}", number + 1, explanation.spp, numbers(sample.color));
        } else {
            let _ = writeln!(text);
        }
        let tree = Tree::new(sample, total, style, explanation);
        let hidden = sample.nodes.len() - tree.node(&mut text, 0, "", "");
        if hidden > 0 {
            text.pieces.push(Piece::MoreRays(hidden));
        }
    }
    text
}

/// Which pixel, its colour, and the sentence.
pub fn head(explanation: &Explanation) -> Text {
    let Explanation { scene, integrator, pixel: [x, y], size: [width, height], color, transfer, .. } = explanation;
    let [r, g, b] = bytes(*color, *transfer);
    let name = format!("{integrator:?}").to_lowercase();
    let mut text = Text::default();
    let _ = writeln!(text, "{scene}, pixel {x},{y} of {width} x {height}, {name}");
    text.patch(*color, *transfer);
    let _ = writeln!(text, "{} #{r:02x}{g:02x}{b:02x}\n{}", numbers(*color), explanation.sentence);
    text
}

/// A sample's tree, of which only the strongest branches are shown.
struct Tree<'a> {
    sample: &'a ExplainedSample,
    total: f64,
    style: Style,
    explanation: &'a Explanation,
    children: Vec<Vec<usize>>,
    shown: Vec<bool>,
}

impl<'a> Tree<'a> {
    fn new(sample: &'a ExplainedSample, total: f64, style: Style, explanation: &'a Explanation) -> Self {
        let mut children = vec![Vec::new(); sample.nodes.len()];
        for node in &sample.nodes {
            if let Some(parent) = node.parent {
                children[parent].push(node.id);
            }
        }
        let weight = |id: usize| {
            mean(sample.nodes[id].subtotal.map(f64::abs)) + mean(sample.nodes[id].bound.unwrap_or_default())
        };
        // The strongest, with all their parents: a subtotal is in those of its parents.
        let mut order: Vec<usize> = (0..sample.nodes.len()).collect();
        order.sort_by(|&a, &b| weight(b).total_cmp(&weight(a)).then(a.cmp(&b)));
        let mut shown = vec![false; sample.nodes.len()];
        for &id in order.iter().take(style.top) {
            let mut at = Some(id);
            while let Some(id) = at.filter(|&id| !std::mem::replace(&mut shown[id], true)) {
                at = sample.nodes[id].parent;
            }
        }
        Self { sample, total, style, explanation, children, shown }
    }

    fn share(&self, color: [f64; 3]) -> String {
        if self.total == 0.0 { "0 %".to_owned() } else { percent(mean(color) / self.total) }
    }

    /// Writes a ray and those below it; returns how many.
    fn node(&self, text: &mut Text, id: usize, before: &str, below: &str) -> usize {
        let Some(node) = self.sample.nodes.get(id) else { return 0 };
        let mut count = 1;
        let _ = write!(text, "{before}{:>6}  ", self.share(node.subtotal));
        text.patch(node.subtotal, self.explanation.transfer);
        let _ = writeln!(text, "{}", line(node, self.explanation.integrator));
        if let Some(local) = &node.local
            && mean(node.contribution) != 0.0
        {
            let bar = if self.below(id).is_empty() { "        " } else { "│       " };
            let _ = writeln!(text, "{below}{bar}{} its own colour: {}", self.share(node.contribution), lights(local));
        }
        let below_it = self.below(id);
        for (place, &child) in below_it.iter().enumerate() {
            let last = place + 1 == below_it.len();
            let (fork, bar) = if last { ("└─", "  ") } else { ("├─", "│ ") };
            count += self.node(text, child, &format!("{below}{fork}"), &format!("{below}{bar}"));
        }
        count
    }

    /// The children that are shown, the strongest first.
    fn below(&self, id: usize) -> Vec<usize> {
        let mut below: Vec<usize> = self.children[id].iter().copied().filter(|&c| self.shown[c]).collect();
        below.retain(|&child| self.sample.nodes[child].depth <= self.style.depth);
        let weight = |id: usize| mean(self.sample.nodes[id].subtotal);
        below.sort_by(|&a, &b| weight(b).total_cmp(&weight(a)).then(a.cmp(&b)));
        below
    }
}

/// What lights a surface.
fn lights(local: &LocalLight) -> String {
    let mut parts = Vec::new();
    if mean(local.emission) != 0.0 {
        parts.push("it shines".to_owned());
    }
    if mean(local.ambient) != 0.0 {
        parts.push("ambient".to_owned());
    }
    for light in &local.lights {
        let name = &light.name;
        if !light.facing {
            continue;
        }
        if let Some(blocker) = &light.blocked_by {
            parts.push(format!("{name} is behind {blocker}"));
        } else if mean(light.transmittance) == 0.0 {
            parts.push(format!("nothing of {name} arrives"));
        } else {
            let through =
                if light.through.is_empty() { String::new() } else { format!(" through {}", light.through.join(", ")) };
            let shine = if mean(light.highlight) > mean(light.diffuse) { " (highlight)" } else { "" };
            parts.push(format!("{name}{through}{shine}"));
        }
    }
    if parts.is_empty() { "no light".to_owned() } else { parts.join(", ") }
}

/// One ray in a line.
fn line(node: &ExplainedNode, integrator: Integrator) -> String {
    let kind = match node.kind {
        NodeKind::Camera if integrator.starts_at_eye() => "camera ray from the eye",
        NodeKind::Camera => "camera ray from the image plane",
        NodeKind::Mirror => "mirrored",
        NodeKind::Refracted => "refracted",
        NodeKind::Inside => "inside",
    };
    let mut text = kind.to_owned();
    if node.kind == NodeKind::Inside {
        let _ = write!(text, " {}", node.medium);
    }
    if let Some(nm) = node.band_nm {
        let _ = write!(text, " at {nm:.0} nm");
    }
    match &node.hit {
        Some(hit) => {
            let _ = write!(text, " → {} after {}, at {:.1}°", hit.object, six_digits(hit.t), hit.angle_in);
            if hit.total_reflection {
                text += ", total reflection";
            } else if let Some(out) = hit.angle_out {
                let _ = write!(text, " → {out:.1}°");
            }
        }
        None if node.ended == Some(Ending::Missed) && mean(node.contribution) != 0.0 => text += " → background",
        None => {}
    }
    match (node.ended, node.bound) {
        (Some(Ending::Missed), _) if mean(node.contribution) == 0.0 => text += " → nothing",
        (Some(Ending::Depth), Some(bound)) => ended(&mut text, "as deep as allowed", bound),
        (Some(Ending::Threshold), Some(bound)) => ended(&mut text, "it carries too little", bound),
        (Some(Ending::Rays), Some(bound)) => ended(&mut text, "the pixel had all its rays", bound),
        _ => {}
    }
    text
}

fn ended(text: &mut String, why: &str, bound: [f64; 3]) {
    let _ = write!(text, ", not followed: {why}; it could have added {:.5} at most", mean(bound));
}

#[cfg(test)]
mod tests {
    #[test]
    fn lengths_have_six_digits_in_any_unit() {
        let lengths = [38.012_345, 0.462_512_34, 5.0, -999_999.7, 3.801_234_5e-9, 3.801_234_5e15, 0.0];
        let shown = ["38.0123", "0.462512", "5", "-1000000", "3.80123e-9", "3801230000000000", "0"];
        assert_eq!(lengths.map(super::six_digits), shown);
    }
}
