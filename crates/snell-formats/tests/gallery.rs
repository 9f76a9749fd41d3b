//! What must be visible in the pictures of the gallery, as their comments say, and what none of the built-in scenes may lose.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use snell::film::Rgb;
use snell::render::{Options, Settings, render, trace_pixel};
use snell::scene::Scene;
use snell::trace::{Node, RayKind, RayTree};
use snell::world::World;
use snell_formats::Source;
use snell_formats::builtin::{SCENES, description};
use snell_formats::scene_file::{Syntax, parse};
use snell_test_scenes::lecture;

/// The tree of a pixel of one sample.
fn traced(scene: &Scene, world: &World, x: u32, y: u32) -> RayTree {
    trace_pixel(world, &Settings::from(scene), x, y).unwrap().samples.remove(0)
}

/// The objects that a pixel of a built-in scene shows, from the strongest refracted or direct contribution on.
fn shown(name: &str, size: [u32; 2], pixel: [u32; 2]) -> (Vec<String>, RayTree) {
    let mut scene = lecture(name, 1);
    scene.render.size = size;
    let world = World::new(&scene).unwrap();
    let tree = traced(&scene, &world, pixel[0], pixel[1]);
    let mut nodes: Vec<_> = tree.nodes.iter().filter(|n| n.contribution.mean() > 0.0).collect();
    nodes.sort_by(|a, b| b.contribution.mean().total_cmp(&a.contribution.mean()));
    let name = |n: &&Node| {
        n.hit.as_ref().and_then(|hit| world.object_of(hit.primitive)).map_or("sky".to_owned(), |o| o.name.clone())
    };
    (nodes.iter().map(name).collect(), tree)
}

/// Outside the ball the sky is above and the tiles are below; in it, the other way round, and left and right are swapped.
#[test]
fn in_the_ball_of_the_gallery_the_world_stands_on_its_head() {
    let seen = |x: u32, y: u32| shown("gallery/ball", [384, 256], [x, y]).0[0].clone();
    assert_eq!([seen(20, 40), seen(330, 60)], ["sky", "sky"]);
    assert!([seen(20, 200), seen(330, 200)].iter().all(|s| s.ends_with("tiles")));
    // In the ball, whose middle is at 192, 125.
    assert!([seen(192, 72), seen(170, 80)].iter().all(|s| s.ends_with("tiles")));
    assert_eq!([seen(172, 170), seen(212, 172)], ["sky", "sky"]);
    // The orange post stands left of the ball and is seen in its right half.
    let row = |from: u32, to: u32| (from..to).map(|x| seen(x, 128)).collect::<Vec<_>>();
    let (left, right) = (row(130, 190), row(194, 254));
    assert!(left.contains(&"green post".to_owned()) && !left.contains(&"orange post".to_owned()), "{left:?}");
    assert!(right.contains(&"orange post".to_owned()) && !right.contains(&"green post".to_owned()), "{right:?}");
    // The knobs are below their posts.
    assert_eq!(seen(192, 158), "white knob");
    assert_eq!(seen(192, 115), "white post");
}

/// At the rim of a bubble everything is reflected, and in its middle nearly nothing.
#[test]
fn bubbles_have_bright_rims() {
    let at = |x: u32, y: u32| {
        let (_, tree) = shown("gallery/bubbles", [640, 640], [x, y]);
        // The first ray within the water, and what it becomes at the bubble.
        let inside = tree.nodes.iter().position(|n| n.depth == 1 && n.kind == RayKind::Refracted).unwrap();
        let of = |kind: RayKind| tree.nodes.iter().find(|n| n.parent == Some(inside) && n.kind == kind);
        let mirrored = of(RayKind::Mirror).map_or(0.0, |n| n.throughput.g);
        let refracted = of(RayKind::Refracted).map_or(0.0, |n| n.throughput.g);
        mirrored / (mirrored + refracted)
    };
    // Bubble 1 has its middle near 302, 383 and a radius of 60 pixels.
    assert!(at(302, 383) < 0.03, "{}", at(302, 383));
    assert!([at(302, 328), at(249, 383), at(302, 438)].contains(&1.0));
}

