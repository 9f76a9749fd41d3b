// The module for browsers, as a page loads it, against the command: the same bits, and no trap whatever it is given.
// Usage: SNELL=target/ci/snell STUDIO=target/studio node --test tests/studio/

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { env } from "node:process";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const command = env.SNELL ?? "target/ci/snell";
const studio = resolve(env.STUDIO ?? "target/studio");
const module = new WebAssembly.Module(readFileSync(join(studio, "snell_wasm_bg.wasm")));

// A worker has an instance of its own; here each is a copy of the script, which the query tells apart.
async function instance(name) {
    const script = await import(`${pathToFileURL(join(studio, "snell_wasm.js"))}?${name}`);
    script.initSync({ module });
    return script;
}

const { Session } = await instance("first");
const bytes = (text) => new TextEncoder().encode(text);
const textOf = (name) => JSON.parse(Session.scenes()).find((scene) => scene.name === name).text;

function run(...args) {
    return execFileSync(command, args, { encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "pipe"] });
}

// What `snell render` says in the end, and the picture that it writes.
function native(...args) {
    const folder = mkdtempSync(join(tmpdir(), "snell-studio-"));
    try {
        const output = join(folder, "picture.npy");
        const lines = execFileSync(
            "sh",
            ["-c", 'exec "$@" 2>&1', "sh", command, "render", ...args, "--progress", "json", "-o", output],
            { encoding: "utf8", maxBuffer: 1 << 28 },
        );
        return JSON.parse(lines.trim().split("\n").at(-1));
    } finally {
        rmSync(folder, { recursive: true });
    }
}

// Renders to the end; each step is to be soon over, and what has changed lies within the picture.
function finish(session, milliseconds = 5) {
    const [width, height] = session.size;
    while (!session.is_finished) {
        const changed = session.step(milliseconds);
        assert.ok(changed.length > 0 && changed.length % 5 === 0);
        for (let at = 0; at < changed.length; at += 5) {
            const [x, y, w, h, step] = changed.subarray(at, at + 5);
            assert.ok(w > 0 && h > 0 && x + w <= width && y + h <= height && step >= 1, `${changed}`);
        }
    }
    assert.equal(session.step(milliseconds).length, 0);
    return session;
}

// What is refused, as it is told; that it is an error and no trap.
function findings(action, what = action) {
    try {
        action();
    } catch (error) {
        assert.ok(error instanceof Error && !(error instanceof WebAssembly.RuntimeError), `${error.stack}`);
        assert.ok(error.findings, `no findings: ${error.stack}`);
        return JSON.parse(error.findings);
    }
    return assert.fail(`nothing was refused by ${what}`);
}

for (const [name, size, options] of [
    ["lecture/default", [160, 120], { coarsest: 4 }],
    ["gallery/ball", [64, 64], { coarsest: 8, spp: 5, depth: 6 }],
    ["gallery/prism", [64, 48], {}],
]) {
    test(`${name} in steps has the hash of the command`, () => {
        const session = Session.builtin(name);
        session.begin(JSON.stringify({ size, ...options }));
        finish(session);
        const given = Object.entries(options).filter(([key]) => key !== "coarsest");
        const expected = native(name, "--size", size.join("x"), ...given.flatMap(([key, value]) => [`--${key}`, `${value}`]));
        assert.equal(session.film_sha256, expected.film_sha256);
        const { pixels, total_pixels, rays } = JSON.parse(session.progress());
        assert.deepEqual([pixels, total_pixels], [size[0] * size[1], size[0] * size[1]]);
        assert.equal(rays, Object.values(expected.rays).reduce((sum, count) => sum + count));
    });
}

test("every built-in scene loads as a file, and is saved as the same scene", () => {
    for (const { name, text } of JSON.parse(Session.scenes())) {
        const session = Session.load(`${name}.toml`, bytes(text));
        const [width, height] = session.size;
        const again = Session.load("saved.toml", bytes(session.save()));
        const crop = { x: Math.floor(width / 2), y: Math.floor(height / 2), width: 4, height: 4 };
        const values = [session, again].map((one) => {
            one.begin(JSON.stringify({ crop }));
            return finish(one).values(crop.x, crop.y, 4, 4);
        });
        assert.deepEqual(values[0], values[1], name);
        session.free();
        again.free();
    }
});

