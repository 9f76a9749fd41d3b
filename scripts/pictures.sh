#!/usr/bin/env bash
# Makes the pictures of the documentation anew: the models of light side by side, the gallery, the page that explains a pixel, a
# sweep. Those in notebooks, and that of one, are made by `make notebooks`.
source "$(dirname "$0")/lib.sh"

# 240 pixels high, in the scene's shape.
picture_size() {
    sed -n 's/^size = \[\([0-9]*\), \([0-9]*\)\]$/\1 \2/p' "$1" | head -1 | awk '{ printf "%dx240", int($1 * 240 / $2 + 0.5) }'
}

need_rust
cargo build --locked --quiet --profile ci --package snell-cli
mkdir -p docs/pictures/models docs/pictures/gallery
for scene in scenes/models/*.toml; do
    name=$(basename "$scene" .toml)
    shadows=()
    [ "$name" != shadow ] || shadows=(--shadows tinted)
    target/ci/snell render "$scene" --integrator lecture --quiet -o "docs/pictures/models/$name-lecture.png"
    target/ci/snell render "$scene" --integrator whitted "${shadows[@]}" --quiet -o "docs/pictures/models/$name-whitted.png"
done
for scene in scenes/gallery/*.toml; do
    name=$(basename "$scene" .toml)
    printf '%s\n' "$name"
    target/ci/snell render "$scene" --size "$(picture_size "$scene")" --spp 4 --quiet -o "docs/pictures/gallery/$name.png"
done
need_node
need_chromium
need_viewer_packages
mkdir -p out
target/ci/snell explain lecture/default 190,300 --html out/why.html
(cd viewer && node test/screenshot.mjs ../out/why.html ../docs/pictures/explain.png 'Refracted ray hits green')

need_python_package
target/python/bin/python - <<'PYTHON'
import numpy as np
import snell

ball = snell.scenes["lecture/default"]
frames = snell.sweep(ball, {"material.glass.eta": np.linspace(1, 2.5, 60)}, "out/sweep", width=320, spp=16)
frames[::4].sheet("docs/pictures/sweep.png")
frames.save("docs/pictures/sweep.gif")
PYTHON
