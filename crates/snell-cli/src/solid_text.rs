//! What `snell check` found, for people and for programs.

use serde_json::{Value, json};
use snell::explain::text::six_digits;
use snell::geometry::solid::{Component, EdgePlace, FacePlace, Found, Orientation, RepairLog, Report, Step, Verdict};
use snell::geometry::{TriangleMesh, Vec3};
use std::fmt::Write;

/// So many findings of a kind are listed for people.
const LISTED: usize = 3;
/// So many components are listed.
const COMPONENTS: usize = 10;

/// The report, verdict first.
pub fn as_text(name: &str, mesh: &TriangleMesh, report: &Report, advice: &str) -> String {
    let mut text = format!("{name}: {}\n", verdict(report));
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:15}{value}");
    };
    let gone = mesh.faces.len() - report.faces;
    let gone = if gone > 0 {
        format!(" of {}; the others have no three different corners", mesh.faces.len())
    } else {
        String::new()
    };
    line("faces", format!("{}{gone}", report.faces));
    let apart = mesh.vertices.len() != report.vertices;
    let apart = if apart { format!(" (places; {} in the file)", mesh.vertices.len()) } else { String::new() };
    line("vertices", format!("{}{apart}", report.vertices));
    line("edges", format!("{}, Euler number {}", report.edges, report.euler()));
    if report.is_solid() {
        line("volume", six_digits(report.volume()));
    }
    for (number, component) in report.components.iter().take(COMPONENTS).enumerate() {
        line("component", format!("{number}: {}", about(component)));
    }
    if report.components.len() > COMPONENTS {
        line("", format!("… and {} more components", report.components.len() - COMPONENTS));
    }
    let mut list = |name: &str, count: usize, places: Vec<String>| {
        if count > 0 {
            line(name, count.to_string());
            places.into_iter().take(LISTED).for_each(|place| line("", place));
            if count > LISTED {
                line("", format!("… and {} more", count - LISTED));
            }
        }
    };
    for (name, found) in
        [("open edges", &report.boundary), ("crowded edges", &report.non_manifold), ("at odds", &report.misoriented)]
    {
        list(name, found.count, found.first.iter().map(edge).collect());
    }
    for (name, found) in [
        ("turned faces", &report.against),
        ("broken faces", &report.broken),
        ("without area", &report.degenerate),
        ("copies", &report.duplicate),
    ] {
        list(name, found.count, found.first.iter().map(face).collect());
    }
    let crossing =
        report.crossing.first.iter().map(|c| format!("faces {} and {} near {}", c.faces[0], c.faces[1], at(c.at)));
    list("crossings", report.crossing.count, crossing.collect());
    if !report.complete {
        line("", "not all pairs of faces were looked at: the mesh is too entangled".to_owned());
    }
    if !advice.is_empty() {
        let _ = writeln!(text, "{advice}");
    }
    text
}

fn verdict(report: &Report) -> String {
    let count = |good: fn(&Component) -> bool| report.components.iter().filter(|c| !good(c)).count();
    let also = if report.crossing.is_empty() { "" } else { ", but faces cross or touch each other" };
    match report.verdict() {
        Verdict::Solid if report.components.len() == 1 => format!("a solid{also}"),
        Verdict::Solid => format!("{} solids{also}", report.components.len()),
        Verdict::InsideOut => {
            let inward = count(|c| !c.inside_out);
            format!("a solid, but inside out ({inward} of {} components){also}", report.components.len())
        }
        Verdict::Flat => format!("no solid: closed, but {} components enclose nothing", count(Component::is_solid)),
        Verdict::Misoriented => {
            format!("no solid: closed, but the faces along {} edges look different ways", report.misoriented.count)
        }
        Verdict::Open if report.boundary.is_empty() && report.broken.count > 0 => {
            format!("no solid: {} faces have vertices that are not there or not finite", report.broken.count)
        }
        Verdict::Open => {
            format!("no solid: open along {} edges", report.components.iter().map(|c| c.open_edges).sum::<usize>())
        }
        Verdict::Empty => "no solid: it has no faces with three different corners".to_owned(),
    }
}

fn about(c: &Component) -> String {
    let look = match (c.orientation, c.cavity, c.inside_out) {
        _ if !c.is_closed() => "open".to_owned(),
        _ if !c.orientable => "closed, not orientable".to_owned(),
        _ if !c.is_oriented() => "closed, at odds with itself".to_owned(),
        (Orientation::None, ..) => "flat".to_owned(),
        (Orientation::Inward, true, _) => format!("a cavity of {}", six_digits(-c.volume)),
        (.., true) => "inside out".to_owned(),
        _ => format!("a solid of {}", six_digits(c.volume)),
    };
    format!("{look}, {} faces, Euler number {}, {} to {}", c.faces, c.euler(), at(c.bounds.min), at(c.bounds.max))
}