test("two instances with parts of a picture make the picture", async () => {
    const name = "gallery/ball";
    const size = [50, 40];
    const parts = [
        { x: 0, y: 0, width: 50, height: 17 },
        { x: 0, y: 17, width: 50, height: 23 },
    ];
    const whole = Session.builtin(name);
    whole.begin(JSON.stringify({ size, spp: 3 }));
    finish(whole);
    const gathered = Session.builtin(name);
    gathered.gather(JSON.stringify({ size, spp: 3 }));
    assert.equal(gathered.step(5).length, 0);
    for (const [number, crop] of parts.entries()) {
        assert.ok(!gathered.is_finished && gathered.film_sha256 === undefined);
        const worker = (await instance(`worker-${number}`)).Session.builtin(name);
        worker.begin(JSON.stringify({ size, spp: 3, coarsest: 8, crop }));
        finish(worker);
        const { x, y, width, height } = crop;
        gathered.put(x, y, width, height, worker.values(x, y, width, height));
        assert.deepEqual(worker.rgba(x, y, width, height), whole.rgba(x, y, width, height));
    }
    assert.equal(gathered.film_sha256, whole.film_sha256);
    assert.deepEqual(gathered.png(), whole.png());
    findings(() => gathered.put(0, 0, 50, 41, new Float64Array(50 * 41 * 3)));
    findings(() => gathered.put(0, 0, 2, 2, new Float64Array(11)));
    findings(() => gathered.put(4294967295, 0, 2, 2, new Float64Array(12)));
    findings(() => whole.put(0, 0, 1, 1, new Float64Array(3)));
});

test("an edited scene is the scene that was written so", () => {
    const session = Session.builtin("lecture/default");
    session.begin('{ "size": [40, 40] }');
    finish(session);
    const before = session.film_sha256;
    for (let step = 0; step < 5; step++) {
        session.edit("material.glass.eta", `${1.1 + step / 10}`);
        session.edit("camera.eye", `[${step}, 5, 20]`);
    }
    assert.ok(!session.is_finished && session.film_sha256 === undefined);
    session.begin('{ "size": [40, 40] }');
    finish(session);
    assert.notEqual(session.film_sha256, before);
    const set = ["--set", "material.glass.eta=1.5", "--set", "camera.eye=[4, 5, 20]", "--size", "40x40"];
    assert.equal(session.film_sha256, native("lecture/default", ...set).film_sha256);
    const fresh = Session.load("fresh.toml", bytes(session.save()));
    fresh.begin('{ "size": [40, 40] }');
    assert.equal(finish(fresh).film_sha256, session.film_sha256);

    // What is refused leaves all as it was.
    const saved = session.save();
    for (const [key, value] of [
        ["material.glas.eta", "1"],
        ["material.glass.eta", "no number"],
        ["material.glass.eta", "-1"],
        ["no key at all", "1"],
        ["", ""],
        ["camera", "{"],
        ["render.size", "[0, 0]"],
        ["\u0000", "\ud800"],
    ]) {
        assert.ok(findings(() => session.edit(key, value), key).length > 0);
    }
    assert.equal(session.save(), saved);
    assert.equal(session.film_sha256, fresh.film_sha256);
});

test("explanations and the view are those of the command", () => {
    const session = Session.builtin("lecture/default");
    for (const [x, y] of [
        [256, 256],
        [200, 300],
    ]) {
        const expected = JSON.parse(run("explain", "lecture/default", `${x},${y}`, "--json"));
        assert.deepEqual(JSON.parse(session.explain(x, y)), expected);
    }
    assert.ok(findings(() => session.explain(512, 0))[0].message.includes("512,0"));
    const { snell_view, spheres } = JSON.parse(session.view());
    assert.ok(snell_view >= 1 && spheres.length > 0);
    session.begin('{ "size": [32, 32] }');
    const seen = session.find("glass");
    assert.equal(seen.mask.length, 32 * 32);
    assert.ok(JSON.parse(seen.paths)[0].pixels > 0);
    assert.ok(findings(() => session.find("glas"))[0].help.includes("glass"));
});

test("files keep the recipe", () => {
    const session = Session.builtin("gallery/ice");
    findings(() => session.png());
    session.begin('{ "size": [32, 32], "coarsest": 8 }');
    session.step(0);
    assert.ok(session.png().length > 0, "an unfinished picture");
    finish(session);
    const folder = mkdtempSync(join(tmpdir(), "snell-studio-"));
    try {
        for (const [ending, content] of [
            ["png", session.png()],
            ["exr", session.exr()],
        ]) {
            const file = join(folder, `ice.${ending}`);
            writeFileSync(file, content);
            assert.equal(native("--from", file).film_sha256, session.film_sha256);
        }
    } finally {
        rmSync(folder, { recursive: true });
    }
});

