//! Whole pictures, from the camera to the film, on one thread.

#![allow(missing_docs, reason = "criterion's macros write functions without")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use snell::render::{Options, Settings, render};
use snell_bench::{build, scenes};

const SIZE: u32 = 256;

fn frames(c: &mut Criterion) {
    let mut group = c.benchmark_group("frames");
    group.sample_size(10);
    for name in ["default", "flake:4", "knot"] {
        let scene = scenes::find(name, SIZE).unwrap_or_else(|e| unreachable!("{e}"));
        let (world, _) = build(&scene, 1).unwrap_or_else(|e| unreachable!("{e}"));
        let settings = Settings::from(&scene);
        group.throughput(Throughput::Elements(u64::from(SIZE * SIZE)));
        group.bench_function(BenchmarkId::from_parameter(name), |b| {
            b.iter(|| render(&world, &settings, &Options { threads: 1, ..Options::default() }));
        });
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