/// Red is bent least, violet most.
#[test]
fn the_prism_of_the_gallery_shows_the_colours_in_order() {
    let mut scene = lecture("gallery/prism", 1);
    scene.render.size = [320, 240];
    let world = World::new(&scene).unwrap();
    let crop = Some(snell::film::Crop { x: 90, y: 90, width: 80, height: 1 });
    let row = render(&world, &Settings::from(&scene), &Options { crop, ..Options::default() }).unwrap().film.pixels;
    let peak =
        |value: fn(&Rgb) -> f64| (0..row.len()).max_by(|&a, &b| value(&row[a]).total_cmp(&value(&row[b]))).unwrap();
    let (red, green, blue) = (peak(|c| c.r - c.g - c.b), peak(|c| c.g - c.r - c.b), peak(|c| c.b - c.r - c.g));
    assert!(blue + 5 < green && green + 5 < red, "{blue} {green} {red}");
    let violet = row[..blue].iter().filter(|c| c.b > c.r && c.r > c.g && c.b > 0.3).count();
    assert!(violet > 3, "beyond blue there is violet");
}

/// What is not followed weighs at most 1 % of a pixel on average, or the scene's comment names W202 and says why.
#[test]
fn built_in_scenes_lose_little_light_or_say_so() {
    let mut told = Vec::new();
    for (name, text) in SCENES {
        let source = Source::new(*name, *text);
        let mut scene = parse(&source, Syntax::Toml).unwrap();
        // The average over every eighth column and row is that of the whole picture but for 6 % of itself.
        scene.render.size = scene.render.size.map(|n| n / 8);
        let rendered = render(&World::new(&scene).unwrap(), &Settings::from(&scene), &Options::default()).unwrap();
        let pixels = u64::from(scene.render.size[0]) * u64::from(scene.render.size[1]);
        let (share, says) = (
            rendered.statistics.lost.share(pixels * u64::from(scene.render.spp)),
            description(text).join(" ").contains("W202"),
        );
        assert_eq!(share > 0.01, says, "{name}: {share}");
        if says {
            told.push(*name);
        }
    }
    assert_eq!(told, ["lecture/diamond-depth-1"]);
}

/// A built-in scene at this size, one sample for each pixel, and what the pixels show most.
struct Look {
    scene: Scene,
    world: World,
}

impl Look {
    fn at(name: &str, size: [u32; 2]) -> Self {
        let mut scene = lecture(name, 1);
        (scene.render.size, scene.render.spp) = (size, 1);
        let world = World::new(&scene).unwrap();
        Self { scene, world }
    }

    fn tree(&self, x: u32, y: u32) -> RayTree {
        traced(&self.scene, &self.world, x, y)
    }

    fn name(&self, node: &Node) -> &str {
        let object = node.hit.as_ref().and_then(|hit| self.world.object_of(hit.primitive));
        object.map_or("", |object| object.name.as_str())
    }

    /// The object that adds most to a pixel.
    fn most(&self, x: u32, y: u32) -> String {
        let tree = self.tree(x, y);
        let strongest = tree.nodes.iter().max_by(|a, b| a.contribution.mean().total_cmp(&b.contribution.mean()));
        self.name(strongest.unwrap()).to_owned()
    }

    /// The columns of a row that show an object most.
    fn columns(&self, name: &str, y: u32) -> Vec<u32> {
        (0..self.world.camera.size[0]).filter(|&x| self.most(x, y) == name).collect()
    }
}

fn middle(columns: &[u32]) -> f64 {
    columns.iter().copied().map(f64::from).sum::<f64>() / columns.len() as f64
}

/// Below the water line the pencil is wider, and its edges jump.
#[test]
fn the_pencil_is_broken_at_the_water_line() {
    let look = Look::at("gallery/pencil", [600, 800]);
    let [above, over, under, below] = [300, 350, 410, 460].map(|y| look.columns("pencil", y));
    assert!(under.len() as f64 > 1.3 * over.len() as f64, "{} {}", under.len(), over.len());
    // Where the left edge would be if the pencil went on as above.
    let slope = f64::from(over[0]) - f64::from(above[0]);
    let straight = f64::from(over[0]) + slope / 50.0 * 60.0;
    assert!(f64::from(under[0]) < straight - 10.0, "{} {straight}", under[0]);
    assert!(below.len() > over.len());
}

/// The blue pole in the middle is seen beside itself, by the formula of the comment.
#[test]
fn the_window_shifts_the_poles() {
    let look = Look::at("gallery/window", [768, 512]);
    // Above the pane, and through it.
    let direct: Vec<u32> = look.columns("blue poles", 152).into_iter().filter(|x| (370..400).contains(x)).collect();
    let through: Vec<u32> = look.columns("blue poles", 220).into_iter().filter(|x| (330..400).contains(x)).collect();
    let shift = middle(&direct) - middle(&through);
    let (sin, cos) = (0.75f64.sqrt(), 0.5);
    let d = 0.8 * sin * (1.0 - cos / (2.25 - 0.75f64).sqrt());
    // The pole stands 16 away, where the 511 steps between the rows are 2·16·tan 12° high.
    let expected = d * 511.0 / (32.0 * libm::tan(12.0f64.to_radians()));
    // The ray is within 2 degrees of the axis, which changes d by less than 4 %; a pixel is 3 %.
    assert!((shift / expected - 1.0).abs() < 0.07, "{shift} {expected}");
}

