#!/usr/bin/env bash
# Counts instructions with callgrind, next to the committed baseline. Counts do not depend on what else the machine does.
#   BASELINE=1 make bench-counts     makes what was counted the new baseline, benches/counts.json
#   ONLY=gallery make bench-counts   counts only what has this in its name
#   LIMIT=3 make bench-counts        fails where a count has grown by more than 3 %
source "$(dirname "$0")/lib.sh"

need_rust
need_plain_python
command -v valgrind >/dev/null || missing 'valgrind' 'sudo apt-get install valgrind'
cargo build --locked --quiet --package snell-bench --bin bench-counts --profile ci
BENCH_COMMAND="${BASELINE:+BASELINE=1 }make bench-counts" python3 benches/counts.py