test("models and pictures come from memory", () => {
    const scene = `${textOf("lecture/default")}
[[mesh]]
file = "models/a.obj"
material = "green"
`;
    const model = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const missing = findings(() => Session.load("scenes/s.toml", bytes(scene)));
    assert.ok(missing[0].message.includes("a.obj") && missing[0].place.line > 1, JSON.stringify(missing));
    for (const files of [
        new Map([["scenes/models/a.obj", bytes(model)]]),
        [["scenes/models/a.obj", bytes(model)]],
    ]) {
        const session = Session.load("scenes/s.toml", bytes(scene), files);
        session.edit("mesh.1.material", "green");
        session.begin('{ "size": [16, 16] }');
        finish(session);
    }
    findings(() => Session.load("scenes/s.toml", bytes(scene), [["scenes/models/a.obj", bytes("f 1 2 3")]]));
    findings(() => Session.load("scenes/s.toml", bytes(scene), [["scenes/models/a.obj", 1 << 30]]));
    findings(() => Session.load("scenes/s.toml", bytes(scene), [[7, bytes(model)]]));
    findings(() => Session.load("scenes/s.toml", bytes(scene), 7));
});

test("what is wrong has its place", () => {
    const text = "snell = 1\n[render]\nintegrator = \"whitted\"\nsize = [8, 8]\nsparkle = 3\n";
    const [finding] = findings(() => Session.load("a.toml", bytes(text)));
    assert.deepEqual([finding.place.file, finding.place.line, finding.place.column], ["a.toml", 5, 1]);
    assert.ok(finding.message.includes("sparkle") && finding.help.length > 0);
    const [unknown] = findings(() => Session.builtin("ball"));
    assert.ok(unknown.help.includes("gallery/ball"), JSON.stringify(unknown));
    assert.equal(JSON.parse(Session.builtin("lecture/default").validate()).constructor, Array);
});

test("nothing traps", () => {
    const text = textOf("lecture/default");
    const junk = Uint8Array.from({ length: 4096 }, (_, at) => (at * 197 + 13) % 256);
    for (const [name, content] of [
        ["", new Uint8Array()],
        ["a.toml", new Uint8Array()],
        ["a.toml", junk],
        ["a.json", bytes("[".repeat(100_000))],
        ["a.toml", bytes(`a = ${"[".repeat(100_000)}`)],
        ["a.nff", bytes("v")],
        ["a.txt", bytes("camera")],
        ["../../..", bytes("{}")],
        ["a.toml", bytes(text.slice(0, text.length / 2))],
        ["a.png", junk],
        ["a.toml", new Uint8Array(65 << 20).fill(32)],
        ["a.toml", new Uint8Array(60 << 20).fill(35)],
    ]) {
        findings(() => Session.load(name, content));
    }
    for (let cut = 0; cut < text.length; cut += 97) {
        try {
            Session.load("cut.toml", bytes(text.slice(0, cut))).free();
        } catch (error) {
            assert.ok(error.findings, `${cut}: ${error.stack}`);
        }
    }
    const session = Session.builtin("lecture/default");
    assert.deepEqual([session.step(5).length, session.is_finished, session.film_sha256], [0, false, undefined]);
    for (const options of [
        "",
        "[]",
        "null",
        '{ "sizes": [1, 1] }',
        '{ "size": [0, 5] }',
        '{ "size": [-1, 5] }',
        '{ "size": [1e9, 5] }',
        '{ "size": [100000, 100000] }',
        '{ "size": [4294967295, 4294967295] }',
        '{ "size": [8000, 8000], "spp": 64, "coarsest": 8 }',
        '{ "spp": 0 }',
        '{ "spp": 4294967295 }',
        '{ "integrator": "magic" }',
        '{ "crop": { "x": 500, "y": 0, "width": 13, "height": 1 } }',
        '{ "crop": { "x": 0, "y": 0, "width": 0, "height": 1 } }',
        '{ "crop": { "x": 4294967295, "y": 4294967295, "width": 4294967295, "height": 4294967295 } }',
    ]) {
        assert.ok(findings(() => session.begin(options), options).length > 0);
    }
    // It is of use still.
    for (const options of [
        '{ "size": [1, 1], "coarsest": 0 }',
        '{ "size": [3, 2], "coarsest": 4294967295, "spp": 7 }',
        '{ "size": [16, 16], "integrator": "whitted", "shadows": "opaque", "depth": 0 }',
        undefined,
    ]) {
        session.begin(options);
        session.step(Number.NaN);
        session.step(-1);
        finish(session, Number.POSITIVE_INFINITY);
    }
    assert.equal(session.film_sha256, native("lecture/default").film_sha256);
    const [width, height] = session.size;
    for (const part of [
        [0, 0, width + 1, 1],
        [0, 0, 0, 1],
        [width, height, 1, 1],
        [4294967295, 0, 4294967295, 1],
    ]) {
        findings(() => session.rgba(...part));
        findings(() => session.values(...part));
    }
});