fn edge(e: &EdgePlace) -> String {
    let faces = if e.faces == 1 { "face".to_owned() } else { format!("{} faces, one of them", e.faces) };
    format!("from {} to {}, {faces} {}", at(e.ends[0]), at(e.ends[1]), e.face)
}

fn face(f: &FacePlace) -> String {
    format!("face {} at {}", f.face, at(f.at))
}

fn at(p: Vec3) -> String {
    format!("({}, {}, {})", six_digits(p.x), six_digits(p.y), six_digits(p.z))
}

/// What was done, one line for each thing.
pub fn done_text(log: &RepairLog) -> String {
    let mut text = "repair:\n".to_owned();
    for (count, what) in [
        (log.welded_vertices, "vertices became one with another"),
        (log.broken_faces, "broken faces removed"),
        (log.degenerate_faces, "faces without area removed or mended"),
        (log.duplicate_faces, "copies of faces removed"),
        (log.turned_faces, "faces turned to agree with their neighbours"),
        (log.filled_holes, "holes filled"),
        (log.new_faces, "new faces in them"),
        (log.turned_components, "components turned outward"),
        (log.unused_vertices, "unused vertices removed"),
        (log.obstructed_holes, "holes left open: what would fill them meets other faces"),
    ] {
        if count > 0 {
            let _ = writeln!(text, "  {count:<9}{what}");
        }
    }
    for step in &log.undone {
        let _ = writeln!(text, "  undone   {}: the model would be worse", step_name(*step));
    }
    if *log == RepairLog::default() {
        text.push_str("  nothing to do\n");
    }
    text
}

fn step_name(step: Step) -> &'static str {
    match step {
        Step::Weld => "weld",
        Step::Copies => "remove copies of faces",
        Step::Turn => "turn faces to agree with their neighbours",
        Step::Fill => "fill holes",
        Step::Lines => "mend faces without area",
        Step::Outward => "turn components outward",
    }
}

/// The same as [`done_text`].
pub fn done_json(log: &RepairLog) -> Value {
    json!({
        "welded_vertices": log.welded_vertices, "broken_faces": log.broken_faces,
        "degenerate_faces": log.degenerate_faces, "duplicate_faces": log.duplicate_faces,
        "turned_faces": log.turned_faces, "filled_holes": log.filled_holes, "new_faces": log.new_faces,
        "turned_components": log.turned_components, "unused_vertices": log.unused_vertices,
        "obstructed_holes": log.obstructed_holes,
        "undone": log.undone.iter().map(|step| format!("{step:?}").to_lowercase()).collect::<Vec<_>>(),
    })
}

/// The whole report but `component_of`. What is not finite is null.
pub fn as_json(name: &str, report: &Report) -> Value {
    let point = |p: Vec3| json!([p.x, p.y, p.z]);
    let faces = |found: &Found<FacePlace>| {
        let first: Vec<Value> = found.first.iter().map(|f| json!({ "face": f.face, "at": point(f.at) })).collect();
        json!({ "count": found.count, "first": first })
    };
    let edges = |found: &Found<EdgePlace>| {
        let place = |e: &EdgePlace| json!({ "ends": e.ends.map(point), "face": e.face, "faces": e.faces });
        json!({ "count": found.count, "first": found.first.iter().map(place).collect::<Vec<_>>() })
    };
    let lower = |value: &dyn std::fmt::Debug| format!("{value:?}").to_lowercase();
    let component = |c: &Component| {
        json!({
            "solid": c.is_solid(), "closed": c.is_closed(), "oriented": c.is_oriented(), "orientable": c.orientable,
            "orientation": lower(&c.orientation), "cavity": c.cavity, "inside_out": c.inside_out, "faces": c.faces,
            "vertices": c.vertices, "edges": c.edges, "euler": c.euler(), "open_edges": c.open_edges,
            "misoriented_edges": c.misoriented_edges, "volume": c.volume,
            "bounds": [point(c.bounds.min), point(c.bounds.max)],
        })
    };
    let crossing = report.crossing.first.iter().map(|c| json!({ "faces": c.faces, "at": point(c.at) }));
    let verdict = match report.verdict() {
        Verdict::InsideOut => "inside-out".to_owned(),
        other => lower(&other),
    };
    json!({
        "model": name, "verdict": verdict, "solid": report.is_solid(), "faces": report.faces,
        "vertices": report.vertices, "edges": report.edges, "euler": report.euler(), "volume": report.volume(),
        "components": report.components.iter().map(component).collect::<Vec<_>>(),
        "boundary_edges": edges(&report.boundary), "non_manifold_edges": edges(&report.non_manifold),
        "misoriented_edges": edges(&report.misoriented), "turned_faces": faces(&report.against),
        "broken_faces": faces(&report.broken), "degenerate_faces": faces(&report.degenerate),
        "duplicate_faces": faces(&report.duplicate),
        "crossings": { "count": report.crossing.count, "first": crossing.collect::<Vec<_>>(), "complete": report.complete },
    })
}
