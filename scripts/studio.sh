#!/usr/bin/env bash
# Builds Snell Studio and opens it in a browser. Arguments are those of `snell studio`.
source "$(dirname "$0")/lib.sh"

need_rust wasm32-unknown-unknown
need_node
cargo build --locked --quiet --package snell-cli --package snell-wasm-bundle --profile ci
build_studio
export SNELL_STUDIO_DIST=$PWD/target/studio-dist
exec target/ci/snell studio "$@"
