//! What can be typed.

use clap::builder::styling::{AnsiColor, Styles};
use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use serde::de::IntoDeserializer;
use serde::de::value::{Error as ValueError, StrDeserializer};
use snell::film::Crop;
use snell::geometry::bvh::Quality;
use snell::lanes::LaneWidth;
use snell::scene::{Integrator, MAX_DEPTH, MAX_SPP, Rounding, Shadows, Transfer};
use snell_formats::builtin::SCENES;
use snell_formats::driver::Dialect;
use snell_formats::schema::Form;
use std::ffi::OsStr;
use std::path::PathBuf;
use std::time::Duration;

const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Yellow.on_default().bold())
    .usage(AnsiColor::Yellow.on_default().bold())
    .literal(AnsiColor::Cyan.on_default());

/// A ray tracer that shows its work: exact pictures of light that reflects and refracts.
#[derive(Debug, Parser)]
#[command(name = "snell", version, styles = STYLES, arg_required_else_help = true, after_help = "\
Start here:
  snell render lecture/default         the lecture's picture, as default.png
  snell scenes                         what else is built in
  snell scenes --save lecture/default  a copy to change

Exit codes: 0 done, 1 difference or failure, 2 wrong usage, 3 the scene cannot be drawn, 130 stopped (^C, SIGTERM, SIGHUP)")]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    Render(Box<RenderArgs>),
    Explain(Box<ExplainArgs>),
    Info(InfoArgs),
    Scenes(ScenesArgs),
    Studio(StudioArgs),
    Convert(ConvertArgs),
    Diff(DiffArgs),
    Merge(MergeArgs),
    Check(CheckArgs),
    /// Print a JSON Schema: of scene files, for editors; of ray trees (`snell explain --json`); or of what the viewer shows
    Schema {
        #[arg(value_name = "FORM", default_value = "scene", value_parser = form)]
        form: Form,
    },
    /// Print completions for a shell
    #[command(after_help = "Example:\n  snell completions bash > ~/.local/share/bash-completion/completions/snell")]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

