//! `snell info`.

use crate::args::InfoArgs;
use crate::excerpt::plain;
use crate::input::{self, what_is};
use crate::progress::short;
use crate::say::{self, FAILED, Failure, OrFail, Outcome, SCENE};
use snell::explain::text::six_digits;
use snell::geometry::Vec3;
use snell::scene::Scene;
use snell::world::World;
use snell_formats::files::{Disk, Files, MAX_SCENE_BYTES};
use snell_formats::given::Given;
use snell_formats::load::Loaded;
use snell_formats::part::{self, Header, PartFile};
use snell_formats::picture::{self, Picture};
use snell_formats::recipe::Recipe;
use snell_formats::text::decode;
use snell_formats::{LoadOptions, Report};
use std::fmt::Write;
use std::io::IsTerminal;
use std::path::Path;

pub fn run(args: &InfoArgs) -> Outcome {
    let given = what_is(&args.file);
    if let Given::Picture(_) = given {
        return about_picture(&picture::read(Path::new(&args.file)).or_fail(FAILED)?, args);
    }
    if given == Given::Part {
        return about_part(PartFile::open(Path::new(&args.file)).or_fail(FAILED)?.header(), args);
    }
    if let Some(report) = given.not_read(&args.file) {
        return Err(Failure::new(SCENE, report));
    }
    if args.scene && Path::new(&args.file).is_file() {
        // Not what it needs besides, which may not be there.
        if let Some(report) = given.no_scene(&args.file) {
            return Err(Failure::new(SCENE, report));
        }
        let bytes = Disk.read(Path::new(&args.file), MAX_SCENE_BYTES).or_fail(SCENE)?;
        return print_text(&decode(&args.file, &bytes).0.text);
    }
    let loaded = input::scene(&args.file, &LoadOptions::from(&args.reading))?;
    if args.scene {
        return print_text(&loaded.source.text);
    }
    let world = loaded.world().or_fail(SCENE)?;
    say::print(&plain(&about_scene(&loaded, &world)))?;
    say::reports(&loaded.warnings_with(&world));
    Ok(())
}

/// As it is into a file, without what would steer a terminal onto one.
fn print_text(text: &str) -> Outcome {
    if std::io::stdout().is_terminal() { say::print(&plain(text)) } else { say::print(text) }
}

fn about_picture(picture: &Picture, args: &InfoArgs) -> Outcome {
    let bits = picture.max.map_or("floating point".to_owned(), |max| format!("0 to {max}"));
    let mut text = format!("{}: {} x {} pixels, {bits}\n", args.file, picture.width, picture.height);
    let recipe = picture.recipe.as_ref().and_then(|r| Recipe::from_json(r).ok());
    let Some(recipe) = recipe else {
        if args.scene {
            let report = Report::error(format!("`{}` does not say how it was made", args.file));
            return Err(Failure::new(FAILED, report));
        }
        text.push_str("it does not say how it was made\n");
        return say::print(&plain(&text));
    };
    if args.scene {
        return print_text(&recipe.text);
    }
    text.push_str(&about_recipe(&recipe));
    let film = recipe.film_sha256.unwrap_or_else(|| "not finished".to_owned());
    let _ = writeln!(text, "film         {film}");
    let _ = writeln!(text, "again        snell render --from {}", args.file);
    say::print(&plain(&text))
}

/// Of which picture it is, and what of it is there.
fn about_part(header: &Header, args: &InfoArgs) -> Outcome {
    let Header { recipe, size: [width, height], crop, spp, pieces, statistics, .. } = header;
    if args.scene {
        return print_text(&recipe.text);
    }
    let mut text = format!("{}: a part of a picture of {width} x {height} pixels, {spp} samples each\n", args.file);
    text.push_str(&about_recipe(recipe));
    for piece in pieces.iter().take(SHOWN) {
        let _ = writeln!(text, "has          {}", part::words(piece.rect, &piece.samples));
    }
    if pieces.len() > SHOWN {
        let _ = writeln!(text, "             … and {} more rectangles", pieces.len() - SHOWN);
    }
    let of = if (crop.width, crop.height) == (*width, *height) { "picture" } else { "crop" };
    let _ = writeln!(text, "share        {} % of all samples of the {of}", six_digits(100.0 * header.share()));
    let _ = writeln!(text, "rays         {}", statistics.rays.total());
    let _ = writeln!(text, "go on        snell render --resume {}", args.file);
    say::print(&plain(&text))
}

/// What a picture, or a part of one, is made of.
fn about_recipe(recipe: &Recipe) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "made by      Snell {}", recipe.snell);
    let _ = writeln!(text, "scene        {} (its text: --scene)", recipe.name);
    for change in &recipe.set {
        let _ = writeln!(text, "changed      {change}");
    }
    if let Some([width, height]) = recipe.size {
        let _ = writeln!(text, "size         {width} x {height}");
    }
    if let Some(crop) = recipe.crop {
        let _ = writeln!(text, "crop         {},{},{},{}", crop.x, crop.y, crop.width, crop.height);
    }
    for model in &recipe.models {
        let _ = writeln!(text, "model        {}", model.path.display());
    }
    text
}

/// More shapes of a kind, or rectangles, than this are counted, not listed.
const SHOWN: usize = 20;

