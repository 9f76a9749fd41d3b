//! The planes of incidence along the strongest light path of a pixel, with normals, angles and critical angles, as SVG.

use snell::explain::text::{bytes, mean};
use snell::explain::{ExplainedHit, ExplainedNode, Explanation, NodeKind};
use snell::scene::is_unprintable;
use std::f64::consts::PI;
use std::fmt::Write;

/// Panels in a row, and their width and height.
const COLUMNS: usize = 3;
const WIDTH: f64 = 320.0;
const HEIGHT: f64 = 340.0;
/// Width of the title, and letters of a name, at most.
const TITLE: f64 = 480.0;
const LONGEST: usize = 34;
/// More surfaces than this are left out.
const MOST: usize = 9;
/// Length of the rays that are drawn, and where they meet the surface.
const RAY: f64 = 105.0;
const MIDDLE: [f64; 2] = [WIDTH / 2.0, 172.0];

/// One panel for each surface on the path of the strongest contribution.
pub fn figure(explanation: &Explanation) -> String {
    let nodes = explanation.samples.iter().map(|sample| sample.nodes.as_slice());
    let strongest = nodes
        .flat_map(|nodes| nodes.iter().map(move |node| (nodes, node)))
        .max_by(|a, b| mean(a.1.contribution).total_cmp(&mean(b.1.contribution)));
    let mut path: Vec<(&[ExplainedNode], &ExplainedNode)> = Vec::new();
    let mut at = strongest;
    while let Some((nodes, node)) = at {
        path.push((nodes, node));
        at = node.parent.map(|parent| (nodes, &nodes[parent]));
    }
    path.reverse();
    let panels: Vec<String> = path.iter().filter_map(|(nodes, node)| panel(nodes, node)).take(MOST).collect();
    let (columns, rows) = (panels.len().min(COLUMNS), panels.len().div_ceil(COLUMNS));
    let [x, y] = explanation.pixel;
    let [r, g, b] = bytes(explanation.color, explanation.transfer);
    // The title needs some room even where there is no panel below it.
    let (width, height) = ((WIDTH * columns as f64).max(TITLE), HEIGHT * rows as f64 + 44.0);
    let dark = strongest.is_none_or(|(_, node)| node.contribution == [0.0; 3]);
    let what = match (panels.is_empty(), dark) {
        (true, _) => "its ray meets nothing",
        (false, true) => "no light comes along its paths; one of them",
        (false, false) => "along its strongest light path",
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"system-ui, sans-serif\" font-size=\"13\">\n<title>{}</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fbfaf8\"/>\n\
         <rect x=\"16\" y=\"14\" width=\"20\" height=\"20\" fill=\"rgb({r},{g},{b})\" stroke=\"#0003\"/>\n\
         <text x=\"44\" y=\"29\" fill=\"#222\">{}, pixel {x},{y}: {what}</text>\n",
        plain(&explanation.sentence),
        plain(&shortened(&explanation.scene)),
    );
    for (number, panel) in panels.iter().enumerate() {
        let (left, top) = ((number % COLUMNS) as f64 * WIDTH, (number / COLUMNS) as f64 * HEIGHT + 44.0);
        let _ = writeln!(svg, "<g transform=\"translate({left} {top})\">\n{panel}</g>");
    }
    svg + "</svg>\n"
}

