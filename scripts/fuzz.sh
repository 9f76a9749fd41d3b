#!/usr/bin/env bash
# Fuzzes the command with files that are nearly right, and every reader with libFuzzer, on the stable compiler.
# SECONDS_EACH: how long, 60 if not given.
source "$(dirname "$0")/lib.sh"

need_rust
command -v c++ >/dev/null || missing 'a C++ compiler for libFuzzer' 'sudo apt-get install g++'
# What cargo-fuzz passes on the nightly compiler, without the sanitizer that only that one has.
export RUSTFLAGS='--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table
    -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1'
host=$(rustc -vV | sed -n 's/^host: //p')
cargo build --locked --release --features run --manifest-path fuzz/Cargo.toml --target "$host"
printf '\n── fuzzing the command\n'
RUSTFLAGS='' cargo build --locked --quiet --package snell-cli --profile ci
python3 scripts/fuzz_command.py target/ci/snell "${SECONDS_EACH:-60}"
for target in scene driver obj ply stl nff picture part; do
    printf '\n── fuzzing %s\n' "$target"
    mkdir -p "fuzz/corpus/$target"
    seeds=("fuzz/seeds/$target")
    [ "$target" != scene ] || seeds+=(scenes/lecture)
    "fuzz/target/$host/release/$target" "fuzz/corpus/$target" "${seeds[@]}" \
        -max_total_time="${SECONDS_EACH:-60}" -timeout=10 -rss_limit_mb=2048 -max_len=4096 -print_final_stats=1
done
