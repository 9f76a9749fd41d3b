#!/usr/bin/env bash
# Writes the JSON Schemas of scenes, ray trees and what the viewer shows, and the types of them in the viewer and the studio.
source "$(dirname "$0")/lib.sh"

need_rust
need_node
need_studio_packages
cargo build --locked --quiet --profile ci --package snell-cli
for form in scene ray-tree view; do
    target/ci/snell schema "$form" >"docs/$form.schema.json"
done
(cd viewer && npm run --silent types)
(cd studio && npm run --silent types)
