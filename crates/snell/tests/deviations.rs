//! The sizes that `docs/deviations.md` gives, recomputed.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{ball, furnace, glass, tree};
use snell::film::Rgb;
use snell::geometry::Vec3;
use snell::lanes::elementary::sin_cos_degrees;
use snell::optics::fresnel::{brewster_angle, fresnel_dielectric, fresnel_polarized};
use snell::optics::phong::{self, Surface};
use snell::optics::spectrum::{Band, bands};
use snell::optics::thin::{lateral_displacement, slab, slanted_pass};
use snell::optics::{dispersion, glass as catalogue};
use snell::scene::{Lathe, Scene};
use snell::trace::RayKind;
use snell_formats::Source;
use snell_formats::scene_file::{Syntax, parse};
use std::f64::consts::{FRAC_PI_3, FRAC_PI_6, PI};
use std::path::Path;

const PAGE: &str = include_str!("../../../docs/deviations.md");

/// The cells of the table below a heading, without its head.
fn table(heading: &str) -> Vec<Vec<&'static str>> {
    let (_, section) = PAGE.split_once(&format!("\n### {heading}\n")).unwrap();
    let section = section.split("\n#").next().unwrap();
    let lines = section.lines().filter(|line| line.starts_with('|')).skip(2);
    lines.map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect()
}

/// The number that a cell shows, and half of its last digit.
fn number(cell: &str) -> (f64, f64) {
    let text = cell.replace('−', "-").replace('°', "").replace(" %", "").replace('`', "");
    let digits = text.split_once('.').map_or(0, |(_, digits)| digits.len());
    let unit = if cell.contains('%') { 0.01 } else { 1.0 };
    (text.parse::<f64>().unwrap() * unit, 0.5 * unit * libm::exp10(-(digits as f64)))
}

fn check(cell: &str, value: f64) {
    let (shown, half) = number(cell);
    // A tie may have been rounded either way.
    assert!((value - shown).abs() <= half * (1.0 + 1e-9), "the page says {cell}, and it is {value}");
}

/// `[nature, Snell, off by]` against the last three cells of a row.
fn compare(row: &[&str], nature: f64, snell: f64) {
    check(row[1], nature);
    check(row[2], snell);
    if row[3] != "all of it" {
        check(row[3], snell / nature - 1.0);
    }
}

#[test]
fn every_test_and_function_that_is_named_exists() {
    let mut sources = String::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for folder in ["crates/snell", "crates/snell-kernels", "crates/snell-formats", "tests"] {
        read_all(&root.join(folder), &mut sources);
    }
    let quoted = PAGE.split('`').skip(1).step_by(2);
    let names: Vec<&str> = quoted.filter(|word| word.matches('_').count() >= 2 && !word.contains(' ')).collect();
    assert!(names.len() > 20, "{names:?}");
    for name in names {
        let defined = |before: &str, after: &str| sources.contains(&format!("{before} {name}{after}"));
        assert!(defined("fn", "(") || defined("fn", "<") || defined("def", "("), "nothing is called `{name}`");
    }
}

