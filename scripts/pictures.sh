#!/usr/bin/env bash
# Makes the pictures of the documentation anew: the models of light side by side, the gallery, the page that explains a pixel, a
# sweep, the studio in motion. Those in notebooks, and that of one, are made by `make notebooks`.
source "$(dirname "$0")/lib.sh"

# 240 pixels high, in the scene's shape.
picture_size() {
    sed -n 's/^size = \[\([0-9]*\), \([0-9]*\)\]$/\1 \2/p' "$1" | head -1 | awk '{ printf "%dx240", int($1 * 240 / $2 + 0.5) }'
}

need_rust wasm32-unknown-unknown
cargo build --locked --quiet --profile ci --package snell-cli --package snell-wasm-bundle
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

milliseconds=55 # for each frame of the film
build_studio --quick
rm -rf out/studio
(cd studio && node scripts/film.mjs ../out/studio "$milliseconds")

need_python_package
target/python/bin/python - "$milliseconds" <<'PYTHON'
import sys
from pathlib import Path

import numpy as np
import snell
from PIL import Image

ball = snell.scenes["lecture/default"]
frames = snell.sweep(ball, {"material.glass.eta": np.linspace(1, 2.5, 60)}, "out/sweep", width=320, spp=16)
frames[::4].sheet("docs/pictures/sweep.png")
frames.save("docs/pictures/sweep.gif")

film = [Image.open(path).convert("RGB") for path in sorted(Path("out/studio").glob("*.png"))]
film[-1].save("docs/pictures/studio.png", optimize=True)
# The end fades into the beginning.
fade = [Image.blend(film[-1], film[0], part / 8) for part in range(1, 8)]
# Key frames clear away what small differences leave; many of them would take more bytes than the film may have.
size = {"quality": 78, "kmin": 40, "kmax": 60}
film[0].save("docs/pictures/studio.webp", save_all=True, append_images=film[1:] + fade, duration=int(sys.argv[1]), loop=0, **size)
PYTHON
