//! The innermost loops: spheres, triangles, refraction, highlights, at every lane width.

#![allow(missing_docs, reason = "criterion's macros write functions without")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use snell::film::Rgb;
use snell::geometry::ray::{Heading, axes, main_axis};
use snell::geometry::{Vec3, sphere, triangle};
use snell::lanes::{Kernel, LaneWidth, Lanes, Mask, dispatch, pow};
use snell::optics::phong::{self, Surface};
use snell::optics::snell::{reflect, through_sphere};
use snell_bench::uniform;
use std::hint::black_box;

/// So many rays go through a kernel, from a small region towards a large one around the shapes at (0, 0, 5).
const COUNT: usize = 1024;

#[derive(Clone, Copy)]
enum What {
    Sphere,
    Triangle,
    Mirror,
    ThroughSphere,
    Power,
    Phong,
}

/// All rays through one kernel.
struct All<'a> {
    what: What,
    columns: &'a [Vec<f64>; 6],
}

impl Kernel for All<'_> {
    type Output = f64;
    #[inline(always)]
    fn run<L: Lanes>(self) -> f64 {
        let center = Vec3::new(0.0, 0.0, 5.0).splat::<L>();
        let corners = [Vec3::new(-1.0, -1.0, 5.0), Vec3::new(1.5, -1.0, 5.2), Vec3::new(0.0, 1.5, 4.9)];
        let k = axes(main_axis(Vec3::new(0.0, 0.0, 1.0)));
        let [a, b, c] = corners.map(|corner| corner.permuted(k));
        let corners = [a.splat(), b.splat(), c.splat()];
        let (one, eta, spow) = (L::splat(1.0), L::splat(1.5), L::splat(32.0));
        let surface = Surface { kd: Rgb::gray(0.5).splat(), ks: Rgb::gray(0.5).splat(), spow };
        let mut sum = L::splat(0.0);
        for start in (0..COUNT).step_by(L::WIDTH) {
            let column = |i: usize| L::load(&self.columns[i][start..]);
            let origin = Vec3::new(column(0), column(1), column(2));
            let dir = Vec3::new(column(3), column(4), column(5));
            let value = match self.what {
                What::Sphere => sphere::intersect(origin, dir, center, one).0,
                What::Triangle => triangle::intersect(origin, &Heading::new(dir), corners).t,
                What::Mirror => reflect(-dir, origin).x,
                What::ThroughSphere => through_sphere(origin, -dir, -dir, center, one, eta).1.x,
                What::Power => pow(dir.z, spow),
                What::Phong => {
                    let all = L::Mask::first(L::WIDTH);
                    phong::light(all, -dir, -dir, -dir, Rgb::gray(0.7).splat(), &surface)[1].r
                }
            };
            // Select, for a NaN would stay; and something must depend on every value.
            sum = L::select(value.gt(sum), value, sum);
        }
        sum.lane(0)
    }
}

fn kernels(c: &mut Criterion) {
    let mut columns: [Vec<f64>; 6] = Default::default();
    for ray in 0..COUNT {
        let from = |axis: usize| uniform((6 * ray + axis) as u32) - 0.5;
        let dir = Vec3::new(0.3 * from(3), 0.3 * from(4), 1.0).unit();
        let row = [from(0), from(1), from(2), dir.x, dir.y, dir.z];
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    let all = [
        ("sphere", What::Sphere),
        ("triangle", What::Triangle),
        ("mirror", What::Mirror),
        ("through a sphere", What::ThroughSphere),
        ("power", What::Power),
        ("Phong", What::Phong),
    ];
    for (name, what) in all {
        let mut group = c.benchmark_group(format!("kernels/{name}"));
        group.throughput(Throughput::Elements(COUNT as u64));
        for width in LaneWidth::ALL {
            let id = BenchmarkId::from_parameter(format!("{} wide", width.numbers()));
            group.bench_function(id, |b| b.iter(|| dispatch(width, All { what, columns: black_box(&columns) })));
        }
    }
}

criterion_group!(benches, kernels);
criterion_main!(benches);