fn read_all(folder: &Path, text: &mut String) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            read_all(&path, text);
        } else if path.extension().is_some_and(|ending| ending == "rs" || ending == "py") {
            text.push_str(&std::fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn two_faces_in_a_row_are_as_far_off_as_the_table_says() {
    let c = libm::cos(brewster_angle(1.5));
    let (r, [rs, rp]) = (fresnel_dielectric(c, 1.5), fresnel_polarized(c, 1.5));
    // Through n plates, all reflections added up (Stokes 1862): (1 - r)/(1 + (2n - 1)r).
    let through = |n: f64, r: f64| (1.0 - r) / (1.0 + (2.0 * n - 1.0) * r);
    let unpolarised = |of: &dyn Fn(f64) -> f64| 0.5 * (of(rs) + of(rp));
    let rows = table("Two faces in a row");
    for (row, n) in rows.iter().zip([1.0, 10.0]) {
        compare(row, unpolarised(&|r| through(n, r)), through(n, r));
    }
    compare(&rows[2], unpolarised(&|r| r * r), r * r);
    // What is s-polarised in one plane is p-polarised in the other.
    compare(&rows[3], rs * rp, r * r);
}

/// What other pages say in passing.
#[test]
fn a_slanted_plate_lets_through_what_the_pages_say() {
    for (degrees, more, nature, snell) in [(60.0, "1.4 %", "0.848", "0.836"), (80.0, "3.9 %", "0.458", "0.441")] {
        let (_, c) = sin_cos_degrees(degrees);
        let through = |r: f64| slab(r, 1.0)[1];
        let [rs, rp] = fresnel_polarized(c, 1.5);
        let (apart, together) = (0.5 * (through(rs) + through(rp)), through(fresnel_dielectric(c, 1.5)));
        check(nature, apart);
        check(snell, together);
        check(more, apart / together - 1.0);
    }
    let notebook = include_str!("../../../docs/notebooks/4-solids-holes-and-thin-faces.ipynb");
    assert!(notebook.contains("0.848 instead of 0.836 at 60°, 0.458 instead of 0.441 at 80°"));
    let models = include_str!("../../../docs/models.md").replace('\n', " ");
    assert!(models.contains("1.4 % more would pass through the clear plate at 60° and 3.9 % more at 80°"));
}

/// By the engine: what it traces through a drop, and what the same ray would carry with the two polarisations apart.
#[test]
fn the_rainbows_are_as_far_off_as_the_table_says() {
    let n = 1.333;
    let mut scene = furnace(1);
    (scene.render.min_throughput, scene.render.max_depth) = (0.0, 5);
    glass(&mut scene, "water", n, 0);
    ball(&mut scene, [0.0; 3], 1.0, "water");
    let bow = |reflections: i32| {
        let k = f64::from(reflections);
        // Descartes: cos i = √((n² - 1)/(k(k + 2))).
        let c = ((n * n - 1.0) / (k * (k + 2.0))).sqrt();
        let tree = tree(&scene, [(1.0 - c * c).sqrt(), 0.0, 3.0], [0.0, 0.0, -1.0]);
        let child = |parent: usize, kind: RayKind| {
            tree.nodes.iter().position(|n| n.parent == Some(parent) && n.kind == kind).unwrap()
        };
        let inside = (0..reflections).fold(child(0, RayKind::Refracted), |at, _| child(at, RayKind::Mirror));
        let power = |r: f64| (1.0 - r) * (1.0 - r) * (0..reflections).fold(1.0, |power, _| power * r);
        let [rs, rp] = fresnel_polarized(c, n);
        (0.5 * (power(rs) + power(rp)), tree.nodes[child(inside, RayKind::Refracted)].throughput.g)
    };
    let (first, second) = (bow(1), bow(2));
    let rows = table("Rainbows");
    compare(&rows[0], first.0, first.1);
    compare(&rows[1], second.0, second.1);
    compare(&rows[2], second.0 / first.0, second.1 / first.1);
}

#[test]
fn bands_part_as_far_as_the_table_says() {
    for row in table("Bands") {
        let glass = &catalogue::find(row[0]).unwrap().dispersion;
        let incidence = libm::asin(0.5 * glass.eta(dispersion::LINE_D_NM).unwrap());
        let deviation = |wavelength_nm: f64| {
            let eta = glass.eta(wavelength_nm).unwrap();
            let inside = FRAC_PI_3 - libm::asin(libm::sin(incidence) / eta);
            (incidence + libm::asin(eta * libm::sin(inside)) - FRAC_PI_3).to_degrees()
        };
        for (count, cells) in [(16, &row[1..3]), (32, &row[3..5])] {
            let angles: Vec<f64> = bands(count).iter().map(|band| deviation(band.wavelength_nm)).collect();
            check(cells[0], angles[0] - angles[count - 1]);
            check(cells[1], angles.windows(2).map(|pair| pair[0] - pair[1]).fold(0.0, f64::max));
        }
        let [shortest, longest] = dispersion::VISIBLE_NM;
        check(row[5], deviation(shortest.max(glass.range_nm[0])) - deviation(longest));
    }
    let of_16 = bands(16);
    let cyan = of_16.iter().find(|band| (band.wavelength_nm - 503.0).abs() < 0.5).unwrap().weight;
    assert!((cyan.r / cyan.g + 0.96).abs() < 0.005, "{cyan:?}");
    assert!((of_16[0].wavelength_nm - 425.0).abs() < 0.5 && (of_16[0].weight.r - 0.03).abs() < 0.005);
}

/// A later face multiplies what an earlier one reflects: by channels, where nature does it by wavelengths.
#[test]
fn reflected_light_loses_next_to_nothing_by_staying_white() {
    let glass = &catalogue::find("SF11").unwrap().dispersion;
    for degrees in [0.0, 30.0, 60.0] {
        let bands: Vec<Band> = bands(64);
        let r = |band: &Band| fresnel_dielectric(sin_cos_degrees(degrees).1, glass.eta(band.wavelength_nm).unwrap());
        for channel in 0..3 {
            let mean = |of: &dyn Fn(f64) -> f64| {
                bands.iter().map(|band| band.weight.to_array()[channel] * of(r(band))).sum::<f64>()
            };
            let (nature, snell) = (mean(&|r| r * (1.0 - r)), mean(&|r| r) * mean(&|r| 1.0 - r));
            assert!((snell / nature - 1.0).abs() < 1e-4, "{degrees} degrees: {snell} {nature}");
        }
    }
}

/// The sun above a white floor, at an angle in the x direction, and a clear or gray glass.
fn sunny(degrees: f64, sigma_a: f64) -> Scene {
    let (sin, cos) = sin_cos_degrees(degrees);
    let text = format!(
        "snell = 1\n[render]\nintegrator = \"whitted\"\nsize = [1, 1]\nshadows = \"tinted\"\n\
         [camera]\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\nbounds = [-1, 1, -1, 1]\n\
         [[light]]\ndirection = [{sin}, {cos}, 0]\ncolor = 1\n\
         [material.white]\nkd = 1\n[[plane]]\ncenter = [0, -3, 0]\nsize = [200, 200]\nmaterial = \"white\"\n\
         [material.glass]\nko = 0\neta = 1.5\nsigma_a = {sigma_a}\n"
    );
    parse(&Source::new("sunny", text), Syntax::Toml).unwrap()
}

/// What of the light arrives on the floor there.
fn arrives(scene: &Scene, x: f64) -> f64 {
    let light = Vec3::from(scene.lights[0].direction.unwrap());
    tree(scene, [x, -2.5, 0.0], [0.0, -1.0, 0.0]).sum().g / light.y
}

#[test]
fn a_plate_casts_the_shadow_that_the_table_says() {
    for row in table("The shadow of a plate") {
        let degrees = number(row[0]).0;
        let c = sin_cos_degrees(degrees).1;
        let (r, tau) = (fresnel_dielectric(c, 1.5), libm::exp(-0.5 * slanted_pass(1.0, c, 1.5)));
        let (nature, once) = (slab(r, tau)[1], (1.0 - r) * (1.0 - r));
        let straight = once * libm::exp(-0.5 / c);
        compare(&row[..4], nature, once * tau);
        check(row[4], straight);
        check(row[5], straight / nature - 1.0);
        check(row[6], lateral_displacement(1.0, c, 1.5));
        // By the engine, through a plate whose upper face leans by 0.2 degrees, across the light, so that it is no plate.
        let mut scene = sunny(degrees, 0.5);
        let lean = 50.0 * 0.0035;
        let mut wedge = snell_test_scenes::glass::cuboid([-50.0, 0.0, -50.0], [50.0, 1.0, 50.0]);
        for vertex in wedge.vertices.iter_mut().filter(|vertex| vertex.y > 0.5) {
            vertex.y += lean * vertex.z.signum();
        }
        common::mesh(&mut scene, wedge, "glass");
        // The lean changes the cosine by 6e-6 of itself, and R at 80 degrees by five times that.
        assert!((arrives(&scene, 0.0) / straight - 1.0).abs() < 1e-4, "{degrees}: {}", arrives(&scene, 0.0));
    }
    let [through_s, through_p] =
        fresnel_polarized(0.5, 1.5).map(|r| slab(r, libm::exp(-0.5 * slanted_pass(1.0, 0.5, 1.5)))[1]);
    assert!(PAGE.contains(&format!("{:.4} at 60°", 0.5 * (through_s + through_p))));
}

/// By the engine, over 64 rings of the same area.
#[test]
fn a_ball_lets_through_what_the_page_says() {
    let mut scene = sunny(0.0, 0.0);
    ball(&mut scene, [0.0; 3], 1.0, "glass");
    let rings = (0..64).map(|ring| arrives(&scene, ((f64::from(ring) + 0.5) / 64.0).sqrt()));
    let mean = rings.sum::<f64>() / 64.0;
    // A whole number of percent is printed.
    assert!((mean - 0.84).abs() < 0.005, "{mean}");
}

#[test]
fn phong_sends_on_what_the_table_says() {
    const RINGS: u32 = 400;
    const AROUND: u32 = 720;
    let up = Vec3::new(0.0, 0.0, 1.0);
    for row in table("What Phong's highlight reflects") {
        let surface = Surface { kd: Rgb::gray(0.0), ks: Rgb::gray(1.0), spow: number(row[0]).0 };
        for (cell, degrees) in row[1..].iter().zip([0.0, 60.0, 80.0, 85.0, 89.0]) {
            let (sin_i, cos_i) = sin_cos_degrees(degrees);
            let wi = Vec3::new(sin_i, 0.0, cos_i);
            let mut sum = 0.0;
            for ring in 0..RINGS {
                let cos_o = (f64::from(ring) + 0.5) / f64::from(RINGS);
                let sin_o = (1.0 - cos_o * cos_o).sqrt();
                for step in 0..AROUND {
                    let (sin, cos) = libm::sincos(2.0 * PI * (f64::from(step) + 0.5) / f64::from(AROUND));
                    let wo = Vec3::new(sin_o * cos, sin_o * sin, cos_o);
                    let [_, highlight] = phong::light(true, up, wo, wi, Rgb::gray(1.0), &surface);
                    sum += highlight.r * cos_o;
                }
            }
            check(cell, sum * (2.0 * PI / f64::from(RINGS * AROUND)) / (PI * cos_i));
        }
    }
}

/// Where a ray hits, its normal points away from the axis; the place is on the facet.
#[test]
fn a_smooth_lathe_is_round_for_rays_and_has_facets_in_outline() {
    for row in table("Facets") {
        let segments = number(row[0]).0;
        let inner = libm::cos(PI / segments);
        check(row[1], 1.0 - inner);
        check(row[2], 180.0 / segments);
        let mut scene = furnace(1);
        glass(&mut scene, "glass", 1.5, 0);
        scene.lathes.push(Lathe {
            name: None,
            profile: vec![[0.0, -5.0], [1.0, -5.0], [1.0, 5.0], [0.0, 5.0]],
            segments: segments as u32,
            smooth_angle: 30.0,
            material: "glass".to_owned(),
            inside: None,
            outside: None,
            transform: vec![],
            instances: vec![],
        });
        let (mut nearest, mut farthest) = (f64::INFINITY, 0.0f64);
        for step in 0..50 {
            let (sin, cos) = libm::sincos(FRAC_PI_6 * f64::from(step) / 50.0);
            let tree = tree(&scene, [3.0 * cos, 0.3, 3.0 * sin], [-cos, 0.0, -sin]);
            let hit = tree.nodes[0].hit.as_ref().unwrap();
            let outward = Vec3::new(hit.point.x, 0.0, hit.point.z);
            (nearest, farthest) = (nearest.min(outward.length()), farthest.max(outward.length()));
            // Normals of corners are sums of those of three triangles; a few roundings.
            assert!((hit.normal - outward.unit()).length() < 1e-14, "{:?}", hit.normal - outward.unit());
        }
        // Fifty places: one is within a fiftieth of a facet of each end for the largest of them, where the circle has no slope.
        assert!((nearest - inner).abs() < 0.1 * (1.0 - inner) && (farthest - 1.0).abs() < 0.2 * (1.0 - inner));
    }
}
