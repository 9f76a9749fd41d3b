#!/usr/bin/env bash
# Times kernels, trees, rays and pictures with criterion, and writes docs/performance.md anew.
#   BASELINE=name make bench   saves the times under this name as well
#   AGAINST=name make bench    compares with what was saved under this name
#   ONLY=kernels make bench    only kernels, build, traversal or frames; of the others, the last result stays
#   QUICK=1 make bench         a rough look
source "$(dirname "$0")/lib.sh"

need_rust
need_plain_python
cargo build --locked --quiet --package snell-bench --profile ci
options=(--noplot)
[ -z "${QUICK:-}" ] || options+=(--quick)
[ -z "${BASELINE:-}" ] || options+=(--save-baseline "$BASELINE")
[ -z "${AGAINST:-}" ] || options+=(--baseline "$AGAINST")
# What a bench of former times found is not a result of this run; baselines stay.
[ -n "${ONLY:-}" ] || [ ! -d target/criterion ] || find target/criterion -type d -name new -prune -exec rm -r {} +
for bench in ${ONLY:-kernels build traversal frames}; do
    cargo bench --locked --quiet --package snell-bench --profile ci --bench "$bench" -- "${options[@]}"
done
BENCH_COMMAND="${QUICK:+QUICK=1 }make bench" python3 benches/kernels.py
python3 benches/report.py
