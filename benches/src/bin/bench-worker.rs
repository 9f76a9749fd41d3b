//! Stays alive, does what its input says, a line each, and answers with a line of JSON: so that a runner can take
//! turns with other programs, and preparing is paid for once.
//!
//! | line | what | answer |
//! | --- | --- | --- |
//! | `build SCENE THREADS` | compiles the scene | `seconds`, `bytes`, `primitives` |
//! | `frame SCENE SIZE DEPTH THREADS` | renders a picture twice into the same memory, and times the second | `seconds`, `rays`, `peak_bytes` of the process so far |
//! | `rays KIND THREADS` | traces `primary`, `shadow` or `bounce` rays on the knot | `seconds`, `rays`, `hits`, `mean_t` |
//! | `export DIR` | writes the knot and its rays for `peers/embree.cpp` | `triangles` |
//! | `scene SCENE SIZE FILE` | saves the scene as JSON | `primitives` |

#![allow(clippy::print_stdout, reason = "its answers go there")]

use snell::geometry::TriangleMesh;
use snell::render::{Options, Settings, render, render_into};
use snell::world::World;
use snell_bench::rays::{Found, Kind, RaySets};
use snell_bench::{build, knot, scenes};
use snell_formats::scene_file::{Syntax, to_text};
use std::collections::HashMap;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Pixels a side of the picture that the ray sets belong to.
const RAYS_SIZE: u32 = 1024;

fn main() -> io::Result<()> {
    let mut worker = Worker::default();
    for line in io::stdin().lines() {
        let line = line?;
        let answer =
            worker.answer(&line).unwrap_or_else(|error| format!("{{\"error\": {:?}}}", format!("{line}: {error}")));
        println!("{answer}");
        io::stdout().flush()?;
    }
    Ok(())
}

/// What is prepared when it is first asked for.
#[derive(Default)]
struct Worker {
    worlds: HashMap<(String, u32), (World, Settings)>,
    knot: Option<Knot>,
    found: Found,
}

struct Knot {
    mesh: Arc<TriangleMesh>,
    world: World,
    rays: RaySets,
}

impl Worker {
    fn answer(&mut self, line: &str) -> Result<String, String> {
        match *line.split_whitespace().collect::<Vec<_>>() {
            ["build", name, threads] => {
                let (world, time) = build(&scenes::find(name, RAYS_SIZE)?, number(threads)?)?;
                Ok(format!("{}, \"bytes\": {}, {}}}", timed(time), world.memory(), primitives(&world)))
            }
            ["frame", name, size, depth, threads] => self.frame(name, number(size)?, number(depth)?, number(threads)?),
            ["rays", kind, threads] => self.rays(kind, number(threads)?),
            ["export", folder] => {
                let knot = self.knot()?;
                export(knot, Path::new(folder)).map_err(|e| e.to_string())?;
                Ok(format!("{{\"triangles\": {}}}", knot.mesh.faces.len()))
            }
            ["scene", name, size, file] => {
                let mut scene = scenes::find(name, number(size)?)?;
                for mesh in &mut scene.meshes {
                    if let Some(geometry) = mesh.geometry.take() {
                        mesh.vertices = geometry.vertices.iter().map(|&v| v.into()).collect();
                        mesh.faces.clone_from(&geometry.faces);
                    }
                }
                let text = to_text(&scene, Syntax::Json).map_err(|report| format!("{report:?}"))?;
                fs::write(file, text).map_err(|e| e.to_string())?;
                Ok(format!("{{{}}}", primitives(&build(&scene, 1)?.0)))
            }
            _ => Err("not understood; see the top of bench-worker.rs".to_owned()),
        }
    }