/// n plates let 1/(1 + n/12) through.
#[test]
fn each_plate_takes_its_share() {
    let mut scene = lecture("gallery/plates", 1);
    (scene.render.size, scene.render.spp, scene.render.min_throughput) = ([768, 432], 1, 1e-6);
    let world = World::new(&scene).unwrap();
    let look = Look { scene, world };
    // In the middle of each step.
    for (n, x) in [60, 155, 236, 314, 389, 461, 531, 598, 666].into_iter().enumerate() {
        let tree = look.tree(x, 150);
        let on_wall = tree.nodes.iter().filter(|node| look.name(node) == "wall");
        let share: f64 = on_wall.map(|node| node.throughput.g).sum();
        // Nearly straight on: the angle is below 7 degrees, where Fresnel differs by less than 1e-4; beyond depth 48
        // and below a throughput of 1e-6 something is lost.
        let expected = 1.0 / (1.0 + n as f64 / 12.0);
        assert!((share - expected).abs() < 2e-3, "{n} plates: {share} {expected}");
    }
}

/// The warm ball stands right above; the lens shows it left below.
#[test]
fn the_lens_turns_the_picture_upside_down() {
    let look = Look::at("gallery/lens", [320, 320]);
    // Two faces let (1 - 0.36)² through; a mirror image in the lens is fainter.
    let shows = |x: u32, y: u32| {
        let tree = look.tree(x, y);
        tree.nodes.iter().any(|n| look.name(n) == "hand" && n.contribution.r > 0.3)
    };
    let count = |x: std::ops::Range<u32>, y: std::ops::Range<u32>| {
        y.flat_map(|y| x.clone().map(move |x| (x, y))).filter(|&(x, y)| shows(x, y)).count()
    };
    assert!(count(90..150, 180..240) > 100);
    assert_eq!(count(170..230, 80..140), 0);
}

/// More than half of what enters through the table comes back up, and it comes back in colours.
#[test]
fn the_brilliant_sends_light_back_with_fire() {
    let look = Look::at("gallery/brilliant", [320, 240]);
    let (mut up, mut down) = (0.0, 0.0);
    for (x, y) in [(150, 60), (160, 70), (170, 60), (140, 70), (180, 70)] {
        let tree = look.tree(x, y);
        assert!(tree.nodes.iter().any(|n| n.depth == 1 && n.kind == RayKind::Refracted && look.name(n) == "diamond"));
        for node in
            tree.nodes.iter().filter(|n| n.depth > 1 && n.kind == RayKind::Refracted && look.name(n) != "diamond")
        {
            *(if node.dir.y > 0.0 { &mut up } else { &mut down }) += node.throughput.g;
        }
    }
    assert!(up > 1.5 * down, "{up} up, {down} down");
    let film = render(&look.world, &Settings::from(&look.scene), &Options::default()).unwrap().film;
    let colourful = |c: &&Rgb| {
        let [r, g, b] = c.to_array().map(|c| c.clamp(0.0, 1.0));
        r.max(g).max(b) - r.min(g).min(b) > 0.35
    };
    let count = film.pixels.iter().filter(colourful).count();
    assert!(count > 200, "{count} pixels in strong colours");
}

/// Under water the ice is nearly gone: light goes straight through its faces.
#[test]
fn ice_vanishes_in_water() {
    let look = Look::at("gallery/ice", [640, 720]);
    let mut clear = 0;
    for x in 200..340 {
        let tree = look.tree(x, 430);
        let by_weight = |a: &&Node, b: &&Node| a.contribution.mean().total_cmp(&b.contribution.mean());
        let strongest = tree.nodes.iter().max_by(by_weight).unwrap();
        let way = std::iter::successors(Some(strongest), |n| n.parent.map(|parent| &tree.nodes[parent]));
        let through_ice = way.skip(1).filter(|n| look.name(n).starts_with("ice")).count();
        // Into the glass, the water, the ice, and out: eight faces, of which the four of glass and air take 4 % each.
        clear += usize::from(through_ice >= 2 && strongest.throughput.g > 0.75);
    }
    assert!(clear > 30, "{clear} pixels");
}
