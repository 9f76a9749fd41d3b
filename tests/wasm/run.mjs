// Renders every scene of the matrix in WASM and prints its line, as `snell-test-scenes` does natively.
// Usage: node tests/wasm/run.mjs module.wasm

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { argv, stdout } from "node:process";

const module = new WebAssembly.Module(readFileSync(argv[2]));

// A panic traps without a word; its message waits in the module's text.
function start() {
    const { memory, scene_count, check, text, text_length } = new WebAssembly.Instance(module).exports;
    const read = () => Buffer.from(memory.buffer, text(), text_length()).toString();
    const count = scene_count();
    const line = (scene) => {
        try {
            check(scene);
        } catch (trap) {
            throw new Error(`scene ${scene} of ${count} in WASM: ${read() || "no message"}`, { cause: trap });
        }
        return read();
    };
    return { count, line };
}

// That a failure shows is worth a look: there is no such scene.
assert.throws(() => start().line(-1), /index out of bounds/);

const { count, line } = start();
for (let scene = 0; scene < count; scene++) stdout.write(`${line(scene)}\n`);
