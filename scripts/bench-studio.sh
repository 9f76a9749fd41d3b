#!/usr/bin/env bash
# How fast the studio is, in Chromium. Figures, not tests.
source "$(dirname "$0")/lib.sh"

need_rust wasm32-unknown-unknown
need_node
need_chromium
cargo build --locked --quiet --package snell-cli --package snell-wasm-bundle --profile ci
build_studio --quick
cd studio
npm run bench --silent
