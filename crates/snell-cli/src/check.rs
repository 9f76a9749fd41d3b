//! `snell check`: is a model a solid?

use crate::args::CheckArgs;
use crate::excerpt::plain;
use crate::input::{self, what_is};
use crate::output::{refuse_existing, refuse_inputs};
use crate::say::{self, FAILED, Failure, OrFail, Outcome, SCENE, USAGE};
use crate::solid_text::{as_json, as_text, done_json, done_text};
use snell::geometry::TriangleMesh;
use snell::geometry::solid::{Options, RepairLog, Report as Findings, Step, Verdict, check, repair};
use snell::scene::WarningCode;
use snell_formats::files::{Disk, Files, MAX_MODEL_BYTES};
use snell_formats::given::Given;
use snell_formats::model::{Model, parse_model, write_obj};
use snell_formats::{LoadOptions, Report, disk};
use std::path::Path;
use std::sync::Arc;

pub fn run(args: &CheckArgs) -> Outcome {
    let path = Path::new(&args.model);
    if let Some(output) = &args.output {
        may_write(output, path, args.force)?;
    }
    let named = path.extension().is_some_and(|e| ["obj", "ply", "stl"].iter().any(|m| e.eq_ignore_ascii_case(m)));
    let given = what_is(&args.model);
    if named || matches!(given, Given::Model(_)) {
        return one_model(args, path);
    }
    if let Some(report) = given.not_read(&args.model) {
        return Err(Failure::new(SCENE, report));
    }
    if let Given::Picture(format) = given {
        let report = Report::error(format!("`{}` is {}, not a model", args.model, format.words()));
        return Err(Failure::new(SCENE, report));
    }
    all_meshes(args)
}

fn one_model(args: &CheckArgs, path: &Path) -> Outcome {
    let bytes = Disk.read(path, MAX_MODEL_BYTES).or_fail(SCENE)?;
    let Model { mesh, libraries, lost_uv, mut warnings, .. } = parse_model(path, &bytes).or_fail(SCENE)?;
    drop(bytes);
    // Of no matter here.
    warnings.extend(lost_uv.map(|report| Report { warning: Some(WarningCode::NotDrawn), ..report }));
    say::reports(&warnings);
    let findings = check(&mesh);
    let Some(output) = &args.output else {
        let advice = advice(args, &findings);
        show(args, &as_text(&args.model, &mesh, &findings, &advice), &as_json(&args.model, &findings))?;
        return exit(&[findings]);
    };
    let options = Options { weld: args.weld, largest_hole: usize::from(args.holes) };
    let (mended, log) = repair(&mesh, &options);
    if log.is_empty() && !findings.is_solid() {
        let text = [as_text(&args.model, &mesh, &findings, ""), done_text(&log)];
        let json = serde_json::json!({ "before": as_json(&args.model, &findings), "done": done_json(&log) });
        show(args, &text.join("\n"), &json)?;
        return Err(Failure::new(FAILED, nothing_mended(output, &log)));
    }
    let after = check(&mended);
    disk::write(output, |out| write_obj(&mended, &libraries, out)).or_fail(FAILED)?;
    let name = output.display().to_string();
    let text = [as_text(&args.model, &mesh, &findings, ""), done_text(&log), as_text(&name, &mended, &after, "")];
    let json = serde_json::json!({
        "before": as_json(&args.model, &findings), "done": done_json(&log), "after": as_json(&name, &after),
    });
    show(args, &text.join("\n"), &json)?;
    exit(&[after])
}

/// The meshes of a scene, one by one.
fn all_meshes(args: &CheckArgs) -> Outcome {
    if args.repair {
        let report = Report::error("only models are mended, not the meshes of a scene");
        return Err(Failure::new(USAGE, report.help("models end in .obj, .ply or .stl")));
    }
    let loaded = input::scene(&args.model, &LoadOptions::default())?;
    loaded.world().or_fail(SCENE)?;
    let (mut texts, mut all) = (Vec::new(), Vec::new());
    let mut json = Vec::new();
    for (number, mesh) in (1..).zip(&loaded.scene.meshes) {
        let own = || {
            let vertices = mesh.vertices.iter().map(|&v| v.into()).collect();
            Arc::new(TriangleMesh { vertices, faces: mesh.faces.clone(), ..TriangleMesh::default() })
        };
        let geometry = mesh.geometry.clone().unwrap_or_else(own);
        let findings = check(&geometry);
        let title = mesh.name.as_ref().or(mesh.file.as_ref()).or(mesh.material.as_ref());
        let title = title.map_or(String::new(), |t| format!(", {t}"));
        let name = format!("mesh {number}{title}");
        texts.push(as_text(&name, &geometry, &findings, ""));
        json.push(as_json(&name, &findings));
        all.push(findings);
    }
    if all.is_empty() {
        return Err(Failure::new(SCENE, Report::error(format!("`{}` has no meshes", args.model))));
    }
    show(args, &texts.join("\n"), &json.into())?;
    exit(&all)
}

fn show(args: &CheckArgs, text: &str, json: &serde_json::Value) -> Outcome {
    if args.json { say::print(&format!("{json:#}\n")) } else { say::print(&plain(text)) }
}

/// All is said already.
fn exit(all: &[Findings]) -> Outcome {
    if all.iter().all(Findings::is_solid) {
        return Ok(());
    }
    Err(Failure { code: FAILED, reports: Vec::new() })
}

/// Why a model that is no solid stays as it is.
fn nothing_mended(output: &Path, log: &RepairLog) -> Report {
    let (why, help) = if log.undone.contains(&Step::Weld) {
        ("the weld would leave it worse", "try a smaller --weld")
    } else if log.obstructed_holes > 0 {
        ("what would fill its holes meets other faces", "the holes have to be closed where the model was made")
    } else if log.undone.is_empty() {
        (
            "what is wrong with it cannot be mended without guessing",
            "larger holes are filled with --holes, and cracks with --weld",
        )
    } else {
        ("what was tried would leave it worse", "it has to be mended where it was made")
    };
    Report::error(format!("nothing was mended, and `{}` was not written: {why}", output.display())).help(help)
}

fn advice(args: &CheckArgs, findings: &Findings) -> String {
    if matches!(findings.verdict(), Verdict::Solid | Verdict::Empty | Verdict::Flat) {
        return String::new();
    }
    format!("to mend what can be mended: snell check {} --repair -o mended.obj", args.model)
}

/// A file that is there, the model itself above all, is not written over unless asked.
fn may_write(output: &Path, model: &Path, force: bool) -> Outcome {
    if !output.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj")) {
        let report = Report::error("a mended model is written as OBJ").help("like -o mended.obj");
        return Err(Failure::new(USAGE, report));
    }
    if !(force && output == model) {
        refuse_inputs(output, [model])?;
    }
    refuse_existing(output, force).or_fail(USAGE)?;
    disk::check_writable(output).or_fail(FAILED)
}
