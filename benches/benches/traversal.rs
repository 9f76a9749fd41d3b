//! Rays through the tree of the knot, a million triangles, by kind, on one thread.

#![allow(missing_docs, reason = "criterion's macros write functions without")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use snell_bench::rays::{Found, Kind, RaySets};
use snell_bench::{build, knot, scenes};
use std::sync::Arc;

/// A quarter of the picture of the peers, so that a sample takes a moment and not seconds.
const SIZE: u32 = 512;

fn kinds(c: &mut Criterion) {
    let mesh = Arc::new(knot::on_ground());
    let scene = scenes::knot_on_ground(Arc::clone(&mesh), SIZE);
    let (world, _) = build(&scene, 1).unwrap_or_else(|e| unreachable!("{e}"));
    let sets = RaySets::new(&world, &mesh, SIZE);
    let mut found = Found::default();
    let mut group = c.benchmark_group("traversal");
    group.sample_size(10);
    for (name, kind) in Kind::ALL {
        group.throughput(Throughput::Elements(sets.of(kind).t_max.len() as u64));
        group.bench_function(BenchmarkId::from_parameter(name), |b| b.iter(|| found.trace(&world, &sets, kind, 1)));
    }
}

criterion_group!(benches, kinds);
criterion_main!(benches);
