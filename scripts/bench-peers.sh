#!/usr/bin/env bash
# Compares Snell with POV-Ray and Embree by turns, measures how cost grows, and writes docs/performance.md anew.
#   ROUNDS=7: how often everybody is asked; LARGEST=8192: side of the largest picture
source "$(dirname "$0")/lib.sh"

need_rust
need_plain_python
command -v povray >/dev/null || absent 'POV-Ray' 'sudo apt-get install povray'
command -v g++ >/dev/null || absent 'a C++ compiler for Embree' 'sudo apt-get install g++'
[ -e /usr/include/embree3/rtcore.h ] || absent 'Embree 3' 'sudo apt-get install libembree-dev   (Debian 12)'
cargo build --locked --quiet --package snell-bench --package snell-cli --profile ci
export BENCH_COMMAND="ROUNDS=${ROUNDS:=7} LARGEST=${LARGEST:=8192} make bench-peers"
status=0
python3 benches/peers/run.py "$ROUNDS" || status=$?
python3 benches/growth.py "$LARGEST"
python3 benches/report.py
exit "$status"
