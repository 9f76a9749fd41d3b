#!/usr/bin/env bash
# Builds what Snell Studio's page loads of Rust, into target/studio.
source "$(dirname "$0")/lib.sh"

cargo build --locked --quiet --package snell-wasm --target wasm32-unknown-unknown --profile ci
cargo run --locked --quiet --package snell-wasm-bundle --profile ci -- target/wasm32-unknown-unknown/ci/snell_wasm.wasm target/studio
