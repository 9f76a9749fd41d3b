#!/usr/bin/env bash
# Long attacks, each time with other numbers, which are said where something is wrong.
source "$(dirname "$0")/lib.sh"
need_rust
SNELL_SOAK_SECONDS=${SNELL_SOAK_SECONDS:-600} cargo test --locked --quiet --package snell --lib --profile ci soak -- --nocapture
SNELL_SOAK_KILLS=${SNELL_SOAK_KILLS:-100} cargo test --locked --quiet --package snell-cli --test parts --profile ci kill_dash_nine
need_python_package
SNELL_SOAK_KILLS=${SNELL_SOAK_KILLS:-20} target/python/bin/python -m pytest -q tests/python/test_cluster.py -k killed
target/python/bin/python benches/cluster.py --simulate 200
