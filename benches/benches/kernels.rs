//! The innermost loops: boxes, spheres, triangles, refraction, highlights; one call for each lane width.

#![allow(missing_docs, reason = "criterion's macros write functions without")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use snell::film::Rgb;
use snell::geometry::bounds::{Bounds, OuterBox};
use snell::geometry::{Ray, RayFrame, Vec3, sphere, triangle};
use snell::lanes::{ArrayLanes, Lanes, Mask};
use snell::optics::phong::{self, Surface};
use snell::optics::snell::{reflect, through_sphere};
use snell_bench::uniform;
use std::hint::black_box;

/// A ray in each lane, from a small region towards a large one around the shapes at (0, 0, 5).
fn rays<L: Lanes>() -> Ray<L> {
    let from = |axis: usize, lane: usize| uniform((6 * lane + axis) as u32) - 0.5;
    let origin = Vec3::new(L::from_fn(|i| from(0, i)), L::from_fn(|i| from(1, i)), L::from_fn(|i| from(2, i)));
    let dir = Vec3::new(L::from_fn(|i| 0.3 * from(3, i)), L::from_fn(|i| 0.3 * from(4, i)), L::splat(1.0)).unit();
    Ray { origin, dir, t_min: L::splat(0.0), t_max: L::splat(f64::INFINITY) }
}

fn kernels<L: Lanes>(c: &mut Criterion) {
    let ray = rays::<L>();
    let frame = RayFrame::new(ray.dir);
    let corners = [Vec3::new(-1.0, -1.0, 5.0), Vec3::new(1.5, -1.0, 5.2), Vec3::new(0.0, 1.5, 4.9)];
    let center = Vec3::new(0.0, 0.0, 5.0);
    let bounds = OuterBox::around(&Bounds::of(corners), 0.0);
    let normal = (ray.at(L::splat(4.0)) - center.splat()).unit();
    let point = center.splat() + normal;
    let (one, wo, wi) = (L::splat(1.0), normal, -ray.dir);
    let surface = Surface { kd: Rgb::gray(0.5).splat(), ks: Rgb::gray(0.5).splat(), spow: L::splat(32.0) };
    let eta = L::splat(1.5);

    // References go through the black box, so that nothing is copied but results.
    bench::<L, _>(c, "frame of a ray", || RayFrame::new(*black_box(&ray.dir)));
    bench::<L, _>(c, "box", || {
        let (ray, frame) = (black_box(&ray), black_box(&frame));
        bounds.enter(ray.origin, frame, ray.t_min, ray.t_max)
    });
    bench::<L, _>(c, "sphere", || sphere::intersect(black_box(&ray), center, 1.0));
    bench::<L, _>(c, "triangle", || triangle::intersect(black_box(&ray), black_box(&frame), corners));
    bench::<L, _>(c, "mirror", || reflect(*black_box(&wo), *black_box(&normal)));
    bench::<L, _>(c, "through a sphere", || {
        let (point, normal) = (black_box(&point), black_box(&normal));
        through_sphere(*point, *normal, wo, center.splat(), one, eta)
    });
    bench::<L, _>(c, "Phong", || {
        let (normal, wi) = (black_box(&normal), black_box(&wi));
        phong::light(L::Mask::first(L::WIDTH), *normal, wo, *wi, Rgb::gray(0.7).splat(), &surface)
    });
}

fn bench<L: Lanes, R>(c: &mut Criterion, name: &str, kernel: impl FnMut() -> R + Copy) {
    let mut group = c.benchmark_group(format!("kernels/{name}"));
    group.throughput(Throughput::Elements(L::WIDTH as u64));
    let width = BenchmarkId::from_parameter(format!("{} wide", L::WIDTH));
    group.bench_function(width, |b| b.iter(kernel));
}

fn every_width(c: &mut Criterion) {
    kernels::<f64>(c);
    kernels::<ArrayLanes<4>>(c);
}

criterion_group!(benches, every_width);
criterion_main!(benches);
