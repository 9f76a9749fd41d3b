#!/usr/bin/env bash
# Builds Snell, renders the default scene, says where the picture is.
source "$(dirname "$0")/lib.sh"

need_rust
cargo build --locked --profile ci --package snell-cli
mkdir -p out
target/ci/snell render lecture/default -o out/default.png
printf '\nThe picture is %s/out/default.png\nThe command is %s/target/ci/snell: try `target/ci/snell scenes`\n' "$PWD" "$PWD"
