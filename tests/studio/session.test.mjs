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

test("every built-in scene loads as a file, and stays the text that it is", () => {
    for (const { name, text } of JSON.parse(Session.scenes())) {
        const session = Session.load(`${name}.toml`, bytes(text));
        assert.equal(session.text, text);
        const [width, height] = session.size;
        const again = Session.load("again.toml", bytes(session.text));
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

// What a worker of a pool does, and what another one makes of it.
async function inShares(name, shares, options) {
    const gathered = Session.builtin(name);
    gathered.gather(JSON.stringify(options));
    const [width, height] = gathered.size;
    let pixels = 0;
    for (let share = 0; share < shares; share++) {
        assert.ok(gathered.film_sha256 === undefined);
        const worker = (await instance(`worker-${share}`)).Session.builtin(name);
        worker.begin(JSON.stringify({ ...options, coarsest: 4, share: [share, shares] }));
        let fineness = 0;
        const pieces = new Set();
        while (!worker.is_finished) {
            const changed = worker.step(0);
            assert.ok(changed.length > 0 && changed.length % 5 === 0);
            for (let at = 0; at < changed.length; at += 5) {
                const [x, y, w, h, step] = changed.subarray(at, at + 5);
                const [column, row] = [x >> 6, y >> 6];
                assert.ok((x + w - 1) >> 6 === column && (y + h - 1) >> 6 === row, "it lies in one piece");
                assert.equal((column + row) % shares, share, "and in one of its own");
                assert.ok(1 / step >= fineness, "the whole share gets finer together");
                fineness = 1 / step;
                worker.rgba(x, y, w, h);
                pieces.add(`${column},${row}`);
            }
        }
        assert.deepEqual([...worker.step(5)], []);
        findings(() => worker.png());
        const progress = JSON.parse(worker.progress());
        assert.equal(progress.pixels, progress.total_pixels);
        for (const [column, row] of [...pieces].map((piece) => piece.split(",").map(Number))) {
            const [x, y] = [64 * column, 64 * row];
            const [w, h] = [Math.min(64, width - x), Math.min(64, height - y)];
            const values = worker.values(x, y, w, h);
            gathered.put(x, y, w, h, values, false);
            gathered.put(x, y, w, h, values, true);
            gathered.put_lost(x, y, w, h, worker.lost(x, y, w, h));
            pixels += w * h;
        }
        gathered.put_statistics(worker.statistics());
        worker.free();
    }
    assert.equal(pixels, width * height, "nothing is rendered twice");
    return gathered;
}

for (const [name, options] of [
    ["lecture/default", { size: [200, 130] }],
    ["gallery/ball", { size: [150, 100], spp: 13 }],
    ["gallery/lens", { size: [65, 129], spp: 2, depth: 3 }],
    ["lecture/default", { size: [200, 130], depth: 1 }],
]) {
    test(`${name} in shares is what the command makes of it, ${JSON.stringify(options)}`, async () => {
        const given = Object.entries(options).flatMap(([key, value]) => [`--${key}`, [value].flat().join("x")]);
        const expected = native(name, ...given);
        const whole = Session.builtin(name);
        whole.begin(JSON.stringify(options));
        finish(whole);
        for (const shares of [1, 2, 3]) {
            const gathered = await inShares(name, shares, options);
            assert.equal(gathered.film_sha256, expected.film_sha256, `${shares}`);
            assert.equal(gathered.validate(), whole.validate());
            assert.deepEqual(gathered.png(), whole.png());
            const rays = Object.values(expected.rays).reduce((sum, count) => sum + count);
            assert.equal(JSON.parse(gathered.progress()).rays, rays);
            assert.deepEqual(lostLight(gathered), expected.lost);
        }
    });
}

// What the pixels have lost, added up as `snell render` tells it.
function lostLight(session) {
    const [width, height] = session.size;
    const units = session.lost(0, 0, width, height);
    const worst = units.reduce((worst, lost, at) => (lost > units[worst] ? at : worst), 0);
    return {
        rays: JSON.parse(session.statistics()).lost.rays,
        share: units.reduce((sum, lost) => sum + lost, 0) / 2 ** 32 / (width * height * session.spp),
        worst: units[worst] / 2 ** 32 / session.spp,
        worst_pixel: [worst % width, Math.floor(worst / width)],
    };
}

test("what a whole picture has lost is known if it comes coarse to fine", () => {
    const session = Session.builtin("gallery/ball");
    findings(() => session.lost(0, 0, 1, 1));
    for (const spp of [1, 3]) {
        const options = { size: [50, 40], depth: 2, spp };
        session.begin(JSON.stringify(options));
        findings(() => finish(session).lost(0, 0, 1, 1));
        session.begin(JSON.stringify({ ...options, coarsest: 8 }));
        assert.equal(lostLight(session).share, 0);
        finish(session);
        assert.deepEqual(lostLight(session), native("gallery/ball", "--size", "50x40", "--depth", "2", "--spp", `${spp}`).lost);
    }
});

test("what was gathered is taken as it is given", () => {
    const session = Session.builtin("gallery/ball");
    session.gather('{ "size": [50, 40] }');
    session.put(0, 0, 50, 40, new Float64Array(50 * 40 * 3).fill(0.5), false);
    assert.ok(!session.is_finished && session.rgba(0, 0, 1, 1)[0] > 0 && session.png().length > 0);
    findings(() => session.put(0, 0, 50, 41, new Float64Array(50 * 41 * 3), true));
    findings(() => session.put(0, 0, 2, 2, new Float64Array(11), true));
    findings(() => session.put(4294967295, 0, 2, 2, new Float64Array(12), true));
    findings(() => session.put(0, 0, 4294967295, 4294967295, new Float64Array(3), true));
    findings(() => session.put_lost(0, 0, 2, 2, new Float64Array(3)));
    findings(() => session.put_lost(49, 0, 2, 2, new Float64Array(4)));
    session.put_lost(1, 2, 2, 1, new Float64Array([3, 4]));
    assert.deepEqual([...session.lost(0, 2, 4, 1)], [0, 3, 4, 0]);
    for (const statistics of ["", "[]", "{}", '{"rays": 1}']) {
        findings(() => session.put_statistics(statistics));
    }
    session.begin('{ "size": [50, 40] }');
    findings(() => session.put(0, 0, 1, 1, new Float64Array(3), true));
    findings(() => session.put_lost(0, 0, 1, 1, new Float64Array(1)));
    findings(() => session.put_statistics(session.statistics()));
});

const edited = (session, ...changes) => session.edit(JSON.stringify(changes));

test("an edit changes the text, and the picture is that of the text", () => {
    const session = Session.builtin("lecture/default");
    const text = session.text;
    session.begin('{ "size": [40, 40] }');
    finish(session);
    const before = session.film_sha256;
    for (let step = 0; step < 5; step++) {
        edited(session, ["material.glass.eta", `${1.1 + step / 10}`]);
        edited(session, ["camera.eye", `[${step}, 5, 20]`], ["camera.bounds.1", "-1"]);
    }
    assert.ok(!session.is_finished && session.film_sha256 === undefined);
    assert.equal(
        session.text,
        text
            .replace("eta = 2.0", "eta = 1.5")
            .replace("eye = [50, 50, 100]", "eye = [4, 5, 20]")
            .replace("bounds = [-2, 2, -2, 2] # left", "bounds = [-1, 2, -2, 2] # left"),
    );
    session.begin('{ "size": [40, 40] }');
    finish(session);
    assert.notEqual(session.film_sha256, before);
    const set = ["material.glass.eta=1.5", "camera.eye=[4, 5, 20]", "camera.bounds.1=-1"].flatMap((change) => ["--set", change]);
    assert.equal(session.film_sha256, native("lecture/default", ...set, "--size", "40x40").film_sha256);

    // What is refused leaves all as it was.
    const { text: kept, film_sha256 } = session;
    for (const [key, value] of [
        ["material.glas.eta", "1"],
        ["material.glass.eta", "no number"],
        ["material.glass.eta", "-1"],
        ["material.glass", null],
        ["no key at all", "1"],
        ["", ""],
        ["camera", "{"],
        ["camera", null],
        ["sphere.5", null],
        ["render.size", "[0, 0]"],
        ["\u0000", "\ufffd"],
    ]) {
        const [finding] = findings(() => edited(session, ["ambient", "0.9"], [key, value]), key);
        assert.ok(finding.message.includes(key) && finding.message.includes((value ?? "").slice(0, 60)), finding.message);
        assert.equal(finding.place, undefined, "nobody has seen the text that was refused");
    }
    for (const changes of ["", "[]]", "{}", "[[1, 2]]", '[["a", "\\ud800"]]', '[["ambient"]]', '["ambient", "1"]', '[["ambient", 1]]']) {
        findings(() => session.edit(changes), changes);
    }
    assert.deepEqual([session.text, session.film_sha256], [kept, film_sha256]);
    session.edit("[]");
    assert.equal(session.text, kept);
});

test("what an edit adds or takes away is there, or is not", () => {
    const session = Session.builtin("lecture/default");
    const { text, size } = session;
    edited(
        session,
        ["render.spp", "3"],
        ["render.size", "[20, 10]"],
        ["material.water", "{ ko = 0, eta = 1.33 }"],
        ["sphere", '{ name = "drop", center = [1, 2, 3], radius = 1, material = "water" }'],
    );
    assert.ok(session.text.includes('\n[[sphere]]\nname = "drop"\n') && session.text.includes("\n[material.water]\n"));
    const { render, sphere, material } = JSON.parse(session.scene());
    assert.deepEqual([render.spp, sphere.at(-1).name, material.water.eta, [...session.size]], [3, "drop", 1.33, [20, 10]]);
    edited(session, ["sphere.drop", null], ["material.water", null], ["render.spp", null], ["render.size", `[${size.join(", ")}]`]);
    assert.equal(session.text, text);
});

test("a text that was typed is taken, or refused at its place", () => {
    const session = Session.builtin("lecture/default");
    const { text } = session;
    session.begin("{}");
    for (const [from, to, line] of [
        ["radius = 9", "radius = -9", 1 + text.slice(0, text.indexOf("radius = 9")).split("\n").length - 1],
        ["[render]", "[render", 1 + text.slice(0, text.indexOf("[render]")).split("\n").length - 1],
    ]) {
        const [finding] = findings(() => session.revise(text.replace(from, to)));
        assert.equal(finding.place.line, line);
    }
    for (const hostile of ["", "\u0000", "snell = 1", "[".repeat(100_000), `a = ${"[".repeat(100_000)}`, "#".repeat(65 << 20)]) {
        findings(() => session.revise(hostile), hostile.slice(0, 20));
    }
    assert.equal(session.text, text);
    assert.ok(session.step(0).length > 0, "the picture goes on");
    session.revise(`# Mine.\r\n${text.replace("size = [512, 512]", "size = [30, 20]")}`);
    assert.ok(session.text.startsWith("# Mine.\n# The lecture") && session.size.join() === "30,20");
    const [width, height] = session.size;
    session.begin("{}");
    assert.equal(finish(session).values(0, 0, width, height).length, 3 * width * height);
});

test("what is no TOML becomes TOML that makes the same picture", () => {
    const folder = mkdtempSync(join(tmpdir(), "snell-studio-"));
    try {
        const file = join(folder, "scene.json");
        run("convert", "gallery/ball", "-o", file);
        const session = Session.load("scene.json", readFileSync(file));
        assert.ok(session.text.includes("\n[render]\n"));
        session.begin('{ "size": [16, 16] }');
        assert.equal(finish(session).film_sha256, native(file, "--size", "16x16").film_sha256);
        edited(session, ["render.spp", "2"]);
        assert.ok(session.text.includes("spp = 2\n"));
    } finally {
        rmSync(folder, { recursive: true });
    }
});

test("the view tells what geometry has stayed", () => {
    const session = Session.builtin("gallery/brilliant");
    const view = () => JSON.parse(session.view()).meshes;
    const before = view();
    assert.ok(before.length > 0 && before.every(({ vertices, faces }) => vertices.length === 0 && faces.length === 0));
    const { vertices, faces } = session.view_mesh(0);
    assert.ok(vertices instanceof Float64Array && faces instanceof Uint32Array && faces.length > 0);
    assert.ok(faces.every((vertex) => 3 * vertex + 2 < vertices.length));
    edited(session, ["ambient", "0.1"], ["camera.near", "-4"]);
    assert.deepEqual(view(), before);
    const kind = ["mesh", "lathe", "plane", "box", "disc"].find((kind) => JSON.parse(session.scene())[kind]?.[0].name === before[0].name);
    edited(session, [`${kind}.1.transform`, "[{ scale = [2, 2, 2] }]"]);
    assert.notEqual(view()[0].geometry, before[0].geometry);
    findings(() => session.view_mesh(before.length));
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
        session.edit('[["mesh.1.material", "\\"green\\""]]');
        assert.ok(session.text.startsWith(scene.slice(0, 200)));
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
        '{ "share": [0, 0] }',
        '{ "share": [2, 2] }',
        '{ "share": [-1, 2] }',
        '{ "share": [0] }',
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
        '{ "size": [3, 2], "coarsest": 4, "share": [0, 4294967295] }',
        '{ "size": [3, 2], "coarsest": 4, "share": [4294967294, 4294967295] }',
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
