# Sourced by the other scripts: how to fail, and what has to be there.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Says what is missing and the command that helps, and stops with 2.
missing() {
    printf '\nSnell needs %s, and it cannot be installed from here. Please run:\n\n    %s\n\nthen try again.\n' "$1" "$2" >&2
    exit 2
}

# Says what is missing, and goes on without it.
absent() {
    printf '%s is not installed, so it is left out. To have it:   %s\n' "$1" "$2" >&2
}

# The Rust toolchain that rust-toolchain.toml names, with its components, and the standard library for these targets.
need_rust() {
    local channel target
    channel=$(sed -n 's/^channel = "\(.*\)"/\1/p' rust-toolchain.toml)
    if command -v rustup >/dev/null; then
        local install=(rustup toolchain install "$channel" --profile minimal --component clippy --component rustfmt)
        for target in "$@"; do install+=(--target "$target"); done
        if ! complete_toolchain "$channel" "$@"; then
            printf 'Installing Rust %s ...\n' "$channel" >&2
            "${install[@]}" --no-self-update >&2 || missing "the Rust toolchain $channel" "${install[*]}"
        fi
    elif ! cargo --version 2>/dev/null | grep -qF "cargo $channel"; then
        missing "Rust $channel" 'sudo apt-get install rustup   (or install rustup as rust-lang.org describes)'
    elif ! cargo clippy --version >/dev/null 2>&1 || ! cargo fmt --version >/dev/null 2>&1; then
        missing 'clippy and rustfmt' 'sudo apt-get install rustup   (or install rustup as rust-lang.org describes)'
    else
        for target in "$@"; do
            [ -d "$(rustc --print target-libdir --target "$target")" ] ||
                missing "the Rust standard library for $target" 'sudo apt-get install rustup'
        done
    fi
    command -v cc >/dev/null || missing 'a linker (cc)' 'sudo apt-get install gcc libc6-dev'
}

complete_toolchain() {
    local parts target
    parts=$(rustup component list --toolchain "$1" --installed 2>/dev/null) || return 1
    grep -q '^clippy' <<<"$parts" && grep -q '^rustfmt' <<<"$parts" || return 1
    for target in "${@:2}"; do
        grep -q "^rust-std-$target" <<<"$parts" || return 1
    done
}

need_plain_python() {
    python3 -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null ||
        missing 'Python 3.10 or newer' 'sudo apt-get install python3 python3-venv'
}

# A virtual environment of our own with what the Python tests need.
need_python() {
    need_plain_python
    local stamp=.venv/requirements.txt
    if ! cmp -s tests/requirements.txt "$stamp"; then
        rm -rf .venv
        python3 -m venv .venv || missing "Python's venv module" 'sudo apt-get install python3-venv'
        .venv/bin/python -m pip install --quiet --disable-pip-version-check -r tests/requirements.txt ||
            missing 'the Python packages of the tests' '.venv/bin/python -m pip install -r tests/requirements.txt'
        cp tests/requirements.txt "$stamp"
    fi
}

# The Python package of this clone with what its tests need, in an environment that is made anew.
need_python_package() {
    rm -rf target/python
    python3 -m venv target/python || missing "Python's venv module" 'sudo apt-get install python3-venv'
    target/python/bin/python -m pip install --quiet --disable-pip-version-check '.[test]' ||
        missing 'the Python package and what its tests need' "target/python/bin/python -m pip install '.[test]'"
}

# Chromium shows pages to the tests. Debian's is installed where that needs no questions.
need_chromium() {
    [ -x /usr/bin/chromium ] && return
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        printf 'Installing chromium ...\n' >&2
        { apt-get update -qq && apt-get install -y -qq chromium; } >/dev/null 2>&1 || true
    fi
    [ -x /usr/bin/chromium ] || missing 'Chromium' 'sudo apt-get install chromium'
}

# What the viewer is built and tested with; fetched again when the list of it has changed.
need_viewer_packages() {
    cmp -s viewer/package-lock.json viewer/node_modules/.fetched && return
    (cd viewer && npm ci --silent --no-audit --no-fund) && cp viewer/package-lock.json viewer/node_modules/.fetched
}

# The same for the studio, which is built on the viewer.
need_studio_packages() {
    need_viewer_packages
    cmp -s studio/package-lock.json studio/node_modules/.fetched && return
    (cd studio && npm ci --silent --no-audit --no-fund) && cp studio/package-lock.json studio/node_modules/.fetched
}

# Node runs the WASM tests and builds the viewer; 20 is the oldest that its tools run on.
need_node() {
    node --eval 'process.exit(parseInt(process.versions.node) < 20 ? 1 : 0)' 2>/dev/null ||
        missing 'Node 20 or newer' 'sudo apt-get install nodejs npm'
}

# What runs in a browser, and what its bits are tested with; together, as cargo then builds the library once for both.
build_wasm() {
    cargo build --locked --quiet --package snell-wasm --package snell-wasm-test --target wasm32-unknown-unknown --profile wasm
}

# What a page loads of Rust, in target/studio. Needs snell-wasm-bundle, which the workspace builds, or cargo on its own.
bundle_studio() {
    build_wasm
    target/ci/snell-wasm-bundle target/wasm32-unknown-unknown/wasm/snell_wasm.wasm target/studio
}

# The studio as any host serves it, in target/studio-dist, and for notebooks, in the Python package. Needs snell besides; with --quick,
# scenes that take long have no hash.
build_studio() {
    local page=python/snell/notebook/page
    need_studio_packages
    bundle_studio
    node studio/scripts/scenes.mjs target/ci/snell target/studio "$@"
    (cd studio && npm run build --silent && npm run build-notebook --silent)
    mkdir -p $page
    cp target/studio-notebook/widget.js $page/
    gzip -9nc target/studio-notebook/studio.js >$page/studio.js.gz
    gzip -9nc target/studio-notebook/studio.css >$page/studio.css.gz
    gzip -9nc target/studio/snell_wasm_bg.wasm >$page/snell.wasm.gz
}