/// The surface that a ray meets: the ray from the upper left, what it mirrors, and what goes through.
fn panel(nodes: &[ExplainedNode], node: &ExplainedNode) -> Option<String> {
    let hit: &ExplainedHit = node.hit.as_ref()?;
    let carries = |mirrored: bool| {
        let children = nodes.iter().filter(|n| n.parent == Some(node.id) && is_mirrored(node, n) == mirrored);
        children.map(|n| mean(n.throughput)).sum::<f64>() / mean(hit.throughput)
    };
    let (mirrored, refracted) = (carries(true), carries(false));
    let [cx, cy] = MIDDLE;
    let at = |degrees: f64, length: f64, down: f64| {
        let (sin, cos) = libm::sincos(degrees * PI / 180.0);
        (cx + sin * length, cy + down * cos * length)
    };
    let mut svg = String::new();
    let behind = if hit.eta_behind == hit.eta_before { "#e9e6e0" } else { "#dcebf2" };
    let _ = writeln!(svg, "<rect x=\"12\" y=\"{cy}\" width=\"{}\" height=\"118\" fill=\"{behind}\"/>", WIDTH - 24.0);
    let _ = writeln!(
        svg,
        "<line x1=\"12\" y1=\"{cy}\" x2=\"{}\" y2=\"{cy}\" stroke=\"#456\" stroke-width=\"1.5\"/>",
        WIDTH - 12.0
    );
    let _ = writeln!(
        svg,
        "<line x1=\"{cx}\" y1=\"{}\" x2=\"{cx}\" y2=\"{}\" stroke=\"#888\" stroke-dasharray=\"4 4\"/>",
        cy - 118.0,
        cy + 118.0
    );
    let _ = writeln!(
        svg,
        "<text x=\"16\" y=\"24\" fill=\"#222\" font-weight=\"600\">{}</text>",
        plain(&shortened(&hit.object))
    );
    let _ = writeln!(svg, "<text x=\"16\" y=\"{}\" fill=\"#567\">n = {:.4}</text>", cy - 8.0, hit.eta_before);
    if hit.eta_behind != hit.eta_before {
        let _ = writeln!(svg, "<text x=\"16\" y=\"{}\" fill=\"#567\">n = {:.4}</text>", cy + 18.0, hit.eta_behind);
    }
    if hit.eta_behind < hit.eta_before {
        let critical = libm::asin(hit.eta_behind / hit.eta_before) * 180.0 / PI;
        let (x, y) = at(-critical, RAY + 8.0, -1.0);
        let _ = writeln!(
            svg,
            "<line x1=\"{cx}\" y1=\"{cy}\" x2=\"{x:.1}\" y2=\"{y:.1}\" stroke=\"#c0842a\" stroke-dasharray=\"2 4\"/>"
        );
        let _ = writeln!(
            svg,
            "<text x=\"{x:.1}\" y=\"{:.1}\" fill=\"#a06a1c\" text-anchor=\"middle\">critical {critical:.1}°</text>",
            y - 6.0
        );
    }
    let (x, y) = at(-hit.angle_in, RAY, -1.0);
    ray(&mut svg, (x, y), (cx, cy), "#3a4657");
    // Beside the ray, away from the normal, unless it would lie on the surface.
    let beside = |angle: f64| if angle < 55.0 { angle + 16.0 } else { angle - 16.0 };
    label(&mut svg, at(-beside(hit.angle_in), 74.0, -1.0), &format!("{:.1}°", hit.angle_in));
    if mirrored > 0.0 {
        ray(&mut svg, (cx, cy), at(hit.angle_in, RAY, -1.0), "#b4573c");
        let name = if hit.total_reflection { "total reflection" } else { "mirrored" };
        caption(&mut svg, HEIGHT - 32.0, "#b4573c", &format!("{name}: {:.1} %", 100.0 * mirrored));
    }
    if refracted > 0.0 {
        let angle = hit.angle_out.unwrap_or(hit.angle_in);
        ray(&mut svg, (cx, cy), at(angle, RAY, 1.0), "#1d7a86");
        label(&mut svg, at(beside(angle), 74.0, 1.0), &format!("{angle:.1}°"));
        caption(&mut svg, HEIGHT - 14.0, "#1d7a86", &format!("goes through: {:.1} %", 100.0 * refracted));
    }
    Some(svg)
}

/// Is a child on the side that its parent came from?
fn is_mirrored(parent: &ExplainedNode, child: &ExplainedNode) -> bool {
    let side = |dir: [f64; 3]| {
        parent.hit.as_ref().map_or(0.0, |hit| hit.normal.iter().zip(dir).map(|(n, d)| n * d).sum::<f64>())
    };
    child.kind != NodeKind::Camera && side(child.dir) > 0.0
}

fn ray(svg: &mut String, from: (f64, f64), to: (f64, f64), color: &str) {
    let ((x1, y1), (x2, y2)) = (from, to);
    let _ = writeln!(
        svg,
        "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{color}\" stroke-width=\"2.5\" stroke-linecap=\"round\"/>"
    );
    // An arrowhead in the middle.
    let (mx, my) = (f64::midpoint(x1, x2), f64::midpoint(y1, y2));
    let angle = libm::atan2(y2 - y1, x2 - x1) * 180.0 / PI;
    let _ = writeln!(
        svg,
        "<path d=\"M6 0 L-5 5 L-5 -5 Z\" fill=\"{color}\" transform=\"translate({mx:.1} {my:.1}) rotate({angle:.1})\"/>"
    );
}

fn label(svg: &mut String, (x, y): (f64, f64), text: &str) {
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{:.1}\" fill=\"#222\" text-anchor=\"middle\" paint-order=\"stroke\" stroke=\"#fbfaf8\" stroke-width=\"3\">{text}</text>",
        y + 4.0
    );
}

fn caption(svg: &mut String, y: f64, color: &str, text: &str) {
    let _ = writeln!(svg, "<text x=\"16\" y=\"{y}\" fill=\"{color}\">{text}</text>");
}

/// A name that fits into a panel.
fn shortened(name: &str) -> String {
    if name.chars().count() <= LONGEST {
        name.to_owned()
    } else {
        name.chars().take(LONGEST - 1).chain(['…']).collect()
    }
}

/// As XML 1.0 has it, which knows no control characters, no U+FFFE and no U+FFFF.
fn plain(text: &str) -> String {
    let odd = |c: char| is_unprintable(c) || matches!(c, '\u{fffe}' | '\u{ffff}');
    text.replace(odd, "\u{fffd}").replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
