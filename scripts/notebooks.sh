#!/usr/bin/env bash
# Runs the notebooks of the documentation anew, in JupyterLab in Chromium, and keeps what they show.
source "$(dirname "$0")/lib.sh"

need_rust
need_node
need_chromium
need_viewer_packages
need_python_package
node docs/notebooks/run.mjs docs/notebooks/*.ipynb
SHOT=docs/pictures/notebook.png node docs/notebooks/run.mjs docs/notebooks/5-the-yellow-pixel.ipynb
