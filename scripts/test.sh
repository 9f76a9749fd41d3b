#!/usr/bin/env bash
# Everything that CI runs, with the time of each stage. Stops at the first stage that fails.
source "$(dirname "$0")/lib.sh"

times=()
stage() {
    local name=$1 start=$SECONDS
    shift
    printf '\n── %s\n' "$name"
    "$@"
    times+=("$(printf '%5d s  %s' $((SECONDS - start)) "$name")")
}

need_tools() { need_rust wasm && need_python; }
oracle() { SNELL=$PWD/target/ci/snell .venv/bin/python -m pytest -q tests; }
documentation() { RUSTDOCFLAGS='-D warnings' cargo doc --locked --quiet --workspace --no-deps --profile ci; }

stage 'tools' need_tools
stage 'format' cargo fmt --all --check
stage 'lints' cargo clippy --locked --quiet --workspace --all-targets --profile ci -- -D warnings
stage 'build' cargo build --locked --quiet --workspace --profile ci
stage 'Rust tests' cargo test --locked --quiet --workspace --profile ci
stage 'Python tests: the slow oracle, the schema' oracle
stage 'documentation' documentation
stage 'fuzz targets compile' cargo check --locked --quiet --manifest-path fuzz/Cargo.toml --target-dir target/fuzz
stage 'the library for WASM' cargo check --locked --quiet --package snell --target wasm32-unknown-unknown --profile ci

printf '\n── all passed\n'
printf '%s\n' "${times[@]}"