    fn frame(&mut self, name: &str, size: u32, depth: u32, threads: usize) -> Result<String, String> {
        let key = (name.to_owned(), size);
        if !self.worlds.contains_key(&key) {
            let scene = scenes::find(name, size)?;
            self.worlds.insert(key.clone(), (build(&scene, 1)?.0, Settings::from(&scene)));
        }
        let (world, settings) = self.worlds.get(&key).ok_or("the scene is gone")?;
        let settings = Settings { max_depth: depth, ..settings.clone() };
        let options = Options { threads, ..Options::default() };
        // The first one fetches the memory.
        let mut film = render(world, &settings, &options).map_err(|e| e.to_string())?.film;
        let start = Instant::now();
        let statistics = render_into(&mut film, world, &settings, &options).map_err(|e| e.to_string())?;
        let time = start.elapsed();
        let rays = statistics.rays.total();
        Ok(format!("{}, \"rays\": {rays}, \"peak_bytes\": {}}}", timed(time), peak_bytes()))
    }

    fn rays(&mut self, kind: &str, threads: usize) -> Result<String, String> {
        let (_, kind) = *Kind::ALL.iter().find(|(name, _)| *name == kind).ok_or("kinds: primary, shadow, bounce")?;
        self.knot()?;
        let Self { knot: Some(knot), found, .. } = self else { return Err("the knot is gone".to_owned()) };
        let start = Instant::now();
        found.trace(&knot.world, &knot.rays, kind, threads);
        let time = start.elapsed();
        let (rays, (hits, mean)) = (knot.rays.of(kind).t_max.len(), found.summary(kind));
        Ok(format!("{}, \"rays\": {rays}, \"hits\": {hits}, \"mean_t\": {mean}}}", timed(time)))
    }

    fn knot(&mut self) -> Result<&Knot, String> {
        if self.knot.is_none() {
            let mesh = Arc::new(knot::on_ground());
            let (world, _) = build(&scenes::knot_on_ground(Arc::clone(&mesh), RAYS_SIZE), 1)?;
            if world.primitive_count() != mesh.faces.len() {
                return Err("a face of the knot is without area, so that numbers do not agree".to_owned());
            }
            let rays = RaySets::new(&world, &mesh, RAYS_SIZE);
            self.knot = Some(Knot { mesh, world, rays });
        }
        self.knot.as_ref().ok_or_else(|| "the knot is gone".to_owned())
    }
}

fn number<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("`{text}` is not a number"))
}

/// The start of an answer.
fn timed(time: Duration) -> String {
    format!("{{\"seconds\": {}", time.as_secs_f64())
}

fn primitives(world: &World) -> String {
    format!("\"primitives\": {}", world.primitive_count())
}

/// Most memory that this process has held at a time, from Linux; 0 elsewhere.
fn peak_bytes() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let kib =
        status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix("kB")?.trim().parse().ok());
    kib.unwrap_or(0u64) * 1024
}

/// Little-endian: `knot.mesh` has the numbers of vertices and faces (u32), positions (f32), faces (u32); `KIND.rays`
/// the number of rays (u32), then the columns of origin, direction and `t_max` (f32).
fn export(knot: &Knot, folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let count = |n: usize| (n as u32).to_le_bytes();
    let mut file = BufWriter::new(fs::File::create(folder.join("knot.mesh"))?);
    file.write_all(&count(knot.mesh.vertices.len()))?;
    file.write_all(&count(knot.mesh.faces.len()))?;
    for v in &knot.mesh.vertices {
        [v.x, v.y, v.z].iter().try_for_each(|&c| file.write_all(&(c as f32).to_le_bytes()))?;
    }
    knot.mesh.faces.iter().flatten().try_for_each(|v| file.write_all(&v.to_le_bytes()))?;
    file.flush()?;
    for (name, kind) in Kind::ALL {
        let rays = knot.rays.of(kind);
        let mut file = BufWriter::new(fs::File::create(folder.join(format!("{name}.rays")))?);
        file.write_all(&count(rays.t_max.len()))?;
        for column in rays.origin.iter().chain(&rays.dir).chain([&rays.t_max]) {
            column.iter().try_for_each(|&v| file.write_all(&(v as f32).to_le_bytes()))?;
        }
        file.flush()?;
    }
    Ok(())
}
