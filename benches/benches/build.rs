//! Compiling scenes, the tree above all.

#![allow(missing_docs, reason = "criterion's macros write functions without")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use snell_bench::{build, scenes};
use std::time::Duration;

fn trees(c: &mut Criterion) {
    let mut group = c.benchmark_group("build");
    group.sample_size(10);
    for name in ["flake:4", "flake:5", "knot"] {
        let scene = scenes::find(name, 512).unwrap_or_else(|e| unreachable!("{e}"));
        let primitives = build(&scene, 1).map_or(0, |(world, _)| world.primitive_count());
        group.throughput(Throughput::Elements(primitives as u64));
        group.bench_function(BenchmarkId::from_parameter(name), |b| {
            b.iter_custom(|times| (0..times).map(|_| build(&scene, 1).map_or(Duration::ZERO, |(_, time)| time)).sum());
        });
    }
}

criterion_group!(benches, trees);
criterion_main!(benches);
