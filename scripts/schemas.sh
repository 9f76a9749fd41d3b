#!/usr/bin/env bash
# Writes the JSON Schemas of scenes, ray trees and what the viewer shows, and the viewer's types of them.
source "$(dirname "$0")/lib.sh"

need_rust
need_node
need_viewer_packages
cargo build --locked --quiet --profile ci --package snell-cli
for form in scene ray-tree view; do
    target/ci/snell schema "$form" >"docs/$form.schema.json"
done
(cd viewer && npm run --silent types)