/// Render scenes to pictures
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  snell render lecture/default
  snell render lecture/default -o glass.png --set material.glass.eta=1.5
  snell render driver00.txt -o driver00.ppm --search models/
  snell render lecture/default --size 4096x4096 --crop 1800,1800,400,400 -o rim.exr
  snell render drivers/*.txt -o out/
  snell render --from glass.png -o smooth.png --spp 64
  snell render - -o - --format ppm < scene.toml > picture.ppm
  snell render scene.toml --spp 4096 --checkpoint work.npz --until 2h -o night.exr
  snell render --resume work.npz -o night.exr
  snell render scene.toml --spp 64 --rows 0:256 --part top.npz
  snell render scene.toml --sweep material.glass.eta=1.3:1.7:9 -o 'glass_{eta}.png'
  snell render scene.toml --keys camera.toml --frames 1:240 -o 'movie/{frame}.png'")]
pub struct RenderArgs {
    /// Scene files, driver files, or names of built-in scenes; - is standard input
    #[arg(required_unless_present_any = ["from", "resume"], value_name = "SCENE", value_parser = SceneName, hide_possible_values = true)]
    pub scenes: Vec<String>,
    /// The picture, or a folder for many; the ending decides the format: .png .ppm .exr .npy; - is standard output; of many
    /// pictures the pattern of their names, with {frame}, {index} and {KEY}
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Format of the pictures in a folder, and on standard output
    #[arg(long, value_name = "FORMAT", value_parser = ["png", "ppm", "exr", "npy"], default_value = "png")]
    pub format: String,
    /// Render a picture again, from what a PNG or EXR of Snell remembers, with what is changed by other options
    #[arg(long, value_name = "PICTURE", conflicts_with_all = ["scenes", "dialect"])]
    pub from: Option<PathBuf>,

    /// Write a part for `snell merge` instead of a picture: the samples that --rows and --samples select
    #[arg(long, value_name = "FILE.npz", conflicts_with_all = ["output", "paths", "only"], help_heading = "Parts")]
    pub part: Option<PathBuf>,
    /// With --part: only rows A to B - 1
    #[arg(long, value_name = "A:B", requires = "part", value_parser = range, help_heading = "Parts")]
    pub rows: Option<[u32; 2]>,
    /// With --part: only samples A to B - 1 of each pixel, out of --spp
    #[arg(long, value_name = "A:B", requires = "part", value_parser = range, help_heading = "Parts")]
    pub samples: Option<[u32; 2]>,
    /// Save the work to this file while rendering, and when stopped
    #[arg(long, value_name = "FILE.npz", conflicts_with_all = ["part", "paths", "only"], help_heading = "Parts")]
    pub checkpoint: Option<PathBuf>,
    /// How often to save: 30s (default), 10m, 2h
    #[arg(long, value_name = "TIME", value_parser = duration, help_heading = "Parts")]
    pub every: Option<Duration>,
    /// Continue a checkpoint or part, and save to it; with a larger --spp, add samples
    #[arg(long, value_name = "FILE.npz", conflicts_with_all = ["scenes", "from", "part", "dialect", "paths", "only"], help_heading = "Parts")]
    pub resume: Option<PathBuf>,
    /// Stop after this time (like 2h), and save the work
    #[arg(long, value_name = "TIME", value_parser = duration, help_heading = "Parts")]
    pub until: Option<Duration>,

    /// A picture for each value of a key: A:B:N (N evenly spaced numbers) or a list, like `["BK7", "SF10"]`; if repeated,
    /// all combinations; finished pictures are skipped, and several machines may run the same command on one folder
    #[arg(long, value_name = "KEY=VALUES", conflicts_with_all = MANY_NOT, help_heading = "Many pictures")]
    pub sweep: Vec<String>,
    /// A picture for each frame of a movie; the file gives key frames of the camera or any other key of the scene
    #[arg(long, value_name = "FILE.toml", conflicts_with_all = MANY_NOT, help_heading = "Many pictures")]
    pub keys: Option<PathBuf>,
    /// Frames A to B, both included; by default from the first key frame to the last
    #[arg(long, value_name = "A:B", requires = "keys", value_parser = frames, help_heading = "Many pictures")]
    pub frames: Option<[u32; 2]>,

    /// Width and height in pixels; a shape other than the scene's shows more of it, unless `--stretch` is given
    #[arg(long, value_name = "WxH", value_parser = size, help_heading = "Picture")]
    pub size: Option<[u32; 2]>,
    /// With --size: keep the bounds, even if pixels are no longer square
    #[arg(long, requires = "size", help_heading = "Picture")]
    pub stretch: bool,
    /// Only this part: left, top, width, height in pixels
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop, help_heading = "Picture")]
    pub crop: Option<Crop>,
    /// Samples per pixel: 1 is the point of the grid, 16 make smooth edges
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SPP)), help_heading = "Picture")]
    pub spp: Option<u32>,
    /// The curve to 8 and 16 bit: linear or srgb
    #[arg(long, value_name = "CURVE", value_parser = named::<Transfer>, help_heading = "Picture")]
    pub transfer: Option<Transfer>,
    /// The fraction in 8 and 16 bit: round or truncate
    #[arg(long, value_name = "HOW", value_parser = named::<Rounding>, help_heading = "Picture")]
    pub rounding: Option<Rounding>,
    /// Bits per channel of a PNG: 8 (default) or 16
    #[arg(long, value_name = "N", value_parser = bits, help_heading = "Picture")]
    pub bits: Option<u8>,
    /// Write PPM as bytes (P6) instead of text (P3)
    #[arg(long, help_heading = "Picture")]
    pub binary: bool,

    /// How many bounces may follow the camera ray, at most 1000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_DEPTH)), help_heading = "Light")]
    pub depth: Option<u32>,
    /// The model of light: lecture, course2018, course2020 or whitted
    #[arg(long, value_name = "NAME", value_parser = named::<Integrator>, help_heading = "Light")]
    pub integrator: Option<Integrator>,
    /// What blocks a light: off (nothing), opaque (anything) or tinted (whitted's default: what is transparent dims it)
    #[arg(long, value_name = "KIND", value_parser = named::<Shadows>, help_heading = "Light")]
    pub shadows: Option<Shadows>,

    /// One layer for each of the N strongest light paths, and one for the rest: an EXR whose layers add up to the picture
    #[arg(long, value_name = "N", conflicts_with = "only", value_parser = clap::value_parser!(u32).range(1..=1000), help_heading = "Light")]
    pub paths: Option<u32>,
    /// Only the light of one path, like "glass(refract) green"
    #[arg(long, value_name = "PATH", help_heading = "Light")]
    pub only: Option<String>,

    #[command(flatten)]
    pub reading: ReadingArgs,

    /// Threads; 0: as many as `SNELL_THREADS` says, else `OMP_NUM_THREADS`, else `SLURM_CPUS_PER_TASK`, else one for each core that
    /// this process may use (affinity, CPU quotas)
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024), help_heading = "Work")]
    pub threads: u16,
    /// Let other programs go first: niceness 10, or --nice=N, from 0 to 19
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true, default_missing_value = "10", value_parser = clap::value_parser!(u8).range(0..=19), help_heading = "Work")]
    pub nice: Option<u8>,
    /// Edge of a tile in pixels; the picture does not depend on it
    #[arg(long, value_name = "N", default_value_t = TILE, value_parser = clap::value_parser!(u32).range(1..=4096), help_heading = "Work")]
    pub tile: u32,
    /// How many numbers are computed together: 1, 2, 4 or 8; left out: as many as this machine has instructions for; the
    /// picture does not depend on it
    #[arg(long, value_name = "N", env = "SNELL_LANES", value_parser = lanes, help_heading = "Work")]
    pub lanes: Option<LaneWidth>,
    /// How the tree over the shapes is built: fast for a first look, best for long renders; the picture does not depend
    /// on it
    #[arg(long, value_name = "QUALITY", default_value = "good", value_parser = quality, help_heading = "Work")]
    pub bvh: Quality,
    /// Say nothing but errors
    #[arg(short, long, help_heading = "Work")]
    pub quiet: bool,
    /// How to show progress on stderr
    #[arg(long, value_name = "KIND", value_enum, default_value_t = ProgressKind::Auto, help_heading = "Work")]
    pub progress: ProgressKind,
}

/// Why a pixel has the colour it has: the tree of its rays, whose contributions add up to it, bit for bit
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  snell explain lecture/default 256,256
  snell explain lecture/default 190,300 --html why.html      the tree and its rays in 3D, in one file
  snell explain lecture/default 256,256 --svg why.svg        angles at every surface on the path
  snell explain lecture/default 256,400 --light left         why is this light missing here?
  snell explain lecture/default 256,256 --without glass      the same pixel without an object
  snell explain lecture/default 256,256 --set material.glass.eta=1.05
  snell explain lecture/default --find green --mask green.png
  snell explain glass.png 100,80                             of the scene that a picture remembers")]
pub struct ExplainArgs {
    /// A scene file, a driver file, the name of a built-in scene, or a PNG or EXR of Snell; - is standard input
    #[arg(value_parser = SceneName, hide_possible_values = true)]
    pub scene: String,
    /// Column and row of the pixel, from the top left
    #[arg(value_name = "X,Y", value_parser = pixel, required_unless_present = "find")]
    pub pixel: Option<[u32; 2]>,
    /// Print the tree as JSON
    #[arg(long, conflicts_with_all = ["html", "svg", "light", "set", "without"], help_heading = "Form")]
    pub json: bool,
    /// Write a page that shows the tree and its rays in 3D; it needs nothing else and opens from disk
    #[arg(long, value_name = "FILE", conflicts_with_all = ["svg", "light", "set", "without"], help_heading = "Form")]
    pub html: Option<PathBuf>,
    /// Write a drawing of the angles at each surface on the strongest path
    #[arg(long, value_name = "FILE", conflicts_with_all = ["light", "set", "without"], help_heading = "Form")]
    pub svg: Option<PathBuf>,
    /// Show no more bounces than this
    #[arg(long, value_name = "N", help_heading = "Form")]
    pub depth: Option<u32>,
    /// Show so many of the strongest branches
    #[arg(long, value_name = "N", help_heading = "Form")]
    pub top: Option<usize>,
    /// Why is this light on, or not on, what the pixel shows?
    #[arg(long, value_name = "NAME", conflicts_with_all = ["set", "without"], help_heading = "Questions")]
    pub light: Option<String>,
    /// The same pixel without an object
    #[arg(long, value_name = "OBJECT", help_heading = "Questions")]
    pub without: Option<String>,
    /// Which pixels show this object, and along which paths?
    #[arg(long, value_name = "OBJECT", conflicts_with_all = ["pixel", "json", "html", "svg", "light", "without"], help_heading = "Questions")]
    pub find: Option<String>,
    /// With --find: a picture of where it is seen, and how much
    #[arg(long, value_name = "FILE", requires = "find", help_heading = "Questions")]
    pub mask: Option<PathBuf>,
    /// Width and height of the picture
    #[arg(long, value_name = "WxH", value_parser = size, help_heading = "Scene")]
    pub size: Option<[u32; 2]>,
    /// Samples per pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SPP)), help_heading = "Scene")]
    pub spp: Option<u32>,
    /// The model of light
    #[arg(long, value_name = "NAME", value_parser = named::<Integrator>, help_heading = "Scene")]
    pub integrator: Option<Integrator>,
    /// What blocks a light
    #[arg(long, value_name = "KIND", value_parser = named::<Shadows>, help_heading = "Scene")]
    pub shadows: Option<Shadows>,
    /// Changes by `--set` are what would be: the pixel is shown before and after
    #[command(flatten)]
    pub reading: ReadingArgs,
}

/// How scene files are read.
#[derive(Debug, Args, Clone, Default)]
#[command(next_help_heading = "Reading")]
pub struct ReadingArgs {
    /// Change a value of the scene; may be given many times
    #[arg(long, value_name = "KEY=VALUE", value_parser = assignment)]
    pub set: Vec<String>,
    /// Look for models here first; may be given many times
    #[arg(long, value_name = "DIR", value_parser = folder)]
    pub search: Vec<PathBuf>,
    /// Year of a driver file, if it is not recognised: 2018, lecture, 2019 or 2020
    #[arg(long, value_name = "YEAR", value_parser = dialect)]
    pub dialect: Option<Dialect>,
}

impl From<&ReadingArgs> for snell_formats::LoadOptions {
    fn from(args: &ReadingArgs) -> Self {
        Self {
            search: args.search.clone(),
            dialect: args.dialect,
            set: args.set.clone(),
            ..snell_formats::LoadOptions::default()
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressKind {
    /// A bar, if stderr is a terminal
    Auto,
    /// One JSON object a line
    Json,
}

/// Say what is in a scene, a driver, or a picture or part made by Snell
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  snell info lecture/default
  snell info driver00.txt
  snell info glass.png           how it was made
  snell info part.npz            of which picture, and which samples of it
  snell info glass.png --scene   the text of its scene")]
pub struct InfoArgs {
    /// Scene file, driver file, built-in name, picture, or part; - is standard input
    #[arg(value_parser = SceneName, hide_possible_values = true)]
    pub file: String,
    /// Print the text of the scene, as it is in the file, and nothing else
    #[arg(long, conflicts_with = "set")]
    pub scene: bool,
    #[command(flatten)]
    pub reading: ReadingArgs,
}

/// List the built-in scenes, or save one to start from
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  snell scenes\n  snell scenes --save lecture/default -o mine.toml")]
pub struct ScenesArgs {
    /// Write this built-in scene to a file
    #[arg(long, value_name = "NAME", value_parser = SceneName, hide_possible_values = true)]
    pub save: Option<String>,
    /// The file; NAME.toml in this folder if left out
    #[arg(short, long, value_name = "FILE", requires = "save")]
    pub output: Option<PathBuf>,
    /// Overwrite the file if there is one
    #[arg(long)]
    pub force: bool,
}

/// Open Snell Studio in the browser: the ray tracer, to look at, to change, and to ask
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  snell studio
  snell studio scene.toml      this scene, and again whenever it or one of its models is saved
  snell studio gallery/prism

It is served to this machine alone, until ^C.")]
pub struct StudioArgs {
    /// Scene file, driver file, or built-in name
    #[arg(value_parser = SceneName, hide_possible_values = true)]
    pub scene: Option<String>,
    /// The port to listen at; 0 takes a free one. What a page keeps belongs to its port
    #[arg(long, value_name = "N", default_value_t = 1621)]
    pub port: u16,
    /// Open no browser, only print the address
    #[arg(long)]
    pub no_open: bool,
}

/// Turn a driver or NFF file into a scene file (or TOML into JSON and back)
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  snell convert driver00.txt                  prints the scene
  snell convert driver00.txt -o driver00.toml
  snell convert lecture/default -o default.json")]
pub struct ConvertArgs {
    /// Driver file, scene file, or built-in name; - is standard input
    #[arg(value_parser = SceneName, hide_possible_values = true)]
    pub file: String,
    /// The scene file, .toml or .json, with large meshes in files beside it; printed as TOML if left out
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Overwrite the file if there is one
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub reading: ReadingArgs,
}

/// Join parts of a picture that were rendered apart: the same bits as if it had been rendered at once
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  snell render scene.toml --spp 64 --samples 0:32 --part a.npz
  snell render scene.toml --spp 64 --samples 32:64 --part b.npz
  snell merge a.npz b.npz -o picture.png
  snell merge part-1*.npz -o tenth.npz        some of many, into one part")]
pub struct MergeArgs {
    /// Parts (`snell render --part`, or checkpoints) of one picture, of which no sample is there twice; of different --spp, above
    /// 1, they join to a picture of the largest
    #[arg(required = true, value_name = "PART")]
    pub parts: Vec<PathBuf>,
    /// The picture (.png .ppm .exr .npy), which all parts together must cover; or a part (.npz)
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Compare two pictures; exit code 1 if they differ by more than the tolerance
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  snell diff mine.ppm course.ppm
  snell diff a.npy b.npy --tolerance 1e-9
  snell diff a.png b.png -o difference.png

Pictures with 8 or 16 bit are compared in steps of 8 bit (0 to 255), EXR and NPY by their numbers.")]
pub struct DiffArgs {
    /// A picture: .png .ppm .exr .npy
    pub a: PathBuf,
    /// Another one
    pub b: PathBuf,
    /// Differences up to this count as none
    #[arg(short, long, value_name = "X", default_value_t = 0.0)]
    pub tolerance: f64,
    /// Write a picture of the difference, brightened so that the largest is white
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Say whether a model is a solid, so that light can refract in it, and mend it; exit code 1 if it is not
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  snell check bunny.obj                            closed? oriented? where not?
  snell check bunny.obj --repair -o mended.obj     fills holes, turns faces, welds, removes copies
  snell check scan.stl --repair -o mended.obj --weld 1e-6
  snell check scene.toml                           all meshes of a scene
  snell check part.ply --json

A solid is closed (every edge has two faces, or an even number), its faces look the same way,
and it has a volume. One that is inside out is a solid, and is said to be. Faces are the
triangles into which polygons are divided, counted from 0. With --repair the exit code is that
of the mended model.

Exit codes: 0 a solid, 1 no solid, 2 wrong usage, 3 the model cannot be read")]
pub struct CheckArgs {
    /// A model (.obj .ply .stl), or a scene with meshes
    pub model: String,
    /// Mend what can be mended without guessing, and write it to the file of -o; nothing is made worse, and nothing written
    /// if nothing can be mended
    #[arg(long, requires = "output")]
    pub repair: bool,
    /// The mended model, .obj
    #[arg(short, long, value_name = "FILE", requires = "repair")]
    pub output: Option<PathBuf>,
    /// Overwrite the file if there is one
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Join vertices of open edges that are no farther apart than this share of the model's diagonal, at most 0.1; 0: only
    /// equal ones
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share, requires = "repair")]
    pub weld: f64,
    /// Fill holes of at most so many edges; 0: none
    #[arg(long, value_name = "EDGES", default_value_t = 100, value_parser = clap::value_parser!(u16).range(0..=1000), requires = "repair")]
    pub holes: u16,
    /// Print everything as JSON
    #[arg(long)]
    pub json: bool,
}

/// What is of one picture only.
const MANY_NOT: [&str; 8] = ["from", "part", "checkpoint", "every", "resume", "until", "paths", "only"];

/// Edge of a tile in pixels, if nobody says: that of the library.
const TILE: u32 = snell::render::TILE_SIZE;

/// Any text, but shells complete the names of built-in scenes.
#[derive(Clone)]
struct SceneName;

impl TypedValueParser for SceneName {
    type Value = String;
    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<String, clap::Error> {
        StringValueParser::new().parse_ref(command, argument, value)
    }
    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(SCENES.iter().map(|(name, _)| PossibleValue::new(*name))))
    }
}

fn share(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|v| (0.0..=0.1).contains(v)).ok_or_else(|| "expected a number from 0 to 0.1".to_owned())
}

/// A value by the name that it has in scene files.
fn named<T: for<'de> serde::Deserialize<'de>>(text: &str) -> Result<T, String> {
    let deserializer: StrDeserializer<'_, ValueError> = text.into_deserializer();
    T::deserialize(deserializer).map_err(|e| e.to_string().replace("variant", "value"))
}

fn assignment(text: &str) -> Result<String, String> {
    if text.contains('=') { Ok(text.to_owned()) } else { Err("it has no `=`; like material.glass.eta=2.42".to_owned()) }
}

fn folder(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if path.is_dir() { Ok(path) } else { Err("there is no such folder".to_owned()) }
}

fn dialect(text: &str) -> Result<Dialect, String> {
    let names: Vec<&str> = Dialect::ALL.iter().map(|d| d.name()).collect();
    let text = if text == "2017" { "2018" } else { text };
    let found = Dialect::ALL.into_iter().find(|d| d.name() == text);
    found.ok_or_else(|| format!("expected one of {}", names.join(", ")))
}

fn form(text: &str) -> Result<Form, String> {
    let found = Form::ALL.into_iter().find(|form| form.name() == text);
    found.ok_or_else(|| format!("expected one of {}", Form::ALL.map(Form::name).join(", ")))
}

fn bits(text: &str) -> Result<u8, String> {
    match text {
        "8" => Ok(8),
        "16" => Ok(16),
        _ => Err("expected 8 or 16".to_owned()),
    }
}

fn lanes(text: &str) -> Result<LaneWidth, String> {
    let width = text.parse().ok().and_then(LaneWidth::of);
    width.ok_or_else(|| "expected 1, 2, 4 or 8 (if it was not typed, it is in SNELL_LANES)".to_owned())
}

fn quality(text: &str) -> Result<Quality, String> {
    match text {
        "fast" => Ok(Quality::Fast),
        "good" => Ok(Quality::Good),
        "best" => Ok(Quality::Best),
        _ => Err("expected fast, good or best".to_owned()),
    }
}

/// `256,300`.
fn pixel(text: &str) -> Result<[u32; 2], String> {
    let numbers: Vec<Option<u32>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    match numbers.as_slice() {
        [Some(x), Some(y)] => Ok([*x, *y]),
        _ => Err("expected column and row, like 256,300".to_owned()),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.trim().parse::<u32>().ok().filter(|&v| v > 0);
    text.split_once(['x', 'X'])
        .and_then(|(w, h)| Some([side(w)?, side(h)?]))
        .ok_or_else(|| "expected width x height in pixels, at least 1, like 640x480".to_owned())
}

fn range(text: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.trim().parse::<u32>().ok();
    text.split_once(':')
        .and_then(|(first, end)| Some([number(first)?, number(end)?]))
        .filter(|[first, end]| first < end)
        .ok_or_else(|| "expected the first one and the one behind the last, like 0:512".to_owned())
}

fn frames(text: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.trim().parse::<u32>().ok();
    text.split_once(':')
        .and_then(|(first, last)| Some([number(first)?, number(last)?]))
        .filter(|[first, last]| first <= last)
        .ok_or_else(|| "expected the first frame and the last one, both included, like 1:240".to_owned())
}

fn duration(text: &str) -> Result<Duration, String> {
    let expected = || "expected a number and s, m or h, like 30s".to_owned();
    let text = text.trim();
    let (number, unit) = text.split_at(text.len() - text.chars().next_back().map_or(0, char::len_utf8));
    let seconds = match unit {
        "s" => 1.0,
        "m" => 60.0,
        "h" => 3600.0,
        _ => return Err(expected()),
    };
    let number: f64 = number.trim().parse().map_err(|_| expected())?;
    // At most ten years, which clocks can count.
    let seconds = number * seconds;
    if (0.0..=3.2e8).contains(&seconds) { Ok(Duration::from_secs_f64(seconds)) } else { Err(expected()) }
}

fn crop(text: &str) -> Result<Crop, String> {
    let parts: Vec<u32> = text.split(',').map_while(|s| s.trim().parse().ok()).collect();
    match parts.as_slice() {
        &[x, y, width, height] if width > 0 && height > 0 && text.split(',').count() == 4 => {
            Ok(Crop { x, y, width, height })
        }
        _ => Err("expected left,top,width,height in pixels, like 100,50,64,64".to_owned()),
    }
}