fn about_scene(loaded: &Loaded, world: &World) -> String {
    let Scene { render, camera, lights, materials, spheres, meshes, planes, boxes, discs, lathes, .. } = &*loaded.scene;
    let mut text = format!("{}\n", loaded.source.name);
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:12}{value}");
    };
    if let Some(dialect) = loaded.dialect {
        line("dialect", dialect.name().to_owned());
    }
    let name = |value: &dyn std::fmt::Debug| format!("{value:?}").to_lowercase();
    line(
        "integrator",
        format!("{}, depth {}, shadows {}", name(&render.integrator), render.max_depth, name(&render.shadows())),
    );
    line(
        "picture",
        format!("{} x {}, {}, {}", render.size[0], render.size[1], name(&render.transfer), name(&render.rounding)),
    );
    let view = match (camera.bounds, camera.fov) {
        (None, Some(fov)) => format!("angle of view {fov} degrees"),
        _ => format!("bounds {:?}", camera.window(render.size)),
    };
    line(
        "camera",
        format!("at {:?}, looks at {:?}, {view}, near {}", camera.eye, camera.look_at, camera.image_plane()),
    );
    for (i, light) in lights.iter().enumerate() {
        let place = match (light.position, light.direction) {
            (Some(p), _) => format!("at {p:?}"),
            (_, Some(d)) => format!("at infinity towards {d:?}"),
            _ => String::new(),
        };
        let title = light.name.clone().unwrap_or_else(|| format!("light {}", i + 1));
        let cone = light
            .target
            .map_or(String::new(), |target| format!(" towards {target:?}, cone {}", light.cone.unwrap_or_default()));
        line("light", format!("{title}: {place}{cone}, {:?}", light.color.to_array()));
    }
    for (name, m) in materials {
        let [ka, kd, ks, kr, ko] = [m.ka, m.kd, m.ks, m.kr, m.ko]
            .map(|c| if c.r == c.g && c.g == c.b { c.r.to_string() } else { format!("{:?}", c.to_array()) });
        let eta = m.glass.as_ref().map_or_else(|| format!("eta {}", m.eta), |glass| format!("glass {glass}"));
        line("material", format!("{name}: ka {ka} kd {kd} ks {ks} kr {kr} ko {ko} spow {} {eta}", m.spow));
    }
    let mut list = |kind: &str, count: usize, of: &dyn Fn(usize) -> (Option<String>, String)| {
        for number in 0..count.min(SHOWN) {
            let (name, what) = of(number);
            // What has no name is called by its number, here as in explanations.
            line(kind, format!("{}: {what}", name.unwrap_or_else(|| format!("{kind} {}", number + 1))));
        }
        if count > SHOWN {
            line("", format!("… and {} more of kind `{kind}`", count - SHOWN));
        }
    };
    list("sphere", spheres.len(), &|i| {
        let sphere = &spheres[i];
        let what = format!("at {:?}, radius {}, {}", sphere.center, sphere.radius, sphere.material);
        (sphere.name.clone(), what + &places(sphere.instances.len()))
    });
    list("mesh", meshes.len(), &|i| {
        let (mesh, path) = (&meshes[i], &loaded.mesh_paths[i]);
        let faces = mesh.geometry.as_ref().map_or(mesh.faces.len(), |g| g.faces.len());
        let from = path.as_ref().map_or("written out".to_owned(), |p| p.display().to_string());
        let name = mesh.name.clone().or_else(|| mesh.file.clone());
        (name, format!("{faces} triangles, {from}{}", places(mesh.instances.len())))
    });
    list("plane", planes.len(), &|i| {
        let plane = &planes[i];
        let what =
            format!("at {:?}, normal {:?}, size {:?}, {}", plane.center, plane.normal, plane.size, plane.material);
        (plane.name.clone(), what + &places(plane.instances.len()))
    });
    list("box", boxes.len(), &|i| {
        let cuboid = &boxes[i];
        let what = format!("from {:?} to {:?}, {}", cuboid.min, cuboid.max, cuboid.material);
        (cuboid.name.clone(), what + &places(cuboid.instances.len()))
    });
    list("disc", discs.len(), &|i| {
        let disc = &discs[i];
        let what = format!("at {:?}, normal {:?}, radius {}, {}", disc.center, disc.normal, disc.radius, disc.material);
        (disc.name.clone(), what + &places(disc.instances.len()))
    });
    list("lathe", lathes.len(), &|i| {
        let lathe = &lathes[i];
        let what = format!("{} points, {} segments, {}", lathe.profile.len(), lathe.segments, lathe.material);
        (lathe.name.clone(), what + &places(lathe.instances.len()))
    });
    let memory = short(world.memory() as f64);
    let bounds = world.bounds();
    let at = |p: Vec3| format!("({})", [p.x, p.y, p.z].map(six_digits).join(", "));
    let extent = if world.primitive_count() == 0 {
        "empty".to_owned()
    } else {
        format!("{} to {}", at(bounds.min), at(bounds.max))
    };
    line("bounds", extent);
    line("world", format!("{} primitives, {memory}B", world.primitive_count()));
    let tree = world.tree();
    let [boxes, primitives] = [tree.node_bytes, tree.primitive_bytes].map(|bytes| short(bytes as f64));
    let counts = format!("{} nodes, {} leaves, depth {}", tree.nodes, tree.leaves, tree.depth);
    line("tree", format!("{counts}, {boxes}B of boxes, {primitives}B of primitives"));
    text
}

/// In how many places a shape stands, if it is not one.
fn places(instances: usize) -> String {
    if instances == 0 { String::new() } else { format!(", in {instances} places") }
}
