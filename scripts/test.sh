#!/usr/bin/env bash
# Everything that CI runs, with the time of each stage. Stops at the first stage that fails.
source "$(dirname "$0")/lib.sh"

times=()
stage() {
    local name=$1 start=$SECONDS
    shift
    printf '\n── %s\n' "$name"
    "$@"
    times+=("$(printf '%5d s  %s' $((SECONDS - start)) "$name")")
}

need_tools() { need_rust wasm32-unknown-unknown aarch64-unknown-linux-gnu && need_python && need_node && need_chromium; }
oracle() { SNELL=$PWD/target/ci/snell .venv/bin/python -m pytest -q tests --ignore tests/python; }
# As on a fresh machine: an environment of its own, and what the package says that it needs.
python_package() {
    need_python_package
    local python=$PWD/target/python/bin/python
    "$python" -m mypy
    "$python" -m ruff check --quiet
    "$python" -m ruff format --check --quiet
    SNELL=$PWD/target/ci/snell "$python" -m pytest -q --doctest-modules --pyargs snell tests/python
}
jupyterlab() { PYTHON=$PWD/target/python/bin/python node --test tests/jupyterlab/; }
documentation() { RUSTDOCFLAGS='-D warnings' cargo doc --locked --quiet --workspace --no-deps --profile ci; }
# An intrinsic that is a function of its own was called from code without the instructions of its width: each operation
# becomes a call through memory, and nothing but the time tells. Only those on f64 are ours; memchr has such functions too.
kernels_are_inlined() {
    if ! command -v nm >/dev/null; then
        absent 'nm' 'sudo apt-get install binutils'
        return
    fi
    local symbols lost
    symbols=$(nm -C target/ci/snell)
    if ! grep -q ' snell::' <<<"$symbols"; then
        printf 'nm shows no functions of ours: has target/ci/snell been stripped?\n'
        return 1
    fi
    if lost=$(grep -E 'core_arch::x86::(sse|avx)[0-9a-z]*::_mm[0-9]*_([0-9a-z_]*pd|maskz?_)' <<<"$symbols"); then
        printf 'These are called, not inlined; look for a closure or function without #[inline(always)]:\n%s\n' "$lost"
        return 1
    fi
}
# No threads, no files, no standard library: rustc refuses what is not there.
kernels_alone() {
    cargo build --locked --quiet --package snell-kernels --no-default-features --target wasm32-unknown-unknown --profile ci
}
same_bits_in_wasm() {
    build_wasm
    target/ci/snell-test-scenes >target/same-bits-native.txt
    node tests/wasm/run.mjs target/wasm32-unknown-unknown/wasm/snell_wasm_test.wasm >target/same-bits-wasm.txt
    diff target/same-bits-native.txt target/same-bits-wasm.txt
    printf '%d films and statistics, the same bits\n' "$(wc -l <target/same-bits-wasm.txt)"
}
# As a page loads it; some lints depend on the size of a pointer.
browser_module() {
    bundle_studio
    cargo clippy --locked --quiet --package snell-wasm --target wasm32-unknown-unknown --profile wasm -- -D warnings
    SNELL=$PWD/target/ci/snell node --test tests/studio/
}

# The whole page, as people use it.
studio() { (cd studio && SNELL=$PWD/../target/ci/snell npm test --silent); }

viewer() {
    need_viewer_packages
    (cd viewer && SNELL=$PWD/../target/ci/snell npm test --silent)
}

stage 'tools' need_tools
stage 'format' cargo fmt --all --check
stage 'lints' cargo clippy --locked --quiet --workspace --all-targets --profile ci -- -D warnings
stage 'build' cargo build --locked --quiet --workspace --profile ci
stage 'kernels are inlined' kernels_are_inlined
stage 'Rust tests' cargo test --locked --quiet --workspace --profile ci
stage 'Python tests: the slow oracle, the schema' oracle
stage 'the same bits in WASM' same_bits_in_wasm
stage 'the module for browsers' browser_module
stage 'the studio is built' build_studio --quick
stage 'the Python package, which has it' python_package
stage 'the viewer, in Chromium' viewer
stage 'notebooks in JupyterLab, in Chromium' jupyterlab
stage 'documentation' documentation
stage 'fuzz targets compile' cargo check --locked --quiet --manifest-path fuzz/Cargo.toml --target-dir target/fuzz
stage 'the library for ARM' cargo check --locked --quiet --package snell --target aarch64-unknown-linux-gnu --profile ci
stage 'the kernels without the standard library' kernels_alone
stage 'the studio, in Chromium' studio

printf '\n── all passed\n'
printf '%s\n' "${times[@]}"
